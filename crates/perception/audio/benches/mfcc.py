#!/usr/bin/env python3
"""librosa's time for the cepstra of `mfcc/librosa_64` in `cargo bench -p opendr-audio --bench mfcc`."""

import time

import librosa
import numpy as np

second = np.sin(np.arange(16_000) ** 2 * 1e-4).astype("float32")
times = []
for _ in range(300):
    start = time.perf_counter()
    librosa.feature.mfcc(y=second, sr=16_000, n_mfcc=64, n_fft=640, hop_length=480, pad_mode="reflect")
    times.append(time.perf_counter() - start)
print(f"librosa {librosa.__version__}: {1e6 * np.median(times):.0f} us per second of audio")
