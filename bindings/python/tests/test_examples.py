"""The examples run in both languages: they print the same and draw the same, on real images where the test data have them."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import wave
from pathlib import Path

import numpy as np
import pytest
from opendr.engine.data import Image
from programs import ROOT

FOLDER = ROOT / "examples"
#: The names of the examples, with the file of each language.
TWINS = {path.stem: (path, FOLDER / f"rust/src/{path.stem}.rs") for path in sorted((FOLDER / "python").glob("*.py"))}
#: Maximum number of lines of an example.
LINES = 40
#: Seconds that an example may take.
LIMIT = 600
#: Inputs of the examples that are files of the test data.
FILES = {
    "astronaut.png": "data/photos/astronaut.png",
    "fallen.jpg": "data/lspet/images/im00066.jpg",
    "hand.jpg": "data/mmpose_samples/onehand10k/33.jpg",
    "heart.txt": "data/ecg/ECG5000_TRAIN.txt",
    "known/first/1.jpg": "data/face_verification/img1.jpg",
    "known/first/2.jpg": "data/face_verification/img2.jpg",
    "known/first/3.jpg": "data/face_verification/img4.jpg",
    "known/second/1.jpg": "data/face_verification/img20.jpg",
    "left.png": "data/photos/motorcycle_left.png",
    "my_detector.onnx": "models/found/yolox_nano.onnx",
    "people.jpg": "data/photos/zidane.jpg",
    "right.png": "data/photos/motorcycle_right.png",
    "scan.bin": "data/kitti/mmdet3d_demo/000008.bin",
    "street.jpg": "data/photos/bus.jpg",
    "visitor.jpg": "data/face_verification/img5.jpg",
    "word.wav": "data/speech_commands_v0.02_test/right/0d53e045_nohash_0.wav",
}


def write_frames(folder, street):
    """Writes what a camera sees that turns: parts of an image, each further to the right."""
    folder.mkdir()
    for number in range(12):
        part = street[:, 200:, 10 * number : 10 * number + 690]
        Image(np.ascontiguousarray(part), guess_format=False).save(folder / f"{number:02}.jpg")


def write_speech(path, words):
    """Writes three words with a second of silence after each."""
    with wave.open(str(path), "wb") as speech:
        speech.setnchannels(1)
        speech.setsampwidth(2)
        speech.setframerate(16000)
        for word in ("right", "left", "stop"):
            with wave.open(str(sorted((words / word).glob("*.wav"))[3])) as file:
                speech.writeframes(file.readframes(16000) + bytes(16000))


def write_skeleton(path, recordings):
    """Writes one recording of a person who draws a circle: frames, joints, coordinates."""
    rows = [line.split("\t") for line in (recordings / "index.tsv").read_text("utf-8").splitlines()]
    [(first, frames)] = [(int(row[4]), int(row[5])) for row in rows if row[0] == "a9_s1_t3_skeleton"]
    np.save(path, np.load(recordings / "frames.npy")[first : first + frames])


@pytest.fixture(scope="module")
def inputs(test_data, zoo, tmp_path_factory):
    """A folder with the inputs of all examples."""
    folder = tmp_path_factory.mktemp("inputs")
    for name, source in FILES.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(test_data / source, folder / name)
    write_frames(folder / "frames", Image.open(folder / "street.jpg").numpy())
    write_speech(folder / "speech.wav", test_data / "data/speech_commands_v0.02_test")
    write_skeleton(folder / "skeleton.npy", test_data / "data/utd_mhad_skeleton")
    sys.path.append(str(ROOT / "tests/text"))
    from signs import sign

    Image(np.ascontiguousarray(sign(4)[0])).save(folder / "sign.png")
    recorded = [os.environ["OPENDR_BIN"], "infer", "yolox", "frames", "--out", "drive.mcap", "--with-input", "--quiet"]
    subprocess.run(recorded, cwd=folder, check=True, stdout=subprocess.DEVNULL, timeout=LIMIT)
    return folder


def start(command, folder, inputs):
    """Starts an example in a folder of its own with the inputs. One runtime, so that languages can be compared."""
    # Hard links: a model that is a symbolic link out of its folder is refused.
    shutil.copytree(inputs, folder, copy_function=os.link)
    environment = {**os.environ, "OPENDR_RUNTIME": "builtin"}
    options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(command, cwd=folder, env=environment, **options)


@pytest.mark.parametrize("name", TWINS)
def test_example(name, inputs, tmp_path):
    rust = Path(os.environ["OPENDR_BIN"]).with_name("opendr-examples")
    commands = {"python": [sys.executable, str(TWINS[name][0])], "rust": [str(rust), name]}
    running = {language: start(command, tmp_path / language, inputs) for language, command in commands.items()}
    printed, pictures = {}, {}
    for language, process in running.items():
        printed[language], errors = process.communicate(timeout=LIMIT)
        assert process.returncode == 0, f"{name} in {language}: {errors}"
        pictures[language] = Image.open(tmp_path / language / f"{name}.png").numpy().astype(int)
        assert pictures[language].std() > 5, f"{name} in {language}: an empty image"
    assert printed["python"] == printed["rust"] != ""
    assert pictures["python"].shape == pictures["rust"].shape
    assert np.abs(pictures["python"] - pictures["rust"]).mean() <= 2


def test_every_example_is_short_and_has_a_twin():
    assert len(TWINS) >= 25
    rust = {path.stem for path in (FOLDER / "rust/src").glob("*.rs")} - {"main"}
    assert rust == TWINS.keys()
    for path in [path for paths in TWINS.values() for path in paths]:
        lines = path.read_text("utf-8").splitlines()
        assert len(lines) <= LINES, f"{path}: {len(lines)} lines"


def test_the_table_lists_every_example():
    rows = [line.split("|")[1:-1] for line in (FOLDER / "README.md").read_text("utf-8").splitlines() if line.startswith("| `")]
    assert [row[0].strip(" `") for row in rows] == sorted(TWINS)
    for name, (python, rust) in TWINS.items():
        [row] = [row for row in rows if row[0].strip(" `") == name]
        for path in (python, rust):
            assert f"({path.relative_to(FOLDER)})" in row[2]
        # The languages say the same about themselves, as does the table.
        about = python.read_text("utf-8").splitlines()[0].strip('"').split(". ")[0].rstrip(".")
        assert rust.read_text("utf-8").startswith(f"//! {about}.")
        assert row[1].strip().rstrip(".") == about
