"""Networks quantised by crates/optimize: valid ONNX, and computed in INT8 by ONNX Runtime."""

import collections

import numpy as np
import onnx
import onnxruntime
import pytest
from onnx import TensorProto, helper, numpy_helper

SHAPE = [1, 3, 32, 32]


def network():
    random = np.random.default_rng(0)
    weights = {
        "w1": random.normal(0, 0.3, (16, 3, 3, 3)),
        "b1": random.normal(0, 0.1, 16),
        "w2": random.normal(0, 0.3, (16, 1, 3, 3)),
        "w3": random.normal(0, 0.2, (32, 16, 1, 1)),
        "w4": random.normal(0, 0.2, (48, 10)),
        "axes": np.array([2, 3]),
    }
    weights = {name: array if name == "axes" else array.astype(np.float32) for name, array in weights.items()}
    nodes = [
        helper.make_node("Conv", ["x", "w1", "b1"], ["a"], pads=[1, 1, 1, 1]),
        helper.make_node("Relu", ["a"], ["b"]),
        helper.make_node("MaxPool", ["b"], ["c"], kernel_shape=[2, 2], strides=[2, 2]),
        helper.make_node("Conv", ["c", "w2"], ["d"], pads=[1, 1, 1, 1], group=16),
        helper.make_node("LeakyRelu", ["d"], ["e"], alpha=0.1),
        helper.make_node("Add", ["c", "e"], ["f"]),
        helper.make_node("Conv", ["f", "w3"], ["g"]),
        helper.make_node("Concat", ["f", "g"], ["h"], axis=1),
        helper.make_node("GlobalAveragePool", ["h"], ["i"]),
        helper.make_node("Squeeze", ["i", "axes"], ["j"]),
        helper.make_node("MatMul", ["j", "w4"], ["y"]),
    ]
    graph = helper.make_graph(
        nodes,
        "small",
        [helper.make_tensor_value_info("x", TensorProto.FLOAT, SHAPE)],
        [helper.make_tensor_value_info("y", TensorProto.FLOAT, [1, 10])],
        [numpy_helper.from_array(array, name) for name, array in weights.items()],
    )
    return helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)


def run(path, optimized=None):
    options = onnxruntime.SessionOptions()
    if optimized:
        options.graph_optimization_level = onnxruntime.GraphOptimizationLevel.ORT_ENABLE_EXTENDED
        options.optimized_model_filepath = str(optimized)
    session = onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
    x = np.random.default_rng(1).normal(0, 1, (16, *SHAPE)).astype(np.float32)
    return np.stack([session.run(None, {"x": picture})[0] for picture in x])


def signal_to_noise(wanted, found):
    return 10 * np.log10((wanted**2).sum() / ((wanted - found) ** 2).sum())


@pytest.mark.parametrize("precision, least", [("int8", 25), ("fp16", 60)])
def test_it_is_valid_and_answers_nearly_the_same(shrink, tmp_path, precision, least):
    onnx.save(network(), tmp_path / "float.onnx")
    shrink(precision, tmp_path / "float.onnx", tmp_path / "small.onnx")
    onnx.checker.check_model(str(tmp_path / "small.onnx"), full_check=True)
    assert signal_to_noise(run(tmp_path / "float.onnx"), run(tmp_path / "small.onnx")) > least


def test_onnx_runtime_computes_with_bytes(shrink, tmp_path):
    onnx.save(network(), tmp_path / "float.onnx")
    shrink("int8", tmp_path / "float.onnx", tmp_path / "small.onnx")
    run(tmp_path / "small.onnx", tmp_path / "optimized.onnx")
    operators = collections.Counter(node.op_type for node in onnx.load(tmp_path / "optimized.onnx").graph.node)
    assert operators["QLinearConv"] == 3 and operators["Conv"] == 0, operators
    assert operators["QLinearAdd"] == operators["QLinearConcat"] == 1, operators
