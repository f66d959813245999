"""The action of a person, after every frame."""

import numpy as np
from opendr.engine.data import SkeletonSequence
from opendr.perception.skeleton_based_action_recognition import CoSTGCNLearner

learner = CoSTGCNLearner(device="cpu", backbone="costgcn", batch_size=2, loss="cross_entropy", num_workers=0)
learner.download("./pretrained_models", mode="pretrained")
learner.load("./pretrained_models/costgcn_ntu60_xview_joint.ckpt")
steps = np.random.default_rng(0).normal(size=(3, 1, 2, 1, 15, 1)).astype(np.float32)
answers = [learner.infer(SkeletonSequence(step)) for step in steps]
assert all(answer.description in learner.classes for answer in answers)
learner.reset()
