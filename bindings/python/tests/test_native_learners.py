"""The learners of the registry as Python classes: OpenDR's life cycle, arguments, inputs, outputs."""

import inspect
import itertools
import pickle
import warnings
from typing import Annotated, NamedTuple, Optional

import numpy as np
import opendr
import pytest
from opendr import Source, _opendr
from opendr._native_class import native_class
from opendr._input_value import input_value
from opendr.engine.data import Audio, Image, PointCloud, SkeletonSequence, Timeseries, Vector, Video
from opendr.engine.learners import BaseLearner, Init, Learner, LearnerRL
from opendr.engine.target import BoundingBox, BoundingBox3D, BoundingBox3DList, BoundingBoxList, Heatmap
from opendr.perception.object_detection_2d import (
    CenterNetDetectorLearner,
    NanodetLearner,
    draw_bounding_boxes,
)
from opendr.perception.pose_estimation import MovenetLearner, PosenetLearner, draw, get_bbox

ENTRIES = [entry for entry in _opendr.entries() if entry["name"] in opendr.learners()]
NATIVE = [entry for entry in ENTRIES if hasattr(opendr.learners()[entry["name"]], "_entry")]


def test_the_models_are_listed_with_grade_and_accuracy():
    listed = {model["model"]: model for model in opendr.list_models()}
    yolox = listed["yolox/nano"]
    assert (yolox["grade"], yolox["default"], yolox["task"]) == ("real", True, "object_detection_2d")
    low, high = yolox["accuracy"]["interval"]
    assert low < yolox["accuracy"]["value"] < high
    assert listed["sort/default"]["grade"] is None
    faces = opendr.list_models("face_detection", grade="real", commercial=True)
    assert faces and all(face["task"] == "face_detection" and face["licence"]["commercial"] for face in faces)
    assert {model["grade"] for model in opendr.list_models(grade="transfer")} == {"real", "transfer"}
    with pytest.raises(ValueError, match="the grades are real"):
        opendr.list_models(grade="good")


@pytest.mark.parametrize("entry", NATIVE, ids=lambda entry: entry["name"])
def test_class(entry):
    cls = opendr.learners()[entry["name"]]
    assert issubclass(cls, LearnerRL if entry["fit_in"] else Learner)
    assert cls.__name__ == entry["class_name"]
    assert cls.__module__ == f"opendr.{entry['package']}.{entry['task']}"
    assert getattr(__import__(cls.__module__, fromlist=[cls.__name__]), cls.__name__) is cls
    parameters = inspect.signature(cls).parameters
    # OpenDR's own order where it has the class; tests/test_upstream.py.
    if not cls._row.init:
        assert list(parameters)[: len(BaseLearner.__signature__.parameters)] == list(BaseLearner.__signature__.parameters)
    for field in entry["params"]:
        assert parameters[field["name"]].default == pytest.approx(field["default"])
        assert field["name"] in cls.__doc__
        if field["range"]:
            assert f"{field['range'][0]:g} to {field['range'][1]:g}" in " ".join(cls.__doc__.split())


def inputs(entry, photo):
    """Returns a value for every input of a learner, by name."""
    noise = np.random.default_rng(0).uniform(-1, 1, 16000)
    image = Image.open(photo)
    height, width = image.opencv().shape[:2]
    box = BoundingBox(name=0, left=10, top=20, width=60, height=150, score=0.9)
    car = BoundingBox3D("Car", 0, 0, 0, [0, 0, 1, 1], [4, 1.5, 1.8], [5, 1.6, 20], 0, 0.9)
    kinds = {
        "Image": image,
        "depth": Image(np.full((height, width, 1), 700, dtype=np.uint16), dtype=np.uint16),
        "BoundingBoxList": BoundingBoxList([box]),
        "BoundingBox3DList": BoundingBox3DList([car]),
        "Audio": Audio(noise, 16000),
        "Timeseries": Timeseries(noise[:140, None]),
        "Vector": Vector(noise[:42]),
        "Heatmap": Heatmap(noise[:120].reshape(10, 12)),
        "PointCloud": PointCloud(np.abs(noise[:1200]).reshape(300, 4) * 20),
        "Video": Video(noise[:6144].reshape(3, 8, 16, 16)),
        "SkeletonSequence": SkeletonSequence(noise[:960].reshape(1, 2, 32, 15, 1)),
    }
    return {port["name"]: kinds.get(port["name"], kinds[port["type"]]) for port in entry["ports"]}


def json_of(entry, answer):
    """Returns the JSON of each output, after checking its type."""
    answers = answer if len(entry["outputs"]) > 1 else (answer,)
    assert [type(target).__name__ for target in answers] == [output["type"] for output in entry["outputs"]]
    return [target.to_json() for target in answers]


#: Policies, and learners without pretrained models.
PRETRAINED = [entry for entry in NATIVE if not entry["fit_in"] and _opendr.models(entry["name"])]


#: Parameters without which a learner refuses its inputs.
REQUIRED = {"visual_odometry": {"focal_length": 500.0, "baseline": 0.1}}


@pytest.mark.parametrize("entry", PRETRAINED, ids=lambda entry: entry["name"])
def test_life_cycle(entry, zoo, photo, tmp_path):
    cls = opendr.learners()[entry["name"]]
    given = inputs(entry, photo)
    if entry["name"] == "visual_odometry":
        # A frame has the image of a right camera or depths.
        del given["depth"]
    learner = cls(device="cpu", **REQUIRED.get(entry["name"], {}))
    assert not learner.is_ready and learner.classes == []
    if not cls._row.ready:
        with pytest.raises(FileNotFoundError, match=r"download\(\).*load\(\).*fit\(\)"):
            learner.infer(**given)
    folder = learner.download(path=str(tmp_path / "models"), verbose=False)
    assert learner.load(folder) is True and learner.is_ready
    answer = json_of(entry, learner.infer(**given))
    assert learner.save(str(tmp_path / "saved")) is True
    again = cls(device="cpu")
    again.load(tmp_path / "saved")
    assert json_of(entry, again.infer(**given)) == answer
    learner.reset()
    assert json_of(entry, learner.stream().infer(**given)) == answer
    with pytest.raises(TypeError, match="ExternalDataset"):
        learner.eval(None)
    refused = (TypeError, "dataset should be") if entry["fit"] else (NotImplementedError, entry["class_name"])
    with pytest.raises(refused[0], match=refused[1]):
        learner.fit(None)
    with pytest.raises(NotImplementedError, match=entry["class_name"]):
        learner.optimize(target_device="cpu")
    with pytest.raises(ValueError, match="give the folder"):
        learner.optimize()


def test_every_kind_of_input_gives_the_same(nanodet, photo):
    image = Image.open(photo)
    wanted = nanodet.infer(image).to_json()
    frame = image.opencv()
    assert nanodet.infer(str(photo)).to_json() == wanted
    assert nanodet.infer(photo).to_json() == wanted
    assert nanodet.infer(frame).to_json() == wanted
    assert nanodet.infer(np.asfortranarray(frame)).to_json() == wanted
    # Planar layouts use another kernel: results are equal except for rounding.
    for box, planes in zip(nanodet.infer(frame), nanodet.infer(image.numpy())):
        assert (box.left, box.confidence) == pytest.approx((planes.left, planes.confidence), rel=1e-4)
    assert nanodet.infer(image=image.convert("channels_last", "bgr")).to_json() == wanted
    assert [found.to_json() for found in nanodet.infer([image, str(photo), frame])] == [wanted] * 3
    assert [found.to_json() for found in nanodet.infer(Source(photo))] == [wanted]
    assert [found.to_json() for found in nanodet.infer(iter([frame]))] == [wanted]
    assert nanodet.infer([]) == []


def test_views_of_any_layout_are_read_rightly(nanodet, photo):
    frame = Image.open(photo).opencv()
    wanted = nanodet.infer(np.ascontiguousarray(frame[10:-6, 20:-30][::2, ::2])).to_json()
    assert nanodet.infer(frame[10:-6, 20:-30][::2, ::2]).to_json() == wanted
    flipped = nanodet.infer(np.ascontiguousarray(frame[::-1, ::-1])).to_json()
    assert nanodet.infer(frame[::-1, ::-1]).to_json() == flipped != wanted
    floats = Image(frame.astype(np.float32) / 255, dtype=np.float32)
    assert len(nanodet.infer(floats)) == len(nanodet.infer(frame))


def test_time_and_frame_travel(nanodet, photo):
    image = Image.open(photo)
    image.timestamp, image.frame_id = 1_700_000_000_000_000_001, "camera_link"
    found = nanodet.infer(image)
    assert (found.timestamp, found.frame_id) == (image.timestamp, image.frame_id)


def test_parameters(zoo, photo):
    learner = NanodetLearner(threshold=0.6, device="cpu")
    learner.load(verbose=False)
    assert learner.threshold == pytest.approx(0.6)
    few = len(learner.infer(photo))
    assert len(learner.infer(photo, threshold=0.1)) > few
    assert len(learner.infer(photo)) == few
    learner.threshold = 0.1
    assert len(learner.infer(photo)) > few
    with pytest.raises(ValueError, match="threshold = 2.0 is out of range 0.0 to 1.0"):
        learner.threshold = 2
    assert learner.threshold == pytest.approx(0.1)
    with pytest.raises(TypeError, match="threshold should be a float"):
        NanodetLearner(threshold="high")
    with pytest.raises(TypeError, match="no argument 'treshold'"):
        NanodetLearner(treshold=0.5)
    with pytest.raises(TypeError, match="infer has no argument 'treshold'; its arguments are image"):
        learner.infer(photo, treshold=0.5)
    with pytest.raises(ValueError, match="suppression"):
        NanodetLearner(suppression="none")


def test_opendrs_arguments_are_taken(zoo, photo):
    with pytest.warns(UserWarning) as warned:
        nanodet = NanodetLearner(
            model_to_use="m", iters=10, lr=1e-3, batch_size=8, checkpoint_after_iter=0, checkpoint_load_iter=0,
            temp_path="", device="cpu", weight_decay=0.05, warmup_steps=500, warmup_ratio=0.1, lr_schedule_T_max=280,
            lr_schedule_eta_min=5e-5, grad_clip=35,
        )  # fmt: skip
    told = {str(warning.message).split(" has no effect")[0].split(": ")[1] for warning in warned}
    assert {"model_to_use", "lr_schedule_T_max"} <= told
    assert not {"weight_decay", "grad_clip", "iters"} & told
    nanodet.load(verbose=False)
    with pytest.raises(TypeError, match="iou_threshold twice|threshold twice"):
        NanodetLearner(threshold=0.5, conf_threshold=0.5)
    with pytest.warns(UserWarning, match="hf has no effect"):
        found = nanodet.infer(input := Image.open(photo), conf_threshold=0.5, iou_threshold=0.5, nms_max_num=1, hf=False)
    assert len(found) == 1 and input.data.shape[0] == 3
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        centernet = CenterNetDetectorLearner(
            lr=0.001, epochs=120, batch_size=8, device="cpu", backbone="resnet50_v1b", img_size=512,
            lr_schedule="step", temp_path="", checkpoint_after_iter=0, checkpoint_load_iter=0, val_after=5,
            log_after=100, num_workers=8, weight_decay=0.0005, momentum=0.9, scale=1.0, wh_weight=0.1,
            center_reg_weight=1.0, lr_decay_epoch="80,100", lr_decay=0.1, warmup_epochs=0, flip_validation=False,
        )  # fmt: skip
        centernet.load(verbose=False)
        assert isinstance(centernet.infer(photo, threshold=0.2, keep_size=True), BoundingBoxList)
    assert centernet.classes[0] == "person"


def test_download(zoo, tmp_path):
    learner = NanodetLearner()
    picture = learner.download(tmp_path, mode="images", verbose=False)
    assert Image.open(picture).width > 0 and str(picture).startswith(str(tmp_path))
    with pytest.raises(ValueError, match="'pretrained' and 'images'"):
        learner.download(tmp_path, mode="weights")
    with pytest.raises(FileNotFoundError, match="variant|no_such|nanodet"):
        learner.download(tmp_path, variant="no_such")
    with pytest.raises(opendr.Unsupported, match="OPENDR_MODEL_REPOSITORY"):
        learner.download(tmp_path, url="http://localhost/")
    with pytest.raises(FileNotFoundError):
        learner.load(tmp_path / "nothing")


def test_device(zoo, monkeypatch):
    with pytest.raises((RuntimeError, ValueError), match="cpu"):
        NanodetLearner(device="cuda").load(verbose=False)
    with pytest.raises(ValueError, match="no device|device"):
        NanodetLearner(device="toaster")
    monkeypatch.setenv("OPENDR_DEVICE", "cpu")
    learner = NanodetLearner(device="cuda")
    assert learner.load(verbose=False)


def test_poses_are_drawn(zoo, photo):
    image = Image.open(photo)
    for learner in (MovenetLearner(device="cpu"), PosenetLearner(device="cpu")):
        learner.load(verbose=False)
        poses = learner.infer(image)
        frame = image.opencv()
        for pose in poses:
            draw(frame, pose)
            left, top, width, height = get_bbox(pose)
            assert width > 0 and height > 0
        assert not np.array_equal(frame, image.opencv())


def test_boxes_are_drawn_in_place(nanodet, photo):
    frame = Image.open(photo).opencv()
    before = frame.copy()
    drawn = draw_bounding_boxes(frame, nanodet.infer(frame), class_names=nanodet.classes, show=False)
    assert drawn is frame and not np.array_equal(frame, before)


def test_source(test_data, tmp_path):
    files = sorted((test_data / "data/photos").iterdir())[:3]
    (tmp_path / "broken.jpg").write_bytes(b"no picture")
    source = Source(files[0], tmp_path / "broken.jpg", *files[1:])
    assert source.length == 4 and not source.live and source.path is None
    assert next(source).width > 0 and source.path == str(files[0])
    with pytest.raises(ValueError, match="broken.jpg"):
        next(source)
    assert len(list(source)) == 2
    with pytest.raises(FileNotFoundError):
        Source(tmp_path / "absent.jpg")


def test_generators_are_lazy(faces, photo):
    asked = itertools.count()

    def endless():
        while True:
            next(asked)
            yield photo

    answers = faces.infer(endless())
    assert next(asked) == 0
    next(answers), next(answers)
    assert next(asked) == 3


def test_learners_are_not_pickled(nanodet):
    with pytest.raises(TypeError, match="save"):
        pickle.dumps(nanodet)


def test_learner_by_name(zoo):
    assert opendr.learner("yunet/320", device="cpu", verbose=False).is_ready
    with pytest.raises(FileNotFoundError, match="the learners are .*nanodet"):
        opendr.learner("nanodett")


def test_numbers_that_are_none(monkeypatch):
    # The output of a network with damaged weights.
    found = '{"type": "BoundingBoxList", "boxes": [%s], "classes": ["null"]}'
    box = '{"name": 0, "left": %s, "top": 1.0, "width": 2.0, "height": 3.0, "confidence": 0.5}'
    right, wrong = found % (box % "4.0"), found % ", ".join((box % "4.0", box % "null"))

    class DamagedHandle:
        answer = right

        def infer(self, ports):
            return [("boxes", self.answer, None)]

    learner = NanodetLearner(device="cpu")
    monkeypatch.setitem(vars(learner), "_handle", DamagedHandle())
    picture = np.zeros((4, 5, 3), np.uint8)
    assert learner.infer(picture)[0].class_name == "null"
    DamagedHandle.answer = wrong
    with pytest.raises(opendr.InternalError, match=r"nanodet .*BoundingBoxList\.boxes\[1\]\.left is NaN"):
        learner.infer(picture)
    assert BoundingBoxList.from_json(right)[0].left == 4
    with pytest.raises(opendr.InvalidInput, match=r"boxes\[1\]\.left is NaN"):
        BoundingBoxList.from_json(wrong)


class PairOutputs(NamedTuple):
    boxes: BoundingBoxList
    heatmap: Heatmap


class PairLearner(Learner):
    """Returns its boxes, and the sums of image and vector."""

    name = "pair"
    task = "object_detection_2d"

    def load(self, path: str) -> bool:
        return True

    def infer(self, image: Image, boxes: BoundingBoxList, start: Annotated[Optional[Vector], Init] = None) -> PairOutputs:
        self.start = start if start is not None else getattr(self, "start", Vector([0]))
        return PairOutputs(boxes, Heatmap(np.array([image.data.sum(), self.start.data.sum()], np.float32)))


@pytest.fixture(scope="module")
def pair():
    opendr.register(PairLearner)
    (entry,) = (entry for entry in _opendr.entries() if entry["name"] == "pair")
    learner = native_class(entry, __name__)(device="cpu")
    learner.load(".")
    return learner


def test_own_learners_have_no_variants(pair):
    with pytest.raises(FileNotFoundError, match="no pretrained models"):
        opendr.learner("pair/small")


def test_several_inputs_and_outputs(pair):
    picture, boxes = Image(np.ones((3, 4, 5), np.uint8), guess_format=False), BoundingBoxList()
    for answer in (pair.infer(picture, boxes, [1, 2]), pair.infer(boxes=boxes, image=picture, start=Vector([3]))):
        assert type(answer).__name__ == "PairLearnerOutputs" and answer._fields == ("boxes", "heatmap")
        assert (answer.boxes, answer.heatmap.data.tolist()) == (boxes, [60, 3])
    # The vector is used for the first item of a list; boxes are used for all, or one list per item.
    given = [boxes, BoundingBoxList(classes=["cat"])]
    first, second = pair.infer([picture, picture], given, [4, 5])
    assert [first.heatmap.data[1], second.heatmap.data[1]] == [9, 9]
    assert [first.boxes, second.boxes] == given
    assert [answer.boxes for answer in pair.infer([picture, picture], given[1])] == [given[1]] * 2
    assert [answer.boxes for answer in pair.infer(iter([picture]), iter(given))] == given[:1]
    assert pair.stream().infer(picture, boxes, None).boxes == boxes
    with pytest.raises(ValueError, match="different lengths.*'image': 2, 'boxes': 1"):
        pair.infer([picture, picture], given[:1])
    with pytest.raises(TypeError, match="boxes should be a BoundingBoxList, not list"):
        pair.infer(picture, given)
    with pytest.raises(ValueError, match='"boxes" is missing'):
        pair.infer(picture)
    with pytest.raises(opendr.Unsupported, match="chunks"):
        pair.stream().push(picture, boxes)
    with pytest.raises(opendr.Unsupported, match="chunks"):
        pair.stream().flush()


@pytest.mark.parametrize("given", [np.zeros((3, 2)), None, b"sound.wav", [1, 2]])
def test_data_of_several_parts_are_not_guessed(given):
    with pytest.raises(TypeError, match="sound should be an Audio, not"):
        input_value(given, "sound", "Audio")


def test_paths_are_files_of_the_type(tmp_path):
    (tmp_path / "beat.csv").write_text("volt,ampere\n1,2\n3,4\n5,6\n")
    assert input_value(tmp_path / "beat.csv", "series", "Timeseries").data.tolist() == [[1, 2], [3, 4], [5, 6]]
    with pytest.raises(FileNotFoundError, match="none.wav"):
        input_value("none.wav", "sound", "Audio")
    with pytest.raises(ValueError, match="beat.csv"):
        input_value(tmp_path / "beat.csv", "sound", "Audio")


def test_lists_that_hold_themselves():
    endless = []
    endless.append(endless)
    with pytest.raises(TypeError, match="lists nested"):
        _opendr.Handle("nanodet", {"threshold": endless}, "cpu")
