"""Builds the packages of messages that ROS 2's wheels lack into the environment of the interpreter that runs this.

The definitions are crates/messages/msg, the generators the wheels' own, so that rclpy speaks with OpenDR's nodes and
both can be compared. Nothing is done when neither has changed.
"""

import hashlib
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy

HERE = Path(__file__).resolve().parent
DEFINITIONS = HERE.parents[2] / "crates/messages/msg"
PREFIX = Path(sys.prefix)
STAMP = PREFIX / "messages.installed"
# In the order of their needs.
PACKAGES = ["vision_msgs", "audio_common_msgs", "tf2_msgs", "opendr_msgs"]
# Where the wheels were built; their CMake files still look for Python and numpy there.
BUILT_WITH = "/opt/python/cp311-cp311/"

PACKAGE_XML = """<package format="3">
  <name>{name}</name>
  <version>0.0.0</version>
  <description>For tests</description>
  <maintainer email="nobody@example.org">Nobody</maintainer>
  <license>Apache-2.0</license>
  {depends}
  <member_of_group>rosidl_interface_packages</member_of_group>
</package>
"""


def fingerprint():
    """The digest of all that the result depends on."""
    files = [HERE / "CMakeLists.txt", Path(__file__)]
    for package in PACKAGES:
        files += sorted((DEFINITIONS / package).rglob("*.*"))
    digest = hashlib.sha256()
    for file in files:
        digest.update(f"{file.name}\n".encode())
        digest.update(file.read_bytes())
    return digest.hexdigest()


def right_paths():
    """Has the wheels' CMake files find this Python and this numpy."""
    headers = sysconfig.get_path("include")
    if not Path(headers, "Python.h").is_file():
        sys.exit(f"{headers} has no Python.h: install the headers of {sys.executable}")
    right = {
        BUILT_WITH + "include/python3.11": headers,
        BUILT_WITH + "lib/python3.11/site-packages/numpy/_core/include": numpy.get_include(),
    }
    for file in (PREFIX / "share").rglob("*Export.cmake"):
        text = file.read_text()
        if BUILT_WITH in text:
            for wrong, place in right.items():
                text = text.replace(wrong, place)
            file.write_text(text)


def uses(package, files):
    """The other packages whose messages a package's fields are of."""
    found = set()
    for file in files:
        found.update(re.findall(r"^(\w+)/\w+", file.read_text(), re.MULTILINE))
    return sorted(found - {package})


def build(package, folder):
    shutil.copytree(DEFINITIONS / package, folder)
    shutil.copy(HERE / "CMakeLists.txt", folder)
    files = sorted([*folder.glob("msg/*.msg"), *folder.glob("srv/*.srv")])
    needs = uses(package, files)
    depends = "\n  ".join(f"<depend>{need}</depend>" for need in needs)
    (folder / "package.xml").write_text(PACKAGE_XML.format(name=package, depends=depends))
    interfaces = ";".join(str(file.relative_to(folder)) for file in files)
    environment = {
        **os.environ,
        "PATH": f"{PREFIX / 'bin'}{os.pathsep}{os.environ['PATH']}",
        "AMENT_PREFIX_PATH": str(PREFIX),
        "CMAKE_PREFIX_PATH": str(PREFIX),
    }
    configure = ["cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja", f"-DPACKAGE={package}"]
    configure += [f"-DINTERFACES={interfaces}", f"-DUSES={';'.join(needs)}", f"-DCMAKE_INSTALL_PREFIX={PREFIX}"]
    configure += ["-DBUILD_TESTING=OFF", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0"]
    configure += ["-DCMAKE_C_FLAGS_DEBUG=-O0", f"-DPython3_EXECUTABLE={sys.executable}"]
    for command in [configure, ["ninja", "-C", folder / "build", "--quiet", "install"]]:
        done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            sys.exit(f"{package}: {' '.join(map(str, command))} failed:\n{done.stdout}")
    print(f"built {package}: {len(files)} definitions", flush=True)


def main():
    wanted = fingerprint()
    if STAMP.is_file() and STAMP.read_text() == wanted:
        return
    STAMP.unlink(missing_ok=True)
    right_paths()
    folder = PREFIX / "messages"
    shutil.rmtree(folder, ignore_errors=True)
    for package in PACKAGES:
        # Files of a removed definition.
        for old in [PREFIX / "share" / package, Path(sysconfig.get_path("purelib")) / package]:
            shutil.rmtree(old, ignore_errors=True)
        build(package, folder / package)
    shutil.rmtree(folder)
    STAMP.write_text(wanted)


if __name__ == "__main__":
    main()
