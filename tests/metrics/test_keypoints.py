"""Key points: MMPose's measures written out, on its sample annotations and on random poses."""

import json

import numpy as np
import pytest

THRESHOLDS = np.arange(20) / 20


def pose(places, visible, box=None):
    points = [
        {"x": float(x), "y": float(y), "confidence": 1.0} if seen else {"x": -1.0, "y": -1.0}
        for (x, y), seen in zip(places, visible)
    ]
    region = box and {"name": 0, **dict(zip(["left", "top", "width", "height"], map(float, box)))}
    return {"keypoints": points, **({"region": region} if region else {})}


def case(persons, parts=1, **params):
    """A sample for each of (ground truth, visible, prediction, detected, box)."""
    samples = [
        {
            "prediction": {"type": "PoseList", "poses": [pose(answer, found)]},
            "ground_truth": {"type": "PoseList", "poses": [pose(places, visible, box)]},
        }
        for places, visible, answer, found, box in persons
    ]
    return {"metric": "keypoints", "params": params, "samples": samples, "parts": parts}


def measures(persons, sizes, threshold, or_equal=False):
    """`keypoint_pck_accuracy`, `keypoint_auc`, `keypoint_nme` and `keypoint_epe`; joints that were not found are wrong."""
    joints = max(len(person[0]) for person in persons)
    pixels = np.full((len(persons), joints), np.nan)
    seen = np.zeros((len(persons), joints), bool)
    for row, (places, visible, answer, found, _) in enumerate(persons):
        away = np.linalg.norm(np.asarray(answer, float) - np.asarray(places, float), axis=1)
        seen[row, : len(places)] = visible
        pixels[row, : len(places)] = np.where(found, away, np.inf)
    scaled = pixels / np.asarray(sizes, float)[:, None]
    counted = seen.any(axis=0)

    def shares(right):
        return (right & seen).sum(axis=0)[counted] / seen.sum(axis=0)[counted]

    right = scaled <= threshold if or_equal else scaled < threshold
    found = seen & np.isfinite(scaled)
    return {
        "pck": shares(right).mean(),
        "pck_pooled": (right & seen).sum() / seen.sum(),
        "auc": np.mean([shares(scaled < step).mean() for step in THRESHOLDS]),
        "nme": scaled[found].mean(),
        "epe": pixels[found].mean(),
    }


def assert_equal(report, wanted):
    for key, value in wanted.items():
        assert report["scalars"][key] == pytest.approx(value, abs=1e-9), key


def annotations(folder, name):
    """Persons of MMPose's samples, predicted with noise of a tenth of the box, some joints not detected."""
    random = np.random.default_rng(3)
    persons = []
    for annotation in json.loads((folder / name).read_text())["annotations"]:
        points = np.array(annotation["keypoints"], np.float32).reshape(-1, 3)
        visible = (points[:, 2] > 0) & (points[:, :2] >= 0).all(axis=1)
        if not visible.any():
            continue
        box = np.array(annotation["bbox"], np.float32).astype(float)
        noise = random.normal(scale=0.1 * max(box[2:]), size=(len(points), 2))
        answer = np.maximum(points[:, :2] + noise, 0).astype(np.float32).astype(float)
        persons.append((points[:, :2].astype(float), visible, answer, random.random(len(points)) < 0.9, box.tolist()))
    return persons


@pytest.mark.parametrize(
    "name", ["coco/test_coco.json", "freihand/test_freihand.json", "onehand10k/test_onehand10k.json", "300w/test_300w.json"]
)
def test_real_annotations(compute, test_data, name):
    persons = annotations(test_data / "data" / "mmpose_samples", name)
    boxes = np.array([person[4] for person in persons])
    longer, area = boxes[:, 2:].max(axis=1), np.sqrt(boxes[:, 2] * boxes[:, 3])
    by_box, by_area, by_head = compute(
        case(persons, parts=2),
        case(persons, parts=3, normalize="area", threshold=0.1),
        case(persons, normalize="head", threshold=0.5),
    )
    assert_equal(by_box, measures(persons, longer, 0.2))
    assert_equal(by_area, measures(persons, area, 0.1))
    head = 0.6 * np.linalg.norm(boxes[:, 2:], axis=1)
    assert_equal(by_head, measures(persons, head, 0.5, or_equal=True))
    assert by_box["scalars"]["poses"] == len(persons)


def test_faces_between_the_eyes(compute, test_data):
    persons = annotations(test_data / "data" / "mmpose_samples", "300w/test_300w.json")
    outer = [36, 45]
    pupils = [*range(36, 42), *range(42, 48)]
    ocular, pupil = compute(
        case(persons, normalize="joints", joints=outer), case(persons, normalize="joints", joints=pupils)
    )
    corners = [np.linalg.norm(person[0][36] - person[0][45]) for person in persons]
    centres = [np.linalg.norm(person[0][36:42].mean(axis=0) - person[0][42:48].mean(axis=0)) for person in persons]
    assert_equal(ocular, measures(persons, corners, 0.2))
    assert_equal(pupil, measures(persons, centres, 0.2))


def test_torso(compute):
    random = np.random.default_rng(0)
    persons = []
    for _ in range(10):
        places, answer = random.integers(0, 200, size=(2, 18, 2)).astype(float)
        persons.append((places, np.ones(18, bool), answer, np.ones(18, bool), None))
    (report,) = compute(case(persons, normalize="torso"))
    # OpenDR's 18 joints: the left shoulder is 5, the right hip 8.
    sizes = [np.linalg.norm(person[0][5] - person[0][8]) for person in persons]
    assert_equal(report, measures(persons, sizes, 0.2))


def test_random_poses_on_a_grid(compute):
    """Integers: distances that are exactly the threshold."""
    for seed in range(20):
        random = np.random.default_rng(seed)
        persons = []
        for _ in range(int(random.integers(1, 9))):
            places, answer = random.integers(0, 9, size=(2, 6, 2)).astype(float)
            visible = random.random(6) < 0.8
            visible[0] = True
            found = random.random(6) < 0.9
            found[0] = True
            persons.append((places, visible, answer, found, [0, 0, 10, 8]))
        box, head = compute(
            case(persons, parts=2, threshold=0.5), case(persons, normalize="head", threshold=0.5)
        )
        sizes = np.full(len(persons), 10.0)
        assert_equal(box, measures(persons, sizes, 0.5))
        assert_equal(head, measures(persons, 0.6 * np.full(len(persons), np.hypot(10, 8)), 0.5, or_equal=True))


def test_persons_in_one_picture(compute, test_data):
    """Predictions in another order, one too many and one too few."""
    persons = annotations(test_data / "data" / "mmpose_samples", "coco/test_coco.json")

    def moved(places, at):
        return (places + 1000 * at).astype(np.float32).astype(float)

    far = [
        (moved(places, at), visible, moved(answer, at), found, box)
        for at, (places, visible, answer, found, box) in enumerate(persons)
    ]
    truths = [pose(places, visible, box) for places, visible, _, _, box in far]
    answers = [pose(answer, found) for _, _, answer, found, _ in far][::-1]
    alone, crowd, fewer = compute(
        case(far),
        *(
            {
                "metric": "keypoints",
                "samples": [
                    {"prediction": {"type": "PoseList", "poses": some}, "ground_truth": {"type": "PoseList", "poses": truths}}
                ],
            }
            for some in (answers + [pose(far[0][0] + 90000, far[0][1])], answers[1:])
        ),
    )
    assert crowd["scalars"] == pytest.approx(alone["scalars"])
    places, visible, _, found, box = far[-1]
    far[-1] = (places, visible, places, np.zeros_like(found), box)
    wanted = measures(far, [max(person[4][2:]) for person in far], 0.2)
    assert_equal(fewer, wanted)


def test_what_cannot_be_counted_is_an_error(compute):
    everything = [True, True]
    good = ([[0, 0], [1, 1]], everything, [[0, 0], [1, 1]], everything, [0, 0, 4, 4])
    short = ([[0, 0], [1, 1]], everything, [[0, 0]], [True], [0, 0, 4, 4])
    joints, odd = compute(case([short]), case([good], normalize="joints", joints=[1]))
    assert "1 joints cannot be compared with one of 2" in joints["error"]
    assert "even number" in odd["error"]
