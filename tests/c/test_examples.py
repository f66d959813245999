"""The examples: short, built through pkg-config and through CMake, run on a folder, clean under valgrind."""

import subprocess

import pytest

from conftest import ROOT

EXAMPLES = ROOT / "bindings/c/examples"
NAMES = ["detect.c", "detect.cpp", "faces.c", "poses.c"]


def is_found(output):
    """What each example prints for the two photographs."""
    return output.count("bus.jpg") == 1 and output.count("zidane.jpg") == 1


@pytest.mark.parametrize("name", [*NAMES, "balance.c"])
def test_examples_are_short(name):
    assert len((EXAMPLES / name).read_text().splitlines()) <= 40


@pytest.mark.parametrize("name", NAMES)
def test_pkg_config(compiler, pictures, name):
    program = compiler.build(EXAMPLES / name)
    if name.endswith(".cpp"):
        # It stops at the file that is not an image.
        done = compiler.run(program, pictures / "bus.jpg")
        assert "bus.jpg: 5" in done.stdout.decode()
        assert "broken.png" in compiler.run(program, pictures, code=1).stderr.decode()
        return
    done = compiler.run(program, pictures)
    assert is_found(done.stdout.decode()), done.stdout
    assert "broken.png" in done.stderr.decode()


def test_a_policy_balances(compiler):
    program = compiler.build(EXAMPLES / "balance.c")
    assert compiler.run(program).stdout == b"return 500\n"


def test_cmake(compiler, pictures, tmp_path):
    configure = ["cmake", "-S", ROOT / "tests/c/cmake", "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={compiler.prefix}"]
    subprocess.run([*configure, f"-DEXAMPLES={EXAMPLES}"], check=True, capture_output=True)
    subprocess.run(["cmake", "--build", tmp_path], check=True, capture_output=True)
    for name in ["faces", "faces_static"]:
        assert is_found(compiler.run(tmp_path / name, pictures).stdout.decode())


def test_faces_are_drawn(compiler, opendr, shared, tmp_path):
    seen, photo = tmp_path / "seen.png", shared / "data/photos/zidane.jpg"
    model = opendr.run("download", "ultra_light_face").stdout.split()[-1]
    compiler.run(compiler.build(EXAMPLES / "faces.c"), photo, model, seen)
    assert seen.stat().st_size > 100_000


@pytest.mark.parametrize(("name", "given", "code"), [
    ("faces.c", ".", 0),
    # Networks are slow under valgrind: one image, and one that cannot be read for the C++ example.
    ("poses.c", "zidane.jpg", 0),
    ("detect.c", "zidane.jpg", 0),
    ("detect.cpp", "broken.png", 1),
])
def test_valgrind(compiler, pictures, name, given, code):
    program = compiler.build(EXAMPLES / name)
    quiet = {"OPENDR_RUNTIME": "builtin", "OPENDR_THREADS": "1"}
    done = compiler.run(program, pictures / given, code=code, valgrind=True, **quiet)
    assert b"zidane.jpg" in done.stdout or b"broken.png" in done.stderr
