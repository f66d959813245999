"""Comparison of crates/simulation with Gymnasium."""

import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def serve():
    """Has environments stepped by crates/simulation/examples/serve_environments.rs."""
    program = os.environ.get("OPENDR_SIMULATION_SERVE")
    example = ["cargo", "run", "-q", "-p", "opendr-simulation", "--example", "serve_environments"]

    def run(requests):
        lines = "".join(json.dumps(request) + "\n" for request in requests)
        command = [program] if program else example
        done = subprocess.run(command, cwd=ROOT, input=lines, stdout=subprocess.PIPE, text=True, check=True)
        return [json.loads(line) for line in done.stdout.splitlines()]

    return run
