"""Fixtures of the tests of C programs: the installed library, a compiler, models."""

import importlib.util
import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
STRICT = ["-Wall", "-Wextra", "-Werror", "-pedantic"]

# The same folders and the same command as for the tests of the command line.
spec = importlib.util.spec_from_file_location("outside", ROOT / "tests/python/conftest.py")
outside = importlib.util.module_from_spec(spec)
spec.loader.exec_module(outside)
shared, cache, opendr = outside.shared, outside.cache, outside.opendr


@pytest.fixture(scope="session")
def prefix():
    """Where `cargo xtask install-c` put the library."""
    named = os.environ.get("OPENDR_C_PREFIX")
    if named is None:
        pytest.skip("skipped: no OPENDR_C_PREFIX; run cargo xtask test")
    return Path(named)


class Compiler:
    """Builds programs through pkg-config, and runs them."""

    def __init__(self, prefix, folder, environment):
        self.prefix, self.folder = prefix, folder
        self.environment = {**environment, "LD_LIBRARY_PATH": str(prefix / "lib")}

    def pkg_config(self, *arguments, package="opendr"):
        path = {"PKG_CONFIG_PATH": str(self.prefix / "lib/pkgconfig")}
        command = ["pkg-config", *arguments, package]
        return subprocess.run(command, env={**os.environ, **path}, capture_output=True, text=True, check=True).stdout.split()

    def build(self, source, *flags, package="opendr", language=None):
        """The program of a source, as `language`, else as its extension says."""
        source = Path(source)
        language = language or {".c": "c11"}.get(source.suffix, "c++17")
        program = self.folder / f"{source.name}.{language}.out"
        compiler = ["gcc", "-x", "c"] if language == "c11" else ["g++", "-x", "c++"]
        subprocess.run(
            [*compiler, f"-std={language}", *STRICT, "-g", "-O1", *self.pkg_config("--cflags", package=package), source,
             "-x", "none", "-o", program, *flags, *self.pkg_config("--libs", package=package), "-lpthread"],
            check=True,
        )
        return program

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def run(self, program, *arguments, code=0, valgrind=False, **environment):
        command = [str(program), *map(str, arguments)]
        if valgrind:
            command = ["valgrind", "--quiet", "--leak-check=full", "--show-leak-kinds=definite",
                       "--errors-for-leak-kinds=definite", "--error-exitcode=99", *command]
        done = subprocess.run(command, env={**self.environment, **environment}, capture_output=True, timeout=600)
        assert done.returncode == code, (done.stdout + done.stderr).decode(errors="replace")
        return done


@pytest.fixture(scope="session")
def compiler(prefix, opendr, tmp_path_factory):
    return Compiler(prefix, tmp_path_factory.mktemp("programs"), opendr.environment)


@pytest.fixture(scope="session")
def pictures(shared, tmp_path_factory):
    """A folder with two photographs and a file that is not an image."""
    folder = tmp_path_factory.mktemp("pictures")
    for name in ["bus.jpg", "zidane.jpg"]:
        shutil.copy(shared / "data/photos" / name, folder)
    (folder / "broken.png").write_bytes(b"no picture")
    return folder
