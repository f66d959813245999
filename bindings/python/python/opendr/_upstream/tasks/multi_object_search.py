"""OpenDR's control.multi_object_search."""

from __future__ import annotations

from opendr._upstream.rows import Home, Learner

MODULES: dict[str, dict[str, Home]] = {
    "multi_object_search_learner": {"MultiObjectSearchRLLearner": "opendr.control.reinforcement_learning"},
}

LEARNERS = {
    "MultiObjectSearchRLLearner": Learner(
        init=(
            "env lr>learning_rate ent_coef clip_range gamma n_steps n_epochs iters batch_size "
            "lr_schedule>learning_rate_schedule backbone!network checkpoint_after_iter temp_path device seed "
            "config_filename!config nr_evaluations>n_eval_episodes"
        ),
        infer="batch>observation deterministic",
        fit="env logging_path",
        eval="env name_prefix!log name_scene!log nr_evaluations>episodes deterministic_policy>deterministic",
        mixin="opendr._upstream.learners.planning:Planner",
        demos="–",
        differs=(
            "The policy chooses among frontiers of the map in `ObjectSearch2D-frontier-v1`, which needs no iGibson; in "
            "`ObjectSearch2D-v1` its actions are speed and turn rate",
            "There is no auxiliary prediction of directions",
            "`infer` returns an `RlTarget`, whose `data` are the action",
        ),
    ),
}
