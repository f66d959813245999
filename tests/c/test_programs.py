"""Programs in C: the learner with two ports, OpenDR's own names, errors."""

import json
import os
import subprocess

import pytest

from conftest import ROOT

TESTS = ROOT / "bindings/c/tests"


@pytest.fixture
def counter_model(tmp_path):
    """A container of the test learner that begins to count at 1."""
    folder = tmp_path / "counter"
    folder.mkdir()
    (folder / "bias.bin").write_bytes(b"\x01")
    sha256 = "4bf5122f344554c53bde2ebb8cd2b7e3d1600ad631c385a5d7cce23c7785459a"
    manifest = {"format_version": 1, "learner": "counter", "files": [{"name": "bias.bin", "size": 1, "sha256": sha256}]}
    (folder / "model.json").write_text(json.dumps(manifest))
    return folder


@pytest.mark.parametrize("valgrind", [False, True])
def test_learner_with_two_ports(compiler, counter_model, valgrind):
    done = compiler.run(compiler.build(TESTS / "counter.c"), counter_model, valgrind=valgrind)
    assert json.loads(done.stdout)["boxes"][1]["landmarks"] == [[3.0, 4.0]]


def test_program_for_opendr(compiler, shared, tmp_path):
    seen = tmp_path / "seen.png"
    done = compiler.run(compiler.build(TESTS / "nanodet_of_opendr.c"), shared / "data/photos/bus.jpg", seen)
    names = [line.split()[0] for line in done.stdout.decode().splitlines()]
    assert names.count("0") >= 3 and "5" in names, names
    assert seen.stat().st_size > 100_000 and done.stderr == b""


def test_errors_have_the_numbers_of_the_command(compiler, shared):
    runner = compiler.build(TESTS / "runner.c")
    photo = shared / "data/photos/bus.jpg"
    for arguments, code in [
        (["no_such_learner", "{}", f"image={photo}"], 13),
        (["nanodet", '{"threshold": 7}', f"image={photo}"], 12),
        (["nanodet", "[]", f"image={photo}"], 12),
        (["ultra_light_face", "{}", "image=/no/such/file"], 13),
        (["ultra_light_face", "{}", f"picture={photo}"], 11),
    ]:
        done = compiler.run(runner, *arguments, code=code)
        assert done.stderr.strip()


def test_names_that_are_no_utf8(compiler, shared, tmp_path):
    runner = compiler.build(TESTS / "runner.c")
    odd = os.fsencode(tmp_path) + b"/caf\xe9.jpg"
    with open(odd, "wb") as file:
        file.write((shared / "data/photos/zidane.jpg").read_bytes())
    arguments = ["ultra_light_face", "{}"]
    plain = compiler.run(runner, *arguments, f"image={shared / 'data/photos/zidane.jpg'}")
    done = subprocess.run([runner, *arguments, b"image=" + odd], env=compiler.environment, capture_output=True)
    assert (done.returncode, done.stdout) == (0, plain.stdout), done.stderr
