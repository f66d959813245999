#!/usr/bin/env python3
"""The built-in runtime of the release binary beside plain rten at opt-level 3 and, where it is installed, ONNX Runtime: sessions alone.

    benches/builtin.py [--opendr target/release/opendr] [--data ../shared] [--threads 2] [--rounds 5] [--write]

Builds `benches/plain_rten` (rten as it comes, opt-level 3), has every side run the same ONNX file with the same number of threads,
taking turns, and prints medians and ratios. A ratio above 1.03 to plain rten fails. --write puts the range of the ratios to ONNX Runtime
where `opendr runtime` has it (crates/inference/src/measured.rs). Needs numpy and onnxruntime (for its column), and an idle machine.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MODELS = {
    "nanodet": "1,3,416,416",
    "centernet": "1,3,512,512",
    "posenet": "1,3,385,385",
    "yunet": "1,3,640,640",
}
RUNS = 30
LIMIT = 1.03
MEASURED = ROOT / "crates/inference/src/measured.rs"


def plain_rten():
    """Returns the built program."""
    folder = ROOT / "benches/plain_rten"
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "plain_rten"
    subprocess.run(["cargo", "build", "--quiet", "--release", "--target-dir", target], cwd=folder, check=True)
    return target / "release/plain-rten"


def milliseconds_of_rten(program, model, dims, threads):
    done = subprocess.run(
        [program, model, dims, str(threads), str(RUNS + 5)], stdout=subprocess.PIPE, text=True, check=True
    )
    return statistics.median([float(line) for line in done.stdout.split()][5:])


def milliseconds_of_opendr(program, learner, threads, environment):
    command = [program, "bench", learner, "--frames", str(RUNS), "--warmup", "5", "--threads", str(threads), "--json"]
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)["p50_ms"]["session"]


def milliseconds_of_onnxruntime(session, dims):
    import time

    import numpy

    picture = numpy.random.default_rng(1).random([int(dim) for dim in dims.split(",")], dtype=numpy.float32)
    taken = []
    for _ in range(RUNS + 5):
        start = time.perf_counter()
        session.run(None, {session.get_inputs()[0].name: picture})
        taken.append(1e3 * (time.perf_counter() - start))
    return statistics.median(taken[5:])


def onnxruntime_session(model, threads):
    try:
        import onnxruntime
    except ImportError:
        return None
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    return onnxruntime.InferenceSession(model, options, providers=["CPUExecutionProvider"])


def write_range(ratios):
    text = MEASURED.read_text()
    low, high = min(ratios), max(ratios)
    text, count = re.subn(r"(SLOWER_THAN_ONNX_RUNTIME: \[f32; 2\] = )\[[^]]*\]", rf"\g<1>[{low:.1f}, {high:.1f}]", text)
    assert count == 1, MEASURED
    MEASURED.write_text(text)
    print(f"wrote {low:.1f} to {high:.1f} into {MEASURED}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--opendr", default=str(ROOT / "target/release/opendr"))
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    rten = plain_rten()
    environment = {
        **os.environ,
        "OPENDR_RUNTIME": "builtin",
        "OPENDR_MODEL_REPOSITORY": str(options.data / "models"),
    }
    failed, to_onnxruntime = False, []
    print(f"{options.threads} threads, medians of {options.rounds} rounds of {RUNS} sessions, ms")
    with tempfile.TemporaryDirectory() as folder:
        for learner, dims in MODELS.items():
            download = [options.opendr, "download", learner, "--to", folder]
            subprocess.run(download, env=environment, check=True, stdout=subprocess.DEVNULL)
            (model,) = (path for path in Path(folder).rglob("model.onnx") if learner in str(path))
            session = onnxruntime_session(str(model), options.threads)
            ours, plain, theirs = [], [], []
            for _ in range(options.rounds):
                ours.append(milliseconds_of_opendr(options.opendr, learner, options.threads, environment))
                plain.append(milliseconds_of_rten(rten, model, dims, options.threads))
                if session is not None:
                    theirs.append(milliseconds_of_onnxruntime(session, dims))
            ratio = statistics.median(a / b for a, b in zip(ours, plain))
            line = f"{learner:12} built-in {statistics.median(ours):7.2f}  plain rten {statistics.median(plain):7.2f}  ratio {ratio:.3f}"
            if theirs:
                to_onnxruntime.append(statistics.median(a / b for a, b in zip(ours, theirs)))
                line += f"  ONNX Runtime {statistics.median(theirs):7.2f}  ratio {to_onnxruntime[-1]:.2f}"
            print(line, flush=True)
            failed |= ratio > LIMIT
    if options.write and to_onnxruntime:
        write_range(to_onnxruntime)
    if failed:
        sys.exit(f"the built-in runtime is slower than {LIMIT} times plain rten")


if __name__ == "__main__":
    main()
