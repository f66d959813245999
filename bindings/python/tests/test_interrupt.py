"""Ctrl-C ends long calls within a second."""

import os
import signal
import socket
import subprocess
import sys
import textwrap
import time

import pytest


def interrupt(program, ready, env, seconds=1.0):
    """Runs a program, sends SIGINT after it printed `ready`, and returns the time until its end and its output."""
    # Shells start background jobs with SIGINT ignored, and Python keeps this.
    heed = "import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n"
    command = [sys.executable, "-c", heed + textwrap.dedent(program)]
    child = subprocess.Popen(command, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert child.stdout.readline().strip() == ready, child.stderr.read()
        time.sleep(0.5)
        begin = time.monotonic()
        child.send_signal(signal.SIGINT)
        _, errors = child.communicate(timeout=30)
    finally:
        child.kill()
    return time.monotonic() - begin, errors


def test_infer_over_a_source(zoo, photo, tmp_path):
    program = f"""
        import opendr
        learner = opendr.learner("nanodet", device="cpu", verbose=False)
        frames = opendr.Source(*[{str(photo)!r}] * 2000)
        print("begun", flush=True)
        for answer in learner.infer(frames):
            pass
    """
    took, errors = interrupt(program, "begun", dict(os.environ))
    assert "KeyboardInterrupt" in errors
    assert took < 3.0  # One second, plus the time to end Python on a busy machine.


def test_waiting_for_a_video(tmp_path):
    # A replacement of ffmpeg that never responds.
    for name in ("ffmpeg", "ffprobe"):
        (tmp_path / name).write_text("#!/bin/sh\nexec sleep 20\n")
        (tmp_path / name).chmod(0o755)
    video = tmp_path / "slow.mp4"
    video.write_bytes(b"no video")
    program = f"""
        from opendr import _opendr
        print("begun", flush=True)
        for frame in _opendr.Source([{str(video)!r}]):
            pass
    """
    path = os.pathsep.join([str(tmp_path), os.environ["PATH"]])
    took, errors = interrupt(program, "begun", {**os.environ, "PATH": path})
    assert "KeyboardInterrupt" in errors, errors
    assert took < 3.0


def test_download(tmp_path):
    # A server that responds slowly.
    server = socket.create_server(("127.0.0.1", 0))
    address = f"http://127.0.0.1:{server.getsockname()[1]}"
    program = """
        import opendr
        print("begun", flush=True)
        opendr.learners()["nanodet"]().download(verbose=False)
    """
    env = {**os.environ, "OPENDR_MODEL_REPOSITORY": address, "OPENDR_CACHE": str(tmp_path / "cache")}
    with server:
        took, errors = interrupt(program, "begun", env)
    assert "KeyboardInterrupt" in errors, errors
    assert took < 3.0


if sys.platform == "win32":
    pytest.skip("POSIX signals", allow_module_level=True)
