"""Names the gesture of each hand in an image. Input: hand.jpg, a photograph of a hand."""

import opendr

recogniser = opendr.learner("hand_gesture")
hands = recogniser.infer("hand.jpg")
print("gestures:", ", ".join(recogniser.classes))
for hand in hands:
    print(f"{hand.class_name or hand.name} {hand.confidence:.2f}")
hands.save("name_gesture.png")
