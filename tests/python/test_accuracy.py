"""Accuracy of our pipeline on real images, computed by reference tools."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from coco128 import Coco128

PERSON = [0]
#: Mean OKS over the annotated persons, and the share of persons detected by MoveNet at OKS 0.5.
OPEN_POSE_FLOOR, AGREEMENT_FLOOR = 0.5, 0.65
#: Folder of the Debian package dataset-fashion-mnist.
FASHION_MNIST = Path("/usr/share/datasets/fashion-mnist")
# COCO's 17 joints among OpenDR's 18.
COCO_JOINTS = [0, 15, 14, 17, 16, 5, 2, 6, 3, 7, 4, 11, 8, 12, 9, 13, 10]
# pycocotools' constants of the object keypoint similarity.
SIGMAS = np.array([26, 25, 25, 35, 35, 79, 79, 72, 72, 62, 62, 107, 107, 87, 87, 89, 89]) / 1000


def coco_points(pose):
    """Returns the positions of COCO's joints in a pose of ours, `[17, 2]`."""
    return np.array([[pose["keypoints"][joint]["x"], pose["keypoints"][joint]["y"]] for joint in COCO_JOINTS])


def oks(points, joints, area):
    """Object keypoint similarity of `points` `[17, 2]` to true `joints` `[17, 3]`, over those that are visible."""
    distances = ((points - joints[:, :2]) ** 2).sum(axis=1)
    return np.exp(-distances / (2 * SIGMAS) ** 2 / area / 2)[joints[:, 2] > 0].mean()


def similarities(truths, poses):
    """OKS of each true person (joints `[17, 3]`, area) with the pose that fits it best; 0 where there is none."""
    found = [coco_points(pose) for pose in poses]
    return [max((oks(points, joints, area) for points in found), default=0.0) for joints, area in truths]


@pytest.mark.parametrize(
    ("learner", "all_classes", "person"), [("centernet", 0.52, 0.63), ("nanodet", 0.46, 0.63)]
)
def test_detectors_on_coco128(opendr, shared, learner, all_classes, person):
    coco = Coco128(shared / "data/coco128")
    lines = opendr.infer(learner, "--threshold", "0.01", *coco.pictures)
    scores = coco.map50(lines), coco.map50(lines, PERSON)
    print(f"{learner}: mAP50 {scores[0]:.3f}, person AP50 {scores[1]:.3f}")
    assert scores[0] >= all_classes
    assert scores[1] >= person


def test_movenet_on_cropped_persons(opendr, shared, tmp_path):
    folder = shared / "data/mmpose_samples/coco"
    truth = json.loads((folder / "test_coco.json").read_text())
    names = {image["id"]: image["file_name"] for image in truth["images"]}
    persons, corners = [person for person in truth["annotations"] if person["num_keypoints"]], []
    for number, person in enumerate(persons):
        picture = cv2.imread(str(folder / names[person["image_id"]]))
        left, top, width, height = (int(edge) for edge in person["bbox"])
        cv2.imwrite(str(tmp_path / f"{number:02}.png"), picture[top : top + height, left : left + width])
        corners.append((left, top))
    lines = opendr.infer("movenet/lightning", "--threshold", "0", "--keypoint-threshold", "0", tmp_path)
    values = []
    for person, corner, line in zip(persons, corners, lines, strict=True):
        joints = np.array(person["keypoints"], dtype=float).reshape(17, 3)
        points = coco_points(line["outputs"]["poses"]["poses"][0]) + corner
        values.append(oks(points, joints, person["area"]))
    print(f"movenet: mean OKS {np.mean(values):.3f} over {len(values)} persons")
    assert np.mean(values) >= 0.75


@pytest.mark.parametrize(("picture", "faces"), [("t1.jpg", 6), ("zidane.jpg", 2), ("astronaut.png", 1)])
def test_yunet_counts_faces(opendr, shared, picture, faces):
    [line] = opendr.infer("yunet/640", shared / "data/photos" / picture)
    found = line["outputs"]["boxes"]["boxes"]
    assert len(found) == faces
    assert all(len(face["landmarks"]) == 5 for face in found)


@pytest.mark.parametrize(("picture", "faces"), [("t1.jpg", 6), ("zidane.jpg", 2), ("astronaut.png", 1)])
def test_ultra_light_counts_faces(opendr, shared, picture, faces):
    [line] = opendr.infer("ultra_light_face", shared / "data/photos" / picture)
    assert len(line["outputs"]["boxes"]["boxes"]) == faces


@pytest.mark.parametrize("learner", ["movenet/multipose", "posenet"])
def test_multi_person_poses_stand_on_the_persons(opendr, shared, learner):
    """Of the annotated persons, most have a pose whose joints are theirs (OKS of at least 0.5)."""
    folder = shared / "data/mmpose_samples/coco"
    truth = json.loads((folder / "test_coco.json").read_text())
    lines = opendr.infer(learner, "--keypoint-threshold", "0", *sorted(folder.glob("*.jpg")))
    poses = {line["input"].rsplit("/", 1)[-1]: line["outputs"]["poses"]["poses"] for line in lines}
    names = {image["id"]: image["file_name"] for image in truth["images"]}
    persons, hits = [person for person in truth["annotations"] if person["num_keypoints"] >= 10], 0
    for person in persons:
        joints = np.array(person["keypoints"], dtype=float).reshape(17, 3)
        [best] = similarities([(joints, person["area"])], poses[names[person["image_id"]]])
        hits += best >= 0.5
    print(f"{learner}: {hits} of {len(persons)} persons")
    assert hits >= 0.6 * len(persons)


def test_single_shot_detector_on_coco128(opendr, shared):
    coco = Coco128(shared / "data/coco128")
    score = coco.map50(opendr.infer("single_shot_detector", "--threshold", "0.01", *coco.pictures), PERSON)
    print(f"single_shot_detector: person AP50 {score:.3f}")
    assert score >= 0.33


def test_image_classifier_on_fashion_mnist(opendr):
    if not FASHION_MNIST.is_dir():
        pytest.skip("no Debian package dataset-fashion-mnist")
    report = opendr.eval("image_classifier", FASHION_MNIST, "--split", "test", "--limit", "2000")
    print(f"image_classifier: accuracy {report['scalars']['accuracy']:.3f} on 2000 test pictures")
    assert report["scalars"]["accuracy"] >= 0.88


def interval(values):
    """A 95 % interval of the mean by the bootstrap."""
    means = np.random.default_rng(0).choice(values, (10_000, len(values))).mean(axis=1)
    return np.percentile(means, [2.5, 97.5])


def test_light_open_pose_on_annotated_persons(opendr, shared):
    folder = shared / "data/mmpose_samples/coco"
    truth = json.loads((folder / "test_coco.json").read_text())
    learners = {"lightweight_open_pose": OPEN_POSE_FLOOR, "posenet": 0.6, "movenet/multipose": 0.6}
    for learner, floor in learners.items():
        values = []
        for image in truth["images"]:
            [line] = opendr.infer(learner, "--threshold", "0.05", folder / image["file_name"])
            persons = [person for person in truth["annotations"] if person["image_id"] == image["id"]]
            persons = [
                (np.array(person["keypoints"], float).reshape(17, 3), person["area"])
                for person in persons
                if person["num_keypoints"]
            ]
            values += similarities(persons, line["outputs"]["poses"]["poses"])
        low, high = interval(values)
        print(f"{learner}: mean OKS {np.mean(values):.3f} ({low:.2f} to {high:.2f}) over {len(values)} persons")
        assert np.mean(values) >= floor


def test_light_open_pose_agrees_with_its_teacher(opendr, shared):
    pictures = sorted((shared / "data/coco128/images/val2017").glob("*.jpg"))
    values = []
    ours = opendr.infer("lightweight_open_pose", "--threshold", "0.05", *pictures)
    for line, teacher in zip(ours, opendr.infer("movenet/multipose", "--threshold", "0.3", *pictures)):
        persons = []
        for pose in teacher["outputs"]["poses"]["poses"]:
            joints = np.array([[joint["x"], joint["y"], joint["confidence"] > 0.2] for joint in pose["keypoints"]])[COCO_JOINTS]
            width, height = np.ptp(joints[joints[:, 2] > 0, :2], axis=0)
            persons.append((joints, width * height))
        values += similarities(persons, line["outputs"]["poses"]["poses"])
    share = np.mean(np.array(values) >= 0.5)
    print(f"of {len(values)} persons that MoveNet finds, {share:.2f} at OKS 0.5; mean OKS {np.mean(values):.3f}")
    assert share >= AGREEMENT_FLOOR
