"""Verification and re-identification: scikit-learn, SciPy, and the protocols written out."""

import csv

import numpy as np
import pytest
from scipy.interpolate import interp1d
from scipy.optimize import brentq
from sklearn import metrics
from sklearn.model_selection import KFold

RATES = [1e-1, 1e-2, 1e-3, 1e-4]


def category(kind, confidence=None):
    return {"type": "Category", "class": int(kind), "confidence": confidence}


def case(same, scores, parts=1, **params):
    samples = [
        {"prediction": category(0, float(score)), "ground_truth": category(truth)} for truth, score in zip(same, scores)
    ]
    return {"metric": "verification", "params": params, "samples": samples, "parts": parts}


def fold_accuracies(same, scores, folds):
    """Each fold's accuracy with the best threshold of the others: a score of theirs or infinity, the highest of equals."""
    accuracies = []
    for train, test in KFold(folds).split(scores):
        candidates = [np.inf, *np.unique(scores[train])[::-1]]
        right = [np.sum((scores[train] >= threshold) == same[train]) for threshold in candidates]
        threshold = candidates[int(np.argmax(right))]
        accuracies.append(np.mean((scores[test] >= threshold) == same[test]))
    return np.array(accuracies)


def assert_equals_references(report, same, scores, folds=10):
    found = report["scalars"]
    accepted, true, _ = metrics.roc_curve(same, scores, drop_intermediate=False)
    assert found["roc_auc"] == pytest.approx(metrics.roc_auc_score(same, scores), abs=1e-9)
    for rate in RATES:
        wanted = true[accepted <= rate].max()
        power = int(np.log10(rate))
        assert found[f"tar_at_far_1e{power}"] == pytest.approx(wanted, abs=1e-9), rate
    # Vertical steps of the curve: interpolate along it, not over the rate.
    place = np.arange(len(accepted))
    along = brentq(
        lambda at: interp1d(place, accepted)(at) - (1 - interp1d(place, true)(at)), 0, len(place) - 1, xtol=1e-14
    )
    assert found["equal_error_rate"] == pytest.approx(float(interp1d(place, accepted)(along)), abs=1e-9)
    best = max(np.mean((scores >= threshold) == same) for threshold in [np.inf, *scores])
    assert found["best_accuracy"] == pytest.approx(best, abs=1e-9)
    if len(scores) < folds:
        assert "accuracy" not in found
        return
    wanted = fold_accuracies(same, scores, folds)
    np.testing.assert_allclose([row[1][0] for row in report["tables"][0]["rows"]], wanted, atol=1e-12)
    assert found["accuracy"] == pytest.approx(wanted.mean(), abs=1e-9)
    error = wanted.std(ddof=1) / np.sqrt(folds)
    assert found["accuracy_standard_error"] == pytest.approx(error, abs=1e-9)


@pytest.mark.parametrize("levels", [3, 20, 2**20])
@pytest.mark.parametrize("folds", [2, 10])
def test_random_pairs(compute, levels, folds):
    data = []
    for seed in range(20):
        random = np.random.default_rng(seed)
        count = int(random.integers(2, 200))
        same = random.random(count) < 0.5
        same[:2] = [True, False]
        scores = np.clip(random.normal(0.4 + 0.2 * same, 0.15), -1, 1)
        data.append((same, np.round(scores * levels) / levels))
    data = [(same, scores.astype(np.float32).astype(np.float64)) for same, scores in data]
    cases = [case(*pair, parts=1 + at % 3, folds=folds) for at, pair in enumerate(data)]
    for report, pair in zip(compute(*cases), data):
        assert_equals_references(report, *pair, folds=folds)


def test_labels_of_real_pairs(compute, test_data):
    with open(test_data / "data" / "face_verification" / "master.csv") as file:
        same = np.array([row["Decision"] == "Yes" for row in csv.DictReader(file)])
    assert same.size == 299 or same.size == 300
    random = np.random.default_rng(5)
    scores = random.beta(2 + 4 * same, 4).astype(np.float32).astype(np.float64)
    order = random.permutation(same.size)
    (report,) = compute(case(same[order], scores[order], parts=3))
    assert_equals_references(report, same[order], scores[order])
    assert report["scalars"]["same"] == same.sum()


def test_one_kind_of_pairs_only(compute):
    (report,) = compute(case([1] * 20, np.linspace(0, 1, 20)))
    assert report["scalars"]["accuracy"] == fold_accuracies(np.ones(20, bool), np.linspace(0, 1, 20), 10).mean()
    assert not {"roc_auc", "equal_error_rate", "tar_at_far_1e-1"} & set(report["scalars"])


def test_answers_without_a_score_are_errors(compute):
    sample = {"prediction": category(1), "ground_truth": category(1)}
    (report,) = compute({"metric": "verification", "samples": [sample]})
    assert "no confidence" in report["error"]


def retrieval(vectors, identities, cameras, queries, distance):
    """Market-1501's protocol, query by query; average precision by scikit-learn."""
    precisions, firsts = [], []
    everything = np.arange(len(vectors))
    for query in range(queries or len(vectors)):
        gallery = everything[queries:] if queries else everything[everything != query]
        passed_over = (identities[gallery] == identities[query]) & (cameras[gallery] == cameras[query])
        gallery = gallery[~passed_over & (identities[gallery] != -1)]
        hits = identities[gallery] == identities[query]
        if identities[query] == -1 or not hits.any():
            continue
        if distance == "euclidean":
            away = np.linalg.norm(vectors[gallery] - vectors[query], axis=1)
        else:
            lengths = np.linalg.norm(vectors[gallery], axis=1) * np.linalg.norm(vectors[query])
            away = 1 - vectors[gallery] @ vectors[query] / lengths
        precisions.append(metrics.average_precision_score(hits, -away))
        firsts.append(np.flatnonzero(hits[np.argsort(away)])[0])
    return precisions, np.array(firsts)


@pytest.mark.parametrize("distance", ["cosine", "euclidean"])
@pytest.mark.parametrize("queries", [0, 15])
def test_reidentification(compute, distance, queries):
    for seed in range(8):
        random = np.random.default_rng(seed)
        count = 60
        identities = random.integers(-1, 9, size=count)
        cameras = random.integers(0, 3, size=count)
        centres = random.normal(size=(10, 6))
        vectors = (centres[identities] + random.normal(scale=0.8, size=(count, 6))).astype(np.float32)
        samples = [
            {
                "prediction": {"type": "Heatmap", "shape": [6], "scores": vector.tolist()},
                "ground_truth": {"type": "Category", "class": int(identity), "frame_id": f"camera_{camera}"},
            }
            for vector, identity, camera in zip(vectors, identities, cameras)
        ]
        params = {"queries": queries, "distance": distance, "ranks": [1, 2, 5]}
        (report,) = compute({"metric": "reidentification", "params": params, "samples": samples, "parts": 3})
        precisions, firsts = retrieval(vectors.astype(np.float64), identities, cameras, queries, distance)
        found = report["scalars"]
        assert found["queries"] == len(precisions) > 0
        assert found["map"] == pytest.approx(np.mean(precisions), abs=1e-9)
        for rank in [1, 2, 5]:
            assert found[f"rank_{rank}"] == pytest.approx(np.mean(firsts < rank), abs=1e-12)
