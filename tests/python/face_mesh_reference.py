"""Points of the astronaut's face by ONNX Runtime alone, with MediaPipe's own weights: what ``crates/opendr/tests/suite/faces.rs``
compares with.

    python tests/python/face_mesh_reference.py ../shared

needs numpy, onnxruntime and Pillow; nothing of OpenDR runs here.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import onnxruntime
from PIL import Image

POINTS = (33, 133, 362, 263, 1, 61, 291, 152, 10)


def network(path: Path) -> Any:
    return onnxruntime.InferenceSession(str(path), providers=["CPUExecutionProvider"])


def blend(image: Any, x: Any, y: Any) -> Any:
    """Bilinear samples at pixel centres; 0 outside the image."""
    height, width = image.shape[:2]
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    right, down = (x - left)[..., None], (y - top)[..., None]

    def at(column: Any, row: Any) -> Any:
        inside = ((column >= 0) & (column < width) & (row >= 0) & (row < height))[..., None]
        return np.where(inside, image[row.clip(0, height - 1), column.clip(0, width - 1)], 0.0)

    upper = at(left, top) * (1 - right) + at(left + 1, top) * right
    lower = at(left, top + 1) * (1 - right) + at(left + 1, top + 1) * right
    return upper * (1 - down) + lower * down


class Crop:
    """A rotated square of the image; positions are complex numbers from the top-left corner of the first pixel."""

    def __init__(self, centre: complex, side: float, angle: float, pixels: int) -> None:
        self.turn = side / pixels * np.exp(1j * angle)
        self.origin = centre - self.turn * (pixels / 2) * (1 + 1j)
        self.pixels = pixels

    def cut(self, image: Any) -> Any:
        x, y = np.meshgrid(np.arange(self.pixels) + 0.5, np.arange(self.pixels) + 0.5)
        place = self.in_image(x + 1j * y)
        return blend(image, place.real - 0.5, place.imag - 0.5)[None].astype(np.float32)

    def in_image(self, points: Any) -> Any:
        return self.origin + self.turn * points


def detected(image: Any, path: Path, side: int = 640) -> tuple[Any, Any]:
    """Corners and five points of YuNet's best face."""
    height, width = image.shape[:2]
    scale = side / max(width, height)
    x, y = np.meshgrid((np.arange(side) + 0.5) / scale - 0.5, (np.arange(side) + 0.5) / scale - 0.5)
    inside = (x < width - 0.5) & (y < height - 0.5)
    pixels = blend(image, x.clip(0, width - 1), y.clip(0, height - 1)) * inside[..., None]
    session = network(path)
    given = {session.get_inputs()[0].name: pixels[:, :, ::-1].transpose(2, 0, 1)[None].astype(np.float32)}
    names = [output.name for output in session.get_outputs()]
    outputs = {name: value[0] for name, value in zip(names, session.run(None, given))}
    best: tuple[float, Any, Any] = (0.0, None, None)
    for stride in (8, 16, 32):
        score = np.sqrt(outputs[f"cls_{stride}"].ravel() * outputs[f"obj_{stride}"].ravel())
        cell = int(score.argmax())
        corner = np.array([cell % (side // stride), cell // (side // stride)])
        box = outputs[f"bbox_{stride}"][cell]
        centre, size = (corner + box[:2]) * stride, np.exp(box[2:]) * stride
        points = (outputs[f"kps_{stride}"][cell].reshape(5, 2) + corner) * stride
        if score[cell] > best[0]:
            best = (score[cell], np.array([centre - size / 2, centre + size / 2]) / scale, points / scale)
    return best[1], best[2] @ [1, 1j]


def iris(image: Any, session: Any, corners: Any, mirrored: bool) -> Any:
    across = corners[1] - corners[0]
    crop = Crop(corners.mean(), 2.3 * abs(across), np.angle(across), 64)
    pixels = crop.cut(image) / 255
    points = session.run(None, {"input_1": pixels[:, :, ::-1] if mirrored else pixels})[1].reshape(5, 3)
    x = 64 - points[:, 0] if mirrored else points[:, 0]
    return crop.in_image(x + 1j * points[:, 1])


def main(shared: Path) -> None:
    image = np.asarray(Image.open(shared / "data/photos/astronaut.png").convert("RGB")).astype(np.float64)
    corners, found = detected(image, shared / "models/face_detection/yunet_n_640_640.onnx")
    side = 1.5 * (corners[1] - corners[0]).max()
    crop = Crop(corners.mean(0) @ [1, 1j], side, np.angle(found[1] - found[0]), 192)
    mesh = network(shared / "models/facial_landmarks/face_mesh_468_192.onnx")
    points, presence = mesh.run(None, {"input_1": crop.cut(image) / 255})
    points = crop.in_image(points.reshape(468, 3)[:, :2] @ [1, 1j])
    print("presence", 1 / (1 + np.exp(-presence.item())))
    eyes = network(shared / "models/facial_landmarks/iris_64.onnx")
    shown = {number: points[number] for number in POINTS}
    shown[468] = iris(image, eyes, points[[33, 133]], False)[0]
    shown[473] = iris(image, eyes, points[[362, 263]], True)[0]
    for number, point in shown.items():
        print(number, round(point.real, 2), round(point.imag, 2))
    print("eye distance", round(abs(points[[362, 263]].mean() - points[[33, 133]].mean()), 2))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
