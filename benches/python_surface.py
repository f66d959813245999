#!/usr/bin/env python3
"""What the Python surface costs: `infer` on a NumPy frame beside the same call in Rust, in one run.

    benches/python_surface.py --opendr target/release/opendr [--learner nanodet] [--threads 2]

Run it with a Python that has the wheel installed. The Rust side is `opendr bench` on the same 1080p picture; rounds of
both sides alternate, and the ratio is the median of the rounds' ratios of median times.
"""

import argparse
import json
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

ROUNDS = 9


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--opendr", default="target/release/opendr")
    parser.add_argument("--learner", default="nanodet")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--frames", type=int, default=40)
    arguments = parser.parse_args()
    os.environ["OPENDR_THREADS"] = str(arguments.threads)

    import numpy as np
    import opendr
    from opendr import _opendr
    from opendr.engine.data import Image

    learner = opendr.learner(arguments.learner, verbose=False)
    frame = np.random.default_rng(0).integers(0, 255, (1080, 1920, 3), np.uint8)
    sample = Image.open(learner.download(mode="images", verbose=False)).opencv()
    frame[: sample.shape[0], : sample.shape[1]] = sample[:1080, :1920]
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "frame.png"
        Image(frame).save(picture)
        command = [arguments.opendr, "bench", arguments.learner, picture, "--json", "--quiet"]
        command += ["--frames", str(arguments.frames)]

        def rust():
            report = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
            return report["p50_ms"]["total"]

        def python():
            times = []
            for _ in range(arguments.frames):
                start = time.perf_counter()
                learner.infer(frame)
                times.append(time.perf_counter() - start)
            return 1e3 * statistics.median(times)

        python()
        rounds = [(rust(), python()) for _ in range(ROUNDS)]
    ratio = statistics.median(there / here for here, there in rounds)
    here, there = (statistics.median(side) for side in zip(*rounds))
    print(f"{arguments.learner} on {_opendr.runtime()}, 1080p NumPy frame, median of {ROUNDS} rounds:")
    print(f"  rust {here:.2f} ms, python {there:.2f} ms, ratio {ratio:.3f} (aim 1.05)")


if __name__ == "__main__":
    main()
