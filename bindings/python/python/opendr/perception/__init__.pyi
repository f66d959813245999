"""Perception: a module a task."""

from opendr.perception import face_detection as face_detection
from opendr.perception import heart_anomaly_detection as heart_anomaly_detection
from opendr.perception import image_classification as image_classification
from opendr.perception import object_detection_2d as object_detection_2d
from opendr.perception import pose_estimation as pose_estimation
from opendr.perception import speech_recognition as speech_recognition
