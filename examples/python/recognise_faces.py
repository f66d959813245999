"""Recognises a person by a few images of each. Inputs: known/NAME/*.jpg, a folder of images per person, and visitor.jpg."""

import opendr
from opendr.engine.datasets import ExternalDataset

recogniser = opendr.learner("face_recognition")
recogniser.fit(ExternalDataset("known", "imagenet"), out="recognise_faces", silent=True)
print("known:", ", ".join(recogniser.classes))
faces = recogniser.infer("visitor.jpg")
for face in faces:
    print(f"{face.class_name or 'unknown'} {face.confidence:.2f}")
faces.save("recognise_faces.png")
