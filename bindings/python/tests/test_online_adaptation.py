"""Online fine-tuning of loaded policies."""

import numpy as np
import opendr
import pytest
from opendr.control.online_adaptation import OnlineAdapter
from opendr.control.reinforcement_learning import PpoLearner, Td3Learner
from opendr.simulation import Environment


@pytest.fixture(scope="module")
def learner():
    learner = Td3Learner()
    learner.load(variant="quad_track")
    return learner


def test_a_load_is_learned_and_saved_with_its_lineage(learner, tmp_path):
    env = Environment("QuadTrack-v1")
    adapter = OnlineAdapter(learner)
    observation, _ = env.reset(seed=1, options={"mass_factor": 1.3, "change_at": 2.0})
    for _ in range(1500):
        observation, *_ = env.step(adapter.act(observation))
    assert adapter.steps[0] == 1500 and adapter.steps[1] > 500
    assert 1.5 < adapter.distance < 8.0 and not adapter.is_disarmed
    assert {"step", "kind"} <= set(adapter.events[0])
    adapter.save(tmp_path / "adapted", "test flight")
    with pytest.raises(ValueError, match="replaces nothing"):
        adapter.save(tmp_path / "adapted", "test flight")
    adapted = Td3Learner()
    adapted.load(tmp_path / "adapted")
    assert not np.allclose(adapted.infer(observation).data, learner.infer(observation).data)
    other = OnlineAdapter(learner)
    assert other.load(tmp_path / "adapted")["adapted_on"] == "test flight"
    assert other.distance == pytest.approx(adapter.distance, rel=1e-4)
    other.restore_base()
    assert other.distance == 0.0


def test_adapted_and_frozen_are_compared(learner):
    report = OnlineAdapter(learner).eval(env_params={"mass_factor": 1.3}, env="QuadTrack-v1", episodes=1)
    frozen, adapted, _ = (one["rms_error"] for one in report["controllers"])
    assert adapted < 0.5 * frozen


def test_what_cannot_be_adapted_is_refused(learner):
    choices = PpoLearner()
    with pytest.raises(FileNotFoundError, match="no model is loaded"):
        OnlineAdapter(choices, "CartPole-v1")
    choices.load()
    with pytest.raises(opendr.Unsupported, match="states no tracking task"):
        OnlineAdapter(choices, "CartPole-v1")
    with pytest.raises(ValueError, match="observes"):
        OnlineAdapter(choices, "QuadTrack-v1")
    with pytest.raises(ValueError, match="speed"):
        OnlineAdapter(learner, speed=1.0)
