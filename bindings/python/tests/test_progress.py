"""Progress of infer over several inputs, on a real terminal and without one."""

from __future__ import annotations

import operator
import os
import re
import subprocess
import sys
import time
from types import SimpleNamespace

import numpy as np
import opendr
import pytest
from opendr import Source, _opendr, _progress
from opendr._progress import with_progress
from opendr.engine.data import Image

pty = pytest.importorskip("pty", reason="no pseudo-terminals on this system")


class Terminal:
    """Standard error as a terminal of 80 columns."""

    def __init__(self):
        self.text = ""

    def isatty(self):
        return True

    def fileno(self):
        raise OSError

    def write(self, text):
        self.text += text

    def flush(self):
        pass

    def visible(self):
        """Returns the text of the current line."""
        return re.split("\r\x1b\\[K", self.text)[-1]


@pytest.fixture
def terminal(monkeypatch):
    terminal = Terminal()
    # pytest replaces sys.stderr itself after the fixtures.
    monkeypatch.setattr(_progress, "sys", SimpleNamespace(stderr=terminal))
    return terminal


@pytest.fixture
def clock(monkeypatch):
    """Returns a list with the time in seconds."""
    now = [100.0]
    monkeypatch.setattr(_progress.time, "monotonic", lambda: now[0])
    return now


def test_known_lengths(terminal, clock):
    shown = []

    def predictions():
        for number in range(4):
            shown.append(terminal.visible())
            clock[0] += 30
            yield number

    for number in with_progress(predictions(), "nanodet", 4):
        # The line is erased while the caller works.
        assert terminal.visible() == ""
    assert shown == [
        f"nanodet [{'-' * 30}] 0/4",
        f"nanodet [{'#' * 7}{'-' * 23}] 1/4 0.0/s ETA 1:30",
        f"nanodet [{'#' * 15}{'-' * 15}] 2/4 0.0/s ETA 1:00",
        f"nanodet [{'#' * 22}{'-' * 8}] 3/4 0.0/s ETA 0:30",
    ]
    assert terminal.visible() == ""


def test_unknown_lengths_are_shown_after_two_seconds(terminal, clock):
    shown = []

    def predictions():
        for number in range(5):
            shown.append(terminal.visible())
            clock[0] += 0.75
            yield number

    assert list(with_progress(predictions(), "nanodet", None)) == [0, 1, 2, 3, 4]
    assert shown == ["", "", "", "nanodet 3 1.3/s", "nanodet 4 1.3/s"]
    assert terminal.visible() == ""


def test_the_line_is_erased_when_the_iteration_ends_early(terminal):
    for number in with_progress(iter(range(9)), "nanodet", 9):
        if number == 2:
            break
    assert terminal.visible() == ""

    def failing():
        yield 1
        raise ValueError("no image")

    with pytest.raises(ValueError, match="no image"):
        list(with_progress(failing(), "nanodet", 9))
    assert terminal.visible() == ""


def test_lengths_may_be_wrong(terminal):
    assert list(with_progress(iter(range(5)), "nanodet", 2)) == [0, 1, 2, 3, 4]
    assert "5/2" in terminal.text


def test_narrow_terminals(terminal, monkeypatch):
    monkeypatch.setattr(_progress, "_width", lambda terminal: 20)
    list(with_progress(iter(range(3)), "nanodet", 3))
    assert max(map(len, re.split("\r\x1b\\[K", terminal.text))) == 19


def test_without_a_terminal(monkeypatch, capsys):
    predictions = iter([1, 2, 3])
    assert with_progress(predictions, "nanodet", 3) is predictions
    for missing in (None, object()):
        monkeypatch.setattr(_progress, "sys", SimpleNamespace(stderr=missing))
        assert with_progress(predictions, "nanodet", 3) is predictions
    assert capsys.readouterr().err == ""


def test_one_input_shows_nothing(terminal):
    predictions = iter([1])
    assert with_progress(predictions, "nanodet", 1) is predictions


def test_remaining_images_of_a_source(tmp_path, monkeypatch):
    for number in range(3):
        Image(np.full((4, 5, 3), number, np.uint8)).save(tmp_path / f"{number}.png")
    source = Source(tmp_path)
    assert source.__length_hint__() == 3
    next(source)
    assert source.__length_hint__() == 2
    assert len(list(source)) == 2
    assert source.__length_hint__() == 0
    monkeypatch.setattr(Source, "length", None)
    assert operator.length_hint(source, -1) == -1


def test_no_learner_has_an_input_or_parameter_of_this_name():
    for entry in _opendr.entries():
        fields = [*entry["ports"], *entry["params"], *entry["fit_params"]]
        assert "progress" not in {name for field in fields for name in (field["name"], *field.get("aliases", []))}


def test_infer(faces, photo, terminal):
    image = Image.open(photo)
    wanted = faces.infer(image)
    assert faces.infer([image, image]) == [wanted, wanted]
    assert "yunet [" in terminal.text and "1/2" in terminal.text and terminal.visible() == ""
    terminal.text = ""
    assert list(faces.infer(iter([image, image]))) == [wanted, wanted]
    assert "1/2" in terminal.text
    terminal.text = ""
    assert list(faces.infer(Source(photo, photo))) == [wanted, wanted]
    assert "1/2" in terminal.text
    terminal.text = ""
    # Their number is unknown.
    assert list(faces.infer(image for _ in range(2))) == [wanted, wanted]
    assert faces.infer([image, image], progress=False) == [wanted, wanted]
    assert list(faces.infer(Source(photo, photo), progress=False)) == [wanted, wanted]
    assert faces.infer(image, progress=True) == wanted
    assert terminal.text == ""


def test_a_loop_that_prints_on_a_terminal(tmp_path):
    """Runs a program on a pseudo-terminal: the lines that it prints stay whole, and no progress is left."""
    (tmp_path / "program.py").write_text(
        "import time\n"
        "from opendr._progress import with_progress\n"
        "def work():\n"
        "    for number in range(3):\n"
        "        time.sleep(0.01)\n"
        "        yield number\n"
        "for number in with_progress(work(), 'nanodet', 3):\n"
        "    print('prediction', number, flush=True)\n",
        encoding="utf-8",
    )
    master, slave = pty.openpty()
    program = subprocess.Popen(
        [sys.executable, str(tmp_path / "program.py")], stdin=slave, stdout=slave, stderr=slave, close_fds=True
    )
    os.close(slave)
    text = b""
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        try:
            piece = os.read(master, 4096)
        except OSError:
            break
        if not piece:
            break
        text += piece
    os.close(master)
    assert program.wait(60) == 0
    assert b"0/3" in text and b"2/3" in text
    lines = [line.split(b"\r\x1b[K")[-1] for line in text.split(b"\r\n")]
    assert lines == [b"prediction 0", b"prediction 1", b"prediction 2", b""]


def test_streams_take_single_inputs(faces, photo):
    assert faces.stream().infer(photo) == faces.infer(photo)


def test_custom_suppressions_show_progress_too(zoo, photo, terminal):
    from opendr.perception.object_detection_2d import SingleShotDetectorLearner
    from opendr.perception.object_detection_2d.nms import ClusterNMS

    detector = SingleShotDetectorLearner(device="cpu")
    detector.load()
    found = detector.infer([str(photo)] * 2, custom_nms=ClusterNMS(device="cpu"))
    assert len(found) == 2 and "1/2" in terminal.text
    assert found[0].plot() == found[0].plot(photo)
    assert opendr.learners()["single_shot_detector"] is SingleShotDetectorLearner
