#!/usr/bin/env python3
"""Imports TensorFlow Lite models and compares what they compute with TensorFlow Lite itself.

    compare_tflite.py [MODEL ...]

The .tflite models of the test data and those of PyPI's mediapipe go through the importer and run in ONNX Runtime and in
the built-in runtime, on a real image (sound for the key word model) and on random input. References: LiteRT, and the tf2onnx
conversions in the test data where there is one. Float models: largest difference allowed 1e-4 of the tensor's largest
magnitude. Quantised models: LiteRT rounds sums in its own way, so outputs may lie STEPS integers apart, and of label
maps the share DIFFERENT may differ; tf2onnx's conversions must agree exactly. Prints one line per model; exit status 1
when one fails.

OPENDR_TEST_DATA: folder with models/ and data/ (default: ../shared beside the project).
OPENDR_TEST_CACHE: folder that keeps the downloaded packages (default: a temporary one).
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import zipfile

from compare import DATA, examples, read_results, session, with_packages

PACKAGE, VERSION = "mediapipe", "0.10.9"
PYTHON = ["numpy", "onnxruntime", "opencv-python-headless", "ai-edge-litert"]
UNIT, SIGNED, RAW = (lambda x: x / 255), (lambda x: x / 127.5 - 1), (lambda x: x)
QUANTISED = lambda x: (x - 128) / 128

# Model: (tf2onnx conversion or None, image, how pixels 0..255 become input).
MODELS = {
    "classification/mobilenet_v2_1.0_224_quant": ("classification/mobilenet_v2_1.0_224_qdq", "chelsea.png", QUANTISED),
    "semantic_segmentation/deeplabv3_mnv2_pascal_quant": ("semantic_segmentation/deeplabv3_mnv2_pascal_513_qdq", "bus.jpg", QUANTISED),
    "semantic_segmentation/deeplabv3_mnv2_dm05_pascal_quant": (None, "bus.jpg", QUANTISED),
    "semantic_segmentation/deeplab_mobilenet_edgetpu_slim_cityscapes_quant": ("semantic_segmentation/deeplab_edgetpu_slim_cityscapes_513_qdq", "bus.jpg", QUANTISED),
    "facial_expression/fer_quantized_gray64": (None, "astronaut.png", SIGNED),
    "hand/gesture_keypoint/keypoint_classifier": (None, "", RAW),
    "hand/gesture_point_history/point_history_classifier": (None, "", RAW),
    "pose/movenet_lightning_ptq_192": (None, "zidane.jpg", RAW),
    "speech_commands/kws_ref_model": ("speech_commands/kws_dscnn_12", "", RAW),
    "mediapipe/face_detection_short_range": ("face_detection/blazeface_short_128", "astronaut.png", SIGNED),
    "mediapipe/face_landmark": ("facial_landmarks/face_mesh_468_192", "astronaut.png", UNIT),
    "mediapipe/iris_landmark": ("facial_landmarks/iris_64", "astronaut.png", UNIT),
    "mediapipe/hand_landmark_lite": ("hand/hand_landmark_lite_224", "astronaut.png", UNIT),
    "mediapipe/hand_landmark_full": (None, "astronaut.png", UNIT),
    "mediapipe/palm_detection_lite": ("hand/palm_detection_lite_192", "astronaut.png", UNIT),
    "mediapipe/palm_detection_full": (None, "astronaut.png", UNIT),
    "mediapipe/pose_landmark_full": ("pose/blazepose_landmark_full_256", "astronaut.png", UNIT),
    "mediapipe/hand_recrop": (None, "astronaut.png", UNIT),
    "mediapipe/selfie_segmentation": (None, "astronaut.png", UNIT),
    "mediapipe/selfie_segmentation_landscape": (None, "astronaut.png", UNIT),
}
# LiteRT lacks an operator of MediaPipe's in these; it runs them with its own transposed convolution in that place.
OWN_OPERATOR = {"mediapipe/selfie_segmentation", "mediapipe/selfie_segmentation_landscape"}
# Activations of these are quantised in LiteRT as it runs, by their largest value, which ONNX does not do.
DYNAMIC = {"facial_expression/fer_quantized_gray64": 0.05}
# The logits of one output reach 1900, in a sum of parts that large.
STEEP = {"mediapipe/pose_landmark_full": 1e-3}
# Rounding grows in this one until LiteRT's own kernels lie 0.4 apart, 0.04 on average: the average is compared.
NOISY = {"pose/movenet_lightning_ptq_192": 0.06}
# Largest difference of quantised outputs (a step before the softmax is several after it), and share of positions of a
# label map.
STEPS, DIFFERENT = 6, 0.04
# Refused, with this in the message.
REFUSED = {
    "mediapipe/face_landmark_with_attention": "Landmarks2TransformMatrix",
    "mediapipe/pose_detection": "sparse weights",
    "mediapipe/face_detection_full_range_sparse": "sparse weights",
}


def mediapipe_folder(cache):
    folder = cache / f"{PACKAGE}-{VERSION}"
    if not folder.exists():
        with tempfile.TemporaryDirectory(dir=cache) as work:
            wheel = ["--no-deps", "--only-binary=:all:", "--python-version=3.11", "--platform=manylinux2014_x86_64"]
            command = [sys.executable, "-m", "pip", "download", "-q", *wheel, f"{PACKAGE}=={VERSION}", "-d", work]
            subprocess.run(command, check=True)
            (archive,) = pathlib.Path(work).glob("*.whl")
            unpacked = pathlib.Path(work) / "models"
            unpacked.mkdir()
            with zipfile.ZipFile(archive) as wheel:
                for member in wheel.namelist():
                    if member.endswith(".tflite"):
                        (unpacked / pathlib.PurePath(member).name).write_bytes(wheel.read(member))
            os.rename(unpacked, folder)
    return folder


def with_own_operator(path, work):
    """The model with LiteRT's transposed convolution in place of MediaPipe's."""
    import flatbuffers
    import numpy as np
    from ai_edge_litert import schema_py_generated as schema

    model = schema.ModelT.InitFromObj(schema.Model.GetRootAsModel(path.read_bytes(), 0))
    graph, number = model.subgraphs[0], schema.BuiltinOperator.TRANSPOSE_CONV
    for index, code in enumerate(model.operatorCodes):
        if code.customCode != b"Convolution2DTransposeBias":
            continue
        code.customCode, code.builtinCode, code.deprecatedBuiltinCode, code.version = None, number, number, 3
        for operator in (operator for operator in graph.operators if operator.opcodeIndex == index):
            padding, width, height = np.frombuffer(bytes(operator.customOptions), np.int32)[:3]
            image, weights, bias = operator.inputs
            shape, buffer = schema.TensorT(), schema.BufferT()
            buffer.data = np.array(graph.tensors[operator.outputs[0]].shape, np.int32).tobytes()
            shape.name, shape.shape, shape.type, shape.buffer = "size", [4], schema.TensorType.INT32, len(model.buffers)
            model.buffers.append(buffer)
            graph.tensors.append(shape)
            operator.inputs, operator.customOptions = [len(graph.tensors) - 1, weights, image, bias], None
            operator.builtinOptionsType = schema.BuiltinOptions.TransposeConvOptions
            options = schema.TransposeConvOptionsT()
            options.padding, options.strideW, options.strideH = int(padding) - 1, int(width), int(height)
            operator.builtinOptions = options
    builder = flatbuffers.Builder()
    builder.Finish(model.Pack(builder), b"TFL3")
    changed = work / "changed.tflite"
    changed.write_bytes(builder.Output())
    return changed


class Reference:
    """A model in LiteRT: takes and gives the real numbers for which quantised integers stand."""

    def __init__(self, np, path):
        from ai_edge_litert.interpreter import Interpreter

        self.np, self.interpreter = np, Interpreter(str(path), num_threads=2)
        (self.input,) = self.interpreter.get_input_details()
        self.outputs = self.interpreter.get_output_details()
        self.dims = [int(dim) for dim in self.input["shape"]]

    def stored(self, image):
        """Returns the random input of the model."""
        np, (scale, zero) = self.np, self.input["quantization"]
        if scale:
            limits = np.iinfo(self.input["dtype"])
            image = np.clip(np.round(image / np.float32(scale)) + zero, limits.min, limits.max)
        return image.astype(self.input["dtype"])

    def run(self, image):
        """Outputs by name, and the size of a step of quantised ones."""
        self.interpreter.allocate_tensors()
        self.interpreter.set_tensor(self.input["index"], self.stored(image))
        self.interpreter.invoke()
        results = {}
        for output in self.outputs:
            scale, zero = output["quantization"]
            value = self.interpreter.get_tensor(output["index"]).astype(self.np.float32)
            results[output["name"].removesuffix(":0")] = ((value - zero) * scale if scale else value, scale)
        return results


def inputs(np, cv2, name, reference):
    """Returns inputs by kind, channels-last, in the model's range."""
    _, picture, scale = MODELS[name]
    random, dims = np.random.default_rng(0), reference.dims
    if not picture:
        step, zero = reference.input["quantization"]
        spread = (random.integers(-128, 128, dims) - zero) * step if step else random.uniform(-1, 1, dims)
        return {"random": spread.astype(np.float32)}
    kinds = {"random": random.integers(0, 256, dims[1:3] + [3]).astype(np.float32)}
    read = cv2.imread(str(DATA / "data/photos" / picture))
    if read is not None:
        kinds["picture"] = cv2.cvtColor(cv2.resize(read, (dims[2], dims[1])), cv2.COLOR_BGR2RGB).astype(np.float32)
    for kind, image in kinds.items():
        image = image.mean(-1, keepdims=True).round() if dims[3] == 1 else image
        kinds[kind] = np.ascontiguousarray(scale(image)[None], np.float32)
    return kinds


def like(own, wanted):
    return own.transpose(0, 2, 3, 1) if own.ndim == 4 and own.shape != wanted.shape else own


def difference(np, own, wanted, step, allowed, single):
    """How far apart two results are, in steps, labels or parts of the magnitude; whether that is too far; as a number."""
    own = like(own, wanted)
    if own.shape != wanted.shape:
        return f"shape {own.shape} instead of {wanted.shape}", True, np.inf
    if step:
        apart = np.abs(own - wanted).max() / step
        return f"{apart:.1f} steps", apart > allowed[0] + 0.01, apart
    if single:
        share = float((own != wanted).mean())
        return f"{share:.2%} of labels", share > allowed[1], share
    if len(allowed) == 4:
        apart = np.abs(own - wanted).mean()
        return f"{apart:.1e} on average", not apart <= allowed[3], apart
    apart = np.abs(own - wanted).max() / max(np.abs(wanted).max(), 1e-3)
    return f"{apart:.1e}", not apart <= allowed[2], apart


def conversion(np, name, reference, image):
    """What tf2onnx's conversion computes, as LiteRT gives it; nothing when there is none."""
    path = DATA / "models" / f"{MODELS[name][0]}.onnx"
    if not MODELS[name][0] or not path.exists():
        return {}
    runner = session(path)
    (port,) = runner.get_inputs()
    own = reference.stored(image)
    own = own if list(port.shape)[1:] == reference.dims[1:] else own.transpose(0, 3, 1, 2)
    names = [output.name.removesuffix(":0") for output in runner.get_outputs()]
    results, wanted = dict(zip(names, runner.run(None, {port.name: own}))), {}
    for output in reference.outputs:
        key, (scale, zero) = output["name"].removesuffix(":0"), output["quantization"]
        if key in results:
            value = results[key].astype(np.float32)
            wanted[key] = ((value - zero) * scale if scale else value, scale)
    return wanted


def check(np, cv2, name, path, programs, work):
    """Compares one model in both runtimes with its references; prints a line, returns whether it passed."""
    onnx = work / "model.onnx"
    imported = subprocess.run([programs["tflite_to_onnx"], path, onnx], capture_output=True, text=True)
    if name in REFUSED:
        refused = imported.returncode != 0 and REFUSED[name] in imported.stderr
        print(f"{name:70} {'refused' if refused else 'FAILED  should be refused'}: {imported.stderr.strip()}", flush=True)
        return refused
    if imported.returncode:
        print(f"{name:70} FAILED  {imported.stderr.strip()}", flush=True)
        return False
    reference = Reference(np, with_own_operator(path, work) if name in OWN_OPERATOR else path)
    runner = session(onnx)
    (port,) = runner.get_inputs()
    said, failed = [], False
    for kind, image in inputs(np, cv2, name, reference).items():
        stored = np.ascontiguousarray(image.transpose(0, 3, 1, 2)) if image.ndim == 4 else image
        names = [output.name for output in runner.get_outputs()]
        by_onnx_runtime = dict(zip(names, runner.run(None, {port.name: stored})))
        stored.tofile(work / "input.bin")
        command = [programs["run_onnx"], onnx, work / "input.bin", ",".join(map(str, stored.shape)), work / "builtin"]
        ran = subprocess.run(command, capture_output=True, text=True)
        if ran.returncode:
            print(f"{name:70} FAILED  built-in runtime: {ran.stderr.strip()}", flush=True)
            return False
        by_builtin = read_results(np, work / "builtin")
        litert = reference.run(image)
        steps = {key: step for key, (_, step) in litert.items()}
        near = (STEPS, DIFFERENT, DYNAMIC.get(name, STEEP.get(name, 1e-4)), *([NOISY[name]] if name in NOISY else []))
        labels = all(output.type == "tensor(int64)" for output in runner.get_outputs())
        for who, own, wanted, allowed in [
            ("ONNX Runtime and LiteRT", by_onnx_runtime, litert, near),
            ("ONNX Runtime and tf2onnx", by_onnx_runtime, conversion(np, name, reference, image), (0, 0, 1e-5)),
            ("built-in runtime and ONNX Runtime", by_builtin, {key: (value, steps.get(key)) for key, value in by_onnx_runtime.items()}, near),
        ]:
            found = [difference(np, own[key], value, step, allowed, labels) for key, (value, step) in wanted.items()]
            failed |= any(too_far for _, too_far, _ in found)
            for text, too_far, _ in sorted(found, key=lambda one: one[1:])[-1:]:
                said.append(f"{who} {text}{' (TOO FAR)' if too_far else ''} on {kind}")
    print(f"{name:70} {'FAILED' if failed else 'ok'}: {'; '.join(said)}", flush=True)
    return not failed


def main():
    temporary = tempfile.TemporaryDirectory()
    cache = pathlib.Path(os.environ.get("OPENDR_TEST_CACHE", temporary.name)).resolve()
    cache.mkdir(parents=True, exist_ok=True)
    with_packages(cache, PYTHON)
    import cv2
    import numpy as np

    folder = mediapipe_folder(cache)
    programs = examples()
    passed = []
    with tempfile.TemporaryDirectory() as work:
        for name in sys.argv[1:] or [*MODELS, *REFUSED]:
            place = folder if name.startswith("mediapipe/") else DATA / "models" / pathlib.Path(name).parent
            path = place / f"{pathlib.Path(name).name}.tflite"
            passed.append(check(np, cv2, name, path, programs, pathlib.Path(work)))
    print(f"{sum(passed)} of {len(passed)} models agree")
    return 0 if all(passed) else 1


if __name__ == "__main__":
    sys.exit(main())
