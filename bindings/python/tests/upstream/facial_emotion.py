"""The emotion of a face, with OpenDR's order of arguments of `load`."""

import os

from opendr.engine.data import Image
from opendr.perception.facial_expression_recognition import FacialEmotionLearner
from opendr.perception.facial_expression_recognition.image_based_facial_emotion_estimation import facial_emotion_learner

assert facial_emotion_learner.FacialEmotionLearner is FacialEmotionLearner
learner = FacialEmotionLearner(device="cpu", ensemble_size=9, dimensional_finetune=False, categorical_train=False)
path = learner.download(path="model")
assert learner.load(learner.ensemble_size if hasattr(learner, "ensemble_size") else 9, path)
emotion = learner.infer(Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/zidane.jpg")))
assert emotion.description in learner.classes and 0 < emotion.confidence <= 1
assert len(emotion.probabilities) == len(learner.classes)
