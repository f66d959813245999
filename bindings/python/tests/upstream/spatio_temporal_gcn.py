"""The action of a person from the skeleton sequence."""

import numpy as np
from opendr.engine.data import SkeletonSequence
from opendr.perception.skeleton_based_action_recognition import SpatioTemporalGCNLearner

learner = SpatioTemporalGCNLearner(
    device="cpu", temp_path="./parent_dir", batch_size=2, epochs=1, checkpoint_after_iter=1, val_batch_size=2,
    dataset_name="nturgbd_cv", experiment_name="stgcn_nturgbd", method_name="stgcn", device_ind=[0],
)  # fmt: skip
learner.download("./pretrained_models", method_name="stgcn", mode="pretrained", file_name="stgcn_nturgbd")
learner.load("./pretrained_models", "stgcn_nturgbd")
frames = np.random.default_rng(0).normal(size=(1, 2, 40, 15, 1)).astype(np.float32)
category = learner.infer(SkeletonSequence(frames))
assert category.description in learner.classes
for method_name in ("tagcn", "stbln"):
    learner = SpatioTemporalGCNLearner(method_name=method_name, num_frames=60, num_subframes=40, device="cpu")
    assert learner.method_name == method_name
