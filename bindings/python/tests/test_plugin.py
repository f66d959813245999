"""Learners written in Python, in the registry."""

import functools
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import opendr
import pytest
from bright_spots import BrightSpotsLearner
from opendr import _opendr
from opendr.engine import data, target
from opendr.engine.data import Image
from opendr.engine.learners import Learner


@pytest.fixture(scope="module")
def registered():
    opendr.register(BrightSpotsLearner)


@pytest.fixture
def model(tmp_path):
    folder = tmp_path / "model"
    folder.mkdir()
    (folder / "limit.json").write_text("100")
    return folder


def pictures(count):
    for number in range(count):
        picture = Image(np.full((3, 4, 5), 90 + 20 * number, np.uint8), guess_format=False)
        picture.timestamp, picture.frame_id = number, "camera"
        yield picture


def test_it_is_in_the_registry(registered):
    assert opendr.learners()["bright_spots"] is BrightSpotsLearner
    with pytest.raises(ValueError, match="already"):
        opendr.register(BrightSpotsLearner)


def test_it_passes_the_test_of_all_learners(registered, model, tmp_path):
    calls = [{"image": picture} for picture in pictures(3)]
    opendr.check_learner("bright_spots", str(model), str(tmp_path / "scratch"), calls)


def test_a_broken_promise_is_found(model, tmp_path):
    class ForgetfulLearner(BrightSpotsLearner):
        """Fails at `reset`."""

        name = "forgetful"

        def reset(self):
            pass

    opendr.register(ForgetfulLearner)
    calls = [{"image": picture} for picture in pictures(3)]
    with pytest.raises(opendr.InternalError, match="reset|stream|same"):
        opendr.check_learner("forgetful", str(model), str(tmp_path / "scratch"), calls)


def test_what_it_raises_comes_through(model, tmp_path):
    class FailingLearner(BrightSpotsLearner):
        """Fails."""

        name = "failing"

        def infer(self, image: Image) -> "opendr.engine.target.BoundingBoxList":
            raise KeyError("its own error")

    opendr.register(FailingLearner)
    with pytest.raises(KeyError, match="its own error"):
        calls = [{"image": picture} for picture in pictures(2)]
        opendr.check_learner("failing", str(model), str(tmp_path / "scratch"), calls)


def test_the_command_runs_it(model, tmp_path):
    package = tmp_path / "site"
    (package / "bright_spots-1.dist-info").mkdir(parents=True)
    (package / "bright_spots.py").write_text(Path(__file__).with_name("bright_spots.py").read_text())
    information = package / "bright_spots-1.dist-info"
    information.joinpath("METADATA").write_text("Metadata-Version: 2.1\nName: bright-spots\nVersion: 1\n")
    information.joinpath("entry_points.txt").write_text(
        "[opendr.learners]\nbright_spots = bright_spots:BrightSpotsLearner\nbroken = no_such_module:Learner\n"
    )
    picture = tmp_path / "bright.png"
    next(pictures(5)).save(picture)
    list(pictures(5))[4].save(picture)
    path = os.pathsep.join(filter(None, [str(package), os.environ.get("PYTHONPATH")]))
    arguments = ["infer", "bright_spots", str(picture), "--model", str(model), "--threshold", "0.5"]
    done = subprocess.run(
        [sys.executable, "-m", "opendr", *arguments],
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert "bright 1.00 at left 1.0" in done.stdout
    assert "'broken'" in done.stderr and "is skipped" in done.stderr


CLOUD = np.arange(8, dtype=np.float32).reshape(2, 4)
CALIBRATION = data.Calibration(np.arange(12).reshape(3, 4), np.eye(3) / 2, np.eye(4))
BOXES = target.BoundingBoxList([target.BoundingBox(1, 2, 3, 4, 5, 0.5, class_name="dog")], classes=["cat", "dog"])
DATA = [
    Image(np.arange(24, dtype=np.uint8).reshape(2, 4, 3)),
    Image(np.arange(12, dtype=np.uint16).reshape(1, 3, 4) * 1000, dtype=np.uint16),
    data.Video(np.arange(48, dtype=np.float32).reshape(3, 2, 2, 4)),
    data.PointCloud(CLOUD),
    data.PointCloud(CLOUD[:0]),
    data.PointCloudWithCalibration(CLOUD, CALIBRATION, (370, 1224)),
    data.PointCloudWithCalibration(CLOUD, CALIBRATION),
    data.Calibration(np.ones((3, 4)), np.eye(3), np.eye(4)),
    data.Timeseries([[0.5, 1.0], [0.25, 2.0]]),
    data.Vector([1.0, 2.0]),
    data.SkeletonSequence(np.ones((1, 3, 4, 5, 2))),
    data.Audio(np.linspace(-1, 1, 6).reshape(3, 2), 16000),
    data.Observation([1.0, 2.0, 3.0]),
    data.Observation({"lidar": CLOUD, "goal": [0.5]}),
    data.ImageWithDetections(Image(np.arange(24, dtype=np.uint8).reshape(2, 4, 3)), BOXES),
    BOXES,
    target.Heatmap(np.array([[0.5, np.nan]], np.float32)),
]


@functools.lru_cache(maxsize=None)
def echo_of(kind):
    """A loaded learner that keeps what it was given, and its class."""

    class EchoLearner(Learner):
        """Returns its input as text."""

        name = f"echo_{kind.__name__.lower()}"
        task = "object_detection_2d"

        def load(self, path: str) -> bool:
            return True

        def infer(self, given) -> target.BaseTranscription:
            type(self).given = given
            return target.BaseTranscription(str(given))

    EchoLearner.infer.__annotations__["given"] = kind
    opendr.register(EchoLearner)
    handle = _opendr.Handle(EchoLearner.name, {}, "cpu")
    handle.load(os.curdir)
    return EchoLearner, handle


@pytest.mark.parametrize("given", DATA, ids=lambda given: type(given).__name__)
def test_every_datum_arrives_as_it_was(given):
    given.timestamp, given.frame_id = 5, "camera"
    learner, handle = echo_of(type(given))
    ((name, text, array),) = handle.infer({"given": given})
    answer = json.loads(text)
    assert (name, answer["text"], array) == ("transcription", str(given), None)
    assert (answer["stamp_ns"], answer["frame_id"]) == (5, "camera")
    assert type(learner.given) is type(given) and learner.given is not given
    assert (learner.given.timestamp, learner.given.frame_id) == (5, "camera")
    # NaN is not equal to itself.
    assert str(learner.given) == str(given) if isinstance(given, target.Heatmap) else learner.given == given


def test_matrices_that_were_spoiled_are_refused():
    _, handle = echo_of(data.Calibration)
    for spoiled in (None, np.eye(3), np.full((3, 4), np.nan), [[1.0, 2.0, 3.0, 4.0]] * 4, "P2", np.arange(12)):
        calibration = data.Calibration(np.ones((3, 4)), np.eye(3), np.eye(4))
        calibration.p2 = spoiled
        with pytest.raises(ValueError, match="p2 should be 3 rows of 4 finite numbers"):
            handle.infer({"given": calibration})
    _, handle = echo_of(data.PointCloudWithCalibration)
    with pytest.raises(ValueError, match="no calibration; give calib"):
        handle.infer({"given": data.PointCloudWithCalibration(CLOUD)})
    with pytest.raises(ValueError, match="P2, Tr_velo_to_cam is missing"):
        handle.infer({"given": data.PointCloudWithCalibration(CLOUD, {"R0_rect": np.eye(3)})})
