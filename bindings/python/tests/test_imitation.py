"""Policies that imitate: demonstrations are recorded by the command, and learned from the data set or from a prior."""

import subprocess
import sys

import pytest
from opendr.control.reinforcement_learning import ActLearner, DiffusionPolicyLearner
from opendr.engine.datasets import ExternalDataset

#: A network that trains in a test.
SMALL = {"training_steps": 4, "batch_size": 8, "warmup_steps": 0}
ACT = {**SMALL, "chunk_size": 4, "dim_model": 16, "n_heads": 2, "dim_feedforward": 32}


@pytest.fixture(scope="module")
def pushes(tmp_path_factory):
    """Demonstrations of the teacher of PlanarPush-v1, in LeRobot's format."""
    folder = tmp_path_factory.mktemp("imitation") / "pushes"
    command = [sys.executable, "-m", "opendr", "sim", "record", "PlanarPush-v1", "--controller", "planar-push-teacher"]
    done = subprocess.run([*command, "--episodes", "3", "--out", folder], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "3 demonstrations" in done.stderr
    return ExternalDataset(str(folder), "lerobot")


@pytest.mark.parametrize(("learner", "small"), [(ActLearner, ACT), (DiffusionPolicyLearner, SMALL)])
def test_a_policy_learns_from_a_data_set(pushes, tmp_path, learner, small):
    policy = learner(device="cpu")
    outcome = policy.fit(dataset=pushes, val_dataset=pushes, silent=True, out=tmp_path / "run", **small)
    assert outcome["demonstrations"] == 3 and outcome["steps"] == 4
    assert outcome["val_action_error"] > 0
    evaluation = policy.eval("PlanarPush-v1", episodes=1)
    assert evaluation["episodes"] == 1 and "success_rate" in evaluation


def test_a_policy_learns_from_a_prior(tmp_path):
    policy = ActLearner(device="cpu")
    outcome = policy.fit(
        "PlanarPush-v1", demonstration_prior="planar-push-teacher", demonstration_episodes=2, n_eval_episodes=0, silent=True,
        out=tmp_path / "run", **ACT,
    )
    assert outcome["demonstrations"] == 2


def test_wrong_sources_are_refused(pushes, tmp_path):
    policy = ActLearner(device="cpu")
    with pytest.raises(ValueError, match="two sources"):
        policy.fit("PlanarPush-v1", dataset=pushes)
    with pytest.raises(ValueError, match="demonstration_prior"):
        policy.fit("PlanarPush-v1", silent=True, out=tmp_path / "none")
    with pytest.raises(ValueError, match="lerobot"):
        policy.fit(dataset=ExternalDataset(str(tmp_path), "coco"), silent=True, out=tmp_path / "coco")
