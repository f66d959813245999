"""The class of a stream of feature vectors, after every vector."""

import numpy as np
from opendr.engine.data import Timeseries
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import Category
from opendr.perception.activity_recognition.continual_transformer_encoder.continual_transformer_encoder_learner import (
    CoTransEncLearner,
)


class Streams(DatasetIterator):
    """Noise of two classes."""

    classes = ["calm", "moving"]

    def __len__(self):
        return 8

    def __getitem__(self, index):
        steps = np.random.default_rng(index).normal(size=(6, 8)).astype(np.float32)
        return Timeseries(steps), Category(index % 2)


learner = CoTransEncLearner(
    lr=0.01, iters=1, batch_size=4, num_layers=2, input_dims=8, hidden_dims=16, sequence_len=6, num_heads=4,
    num_classes=2, dropout=0.1, device="cpu", temp_path="./trained", num_workers=0, seed=123,
)  # fmt: skip
assert learner.fit(Streams(), silent=True)["loss"]
learner.save("./model")
learner = CoTransEncLearner(num_layers=2, input_dims=8, hidden_dims=16, sequence_len=6, num_heads=4, device="cpu")
learner.load("./model")
predictions = [learner.infer(Timeseries(step[None])) for step in Streams()[0][0].numpy()]
assert all(prediction.description in learner.classes for prediction in predictions)
assert "accuracy" in learner.eval(Streams())
