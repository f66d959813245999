"""OpenDR 3.0's names, arguments and programs: the table is complete and correct."""

import ast
import importlib
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import opendr
import opendr._upstream
import pytest
from opendr._upstream.arguments import METHODS
from opendr._upstream.modules import TASKS, names_of, rows
from opendr._upstream.reasons import REASONS
from opendr._upstream.rows import Absent, arguments
from opendr.engine.learners import BaseLearner

PROGRAMS = Path(__file__).parent / "upstream"
NAMES = [
    (".".join(filter(None, ("opendr", task, path))), name, home)
    for task in TASKS
    for path, names in rows(task).MODULES.items()
    for name, home in names.items()
]
LEARNERS = {name: (task, row) for task in TASKS for name, row in getattr(rows(task), "LEARNERS", {}).items()}
#: Hand-written methods, whose order of arguments is not in the table; `differs` describes their interface.
BY_HAND = {
    "FacialEmotionLearner": {"fit", "eval", "load"},
    "ObjectTracking2DDeepSortLearner": {"infer"},
    "Seq2SeqNMSLearner": {"infer"},
    "WhisperLearner": {"fit", "load"},
    "EdgeSpeechNetsLearner": {"optimize"},
}


def learner(name):
    return getattr(importlib.import_module(f"opendr.{LEARNERS[name][0]}"), name)


@pytest.mark.parametrize(("module", "name", "home"), NAMES, ids=lambda value: value if isinstance(value, str) else "")
def test_every_name_is_there(module, name, home):
    value = getattr(importlib.import_module(module), name)
    namespace = {}
    exec(f"from {module} import {name}", namespace)
    assert namespace[name] is value
    if isinstance(home, Absent):
        with pytest.raises(opendr.Unsupported, match=re.escape(f"{name} is not available yet; {home.use}")):
            value(1, device="cpu")
        for use in (iter, len, lambda value: value["x"], lambda value: value.download("x")):
            with pytest.raises(opendr.Unsupported):
                use(value)
        assert not hasattr(value, "download")
    elif home == "":
        assert value is learner(name) and value.__module__ == f"opendr.{LEARNERS[name][0]}"


def test_names_are_in_the_packages_above_too():
    from opendr.perception import object_detection_2d
    from opendr.perception.object_detection_2d.nms import ClusterNMS

    assert object_detection_2d.ClusterNMS is ClusterNMS
    assert "ClusterNMS" in object_detection_2d.__all__ and "ClusterNMS" in dir(object_detection_2d.nms)
    with pytest.raises(ImportError):
        from opendr.perception.object_detection_2d import NoSuchLearner  # noqa: F401
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("opendr.perception.object_detection_2d.no_such_module")
    assert names_of("opendr.perception.object_detection_2d.no_such_module") == {}
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("opendr.no_such_package.module")


def test_modules_alone_import_no_numpy():
    program = "import sys, opendr.perception.object_detection_2d.ssd.ssd_learner; assert 'numpy' not in sys.modules"
    subprocess.run([sys.executable, "-c", program], check=True)


@pytest.mark.parametrize("name", LEARNERS)
def test_every_argument_is_known(name):
    cls, row = learner(name), LEARNERS[name][1]
    entry, parent = cls._entry, cls.__mro__[1]
    fit = {key for field in entry["fit_params"] for key in (field["name"], *field["aliases"])}
    live = {key for field in entry["params"] if field["live"] for key in (field["name"], *field["aliases"])}
    own = {key for field in entry["params"] for key in (field["name"], *field["aliases"])}
    idle = {key for key, _ in entry["without_effect"]}
    known = {
        "init": own | fit | idle | {*BaseLearner.__signature__.parameters, "pose_estimator", "env", "path", "object_name", "data_directory"},
        "infer": {port["name"] for port in entry["ports"]} | live | idle,
        "fit": fit | idle,
        "eval": live | {"silent", "use_subset", "subset_size"},
        "load": {"model_name"},
    }
    for method in ("init", *METHODS):
        there = known.get(method, set())
        if method != "init":
            there = there | inspect.signature(getattr(parent, method)).parameters.keys()
        options = "options" in there
        wanted = [argument.ours for argument in arguments(getattr(row, method)) if argument.ours is not None]
        assert options or set(wanted) <= there, f"{name}.{method}: {set(wanted) - there}"
    places = [argument.name for argument in arguments(row.init)]
    assert places == list(inspect.signature(cls).parameters)[: len(places)]
    for argument in arguments(row.init):
        if argument.ours is None:
            assert argument.name not in own | fit, f"{name} knows {argument.name}, the table has a reason"
    for method, instead in row.methods.items():
        assert hasattr(cls, method)
        if instead:
            with pytest.raises(opendr.Unsupported, match=re.escape(instead)):
                cls(device="cpu").__getattribute__(method)(1, name=2)


def test_every_reason_is_used():
    source = "".join(path.read_text("utf-8") for path in Path(opendr._upstream.__file__).parent.rglob("*.py"))
    assert [reason for reason in REASONS if not re.search(rf"!{reason}\b", source)] == []


def signatures(text):
    """The signatures of a block of the inventory: `{class: {method: arguments with their defaults}}`, `__init__` among
    them."""
    found, cls = {}, None
    for match in re.finditer(r"^(?:@static )?(\w+)\(", text, re.MULTILINE):
        depth, end = 1, match.end()
        quote = None
        while depth:
            letter = text[end]
            if quote:
                quote = None if letter == quote and text[end - 1] != "\\" else quote
            elif letter in "'\"":
                quote = letter
            else:
                depth += (letter in "([{") - (letter in ")]}")
            end += 1
        inside = " ".join(text[match.end() : end - 1].split())
        tree = ast.parse(f"def call({inside}): pass").body[0].args
        names = [argument.arg for argument in (*tree.posonlyargs, *tree.args)]
        defaults = [None] * (len(names) - len(tree.defaults)) + [literal(default) for default in tree.defaults]
        name = match[1]
        if name[0].isupper():
            cls, name = name, "__init__"
        found.setdefault(cls, {})[name] = dict(zip(names, defaults))
    return found


def literal(default):
    try:
        return ast.literal_eval(default)
    except ValueError:
        return None


@pytest.fixture(scope="module")
def inventory(test_data):
    path = test_data / "reference/upstream.md"
    if not path.is_file():
        pytest.skip(f"no {path}")
    text = path.read_text("utf-8")
    section = text[text.index("## 3. Signatures") : text.index("### Learners outside")]
    found = {}
    for block in re.findall(r"^```python\n(.*?)^```$", section, re.DOTALL | re.MULTILINE):
        found.update(signatures(block))
    return found


def test_the_table_is_the_inventory(inventory):
    """Every class, method and positional argument of OpenDR's sources is in the table, in order."""
    assert len(inventory) >= 50
    places = {name: (module, home) for module, name, home in NAMES}
    wrong = []
    for name, methods in inventory.items():
        assert name in places, name
        module, home = places[name]
        value = getattr(importlib.import_module(module), name)
        if isinstance(home, Absent):
            continue
        for method, names in methods.items():
            if method in BY_HAND.get(name, ()):
                continue
            signature = inspect.signature(value if method == "__init__" else getattr(value, method, lambda: None))
            given = [key for key in signature.parameters if key != "self"][: len(names)]
            if given != list(names) and not (name in LEARNERS and LEARNERS[name][1].methods.get(method)):
                wrong.append(f"{name}.{method}: {list(names)} is {given}")
    assert not wrong, "\n".join(wrong)


#: Arguments of OpenDR's constructors without defaults.
REQUIRED = {
    "MultilinearCompressiveLearner": {
        "input_shape": (32, 32, 3),
        "compressed_shape": (20, 19, 2),
        "backbone": "cifar_allcnn",
        "n_class": 10,
    },
    "GatedRecurrentUnitLearner": {"in_channels": 1, "series_length": 9000, "n_class": 4},
    "AttentionNeuralBagOfFeatureLearner": {"in_channels": 1, "series_length": 9000, "n_class": 4},
    "RgbdHandGestureLearner": {"n_class": 16, "architecture": "mobilenet_v2"},
    "VoxelObjectDetection3DLearner": {"model_config_path": "configs/tanet_car.proto"},
    "ObjectTracking3DVpitLearner": {"model_config_path": "configs/pointpillars_car.proto"},
    "EfficientPsLearner": {"config_file": "singlegpu_cityscapes.py"},
    "EfficientLpsLearner": {"config_file": "singlegpu_semantickitti.py"},
}


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_defaults_of_opendr_are_taken_by_place(inventory):
    wrong = []
    for name in LEARNERS:
        if "__init__" not in inventory.get(name, ()):
            continue
        given = {**REQUIRED.get(name, {}), "device": "cpu"}
        values = {key: given.get(key, value) for key, value in inventory[name]["__init__"].items()}
        try:
            made = learner(name)(*values.values())
        except (TypeError, ValueError) as error:
            wrong.append(f"{name}: {error}")
        else:
            assert "device" not in values or made.device == "cpu"
    assert not wrong, "\n".join(wrong)


#: OpenDR's constructors of the engine and of data sets.
CONSTRUCTORS = {
    "engine.data": {
        **dict.fromkeys(("PointCloud", "SkeletonSequence", "Timeseries", "Vector", "Video"), "data"),
        "Image": "data dtype guess_format",
        "ImageWithDetections": "image boundingBoxList",
        "PointCloudWithCalibration": "data calib image_shape",
    },
    "engine.target": {
        "BaseTranscription": "text",
        "BoundingBox": "name left top width height score",
        "BoundingBox3D": "name truncated occluded alpha bbox2d dimensions location rotation_y score",
        "BoundingBox3DList": "bounding_boxes_3d",
        "BoundingBoxList": "boxes image_id",
        "Category": "prediction description confidence",
        "CocoBoundingBox": "name left top width height segmentation area iscrowd score",
        "Heatmap": "data class_names",
        "Keypoint": "keypoint confidence",
        "Pose": "keypoints confidence",
        "TrackingAnnotation": "name left top width height id score frame",
        "TrackingAnnotation3D": "name truncated occluded alpha bbox2d dimensions location rotation_y id score frame",
        "TrackingAnnotation3DList": "annotations_3d",
        "TrackingAnnotationList": "annotations",
        "VoskTranscription": "text accept_waveform",
        "WhisperTranscription": "text segments",
    },
    "engine.datasets": {
        "ExternalDataset": "path dataset_type",
        "MappedDatasetIterator": "original map_function",
        "PointCloudsDatasetIterator": "path num_point_features",
    },
    "perception.object_detection_2d.datasets": {
        "ConcatDataset": "datasets",
        "DetectionDataset": "classes dataset_type root image_paths splits image_transform target_transform transform",
        "WiderFaceDataset": "root splits ignore_tiny image_transform target_transform transform",
        "WiderPersonDataset": "root splits image_transform target_transform transform",
        "XMLBasedDataset": "dataset_type root classes image_transform target_transform transform splits images_dir"
        " annotations_dir preload_anno",
    },
    "perception.object_detection_2d.datasets.detection_dataset": {"MappedDetectionDataset": "data map_function"},
    "perception.object_detection_2d.datasets.transforms": {"ResizeImageAndBoxesTransform": "w h"},
    "perception.object_detection_2d.utils.class_filter_wrapper": {"FilteredLearnerWrapper": "learner allowed_classes"},
    "perception.object_tracking_2d": {
        "Market1501Dataset": "path",
        "Market1501DatasetIterator": "path",
        "MotDataset": "path",
        "MotDatasetIterator": "root paths",
        "RawMotDatasetIterator": "root paths",
        "RawMotWithDetectionsDatasetIterator": "root paths",
    },
    "perception.object_detection_3d": {
        "KittiDataset": "path kitti_subsets_path",
        "LabeledPointCloudsDatasetIterator": "lidar_path label_path calib_path image_path num_point_features",
    },
    "perception.object_tracking_3d": {
        "KittiTrackingDatasetIterator": "inputs_path ground_truths_path inputs_format",
        "LabeledTrackingPointCloudsDatasetIterator": "lidar_path label_path calib_path image_path labels_format"
        " num_point_features",
    },
    "perception.semantic_segmentation": {"CamVidDataset": "path scale mode"},
    "perception.panoptic_segmentation": {
        "CityscapesDataset": "path",
        "KittiDataset": "path",
        "SemanticKittiDataset": "path split",
    },
    "perception.binary_high_resolution": {
        "HighResolutionDataset": "dataset_folder patch_size non_zero_threshold transform",
    },
    "perception.pose_estimation": dict.fromkeys(("CocoTrainDataset", "CocoValDataset"), "labels images_folder"),
    "perception.fall_detection": {"URFallDatasetIterator": "data labels"},
    "perception.activity_recognition": {
        "DummyTimeseriesDataset": "num_sines num_datapoints base_offset sequence_len",
        "KineticsDataset": "path frames_per_clip step_between_clips temporal_downsampling split video_transform"
        " use_caching decoder_backend spatial_pixels",
    },
    "perception.heart_anomaly_detection.gated_recurrent_unit.algorithm.data": {"Dataset": "x y"},
    "utils.hyperparameter_tuner": {"HyperparameterTuner": "learner_class study"},
    "utils.ambiguity_measure": {"AmbiguityMeasure": "threshold temperature"},
}
#: OpenDR's attributes and methods of classes.
ATTRIBUTES = {
    "engine.data": {"Image": "data numpy opencv convert open", "PointCloud": "data numpy", "Video": "data numpy"},
    "engine.target": {
        "BoundingBox": "mot coco data confidence action",
        "BoundingBox3D": "kitti name truncated occluded alpha bbox2d dimensions location rotation_y data",
        "BoundingBox3DList": "kitti from_kitti add_box boxes",
        "BoundingBoxList": "mot coco from_coco add_box boxes",
        "Category": "data confidence action",
        "Heatmap": "data class_names numpy opencv shape",
        "Keypoint": "data",
        "Pose": "data",
        "TrackingAnnotation": "mot from_mot bounding_box",
        "TrackingAnnotation3D": "kitti id frame bounding_box_3d action",
        "TrackingAnnotation3DList": "kitti from_kitti bounding_box_3d_list add_annotation boxes",
        "TrackingAnnotationList": "mot from_mot bounding_box_list add_annotation boxes",
    },
    "engine.learners": {
        "Learner": "fit eval infer save load optimize reset get_hyperparameters get_objective_function model "
        + " ".join(BaseLearner.__signature__.parameters),
    },
    "perception.object_detection_2d": {
        "DetectionDataset": "set_transform transform set_image_transform set_target_transform get_image get_bboxes"
        " num_classes",
    },
    "perception.panoptic_segmentation": {
        "CityscapesDataset": "evaluate prepare_data",
        "KittiDataset": "evaluate prepare_data",
        "SemanticKittiDataset": "evaluate prepare_data",
    },
    "perception.object_tracking_2d": {
        "Market1501Dataset": "download download_nano_market1501",
        "MotDataset": "download download_nano_mot20",
    },
    "perception.object_detection_3d": {"KittiDataset": "download download_mini_kitti download_nano_kitti"},
    "perception.object_tracking_3d": {
        "KittiTrackingDatasetIterator": "download download_labels",
        "LabeledTrackingPointCloudsDatasetIterator": "download download_pico_kitti",
    },
    "perception.semantic_segmentation": {"CamVidDataset": "download_data"},
    "perception.activity_recognition": {"KineticsDataset": "download_mini download_micro"},
    "utils.hyperparameter_tuner": {"HyperparameterTuner": "optimize study"},
}


@pytest.mark.parametrize("module", CONSTRUCTORS)
def test_constructors_are_opendrs(module):
    for name, wanted in CONSTRUCTORS[module].items():
        cls = getattr(importlib.import_module(f"opendr.{module}"), name)
        names = [key for key, parameter in inspect.signature(cls).parameters.items() if parameter.kind <= 1]
        assert names[: len(wanted.split())] == wanted.split(), name


@pytest.mark.parametrize("module", ATTRIBUTES)
def test_attributes_are_opendrs(module):
    for name, wanted in ATTRIBUTES[module].items():
        cls = getattr(importlib.import_module(f"opendr.{module}"), name)
        assert [key for key in wanted.split() if not hasattr(cls, key)] == [], name


def version(python):
    """Returns the version of an interpreter with the GIL; None if it does not run."""
    program = (
        "import sys, sysconfig, json\n"
        "print(json.dumps(None if sysconfig.get_config_var('Py_GIL_DISABLED') else sys.version_info[:2]))"
    )
    try:
        done = subprocess.run([python, "-c", program], capture_output=True, text=True, timeout=60)
        return done.returncode == 0 and tuple(json.loads(done.stdout) or ()) or None
    except (OSError, ValueError, subprocess.TimeoutExpired):
        return None


def found_interpreters():
    """Returns the interpreters of this machine by version."""
    names = [f"python3.{minor}" for minor in range(9, 20)]
    paths = [path for path in map(shutil.which, names) if path]
    paths += map(str, sorted(Path.home().glob(".pyenv/versions/*/bin/python")))
    return {known: path for path in paths if (known := version(path)) and known >= (3, 9)}


def environment_of(python, folder):
    """Returns the interpreter of an environment with NumPy, created with `python`."""
    program = folder / "bin/python"
    beside = Path(sys.executable).parents[2] / "uv/bin/uv"
    uv = shutil.which("uv") or (str(beside) if beside.is_file() else None)
    if uv:
        make = [uv, "venv", "--quiet", "--python", python]
        install = [uv, "pip", "install", "--quiet", "--python", program]
    else:
        make = [python, "-m", "venv"]
        install = [program, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    if not (folder / "numpy.installed").is_file():
        shutil.rmtree(folder, ignore_errors=True)
        for command in ([*make, folder], [*install, "numpy"]):
            done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": ""})
            if done.returncode != 0:
                pytest.skip(f"no environment of {python}: {done.stderr.strip()[-300:]}")
        (folder / "numpy.installed").touch()
    return program


@pytest.fixture(scope="module", params=["this", "3.9", "newest"])
def outcomes(request, zoo, tmp_path_factory):
    """Returns the results of the programs with an interpreter, by name."""
    folder = tmp_path_factory.mktemp("programs")
    (folder / "package").mkdir()
    (folder / "package/opendr").symlink_to(Path(opendr.__file__).parent)
    python = sys.executable
    if request.param != "this":
        there = found_interpreters()
        wanted = (3, 9) if request.param == "3.9" else max(there, default=sys.version_info[:2])
        if wanted == sys.version_info[:2]:
            pytest.skip(f"Python {wanted[0]}.{wanted[1]} runs the tests itself")
        if wanted not in there:
            pytest.skip("no Python 3.9")
        cache = os.environ.get("OPENDR_TEST_CACHE")
        home = Path(cache) if cache else tmp_path_factory.mktemp("environments")
        python = environment_of(there[wanted], home / f"python-{wanted[0]}.{wanted[1]}")
    done = subprocess.run(
        [python, PROGRAMS.parent / "run_programs.py", folder / "runs", *sorted(PROGRAMS.glob("*.py"))],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(folder / "package"), "DISPLAY": "", "WAYLAND_DISPLAY": ""},
    )
    lines = [json.loads(line) for line in done.stdout.splitlines() if line.startswith('{"program": ')]
    assert done.returncode == 0, done.stderr
    return {Path(line["program"]).stem: line for line in lines}


def test_there_are_forty_programs():
    assert len(list(PROGRAMS.glob("*.py"))) >= 40


def test_programs_cover_every_learner_and_data_set():
    text = "".join(path.read_text("utf-8") for path in PROGRAMS.glob("*.py"))
    wanted = {name for _, name, home in NAMES if not isinstance(home, Absent)} - {"get_AF_dataset", "visualize"}
    assert [name for name in sorted(wanted) if not re.search(rf"\b{name}\b", text)] == []


@pytest.mark.parametrize("program", [path.stem for path in sorted(PROGRAMS.glob("*.py"))])
def test_program_runs(outcomes, program):
    assert program in outcomes, "the interpreter ended before"
    assert outcomes[program]["failure"] is None, outcomes[program]["failure"]
