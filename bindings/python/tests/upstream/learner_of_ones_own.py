"""A learner from OpenDR's documentation: a subclass with the common positional arguments."""

import numpy as np
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator
from opendr.engine.learners import BaseLearner, Learner, LearnerActive, LearnerRL
from opendr.engine.target import Category


class Brightness(Learner):
    """Classifies images as bright or dark."""

    def fit(self, dataset, val_dataset=None, logging_path="", silent=True, verbose=True):
        self.threshold = float(np.mean([image.data.mean() for image, _ in dataset]) / 255)
        return {"threshold": self.threshold}

    def eval(self, dataset):
        return {"accuracy": float(np.mean([self.infer(image).data == truth.data for image, truth in dataset]))}

    def infer(self, batch):
        return Category(int(batch.data.mean() / 255 > self.threshold))

    def save(self, path):
        return True

    def load(self, path):
        return True

    def optimize(self, target_device):
        return False

    def reset(self):
        pass


class Plain(DatasetIterator):
    def __getitem__(self, idx):
        return Image(np.full((4, 4, 3), 200 * (idx % 2), np.uint8)), Category(idx % 2)

    def __len__(self):
        return 4


learner = Brightness(0.01, 5, 16, "adam", "", "default", "", 0, 0, "temp", "cpu", 0.25, 1.0)
assert (learner.lr, learner.iters, learner.optimizer, learner.threshold) == (0.01, 5, "adam", 0.25)
assert learner.fit(Plain())["threshold"] == learner.threshold and learner.eval(Plain())["accuracy"] == 1
assert issubclass(LearnerRL, BaseLearner) and issubclass(LearnerActive, BaseLearner)
try:
    Brightness("fast")
except TypeError as error:
    assert "lr should be a float" in str(error)
