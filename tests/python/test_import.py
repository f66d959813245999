"""Imported TensorFlow.js models compute what tf2onnx's conversions and TensorFlow.js itself compute."""

import subprocess
import sys

from conftest import ROOT


def test_imported_models_agree(shared):
    done = subprocess.run(
        [sys.executable, ROOT / "tests/import/compare.py"], capture_output=True, text=True, timeout=1800, check=False
    )
    print(done.stdout)
    assert done.returncode == 0, done.stdout + done.stderr
