"""Programs for OpenDR 3.0's C API, one for each of its headers, as C and as C++."""

import json
import shutil
import subprocess

import numpy
import onnx
import onnxruntime
import pytest
from onnx import TensorProto, helper, numpy_helper

from conftest import ROOT

PROGRAMS = ROOT / "bindings/c/tests/opendr"
WEIGHTS = ROOT / "models/weights"
LANGUAGES = ["c11", "c++17"]
languages = pytest.mark.parametrize("language", LANGUAGES)


@pytest.fixture
def build(compiler):
    """Builds a program of OpenDR, which finds its headers by their bare names."""
    return lambda name, language: compiler.build(PROGRAMS / f"{name}.c", package="opendr-compat", language=language)


def printed(output):
    """The tensors that print_tensors.h prints: five sizes, the first numbers and the mean."""
    lines = [line.split(":") for line in output.decode().splitlines() if ":" in line]
    return [([int(size) for size in sizes.split()], [float(number) for number in numbers.split()]) for sizes, numbers in lines]


def sizes(shape):
    """The five sizes of a shape, as docs/c.md says."""
    if len(shape) == 4:
        return [shape[0], 1, *shape[1:]]
    return [1] * (5 - len(shape)) + list(shape)


def expected(model, shape):
    """What ONNX Runtime gives for an input of this shape with the numbers of print_tensors.h."""
    numbers = (numpy.arange(numpy.prod(shape)) % 8 / 8).astype(numpy.float32).reshape(shape)
    session = onnxruntime.InferenceSession(str(model), providers=["CPUExecutionProvider"])
    outputs = session.run(None, {session.get_inputs()[0].name: numbers})
    return [(sizes(output.shape), [*output.ravel()[:4].tolist(), float(output.mean())]) for output in outputs]


def check_outputs(done, model, shape):
    outputs, wanted = printed(done.stdout), expected(model, shape)
    assert [size for size, _ in outputs] == [size for size, _ in wanted]
    for (_, found), (_, right) in zip(outputs, wanted):
        assert found == pytest.approx(right, rel=1e-3, abs=1e-4)


def linear(path, name, shape, outputs):
    """Writes a network: the mean of the input's numbers past the first axis, weighted for each of the outputs."""
    rows, nodes, constants = shape[0], [], []
    nodes.append(helper.make_node("Flatten", [name], ["flat"], axis=1))
    nodes.append(helper.make_node("ReduceMean", ["flat"], ["mean"], axes=[1], keepdims=1))
    for output, dims in outputs.items():
        count = int(numpy.prod(dims)) // rows
        weights = numpy.linspace(-1, 2, count, dtype=numpy.float32).reshape(1, count)
        constants += [numpy_helper.from_array(weights, f"{output}_weights"),
                      numpy_helper.from_array(numpy.array(dims, dtype=numpy.int64), f"{output}_shape")]
        nodes.append(helper.make_node("MatMul", ["mean", f"{output}_weights"], [f"{output}_flat"]))
        nodes.append(helper.make_node("Reshape", [f"{output}_flat", f"{output}_shape"], [output]))
    tensor = helper.make_tensor_value_info
    graph = helper.make_graph(nodes, "linear", [tensor(name, TensorProto.FLOAT, shape)],
                              [tensor(output, TensorProto.FLOAT, dims) for output, dims in outputs.items()], constants)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], ir_version=8)
    onnx.checker.check_model(model)
    onnx.save(model, path)


def opendr_folder(folder, json_name, onnx_name, inference_params, **more):
    """The JSON that OpenDR writes beside its ONNX file."""
    folder.mkdir(exist_ok=True)
    metadata = {"model_paths": [onnx_name], "framework": "pytorch", "format": "onnx", "has_data": False, "optimized": True,
                "optimizer_info": {}, "inference_params": inference_params, **more}
    (folder / json_name).write_text(json.dumps(metadata))


@languages
def test_every_name_is_declared(compiler, build, language):
    assert compiler.run(build("names", language)).stdout == b"57 functions\n"


def test_headers_have_no_place_among_those_of_the_system(prefix):
    assert not (prefix / "include/data.h").exists() and (prefix / "include/opendr/data.h").is_file()


@pytest.mark.parametrize("header", sorted(path.name for path in (ROOT / "bindings/c/include/opendr").glob("*.h")))
@languages
def test_a_header_is_enough(compiler, header, language):
    source = compiler.write(f"alone_{header}.c", f"#include <opendr/{header}>\nint main(void) {{ return 0; }}\n")
    compiler.run(compiler.build(source, language=language))


def test_cmake_finds_the_headers(compiler, tmp_path):
    configure = ["cmake", "-S", ROOT / "tests/c/cmake", "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={compiler.prefix}"]
    subprocess.run([*configure, f"-DEXAMPLES={ROOT / 'bindings/c/examples'}", f"-DOPENDR={PROGRAMS}"], check=True,
                   capture_output=True)
    subprocess.run(["cmake", "--build", tmp_path, "--target", "names"], check=True, capture_output=True)
    compiler.run(tmp_path / "names")


@pytest.mark.parametrize(("language", "valgrind"), [("c11", False), ("c++17", False), ("c11", True)])
def test_utils(compiler, build, shared, language, valgrind):
    compiler.run(build("opendr_utils", language), shared / "data/photos/bus.jpg", valgrind=valgrind)


@languages
def test_nanodet(compiler, build, shared, tmp_path, language):
    seen = tmp_path / "seen.png"
    done = compiler.run(build("object_detection_2d_nanodet_jit", language), shared / "data/photos/bus.jpg", seen)
    names = [line.split()[0] for line in done.stdout.decode().splitlines()]
    assert names.count("0") >= 3 and "5" in names, names
    assert seen.stat().st_size > 100_000


@languages
def test_x3d(compiler, build, language):
    network = WEIGHTS / "x3d/stick_figures.onnx"
    program = build("activity_recognition_x3d", language)
    for model in [network, ""]:
        check_outputs(compiler.run(program, model), network, [8, 3, 48, 48])


def test_x3d_with_a_batch(compiler, build, tmp_path):
    """OpenDR's own networks have five axes, channels before frames."""
    linear(tmp_path / "x3d_xs.onnx", "video", [1, 3, 4, 16, 16], {"classes": [1, 400]})
    done = compiler.run(build("activity_recognition_x3d", "c11"), tmp_path / "x3d_xs.onnx")
    check_outputs(done, tmp_path / "x3d_xs.onnx", [1, 3, 4, 16, 16])


@languages
def test_deep_sort(compiler, build, shared, language):
    network = shared / "models/person_reid/osnet_x0_25_msmt17.onnx"
    program = build("object_tracking_2d_deep_sort", language)
    for model in [network, ""]:
        check_outputs(compiler.run(program, model), network, [1, 3, 256, 128])


@languages
def test_lightweight_open_pose(compiler, build, shared, language):
    network = WEIGHTS / "lightweight_open_pose/openpose_default.onnx"
    program = build("lightweight_open_pose", language)
    for model in [network, ""]:
        done = compiler.run(program, model, shared / "data/photos/zidane.jpg")
        check_outputs(done, network, [1, 3, 256, 256])


@pytest.mark.parametrize(("language", "valgrind"), [("c11", False), ("c++17", False), ("c11", True)])
def test_detr(compiler, build, tmp_path, language, valgrind):
    folder = tmp_path / "detr"
    opendr_folder(folder, "detr.json", "detr.onnx", {"threshold": 0.7})
    shape = [1, 3, 16, 16]
    linear(folder / "detr.onnx", "data", shape, {"pred_logits": [1, 5, 7], "pred_boxes": [1, 5, 4]})
    program = build("object_detection_2d_detr", language)
    quiet = {"OPENDR_RUNTIME": "builtin", "OPENDR_THREADS": "1"} if valgrind else {}
    for model, threshold in [(folder, b"0.7"), (folder / "detr.onnx", b"0")]:
        done = compiler.run(program, model, valgrind=valgrind, **quiet)
        check_outputs(done, folder / "detr.onnx", shape)
        assert done.stdout.split()[0] == threshold


@languages
def test_pst(compiler, build, tmp_path, language):
    network, shape = tmp_path / "pst.onnx", [2, 2, 30, 18, 2]
    linear(network, "onnx_input", shape, {"onnx_output": [2, 60]})
    check_outputs(compiler.run(build("skeleton_based_action_recognition_pst", language), network), network, shape)


@languages
def test_yolov5(compiler, build, shared, tmp_path, language):
    for name, size in [("s", [64, 32]), ("m", ["height", "width"])]:
        params = {"conf_threshold": 0.25, "iou_threshold": 0.45, "input_size": [416, 320]}
        opendr_folder(tmp_path, f"yolov5{name}.json", f"yolov5{name}.onnx", params, classes=["cat", "dog"])
        linear(tmp_path / f"yolov5{name}.onnx", "images", [1, 3, *size], {"output": [1, 10, 7]})
    compiler.run(build("object_detection_2d_yolov5", language), tmp_path, shared / "data/photos/bus.jpg")


@languages
def test_face_recognition(compiler, build, shared, tmp_path, language):
    pictures = shared / "data/face_verification"
    people, persons = tmp_path / "people", {"one": ["img1", "img2"], 'a "second" \\ one': ["img3"], "third": ["img20"]}
    for person, names in persons.items():
        (people / person).mkdir(parents=True)
        for name in names:
            shutil.copy(pictures / f"{name}.jpg", people / person)
    (people / "third/broken.jpg").write_bytes(b"no picture")
    program, database = build("face_recognition", language), tmp_path / 'data "base" \\ 1.dat'
    # A reference, other images of each person, an unknown person, no face.
    given = [pictures / f"{name}.jpg" for name in ["img1", "img4", "img12", "img21", "img16"]]
    given.append(shared / "data/photos/coffee.png")
    for _ in range(2):
        done = compiler.run(program, people, database, *given)
        lines = [line.split(" ", 2) for line in done.stdout.decode().splitlines()]
        names = sorted(persons)
        assert [line[2] for line in lines] == ["one", "one", 'a "second" \\ one', "third", "", ""]
        assert [int(line[0]) for line in lines] == [*(names.index(line[2]) for line in lines[:4]), -1, -1]
        assert float(lines[0][1]) > 0.99 and float(lines[-1][1]) == 0.0
    assert (database / "model/model.json").is_file()
