"""Compares exported policies in ONNX Runtime with the policies' own actions.

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


def actions(session, steps):
    """Returns the actions step by step, with the state of a recurrent policy."""
    states = {each.name: numpy.zeros((32, each.shape[1]), numpy.float32) for each in session.get_inputs() if each.name == "state"}
    for seen in steps:
        done, *after = session.run(["action", *["next_state" for _ in states]], {"observation": seen, **states})
        states = dict(zip(states, after))
        yield done


def main(folder):
    models = sorted(pathlib.Path(folder).glob("*.onnx"))
    assert models, f"no models in {folder}"
    for path in models:
        onnx.checker.check_model(onnx.load(path), full_check=True)
        answers = json.loads(path.with_suffix(".json").read_text())
        session = onnxruntime.InferenceSession(str(path), providers=["CPUExecutionProvider"])
        wanted = numpy.array(answers["actions"], numpy.float64).reshape(3, 32, -1)
        seen = numpy.array(answers["observations"], numpy.float32).reshape(3, 32, -1)
        done = numpy.stack(list(actions(session, seen)))
        difference = numpy.abs(done - wanted).max()
        print(f"{path.stem}: largest difference {difference:.2e}, actions {wanted.min():.3f} to {wanted.max():.3f}")
        assert done.shape == wanted.shape and difference <= TOLERANCE


main(sys.argv[1])
