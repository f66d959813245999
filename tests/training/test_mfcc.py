"""Cepstra of crates/perception/audio equal those of librosa and TensorFlow."""

import os
import subprocess
from pathlib import Path

import librosa
import numpy as np
import onnxruntime
import pytest
import scipy
import soundfile
from programs import example

ROOT = Path(__file__).resolve().parents[2]
#: In the order of the network's outputs.
WORDS = ["down", "go", "left", "no", "off", "on", "right", "stop", "up", "yes", "_silence_", "_unknown_"]


@pytest.fixture(scope="session")
def program():
    """crates/perception/audio/examples/mfcc.rs."""
    return example("sound", "mfcc")


@pytest.fixture
def cepstra(program, tmp_path):
    def run(wave, *recipe):
        out = tmp_path / "cepstra.npy"
        subprocess.run([*program, *map(str, recipe), wave, out], cwd=ROOT, check=True)
        return np.load(out)

    return run


@pytest.fixture(scope="session")
def shared():
    folder = Path(os.environ.get("OPENDR_TEST_DATA", ROOT.parent / "shared"))
    if not folder.is_dir():
        pytest.skip("skipped: no OPENDR_TEST_DATA")
    return folder


def sounds(rate):
    """Noise, a rising tone, a click in silence, and silence, of lengths that no hop divides."""
    rng = np.random.default_rng(7)
    time = np.arange(rate + 137) / rate
    click = np.zeros(rate // 3)
    click[1234] = 0.9
    yield rng.normal(0, 0.1, rate // 2 + 11)
    yield 0.7 * np.sin(2 * np.pi * (200 * time + 1500 * time**2))
    yield click
    yield np.zeros(rate // 4)


def tensorflow_mfcc(samples):
    """The arithmetic of `tf.signal` as TinyML's keyword spotting calls it, in double precision."""
    samples = samples / samples.max() if samples.max() > 0 else samples
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(480) / 480)
    starts = range(0, len(samples) - 480 + 1, 320)
    magnitude = np.abs(np.fft.rfft([samples[start : start + 480] * window for start in starts], 512))
    mel = lambda hz: 1127 * np.log1p(hz / 700)  # noqa: E731
    corners = np.linspace(mel(20), mel(4000), 42)
    bins = mel(np.linspace(0, 8000, 257)[1:])[:, None]
    rising = (bins - corners[:-2]) / (corners[1:-1] - corners[:-2])
    falling = (corners[2:] - bins) / (corners[2:] - corners[1:-1])
    weights = np.maximum(0, np.minimum(rising, falling))
    bands = np.log(magnitude[:, 1:] @ weights + 1e-6)
    return scipy.fft.dct(bands, type=2)[:, :10] / np.sqrt(80)


@pytest.mark.parametrize(("rate", "window", "hop", "count"), [(16000, 640, 480, 64), (22050, 2048, 512, 20), (16000, 400, 160, 13)])
def test_librosa(cepstra, tmp_path, rate, window, hop, count):
    for samples in sounds(rate):
        soundfile.write(tmp_path / "sound.wav", samples.astype("float32"), rate, subtype="FLOAT")
        wanted = librosa.feature.mfcc(
            y=samples.astype("float32"), sr=rate, n_mfcc=count, n_fft=window, hop_length=hop, pad_mode="reflect"
        )
        got = cepstra(tmp_path / "sound.wav", "librosa", window, hop, count)
        assert got.shape == wanted.T.shape
        np.testing.assert_allclose(got, wanted.T, atol=2e-5 * np.abs(wanted).max())


def test_tensorflow(cepstra, tmp_path):
    for samples in sounds(16000):
        soundfile.write(tmp_path / "sound.wav", samples.astype("float32"), 16000, subtype="FLOAT")
        wanted = tensorflow_mfcc(samples.astype("float32").astype("float64"))
        got = cepstra(tmp_path / "sound.wav", "keywords")
        assert got.shape == wanted.shape
        # Where a pure tone leaves a band empty, the logarithm sees single precision's rounding beside its offset of 1e-6.
        np.testing.assert_allclose(got, wanted, atol=1e-3 * np.abs(wanted).max())


def test_keyword_spotter_hears(cepstra, tmp_path, shared):
    """The quantised network that was trained on TensorFlow's cepstra recognises nine words of ten from ours."""
    network = onnxruntime.InferenceSession(shared / "models/speech_commands/kws_dscnn_12.onnx")
    hits = []
    for index, word in enumerate(WORDS):
        for clip in sorted((shared / "data/speech_commands_v0.02_test" / word).glob("*.wav"))[:10]:
            samples, rate = soundfile.read(clip)
            soundfile.write(tmp_path / "second.wav", np.pad(samples, (0, 16000 - len(samples))), rate, subtype="FLOAT")
            features = np.round(cepstra(tmp_path / "second.wav", "keywords") / 0.5847) + 83
            features = np.clip(features, -128, 127).astype("int8").reshape(1, 49, 10, 1)
            hits.append(network.run(None, {"input_1": features})[0].argmax() == index)
    assert len(hits) == 120 and np.mean(hits) >= 0.85, np.mean(hits)
