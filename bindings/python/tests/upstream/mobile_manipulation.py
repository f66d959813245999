"""A policy for the base of a mobile manipulator, with OpenDR's arguments."""

import warnings

from opendr.control.mobile_manipulation import MobileRLLearner
from opendr.control.mobile_manipulation.mobile_manipulation_learner import MobileRLLearner as Same

assert Same is MobileRLLearner
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    learner = MobileRLLearner("MobileManipReach-v1", lr=1e-4, iters=2048, buffer_size=1000, device="cpu")
assert any("buffer_size has no effect" in str(warning.message) for warning in caught), caught
assert learner.env == "MobileManipReach-v1"
learner.fit(silent=True, n_envs=2, n_steps=256)
figures = learner.eval("MobileManipDoor-v1", nr_evaluations=2)
assert figures["episodes"] == 2 and 0 <= figures["success_rate"] <= 1, figures
