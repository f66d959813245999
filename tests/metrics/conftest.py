"""Comparison of crates/metrics with reference tools."""

import json
import os
import subprocess
from pathlib import Path

import pytest
from programs import example

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def compute():
    """Computes cases `{"metric": .., "params": .., "samples": ..}` by crates/metrics/examples/compute.rs."""
    command = example("metrics", "compute")

    def run(*cases):
        lines = "".join(json.dumps(case) + "\n" for case in cases)
        answer = subprocess.run(command, cwd=ROOT, input=lines, stdout=subprocess.PIPE, text=True, check=True)
        return [json.loads(line) for line in answer.stdout.splitlines()]

    return run


@pytest.fixture(scope="session")
def test_data():
    """The folder of real test data."""
    folder = Path(os.environ.get("OPENDR_TEST_DATA", ROOT.parent / "shared"))
    if not folder.is_dir():
        pytest.skip("no OPENDR_TEST_DATA")
    return folder
