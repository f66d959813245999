"""Detects objects in a photograph. Input: street.jpg, any photograph."""

import opendr

detector = opendr.learner("centernet")
boxes = detector.infer("street.jpg")
for box in boxes:
    print(f"{box.class_name} {box.confidence:.2f}, {box.width:.0f} x {box.height:.0f} pixels")
boxes.save("detect_objects.png")
