"""The same training through the command, Python and C: the same numbers, the same container."""

import json
import os
import signal
import subprocess

import numpy as np
import opendr
import pytest
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator, ExternalDataset
from opendr.engine.learners import Learner
from opendr.engine.target import BoundingBox, BoundingBoxList
from test_parity import printed, program

COUNTS = {"train": 4, "val": 6}


class Boxes(DatasetIterator):
    """Sample number ``n`` has ``n`` boxes; reading number ``interrupt`` is Ctrl-C."""

    classes = ["cat", "dog"]

    def __init__(self, count, interrupt=None):
        self.count, self.interrupt, self.reads = count, interrupt, 0

    def __len__(self):
        return self.count

    def __getitem__(self, idx):
        self.reads += 1
        if self.reads == self.interrupt:
            os.kill(os.getpid(), signal.SIGINT)
        boxes = [BoundingBox(1, 1.0, 1.0, 2.0, 2.0, 1.0) for _ in range(idx)]
        return Image(np.zeros((3, 8, 8), np.uint8), guess_format=False), BoundingBoxList(boxes)


@pytest.fixture
def interruptible():
    """Enables Ctrl-C, also if the tests were started in the background with SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def data(tmp_path):
    """The same samples as :class:`Boxes`, on disk."""
    folder = tmp_path / "data"
    for part, count in COUNTS.items():
        for kind in ("images", "labels"):
            (folder / kind / part).mkdir(parents=True)
        for number in range(count):
            Image(np.zeros((3, 8, 8), np.uint8), guess_format=False).save(folder / f"images/{part}/{number}.png")
            (folder / f"labels/{part}/{number}.txt").write_text("1 0.25 0.25 0.25 0.25\n" * number)
    (folder / "data.yaml").write_text("train: images/train\nval: images/val\nnames: [cat, dog]\n")
    return folder


@pytest.fixture
def counter():
    return opendr.learners()["counter"](device="cpu")


def container(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_every_surface_trains_the_same(data, counter, tmp_path):
    options = {"params": {"epochs": 2, "lr": 0.5}, "val_split": "val"}
    command = [program("OPENDR_BIN"), "fit", "counter", str(data), "--json", "--quiet", "--epochs=2", "--lr=0.5"]
    command += ["--val-split=val", "--out", str(tmp_path / "command"), "--device=cpu"]
    reports = {"command": json.loads(printed(command)[0])}
    external = ExternalDataset(data, "yolo")
    numbers = counter.fit(external, silent=True, out=tmp_path / "python", val_split="val", epochs=2, lr=0.5)
    reports["python"] = numbers["report"]
    by_c = json.dumps({**options, "output": str(tmp_path / "c")})
    reports["c"] = json.loads(printed([program("OPENDR_INFER_JSON_C"), "--fit", "counter", str(data), by_c])[0])
    for surface, report in reports.items():
        assert report["curves"] == {"loss": [0.75, 0.75], "val_boxes": [2.5]}, surface
        assert report["scalars"] == {"epochs": 2.0} and report["complete"] and report["samples"] == 4
        assert report["model"] == str(tmp_path / surface / "model")
        assert container(tmp_path / surface / "model") == container(tmp_path / "command/model")
    assert numbers["loss"] == [0.75, 0.75] and counter.is_ready


def test_c_hears_how_it_goes_and_stops_it(data, tmp_path):
    command = [program("OPENDR_INFER_JSON_C"), "--fit", "counter", str(data)]
    options = json.dumps({"output": str(tmp_path / "run"), "params": {"epochs": 5}})
    stopped = subprocess.run([*command, options], env={**os.environ, "STOP_AT": "7"}, capture_output=True, check=True)
    report = json.loads(stopped.stdout)
    assert not report["complete"] and report["curves"] == {"loss": [1.5]} and int(stopped.stderr) == 7
    options = json.dumps({"output": str(tmp_path / "run"), "params": {"epochs": 5}, "resume": True})
    assert json.loads(printed([*command, options])[0])["curves"] == {"loss": [1.5] * 5}
    refused = subprocess.run([*command, '{"epochs": 5}'], capture_output=True, text=True)
    assert refused.returncode == 12 and "options of opendr_fit" in refused.stderr


def test_data_sets_of_python(counter, tmp_path, capsys):
    numbers = counter.fit(Boxes(4), Boxes(6), out=tmp_path / "run")
    assert (numbers["loss"], numbers["val_boxes"], numbers["report"]["dataset"]) == ([1.5], [2.5], "Boxes")
    assert "trained on 4 samples of Boxes" in capsys.readouterr().out
    with pytest.raises(ValueError, match="is not empty"):
        counter.fit(Boxes(4), out=tmp_path / "run")
    with pytest.raises(TypeError, match="an ExternalDataset or a DatasetIterator, not int"):
        counter.fit(3)
    counter.fit(Boxes(4), out=tmp_path / "quiet", silent=True)
    assert capsys.readouterr().out == ""


def test_arguments_of_the_constructor_are_those_of_fit(tmp_path):
    cls = opendr.learners()["counter"]
    assert (cls().lr, cls().epochs, cls(0.5, 7).epochs, cls(iters=3).epochs) == (1.0, 1, 7, 3)
    learner = cls(lr=2.0, epochs=3, temp_path=str(tmp_path / "temp"))
    learner.iters = 2
    assert learner.fit(Boxes(4), silent=True)["loss"] == [3.0, 3.0]
    assert (tmp_path / "temp/model/model.json").is_file()
    resumed = cls(0.5, 3, temp_path=str(tmp_path / "temp"), checkpoint_load_iter=2)
    assert resumed.fit(Boxes(4), silent=True)["loss"] == [3.0, 3.0, 0.75]
    assert learner.fit(Boxes(4), silent=True, out=tmp_path / "other", lr=1.0, iters=1)["loss"] == [1.5]
    with pytest.raises(ValueError, match="epochs = 0"):
        cls(epochs=0)
    with pytest.raises(TypeError, match="no argument 'momentum'"):
        cls(momentum=0.9)
    with pytest.raises(TypeError, match="fit has no argument 'momentum'; the parameters of the training are epochs, lr"):
        learner.fit(Boxes(4), momentum=0.9)


def test_interrupt_saves(counter, tmp_path, interruptible):
    with pytest.raises(KeyboardInterrupt):
        counter.fit(Boxes(4, interrupt=6), silent=True, out=tmp_path / "run", epochs=3)
    report = json.loads((tmp_path / "run/report.json").read_text())
    assert not report["complete"] and report["curves"] == {"loss": [1.5]}
    assert counter.is_ready
    resumed = counter.fit(Boxes(4), silent=True, out=tmp_path / "run", epochs=3, resume=True)
    assert resumed["loss"] == [1.5] * 3


def test_a_learner_written_in_python_teaches(counter, tmp_path):
    class OneEachLearner(Learner):
        """Detects one dog in every image, and another with a low score."""

        name = "one_each"
        task = "object_detection_2d"
        classes = ["dog"]

        def load(self, path: str) -> bool:
            return True

        def infer(self, image: Image) -> BoundingBoxList:
            return BoundingBoxList([BoundingBox("dog", 0, 0, 1, 1, 0.9), BoundingBox("dog", 0, 0, 1, 1, 0.2)])

    teacher = OneEachLearner()
    with pytest.raises(TypeError, match="register"):
        counter.fit(Boxes(4), teacher=teacher)
    opendr.register(OneEachLearner)
    numbers = counter.fit(Boxes(4), silent=True, out=tmp_path / "run", teacher=teacher)
    assert numbers["loss"] == [1.0] and numbers["report"]["samples"] == 4
    lines = (tmp_path / "run/teacher.jsonl").read_text().splitlines()
    assert len(lines) == 5 and "one_each" in lines[0]
    both = counter.fit(Boxes(4), silent=True, out=tmp_path / "both", teacher=teacher, teacher_threshold=0.1)
    assert both["loss"] == [2.0]


def test_what_cannot_train_says_what_can():
    learner = opendr.learners()["nanodet"]()
    if learner._entry["fit"]:
        learner = opendr.learners()["yunet"]()
    with pytest.raises(NotImplementedError, match=f"{type(learner).__name__} cannot fit"):
        learner.fit(Boxes(4))
