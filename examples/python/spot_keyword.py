"""Recognises a spoken word and draws its waveform. Input: word.wav, a word of Speech Commands, such as "right"."""

import wave

import numpy as np

import opendr
from opendr.engine.data import Image

recogniser = opendr.learner("matchboxnet")
word = recogniser.infer("word.wav")
print(f"{recogniser.classes[word.data]} {word.confidence:.2f}")

with wave.open("word.wav") as file:
    samples = np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(np.float32) / 32768
picture = np.full((200, 500, 3), 255, np.uint8)
step = len(samples) // 500
for column in range(500):
    part = samples[column * step : (column + 1) * step]
    top, bottom = 100 - int(part.max() * 99), 100 - int(part.min() * 99)
    picture[top : bottom + 1, column] = (180, 90, 20)
word.plot(Image(picture)).save("spot_keyword.png")
