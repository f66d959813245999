"""Detects fallen persons, and the poses that show it. Input: fallen.jpg, a photograph with a person who lies."""

import opendr

detector = opendr.learner("fall_detector")
falls, poses = detector.infer("fallen.jpg")
for fall in falls:
    print(f"{fall.class_name or fall.name}, score {fall.confidence:.2f}")
print(f"{len(poses)} poses")
falls.plot(poses.plot("fallen.jpg")).save("detect_falls.png")
