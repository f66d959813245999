"""Segmentation: scikit-learn's confusion matrix and Jaccard scores."""

import numpy as np
import pytest
from sklearn import metrics

# scikit-learn warns of a single class.
pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")

IGNORE = 255


def labels(array):
    return {"type": "Heatmap", "shape": list(array.shape), "labels": array.ravel().tolist()}


def case(pictures, parts=1, **params):
    samples = [{"prediction": labels(answer), "ground_truth": labels(truth)} for truth, answer in pictures]
    return {"metric": "segmentation", "params": params, "samples": samples, "parts": parts}


def random_picture(random, classes):
    """Regions rather than noise, some of them void, with a prediction shifted from the ground truth."""
    height, width = (int(side) for side in random.integers(1, 40, size=2))
    truth = np.full((height, width), int(random.integers(0, classes)))
    for _ in range(8):
        top, left = random.integers(0, height), random.integers(0, width)
        value = IGNORE if random.random() < 0.2 else int(random.integers(0, classes))
        truth[top : top + random.integers(1, 20), left : left + random.integers(1, 20)] = value
    answer = np.where(truth == IGNORE, 0, np.roll(truth, int(random.integers(0, 3)), axis=1))
    answer[random.random(truth.shape) < 0.1] = int(random.integers(0, classes))
    return truth, answer


def assert_equals_scikit(report, truth, answer):
    counted = truth != IGNORE
    truth, answer = truth[counted], answer[counted]
    # A void prediction is a false negative, but no false positive of a class.
    present = np.union1d(truth, answer)
    present = present[present != IGNORE]
    ious = metrics.jaccard_score(truth, answer, labels=present, average=None, zero_division=0)
    matrix = metrics.confusion_matrix(truth, answer, labels=present)
    sizes = np.array([(truth == label).sum() for label in present])
    found = report["scalars"]
    assert [row[0] for row in report["tables"][0]["rows"]] == [str(label) for label in present]
    np.testing.assert_allclose([row[1][0] for row in report["tables"][0]["rows"]], ious, atol=1e-12)
    assert report["figures"][0]["counts"] == matrix.ravel().tolist()
    assert found["miou"] == pytest.approx(ious.mean(), abs=1e-9)
    assert found["pixel_accuracy"] == pytest.approx(metrics.accuracy_score(truth, answer), abs=1e-9)
    accuracies = np.diag(matrix)[sizes > 0] / sizes[sizes > 0]
    assert found["mean_accuracy"] == pytest.approx(accuracies.mean(), abs=1e-9)
    assert found["frequency_weighted_iou"] == pytest.approx(np.average(ious, weights=sizes), abs=1e-9)


@pytest.mark.parametrize("classes", [1, 2, 19, 300])
def test_random_pictures(compute, classes):
    sets = []
    for seed in range(15):
        random = np.random.default_rng(seed)
        sets.append([random_picture(random, classes) for _ in range(1 + seed % 4)])
    if classes == 300:
        # 255 is a class here, and void is another label.
        for pictures in sets:
            for truth, answer in pictures:
                truth[truth == IGNORE] = 254
    reports = compute(*(case(pictures, parts=1 + at % 3) for at, pictures in enumerate(sets)))
    for report, pictures in zip(reports, sets):
        truth, answer = (np.concatenate([picture[side].ravel() for picture in pictures]) for side in (0, 1))
        assert_equals_scikit(report, truth, answer)


def test_void_answers(compute):
    truth, answer = np.array([[0, 0, 1, 1]]), np.array([[0, IGNORE, 1, 0]])
    (report,) = compute(case([(truth, answer)]))
    assert_equals_scikit(report, truth, answer)
    assert report["scalars"]["pixel_accuracy"] == 0.5


def test_everything_void(compute):
    (report,) = compute(case([(np.full((2, 2), IGNORE), np.zeros((2, 2), int))]))
    assert report["scalars"] == {"pixels": 0}


def test_no_label_is_void(compute):
    truth, answer = np.array([[255, 3]]), np.array([[255, 255]])
    (report,) = compute(case([(truth, answer)], ignore=None))
    assert report["scalars"]["miou"] == pytest.approx((0.5 + 0) / 2)


def test_scores(compute):
    random = np.random.default_rng(1)
    scores = random.random((5, 12, 17), dtype=np.float32)
    truth = random.integers(0, 5, size=(12, 17))
    sample = {
        "prediction": {"type": "Heatmap", "shape": [5, 12, 17], "scores": scores.ravel().tolist()},
        "ground_truth": labels(truth),
    }
    (report,) = compute({"metric": "segmentation", "samples": [sample]})
    assert_equals_scikit(report, truth.ravel(), scores.argmax(axis=0).ravel())


def test_what_cannot_be_counted_is_an_error(compute):
    small, large = np.zeros((2, 2), int), np.zeros((2, 3), int)
    shapes, label = compute(case([(small, large)]), case([(small, small + 5000)]))
    assert "[2, 3]" in shapes["error"] and "resize" in shapes["error"]
    assert "5000" in label["error"]
