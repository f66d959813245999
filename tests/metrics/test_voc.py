"""Pascal VOC: the development kit's VOCevaldet.m and VOCap.m, line by line in NumPy."""

import numpy as np
import pytest

CASES = 200


def overlaps(found, there):
    """Of corners that both belong to the box."""
    found, there = np.array(found)[:, None], np.array(there)[None]
    start, end = np.maximum(found[..., :2], there[..., :2]), np.minimum(found[..., 2:], there[..., 2:])
    size = end - start + 1
    area = lambda box: (box[..., 2] - box[..., 0] + 1) * (box[..., 3] - box[..., 1] + 1)
    shared = np.maximum(size, 0).prod(-1)
    return np.where(shared > 0, shared / (area(found) + area(there) - shared), -np.inf)


def evaluate(pictures, name, eleven_points):
    """VOCevaldet: average precision of one class."""
    truth = [[(box, difficult) for box, label, difficult in there if label == name] for there, _ in pictures]
    detections = [(at, box, score) for at, (_, found) in enumerate(pictures) for box, label, score in found if label == name]
    positives = sum(not difficult for there in truth for _, difficult in there)
    if positives == 0:
        return None
    order = np.argsort([-score for *_, score in detections], kind="stable")
    seen = [np.zeros(len(there), bool) for there in truth]
    right, wrong = np.zeros(len(order)), np.zeros(len(order))
    for place, index in enumerate(order):
        at, box, _ = detections[index]
        shared = overlaps([box], [there for there, _ in truth[at]])[0] if truth[at] else np.array([-np.inf])
        best = shared.argmax()
        if shared[best] >= 0.5:
            if not truth[at][best][1]:
                (wrong if seen[at][best] else right)[place] = 1
                seen[at][best] = True
        else:
            wrong[place] = 1
    right, wrong = right.cumsum(), wrong.cumsum()
    recall, precision = right / positives, right / np.maximum(right + wrong, 1)
    if eleven_points:
        return sum(precision[recall >= tenth / 10].max(initial=0) / 11 for tenth in range(11))
    recall, precision = np.concatenate([[0], recall, [1]]), np.concatenate([[0], precision, [0]])
    precision = np.maximum.accumulate(precision[::-1])[::-1]
    steps = np.flatnonzero(np.diff(recall)) + 1
    return ((recall[steps] - recall[steps - 1]) * precision[steps]).sum()


def random_pictures(rng):
    pictures = []
    for _ in range(rng.integers(1, 6)):
        corners = lambda: np.concatenate([start := rng.integers(1, 60, 2), start + rng.integers(0, 40, 2)])
        there = [(corners(), int(rng.integers(3)), rng.random() < 0.2) for _ in range(rng.integers(0, 7))]
        found = []
        for _ in range(rng.integers(0, 15)):
            box, label = corners(), int(rng.integers(3))
            if there and rng.random() < 0.7:
                box, label, _ = there[rng.integers(len(there))]
                box = box + rng.integers(-4, 5, 4) * (rng.random() < 0.7)
                box[2:] = np.maximum(box[2:], box[:2])
            found.append((box, label, float(rng.choice([0.25, 0.5, 0.5, rng.integers(1, 256) / 256]))))
        pictures.append((there, found))
    return pictures


def target(rows, is_truth):
    boxes = []
    for (x0, y0, x1, y1), label, last in rows:
        box = dict(name=label, left=float(x0 - 1), top=float(y0 - 1), width=float(x1 - x0 + 1), height=float(y1 - y0 + 1))
        if not is_truth:
            box["confidence"] = last
        elif last:
            box["segment"] = dict(segmentation=[], area=1, iscrowd=True)
        boxes.append(box)
    return {"type": "BoundingBoxList", "boxes": boxes}


@pytest.mark.parametrize("eleven_points", [False, True])
def test_random_cases(compute, eleven_points):
    rng = np.random.default_rng(5)
    cases = [random_pictures(rng) for _ in range(CASES)]
    lines = [
        {
            "metric": "voc_detection",
            "params": {"eleven_points": eleven_points},
            "samples": [{"prediction": target(found, False), "ground_truth": target(there, True)} for there, found in pictures],
            "parts": 1 + at % 3,
        }
        for at, pictures in enumerate(cases)
    ]
    means = []
    for pictures, report in zip(cases, compute(*lines), strict=True):
        averages = {name: evaluate(pictures, name, eleven_points) for name in range(3)}
        averages = {str(name): average for name, average in averages.items() if average is not None}
        rows = {name: numbers[1] for name, numbers in report["tables"][0]["rows"]} if averages else {}
        assert rows == pytest.approx(averages, abs=1e-9)
        assert report.get("scalars", {}).get("map") == (pytest.approx(np.mean(list(averages.values()))) if averages else None)
        means += averages.values()
    assert len(np.unique(np.round(means, 6))) > CASES / 2
