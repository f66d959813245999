"""Policies: training in environments of the toolkit and of Python, evaluation, saving, errors."""

import gymnasium
import numpy as np
import opendr
import pytest
from opendr import _opendr, priors
from opendr.control.reinforcement_learning import PpoLearner, ResidualPpoLearner, SacLearner, ShapedPpoLearner
from opendr.engine.data import Observation
from opendr.engine.learners import LearnerRL
from opendr.engine.target import RlTarget

SHORT = {"total_timesteps": 1024, "eval_freq": 512, "n_eval_episodes": 3, "checkpoint_after_iter": 512}


@pytest.fixture(scope="module")
def policy(tmp_path_factory):
    learner = PpoLearner()
    learner.outcome = learner.fit("CartPole-v1", silent=True, out=tmp_path_factory.mktemp("run") / "run", **SHORT)
    return learner


def test_a_policy_learns_by_name(policy, tmp_path):
    assert isinstance(policy, LearnerRL) and policy.is_ready
    assert policy.outcome["steps"] == 1024 and len(policy.outcome["val_return"]) >= 2
    assert policy.outcome["report"]["environment"] == "CartPole-v1"
    chosen = policy.infer(np.array([0.0, 0.0, 0.05, 0.0]))
    assert isinstance(chosen, RlTarget) and int(chosen) in (0, 1)
    policy.save(tmp_path / "copy")
    copy = PpoLearner()
    copy.load(tmp_path / "copy")
    seen = Observation([0.1, 0.0, -0.05, 0.2])
    assert np.array_equal(copy.infer(seen), policy.infer(seen))
    with pytest.raises(ValueError, match="3 numbers"):
        policy.infer(np.zeros(3))


def test_the_same_training_gives_the_same_policy(policy, tmp_path):
    again = PpoLearner(**SHORT)
    again.fit("CartPole-v1", silent=True, out=tmp_path / "run")
    seen = np.random.default_rng(0).normal(0, 0.1, (20, 4))
    assert [int(again.infer(row)) for row in seen] == [int(policy.infer(row)) for row in seen]


#: Policies over observations with pretrained models; those of active perception take images (test_active.py).
POLICIES = [
    entry
    for entry in _opendr.entries()
    if entry["fit_in"] and entry["ports"][0]["type"] == "Observation" and _opendr.models(entry["name"])
]


@pytest.mark.parametrize("entry", POLICIES, ids=lambda entry: entry["name"])
def test_pretrained_policies(entry, tmp_path):
    cls = opendr.learners()[entry["name"]]
    learner = cls(device="cpu")
    with pytest.raises(FileNotFoundError, match=r"download\(\).*load\(\).*fit\(\)"):
        learner.infer(np.zeros(1))
    if entry["name"].startswith(("residual_", "shaped_")):
        # A correction or a command belongs to a prior of the user's choice.
        with pytest.raises(opendr.NotFound, match="no pretrained weights"):
            learner.load()
        return
    assert learner.load() is True and learner.is_ready
    numbers = learner.eval(episodes=3)
    assert numbers["episodes"] == 3
    learner.save(tmp_path / "saved")
    again = cls(device="cpu")
    again.load(tmp_path / "saved")
    assert {**again.eval(episodes=3), "seconds": 0} == {**numbers, "seconds": 0}
    with pytest.raises(opendr.Unsupported, match=entry["class_name"]):
        learner.optimize("cpu")


def test_eval_is_of_fixed_episodes(policy):
    numbers = policy.eval(episodes=5)
    assert numbers["episodes"] == 5 and numbers["mean_return"] == numbers["mean_length"] > 9
    same = policy.eval(lambda: gymnasium.make("opendr.simulation:opendr/CartPole-v1"), episodes=5)
    assert same["mean_return"] == numbers["mean_return"]
    with pytest.raises(ValueError, match="the policy needs"):
        policy.eval("Pendulum-v1", episodes=1)


def test_a_policy_learns_in_an_environment_of_gymnasium(tmp_path):
    learner = SacLearner(net_arch=[16, 16], learning_starts=64, batch_size=16)
    outcome = learner.fit(
        lambda: gymnasium.make("Pendulum-v1"), silent=True, out=tmp_path / "run", total_timesteps=400, eval_freq=0,
        n_eval_episodes=1,
    )
    assert outcome["steps"] == 400 and len(outcome["val_return"]) == 1
    assert -2 <= float(learner.infer(np.array([1.0, 0.0, 0.0]))) <= 2


def test_one_environment_trains_without_another_to_measure_in(tmp_path):
    learner = PpoLearner(n_steps=64, preset=False)
    outcome = learner.fit(gymnasium.make("CartPole-v1"), silent=True, out=tmp_path / "run", total_timesteps=128)
    assert outcome["steps"] == 128 and "val_return" not in outcome
    with pytest.raises(opendr.Unsupported, match="give a function"):
        learner.fit(gymnasium.make("CartPole-v1"), silent=True, out=tmp_path / "two", n_envs=2)


class Breaking(gymnasium.Wrapper):
    """Raises at step 700."""

    steps = 0

    def step(self, action):
        self.steps += 1
        if self.steps == 700:
            raise RuntimeError("the motor burnt")
        return super().step(action)


def test_what_an_environment_raises_leaves_the_checkpoint(tmp_path):
    learner = PpoLearner(n_steps=64, n_envs=1, preset=False)
    made = iter([Breaking(gymnasium.make("CartPole-v1")), gymnasium.make("CartPole-v1")])
    with pytest.raises(RuntimeError, match="the motor burnt"):
        learner.fit(lambda: next(made), silent=True, out=tmp_path / "run", **SHORT)
    outcome = learner.fit(lambda: gymnasium.make("CartPole-v1"), silent=True, out=tmp_path / "run", resume=True, **SHORT)
    assert outcome["steps"] == 1024


def test_wrong_environments_are_told(tmp_path):
    learner = PpoLearner()
    with pytest.raises(ValueError, match="no environment"):
        learner.fit(out=tmp_path / "run")
    with pytest.raises(FileNotFoundError, match="CartPole-v1"):
        learner.fit("CartPole-v7", silent=True, out=tmp_path / "run")
    with pytest.raises(ValueError, match="gravity"):
        learner.fit("CartPole-v1", env_params={"gravity": -1}, silent=True, out=tmp_path / "run")
    with pytest.raises(TypeError, match="no argument 'epochs'"):
        learner.fit("CartPole-v1", silent=True, out=tmp_path / "run", epochs=3)


def test_a_shaped_policy_begins_as_its_prior(tmp_path):
    learner = ShapedPpoLearner()
    steps = {"total_timesteps": 256, "n_steps": 64, "n_envs": 1, "n_eval_episodes": 1}
    learner.fit("Pendulum-v1", prior="pendulum-energy", out=tmp_path / "run", silent=True, **steps)
    numbers = learner.eval(episodes=2)
    assert [row["name"] for row in numbers["controllers"]] == ["prior", "prior and policy"]
    learner.save(tmp_path / "saved")
    again = ShapedPpoLearner()
    again.load(tmp_path / "saved")
    seen = Observation([1.0, 0.0, 0.5])
    assert list(np.asarray(again.infer(seen))) == list(np.asarray(learner.infer(seen)))
    # A function takes no commands.
    priors.register("test-uncommanded", 1, lambda seen: [0.0])
    with pytest.raises(opendr.Unsupported, match="follows no commands"):
        ShapedPpoLearner().fit("Pendulum-v1", prior="test-uncommanded", out=tmp_path / "none", silent=True, **steps)


def test_a_function_is_a_prior(tmp_path):
    def damp(seen):
        return [max(-2.0, min(2.0, -2.0 * seen[1] - 0.5 * seen[2]))]

    priors.register("test-damping", 1, damp, "damps a pendulum")
    assert "test-damping" in priors.names() and "corridor-reactive" in priors.names()
    with pytest.raises(ValueError, match="new version"):
        priors.register("test-damping", 1, damp)
    with pytest.raises(TypeError):
        priors.register("test-number", 1, 3)
    learner = ResidualPpoLearner()
    steps = {"total_timesteps": 256, "n_steps": 64, "n_envs": 1, "n_eval_episodes": 1}
    learner.fit("Pendulum-v1", prior="test-damping", out=tmp_path / "run", silent=True, **steps)
    numbers = learner.eval(episodes=2)
    names = [row["name"] for row in numbers["controllers"]]
    assert names == ["prior", "policy", "prior and policy"]
    # The critic alone was trained: the policy is its prior.
    assert numbers["controllers"][0]["mean_return"] == numbers["mean_return"]
    action = learner.infer(Observation([1.0, 0.0, 0.5]))
    assert list(np.asarray(action)) == pytest.approx(damp([1.0, 0.0, 0.5]), abs=1e-6)
    # An exception of the function is one of the training.
    priors.register("test-broken", 1, lambda seen: [])
    with pytest.raises(ValueError, match="0 numbers"):
        broken = ResidualPpoLearner()
        broken.fit("Pendulum-v1", prior="test-broken", out=tmp_path / "broken", silent=True, **steps)
