"""Names of files."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Union


def bump_version(path: Union[str, os.PathLike[str]]) -> Path:
    """Returns a name under which there is no file: ``path`` itself, or the next number in its place.

    ``model.json`` becomes ``model_1.json``, ``model_1.json`` becomes ``model_2.json`` where it is there.
    """
    wanted = Path(path)
    if not wanted.exists():
        return wanted
    numbered = re.fullmatch(r"(.*)_(\d+)", wanted.stem)
    stem, number = (numbered[1], int(numbered[2])) if numbered else (wanted.stem, 0)
    while wanted.exists():
        number += 1
        wanted = wanted.with_name(f"{stem}_{number}{wanted.suffix}")
    return wanted
