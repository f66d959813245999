"""Comparison of crates/simulation with Gymnasium."""

import json
import subprocess
from pathlib import Path

import pytest
from programs import example

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def serve():
    """Has environments stepped by crates/simulation/examples/serve_environments.rs."""
    command = example("simulation", "serve_environments")

    def run(requests):
        lines = "".join(json.dumps(request) + "\n" for request in requests)
        done = subprocess.run(command, cwd=ROOT, input=lines, stdout=subprocess.PIPE, text=True, check=True)
        return [json.loads(line) for line in done.stdout.splitlines()]

    return run
