"""Abnormal beats of a heart."""

import os

import numpy as np
from opendr.engine.data import Timeseries
from opendr.perception.heart_anomaly_detection import AttentionNeuralBagOfFeatureLearner, GatedRecurrentUnitLearner
from opendr.perception.heart_anomaly_detection.gated_recurrent_unit.algorithm.data import Dataset

rows = np.loadtxt(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/ecg/ECG5000_TRAIN.txt"))
beats, normal = rows[:40, 1:], rows[:40, 0] == 1
learner = GatedRecurrentUnitLearner(in_channels=1, series_length=140, n_class=2, recurrent_unit=64, device="cpu")
learner.download(path="./checkpoint", fold_idx=0)
assert learner.is_ready
answers = [learner.infer(Timeseries(beat[:, None])).description for beat in beats]
assert np.mean([(answer == "normal") == is_normal for answer, is_normal in zip(answers, normal)]) > 0.9

bag = AttentionNeuralBagOfFeatureLearner(1, 140, 2, device="cpu", attention_type="temporal", iters=1, batch_size=8)
train = Dataset(beats[:, None, :], [0 if is_normal else 1 for is_normal in normal])
stats = bag.fit(train, train, class_weight=[1.0, 1.0], silent=True)
assert stats["loss"] and bag.infer(train[0][0]).data in (0, 1)
assert "accuracy" in bag.eval(train, silent=True)
