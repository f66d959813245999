"""OpenDR's control.mobile_manipulation."""

from __future__ import annotations

from opendr._upstream.rows import Home, Learner

MODULES: dict[str, dict[str, Home]] = {
    "mobile_manipulation_learner": {"MobileRLLearner": "opendr.control.reinforcement_learning"},
}

LEARNERS = {
    "MobileRLLearner": Learner(
        init=(
            "env lr>learning_rate iters batch_size lr_schedule>learning_rate_schedule lr_end!schedule backbone!network "
            "checkpoint_after_iter checkpoint_load_iter restore_model_path!load temp_path device seed buffer_size!ppo "
            "learning_starts!ppo tau!ppo gamma explore_noise!ppo explore_noise_type!ppo ent_coef "
            "nr_evaluations>n_eval_episodes evaluation_frequency>eval_freq"
        ),
        infer="batch>observation deterministic",
        fit="env val_env logging_path silent verbose",
        eval="env name_prefix!log nr_evaluations>episodes",
        mixin="opendr._upstream.learners.planning:Planner",
        demos="–",
        differs=(
            "The policy is trained by PPO, not by SAC, in `MobileManipReach-v1`, which needs neither ROS nor MoveIt; `ent_coef` is "
            "a number",
            "`infer` returns an `RlTarget`, whose `data` are the action",
            "`eval` returns `success_rate` with its interval, not `metrics`",
        ),
    ),
}
