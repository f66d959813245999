"""Perception: a module a task."""

from opendr.perception import compressive_learning as compressive_learning
from opendr.perception import face_detection as face_detection
from opendr.perception import face_recognition as face_recognition
from opendr.perception import facial_expression_recognition as facial_expression_recognition
from opendr.perception import facial_landmarks as facial_landmarks
from opendr.perception import fall_detection as fall_detection
from opendr.perception import gesture_recognition as gesture_recognition
from opendr.perception import grasp_detection as grasp_detection
from opendr.perception import hand_pose_estimation as hand_pose_estimation
from opendr.perception import heart_anomaly_detection as heart_anomaly_detection
from opendr.perception import image_classification as image_classification
from opendr.perception import multimodal_human_centric as multimodal_human_centric
from opendr.perception import object_detection_2d as object_detection_2d
from opendr.perception import object_tracking_2d as object_tracking_2d
from opendr.perception import object_tracking_3d as object_tracking_3d
from opendr.perception import pose_estimation as pose_estimation
from opendr.perception import semantic_segmentation as semantic_segmentation
from opendr.perception import skeleton_based_action_recognition as skeleton_based_action_recognition
from opendr.perception import speech_recognition as speech_recognition
from opendr.perception import speech_transcription as speech_transcription
from opendr.perception import voice_activity_detection as voice_activity_detection
