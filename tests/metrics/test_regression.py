"""Regression: scikit-learn and the definition of Lin's coefficient; depth and disparity: their definitions."""

import numpy as np
import pytest
from sklearn import metrics

# scikit-learn warns about undefined numbers, which are tested here.
pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")


def scores(array):
    array = np.asarray(array, np.float32)
    numbers = [float(number) if np.isfinite(number) else None for number in array.ravel()]
    return {"type": "Heatmap", "shape": list(array.shape), "scores": numbers}


def case(metric, pairs, parts=1, **params):
    samples = [{"prediction": scores(answer), "ground_truth": scores(truth)} for truth, answer in pairs]
    return {"metric": metric, "params": params, "samples": samples, "parts": parts}


def concordance(truth, answer):
    apart = (truth.mean() - answer.mean()) ** 2
    return 2 * np.mean((truth - truth.mean()) * (answer - answer.mean())) / (truth.var() + answer.var() + apart)


@pytest.mark.parametrize("offset", [0, 1e6])
def test_random_numbers(compute, offset):
    cases, data = [], []
    for seed in range(30):
        random = np.random.default_rng(seed)
        shape = (int(random.integers(2, 100)), int(random.integers(1, 4)))
        truth = (offset + random.normal(size=shape)).astype(np.float32)
        answer = (truth + random.normal(scale=0.5, size=shape)).astype(np.float32)
        cases.append(case("regression", list(zip(truth, answer)), parts=1 + seed % 4))
        data.append((truth.astype(float), answer.astype(float)))
    for report, (truth, answer) in zip(compute(*cases), data):
        found = report["scalars"]
        assert found["mae"] == pytest.approx(metrics.mean_absolute_error(truth, answer), abs=1e-9)
        assert found["rmse"] == pytest.approx(metrics.root_mean_squared_error(truth, answer), abs=1e-9)
        assert found["r2"] == pytest.approx(metrics.r2_score(truth, answer), abs=1e-9)
        columns = [concordance(*pair) for pair in zip(truth.T, answer.T)]
        assert found["ccc"] == pytest.approx(np.mean(columns), abs=1e-9)
        assert [row[1][3] for row in report["tables"][0]["rows"]] == pytest.approx(columns, abs=1e-9)


@pytest.mark.parametrize("answer", [[2, 2, 2], [2, 2, 3]])
def test_constant_truth(compute, answer):
    (report,) = compute(case("regression", [([2], [number]) for number in answer]))
    assert report["scalars"]["r2"] == metrics.r2_score([2, 2, 2], answer)


def test_single_sample(compute):
    (report,) = compute(case("regression", [([1], [3])]))
    assert np.isnan(metrics.r2_score([1], [3])) and "r2" not in report["scalars"]
    assert report["scalars"]["mae"] == 2


def depth_errors(truth, answer, low, high):
    counted = np.isfinite(truth) & (truth >= low) & (truth <= high)
    truth, answer = truth[counted], np.clip(answer[counted], low, high)
    factor, log = np.maximum(truth / answer, answer / truth), np.log(answer) - np.log(truth)
    return {
        "abs_rel": np.mean(np.abs(truth - answer) / truth),
        "sq_rel": np.mean((truth - answer) ** 2 / truth),
        "rmse": np.sqrt(np.mean((truth - answer) ** 2)),
        "rmse_log": np.sqrt(np.mean(log**2)),
        "silog": np.sqrt(np.mean(log**2) - np.mean(log) ** 2),
        **{f"delta{power}": np.mean(factor < 1.25**power) for power in (1, 2, 3)},
    }


@pytest.mark.parametrize("high", [None, 20])
def test_depth(compute, high):
    params = {"max_depth": high} if high else {}
    cases, wanted = [], []
    for seed in range(15):
        random = np.random.default_rng(seed)
        pairs, errors = [], []
        for _ in range(3):
            shape = tuple(int(side) for side in random.integers(2, 30, size=2))
            truth = random.uniform(0.5, 40, size=shape).astype(np.float32)
            answer = (truth * random.uniform(0.5, 2, size=shape)).astype(np.float32)
            truth[random.random(shape) < 0.2] = 0
            truth[random.random(shape) < 0.1] = np.nan
            truth[0, 0], answer[0, 0] = 2, -1
            pairs.append((truth, answer))
            errors.append(depth_errors(truth.astype(float), answer.astype(float), 1e-3, high or np.inf))
        cases.append(case("depth", pairs, parts=1 + seed % 3, **params))
        wanted.append({key: np.mean([error[key] for error in errors]) for key in errors[0]})
    for report, errors in zip(compute(*cases), wanted):
        for key, value in errors.items():
            assert report["scalars"][key] == pytest.approx(value, rel=1e-9), key


def test_disparity(compute):
    random = np.random.default_rng(0)
    pairs = []
    for _ in range(5):
        truth = random.integers(0, 200, size=(20, 30)).astype(np.float32)
        pairs.append((truth, truth + random.integers(-8, 9, size=truth.shape).astype(np.float32)))
    (report,) = compute(case("depth", pairs, parts=2, quantity="disparity"))
    truth, answer = (np.concatenate([pair[side].ravel() for pair in pairs]).astype(float) for side in (0, 1))
    away = np.abs(truth - answer)[truth > 0]
    found = report["scalars"]
    for bound in (1, 2, 3):
        assert found[f"bad_{bound}"] == pytest.approx(np.mean(away > bound), abs=1e-9)
    assert found["d1"] == pytest.approx(np.mean((away > 3) & (away / truth[truth > 0] > 0.05)), abs=1e-9)
    assert found["end_point_error"] == pytest.approx(away.mean(), abs=1e-9)


def test_nan_is_an_error(compute):
    numbers, depth = compute(case("regression", [([1], [np.nan])]), case("depth", [([[1]], [[np.nan]])]))
    assert "not finite" in numbers["error"] and "NaN" in depth["error"]
