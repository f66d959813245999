"""Slices of the trainings that made our own weights (models/training), by the built command."""

import csv
import json

import pytest


@pytest.fixture(scope="module")
def backbone(opendr, shared, tmp_path_factory):
    folder = tmp_path_factory.mktemp("zoo")
    done = opendr.run("download", "posenet/mnv1_385", "--to", folder)
    assert done.returncode == 0, done.stderr
    return folder / "posenet/mnv1_385"


def losses(output):
    with open(output / "log/log.csv") as log:
        rows = list(csv.DictReader(log))
    return [float(row["train/loss"]) for row in rows if row["train/loss"]]


def fit(opendr, *arguments):
    done = opendr.run("fit", *arguments, "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_a_person_detector_begins_to_learn(opendr, shared, backbone, tmp_path):
    arguments = ["single_shot_detector", shared / "data/coco128/object_detection", "--split", "train"]
    arguments += ["--out", tmp_path / "run", "--classes", "person", "--backbone-weights", backbone, "--freeze", "14"]
    arguments += ["--img-size", "192", "--max-steps", "24", "--epochs", "3", "--log-after", "1", "--lr", "0.002"]
    report = fit(opendr, *arguments, "--warmup-steps", "4", "--augment", "false")
    assert report["complete"] and report["scalars"]["steps"] == 24
    curve = losses(tmp_path / "run")
    assert len(curve) == 24 and sum(curve[-5:]) < 0.85 * sum(curve[:5])
    [line] = opendr.infer("single_shot_detector", "--model", tmp_path / "run/model", shared / "data/photos/bus.jpg")
    assert line["outputs"]["boxes"]["classes"] == ["person"]


def test_a_pose_estimator_learns_from_a_teacher(opendr, shared, backbone, tmp_path):
    arguments = ["lightweight_open_pose", shared / "data/coco128/images/train2017", "--out", tmp_path / "run"]
    arguments += ["--teacher", "movenet/multipose", "--teacher-threshold", "0.2", "--backbone", backbone, "--freeze", "true"]
    arguments += ["--width", "0.75", "--extra-blocks", "2", "--channels", "32", "--separable", "true", "--crop-size", "128"]
    arguments += ["--num-refinement-stages", "1", "--batch-size", "8", "--epochs", "6", "--lr", "0.002", "--log-after", "1"]
    report = fit(opendr, *arguments, "--grad-clip", "100", "--weight-decay", "0")
    assert report["complete"]
    curve = losses(tmp_path / "run")
    assert sum(curve[-4:]) < 0.5 * sum(curve[:4])
