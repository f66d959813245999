"""Learners written in Python are learners like all others."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import opendr
import pytest
from bright_spots import BrightSpotsLearner
from opendr.engine.data import Image


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
        """Cannot forget."""

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
    assert "'broken'" in done.stderr and "left out" in done.stderr
