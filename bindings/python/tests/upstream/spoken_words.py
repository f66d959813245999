"""Recognition of spoken words: three learners of OpenDR."""

import os
import wave

import numpy as np
from opendr.engine.data import Timeseries
from opendr.perception.speech_recognition import EdgeSpeechNetsLearner, MatchboxNetLearner, QuadraticSelfOnnLearner

folder = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/speech_commands_v0.02_test/go")
with wave.open(os.path.join(folder, sorted(os.listdir(folder))[0])) as file:
    sound = np.frombuffer(file.readframes(16000), dtype=np.int16) / 32768
learner = MatchboxNetLearner(
    device="cpu",
    output_classes_n=12,
    batch_size=16,
    iters=1,
    number_of_blocks=3,
    number_of_channels=64,
    sample_rate=16000,
)
learner.download_pretrained(".")
learner.load("./MatchboxNet")
word = learner.infer(Timeseries(sound[None].astype(np.float32)))
assert word.description in learner.classes
onn = QuadraticSelfOnnLearner(device="cpu", expansion_order=3)
onn.load(onn.download_pretrained("."))
edge = EdgeSpeechNetsLearner(0.01, 30, 64, "sgd", 0, 0, "temp", "cpu", "A", 12)
edge.load()
for other in (onn, edge):
    assert other.infer(Timeseries(sound[None].astype(np.float32))).description in other.classes
    other.reset()
