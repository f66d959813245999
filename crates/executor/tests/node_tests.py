"""Writes the node tests of the package `onnx` as `FOLDER/NAME/model.onnx` and `FOLDER/NAME/test_data_set_0/{input,output}_N.pb`.

Usage: `python node_tests.py FOLDER`. Tests of sequences and optional values have no such files and are left out.
"""

import sys
from pathlib import Path

import numpy
import onnx
from onnx import numpy_helper
from onnx.backend.test.case.node import collect_testcases


def write(values, infos, kind, folder):
    for at, (value, info) in enumerate(zip(values, infos)):
        if not isinstance(value, onnx.TensorProto):
            value = numpy_helper.from_array(numpy.asarray(value), info.name)
        (folder / f"{kind}_{at}.pb").write_bytes(value.SerializeToString())


def main(root):
    count = 0
    for case in collect_testcases(None):
        graph = case.model.graph
        if any(not value.type.HasField("tensor_type") for value in [*graph.input, *graph.output]):
            continue
        inputs, outputs = case.data_sets[0]
        data = root / case.name / "test_data_set_0"
        data.mkdir(parents=True, exist_ok=True)
        (root / case.name / "model.onnx").write_bytes(case.model.SerializeToString())
        write(inputs, graph.input, "input", data)
        write(outputs, graph.output, "output", data)
        count += 1
    print(f"{count} node tests of onnx {onnx.__version__}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
