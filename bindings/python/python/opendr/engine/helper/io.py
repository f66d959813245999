"""Names of files."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Union


def bump_version(path: Union[str, os.PathLike[str]]) -> Path:
    """Returns an unused path: ``path`` itself, or ``path`` with the next free number.

    If they exist, ``model.json`` becomes ``model_1.json``, and ``model_1.json`` becomes ``model_2.json``.
    """
    unused = Path(path)
    if not unused.exists():
        return unused
    numbered = re.fullmatch(r"(.*)_(\d+)", unused.stem)
    stem, number = (numbered[1], int(numbered[2])) if numbered else (unused.stem, 0)
    while unused.exists():
        number += 1
        unused = unused.with_name(f"{stem}_{number}{unused.suffix}")
    return unused
