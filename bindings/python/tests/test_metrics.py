"""Metrics, and `eval` of learners."""

from __future__ import annotations

import json
import os
import threading

import numpy as np
import opendr
import pytest
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator, ExternalDataset
from opendr.engine.learners import Learner
from opendr.engine.target import BoundingBox, BoundingBoxList, Category, Heatmap
from opendr.metrics import Metric, names, tables


def test_tables_name_defaults_and_types():
    assert {"classification", "coco_detection", "coco_keypoints", "voc_detection"} <= set(names())
    table = next(table for table in tables() if table["name"] == "coco_detection")
    assert (table["prediction"], table["ground_truth"]) == ("BoundingBoxList", "BoundingBoxList")


def box(name, left, score=0.0):
    return BoundingBox(name=name, left=left, top=0, width=10, height=10, score=score)


def test_metric_counts_merges_and_tells():
    truth, wrong = BoundingBoxList([box(0, 0)]), BoundingBoxList([box(0, 50, 0.9)])
    right = BoundingBoxList([box(0, 0, 0.8)])
    whole = Metric("coco_detection")
    assert whole.update(right, truth) > whole.update(wrong, truth)
    one, other = Metric("coco_detection"), Metric("coco_detection")
    one.update(right, truth, index=0)
    other.update(wrong, truth, index=1)
    one.merge(other)
    assert one.result() == whole.result()
    assert whole.result()["map50"] == pytest.approx(0.2525, abs=1e-3)


def test_wrong_use_is_refused():
    with pytest.raises(opendr.NotFound, match="coco_detection"):
        Metric("coco")
    with pytest.raises(opendr.InvalidParam):
        Metric("classification", nonsense=3)
    metric = Metric("classification")
    with pytest.raises(opendr.InvalidInput, match="Category"):
        metric.update(Heatmap(np.zeros((2, 2))), Category(1))
    with pytest.raises(opendr.InvalidInput):
        metric.merge(metric)
    with pytest.raises(opendr.InvalidInput):
        metric.merge(Metric("coco_detection"))


def test_threads_may_share_a_metric():
    metric = Metric("classification")

    def count(offset):
        for at in range(100):
            metric.update(Category(at % 2, confidence=1.0), Category(at % 4 // 2), index=offset + at)

    threads = [threading.Thread(target=count, args=(100 * at,)) for at in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert metric.result()["accuracy"] == 0.5


class Astronauts(DatasetIterator):
    """Repeats one image; the annotation of its second sample is wrong."""

    classes = ["cat", "human"]

    def __init__(self, picture):
        self.picture = picture

    def __len__(self):
        return 3

    def __getitem__(self, idx):
        person = BoundingBox(name=1, left=20, top=10, width=450, height=500, score=0)
        cat = BoundingBox(name=0, left=0, top=0, width=20, height=20, score=0)
        return self.picture, BoundingBoxList([cat if idx == 1 else person])


@pytest.fixture(scope="module")
def detector():
    if not os.environ.get("OPENDR_TEST_DATA"):
        pytest.skip("skipped: no OPENDR_TEST_DATA")
    learner = opendr.learner("centernet")
    return learner


@pytest.fixture(scope="module")
def picture(detector):
    from opendr import _opendr

    return Image.open(_opendr.sample("astronaut", False))


def test_eval_of_a_python_data_set_resumes(detector, picture, tmp_path):
    dataset = Astronauts(picture)
    outcome = detector.eval(dataset, out=tmp_path)
    report = outcome["report"]
    assert (report["samples"], report["counted"], report["complete"], report["skipped"]) == (3, 3, True, 0)
    # "person" is the data set's "human"; classes that it does not have are ignored.
    assert outcome["map50"] == report["scalars"]["map50"] > 0.2
    assert report["lowest_scores"][0]["index"] == 1
    assert {"predictions.jsonl", "report.json", "lowest_scores.png", "samples.png"} <= {path.name for path in tmp_path.iterdir()}
    assert any(path.suffix == ".svg" for path in tmp_path.iterdir())
    lines = (tmp_path / "predictions.jsonl").read_text().splitlines(keepends=True)
    assert len(lines) == 4

    class Watched(Astronauts):
        read: list[int] = []

        def __getitem__(self, idx):
            self.read.append(idx)
            return super().__getitem__(idx)

    # Interrupted within the third sample.
    (tmp_path / "predictions.jsonl").write_text("".join(lines[:3]) + lines[3][:20])
    again = Watched(picture)
    Watched.__name__ = "Astronauts"
    resumed = detector.eval(again, folder=tmp_path)
    assert {key: value for key, value in resumed.items() if key != "report"} == {
        key: value for key, value in outcome.items() if key != "report"
    }
    with pytest.raises(opendr.InvalidInput, match="another evaluation .parameters"):
        detector.threshold = 0.5
        detector.eval(again, folder=tmp_path)
    detector.threshold = 0.3
    assert json.loads((tmp_path / "report.json").read_text())["counted"] == 3


def test_eval_leaves_out_what_is_broken(detector, picture):
    class Broken(Astronauts):
        def __getitem__(self, idx):
            if idx == 2:
                raise OSError("the disk is on fire")
            return super().__getitem__(idx)

    with pytest.raises(ValueError, match="2: OSError: the disk is on fire"):
        detector.eval(Broken(picture))
    report = detector.eval(Broken(picture), skip_broken=True)["report"]
    assert (report["counted"], report["skipped"]) == (2, 1)
    assert "on fire" in report["problems"][0]["message"]


def test_eval_of_a_learner_in_python(picture):
    class Guess(Learner):
        """Detects a person in every image."""

        name = "guess"
        task = "object_detection_2d"

        def infer(self, image: Image) -> BoundingBoxList:
            return BoundingBoxList([BoundingBox(name=1, left=20, top=10, width=450, height=500, score=0.5)])

    # One of three images has no person, so half of the last detections are false positives; cats are not detected.
    numbers = Guess().eval(Astronauts(picture))
    assert 0.3 < numbers["map50"] < 0.5


def test_eval_refuses_what_does_not_fit(detector, tmp_path):
    with pytest.raises(TypeError, match="a path, an ExternalDataset"):
        detector.eval(3)
    with pytest.raises(FileNotFoundError):
        detector.eval(ExternalDataset(tmp_path / "none", "coco"))
    with pytest.raises(FileNotFoundError):
        detector.eval(ExternalDataset(tmp_path, "no such format"))
    with pytest.raises(ValueError):
        detector.eval(ExternalDataset(tmp_path, "auto"))
    for path in (tmp_path / "none", str(tmp_path / "none")):
        with pytest.raises(FileNotFoundError, match="none"):
            detector.eval(path)
    with pytest.raises(ValueError, match="BoundingBoxList, not a Category"):
        detector.eval([(Image(np.zeros((3, 64, 64), np.uint8)), Category(1))])


def test_former_arguments_of_update_warn():
    metric = Metric("classification")
    category = Category(1, confidence=1.0)
    with pytest.warns(DeprecationWarning, match="truth is called ground_truth"):
        metric.update(category, truth=category)
    with pytest.warns(DeprecationWarning, match="at is called index"):
        metric.update(category, category, at=1)
    with pytest.raises(TypeError, match="give only ground_truth"), pytest.warns(DeprecationWarning):
        metric.update(category, category, truth=category)
    with pytest.raises(TypeError, match="needs the ground truth"):
        metric.update(category)
    with pytest.raises(TypeError, match="no argument 'sample'"):
        metric.update(category, category, sample=1)
    assert metric.result()["accuracy"] == 1.0
