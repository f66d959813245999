"""Rendering of labelled data sets."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Optional

from opendr import _opendr


def render(
    world: str,
    out: Any,
    *,
    frames: int = 1000,
    size: tuple[int, int] = (640, 480),
    seed: int = 0,
    to: Optional[str] = None,
    split: Optional[str] = None,
    geometry: bool = False,
    verbose: bool = False,
) -> Optional[Path]:
    """Renders a labelled data set of an embedded world into a folder.

    Args:
        world: ``persons`` (boxes and masks), ``person_keypoints``, ``faces``, ``objects`` (views by class) or ``street``
            (lidar scans with 3D boxes).
        out: Folder to write into.
        frames: Number of samples.
        size: Width and height of images, in pixels.
        seed: Seed; a sample depends on the seed and its index only.
        to: Format to write; None writes that of the world: COCO, class folders or KITTI.
        split: Name of the written split.
        geometry: Whether depth (16-bit PNG, millimetres), normals and camera of each image of persons are written, too.
        verbose: Whether to show progress.

    Returns:
        The path of a contact sheet with labels; None for point clouds.

    Raises:
        ValueError: An argument is out of range, or the format does not have the labels of the world.
        OSError: A file cannot be written.
    """
    width, height = size
    _, _, sheet = _opendr.render(world, os.fspath(out), frames, [width, height], seed, to, split, geometry, verbose)
    return None if sheet is None else Path(sheet)
