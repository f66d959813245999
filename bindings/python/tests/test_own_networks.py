"""Learners of OpenDR that run networks which users bring."""

import json
import warnings
from pathlib import Path

import numpy as np
import pytest

import opendr
from opendr.perception.object_detection_2d import DetrLearner, ImportedDetectorLearner, YOLOv3DetectorLearner, YOLOv5DetectorLearner

FIXTURES = Path(__file__).parents[3] / "crates/perception/detection/tests/imported"


def network(name, folder):
    """Unpacks the ONNX file of a fixture, as users have it."""
    import zipfile

    with zipfile.ZipFile(FIXTURES / f"{name}.zip") as archive:
        archive.extract("model.onnx", folder)
    return folder / "model.onnx"


def test_a_class_is_the_same_in_all_module_paths():
    from opendr.perception.object_detection_2d.detr.detr_learner import DetrLearner as detr
    from opendr.perception.object_detection_2d.yolov5.yolov5_learner import YOLOv5DetectorLearner as yolov5

    assert yolov5 is YOLOv5DetectorLearner and detr is DetrLearner
    assert yolov5.__module__ == "opendr.perception.object_detection_2d" and yolov5.__name__ == "YOLOv5DetectorLearner"
    # The registry has one learner, under its own class.
    assert opendr.learners()["detector"] is ImportedDetectorLearner and not issubclass(yolov5, ImportedDetectorLearner)


@pytest.mark.parametrize(
    "name, make",
    [
        ("yolo", lambda path: YOLOv5DetectorLearner("custom", path, "cpu")),
        ("yolo", lambda path: YOLOv3DetectorLearner(device="cpu")),
        ("detr", lambda path: DetrLearner(device="cpu")),
    ],
)
def test_networks_of_users_predict_what_the_detector_predicts(tmp_path, name, make):
    path = network(name, tmp_path)
    facts = json.loads((FIXTURES / f"{name}.json").read_text())
    width, height = facts["image"]
    image = np.random.default_rng(7).integers(0, 256, (height, width, 3), np.uint8)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        learner = make(path)
    if not learner.is_ready:
        learner.load(path)
    learner.threshold = facts["threshold"]
    boxes = learner.infer(image)
    reference = ImportedDetectorLearner(device="cpu", threshold=facts["threshold"])
    reference.load(path)
    wanted = reference.infer(image)
    assert len(boxes) == len(wanted) > 0
    for box, other in zip(boxes, wanted):
        assert (box.name, box.left, box.top, box.confidence) == (other.name, other.left, other.top, other.confidence)


def test_arguments_are_those_of_opendr(tmp_path):
    assert YOLOv3DetectorLearner(0.001, device="cpu").threshold == 0.1
    assert DetrLearner(threshold=0.4, device="cpu").threshold == 0.4 and DetrLearner(device="cpu").threshold == 0.7
    with pytest.warns(UserWarning, match="model_name has no effect: the network of the file"):
        YOLOv5DetectorLearner("yolov5s", device="cpu")
    with pytest.raises(TypeError, match="positional"):
        YOLOv5DetectorLearner("yolov5s", None, "cpu", ".", False, 1)


def test_what_there_is_not_is_named(tmp_path):
    learner = DetrLearner(device="cpu")
    with pytest.raises(opendr.Unsupported, match="DetrLearner has no download yet; export your network to ONNX"):
        learner.download(".")
    with pytest.raises(FileNotFoundError):
        learner.infer(np.zeros((8, 8, 3), np.uint8))
    with pytest.raises(FileNotFoundError):
        YOLOv5DetectorLearner(path=tmp_path / "absent.onnx", device="cpu")
    (tmp_path / "text.onnx").write_text("no network")
    with pytest.raises(ValueError, match="text.onnx"):
        YOLOv5DetectorLearner(path=tmp_path / "text.onnx", device="cpu")


def test_segmented_objects_are_a_map_of_classes(tmp_path):
    from opendr.perception.semantic_segmentation.yolov8_seg.yolov8_seg_learner import YOLOv8SegLearner

    facts = json.loads((FIXTURES / "yolo_segment.json").read_text())
    width, height = facts["image"]
    image = np.random.default_rng(7).integers(0, 256, (height, width, 3), np.uint8)
    with pytest.warns(UserWarning, match="model_name"):
        learner = YOLOv8SegLearner("yolov8s-seg", network("yolo_segment", tmp_path), "cpu")
    heatmap = learner.infer(image, conf_thres=facts["threshold"])
    boxes = learner.get_bboxes()
    assert len(boxes) > 0 and heatmap.data.shape == (height, width)
    classes = {int(box.name) + 1 for box in boxes.data}
    assert set(np.unique(heatmap.data)) - {0} <= classes and heatmap.data.any()
    masks = boxes.to_supervision((height, width)).mask
    assert (heatmap.data > 0).sum() == masks.any(axis=0).sum()
    names = learner.get_classes()
    assert names[0] == "background" and len(names) == len(learner.classes) + 1
    assert learner.get_visualization().data.shape == (3, height, width)
    assert [map.data.shape for map in learner.infer([image, image])] == [(height, width)] * 2
