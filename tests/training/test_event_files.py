"""Event files, read by TensorBoard."""

import io
import math

import numpy as np
import pytest
from PIL import Image
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator
from tensorboard.backend.event_processing.plugin_event_accumulator import EventAccumulator as PluginEventAccumulator
from tensorboard.util import tensor_util


def scalars(folder, tag):
    accumulator = EventAccumulator(str(folder), size_guidance={"scalars": 0}).Reload()
    return {event.step: event.value for event in accumulator.Scalars(tag)}


def values(tag, steps, value=float):
    return [{"tag": tag, "step": step, "value": value(step)} for step in steps]


def test_scalars(log, tmp_path):
    log(tmp_path, values("loss", range(1000), lambda step: 1 / (step + 1)) + values("val/map50", [0, 999], lambda _: 0.0))
    assert scalars(tmp_path, "loss") == pytest.approx({step: 1 / (step + 1) for step in range(1000)})
    assert scalars(tmp_path, "val/map50") == {0: 0.0, 999: 0.0}


def test_values_that_are_not_finite(log, tmp_path):
    log(tmp_path, [{"tag": "loss", "step": 2**40, "value": 1e60}, {"tag": "lr", "step": 1, "value": 1e-60}])
    assert scalars(tmp_path, "loss") == {2**40: math.inf}
    assert scalars(tmp_path, "lr") == {1: 0.0}


def test_pictures(log, tmp_path):
    pixels = np.random.default_rng(0).integers(0, 256, (5, 7, 3), dtype=np.uint8)
    log(tmp_path, [{"tag": "batch", "step": 3, "picture": [5, 7, pixels.flatten().tolist()]}])
    [event] = EventAccumulator(str(tmp_path)).Reload().Images("batch")
    assert (event.step, event.height, event.width) == (3, 5, 7)
    assert (np.asarray(Image.open(io.BytesIO(event.encoded_image_string))) == pixels).all()


def test_what_a_resumed_run_does_again_is_dropped(log, tmp_path):
    log(tmp_path, values("loss", range(10)))
    log(tmp_path, values("loss", range(5, 8), lambda step: 100.0 + step), resume_from=4)
    expected = {**{step: float(step) for step in range(5)}, **{step: 100.0 + step for step in range(5, 8)}}
    assert scalars(tmp_path, "loss") == expected
    rows = (tmp_path / "log.csv").read_text().splitlines()
    assert rows == ["step,loss"] + [f"{step},{value}" for step, value in expected.items()]


def test_a_resume_within_the_second_is_read_in_order(log, tmp_path):
    for last in range(6):
        log(tmp_path, values("loss", [last, last + 1], lambda _: float(last)), resume_from=last - 1 if last else None)
    assert scalars(tmp_path, "loss") == {0: 0, 1: 1, 2: 2, 3: 3, 4: 4, 5: 5, 6: 5}


def test_the_reader_of_the_web_page(log, tmp_path):
    log(tmp_path, values("loss", range(5)))
    tensors = PluginEventAccumulator(str(tmp_path)).Reload().Tensors("loss")
    assert [(event.step, tensor_util.make_ndarray(event.tensor_proto).item()) for event in tensors] == [
        (step, step) for step in range(5)
    ]
