"""Invalid input raises exceptions with a helpful message; nothing crashes."""

import os
import sys
import threading

import numpy as np
import pytest
from opendr.engine.data import Image

WRONG = {
    "None": None,
    "number": 5,
    "text that is no path": "no/such/picture.jpg",
    "bytes": b"abc",
    "dictionary": {},
    "object": object(),
    "objects": np.array([[["a"]]], dtype=object),
    "complex numbers": np.zeros((4, 4, 3), complex),
    "dates": np.zeros((4, 4, 3), "datetime64[s]"),
    "no axes": np.float32(1),
    "one axis": np.zeros(9, np.uint8),
    "two axes": np.zeros((9, 9), np.uint8),
    "four axes": np.zeros((1, 9, 9, 3), np.uint8),
    "empty": np.zeros((0, 9, 3), np.uint8),
    "two channels": np.zeros((9, 9, 2), np.uint8),
    "five channels": np.zeros((9, 9, 5), np.uint8),
    "numbers above 255": np.full((9, 9, 3), 300.0),
    "NaN": np.full((9, 9, 3), np.nan),
    "structured": np.zeros((9, 9, 3), dtype=[("a", "u1")]),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_pictures(nanodet, name):
    with pytest.raises((TypeError, ValueError, OSError)) as raised:
        nanodet.infer(WRONG[name])
    assert len(str(raised.value)) > 10
    assert nanodet.is_ready


def test_huge_views_of_nothing_are_refused(nanodet):
    # A view of one byte as a terabyte.
    huge = np.lib.stride_tricks.as_strided(np.zeros(1, np.uint8), (1 << 20, 1 << 20, 3), (0, 0, 0))
    with pytest.raises((ValueError, MemoryError)):
        nanodet.infer(Image(huge))


def test_arrays_that_lie_about_their_memory(nanodet, photo):
    class Liar(np.ndarray):
        __array_interface__ = {"data": (16, True), "shape": (3, 9999, 9999), "typestr": "|u1", "strides": None}
        strides = (1, 1, 1)

    image = Image.open(photo)
    wanted = nanodet.infer(Image(image.numpy(), guess_format=False)).to_json()
    told = Image(image.numpy(), guess_format=False)
    told._data = told.data.view(Liar)
    assert nanodet.infer(told).to_json() == wanted


def test_swapped_bytes_and_unaligned_memory(nanodet, photo):
    frame = Image.open(photo).opencv()
    wanted = nanodet.infer(frame).to_json()
    buffer = np.zeros(frame.nbytes + 1, np.uint8)
    unaligned = buffer[1:].reshape(frame.shape)
    unaligned[:] = frame
    assert nanodet.infer(unaligned).to_json() == wanted
    thermal = np.full((40, 50), 1000, dtype=">u2")[None]
    assert nanodet.infer(Image(thermal, dtype=np.uint16)) is not None
    floats = np.zeros(40 * 50 * 3 * 4 + 1, np.uint8)[1:].view(np.float32).reshape(40, 50, 3)
    assert len(nanodet.infer(Image(floats, dtype=np.float32))) == 0


def test_wrong_number_of_inputs(nanodet, photo):
    with pytest.raises(ValueError, match='"image".*missing'):
        nanodet.infer()
    with pytest.raises(TypeError, match="threshold should be a float"):
        nanodet.infer(photo, photo)
    with pytest.raises(TypeError, match="twice"):
        nanodet.infer(photo, image=photo)


def test_no_pieces(nanodet, photo):
    with pytest.raises(NotImplementedError, match="pieces"):
        nanodet.push(photo)


@pytest.mark.skipif(sys.platform != "linux", reason="file names of any bytes")
def test_paths_of_any_bytes(nanodet, photo, tmp_path):
    name = os.path.join(os.fsencode(tmp_path), b"p\xff\xfe.jpg")
    with open(name, "wb") as file:
        file.write(photo.read_bytes())
    assert len(nanodet.infer(os.fsdecode(name))) > 0
    with pytest.raises(OSError):
        nanodet.infer(os.fsdecode(name[:-5]))


def test_many_threads_share_a_learner(faces, photo):
    frame = Image.open(photo).opencv()
    wanted = faces.infer(frame).to_json()
    wrong = []

    def work(infer):
        for _ in range(10):
            if infer(frame).to_json() != wanted:
                wrong.append(1)

    threads = [threading.Thread(target=work, args=(infer,)) for infer in (faces.infer, faces.stream().infer) * 3]
    for thread in threads:
        thread.start()
    for _ in range(50):
        # Parameters and other calls in between: no deadlock.
        faces.threshold = faces.threshold
        faces.reset()
    for thread in threads:
        thread.join(60)
        assert not thread.is_alive()
    assert not wrong


def test_a_frame_that_is_written_meanwhile(faces):
    frame = np.zeros((480, 640, 3), np.uint8)
    done = threading.Event()

    def write():
        while not done.is_set():
            frame[:] = np.random.randint(0, 255, frame.shape, np.uint8)

    thread = threading.Thread(target=write)
    thread.start()
    try:
        for _ in range(30):
            faces.infer(frame)
    finally:
        done.set()
        thread.join()
