#!/usr/bin/env python3
"""Writes the skeletons of UTD-MHAD as arrays that `opendr fit spatio_temporal_gcn` reads, split by person.

    python3 models/training/utd_mhad.py ../shared/data/utd_mhad_skeleton runs/utd_mhad --held 7

The folder has frames.npy, float32 (frame, joint, 3), and index.tsv with the first frame and length of every sequence. The result
has PART_data.npy [sequence, 3, frames, joints, 1] and PART_label.npy for the parts `train` and `val`; sequences that are shorter
than the longest are preceded by their repeated first frame.
"""

import argparse
import array
import csv
import pathlib
import struct

JOINTS = 20
#: Names of the 27 actions (Chen, Jafari and Kehtarnavaz, UTD-MHAD, ICIP 2015).
ACTIONS = """swipe left, swipe right, wave, clap, throw, cross arms, basketball shoot, draw x, draw circle clockwise,
draw circle counter-clockwise, draw triangle, bowling, boxing, baseball swing, tennis swing, arm curl, tennis serve, push, knock,
catch, pick up and throw, jog, walk, sit to stand, stand to sit, lunge, squat"""


def read_frames(path):
    """Returns the numbers of a float32 array file."""
    with path.open("rb") as file:
        if file.read(6) != b"\x93NUMPY":
            raise SystemExit(f"{path} is not a NumPy array")
        file.read(2)
        header = file.read(struct.unpack("<H", file.read(2))[0])
        if b"'<f4'" not in header or b"False" not in header:
            raise SystemExit(f"{path}: expected float32 in C order, found {header!r}")
        numbers = array.array("f")
        numbers.frombytes(file.read())
    return numbers


def write_npy(path, numbers, kind, shape):
    """Writes an array file of version 1."""
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".encode()
    header += b" " * (-(len(header) + 11) % 64) + b"\n"
    with path.open("wb") as file:
        file.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header)
        numbers.tofile(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--held", default="7", help="subjects of the part val, separated by commas")
    options = parser.parse_args()
    held = set(options.held.split(","))
    numbers = read_frames(options.folder / "frames.npy")
    with (options.folder / "index.tsv").open() as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    longest = max(int(row["frames"]) for row in rows)
    options.out.mkdir(parents=True, exist_ok=True)
    for part, is_held in (("train", False), ("val", True)):
        chosen = [row for row in rows if (row["subject"] in held) == is_held]
        data, labels = array.array("f"), array.array("q")
        for row in chosen:
            first, count = int(row["first_frame"]), int(row["frames"])
            times = [first] * (longest - count) + list(range(first, first + count))
            for axis in range(3):
                for time in times:
                    start = time * JOINTS * 3 + axis
                    data.extend(numbers[start : start + JOINTS * 3 : 3])
            labels.append(int(row["action"]) - 1)
        write_npy(options.out / f"{part}_data.npy", data, "<f4", (len(chosen), 3, longest, JOINTS, 1))
        write_npy(options.out / f"{part}_label.npy", labels, "<i8", (len(chosen),))
        print(f"{part}: {len(chosen)} sequences of at most {longest} frames")
    names = [name.strip() for name in ACTIONS.replace("\n", " ").split(",")]
    (options.out / "label_map.txt").write_text("\n".join(names) + "\n")


if __name__ == "__main__":
    main()
