"""Names the expression of a face. Input: astronaut.png (opendr download sample/astronaut)."""

import numpy as np

import opendr

recogniser = opendr.learner("facial_emotion")
expression = recogniser.infer("astronaut.png")
for index in np.argsort(-expression.probabilities)[:3]:
    print(f"{recogniser.classes[index]} {expression.probabilities[index]:.2f}")
expression.save("name_expression.png")
