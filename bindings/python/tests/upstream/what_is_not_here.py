"""Learners of OpenDR that are not available yet can be imported, and name a replacement."""

from opendr.perception.continual_slam.continual_slam_learner import ContinualSLAMLearner
from opendr.perception.gesture_recognition.gesture_recognition_learner import GestureRecognitionLearner
from opendr.perception.multimodal_human_centric import IntentRecognitionLearner
from opendr.perception.object_detection_2d import FSeq2NMSLearner, RetinaFaceLearner
from opendr.perception.speech_transcription import VoskLearner
from opendr.simulation.human_model_generation import PIFuGeneratorLearner

for learner in (
    ContinualSLAMLearner, GestureRecognitionLearner, IntentRecognitionLearner,
    FSeq2NMSLearner, RetinaFaceLearner,
    VoskLearner, PIFuGeneratorLearner,
):  # fmt: skip
    try:
        learner(device="cpu")
    except NotImplementedError as error:
        assert str(error).startswith(f"{learner.__name__} is not available yet; "), error
    else:
        raise AssertionError(learner)
