"""Data sets written by crates/datasets and read by reference tools, and the other way round."""

import json
import os
import subprocess
from pathlib import Path

import pytest
from programs import example

ROOT = Path(__file__).resolve().parents[2]


class Data:
    """Checks, prints and converts data sets, as crates/datasets/examples/data.rs."""

    def __init__(self):
        self.command = example("datasets", "data")

    def run(self, *arguments):
        return subprocess.run([*self.command, *map(str, arguments)], cwd=ROOT, capture_output=True, text=True)

    def convert(self, from_format, path, to_format, out, *options):
        done = self.run("convert", from_format, path, to_format, out, *options)
        assert done.returncode == 0, done.stderr

    def samples(self, from_format, path, *options):
        """The classes, and the name, id and target of each sample."""
        done = self.run("print", from_format, path, *options)
        assert done.returncode == 0, done.stderr
        head, *samples = map(json.loads, done.stdout.splitlines())
        return head, samples


@pytest.fixture(scope="session")
def data():
    return Data()


@pytest.fixture(scope="session")
def test_data():
    """The folder of real test data."""
    folder = Path(os.environ.get("OPENDR_TEST_DATA", ROOT.parent / "shared")) / "data"
    if not folder.is_dir():
        pytest.skip("skipped: no OPENDR_TEST_DATA")
    return folder
