"""Success and returns of policies: SciPy, NumPy, and the bootstrap of Agarwal et al. (2021) written out."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binomtest, trim_mean
from programs import example

MASK = 2**64 - 1
STEP = 0x9E3779B97F4A7C15


@pytest.fixture(scope="session")
def statistics_of():
    """Computes the reports of cases, as crates/metrics/examples/episodes.rs."""
    command = example("metrics", "episodes")

    def run(*cases):
        lines = "".join(json.dumps(case) + "\n" for case in cases)
        root = Path(__file__).resolve().parents[2]
        answer = subprocess.run(command, cwd=root, input=lines, stdout=subprocess.PIPE, text=True, check=True)
        return [json.loads(line) for line in answer.stdout.splitlines()]

    return run


def mixed(bits):
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9 & MASK
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EB & MASK
    return bits ^ (bits >> 31)


class Random:
    """crates/engine/src/random.rs: xoshiro256++ and integers by Lemire's method."""

    def __init__(self, seed):
        bits = mixed((1 + STEP & MASK) ^ mixed(seed + STEP & MASK))
        self.state = []
        for _ in range(4):
            bits = bits + STEP & MASK
            self.state.append(mixed(bits))

    def bits(self):
        def rotated(number, by):
            return (number << by | number >> (64 - by)) & MASK

        a, b, c, d = self.state
        result = rotated(a + d & MASK, 23) + a & MASK
        c, d = c ^ a, d ^ b
        self.state = [a ^ d, b ^ c, c ^ (b << 17 & MASK), rotated(d, 45)]
        return result

    def below(self, end):
        refused = (2**64 - end) % end
        while True:
            product = self.bits() * end
            if product & MASK >= refused:
                return product >> 64


def bootstrap(scores, resamples, seed):
    """Interquartile means of runs drawn anew, task by task."""
    random = Random(seed)
    means = []
    for _ in range(resamples):
        drawn = [runs[random.below(len(runs))] for runs in scores for _ in runs]
        means.append(trim_mean(drawn, 0.25))
    return np.percentile(means, [2.5, 97.5])


def random_episodes(seed):
    random = np.random.default_rng(seed)
    episodes = []
    for task in range(int(random.integers(1, 4))):
        for run in range(int(random.integers(1, 7))):
            level = random.normal(scale=3)
            for _ in range(int(random.integers(1, 5))):
                score = float(random.normal(level))
                # Some tasks have no goal.
                success = None if task == 2 else bool(score > 0)
                episodes.append({"task": f"task {task}", "seed": run, "return": score, "success": success})
    return episodes


def close(value):
    return pytest.approx(value, abs=1e-9)


@pytest.mark.parametrize("seed", range(25))
def test_random_episodes(statistics_of, seed):
    episodes = random_episodes(seed)
    params = {"resamples": 200, "seed": seed}
    (report,) = statistics_of({"params": params, "episodes": episodes})
    found = report["scalars"]
    tried = [episode["success"] for episode in episodes if episode["success"] is not None]
    wilson = binomtest(sum(tried), len(tried)).proportion_ci(method="wilson")
    assert found["success_rate"] == close(np.mean(tried))
    assert [found["success_rate_low"], found["success_rate_high"]] == close([wilson.low, wilson.high])
    returns = [episode["return"] for episode in episodes]
    assert found["return_mean"] == close(np.mean(returns))
    assert found["return_std"] == close(np.std(returns))
    assert found["return_median"] == close(np.median(returns))
    runs = {}
    for episode in episodes:
        runs.setdefault(episode["task"], {}).setdefault(episode["seed"], []).append(episode["return"])
    scores = [[np.mean(runs[task][run]) for run in sorted(runs[task])] for task in sorted(runs)]
    assert found["return_iqm"] == close(trim_mean(np.concatenate(scores), 0.25))
    if max(map(len, scores)) > 1:
        assert [found["return_iqm_low"], found["return_iqm_high"]] == close(list(bootstrap(scores, 200, seed)))
    else:
        assert "return_iqm_low" not in found


def test_interval_of_the_interquartile_mean(statistics_of):
    """Against other random numbers: the ends agree as far as draws can."""
    random = np.random.default_rng(11)
    scores = random.gamma(2, size=(3, 10))
    episodes = [
        {"task": str(task), "seed": run, "return": score}
        for task, runs in enumerate(scores.tolist())
        for run, score in enumerate(runs)
    ]
    (report,) = statistics_of({"params": {"resamples": 20000}, "episodes": episodes})
    drawn = [scores[task, random.integers(0, 10, size=(20000, 10))] for task in range(3)]
    low, high = np.percentile(trim_mean(np.concatenate(drawn, axis=1), 0.25, axis=1), [2.5, 97.5])
    assert report["scalars"]["return_iqm_low"] == pytest.approx(low, abs=0.03)
    assert report["scalars"]["return_iqm_high"] == pytest.approx(high, abs=0.03)
    assert report["headline"] == "return_iqm" and "success_rate" not in report["scalars"]


@pytest.mark.parametrize("hits, count", [(0, 1), (1, 1), (0, 50), (50, 50), (1, 1000)])
def test_wilson_at_the_ends(statistics_of, hits, count):
    episodes = [{"return": 0.0, "success": at < hits} for at in range(count)]
    (report,) = statistics_of({"params": {"resamples": 100}, "episodes": episodes})
    wilson = binomtest(hits, count).proportion_ci(method="wilson")
    found = report["scalars"]
    assert [found["success_rate_low"], found["success_rate_high"]] == close([wilson.low, wilson.high])


def test_nothing(statistics_of):
    (report,) = statistics_of({"episodes": []})
    assert report["scalars"] == {"episodes": 0, "runs": 0}
