"""Exported models pass ONNX's checker, and compute what Burn computes."""

import json

import numpy
import onnx
import onnxruntime
import pytest


def values(of):
    return numpy.array(of["values"], numpy.float32).reshape(of["shape"])


def apart(ours, reference):
    assert ours.shape == reference.shape
    return numpy.abs(ours - reference).max() / max(numpy.abs(reference).max(), 1e-30)


def runs(folder):
    files = sorted(folder.glob("*.onnx"))
    assert len(files) > 60
    for file in files:
        yield file, json.loads(file.with_suffix(".json").read_text())


def test_checker(exported):
    for file, _ in runs(exported):
        onnx.checker.check_model(onnx.load(file), full_check=True)


def test_normalisation_is_folded(exported):
    for name in ["mobilenet_v1", "resnet18", "resnet18_small", "mobilenet_v2_blocks", "separable_1d", "u_net"]:
        operators = {node.op_type for node in onnx.load(exported / f"{name}_open.onnx").graph.node}
        assert "Conv" in operators and "BatchNormalization" not in operators, name


def test_recurrent_unit_is_one_node(exported):
    nodes = [node.op_type for node in onnx.load(exported / "gru_open.onnx").graph.node]
    assert nodes.count("GRU") == 1 and "Tanh" not in nodes


def test_hard_swish_is_one_node(exported):
    nodes = [node.op_type for node in onnx.load(exported / "hard_swish_fixed.onnx").graph.node]
    assert nodes == ["Conv", "HardSwish"]


def test_batch_is_open(exported):
    for file, _ in runs(exported):
        graph = onnx.load(file).graph
        first = graph.input[0].type.tensor_type.shape.dim[0]
        assert first.dim_param == ("batch" if file.stem.endswith("_open") else ""), file.name


def test_onnx_runtime(exported):
    for file, run in runs(exported):
        session = onnxruntime.InferenceSession(file, providers=["CPUExecutionProvider"])
        outputs = session.run(None, {"input": values(run["input"])})
        for output, reference in zip(outputs, run["outputs"], strict=True):
            assert apart(output, values(reference)) < 1e-4, file.name


def parameters(folder, name):
    """The parameters of a safetensors file: eight bytes of length, a JSON header, numbers."""
    data = (folder / f"{name}.safetensors").read_bytes()
    size = int.from_bytes(data[:8], "little")
    tensors = json.loads(data[8 : 8 + size])
    tensors.pop("__metadata__", None)
    for key, tensor in tensors.items():
        assert tensor["dtype"] == "F32"
        start, end = (8 + size + offset for offset in tensor["data_offsets"])
        yield key, numpy.frombuffer(data[start:end], numpy.float32).reshape(tensor["shape"])


def load(module, named):
    """Loads Burn's parameters into a PyTorch module: scales and shifts have other names, matrices lie the other way."""
    import torch

    names = {"gamma": "weight", "beta": "bias"}
    state = {}
    for key, value in named:
        path, _, last = key.rpartition(".")
        target = f"{path}.{names.get(last, last)}" if path else last
        if path == "fc" and last == "weight":
            value = value.T
        state[target] = torch.tensor(value)
    missing, unexpected = module.load_state_dict(state, strict=False)
    assert not unexpected and all(key.endswith("num_batches_tracked") for key in missing), (missing, unexpected)
    return module.eval()


def test_gru_is_that_of_pytorch(exported):
    torch = pytest.importorskip("torch")
    run = json.loads((exported / "gru_open.json").read_text())
    named = [(key[2:], value) for key, value in parameters(exported, "gru") if key.startswith("0.")]
    gru = load(torch.nn.GRU(5, 16, batch_first=True), named)
    with torch.no_grad():
        states, _ = gru(torch.tensor(values(run["input"])))
    assert apart(states.numpy(), values(run["outputs"][1])) < 1e-5


def test_resnet_is_that_of_pytorch(exported):
    torch = pytest.importorskip("torch")
    nn = torch.nn

    class Block(nn.Module):
        def __init__(self, channels, out, stride):
            super().__init__()
            self.conv1, self.bn1 = nn.Conv2d(channels, out, 3, stride, 1, bias=False), nn.BatchNorm2d(out)
            self.conv2, self.bn2 = nn.Conv2d(out, out, 3, 1, 1, bias=False), nn.BatchNorm2d(out)
            shortcut = [nn.Conv2d(channels, out, 1, stride, bias=False), nn.BatchNorm2d(out)]
            self.downsample = nn.Sequential(*shortcut) if stride != 1 or channels != out else None

        def forward(self, x):
            result = self.bn2(self.conv2(torch.relu(self.bn1(self.conv1(x)))))
            return torch.relu(result + (x if self.downsample is None else self.downsample(x)))

    class ResNet(nn.Module):
        def __init__(self, width):
            super().__init__()
            self.conv1, self.bn1 = nn.Conv2d(3, width, 7, 2, 3, bias=False), nn.BatchNorm2d(width)
            self.pool = nn.MaxPool2d(3, 2, 1)
            for index in range(4):
                channels, out = width << max(index - 1, 0), width << index
                blocks = [Block(channels, out, 1 if index == 0 else 2), Block(out, out, 1)]
                setattr(self, f"layer{index + 1}", nn.Sequential(*blocks))
            self.fc = nn.Linear(8 * width, 10)

        def forward(self, x):
            x = self.pool(torch.relu(self.bn1(self.conv1(x))))
            x = self.layer4(self.layer3(self.layer2(self.layer1(x))))
            return self.fc(x.mean((2, 3)))

    run = json.loads((exported / "resnet18_open.json").read_text())
    network = load(ResNet(16), parameters(exported, "resnet18"))
    with torch.no_grad():
        logits = network(torch.tensor(values(run["input"])))
    assert apart(logits.numpy(), values(run["outputs"][0])) < 1e-4
