"""Environments: ours in Gymnasium, and Gymnasium's for the learners of the toolkit."""

import json
import subprocess
import sys
import warnings

import gymnasium
import numpy as np
import opendr
import opendr.simulation
import pytest
from gymnasium import spaces
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from opendr import _opendr
from opendr.simulation import Environment, VectorEnvironment
from opendr.simulation._bridge import Bridge

IDS = list(opendr.simulation.environments())
#: Warnings of Gymnasium's checker that its own CartPole, MountainCar and Pendulum cause too.
KNOWN_WARNINGS = ("-infinity", "infinity", "symmetric and normalized")


def script(text):
    return subprocess.run([sys.executable, "-c", text], capture_output=True, text=True)


def same(ours, theirs, tolerance=0.0):
    """Returns whether two observations have the same structure, type and, within a tolerance, values."""
    if isinstance(theirs, dict):
        assert ours.keys() == theirs.keys()
        return all(same(ours[key], theirs[key], tolerance) for key in theirs)
    if isinstance(theirs, tuple):
        return len(ours) == len(theirs) and all(map(same, ours, theirs))
    assert (ours.dtype, ours.shape) == (theirs.dtype, theirs.shape)
    return bool(np.all(np.abs(np.asarray(ours, float) - np.asarray(theirs, float)) <= tolerance))


@pytest.mark.parametrize("name", IDS)
def test_gymnasiums_checker_passes(name):
    env = gymnasium.make(f"opendr/{name}", render_mode="rgb_array")
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        check_env(env.unwrapped)
    told = [str(warning.message) for warning in told]
    assert not [text for text in told if not any(known in text for known in KNOWN_WARNINGS)]


def test_every_environment_is_registered():
    assert {"CartPole-v1", "UavDepthCorridor-v1", "UavDepthCorridor-dyn-v1"} <= set(IDS)
    env = gymnasium.make("opendr/UavDepthCorridor-v1", walls=1.0)
    assert env.spec.max_episode_steps == 100
    assert env.observation_space["depth_cam"] == spaces.Box(0, 255, (64, 64, 1), np.uint8)
    envs = gymnasium.make_vec("opendr/UavDepthCorridor-v1", num_envs=2, threads=2)
    assert isinstance(envs.unwrapped, VectorEnvironment)
    assert envs.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP


def test_the_name_of_the_module_is_enough():
    done = script("import gymnasium; print(gymnasium.make('opendr.simulation:opendr/CartPole-v1').reset(seed=1)[0])")
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == str(gymnasium.make("CartPole-v1").reset(seed=1)[0]).split()


def test_gymnasium_is_optional():
    begin = "import sys; sys.modules['gymnasium'] = None; import opendr.simulation as simulation;"
    assert script(f"{begin} assert 'CartPole-v1' in simulation.environments()").returncode == 0
    refused = script(f"{begin} simulation.Environment")
    assert refused.returncode == 1 and "opendr-rs[gymnasium]" in refused.stderr.splitlines()[-1]


def played(envs, mode, steps=300):
    """Returns all results of environments for actions determined by a seed."""
    random, over = np.random.default_rng(7), np.zeros(envs.num_envs, bool)
    answers = [(*envs.reset(seed=3), over)]
    for _ in range(steps):
        if mode is AutoresetMode.DISABLED and over.any():
            observations, _ = envs.reset(options={"reset_mask": over})
            answers.append((observations,))
        observations, rewards, terminations, truncations, infos = envs.step(random.integers(0, 2, envs.num_envs))
        over = terminations | truncations
        answers.append((observations, rewards, terminations, truncations, infos))
    return answers


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_side_by_side_is_as_gymnasiums(mode):
    count = 8
    theirs = SyncVectorEnv([lambda: gymnasium.make("CartPole-v1")] * count, autoreset_mode=mode)
    ours = VectorEnvironment("CartPole-v1", count, autoreset_mode=mode)
    assert ours.single_observation_space == theirs.single_observation_space
    assert (ours.observation_space, ours.action_space) == (theirs.observation_space, theirs.action_space)
    ended = 0
    for our, their in zip(played(ours, mode), played(theirs, mode)):
        assert same(our[0], their[0], 1e-6)
        if len(their) < 5:
            continue
        for at in (1, 2, 3):
            assert our[at].dtype == their[at].dtype
            np.testing.assert_array_equal(our[at], their[at])
        assert our[4].keys() == their[4].keys()
        if "final_obs" in their[4]:
            np.testing.assert_array_equal(our[4]["_final_obs"], their[4]["_final_obs"])
            np.testing.assert_array_equal(our[4]["_final_info"], their[4]["_final_info"])
            for index in np.flatnonzero(their[4]["_final_obs"]):
                assert same(our[4]["final_obs"][index], their[4]["final_obs"][index], 1e-6)
        ended += np.count_nonzero(their[2])
    assert ended > 2 * count


def test_side_by_side_is_as_alone():
    count, name = 3, "UavDepthCorridor-v1"
    threads = [VectorEnvironment(name, count, threads=number, autoreset_mode="SameStep") for number in (1, 3)]
    alone = SyncVectorEnv([lambda: Environment(name)] * count, autoreset_mode="SameStep")
    for envs in (*threads, alone):
        envs.action_space.seed(5)
        envs.reset(seed=11)
    ended = 0
    for _ in range(60):
        actions = alone.action_space.sample()
        wanted = alone.step(actions)
        ended += np.count_nonzero(wanted[2] | wanted[3])
        for envs in threads:
            given = envs.step(actions)
            assert same(given[0], wanted[0])
            for at in (1, 2, 3):
                np.testing.assert_array_equal(given[at], wanted[at])
            assert given[4].keys() == wanted[4].keys()
            np.testing.assert_array_equal(given[4]["success"], wanted[4]["success"])
            if "final_obs" in wanted[4]:
                for ours, theirs in zip(given[4]["final_obs"], wanted[4]["final_obs"]):
                    assert (ours is None and theirs is None) or same(ours, theirs)
                np.testing.assert_array_equal(
                    given[4]["final_info"]["collision"], wanted[4]["final_info"]["collision"]
                )
    assert ended > 0


def test_answers_are_copies_unless_told_otherwise():
    kept = VectorEnvironment("CartPole-v1", 2)
    first, _ = kept.reset(seed=1)
    before = first.copy()
    assert first.flags.writeable and kept.step([0, 1])[0] is not first
    np.testing.assert_array_equal(first, before)
    same_memory = VectorEnvironment("CartPole-v1", 2, copy=False)
    first, _ = same_memory.reset(seed=1)
    before = first.copy()
    assert same_memory.step([0, 1])[0] is first
    assert np.any(first != before) and not first.flags.writeable


def test_a_snapshot_is_come_back_to():
    env = Environment("UavDepthCorridor-dyn-v1")
    env.action_space.seed(1)
    env.reset(seed=1)
    env.step(env.action_space.sample())
    snapshot, actions = env.snapshot(), [env.action_space.sample() for _ in range(3)]
    wanted = [env.step(action) for action in actions]
    other = Environment("UavDepthCorridor-dyn-v1")
    other.restore(json.loads(json.dumps(snapshot)))
    for action, step in zip(actions, wanted):
        again = other.step(action)
        assert same(again[0], step[0]) and again[1:] == step[1:]
    with pytest.raises(ValueError, match="snapshot"):
        Environment("CartPole-v1").restore(snapshot)
    with pytest.raises(ValueError, match="not a snapshot"):
        other.restore("{}")

    envs = VectorEnvironment("CartPole-v1", 4)
    envs.reset(seed=2)
    snapshot = envs.snapshot()
    wanted = envs.step([0, 1, 0, 1])[0]
    envs.restore(snapshot)
    np.testing.assert_array_equal(envs.step([0, 1, 0, 1])[0], wanted)


def test_pictures_are_drawn_where_asked_for():
    env = gymnasium.make("opendr/CartPole-v1", render_mode="rgb_array")
    env.reset(seed=1)
    picture = env.render()
    assert picture.dtype == np.uint8 and picture.ndim == 3 and picture.shape[2] == 3 and picture.std() > 5
    assert Environment("CartPole-v1").render() is None
    with pytest.raises(ValueError, match="human"):
        Environment("CartPole-v1", render_mode="human")
    with pytest.raises(NotImplementedError):
        VectorEnvironment("CartPole-v1", 2, render_mode="rgb_array")


def test_parameters_and_options():
    assert not np.array_equal(
        Environment("CartPole-v1").reset(seed=1, options={"low": -0.01, "high": 0.01})[0],
        Environment("CartPole-v1").reset(seed=1)[0],
    )
    with pytest.raises(opendr.InvalidParam, match="no parameter 'wals'|wals"):
        gymnasium.make("opendr/UavDepthCorridor-v1", wals=1.0)
    with pytest.raises(opendr.NotFound, match="CartPole-v1"):
        Environment("CartPole-v9")
    with pytest.raises(opendr.InvalidParam, match="0 environments"):
        VectorEnvironment("CartPole-v1", 0)
    with pytest.raises(opendr.InvalidParam, match="NextStep"):
        VectorEnvironment("CartPole-v1", 1, autoreset_mode="sometimes")


def test_a_time_limit_can_be_shorter():
    env = gymnasium.make("opendr/Pendulum-v1", max_episode_steps=5)
    env.reset(seed=1)
    assert [env.step(np.zeros(1, np.float32))[3] for _ in range(5)] == [False] * 4 + [True]
    with pytest.raises(opendr.InvalidParam, match="its own limit, 200"):
        gymnasium.make_vec("opendr/Pendulum-v1", num_envs=2, max_episode_steps=5)


@pytest.mark.parametrize("action", [[np.nan], [2.5], [[0.0]], 0.0, ["left"], [None], [1j]])
def test_wrong_actions_are_refused_and_change_nothing(action):
    env, untouched = Environment("Pendulum-v1"), Environment("Pendulum-v1")
    for each in (env, untouched):
        each.reset(seed=1)
    with pytest.raises(opendr.InvalidInput):
        env.step(action)
    right = np.ones(1, np.float32)
    assert env.step(right)[1] == untouched.step(right)[1]


def test_wrong_calls_are_told():
    env = Environment("CartPole-v1")
    with pytest.raises(opendr.InvalidInput, match="reset"):
        env.step(0)
    env.reset(seed=1)
    for action in (2, -1, 0.5, np.nan):
        with pytest.raises(opendr.InvalidInput):
            env.step(action)
    while not env.step(1)[2]:
        pass
    with pytest.raises(opendr.InvalidInput, match="over"):
        env.step(1)

    envs = VectorEnvironment("CartPole-v1", 3, autoreset_mode="Disabled")
    envs.reset(seed=1)
    with pytest.raises(opendr.InvalidInput, match="environment 1"):
        envs.step([0, 7, 1])
    with pytest.raises(opendr.InvalidInput, match=r"\(2,\).*\(3,\)"):
        envs.step([0, 1])
    for mask in (np.zeros(3, bool), np.ones(2, bool), [True] * 3):
        with pytest.raises(opendr.InvalidInput, match="mask"):
            envs.reset(options={"reset_mask": mask})
    with pytest.raises(opendr.InvalidInput, match="2 seeds"):
        envs.reset(seed=[1, 2])


def act(native, *parts):
    """Takes a step in an environment of Python, as the learners of the toolkit do."""
    for array, part in zip(native.action, parts):
        np.asarray(array)[...] = part
    return native.step()


def seen(native):
    return [np.asarray(array).copy() for array in native.observation]


def test_hopper_is_stepped_from_native_code():
    native = _opendr.Environment.of_python(Bridge(gymnasium.make("Hopper-v5")))
    spec = native.spec
    assert (spec["id"], spec["max_episode_steps"]) == ("Hopper-v5", 1000)
    assert (spec["observation"]["dtype"], spec["observation"]["shape"]) == ("float64", (11,))
    beside = gymnasium.make("Hopper-v5")
    beside.action_space.seed(3)
    native.reset(3)
    first, _ = beside.reset(seed=3)
    np.testing.assert_allclose(seen(native)[0], first, rtol=1e-6, atol=1e-7)
    ended = 0
    for _ in range(200):
        action = beside.action_space.sample()
        observation, reward, terminated, truncated, info = beside.step(action)
        ours = act(native, action)
        np.testing.assert_allclose(seen(native)[0], observation, rtol=1e-6, atol=1e-7)
        assert ours[:3] == (reward, terminated, truncated)
        assert ours[3]["x_position"] == info["x_position"]
        if terminated or truncated:
            ended += 1
            beside.reset(seed=ended)
            native.reset(ended)
    assert ended > 0


class Everything(gymnasium.Env):
    """Has every kind of space, and returns its inputs as results."""

    def __init__(self):
        self.action_space = spaces.Dict(
            {
                "z": spaces.Discrete(3, start=-1),
                "a": spaces.Tuple([spaces.MultiDiscrete([3, 4], start=[1, 2]), spaces.MultiBinary(3)]),
                "m": spaces.Box(-0.1, 0.1, (2, 2), np.float64),
            }
        )
        self.observation_space = spaces.Dict(
            {"same": self.action_space, "picture": spaces.Box(0, 255, (4, 3, 3), np.uint8)}
        )
        self.fail = None

    def _observation(self, action):
        return {"same": action, "picture": np.arange(36, dtype=np.uint8).reshape(4, 3, 3)}

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.action_space.seed(seed)
        self.asked = {"seed": seed, "options": options}
        return self._observation(self.action_space.sample()), {"text": "x", "array": np.zeros(2)}

    def step(self, action):
        assert self.action_space.contains(action), action
        if self.fail is not None:
            return self.fail()
        self.asked = action
        info = {"is_success": np.True_, "count": np.int64(3), 5: 1.0}
        return self._observation(action), np.float32(0.5), np.False_, np.False_, info


def test_every_kind_of_space_goes_through():
    env = Everything()
    native = _opendr.Environment.of_python(Bridge(env))
    assert native.reset(4, {"low": 0.5}) == {}
    assert env.asked == {"seed": 4, "options": {"low": 0.5}}
    # Parts in the order of their names: a[0], a[1], m, z; values count from 0 except those of Discrete.
    bound = np.float32(0.1)
    reward, terminated, truncated, info = act(native, [2, 0], [1, 0, 1], [[bound, -bound], [0, 0.05]], -1)
    assert (reward, terminated, truncated) == (0.5, False, False)
    assert info == {"is_success": 1.0, "success": 1.0, "count": 3.0}
    np.testing.assert_array_equal(env.asked["a"][0], [3, 2])
    np.testing.assert_array_equal(env.asked["a"][1], [1, 0, 1])
    assert env.asked["z"] == -1 and env.asked["m"].dtype == np.float64
    picture, multi, binary, real, choice = seen(native)
    np.testing.assert_array_equal(picture.ravel(), np.arange(36))
    np.testing.assert_array_equal(multi, [2, 0])
    np.testing.assert_array_equal(binary, [1, 0, 1])
    np.testing.assert_allclose(real, env.asked["m"], rtol=1e-6)
    assert choice == -1


class Boom(Exception):
    pass


def boom():
    raise Boom("in the middle")


@pytest.mark.parametrize(
    ("fail", "error", "message"),
    [
        (boom, Boom, "in the middle"),
        (lambda: (None, 0.0, False, {}), ValueError, "4 values"),
        (lambda: ({"same": 1}, 0.0, False, False, {}), KeyError, "picture"),
        (lambda: (Everything()._observation(ACTION), np.nan, False, False, {}), RuntimeError, "reward"),
        (lambda: (Everything()._observation(ACTION), "much", False, False, {}), ValueError, "much"),
    ],
)
def test_what_goes_wrong_in_python_is_told(fail, error, message):
    env = Everything()
    native = _opendr.Environment.of_python(Bridge(env))
    native.reset(1)
    env.fail = fail
    with pytest.raises(error, match=message):
        act(native, [0, 0], [0, 0, 0], 0.0, 0)
    env.fail = None
    with pytest.raises(opendr.InvalidInput, match="reset"):
        act(native, [0, 0], [0, 0, 0], 0.0, 0)
    native.reset(2)
    assert act(native, [0, 0], [0, 0, 0], 0.0, 0)[0] == 0.5


ACTION = Everything().action_space.sample()


def test_what_no_learner_takes_is_refused():
    env = Everything()
    env.action_space = spaces.Text(5)
    with pytest.raises(NotImplementedError, match="Text"):
        Bridge(env)
    env.action_space = spaces.Discrete(2**40)
    with pytest.raises(NotImplementedError, match="discrete space"):
        _opendr.Environment.of_python(Bridge(env))
    env = Everything()
    native = _opendr.Environment.of_python(Bridge(env))
    native.reset(1)
    with pytest.raises(opendr.InvalidInput, match="outside"):
        act(native, [3, 0], [0, 0, 0], 0.0, 0)
