"""Predicts the 478 points of a face, irises included. Input: astronaut.png (opendr download sample/astronaut)."""

import opendr

mesh = opendr.learner("face_mesh")
faces = mesh.infer("astronaut.png")
for face in faces:
    width = face.data[:, 0].max() - face.data[:, 0].min()
    print(f"{len(face)} points over {width:.0f} pixels, score {face.confidence:.2f}")
faces.save("face_mesh.png")
