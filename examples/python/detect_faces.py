"""Detects faces with their eyes, noses and corners of the mouth. Input: people.jpg, a photograph with faces."""

import opendr

detector = opendr.learner("yunet")
faces = detector.infer("people.jpg")
for face in faces:
    (left, _), (right, _) = face.landmarks[:2]
    print(f"a face of {face.width:.0f} pixels, {abs(right - left):.0f} between the eyes")
faces.save("detect_faces.png")
