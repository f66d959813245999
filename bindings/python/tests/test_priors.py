"""Priors of gains and matrices: they act as the same laws in functions, and what does not fit together is refused."""

import numpy as np
import opendr
import pytest
from opendr import priors
from opendr.control.reinforcement_learning import PpoLearner, ResidualPpoLearner

#: The upright of Pendulum-v1 by an Euler step of 0.05 s: the states are the angle (by its sine) and the angular velocity.
A = np.array([[1.0, 0.05], [0.75, 1.0]])
B = np.array([[0.0], [0.15]])
Q, R = np.diag([1.0, 0.1]), np.array([[0.1]])


def prior_return(name, folder):
    """Mean return of a prior in Pendulum-v1, by a short training of its corrections."""
    learner = ResidualPpoLearner(preset=False)
    learner.fit(
        "Pendulum-v1", prior=name, silent=True, out=folder / name, total_timesteps=64, n_steps=32, n_envs=2, n_eval_episodes=1,
        critic_warmup=0,
    )
    prior, *_ = learner.eval(episodes=3)["controllers"]
    assert prior["name"] == "prior"
    return prior["mean_return"]


def test_the_controllers_of_the_toolkit_are_known():
    assert {"cart-pole-lqr", "pendulum-lqr", "quad-track-pid", "quad-track-lqr", "corridor-pure-pursuit"} <= set(priors.names())
    with pytest.raises(ValueError, match="registered already"):
        priors.register("pendulum-lqr", 1, lambda seen: [0.0])


def test_a_regulator_has_the_gains_of_scipy(tmp_path):
    linalg = pytest.importorskip("scipy.linalg")
    made = priors.lqr("test-lqr", 1, A, B, Q, R, state=[1, 2], limit=2.0, about="balances Pendulum-v1")
    assert made in priors.priors() and made.about == "balances Pendulum-v1"
    cost = linalg.solve_discrete_are(A, B, Q, R)
    gain = np.linalg.solve(R + B.T @ cost @ B, B.T @ cost @ A)[0]
    priors.register("test-lqr-law", 1, lambda seen: [float(np.clip(-gain @ seen[1:], -2, 2))])
    assert prior_return("test-lqr", tmp_path) == pytest.approx(prior_return("test-lqr-law", tmp_path), rel=1e-4)


def test_a_pid_has_the_gains_that_were_given(tmp_path):
    priors.pid("test-pid", 1, kp=12.0, kd=3.0, measured=1, rate=2, setpoint=0.0, period=0.05, limit=2.0)
    priors.register("test-pid-law", 1, lambda seen: [float(np.clip(-12.0 * seen[1] - 3.0 * seen[2], -2, 2))])
    assert prior_return("test-pid", tmp_path) == pytest.approx(prior_return("test-pid-law", tmp_path), rel=1e-4)
    # The same number as an error, whose sign is that of the command.
    priors.pid("test-pid-error", 1, kp=1.0, error=1, period=0.05, limit=2.0)
    priors.register("test-pid-error-law", 1, lambda seen: [seen[1]])
    assert prior_return("test-pid-error", tmp_path) == pytest.approx(prior_return("test-pid-error-law", tmp_path), rel=1e-4)


def test_choices_are_levels_of_the_command(tmp_path):
    priors.pid("test-cart-pid", 1, kp=10.0, kd=2.0, error=2, rate=3, period=0.02, levels=[-10.0, 10.0])
    learner = PpoLearner(preset=False, n_steps=64, actor_starts=1_000_000)
    steps = {"total_timesteps": 64, "n_eval_episodes": 1, "demonstration_episodes": 20}
    learner.fit("CartPole-v1", demonstration_prior="test-cart-pid", silent=True, out=tmp_path / "run", **steps)
    assert learner.eval(episodes=5)["mean_return"] > 60, "a random policy balances for about 20 steps"


def test_what_does_not_fit_together_is_refused():
    fitting = {"state": [1, 2], "limit": 2.0}
    for message, matrices, arguments in [
        (r"\(A, B\) is not stabilisable", (A, 0 * B, Q, R), fitting),
        (r"\(A, B\) is not stabilisable", (np.diag([0.5, 1.5]), [[1.0], [0.0]], Q, R), fitting),
        ("Q has no weight on a state", (A, B, 0 * Q, R), fitting),
        ("Q is not positive semidefinite", (A, B, -Q, R), fitting),
        ("Q has 0.5 in row 0, column 1", (A, B, [[1.0, 0.5], [0.0, 1.0]], R), fitting),
        ("R is not positive definite", (A, B, Q, 0 * R), fitting),
        ("B is 1 x 2; for 2 states", (A, B.T, Q, R), fitting),
        ("R is 2 x 2; for 2 states", (A, B, Q, Q), fitting),
        ("A has the shape", (A.ravel(), B, Q, R), fitting),
        ("a matrix with NaN", (np.nan * A, B, Q, R), fitting),
        ("1 places", (A, B, Q, R), {"state": [1], "limit": 2.0}),
        ("neither of limit and levels", (A, B, Q, R), {"state": [1, 2]}),
        ("both of limit and levels", (A, B, Q, R), {**fitting, "levels": [-1.0, 1.0]}),
        ("limit has 2 values for 1 axes", (A, B, Q, R), {"state": [1, 2], "limit": [1.0, 2.0]}),
        ("limits", (A, B, Q, R), {"state": [1, 2], "limit": -1.0}),
    ]:
        with pytest.raises(ValueError, match=message):
            priors.lqr("test-refused", 1, *matrices, **arguments)
    fitting = {"kp": 1.0, "error": 0, "period": 0.05, "limit": 2.0}
    for message, arguments in [
        ("measured with their setpoint", {"measured": 1}),
        ("measured with their setpoint", {"setpoint": 1.0}),
        ("measured with their setpoint", {"error": None, "measured": 1}),
        ("period of 0", {"period": 0.0}),
        ("kp", {"kp": -1.0}),
        ("rate has 1 values for 2 axes", {"error": [0, 1], "rate": [2]}),
        ("neither of limit and levels", {"limit": None}),
    ]:
        with pytest.raises(ValueError, match=message):
            priors.pid("test-refused", 1, **{**fitting, **arguments})
    assert "test-refused" not in priors.names()
    priors.pid("test-far", 1, **{**fitting, "error": 9})
    with pytest.raises(opendr.Unsupported, match="test-far reads number 9"):
        ResidualPpoLearner().fit("Pendulum-v1", prior="test-far", silent=True)
