"""A hand's gesture from colour and depth; the learner is trained on the given pairs."""

import numpy as np
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import Category
from opendr.perception.multimodal_human_centric import RgbdHandGestureLearner


class Hands(DatasetIterator):
    classes = ["Punch", "Span"]

    def __getitem__(self, idx):
        pixels = np.full((3, 32, 32), 60 + 100 * (idx % 2), np.uint8)
        depth = np.full((1, 32, 32), 500 + 300 * (idx % 2), np.uint16)
        return (Image(pixels, guess_format=False), Image(depth, "uint16", False)), Category(idx % 2)

    def __len__(self):
        return 4


learner = RgbdHandGestureLearner(2, "mobilenet_v2", device="cpu", iters=1, batch_size=2, n_workers=0)
stats = learner.fit(train_set=Hands(), val_set=Hands(), silent=True, side=32)
assert stats["loss"]
(picture, depth), _ = Hands()[0]
assert learner.infer(picture, depth).description in Hands.classes
learner.save("./gestures")
assert "accuracy" in learner.eval(Hands(), silent=True)
