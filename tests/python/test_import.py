"""Imported TensorFlow.js and TensorFlow Lite models compute what tf2onnx's conversions and TensorFlow itself compute."""

import subprocess
import sys

import pytest
from programs import ROOT


@pytest.mark.parametrize("script", ["compare.py", "compare_tflite.py"])
def test_imported_models_agree(shared, script):
    done = subprocess.run(
        [sys.executable, ROOT / "tests/import" / script], capture_output=True, text=True, timeout=1800, check=False
    )
    print(done.stdout)
    assert done.returncode == 0, done.stdout + done.stderr
