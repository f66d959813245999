"""The Debian packages of `cargo xtask deb`: their files and fields, and their installation into a new system.

OPENDR_DEBS is the folder of the packages; the installation needs root and mmdebstrap.
"""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

PROGRAM = """
#include <opendr.h>
#include <stdio.h>

int main(void)
{
    opendr_learner *learner = NULL;
    puts(opendr_version());
    if (opendr_load("no_such_learner", NULL, "cpu", NULL, &learner) == OPENDR_OK) {
        return 1;
    }
    puts(opendr_last_error());
    return 0;
}
"""


def output(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=1800, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def packages():
    folder = os.environ.get("OPENDR_DEBS")
    if not folder:
        pytest.skip("skipped: no OPENDR_DEBS; run cargo xtask deb and set it to target/deb")
    found = {path.name.split("_")[0]: path.resolve() for path in Path(folder).glob("*.deb")}
    assert sorted(found) == ["libopendr-dev", "libopendr0", "opendr", "opendr-models"]
    return found


@pytest.fixture(scope="module")
def files(packages):
    """Names of the files by package."""
    lines = {name: output("dpkg-deb", "--contents", path).splitlines() for name, path in packages.items()}
    assert all(line.split()[1] == "root/root" for of in lines.values() for line in of)
    return {name: {line.split()[5][2:] for line in of} for name, of in lines.items()}


def field(path, name):
    return output("dpkg-deb", "--field", path, name).strip()


def test_files_are_where_debian_has_them(files):
    triplet = output("dpkg-architecture", "-qDEB_HOST_MULTIARCH").strip()
    assert {"usr/bin/opendr", "usr/share/man/man1/opendr.1.gz", "usr/share/man/man1/opendr-infer.1.gz"} <= files["opendr"]
    library = {name for name in files["libopendr0"] if name.startswith(f"usr/lib/{triplet}/libopendr.so.0")}
    assert len(library) == 2
    development = {
        "usr/include/opendr.h", "usr/include/opendr_compat.h", "usr/include/opendr/data.h",
        *(f"usr/lib/{triplet}/{name}" for name in
          ["libopendr.a", "libopendr.so", "pkgconfig/opendr.pc", "cmake/OpenDR/OpenDRConfig.cmake"]),
    }
    assert development <= files["libopendr-dev"]
    assert any(name.startswith("usr/share/opendr/models/") for name in files["opendr-models"])
    for name, of in files.items():
        assert f"usr/share/doc/{name}/copyright" in of or f"usr/share/doc/{name}" in of, name


def test_dependencies_are_of_the_same_version(packages):
    version = field(packages["opendr"], "Version")
    assert field(packages["libopendr-dev"], "Depends") == f"libopendr0 (= {version})"
    assert field(packages["opendr"], "Recommends") == f"opendr-models (= {version})"
    for name in ["opendr", "libopendr0"]:
        assert "libc6 (>=" in field(packages[name], "Depends")
    assert field(packages["opendr-models"], "Architecture") == "all"


def test_copyright_names_every_linked_crate(packages, tmp_path):
    output("dpkg-deb", "--extract", packages["opendr"], tmp_path)
    text = (tmp_path / "usr/share/doc/opendr/copyright").read_text()
    stanzas = [stanza for stanza in text.split("\n\n") if stanza.strip()]
    fields = [dict(line.split(":", 1) for line in stanza.splitlines() if line[:1] not in (" ", "")) for stanza in stanzas]
    assert fields[0]["Format"].strip() == "https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/"
    of_files = [one for one in fields if "Files" in one]
    assert all("Copyright" in one and "License" in one for one in of_files)
    texts = {one["License"].strip() for one in fields if "License" in one and "Files" not in one}
    for one in of_files:
        for licence in one["License"].strip().split(" and "):
            assert licence in texts | {"public-domain"}, licence
    assert "clap-4" in text and "serde-1" in text


@pytest.fixture(scope="module")
def system(packages, tmp_path_factory):
    """A new Debian system with the packages and a compiler."""
    if not shutil.which("mmdebstrap") or os.geteuid() != 0:
        pytest.skip("skipped: the installation needs mmdebstrap and root")
    folder = tmp_path_factory.mktemp("system")
    suite = output("sh", "-c", ". /etc/os-release && echo $VERSION_CODENAME").strip()
    output("mmdebstrap", "--mode=root", "--variant=minbase", "--quiet",
           "--include=gcc,libc6-dev,pkg-config", suite, folder)
    for path in packages.values():
        shutil.copy(path, folder / "tmp")
    names = [f"/tmp/{path.name}" for path in packages.values()]
    output("chroot", folder, "dpkg", "--install", *names)
    yield folder
    shutil.rmtree(folder, ignore_errors=True)


def test_command_runs_in_a_new_system(system, packages):
    version = field(packages["opendr"], "Version").split("-")[0]
    assert output("chroot", system, "opendr", "--version") == f"opendr {version}\n"
    assert "nanodet" in output("chroot", system, "env", "OPENDR_OFFLINE=1", "opendr", "models")


def test_program_in_c_is_compiled_in_a_new_system(system):
    (system / "tmp/program.c").write_text(PROGRAM)
    compile_line = "cc -Wall -Wextra -Werror /tmp/program.c -o /tmp/program $(pkg-config --cflags --libs opendr) && /tmp/program"
    lines = output("chroot", system, "sh", "-c", compile_line).splitlines()
    assert lines[0].startswith("0.") and "no_such_learner" in lines[1]
    static = "cc /tmp/program.c -o /tmp/static $(pkg-config --cflags opendr) -l:libopendr.a -lm -lpthread -ldl -lgcc_s && /tmp/static"
    assert output("chroot", system, "sh", "-c", static).splitlines()[0] == lines[0]


def test_packages_are_removed_without_remains(system):
    output("chroot", system, "dpkg", "--purge", "libopendr-dev", "libopendr0", "opendr", "opendr-models")
    assert not list(system.glob("usr/**/*opendr*"))
