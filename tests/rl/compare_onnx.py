"""Compares exported policies in ONNX Runtime with what the policies did.

    cargo run -p opendr-rl --example export_policy FOLDER
    python tests/rl/compare_onnx.py FOLDER
"""

import json
import pathlib
import sys

import numpy
import onnx
import onnxruntime

TOLERANCE = 1e-6


def main(folder):
    models = sorted(pathlib.Path(folder).glob("*.onnx"))
    assert models, f"no models in {folder}"
    for path in models:
        onnx.checker.check_model(onnx.load(path), full_check=True)
        answers = json.loads(path.with_suffix(".json").read_text())
        session = onnxruntime.InferenceSession(str(path), providers=["CPUExecutionProvider"])
        wanted = numpy.array(answers["actions"], numpy.float64).reshape(32, -1)
        seen = numpy.array(answers["observations"], numpy.float32).reshape(32, -1)
        done = session.run(["action"], {"observation": seen})[0]
        difference = numpy.abs(done - wanted).max()
        print(f"{path.stem}: largest difference {difference:.2e}, actions {wanted.min():.3f} to {wanted.max():.3f}")
        assert done.shape == wanted.shape and difference <= TOLERANCE


main(sys.argv[1])
