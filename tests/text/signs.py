"""Rendered signs: text in fonts of Debian, in perspective, tilted, over noise, and blurred."""

import random
from pathlib import Path

import cv2
import numpy as np
from PIL import Image, ImageDraw, ImageFont

FONTS = Path("/usr/share/fonts/truetype/dejavu")
NAMES = ["DejaVuSans", "DejaVuSans-Bold", "DejaVuSerif", "DejaVuSerif-Bold", "DejaVuSansMono"]
TEXTS = [
    "EMERGENCY EXIT",
    "NO PARKING",
    "Platform 12",
    "Push to open",
    "CAUTION WET FLOOR",
    "Room 204 East",
    "Please wait here",
    "STAFF ONLY",
    "Lift 3 out of order",
    "Fire Extinguisher",
]
SIZE = (640, 480)


def sign(number, upside_down=False):
    """Returns an image [480, 640, 3] of BGR bytes with one text, and the corners [4, 2] of the text."""
    draw, numbers = random.Random(number), np.random.default_rng(number)
    text, font = TEXTS[number], ImageFont.truetype(FONTS / f"{NAMES[number % len(NAMES)]}.ttf", draw.randint(30, 54))
    left, top, right, bottom = font.getbbox(text)
    width, height = right - left, bottom - top
    plate = Image.new("RGB", (width + 80, height + 70), tuple(draw.randint(120, 255) for _ in range(3)))
    ink = tuple(draw.randint(0, 60) for _ in range(3))
    ImageDraw.Draw(plate).text((40 - left, 35 - top), text, font=font, fill=ink)
    scale = min(560 / plate.width, 1.0)
    half = np.array([plate.width, plate.height]) * scale / 2
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half
    angle = draw.uniform(-0.25, 0.25) + (np.pi if upside_down else 0)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    corners = corners @ turn.T + [320, draw.uniform(180, 300)] + numbers.uniform(-0.25, 0.25, (4, 2)) * half[1]
    whole = np.float32([[0, 0], [plate.width, 0], [plate.width, plate.height], [0, plate.height]])
    perspective = cv2.getPerspectiveTransform(whole, corners.astype(np.float32))
    scene = np.full((SIZE[1], SIZE[0], 3), [draw.randint(0, 255) for _ in range(3)]) + numbers.normal(0, 12, (SIZE[1], SIZE[0], 3))
    mask = cv2.warpPerspective(np.full((plate.height, plate.width), 255, np.uint8), perspective, SIZE)
    image = np.where(mask[..., None] > 127, cv2.warpPerspective(np.array(plate), perspective, SIZE), scene)
    image = cv2.GaussianBlur(np.clip(image, 0, 255).astype(np.uint8), (0, 0), draw.uniform(0.6, 1.4))
    box = np.float32([[[40, 35], [40 + width, 35], [40 + width, 35 + height], [40, 35 + height]]])
    return np.ascontiguousarray(image[..., ::-1]), cv2.perspectiveTransform(box, perspective)[0]


def write_signs(folder, upside_down=False):
    """Writes the signs as a data set of ICDAR's format and returns its folder."""
    for name in ("images", "gt"):
        (folder / name).mkdir()
    for number, text in enumerate(TEXTS):
        image, corners = sign(number, upside_down)
        cv2.imwrite(str(folder / f"images/sign_{number}.png"), image)
        line = ",".join(f"{value:.1f}" for value in corners.ravel())
        (folder / f"gt/gt_sign_{number}.txt").write_text(f"{line},{text}\n")
    return folder
