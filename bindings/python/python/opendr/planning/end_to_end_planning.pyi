"""Learners of the task end_to_end_planning. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import PathLike
from opendr._upstream.learners.planning import Planner
from opendr.engine.data import Observation
from opendr.engine.target import RlTarget

class EndToEndPlanningRLLearner(Planner):
    """Flies a drone between obstacles, from its depth camera to heading and yaw.

    Task: end_to_end_planning. ``infer`` takes:

        observation: Observation.

    and gives: RlTarget.

    Args:
        deterministic: Whether it takes its most likely actions, else some by chance. (default True; may change
            while running, also for one call of infer)
        seed: What fixes those by chance, from the beginning of a stream on. (default 0)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        lr: Learning rate of Adam at the beginning; it falls evenly to zero. With OpenDR's values of this and of
            the next two (3e-4, 1024, 64) chance moves the policy away from the way that the drone proposes by
            itself. (default 0.0001; 0 to 1)
        n_steps: Steps of all environments together between two updates. (default 8192; 1 to 1e+06)
        batch_size: Steps in a minibatch. (default 1024; 1 to 1e+06)
        total_timesteps: Steps of all environments together. (default 300000; 1 to 2e+09; in OpenDR iters)
        n_envs: How many environments are stepped together. (default 8; 1 to 65536)
        num_workers: Threads that step environments and learn; they change no bit. (default 2; 1 to 256)
        eval_freq: Steps between two measurements of the policy; 0 measures it at the end only. (default 0; 0 to
            1e+09)
        n_eval_episodes: Episodes of a measurement. (default 100; 1 to 1e+06)
        checkpoint_after_iter: Steps between two checkpoints. (default 20000; 1 to 1e+09)
        checkpoints_kept: How many checkpoints are kept. (default 2; 1 to 1000)
        preset: Whether settings that are known to solve the environment stand in for those that have their
            default. (default True)
    """

    deterministic: bool
    seed: int
    def __init__(self, env: Any = ..., lr: float = ..., n_steps: int = ..., iters: int = ..., batch_size: int = ..., checkpoint_after_iter: int = ..., temp_path: str = ..., device: str = ..., *, optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_load_iter: int = ..., threshold: float = ..., scale: float = ..., seed: int = ..., total_timesteps: int = ..., n_envs: int = ..., num_workers: int = ..., eval_freq: int = ..., n_eval_episodes: int = ..., checkpoints_kept: int = ..., preset: bool = ..., deterministic: bool = ...) -> None: ...
    @overload
    def infer(self, observation: Union[Observation, ArrayLike], deterministic: bool = ...) -> RlTarget: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, observation: Sequence[Union[Observation, ArrayLike]], deterministic: bool = ...) -> list[RlTarget]: ...
    @overload
    def infer(self, observation: Iterator[Union[Observation, ArrayLike]], deterministic: bool = ...) -> Iterator[RlTarget]: ...
    def fit(self, env: Any = ..., logging_path: PathLike = ..., verbose: bool = ..., *, val_env: Any = ..., silent: bool = ..., lr: float = ..., n_steps: int = ..., batch_size: int = ..., seed: int = ..., total_timesteps: int = ..., iters: int = ..., n_envs: int = ..., num_workers: int = ..., eval_freq: int = ..., n_eval_episodes: int = ..., checkpoint_after_iter: int = ..., checkpoints_kept: int = ..., preset: bool = ...) -> dict[str, Any]: ...
    @classmethod
    def download(cls, path: Optional[PathLike] = ..., url: Optional[str] = ..., *, mode: str = ..., verbose: bool = ..., variant: Optional[str] = ...) -> str: ...

class AgiEnv:
    """Not here yet: opendr.simulation has "UavDepthCorridor-v1", which needs no Webots."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...

class UAVDepthPlanningEnv:
    """Not here yet: opendr.simulation has "UavDepthCorridor-v1", which needs no Webots."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
