"""The examples of docs/python.md and docs/simulation.md run; those marked `python no_run` need models."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[3] / "docs"
BLOCKS = [
    block
    for page in ("python.md", "simulation.md")
    for block in re.findall(r"^```python\n(.*?)^```$", (DOCS / page).read_text("utf-8"), re.DOTALL | re.MULTILINE)
]


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.strip().splitlines()[0])
def test_example(block, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    example = tmp_path / "example.py"
    example.write_text("import numpy as np\n" + block, encoding="utf-8")
    runpy.run_path(str(example))


def test_there_are_examples():
    assert len(BLOCKS) >= 3
