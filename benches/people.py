#!/usr/bin/env python3
"""Hands, face and words beside MediaPipe and the Python reference of the same network, in one run.

    python -m venv people && people/bin/pip install mediapipe==0.10.9 ai-edge-litert soundfile opendr_rs-*.whl
    OPENDR_TEST_DATA=../shared people/bin/python benches/people.py

* hands: `hand_pose` beside MediaPipe Hands with its light networks, over a hand that moves a little from frame to frame;
* face: `face_mesh` beside MediaPipe Face Mesh with irises, over a face that does;
* words: `ds_cnn` beside its 8-bit network in LiteRT with cepstra by NumPy, over clips of a second.

All take the same frames and clips, two threads where a thread count can be set. Rounds take turns; the table has the median of
the rounds' medians, and the processor's time, since MediaPipe works on threads of its own.
"""

import argparse
import os
import statistics
import time
from pathlib import Path

import numpy as np
import opendr
import soundfile
from opendr.engine.data import Audio, Image

WARM_UP = 10
SAMPLE_RATE, WINDOW, STEP, FOURIER, BANDS, CEPSTRA = 16000, 480, 320, 512, 40, 10


def moving(path, frames):
    """Frames of an RGB image that moves to and fro by a few pixels."""
    picture = Image.open(path).opencv()[:, :, ::-1]
    steps = [int(12 * np.sin(at / 8)) for at in range(frames)]
    return [np.ascontiguousarray(np.roll(picture, step, axis=1)) for step in steps]


def our_pictures(name):
    """Our learner as a function of an RGB frame."""
    learner = opendr.learner(name)

    def answer(frame):
        return len(learner.infer(frame[:, :, ::-1]))

    return answer


def mediapipe_hands():
    import mediapipe

    hands = mediapipe.solutions.hands.Hands(max_num_hands=2, model_complexity=0)
    return lambda frame: len(hands.process(frame).multi_hand_landmarks or [])


def mediapipe_face():
    import mediapipe

    mesh = mediapipe.solutions.face_mesh.FaceMesh(max_num_faces=1, refine_landmarks=True)
    return lambda frame: len(mesh.process(frame).multi_face_landmarks or [])


def our_words():
    learner = opendr.learner("ds_cnn")
    return lambda clip: learner.infer(Audio(clip, SAMPLE_RATE)).data


def mel_bank():
    """Triangles `[FOURIER / 2 + 1, BANDS]` from 20 Hz to 4 kHz on the mel scale."""
    mel = np.linspace(*(1127 * np.log1p(np.array([20, 4000]) / 700)), BANDS + 2)
    at = 1127 * np.log1p(np.arange(FOURIER // 2 + 1) * SAMPLE_RATE / FOURIER / 700)[:, None]
    rise, fall = (at - mel[:-2]) / (mel[1:-1] - mel[:-2]), (mel[2:] - at) / (mel[2:] - mel[1:-1])
    return np.maximum(0, np.minimum(rise, fall)).astype(np.float32)


def reference_words(network):
    from ai_edge_litert.interpreter import Interpreter

    interpreter = Interpreter(str(network), num_threads=2)
    interpreter.allocate_tensors()
    given, told = interpreter.get_input_details()[0], interpreter.get_output_details()[0]
    scale, zero = given["quantization"]
    bank, window = mel_bank(), np.hanning(WINDOW + 1)[:-1].astype(np.float32)
    angles = np.pi / BANDS * (np.arange(BANDS)[:, None] + 0.5) * np.arange(CEPSTRA)
    transform = (np.cos(angles) / np.sqrt(2 * BANDS) * 2).astype(np.float32)

    def answer(clip):
        frames = np.lib.stride_tricks.sliding_window_view(clip / np.abs(clip).max(), WINDOW)[::STEP]
        spectrum = np.abs(np.fft.rfft(frames * window, FOURIER)).astype(np.float32)
        cepstra = np.log(spectrum @ bank + 1e-6) @ transform
        quantised = np.clip(np.round(cepstra / scale + zero), -128, 127).astype(np.int8)
        interpreter.set_tensor(given["index"], quantised.reshape(given["shape"]))
        interpreter.invoke()
        return int(interpreter.get_tensor(told["index"]).argmax())

    return answer


def measure(answer, inputs):
    """Median milliseconds and mean milliseconds of the processor for an input, and what was answered."""
    for one in inputs[:WARM_UP]:
        answer(one)
    times, answers, processor = [], [], time.process_time()
    for one in inputs:
        begin = time.perf_counter()
        answers.append(answer(one))
        times.append(time.perf_counter() - begin)
    return 1e3 * statistics.median(times), 1e3 * (time.process_time() - processor) / len(inputs), answers


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument("--rounds", type=int, default=5)
    args = parser.parse_args()
    data = Path(os.environ["OPENDR_TEST_DATA"])
    os.environ.setdefault("OPENDR_THREADS", "2")
    clips = sorted((data / "data/speech_commands_v0.02_test").glob("[a-z]*/*.wav"))[: args.frames]
    clips = [soundfile.read(clip, dtype="float32")[0] for clip in clips]
    clips = [np.pad(clip, (0, max(0, SAMPLE_RATE - len(clip))))[:SAMPLE_RATE] for clip in clips]
    clips = [clip for clip in clips if np.abs(clip).max() > 0]
    hand = moving(data / "data/mmpose_samples/freihand/00017620.jpg", args.frames)
    face = moving(data / "data/photos/astronaut.png", args.frames)
    network = data / "models/speech_commands/kws_ref_model.tflite"
    rows = {
        "hands": (hand, our_pictures("hand_pose"), mediapipe_hands()),
        "face": (face, our_pictures("face_mesh"), mediapipe_face()),
        "words": (clips, our_words(), reference_words(network)),
    }
    print("| | ours, ms | other, ms | ratio | ours, ms of processor | other | ratio |\n|---|---|---|---|---|---|---|")
    for name, (inputs, ours, other) in rows.items():
        rounds = [(measure(ours, inputs), measure(other, inputs)) for _ in range(args.rounds)]
        wall, processor = (
            [statistics.median(one[side][which] for one in rounds) for side in (0, 1)] for which in (0, 1)
        )
        cells = [f"{one:.2f} | {two:.2f} | {one / two:.2f}" for one, two in (wall, processor)]
        print(f"| {name} | " + " | ".join(cells) + " |")
        mine, theirs = rounds[0][0][2], rounds[0][1][2]
        same = np.mean([one == two for one, two in zip(mine, theirs)])
        print(f"<!-- {name}: {len(inputs)} inputs, the same answer on {100 * same:.0f} % -->")


if __name__ == "__main__":
    main()
