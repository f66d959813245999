"""PST-BLN is trained on sequences of facial landmarks."""

import numpy as np
from opendr.engine.data import SkeletonSequence
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import Category
from opendr.perception.facial_expression_recognition import ProgressiveSpatioTemporalBLNLearner


class Faces(DatasetIterator):
    classes = ["calm", "joy"]

    def __getitem__(self, idx):
        points = np.random.default_rng(idx).normal(size=(1, 2, 5, 20, 1)).astype(np.float32) + idx % 2
        return SkeletonSequence(points), Category(idx % 2)

    def __len__(self):
        return 4


learner = ProgressiveSpatioTemporalBLNLearner(
    device="cpu", batch_size=2, epochs=1, num_point=20, num_class=2, dataset_name="CASIA",
    experiment_name="pstbln_casia", blocksize=5, num_blocks=2, num_layers=2, topology=[1], device_indices=[0],
    num_workers=0, drop_after_epoch=[1],
)  # fmt: skip
stats = learner.fit(Faces(), Faces(), "", True, False, 0.9, True, 0.0001)
assert stats["loss"]
category = learner.infer(Faces()[0][0])
assert category.data in (0, 1)
learner.save("./pstbln")
assert ProgressiveSpatioTemporalBLNLearner(device="cpu").load(".", "pstbln")
