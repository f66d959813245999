"""The headers in both languages, as strict as compilers get."""

import subprocess

import pytest

from conftest import STRICT

EVERYTHING = """
#include <opendr.h>
#include <opendr_compat.h>
int main(void) { return opendr_last_error()[0] != 0; }
"""


@pytest.mark.parametrize("name", ["headers.c", "headers.cpp"])
def test_headers_compile(compiler, name):
    compiler.run(compiler.build(compiler.write(name, EVERYTHING)))


def test_static_library(compiler):
    source = compiler.write("static.c", EVERYTHING)
    program = compiler.folder / "static.out"
    libs = [flag for flag in compiler.pkg_config("--libs", "--static") if flag != "-lopendr"]
    archive = compiler.prefix / "lib/libopendr.a"
    subprocess.run(["gcc", "-std=c11", *STRICT, *compiler.pkg_config("--cflags"), source, archive, *libs, "-o", program], check=True)
    needed = subprocess.run(["readelf", "-d", program], capture_output=True, text=True, check=True).stdout
    assert "libopendr" not in needed
    compiler.run(program)


def test_shared_library_says_its_name(prefix):
    dynamic = subprocess.run(["readelf", "-d", prefix / "lib/libopendr.so"], capture_output=True, text=True, check=True)
    assert "[libopendr.so.0]" in dynamic.stdout


def test_only_opendr_is_exported(prefix):
    symbols = subprocess.run(["nm", "-D", "--defined-only", prefix / "lib/libopendr.so"], capture_output=True, text=True, check=True)
    names = [line.split()[-1] for line in symbols.stdout.splitlines()]
    assert len(names) > 50 and all(name.startswith("opendr_") for name in names)
