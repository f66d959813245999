"""Pre-processing with OpenCV and NumPy beside opendr-vision's, in one run; prints JSON.

    python benches/preprocess.py

needs opencv-python and numpy, and cargo. Times are medians in milliseconds; `ratio` is ours to Python's.
"""

import json
import pathlib
import subprocess
import time

import cv2
import numpy as np

CRATE = pathlib.Path(__file__).resolve().parent.parent
MEAN = np.array([103.53, 116.28, 123.675], np.float32)
STD = np.array([57.375, 57.12, 58.395], np.float32)


def frame(width, height):
    return np.random.default_rng(0).integers(0, 256, (height, width, 3), np.uint8)


def planes(picture):
    return np.ascontiguousarray(picture.transpose(2, 0, 1)[None])


def rgb(picture, width, height):
    picture = cv2.resize(picture, (width, height))
    return planes(cv2.cvtColor(picture, cv2.COLOR_BGR2RGB).astype(np.float32))


def nanodet(picture):
    return planes((cv2.resize(picture, (416, 416)).astype(np.float32) - MEAN) / STD)


def letterbox(picture, side, centred=True):
    height, width = picture.shape[:2]
    scale = min(side / width, side / height)
    width, height = round(width * scale), round(height * scale)
    left, top = ((side - width) // 2, (side - height) // 2) if centred else (0, 0)
    picture = cv2.resize(picture, (width, height))
    bottom, right = side - height - top, side - width - left
    return cv2.copyMakeBorder(picture, top, bottom, left, right, cv2.BORDER_CONSTANT, value=0)


def nanodet_letterbox(picture):
    return planes((letterbox(picture, 416).astype(np.float32) - MEAN) / STD)


def posenet(picture):
    return planes(cv2.cvtColor(letterbox(picture, 385), cv2.COLOR_BGR2RGB).astype(np.float32) / 127.5 - 1)


def yunet(picture):
    return planes(letterbox(picture, 640, centred=False).astype(np.float32))


def ultra_light(picture):
    picture = cv2.cvtColor(cv2.resize(picture, (320, 240)), cv2.COLOR_BGR2RGB)
    return planes((picture.astype(np.float32) - 127) / 128)


def movenet(picture):
    return cv2.cvtColor(letterbox(picture, 192), cv2.COLOR_BGR2RGB).astype(np.int32)[None]


def centernet_from_planes(picture):
    return rgb(picture.transpose(1, 2, 0), 512, 512)


CAMERA = frame(1920, 1080)
CASES = {
    "centernet_1080p": lambda: rgb(CAMERA, 512, 512),
    "nanodet_1080p": lambda: nanodet(CAMERA),
    "nanodet_letterbox_1080p": lambda: nanodet_letterbox(CAMERA),
    "posenet_1080p": lambda: posenet(CAMERA),
    "yunet_1080p": lambda: yunet(CAMERA),
    "ultra_light_1080p": lambda: ultra_light(CAMERA),
    "movenet_1080p": lambda: movenet(CAMERA),
    "centernet_320x240": lambda picture=frame(320, 240): rgb(picture, 512, 512),
    "centernet_1080p_chw": lambda picture=np.ascontiguousarray(CAMERA.transpose(2, 0, 1)): centernet_from_planes(picture),
}


def python_ms(case, seconds=2.0):
    for _ in range(5):
        case()
    times, end = [], time.perf_counter() + seconds
    while time.perf_counter() < end:
        start = time.perf_counter()
        case()
        times.append(time.perf_counter() - start)
    return float(np.median(times)) * 1e3


def ours_ms():
    options = ["--warm-up-time", "1", "--measurement-time", "2", "--noplot"]
    command = ["cargo", "bench", "-p", "opendr-vision", "--bench", "preprocess", "--", *options]
    subprocess.run(command, cwd=CRATE, check=True, capture_output=True)
    metadata = ["cargo", "metadata", "--format-version", "1", "--no-deps"]
    target = json.loads(subprocess.run(metadata, cwd=CRATE, check=True, capture_output=True).stdout)["target_directory"]
    estimates = pathlib.Path(target, "criterion").glob("*/new/estimates.json")
    return {file.parts[-3]: json.loads(file.read_text())["median"]["point_estimate"] / 1e6 for file in estimates}


def main():
    ours = ours_ms()
    report = {}
    for name, case in CASES.items():
        python = python_ms(case)
        report[name] = {"python": round(python, 3), "ours": round(ours[name], 3), "ratio": round(ours[name] / python, 3)}
    print(json.dumps({"opencv": cv2.__version__, "threads": cv2.getNumThreads(), "cases": report}, indent=1))


if __name__ == "__main__":
    main()
