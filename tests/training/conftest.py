"""Outputs of trainings, read by reference tools."""

import json
import subprocess
from pathlib import Path

import pytest
from programs import example

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def log():
    """Writes lines `{"tag": .., "step": .., "value": ..}` into the log in a folder by crates/runlog/examples/log.rs."""
    command = example("runlog", "log")

    def write(folder, lines, resume_from=None):
        arguments = [str(folder)] + ([] if resume_from is None else [str(resume_from)])
        text = "".join(json.dumps(line) + "\n" for line in lines)
        subprocess.run([*command, *arguments], cwd=ROOT, input=text, text=True, check=True)

    return write


@pytest.fixture(scope="session")
def shrink():
    """Quantises an ONNX file by crates/optimize/examples/shrink.rs."""
    command = example("optimize", "shrink")

    def run(precision, source, target):
        subprocess.run([*command, precision, str(source), str(target)], cwd=ROOT, check=True)

    return run


@pytest.fixture(scope="session")
def exported(tmp_path_factory):
    """The folder with the output of crates/training/examples/export_all.rs."""
    folder = tmp_path_factory.mktemp("exported")
    command = example("training", "export_all")
    subprocess.run([*command, str(folder)], cwd=ROOT, check=True)
    return folder


@pytest.fixture(scope="session")
def own_module():
    """Trains the module of crates/training/examples/own_module.rs on the images in a folder."""
    command = example("training", "own_module")

    def run(pictures, output):
        subprocess.run([*command, str(pictures), str(output)], cwd=ROOT, check=True)

    return run
