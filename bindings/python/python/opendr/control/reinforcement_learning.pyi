"""Learners of the task reinforcement_learning. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import PathLike
from opendr._native_learner_rl import NativeLearnerRL
from opendr.engine.data import Observation
from opendr.engine.target import RlTarget

class PpoLearner(NativeLearnerRL):
    """Proximal policy optimisation: the method to begin with, for actions of any kind.

    Task: reinforcement_learning. ``infer`` takes:

        observation: Observation.

    and gives: RlTarget.

    Args:
        deterministic: Whether it takes its most likely actions, else some by chance. (default True; may change
            while running, also for one call of infer)
        seed: What fixes those by chance, from the beginning of a stream on. (default 0)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        learning_rate: Learning rate of Adam. (default 0.0003; 0 to 1)
        learning_rate_schedule: How it changes in the course of a training. (default 'constant'; one of
            'constant', 'linear')
        n_steps: Steps of each environment between two updates. (default 2048; 1 to 1e+06)
        batch_size: Steps in a minibatch. (default 64; 1 to 1e+06)
        n_epochs: How often an update goes over all steps. (default 10; 1 to 1000)
        gamma: Discount of rewards. (default 0.99; 0 to 1)
        gae_lambda: From one-step (0) to whole-episode (1) estimates of advantages. (default 0.95; 0 to 1)
        clip_range: How far probabilities of actions may move in an update. (default 0.2; 0 to 10)
        clip_range_schedule: How that changes in the course of a training. (default 'constant'; one of 'constant',
            'linear')
        clip_range_vf: How far values may move in an update; none is anywhere. It depends on the scale of rewards.
            (default None; 0 to 1e+09)
        normalize_advantage: Whether the advantages of a minibatch are brought to mean 0 and deviation 1. (default
            True)
        ent_coef: Weight of the entropy. (default 0.0; 0 to 10)
        vf_coef: Weight of the loss of values. (default 0.5; 0 to 100)
        max_grad_norm: Gradients longer than this are cut. (default 0.5; 0 to 1e+09)
        target_kl: An update ends when the policy moved by one and a half times this divergence; none is never.
            (default None; 0 to 1e+09)
        net_arch: Neurons of the hidden layers. (default [64, 64]; 1 to 4096)
        activation_fn: What stands behind every hidden layer. (default 'tanh'; one of 'tanh', 'relu')
        picture_network: What pictures go through before the hidden layers. (default 'small'; one of 'small',
            'nature', 'flat')
        gru_size: Neurons of a gated recurrent unit before the hidden layers, with which a policy remembers its
            episode; none is no memory. (default None; 1 to 4096)
        sequence_length: Steps of an environment that a recurrent policy learns from in one go, all in one
            minibatch; none is as many as fit into a minibatch. Others learn from single steps. (default None; 1
            to 1e+06)
        net_arch_vf: Neurons of the hidden layers of the values, where they are not those of the policy. (default
            None; 1 to 4096)
        ortho_init: Whether weights begin orthogonal, else as PyTorch's default. (default True)
        log_std_init: Logarithm of the first deviation of continuous actions. (default 0.0; -20 to 20)
        norm_obs: Whether observations are normalised by what training saw. (default False)
        norm_reward: Whether rewards are divided by the deviation of the discounted return. (default False)
        clip_obs: Normalised observations lie within plus and minus this. (default 10.0; 0 to 1e+09)
        clip_reward: Normalised rewards lie within plus and minus this. (default 10.0; 0 to 1e+09)
        total_timesteps: Steps of all environments together. (default 100000; 1 to 2e+09; in OpenDR iters)
        n_envs: How many environments are stepped together. (default 1; 1 to 65536)
        num_workers: Threads that step environments and learn; they change no bit. (default 1; 1 to 256)
        eval_freq: Steps between two measurements of the policy; 0 measures it at the end only. (default 10000; 0
            to 1e+09)
        n_eval_episodes: Episodes of a measurement. (default 20; 1 to 1e+06)
        checkpoint_after_iter: Steps between two checkpoints. (default 20000; 1 to 1e+09)
        checkpoints_kept: How many checkpoints are kept. (default 2; 1 to 1000)
        preset: Whether settings that are known to solve the environment stand in for those that have their
            default. (default True)
    """

    deterministic: bool
    seed: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, learning_rate: float = ..., learning_rate_schedule: Literal['constant', 'linear'] = ..., n_steps: int = ..., n_epochs: int = ..., gamma: float = ..., gae_lambda: float = ..., clip_range: float = ..., clip_range_schedule: Literal['constant', 'linear'] = ..., clip_range_vf: Optional[float] = ..., normalize_advantage: bool = ..., ent_coef: float = ..., vf_coef: float = ..., max_grad_norm: float = ..., target_kl: Optional[float] = ..., net_arch: list[Any] = ..., activation_fn: Literal['tanh', 'relu'] = ..., picture_network: Literal['small', 'nature', 'flat'] = ..., gru_size: Optional[int] = ..., sequence_length: Optional[int] = ..., net_arch_vf: Optional[list[Any]] = ..., ortho_init: bool = ..., log_std_init: float = ..., norm_obs: bool = ..., norm_reward: bool = ..., clip_obs: float = ..., clip_reward: float = ..., seed: int = ..., total_timesteps: int = ..., n_envs: int = ..., num_workers: int = ..., eval_freq: int = ..., n_eval_episodes: int = ..., checkpoints_kept: int = ..., preset: bool = ..., deterministic: bool = ...) -> None: ...
    @overload
    def infer(self, observation: Union[Observation, ArrayLike], *, deterministic: bool = ...) -> RlTarget: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, observation: Sequence[Union[Observation, ArrayLike]], *, deterministic: bool = ...) -> list[RlTarget]: ...
    @overload
    def infer(self, observation: Iterator[Union[Observation, ArrayLike]], *, deterministic: bool = ...) -> Iterator[RlTarget]: ...
    def fit(self, env: Any = ..., val_env: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, env_params: Optional[dict[str, Any]] = ..., out: Optional[PathLike] = ..., resume: bool = ..., learning_rate: float = ..., learning_rate_schedule: Literal['constant', 'linear'] = ..., n_steps: int = ..., batch_size: int = ..., n_epochs: int = ..., gamma: float = ..., gae_lambda: float = ..., clip_range: float = ..., clip_range_schedule: Literal['constant', 'linear'] = ..., clip_range_vf: Optional[float] = ..., normalize_advantage: bool = ..., ent_coef: float = ..., vf_coef: float = ..., max_grad_norm: float = ..., target_kl: Optional[float] = ..., net_arch: list[Any] = ..., activation_fn: Literal['tanh', 'relu'] = ..., picture_network: Literal['small', 'nature', 'flat'] = ..., gru_size: Optional[int] = ..., sequence_length: Optional[int] = ..., net_arch_vf: Optional[list[Any]] = ..., ortho_init: bool = ..., log_std_init: float = ..., norm_obs: bool = ..., norm_reward: bool = ..., clip_obs: float = ..., clip_reward: float = ..., seed: int = ..., total_timesteps: int = ..., iters: int = ..., n_envs: int = ..., num_workers: int = ..., eval_freq: int = ..., n_eval_episodes: int = ..., checkpoint_after_iter: int = ..., checkpoints_kept: int = ..., preset: bool = ...) -> dict[str, Any]: ...

class SacLearner(NativeLearnerRL):
    """Soft actor-critic: few steps for continuous actions, where steps are dear.

    Task: reinforcement_learning. ``infer`` takes:

        observation: Observation.

    and gives: RlTarget.

    Args:
        deterministic: Whether it takes its most likely actions, else some by chance. (default True; may change
            while running, also for one call of infer)
        seed: What fixes those by chance, from the beginning of a stream on. (default 0)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        learning_rate: Learning rate of Adam, of all networks. (default 0.0003; 0 to 1)
        buffer_size: Steps that are remembered. (default 1000000; 1 to 1e+09)
        learning_starts: Steps of all environments, with actions by chance, before learning begins. (default 100;
            0 to 1e+09)
        batch_size: Steps that one gradient step learns from. (default 256; 1 to 1e+06)
        tau: How far targets move to their networks at a time. (default 0.005; 0 to 1)
        gamma: Discount of rewards. (default 0.99; 0 to 1)
        train_freq: Steps of each environment between two updates. (default 1; 1 to 1e+06)
        gradient_steps: Gradient steps of an update; none is one for each step that was taken. (default 1; 1 to
            1e+06)
        norm_obs: Whether observations are normalised by what training saw. (default False)
        clip_obs: Normalised observations lie within plus and minus this. (default 10.0; 0 to 1e+09)
        net_arch: Neurons of the hidden layers. (default [256, 256]; 1 to 4096)
        activation_fn: What stands behind every hidden layer. (default 'relu'; one of 'tanh', 'relu')
        picture_network: What pictures go through before the hidden layers. (default 'small'; one of 'small',
            'nature', 'flat')
        gru_size: Neurons of a gated recurrent unit before the hidden layers, with which a policy remembers its
            episode; none is no memory. (default None; 1 to 4096)
        ent_coef: Weight of the entropy; none is found while learning. (default None; 0 to 1e+06)
        ent_coef_init: What that weight is begun with. (default 1.0; 1e-09 to 1e+06)
        target_entropy: The entropy to be held; none is minus the number of axes. (default None; -1e+06 to 1e+06)
        target_update_interval: Gradient steps between two moves of the targets. (default 1; 1 to 1e+06)
        total_timesteps: Steps of all environments together. (default 100000; 1 to 2e+09; in OpenDR iters)
        n_envs: How many environments are stepped together. (default 1; 1 to 65536)
        num_workers: Threads that step environments and learn; they change no bit. (default 1; 1 to 256)
        eval_freq: Steps between two measurements of the policy; 0 measures it at the end only. (default 10000; 0
            to 1e+09)
        n_eval_episodes: Episodes of a measurement. (default 20; 1 to 1e+06)
        checkpoint_after_iter: Steps between two checkpoints. (default 20000; 1 to 1e+09)
        checkpoints_kept: How many checkpoints are kept. (default 2; 1 to 1000)
        preset: Whether settings that are known to solve the environment stand in for those that have their
            default. (default True)
    """

    deterministic: bool
    seed: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, learning_rate: float = ..., buffer_size: int = ..., learning_starts: int = ..., tau: float = ..., gamma: float = ..., train_freq: int = ..., gradient_steps: Optional[int] = ..., norm_obs: bool = ..., clip_obs: float = ..., seed: int = ..., net_arch: list[Any] = ..., activation_fn: Literal['tanh', 'relu'] = ..., picture_network: Literal['small', 'nature', 'flat'] = ..., gru_size: Optional[int] = ..., ent_coef: Optional[float] = ..., ent_coef_init: float = ..., target_entropy: Optional[float] = ..., target_update_interval: int = ..., total_timesteps: int = ..., n_envs: int = ..., num_workers: int = ..., eval_freq: int = ..., n_eval_episodes: int = ..., checkpoints_kept: int = ..., preset: bool = ..., deterministic: bool = ...) -> None: ...
    @overload
    def infer(self, observation: Union[Observation, ArrayLike], *, deterministic: bool = ...) -> RlTarget: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, observation: Sequence[Union[Observation, ArrayLike]], *, deterministic: bool = ...) -> list[RlTarget]: ...
    @overload
    def infer(self, observation: Iterator[Union[Observation, ArrayLike]], *, deterministic: bool = ...) -> Iterator[RlTarget]: ...
    def fit(self, env: Any = ..., val_env: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, env_params: Optional[dict[str, Any]] = ..., out: Optional[PathLike] = ..., resume: bool = ..., learning_rate: float = ..., buffer_size: int = ..., learning_starts: int = ..., batch_size: int = ..., tau: float = ..., gamma: float = ..., train_freq: int = ..., gradient_steps: Optional[int] = ..., norm_obs: bool = ..., clip_obs: float = ..., seed: int = ..., net_arch: list[Any] = ..., activation_fn: Literal['tanh', 'relu'] = ..., picture_network: Literal['small', 'nature', 'flat'] = ..., gru_size: Optional[int] = ..., ent_coef: Optional[float] = ..., ent_coef_init: float = ..., target_entropy: Optional[float] = ..., target_update_interval: int = ..., total_timesteps: int = ..., iters: int = ..., n_envs: int = ..., num_workers: int = ..., eval_freq: int = ..., n_eval_episodes: int = ..., checkpoint_after_iter: int = ..., checkpoints_kept: int = ..., preset: bool = ...) -> dict[str, Any]: ...

class Td3Learner(NativeLearnerRL):
    """Twin delayed policy gradients: deterministic policies of continuous actions.

    Task: reinforcement_learning. ``infer`` takes:

        observation: Observation.

    and gives: RlTarget.

    Args:
        deterministic: Whether it takes its most likely actions, else some by chance. (default True; may change
            while running, also for one call of infer)
        seed: What fixes those by chance, from the beginning of a stream on. (default 0)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        learning_rate: Learning rate of Adam, of all networks. (default 0.001; 0 to 1)
        buffer_size: Steps that are remembered. (default 1000000; 1 to 1e+09)
        learning_starts: Steps of all environments, with actions by chance, before learning begins. (default 100;
            0 to 1e+09)
        batch_size: Steps that one gradient step learns from. (default 256; 1 to 1e+06)
        tau: How far targets move to their networks at a time. (default 0.005; 0 to 1)
        gamma: Discount of rewards. (default 0.99; 0 to 1)
        train_freq: Steps of each environment between two updates. (default 1; 1 to 1e+06)
        gradient_steps: Gradient steps of an update; none is one for each step that was taken. (default 1; 1 to
            1e+06)
        norm_obs: Whether observations are normalised by what training saw. (default False)
        clip_obs: Normalised observations lie within plus and minus this. (default 10.0; 0 to 1e+09)
        net_arch: Neurons of the hidden layers. (default [400, 300]; 1 to 4096)
        activation_fn: What stands behind every hidden layer. (default 'relu'; one of 'tanh', 'relu')
        picture_network: What pictures go through before the hidden layers. (default 'small'; one of 'small',
            'nature', 'flat')
        gru_size: Neurons of a gated recurrent unit before the hidden layers, with which a policy remembers its
            episode; none is no memory. (default None; 1 to 4096)
        action_noise_std: Deviation of the noise on actions while exploring, where actions span [-1, 1]: rl-zoo's,
            Stable-Baselines3 has none. (default 0.1; 0 to 2)
        action_noise: How that noise goes on. (default 'normal'; one of 'normal', 'ornstein_uhlenbeck')
        policy_delay: Updates of the values between two of the policy. (default 2; 1 to 1e+06)
        target_policy_noise: Deviation of the noise on the target policy's actions. (default 0.2; 0 to 2)
        target_noise_clip: That noise lies within plus and minus this. (default 0.5; 0 to 2)
        total_timesteps: Steps of all environments together. (default 100000; 1 to 2e+09; in OpenDR iters)
        n_envs: How many environments are stepped together. (default 1; 1 to 65536)
        num_workers: Threads that step environments and learn; they change no bit. (default 1; 1 to 256)
        eval_freq: Steps between two measurements of the policy; 0 measures it at the end only. (default 10000; 0
            to 1e+09)
        n_eval_episodes: Episodes of a measurement. (default 20; 1 to 1e+06)
        checkpoint_after_iter: Steps between two checkpoints. (default 20000; 1 to 1e+09)
        checkpoints_kept: How many checkpoints are kept. (default 2; 1 to 1000)
        preset: Whether settings that are known to solve the environment stand in for those that have their
            default. (default True)
    """

    deterministic: bool
    seed: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, learning_rate: float = ..., buffer_size: int = ..., learning_starts: int = ..., tau: float = ..., gamma: float = ..., train_freq: int = ..., gradient_steps: Optional[int] = ..., norm_obs: bool = ..., clip_obs: float = ..., seed: int = ..., net_arch: list[Any] = ..., activation_fn: Literal['tanh', 'relu'] = ..., picture_network: Literal['small', 'nature', 'flat'] = ..., gru_size: Optional[int] = ..., action_noise_std: float = ..., action_noise: Literal['normal', 'ornstein_uhlenbeck'] = ..., policy_delay: int = ..., target_policy_noise: float = ..., target_noise_clip: float = ..., total_timesteps: int = ..., n_envs: int = ..., num_workers: int = ..., eval_freq: int = ..., n_eval_episodes: int = ..., checkpoints_kept: int = ..., preset: bool = ..., deterministic: bool = ...) -> None: ...
    @overload
    def infer(self, observation: Union[Observation, ArrayLike], *, deterministic: bool = ...) -> RlTarget: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, observation: Sequence[Union[Observation, ArrayLike]], *, deterministic: bool = ...) -> list[RlTarget]: ...
    @overload
    def infer(self, observation: Iterator[Union[Observation, ArrayLike]], *, deterministic: bool = ...) -> Iterator[RlTarget]: ...
    def fit(self, env: Any = ..., val_env: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, env_params: Optional[dict[str, Any]] = ..., out: Optional[PathLike] = ..., resume: bool = ..., learning_rate: float = ..., buffer_size: int = ..., learning_starts: int = ..., batch_size: int = ..., tau: float = ..., gamma: float = ..., train_freq: int = ..., gradient_steps: Optional[int] = ..., norm_obs: bool = ..., clip_obs: float = ..., seed: int = ..., net_arch: list[Any] = ..., activation_fn: Literal['tanh', 'relu'] = ..., picture_network: Literal['small', 'nature', 'flat'] = ..., gru_size: Optional[int] = ..., action_noise_std: float = ..., action_noise: Literal['normal', 'ornstein_uhlenbeck'] = ..., policy_delay: int = ..., target_policy_noise: float = ..., target_noise_clip: float = ..., total_timesteps: int = ..., iters: int = ..., n_envs: int = ..., num_workers: int = ..., eval_freq: int = ..., n_eval_episodes: int = ..., checkpoint_after_iter: int = ..., checkpoints_kept: int = ..., preset: bool = ...) -> dict[str, Any]: ...

class DqnLearner(NativeLearnerRL):
    """Deep Q-learning: one choice among few, learnt from steps of the past.

    Task: reinforcement_learning. ``infer`` takes:

        observation: Observation.

    and gives: RlTarget.

    Args:
        deterministic: Whether it takes its most likely actions, else some by chance. (default True; may change
            while running, also for one call of infer)
        seed: What fixes those by chance, from the beginning of a stream on. (default 0)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Parameters of ``fit``, for one call or, given here, for all of them:
        learning_rate: Learning rate of Adam, of all networks. (default 0.0001; 0 to 1)
        buffer_size: Steps that are remembered. (default 1000000; 1 to 1e+09)
        learning_starts: Steps of all environments, with actions by chance, before learning begins. (default 100;
            0 to 1e+09)
        batch_size: Steps that one gradient step learns from. (default 32; 1 to 1e+06)
        tau: How far targets move to their networks at a time. (default 1.0; 0 to 1)
        gamma: Discount of rewards. (default 0.99; 0 to 1)
        train_freq: Steps of each environment between two updates. (default 4; 1 to 1e+06)
        gradient_steps: Gradient steps of an update; none is one for each step that was taken. (default 1; 1 to
            1e+06)
        norm_obs: Whether observations are normalised by what training saw. (default False)
        clip_obs: Normalised observations lie within plus and minus this. (default 10.0; 0 to 1e+09)
        net_arch: Neurons of the hidden layers. (default [64, 64]; 1 to 4096)
        activation_fn: What stands behind every hidden layer. (default 'relu'; one of 'tanh', 'relu')
        picture_network: What pictures go through before the hidden layers. (default 'small'; one of 'small',
            'nature', 'flat')
        gru_size: Neurons of a gated recurrent unit before the hidden layers, with which a policy remembers its
            episode; none is no memory. (default None; 1 to 4096)
        target_update_interval: Steps of all environments between two moves of the target. (default 10000; 1 to
            1e+09)
        exploration_fraction: Over which share of the training chance gives way to the policy. (default 0.1; 1e-09
            to 1)
        exploration_initial_eps: The share of actions by chance, at first. (default 1.0; 0 to 1)
        exploration_final_eps: The share of actions by chance, in the end. (default 0.05; 0 to 1)
        max_grad_norm: Gradients longer than this are cut. (default 10.0; 0 to 1e+09)
        total_timesteps: Steps of all environments together. (default 100000; 1 to 2e+09; in OpenDR iters)
        n_envs: How many environments are stepped together. (default 1; 1 to 65536)
        num_workers: Threads that step environments and learn; they change no bit. (default 1; 1 to 256)
        eval_freq: Steps between two measurements of the policy; 0 measures it at the end only. (default 10000; 0
            to 1e+09)
        n_eval_episodes: Episodes of a measurement. (default 20; 1 to 1e+06)
        checkpoint_after_iter: Steps between two checkpoints. (default 20000; 1 to 1e+09)
        checkpoints_kept: How many checkpoints are kept. (default 2; 1 to 1000)
        preset: Whether settings that are known to solve the environment stand in for those that have their
            default. (default True)
    """

    deterministic: bool
    seed: int
    def __init__(self, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., device: str = ..., threshold: float = ..., scale: float = ..., *, learning_rate: float = ..., buffer_size: int = ..., learning_starts: int = ..., tau: float = ..., gamma: float = ..., train_freq: int = ..., gradient_steps: Optional[int] = ..., norm_obs: bool = ..., clip_obs: float = ..., seed: int = ..., net_arch: list[Any] = ..., activation_fn: Literal['tanh', 'relu'] = ..., picture_network: Literal['small', 'nature', 'flat'] = ..., gru_size: Optional[int] = ..., target_update_interval: int = ..., exploration_fraction: float = ..., exploration_initial_eps: float = ..., exploration_final_eps: float = ..., max_grad_norm: float = ..., total_timesteps: int = ..., n_envs: int = ..., num_workers: int = ..., eval_freq: int = ..., n_eval_episodes: int = ..., checkpoints_kept: int = ..., preset: bool = ..., deterministic: bool = ...) -> None: ...
    @overload
    def infer(self, observation: Union[Observation, ArrayLike], *, deterministic: bool = ...) -> RlTarget: ...  # type: ignore[overload-overlap]
    @overload
    def infer(self, observation: Sequence[Union[Observation, ArrayLike]], *, deterministic: bool = ...) -> list[RlTarget]: ...
    @overload
    def infer(self, observation: Iterator[Union[Observation, ArrayLike]], *, deterministic: bool = ...) -> Iterator[RlTarget]: ...
    def fit(self, env: Any = ..., val_env: Any = ..., logging_path: PathLike = ..., silent: bool = ..., verbose: bool = ..., *, env_params: Optional[dict[str, Any]] = ..., out: Optional[PathLike] = ..., resume: bool = ..., learning_rate: float = ..., buffer_size: int = ..., learning_starts: int = ..., batch_size: int = ..., tau: float = ..., gamma: float = ..., train_freq: int = ..., gradient_steps: Optional[int] = ..., norm_obs: bool = ..., clip_obs: float = ..., seed: int = ..., net_arch: list[Any] = ..., activation_fn: Literal['tanh', 'relu'] = ..., picture_network: Literal['small', 'nature', 'flat'] = ..., gru_size: Optional[int] = ..., target_update_interval: int = ..., exploration_fraction: float = ..., exploration_initial_eps: float = ..., exploration_final_eps: float = ..., max_grad_norm: float = ..., total_timesteps: int = ..., iters: int = ..., n_envs: int = ..., num_workers: int = ..., eval_freq: int = ..., n_eval_episodes: int = ..., checkpoint_after_iter: int = ..., checkpoints_kept: int = ..., preset: bool = ...) -> dict[str, Any]: ...
