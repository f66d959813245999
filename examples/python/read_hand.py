"""Estimates the 21 joints of a hand. Input: hand.jpg, a photograph of a hand."""

import opendr

estimator = opendr.learner("hand_pose")
hands = estimator.infer("hand.jpg")
for hand in hands:
    wrist, tip = hand[0], hand[8]
    print(f"wrist at {wrist.x:.0f}, {wrist.y:.0f}, tip of the index finger at {tip.x:.0f}, {tip.y:.0f}")
hands.save("read_hand.png")
