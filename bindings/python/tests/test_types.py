"""Type annotations of the package: type checkers accept a correct program and report every error of a wrong one."""

import json
import re
import subprocess
import sys
from pathlib import Path

import opendr
import pytest

TESTS = Path(__file__).parent
PACKAGE = TESTS.parent
#: mypy's cache, shared by the tests.
CACHE = "mypy-cache"


def lines_of_mypy(*arguments, cwd, cache):
    """Returns the lines with errors of mypy, as `(file name, line)`, and its output."""
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(cache), "--no-error-summary"]
    done = subprocess.run([*command, *map(str, arguments)], cwd=cwd, capture_output=True, text=True)
    # 2 and above: mypy failed to run.
    assert done.returncode in (0, 1), done.stdout + done.stderr
    found = re.findall(r"^([^:\n]+):(\d+): error: ", done.stdout, re.MULTILINE)
    assert bool(found) == (done.returncode == 1), done.stdout
    return {(Path(name).name, int(line)) for name, line in found}, done.stdout


def lines_of_pyright(*arguments, cwd, cache):
    """The same as :func:`lines_of_mypy`, for pyright."""
    command = [sys.executable, "-m", "pyright", "--pythonpath", sys.executable, "--outputjson"]
    done = subprocess.run([*command, *map(str, arguments)], cwd=cwd, capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stdout + done.stderr
    report = json.loads(done.stdout)
    assert report["summary"]["filesAnalyzed"] > 0, done.stdout
    found = {
        (Path(entry["file"]).name, entry["range"]["start"]["line"] + 1)
        for entry in report["generalDiagnostics"]
        if entry["severity"] == "error"
    }
    return found, done.stdout


CHECKERS = pytest.mark.parametrize("check", [lines_of_mypy, lines_of_pyright], ids=["mypy", "pyright"])


@pytest.fixture(scope="session")
def cache(tmp_path_factory):
    return tmp_path_factory.mktemp(CACHE)


@CHECKERS
def test_a_right_program_is_accepted(check, cache, tmp_path):
    found, report = check(TESTS / "user_script.py", cwd=tmp_path, cache=cache)
    assert not found, report


@CHECKERS
def test_every_mistake_is_found(check, cache, tmp_path):
    script = TESTS / "wrong_script.py"
    lines = script.read_text(encoding="utf-8").splitlines()
    wrong = {(script.name, number) for number, line in enumerate(lines, 1) if "# wrong" in line}
    assert len(wrong) >= 15
    found, report = check(script, cwd=tmp_path, cache=cache)
    assert found == wrong, report


def test_mypy_accepts_the_package(cache, tmp_path):
    # mypy does not check installed packages.
    found, report = lines_of_mypy(PACKAGE / "python/opendr", cwd=tmp_path, cache=cache)
    assert not found, report


def test_pyright_accepts_the_package(cache, tmp_path):
    # pyright needs the native module next to its stub.
    found, report = lines_of_pyright(Path(opendr.__file__).parent, cwd=tmp_path, cache=cache)
    assert not found, report


def test_the_right_program_runs(zoo, photo, tmp_path):
    script = TESTS / "user_script.py"
    done = subprocess.run(
        [sys.executable, str(script), str(photo), str(tmp_path)], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert "refused: threshold = 2.0" in done.stdout
    assert "'dark_spot'" in done.stdout


def test_stubs_are_those_of_the_registry():
    done = subprocess.run([sys.executable, str(PACKAGE / "stubs.py"), "--check"], capture_output=True, text=True)
    assert done.returncode == 0, f"run bindings/python/stubs.py\n{done.stdout}{done.stderr}"
