"""Detects cars in a lidar scan and draws both from above. Input: scan.bin, a scan in KITTI's format."""

import numpy as np

import opendr
from opendr.engine.data import Image

detector = opendr.learner("voxel_object_detection_3d")
points = np.fromfile("scan.bin", "<f4").astype(float).reshape(-1, 4)
cars = detector.infer("scan.bin")
# A pixel is 10 cm, ahead is up; the scan is in the lower half, since the detector processes what is ahead.
picture = np.zeros((600, 600, 3), np.uint8)


def mark(ahead, left, colour):
    row, column = 600 - (ahead * 10).astype(int), 300 - (left * 10).astype(int)
    inside = (row >= 0) & (row < 600) & (column >= 0) & (column < 600)
    picture[row[inside], column[inside]] = colour


mark(points[:, 0], points[:, 1], (150, 150, 150))
for car in cars:
    # Camera coordinates: x to the right, z ahead.
    x, _, z = car.location
    print(f"a car {z:.1f} m ahead, {x:.1f} m to the right, score {car.confidence:.2f}")
    offsets = np.mgrid[-10:11, -10:11].reshape(2, -1) / 10
    mark(z + offsets[0], -x + offsets[1], (0, 160, 255))
Image(picture).save("lidar_boxes.png")
