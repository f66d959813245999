"""The examples: short, built through pkg-config and through CMake, run on a folder, clean under valgrind."""

import subprocess

import pytest

from conftest import ROOT

EXAMPLES = ROOT / "bindings/c/examples"
NAMES = ["detect.c", "detect.cpp", "faces.c", "poses.c"]


def is_found(output):
    """What each example prints for the two photographs."""
    return output.count("bus.jpg") == 1 and output.count("zidane.jpg") == 1


@pytest.mark.parametrize("name", NAMES)
def test_examples_are_short(name):
    assert len((EXAMPLES / name).read_text().splitlines()) <= 40


@pytest.mark.parametrize("name", NAMES)
def test_pkg_config(compiler, pictures, name):
    program = compiler.build(EXAMPLES / name)
    if name.endswith(".cpp"):
        # It stops at the file that is no picture.
        (photo,) = pictures.glob("bus.jpg")
        done = compiler.run(program, photo)
        assert "bus.jpg: 5" in done.stdout.decode()
        assert "broken.png" in compiler.run(program, pictures, code=1).stderr.decode()
        return
    done = compiler.run(program, pictures)
    assert is_found(done.stdout.decode()), done.stdout
    assert "broken.png" in done.stderr.decode()


def test_cmake(compiler, pictures, tmp_path):
    configure = ["cmake", "-S", ROOT / "tests/c/cmake", "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={compiler.prefix}"]
    subprocess.run([*configure, f"-DEXAMPLES={EXAMPLES}"], check=True, capture_output=True)
    subprocess.run(["cmake", "--build", tmp_path], check=True, capture_output=True)
    for name in ["faces", "faces_static"]:
        assert is_found(compiler.run(tmp_path / name, pictures).stdout.decode())


def test_faces_are_drawn(compiler, shared, tmp_path):
    seen, photo = tmp_path / "seen.png", shared / "data/photos/zidane.jpg"
    compiler.run(compiler.build(EXAMPLES / "faces.c"), photo, compiler_model(compiler), seen)
    assert seen.stat().st_size > 100_000


def compiler_model(compiler):
    """The container that the example downloads for itself, named."""
    done = subprocess.run([compiler_binary(), "download", "ultra_light_face"], env=compiler.environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()[-1]


def compiler_binary():
    import os

    return os.environ.get("OPENDR_BIN", str(ROOT / "target/release/opendr"))


@pytest.mark.parametrize("name", ["faces.c"])
def test_valgrind(compiler, pictures, name):
    program = compiler.build(EXAMPLES / name)
    done = compiler.run(program, pictures, valgrind=True, OPENDR_RUNTIME="builtin", OPENDR_THREADS="1")
    assert is_found(done.stdout.decode())
