#!/usr/bin/env python3
"""Puts clips of spoken words into a folder of Speech Commands' form whose part `testing` are other speakers than those of `train`.

    python3 models/training/speech_commands.py CLIPS runs/matchboxnet_commands/data

CLIPS has a folder of WAVE files per word. A fifth of the speakers, by the hash in the names of their clips, is held out; clips of noise are
split by their number.
"""

import argparse
import os
import pathlib
import re


def speaker(name):
    """Returns the hash of the speaker, or the number of a clip without one."""
    found = re.search(r"(?:^|_)([0-9a-f]{8})_nohash", name)
    return int(found.group(1) if found else name.split(".")[0], 16)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("clips", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    options = parser.parse_args()
    held, count = [], 0
    for clip in sorted(options.clips.glob("*/*.wav")):
        name = f"{clip.parent.name}/{clip.name}"
        place = options.out / name
        place.parent.mkdir(parents=True, exist_ok=True)
        if not place.exists():
            os.link(clip, place)
        count += 1
        if speaker(clip.name) % 5 == 4:
            held.append(name)
    (options.out / "testing_list.txt").write_text("\n".join(held) + "\n")
    (options.out / "validation_list.txt").write_text("")
    print(f"{count - len(held)} clips to train on, {len(held)} of other speakers")


if __name__ == "__main__":
    main()
