"""A policy that searches for objects, with OpenDR's arguments."""

from opendr.control.multi_object_search import MultiObjectSearchRLLearner
from opendr.control.multi_object_search.multi_object_search_learner import MultiObjectSearchRLLearner as Same

assert Same is MultiObjectSearchRLLearner
learner = MultiObjectSearchRLLearner("ObjectSearch2D-frontier-v1", lr=1e-4, n_steps=32, iters=64, device="cpu")
assert learner.env == "ObjectSearch2D-frontier-v1" and learner.n_steps == 32
learner.fit(n_envs=2)
figures = learner.eval(nr_evaluations=2)
assert figures["episodes"] == 2 and 0 <= figures["success_rate"] <= 1, figures
