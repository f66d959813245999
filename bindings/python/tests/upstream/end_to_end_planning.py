"""A policy for a drone, whose constructor takes the environment."""

import numpy as np
from opendr.planning.end_to_end_planning import EndToEndPlanningRLLearner
from opendr.planning.end_to_end_planning.e2e_planning_learner import EndToEndPlanningRLLearner as Same

assert Same is EndToEndPlanningRLLearner
learner = EndToEndPlanningRLLearner("UavDepthCorridor-v1", 3e-4, 1024, 100000, 64, 500, "", "cpu")
assert learner.env == "UavDepthCorridor-v1" and learner.n_steps == 1024
learner.load(learner.download(path="."))
observation = {"depth_cam": np.full((64, 64, 1), 255, np.uint8), "moving_target": np.array([5.0, 0.0, 0.0])}
action = learner.infer(observation, deterministic=True)
assert action.data.shape == (2,) and abs(action.data).max() <= 1
