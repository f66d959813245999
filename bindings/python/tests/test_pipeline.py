"""Pipelines of learners."""

import threading
from typing import Optional

import numpy as np
import opendr
import pytest
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator
from opendr.engine.learners import Learner
from opendr.engine.target import BoundingBox, BoundingBoxList, Category, PoseList


class Detector(Learner):
    """Returns as many boxes as the value of the first pixel."""

    name, task = "detector", "object_detection_2d"

    def infer(self, image: Image) -> BoundingBoxList:
        if int(image.numpy().flat[0]) == 99:
            raise ValueError("an image that cannot be read")
        count = int(image.numpy().flat[0])
        return BoundingBoxList([BoundingBox(left=n, top=0, width=1, height=1, name=0, score=0.5) for n in range(count)])


class Doubler(Learner):
    """Returns each box twice, and counts the calls."""

    name, task = "doubler", "object_detection_2d"
    seen = 0

    def infer(self, image: Image, boxes: BoundingBoxList, first: Optional[PoseList] = None) -> BoundingBoxList:
        self.seen += 1
        return BoundingBoxList([box for box in boxes for _ in range(2)])

    def reset(self) -> None:
        self.seen = 0


class Judge(Learner):
    """Returns the number of boxes."""

    name, task = "judge", "image_classification"

    def infer(self, boxes: BoundingBoxList) -> Category:
        return Category(prediction=len(boxes.data), confidence=1.0)


class Counted(DatasetIterator):
    """Images with the numbers of boxes in their annotations."""

    classes = ["two", "zero", "one", "three"]

    def __len__(self):
        return 8

    def __getitem__(self, idx):
        name = ["zero", "one", "two", "three"][idx % 4]
        return picture(idx % 4), Category(prediction=self.classes.index(name), description=name)


def picture(value):
    return Image(np.full((3, 2, 2), value, np.uint8))


def test_each_takes_the_newest_answer_of_its_type():
    pipeline = opendr.Pipeline(Detector(), Doubler(), Judge())
    assert pipeline.inputs == ["image", "first"]
    found = pipeline.infer(picture(3))
    assert set(found) == {"boxes", "category"}
    assert (len(found["boxes"].data), found["category"].data) == (6, 6)


def test_a_stream_keeps_its_order_and_ends_with_its_error():
    doubler = Doubler()
    pipeline = opendr.Pipeline(Detector(), doubler, Judge())
    items = [picture(n) for n in range(40)]
    answers = list(pipeline.run(items))
    assert [item is wanted for (item, _), wanted in zip(answers, items)] == [True] * 40
    assert [found["category"].data for _, found in answers] == [2 * n for n in range(40)]
    assert doubler.seen == 40
    told = []
    with pytest.raises(ValueError, match="cannot be read"):
        told.extend(found["category"].data for _, found in pipeline.run([picture(1), picture(99), picture(2)]))
    before = threading.active_count()
    for _, found in pipeline.run(picture(1) for _ in iter(int, 1)):
        assert found["category"].data == 2
        break
    assert threading.active_count() == before


def test_learners_work_at_the_same_time():
    meeting = threading.Barrier(2, timeout=30)

    class Meets(Detector):
        def infer(self, image: Image) -> BoundingBoxList:
            if image.numpy().flat[0] == 1:
                meeting.wait()
            return super().infer(image)

    class MeetsToo(Judge):
        def infer(self, boxes: BoundingBoxList) -> Category:
            if not boxes.data:
                meeting.wait()
            return super().infer(boxes)

    answers = list(opendr.Pipeline(Meets(), MeetsToo()).run([picture(0), picture(1)]))
    assert [found["category"].data for _, found in answers] == [0, 1]


def test_wrong_use_is_told():
    with pytest.raises(ValueError, match="at least one"):
        opendr.Pipeline()
    with pytest.raises(ValueError, match="Judge takes BoundingBoxList"):

        class Poses(Learner):
            """Returns no boxes."""

            name, task = "poses", "pose_estimation"

            def infer(self, image: Image) -> PoseList:
                return PoseList([])

        opendr.Pipeline(Poses(), Judge())
    with pytest.raises(TypeError, match="no input 'picture'"):
        opendr.Pipeline(Detector()).infer(picture=picture(1))


def test_compiled_learners_beside_each_other(faces, nanodet, photo):
    image = Image.open(str(photo))
    pipeline = opendr.Pipeline(nanodet, "posenet")
    (frame, found), = pipeline.run([image])
    assert frame is image and set(found) == {"boxes", "poses"}
    assert found["boxes"] == nanodet.infer(image)


def test_it_is_measured_as_a_learner_is():
    judge = Judge()
    judge.classes = ["zero", "one", "two", "three"]
    numbers = opendr.Pipeline(Detector(), judge).eval(Counted())
    assert numbers["accuracy"] == 1.0
    assert numbers["report"]["learner"] == "detector + judge"
    assert {pair["learner"] for pair in numbers["report"]["classes"]["pairs"]} == set(judge.classes)
    assert numbers["report"]["interval"]["units"] == 8
    judge.classes = ["null", "eins", "zwei", "drei"]
    with pytest.raises(ValueError, match="match one of the learner by name"):
        opendr.Pipeline(Detector(), judge).eval(Counted())
    pairs = dict(zip(judge.classes, ["zero", "one", "two", "three"]))
    assert opendr.Pipeline(Detector(), judge).eval(Counted(), classes=pairs)["accuracy"] == 1.0
    assert opendr.Pipeline(Detector(), judge).eval(Counted(), by_number=True)["accuracy"] == 0.25
