"""The activity in a clip, and after every frame of it."""

from pathlib import Path

import numpy as np
from opendr.engine.data import Image, Video
from opendr.perception.activity_recognition import CoX3DLearner, X3DLearner
from opendr.perception.activity_recognition.x3d.x3d_learner import X3DLearner as Same

assert Same is X3DLearner
learner = X3DLearner(device="cpu", backbone="s", num_workers=0)
X3DLearner.download(path="model_weights", model_names={"s"})
learner.load(Path("model_weights") / "x3d_s.pyth")
frames = np.random.default_rng(0).random((3, 8, 64, 64)).astype(np.float32)
prediction = learner.infer(Video(frames))
assert prediction.description in learner.classes and len(prediction.probabilities) == len(learner.classes)

continual = CoX3DLearner(device="cpu", backbone="s", num_workers=0, temporal_window_size=4)
CoX3DLearner.download("continual_weights", {"s"})
continual.load(Path("continual_weights") / "x3d_s.pyth")
answers = [continual.infer(Image((255 * frames[:, step]).astype(np.uint8), guess_format=False)) for step in range(3)]
assert {answer.description for answer in answers} <= set(continual.classes)
