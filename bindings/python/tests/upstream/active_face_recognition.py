"""A camera that moves around a person until the person is recognised, trained in an embedded world instead of Webots."""

import numpy as np
from opendr.engine.data import Image
from opendr.perception.active_perception.active_face_recognition import ActiveFaceRecognitionLearner
from opendr.perception.active_perception.active_face_recognition.active_face_recognition_learner import (
    ActiveFaceRecognitionLearner as Same,
)

assert Same is ActiveFaceRecognitionLearner
learner = ActiveFaceRecognitionLearner(lr=3e-4, iters=512, batch_size=64)
small = {"view_episodes": 40, "epochs": 1, "kernels": 4, "hidden": 16, "n_envs": 4, "calibration_episodes": 50}
learner.fit(env="SphereView-Face-v1", out="run", silent=True, **small)
target = learner.infer(Image(np.zeros((64, 64, 3), np.uint8)))
assert np.shape(target.action) == (3,) and np.abs(target.action).max() <= 1
