"""Depths of unknown scale and shift: depth_tools, NumPy, and the definitions of MiDaS and Monodepth2."""

import depth_tools
import numpy as np
import pytest
from test_regression import case, depth_errors

LOW, HIGH = 1e-3, 30.0


def aligned(alignment, truth, prediction, counted):
    """The aligned predictions of `counted` pixels as depths."""
    if alignment == "median":
        return prediction * np.median(truth[counted]) / np.median(prediction[counted])
    target = 1 / truth if alignment == "inverse_scale_shift" else truth
    target = np.where(counted, target, 0.0)
    fitted, shift, scale = depth_tools.align_shift_scale(pred_values=prediction, gt_values=target, mask=counted)
    least = np.linalg.lstsq(np.stack([prediction[counted], np.ones(counted.sum())], 1), target[counted], rcond=None)[0]
    assert (float(scale), float(shift)) == pytest.approx(tuple(least), rel=1e-6)
    if alignment == "scale_shift":
        return fitted
    # MiDaS: an inverse depth below that of the largest depth is set to it.
    return 1 / np.maximum(fitted, 1 / HIGH)


@pytest.mark.parametrize("alignment", ["median", "scale_shift", "inverse_scale_shift"])
def test_alignment(compute, alignment):
    cases, wanted = [], []
    for seed in range(15):
        random = np.random.default_rng(seed)
        pairs, errors = [], []
        for _ in range(3):
            shape = tuple(int(side) for side in random.integers(4, 30, size=2))
            truth = random.uniform(0.5, 40, size=shape).astype(np.float32)
            depth = 1 / truth if alignment == "inverse_scale_shift" else truth
            prediction = (random.uniform(0.5, 9) * (depth * random.uniform(0.7, 1.4, size=shape) + 0.1)).astype(np.float32)
            truth[random.random(shape) < 0.2] = 0
            truth[random.random(shape) < 0.1] = np.nan
            truth[0, 0] = 2
            pairs.append((truth, prediction))
            truth, prediction = truth.astype(float), prediction.astype(float)
            counted = np.isfinite(truth) & (truth >= LOW) & (truth <= HIGH)
            with np.errstate(divide="ignore"):
                depths = aligned(alignment, truth, prediction, counted)
            errors.append(depth_errors(truth, depths, LOW, HIGH))
            limited = np.clip(depths, LOW, HIGH)
            known = np.where(counted, truth, 1.0)
            loss = depth_tools.mse_log_loss(gt=known, pred=np.where(counted, limited, 1.0), mask=counted)
            assert errors[-1]["rmse_log"] ** 2 == pytest.approx(float(loss), rel=1e-9)
            for power in (1, 2, 3):
                share = depth_tools.dx_loss(gt=known, pred=np.where(counted, limited, 1.0), mask=counted, x=power)
                assert errors[-1][f"delta{power}"] == pytest.approx(float(share), abs=1e-12)
        cases.append(case("depth", pairs, parts=1 + seed % 3, alignment=alignment, max_depth=HIGH))
        wanted.append({key: np.mean([error[key] for error in errors]) for key in errors[0]})
    for report, errors in zip(compute(*cases), wanted):
        for key, value in errors.items():
            assert report["scalars"][key] == pytest.approx(value, rel=1e-8), key


def test_what_cannot_be_aligned(compute):
    pair = [([[1.0, 2.0]], [[0.0, 0.0]])]
    median, inverse = compute(case("depth", pair, alignment="median"), case("depth", pair, alignment="inverse_scale_shift"))
    assert "median" in median["error"] and "max_depth" in inverse["error"]
