"""Prior controllers that policies start from, learn from, or are shielded by (docs/priors.md).

    from opendr import priors
    from opendr.control.reinforcement_learning import ResidualSacLearner

    priors.register("mine", 1, lambda seen: [-2.0 * seen[1] - 0.5 * seen[2]], "damps the pendulum of Pendulum-v1")
    learner = ResidualSacLearner()
    learner.fit("Pendulum-v1", prior="mine", total_timesteps=5000)

A controller of gains or matrices is one call; unlike a function it keeps its state in checkpoints:

    priors.pid("balance-pid", 1, kp=12.0, kd=3.0, measured=1, rate=2, setpoint=0.0, period=0.05, limit=2.0)
    priors.lqr("balance-lqr", 1, A, B, Q, R, state=[1, 2], limit=2.0)

A policy names its prior with the version: register the same one before the policy is loaded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, TypeVar, Union

from opendr import _opendr

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["Prior", "lqr", "names", "pid", "priors", "register"]

T = TypeVar("T")
#: A value for all axes, or one for each.
PerAxis = Union[T, Sequence[T]]


class Prior(NamedTuple):
    """A prior of this process.

    Attributes:
        name: Name, the value of the parameter ``prior``.
        version: Version, from 1; policies name it, too.
        about: What it does and where.
    """

    name: str
    version: int
    about: str


def register(name: str, version: int, act: Callable[[list[float]], Iterable[float]], about: str = "") -> None:
    """Makes a function a prior of this process.

    Args:
        name: Name, the value of the parameter ``prior``.
        version: Version, from 1; a change of the actions needs a new one.
        act: Function without state, from the numbers of an observation to those of an action.
        about: What it does and where, in one sentence.

    Raises:
        ValueError: Another prior has this name and version.
    """
    if not callable(act):
        raise TypeError(f"act is a {type(act).__name__}; give a function from an observation to an action")
    _opendr.register_prior(name, version, act, about)


def pid(
    name: str,
    version: int,
    *,
    kp: PerAxis[float],
    ki: PerAxis[float] = 0.0,
    kd: PerAxis[float] = 0.0,
    filter: PerAxis[float] = 0.0,
    error: Optional[PerAxis[int]] = None,
    measured: Optional[PerAxis[int]] = None,
    setpoint: Optional[PerAxis[float]] = None,
    rate: Optional[PerAxis[int]] = None,
    period: float,
    limit: Optional[PerAxis[float]] = None,
    levels: Optional[Sequence[float]] = None,
    about: str = "",
) -> Prior:
    """Makes a PID of numbers of the observation a prior: one for each axis of the action.

    Its integral stands still while the command is at its limit. Each argument that is not a sequence holds for all axes.

    Args:
        name: Name, the value of the parameter ``prior``.
        version: Version, from 1; other gains need a new one.
        kp: Gain of the error.
        ki: Gain of the error's integral.
        kd: Gain of the error's rate.
        filter: Time constant of the filter of the rate in seconds; 0 is none.
        error: Place in the observation, from 0, of the error itself (reference less state); one place for each axis.
        measured: Place of a number that is held at ``setpoint``, instead of ``error``.
        setpoint: Value at which ``measured`` is held.
        rate: Place of the rate of that number; without it the rate follows from differences.
        period: Seconds between two steps of the environment.
        limit: Largest magnitude of the command: the bound of the action.
        levels: For an environment with a discrete action, the command that each choice stands for; the choice nearest to the
            command is the action.
        about: What it does and where, in one sentence.

    Returns:
        The prior.

    Raises:
        ValueError: Another prior has this name and version, or gains, places and limits do not fit together.
    """
    if (error is None) == (measured is None) or (setpoint is None) != (measured is None):
        raise ValueError("give the places of errors as error, or of measured numbers as measured with their setpoint")
    places = error if error is not None else measured
    given: dict[str, Any] = {
        "kp": kp, "ki": ki, "kd": kd, "filter": filter, "place": places, "rate": rate, "setpoint": setpoint, "limit": limit,
    }
    axes = max((len(value) for value in given.values() if _is_sequence(value)), default=1)
    columns = {argument: _per_axis(argument, value, axes) for argument, value in given.items()}
    limits = None if limit is None else columns.pop("limit")
    rows = [
        ([row["kp"], row["ki"], row["kd"], row["filter"]], row["place"], row["rate"], row["setpoint"])
        for row in (dict(zip(columns, values)) for values in zip(*columns.values()))
    ]
    _opendr.register_pid(name, version, about, rows, period, (limits, None if levels is None else list(levels)))
    return Prior(name, version, about)


def lqr(
    name: str,
    version: int,
    A: ArrayLike,
    B: ArrayLike,
    Q: ArrayLike,
    R: ArrayLike,
    *,
    state: Sequence[int],
    setpoint: Optional[Sequence[float]] = None,
    trim: Optional[Sequence[float]] = None,
    limit: Optional[PerAxis[float]] = None,
    levels: Optional[Sequence[float]] = None,
    about: str = "",
) -> Prior:
    """Makes an LQR of numbers of the observation a prior: ``u = trim + K (setpoint - x)``.

    The gain K minimises the sum of ``x' Q x + u' R u`` over the steps of ``x[t + 1] = A x[t] + B u[t]``, in discrete time: of
    continuous matrices, ``I + period * A`` and ``period * B`` are those of an Euler step.

    Args:
        name: Name, the value of the parameter ``prior``.
        version: Version, from 1; other matrices need a new one.
        A: ``[states, states]``.
        B: ``[states, inputs]``.
        Q: Weights of the state, ``[states, states]``, symmetric and positive semidefinite.
        R: Weights of the command, ``[inputs, inputs]``, symmetric and positive definite.
        state: Place of each state in the observation, from 0.
        setpoint: State about which the plant was linearised and at which it is held; by default zeros.
        trim: Command that holds it there; by default zeros.
        limit: Largest magnitude of the command of each input, or of all: the bound of the action.
        levels: For an environment with a discrete action, the command that each choice stands for; the choice nearest to the
            command is the action.
        about: What it does and where, in one sentence.

    Returns:
        The prior.

    Raises:
        ValueError: Another prior has this name and version, the matrices do not fit together, (A, B) is not stabilisable, or Q has
            no weight on a state that does not decay by itself.
    """
    matrices = [_matrix(name, matrix) for name, matrix in (("A", A), ("B", B), ("Q", Q), ("R", R))]
    (states, _, _), (_, inputs, _) = matrices[:2]
    point = (list(state), [0.0] * states if setpoint is None else list(setpoint), [0.0] * inputs if trim is None else list(trim))
    limits = None if limit is None else _per_axis("limit", limit, inputs)
    _opendr.register_lqr(name, version, about, matrices, point, (limits, None if levels is None else list(levels)))
    return Prior(name, version, about)


def priors() -> list[Prior]:
    """Returns all priors of this process: the built-in ones, then those that were registered."""
    return [Prior(*row) for row in _opendr.priors()]


def names() -> list[str]:
    """Returns the names of all priors."""
    return [prior.name for prior in priors()]


def _is_sequence(value: object) -> bool:
    return hasattr(value, "__len__")


def _per_axis(name: str, value: Any, axes: int) -> list[Any]:
    """Returns the value of each axis."""
    if not _is_sequence(value):
        return [value] * axes
    if len(value) != axes:
        raise ValueError(f"{name} has {len(value)} values for {axes} axes; give one for each, or a single one for all")
    return list(value)


def _matrix(name: str, matrix: ArrayLike) -> tuple[int, int, list[float]]:
    """Returns rows, columns and numbers of a matrix."""
    from opendr.engine._arrays import array_of

    array = array_of(matrix, "float64", f"the matrix {name}")
    if array.ndim != 2:
        raise ValueError(f"{name} has the shape {array.shape}; give a matrix of two axes")
    return array.shape[0], array.shape[1], array.ravel().tolist()
