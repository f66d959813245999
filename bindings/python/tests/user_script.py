"""A user's program with types: the type checkers accept it, and it runs."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
import pandas
import supervision
from numpy.typing import NDArray

import opendr
from opendr.engine.data import Image, PointCloud, Timeseries, Vector
from opendr.engine.datasets import DatasetIterator, ExternalDataset
from opendr.engine.learners import Learner, Live, Range, Unit
from opendr.engine.target import (
    BoundingBox,
    BoundingBoxList,
    Category,
    Heatmap,
    Keypoint,
    Pose,
    PoseList,
    TrackingAnnotation,
    TrackingAnnotationList,
)
from opendr.perception.face_detection import YunetLearner
from opendr.perception.object_detection_2d import NanodetLearner, draw_bounding_boxes
from opendr.perception.pose_estimation import MovenetLearner, draw, get_bbox


def detect(photo: Path, folder: Path) -> BoundingBoxList:
    detector = NanodetLearner(device="cpu", threshold=0.4, suppression="soft")
    detector.load(detector.download(folder, mode="pretrained", verbose=False))
    found = detector.infer(photo, threshold=0.5)
    for box in found:
        center = (box.left + box.width / 2, box.top + box.height / 2)
        print(box.class_name, box.name, center, f"{box.confidence:.2f}")
    several: list[BoundingBoxList] = detector.infer([photo, Image.open(photo)])
    frame: NDArray[Any] = Image.open(photo).opencv()
    drawn = draw_bounding_boxes(frame, several[0], class_names=detector.classes)
    print(drawn.shape, detector.threshold, detector.is_ready)
    try:
        detector.threshold = 2.0
    except opendr.InvalidParam as error:
        print("refused:", error)
    except ValueError as error:
        print("refused:", error)
    return found


def poses(photo: Path) -> PoseList:
    estimator = MovenetLearner()
    estimator.load(verbose=False)
    found = estimator.infer(str(photo))
    for pose in found:
        nose: Keypoint = pose["nose"]
        left, top, width, height = get_bbox(pose)
        print(nose.x, nose.y, nose.confidence, left + width, top + height, pose.id)
    image: Image = draw(Image.open(photo), found)
    print(image.width, image.height)
    return found


def watch(folder: Path) -> Iterator[tuple[int, BoundingBoxList]]:
    learner = YunetLearner()
    learner.load(verbose=False)
    source = opendr.Source(folder, str(folder))
    for faces in learner.infer(source, progress=False):
        yield source.number, faces


def results(found: BoundingBoxList, people: PoseList, photo: Path, folder: Path) -> None:
    drawing: Image = found.plot()
    named: Image = people[0].plot(Image.open(photo), class_names={0: "person"})
    table: pandas.DataFrame = found.to_pandas()
    best: float = table["confidence"].max()
    detections: supervision.Detections = found.to_supervision(image_size=(480, 640))
    key_points: supervision.KeyPoints = people.to_supervision()
    classes: supervision.Classifications = Category(0, confidence=0.5).to_supervision()
    masks: supervision.Detections = Heatmap(np.ones((2, 2), np.uint8)).to_supervision()
    for name in ("found.jpg", "found.json", "found.csv"):
        found.save(folder / name)
    print(drawing.width, named.height, best, len(detections), len(key_points), len(classes), len(masks))


def data() -> None:
    image = Image(np.zeros((480, 640, 3), np.uint8))
    image.timestamp, image.frame_id = 1, "camera"
    cloud, series = PointCloud(np.zeros((5, 4))), Timeseries([[0.5, 1.0], [0.25, 2.0]])
    red: int = int(image.data[0].sum())
    print(len(cloud), series[0], Vector([1.0, 2.0]).numpy(), red, image.convert("channels_last", "bgr").shape)


def targets() -> None:
    boxes = BoundingBoxList([BoundingBox(name=1, left=0, top=0, width=2, height=2, score=0.5)])
    boxes.add_box(BoundingBox("person", 1, 2, 3, 4))
    again: BoundingBoxList = BoundingBoxList.from_json(boxes.to_json())
    tracks = TrackingAnnotationList([TrackingAnnotation(0, 1, 2, 3, 4, id=7)])
    plain: BoundingBoxList = tracks.bounding_box_list()
    pose = Pose(np.zeros((18, 2)), confidence=0.7)
    category, heatmap = Category(3, description="cat", confidence=0.9), Heatmap(np.zeros((2, 2), np.uint8), {0: "road"})
    rows: NDArray[np.float32] = boxes.mot()
    print(again == boxes, len(plain), pose.data.shape, category.data, heatmap.numpy().shape, rows.shape)


class Found(NamedTuple):
    boxes: BoundingBoxList
    darkness: Heatmap


@opendr.register
class DarkSpotLearner(Learner):
    """Detects the darkest pixel."""

    name = "dark_spot"
    task = "object_detection_2d"
    threshold: Annotated[float, Range(0.0, 1.0), Live, "A pixel brighter than this is no spot."] = 0.5
    margin: Annotated[int, Range(0, 100), Unit("px"), "Added around the spot."] = 0

    def load(self, path: str) -> bool:
        return True

    def infer(self, image: Image) -> Found:
        grey = image.numpy().mean(axis=0) / 255.0
        row, column = divmod(int(grey.argmin()), image.width)
        side = 1 + 2 * self.margin
        box = BoundingBox(0, column - self.margin, row - self.margin, side, side, 1.0 - float(grey.min()))
        found = BoundingBoxList([box] if grey.min() <= self.threshold else [], classes=["dark"])
        return Found(found, Heatmap(grey))


class Photos(DatasetIterator):
    def __init__(self, folder: Path) -> None:
        self.files = sorted(folder.glob("*.jpg"))

    def __getitem__(self, idx: int) -> tuple[Image, BoundingBoxList]:
        return Image.open(self.files[idx]), BoundingBoxList()

    def __len__(self) -> int:
        return len(self.files)


def main(photo: Path, folder: Path) -> None:
    results(detect(photo, folder), poses(photo), photo, folder)
    for number, faces in watch(photo):
        print(number, len(faces))
    data()
    targets()
    spot = DarkSpotLearner(threshold=0.9, margin=2).infer(Image.open(photo))
    print(spot.boxes[0].left, spot.darkness.shape())
    try:
        DarkSpotLearner().fit(Photos(photo.parent), ExternalDataset(photo.parent, "coco"))
    except opendr.Unsupported as error:
        print(error)
    print(sorted(opendr.learners()), opendr.__version__)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
