"""Persons are enrolled from a folder of images, then recognised."""

import os
import shutil

from opendr.engine.data import Image
from opendr.perception.face_recognition import FaceRecognitionLearner

recognizer = FaceRecognitionLearner(device="cpu", backbone="mobilefacenet", mode="backbone_only")
recognizer.download(path=".")
recognizer.load(".")
faces = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/face_verification")
for person, files in {"1": ["img1.jpg", "img2.jpg"], "2": ["img20.jpg", "img21.jpg"]}.items():
    os.makedirs(os.path.join("test_data", "images", person))
    for file in files[:1]:
        shutil.copy(os.path.join(faces, file), os.path.join("test_data", "images", person))
recognizer.fit_reference(path=os.path.join(".", "test_data", "images"), save_path="reference", create_new=True)
for person, file in (("1", "img2.jpg"), ("2", "img21.jpg")):
    results = recognizer.infer(Image.open(os.path.join(faces, file)))
    assert results[0].class_name == person, (person, results)
try:
    recognizer.align("test_data", "aligned")
except NotImplementedError as error:
    assert "infer detects and aligns" in str(error)
