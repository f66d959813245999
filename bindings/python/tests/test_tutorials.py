"""The tutorials that need the command and the Python package are followed word for word."""

import os
import sys
from pathlib import Path

import pytest
from tutorial import FOLDER, Reader

PAGES = ["command_line.md", "python.md", "migration.md", "training.md", "reinforcement_learning.md"]
#: Followed elsewhere: in tests/c, in tests/ros, and as documentation tests of the crate `opendr`.
OTHERS = ["c_embedded.md", "ros1.md", "ros2.md", "rust.md"]
#: Data sets of Debian's packages that a page uses.
DEBIAN = {"training.md": Path("/usr/share/datasets/fashion-mnist")}


@pytest.mark.parametrize("page", PAGES)
def test_tutorial(page, zoo, tmp_path):
    if page in DEBIAN and not DEBIAN[page].is_dir():
        pytest.skip(f"no {DEBIAN[page]}")
    folder = tmp_path / "reader"
    folder.mkdir()
    programs = {"opendr": os.environ["OPENDR_BIN"], "python": sys.executable}
    with Reader(page, folder, os.environ, programs) as reader:
        reader.follow()


def test_every_tutorial_is_followed():
    assert {path.name for path in FOLDER.glob("*.md")} == {"index.md", *PAGES, *OTHERS}
