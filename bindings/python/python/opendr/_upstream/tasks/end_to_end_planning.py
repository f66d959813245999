"""OpenDR's planning.end_to_end_planning."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

_CORRIDOR = Absent('opendr.simulation has "UavDepthCorridor-v1", which needs no Webots')

MODULES: dict[str, dict[str, Home]] = {
    "e2e_planning_learner": {"EndToEndPlanningRLLearner": HERE},
    "envs.UAV_depth_planning_env": {"UAVDepthPlanningEnv": _CORRIDOR},
    "envs.agi_env": {"AgiEnv": _CORRIDOR},
}

LEARNERS = {
    "EndToEndPlanningRLLearner": Learner(
        init="env lr n_steps iters batch_size checkpoint_after_iter temp_path device",
        infer="batch>observation deterministic",
        fit="env logging_path verbose",
        download="path url",
        mixin="opendr._upstream.learners.planning:Planner",
        folder="end_to_end_planning_tr",
        demos="–",
        differs=(
            "`infer` returns an `RlTarget`, whose `data` are the action",
            "`eval` runs 100 episodes and returns `mean_return`, not `rewards_collected`",
        ),
    ),
}
