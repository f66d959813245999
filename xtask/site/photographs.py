"""Writes the photographs that the pages of the learners show into a folder, as JPEG: photographs.py FOLDER [ORIGINALS]

They are from the package scikit-image, free to publish, and not stored in the repository. ORIGINALS is a folder that has them; without
it, or where it lacks one, pip downloads the package.
"""

import subprocess
import sys
import tempfile
import zipfile
from io import BytesIO
from pathlib import Path

from PIL import Image

#: The release that has the photographs in the wheel, and the wheel's tags: nothing of it is installed.
PACKAGE = "scikit-image==0.17.2"
WHEEL = ["--python-version", "3.8", "--platform", "manylinux1_x86_64", "--only-binary", ":all:"]
#: Astronaut Eileen Collins (NASA, public domain), a cup of coffee (Rachel Michetti, CC0), Chelsea the cat (Stefan van der Walt, CC0).
NAMES = ("astronaut", "coffee", "chelsea")


def originals(folder):
    """Returns the content of the PNG files by name."""
    paths = {name: Path(folder) / f"{name}.png" for name in NAMES} if folder else {}
    if paths and all(path.is_file() for path in paths.values()):
        return {name: path.read_bytes() for name, path in paths.items()}
    with tempfile.TemporaryDirectory() as to:
        pip = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps", *WHEEL]
        subprocess.run([*pip, "--dest", to, PACKAGE], check=True)
        [wheel] = Path(to).glob("*.whl")
        with zipfile.ZipFile(wheel) as members:
            return {name: members.read(f"skimage/data/{name}.png") for name in NAMES}


def main(to, folder=None):
    to = Path(to)
    to.mkdir(parents=True, exist_ok=True)
    for name, content in originals(folder).items():
        Image.open(BytesIO(content)).convert("RGB").save(to / f"{name}.jpg", quality=95, subsampling=0)


if __name__ == "__main__":
    main(*sys.argv[1:])
