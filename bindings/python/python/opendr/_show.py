"""Showing an image in a window if possible, else writing it as a file."""

from __future__ import annotations

import functools
import importlib
import importlib.util
import os
import subprocess
import sys
import tempfile
from typing import Any

from opendr.engine.data import Image

_TITLE = "OpenDR"
# A window library may abort the process when its display does not respond, so a separate process tries it.
_PROBE = "import cv2; cv2.namedWindow('OpenDR'); cv2.waitKey(1); cv2.destroyAllWindows()"


def show_image(image: Image) -> None:
    """Shows an image in the cell of a notebook; else opens a window and waits for a key, or for the window to be closed. Without
    OpenCV or a display, writes a file with an unused name into the current folder (else the folder for temporary files) and prints
    its path.

    Raises:
        OSError: The file cannot be written.
    """
    if in_notebook():
        importlib.import_module("IPython.display").display(image)
    elif window_works():
        _show_window(image.opencv())
    else:
        print(f"image written to {write_image(image)}")


def in_notebook() -> bool:
    """Returns whether the program is the code of a notebook, whose kernel displays images."""
    ipython: Any = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


def window_works() -> bool:
    """Returns whether OpenCV is installed with support for windows and a display responds."""
    linux = sys.platform.startswith("linux")
    displays = (os.environ.get("DISPLAY", ""), os.environ.get("WAYLAND_DISPLAY", ""))
    if linux and not any(displays) or importlib.util.find_spec("cv2") is None or not sys.executable:
        return False
    return _probe(displays)


@functools.lru_cache(maxsize=None)
def _probe(displays: tuple[str, str]) -> bool:
    try:
        probe = subprocess.run([sys.executable, "-c", _PROBE], capture_output=True, timeout=10, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return probe.returncode == 0


def _show_window(pixels: Any) -> None:
    cv2: Any = importlib.import_module("cv2")
    cv2.imshow(_TITLE, pixels)
    while cv2.waitKey(50) < 0 and cv2.getWindowProperty(_TITLE, cv2.WND_PROP_VISIBLE) >= 1:
        pass
    cv2.destroyWindow(_TITLE)


def write_image(image: Image) -> str:
    """Writes a PNG file with an unused name.

    Returns:
        The absolute path of the file.

    Raises:
        OSError: Neither the current folder nor that for temporary files can be written.
    """
    try:
        path = _reserved(os.getcwd())
    except OSError:
        path = _reserved(tempfile.gettempdir())
    image.save(path)
    return path


def _reserved(folder: str) -> str:
    number = 0
    while True:
        path = os.path.join(folder, f"opendr-{number}.png" if number else "opendr.png")
        try:
            with open(path, "xb"):
                return path
        except FileExistsError:
            number += 1
