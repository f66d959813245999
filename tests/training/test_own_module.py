"""A custom module, trained by crates/training/examples/own_module.rs, has the same accuracy in ONNX Runtime."""

import csv

import numpy
import onnxruntime
from PIL import Image


def test_an_autoencoder_of_ones_own(own_module, tmp_path):
    (tmp_path / "pictures").mkdir()
    rows, columns = numpy.mgrid[0:64, 0:64]
    for at in range(16):
        waves = numpy.stack([numpy.sin((rows * at + columns * kind) / 40) for kind in (1, 2, 3)], -1)
        Image.fromarray((waves * 100 + 128).astype(numpy.uint8)).save(tmp_path / f"pictures/{at}.png")
    own_module(tmp_path / "pictures", tmp_path / "run")
    session = onnxruntime.InferenceSession(tmp_path / "run/model/model.onnx")
    picture = numpy.asarray(Image.open(tmp_path / "pictures/3.png"), numpy.float32).transpose(2, 0, 1)
    image = (picture - 127.5) / 127.5
    (again,) = session.run(None, {"image": numpy.stack([image] * 3)})
    assert again.shape == (3, 3, 64, 64)
    assert numpy.square(again - image).mean() < 0.5 * numpy.square(image).mean()
    with open(tmp_path / "run/log/log.csv") as log:
        losses = [float(row["train/epoch_loss"]) for row in csv.DictReader(log) if row["train/epoch_loss"]]
    assert len(losses) == 20 and losses[-1] < 0.5 * losses[0]
