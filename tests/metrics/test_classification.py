"""Classification and ROC: scikit-learn; calibration: the definition of Guo et al. (2017)."""

import numpy as np
import pytest
from sklearn import metrics

# scikit-learn warns about undefined numbers, which are tested here.
pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")

ZERO = {"zero": 0.0, "one": 1.0, "undefined": np.nan}


def category(kind, confidence=None, probabilities=()):
    return {
        "type": "Category",
        "class": int(kind),
        "confidence": None if confidence is None else float(confidence),
        "probabilities": [None if np.isnan(score) else float(score) for score in probabilities],
    }


def case(metric, answers, truths, parts=1, **params):
    samples = [{"prediction": answer, "ground_truth": category(truth)} for answer, truth in zip(answers, truths)]
    return {"metric": metric, "params": params, "samples": samples, "parts": parts}


def classes_case(truths, answers, **options):
    return case("classification", [category(answer) for answer in answers], truths, **options)


def same(report, key, wanted):
    """Equal, or absent where the reference is NaN."""
    if np.isnan(wanted):
        assert key not in report["scalars"], key
    else:
        assert report["scalars"][key] == pytest.approx(wanted, abs=1e-9), key


def random_classes(seed):
    """Ground truths and predictions over a few classes, some of which occur only in one of the two."""
    random = np.random.default_rng(seed)
    names = random.choice([-3, 0, 1, 2, 5, 7, 1000], size=int(random.integers(1, 6)), replace=False)
    count = int(random.choice([1, 2, 7, 60, 300]))
    truths = random.choice(random.permutation(names)[: 1 + seed % 3], size=count)
    answers = np.where(random.random(count) < 0.5, truths, random.choice(names, size=count))
    return truths, answers


def assert_equals_scikit(report, truths, answers, labels=None, zero="zero"):
    same(report, "accuracy", metrics.accuracy_score(truths, answers))
    same(report, "balanced_accuracy", metrics.balanced_accuracy_score(truths, answers))
    for average in ["micro", "macro", "weighted"]:
        wanted = metrics.precision_recall_fscore_support(
            truths, answers, labels=labels, average=average, zero_division=ZERO[zero]
        )
        for key, value in zip(["precision", "recall", "f1"], wanted):
            same(report, f"{key}_{average}", value)
    rows = metrics.precision_recall_fscore_support(truths, answers, labels=labels, zero_division=ZERO[zero])
    (table,) = report["tables"]
    occurring = np.union1d(truths, answers) if labels is None else labels
    assert [row[0] for row in table["rows"]] == [str(label) for label in occurring]
    found = [[np.nan if value is None else value for value in row[1]] for row in table["rows"]]
    np.testing.assert_allclose(np.array(found), np.array(rows).T, atol=1e-9)
    (matrix, *_) = report["figures"]
    assert matrix["counts"] == metrics.confusion_matrix(truths, answers).ravel().tolist()


@pytest.mark.parametrize("zero", ZERO)
def test_random_classes(compute, zero):
    data = [random_classes(seed) for seed in range(60)]
    cases = [
        classes_case(*pair, parts=1 + at % 3, zero_division=zero) for at, pair in enumerate(data)
    ]
    for report, pair in zip(compute(*cases), data):
        assert_equals_scikit(report, *pair, zero=zero)


@pytest.mark.parametrize("zero", ZERO)
@pytest.mark.parametrize("labels", [[0, 1, 2], [5], [9, 1000, -3, 0, 1, 2, 5, 7]])
def test_chosen_labels(compute, zero, labels):
    data = [random_classes(seed) for seed in range(40)]
    # scikit-learn raises for labels that do not occur.
    data = [pair for pair in data if np.isin(labels, pair[0]).any()]
    cases = [classes_case(*pair, labels=labels, zero_division=zero) for pair in data]
    for report, pair in zip(compute(*cases), data):
        assert_equals_scikit(report, *pair, labels=labels, zero=zero)


def test_one_class_only(compute):
    (report,) = compute(classes_case([4, 4, 4], [4, 4, 4]))
    assert_equals_scikit(report, [4, 4, 4], [4, 4, 4])
    assert report["scalars"]["accuracy"] == 1


def test_names_of_classes(compute):
    answer = {**category(1), "description": "dog"}
    truth = {**category(0), "description": "cat"}
    (report,) = compute(
        {"metric": "classification", "samples": [{"prediction": answer, "ground_truth": truth}]}
    )
    assert report["figures"][0]["labels"] == ["cat", "dog"]


@pytest.mark.parametrize("levels", [3, 1000])
def test_top_k(compute, levels):
    cases, wanted = [], []
    for seed in range(30):
        random = np.random.default_rng(seed)
        count, classes = int(random.integers(1, 60)), int(random.integers(3, 9))
        scores = (random.integers(0, levels, size=(count, classes)) / levels).astype(np.float32)
        truths = random.integers(0, classes, size=count)
        answers = [category(row.argmax(), probabilities=row) for row in scores]
        cases.append(case("classification", answers, truths, parts=1 + seed % 2, top_k=[1, 2, 5, 100]))
        labels = range(classes)
        wanted.append(
            {k: metrics.top_k_accuracy_score(truths, scores, k=k, labels=labels) for k in [1, 2, 5, 100]}
        )
    for report, rates in zip(compute(*cases), wanted):
        for k, rate in rates.items():
            same(report, f"top_{k}_accuracy", rate)


def calibration_errors(confidences, correct):
    """The definition, bin by bin; a confidence of 0 belongs to the first bin."""
    gaps, weights = [], []
    for low in range(15):
        inside = (confidences > low / 15) & (confidences <= (low + 1) / 15)
        if low == 0:
            inside |= confidences == 0
        if inside.any():
            gaps.append(abs(correct[inside].mean() - confidences[inside].mean()))
            weights.append(inside.mean())
    return np.dot(gaps, weights), max(gaps)


def test_calibration(compute):
    cases, wanted = [], []
    for seed in range(30):
        random = np.random.default_rng(seed)
        count = int(random.integers(1, 200))
        confidences = random.integers(0, 61, size=count).astype(np.float32) / np.float32(60)
        if seed % 2:
            confidences = random.random(count, dtype=np.float32)
        truths, answers = random.integers(0, 3, size=(2, count))
        cases.append(
            case("classification", [category(*pair) for pair in zip(answers, confidences)], truths, parts=1 + seed % 3)
        )
        wanted.append(calibration_errors(confidences.astype(np.float64), truths == answers))
    for report, (expected, maximum) in zip(compute(*cases), wanted):
        same(report, "expected_calibration_error", expected)
        same(report, "maximum_calibration_error", maximum)


def test_what_cannot_be_counted_is_an_error(compute):
    reports = compute(
        case("classification", [category(0, probabilities=[0.5, np.nan])], [0]),
        case("classification", [category(0, probabilities=[0.5, 0.5])], [2]),
        case("classification", [category(0, confidence=1.5)], [0]),
        case("roc", [category(0, probabilities=[0.5, np.nan])], [0]),
        case("roc", [category(0)], [0]),
        case("classification", [category(0)], [0], top_k=[0]),
    )
    wanted = ["NaN", "none of 2 scores", "0..=1", "not finite", "no score", "out of range"]
    for report, text in zip(reports, wanted):
        assert text in report["error"]


def roc_case(truths, scores, **options):
    answers = [category(0, probabilities=[0, score]) for score in scores]
    return case("roc", answers, truths, **options)


def best_f1(truths, scores):
    """The highest F1 and its lowest threshold."""
    thresholds = np.unique(scores)
    hits = np.array([np.sum((scores >= threshold) & (truths == 1)) for threshold in thresholds])
    answered = np.array([np.sum(scores >= threshold) for threshold in thresholds])
    f1 = 2 * hits / (answered + np.sum(truths == 1))
    precision, recall, _ = metrics.precision_recall_curve(truths == 1, scores)
    either = np.where(precision + recall > 0, precision + recall, 1)
    assert f1.max() == pytest.approx(np.max(2 * precision * recall / either))
    return f1.max(), thresholds[np.argmax(f1)]


@pytest.mark.parametrize("levels", [2, 8, 100000])
def test_roc(compute, levels):
    data = []
    for seed in range(30):
        random = np.random.default_rng(seed)
        count = int(random.integers(2, 250))
        truths = random.integers(0, 3, size=count)
        truths[:2] = [0, 1]
        scores = random.integers(0, levels, size=count) + (truths == 1) * random.integers(0, levels // 2 + 1)
        data.append((truths, scores.astype(np.float32).astype(np.float64) / 2**17))
    reports = compute(*(roc_case(*pair, parts=1 + at % 3) for at, pair in enumerate(data)))
    for report, (truths, scores) in zip(reports, data):
        positive = truths == 1
        same(report, "roc_auc", metrics.roc_auc_score(positive, scores))
        same(report, "average_precision", metrics.average_precision_score(positive, scores))
        f1, threshold = best_f1(truths, scores)
        same(report, "best_f1", f1)
        same(report, "best_f1_threshold", threshold)
        rates = np.array(metrics.roc_curve(positive, scores)[:2]).T
        (drawn,) = [line for line in report["figures"][0]["lines"] if line["label"] == "predictions"]
        np.testing.assert_allclose(drawn["points"], rates, atol=1e-12)


def test_roc_of_one_class(compute):
    positives, negatives = compute(roc_case([1, 1], [0.5, 0.25]), roc_case([0, 0], [0.5, 0.25]))
    assert np.isnan(metrics.roc_auc_score([1, 1], [0.5, 0.25]))
    assert "roc_auc" not in positives["scalars"] and "roc_auc" not in negatives["scalars"]
    assert positives["scalars"]["average_precision"] == metrics.average_precision_score([1, 1], [0.5, 0.25])
    assert "average_precision" not in negatives["scalars"]


def test_score_of_the_positive_class(compute):
    """The confidence of another class than the positive one counts against it."""
    answers = [category(3, 0.75), category(2, 0.75), category(2, 0.5), category(3, 0.625)]
    truths = [3, 2, 3, 2]
    (report,) = compute(case("roc", answers, truths, positive=3))
    same(report, "roc_auc", metrics.roc_auc_score([1, 0, 1, 0], [0.75, 0.25, 0.5, 0.625]))
