"""Generates the Python modules of the ROS 1 messages that Debian lacks into the folder named on the command line.

The definitions are crates/messages/msg with crates/messages/ros1 over it, what they need of others is Debian's, and the
generator is ROS 1's own. For Debian's Python. Nothing is done when the definitions have not changed.
"""

import hashlib
import shutil
import sys
from pathlib import Path

import genpy.generate_initpy
import genpy.generator

MESSAGES = Path(__file__).resolve().parents[3] / "crates/messages"
PACKAGES = ["vision_msgs", "audio_common_msgs", "opendr_msgs"]
OTHERS = ["std_msgs", "geometry_msgs", "sensor_msgs"]


def renamed():
    """ROS 2's names of the messages that ROS 1 has not, or under another name."""
    lines = (MESSAGES / "ros1/names.txt").read_text().splitlines()
    return {line.split()[0] for line in lines if line and not line.startswith("#")}


def definitions():
    """Texts by package and file name."""
    without = renamed()
    found = {}
    for package in PACKAGES:
        for root in [MESSAGES / "msg", MESSAGES / "ros1"]:
            for file in sorted((root / package / "msg").glob("*.msg")):
                if root.name == "ros1" or f"{package}/{file.stem}" not in without:
                    found[package, file.name] = file.read_text()
    return found


def main(folder):
    found = definitions()
    wanted = hashlib.sha256((repr(found) + Path(__file__).read_text()).encode()).hexdigest()
    stamp = folder / "messages.installed"
    if stamp.is_file() and stamp.read_text() == wanted:
        return
    shutil.rmtree(folder, ignore_errors=True)
    places = {package: folder / "definitions" / package / "msg" for package in PACKAGES}
    for (package, name), text in found.items():
        places[package].mkdir(parents=True, exist_ok=True)
        (places[package] / name).write_text(text)
    search = {package: [str(place)] for package, place in places.items()}
    search.update({package: [f"/usr/share/{package}/msg"] for package in OTHERS})
    for package, place in places.items():
        target = folder / package / "msg"
        files = [str(file) for file in sorted(place.iterdir())]
        if genpy.generator.MsgGenerator().generate_messages(package, files, str(target), search) != 0:
            sys.exit(f"{package} cannot be generated")
        genpy.generate_initpy.write_modules(str(target))
        (folder / package / "__init__.py").touch()
        print(f"generated {package}: {len(files)} definitions", flush=True)
    stamp.write_text(wanted)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
