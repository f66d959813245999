"""Clips in folders of classes, and synthetic time series."""

import os

import numpy as np
from opendr.engine.data import Timeseries
from opendr.perception.activity_recognition import KineticsDataset
from opendr.perception.activity_recognition.datasets.dummy_timeseries_dataset import DummyTimeseriesDataset

for label in ("jump", "run"):
    os.makedirs(f"kinetics/train/{label}")
    frames = np.arange(20, dtype=np.float32)[None, :, None, None] * np.ones((3, 1, 8, 8), np.float32)
    np.save(f"kinetics/train/{label}/clip.npy", frames / 20)
dataset = KineticsDataset("kinetics", frames_per_clip=4, temporal_downsampling=2, split="train", decoder_backend="pyav")
assert len(dataset) == 2 and sorted(dataset.classes) == ["jump", "run"]
video, category = dataset[1]
assert video.data.shape == (3, 4, 8, 8) and dataset.classes[category.data] == category.description
steps = np.diff(video.data[0, :, 0, 0])
assert np.allclose(steps, 0.1, atol=1e-5)

series = DummyTimeseriesDataset(num_sines=4, num_datapoints=8, sequence_len=64)
sample, label = series[5]
assert isinstance(sample, Timeseries) and sample.data.shape == (64, 4) and len(series) == 8
assert {series[idx][1].data for idx in range(8)} <= {0, 1, 2, 3}
