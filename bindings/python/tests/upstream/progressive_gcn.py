"""A network that grows with the skeleton sequences that it is trained on."""

import numpy as np
from opendr.engine.data import SkeletonSequence
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import Category
from opendr.perception.skeleton_based_action_recognition import ProgressiveSpatioTemporalGCNLearner


class Actions(DatasetIterator):
    """Noise of two classes."""

    classes = ["wave", "jump"]

    def __len__(self):
        return 4

    def __getitem__(self, index):
        frames = np.random.default_rng(index).normal(size=(1, 3, 16, 25, 2)).astype(np.float32)
        return SkeletonSequence(frames), Category(index % 2)


learner = ProgressiveSpatioTemporalGCNLearner(
    device="cpu", temp_path="./grown", batch_size=2, epochs=1, checkpoint_after_iter=0, val_batch_size=2, num_class=2,
    num_point=25, num_person=2, in_channels=3, graph_type="ntu", num_frames=16, blocksize=4, numblocks=2, numlayers=1,
    topology=[], layer_threshold=1e-4, block_threshold=1e-4, experiment_name="pstgcn", dataset_name="nturgbd_cv",
)  # fmt: skip
assert learner.fit(Actions(), silent=True)["loss"]
assert learner.infer(Actions()[0][0]).description in learner.classes
learner.save("./model")
