"""Detects speech in a stream and draws it. Input: speech.wav, 16 kHz, mono, 16 bits."""

import wave

import numpy as np

import opendr
from opendr.engine.data import Audio, Image

with wave.open("speech.wav") as file:
    samples = np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(np.float32) / 32768
detector = opendr.learner("silero_vad")
# Pieces of 0.1 s, as a microphone has them; the learner returns a prediction for every 32 ms.
voices = []
for start in range(0, len(samples), 1600):
    voices += detector.push(Audio(samples[start : start + 1600], 16000))
picture = np.full((100, 3 * len(voices), 3), 255, np.uint8)
for index, voice in enumerate(voices):
    speaks = detector.classes[voice.data] == "speech"
    if index == 0 or voice.data != voices[index - 1].data:
        print(f"{detector.classes[voice.data]} from {index * 0.032:.2f} s")
    # Loudness as the height of a bar, red during speech.
    loudness = np.abs(samples[512 * index : 512 * index + 512]).max()
    picture[100 - int(loudness * 99) :, 3 * index : 3 * index + 3] = (40, 40, 200) if speaks else (160, 160, 160)
Image(picture).save("detect_voice.png")
