"""Follows a page of docs/tutorials word for word: writes its files, runs its commands in order, and compares what they print.

What a page's blocks of code mean:

* A block with `title="NAME"` is the file NAME.
* In a block of `console`, a line that begins with `$ ` is a command, and the lines below it are its output. `...` stands for any text
  within a line, and alone on a line for any lines. A command without output below it may print anything. Every command must succeed.
* `console background` runs the command while the following ones run, from when the output below it has been printed.
* `no_run` leaves a block out: what installs programs.
* Any other block (an excerpt, the output of something) is not run.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import threading
from dataclasses import dataclass, field
from pathlib import Path

from patience import PATIENCE, wait_until
from programs import ROOT

FOLDER = ROOT / "docs/tutorials"
FENCE = re.compile(r"^```(.*?)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
#: Seconds that a command may take.
LIMIT = 600


@dataclass
class Block:
    """A block of code of a page."""

    language: str
    words: list[str]
    title: str | None
    text: str
    #: Line of the page with its first line.
    line: int


@dataclass
class Command:
    """A command of a block, and the lines that it prints."""

    text: str
    line: int
    output: list[str] = field(default_factory=list)


def blocks(page):
    """Returns the blocks of a page."""
    found = []
    for match in FENCE.finditer(page):
        info, text = match.groups()
        title = re.search(r'title="(.*?)"', info)
        language, *words = re.split(r"[ ,]+", re.sub(r'title=".*?"', "", info).strip())
        line = page.count("\n", 0, match.start(2)) + 1
        found.append(Block(language, words, title and title[1], text, line))
    return found


def commands(block):
    """Returns the commands of a block of console."""
    found = []
    for number, line in enumerate(block.text.splitlines(), block.line):
        if line.startswith("$ "):
            found.append(Command(line[2:], number))
        elif found and found[-1].text.endswith("\\"):
            found[-1].text = f"{found[-1].text[:-1]}{line.strip()}"
        elif found:
            found[-1].output.append(line)
        else:
            raise ValueError(f"line {number}: a block of console begins with a command: {line!r}")
    return found


def matches(printed, wanted):
    """Returns whether a text is what the lines of a page state."""
    pattern = ""
    for line in wanted:
        if line.strip() == "...":
            pattern += r"(?:.*\n)*?"
        else:
            pattern += ".*?".join(map(re.escape, line.rstrip().split("..."))) + r"[ ]*\n"
    text = "".join(f"{line}\n" for line in printed.splitlines())
    return re.fullmatch(pattern, text) is not None


class Reader:
    """Follows a page in a folder. `programs` are the paths of commands by the names under which the page starts them."""

    def __init__(self, page, folder, environment, programs):
        self.page, self.folder = page, Path(folder)
        tools = self.folder.parent / f"{self.folder.name}-bin"
        tools.mkdir()
        for name, program in programs.items():
            # A symbolic link would hide the environment of a Python interpreter from it.
            (tools / name).write_text(f'#!/bin/sh\nexec "{program}" "$@"\n')
            (tools / name).chmod(0o755)
        self.environment = {**environment, "PATH": f"{tools}{os.pathsep}{environment['PATH']}"}
        self.running = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.running:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGINT)
        for process in self.running:
            try:
                process.wait(15)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()

    def follow(self):
        """Follows the page from the first block to the last."""
        for block in blocks((FOLDER / self.page).read_text("utf-8")):
            if "no_run" in block.words:
                continue
            if block.title:
                path = self.folder / block.title
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(block.text, "utf-8")
            elif block.language == "console":
                for command in commands(block):
                    (self.start if "background" in block.words else self.run)(command)

    def run(self, command):
        done = subprocess.run(
            ["bash", "-c", command.text], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT,
        )
        place = f"{self.page}:{command.line}: {command.text}\n"
        assert done.returncode == 0, f"{place}exit code {done.returncode}\n{done.stdout}"
        if command.output:
            wanted = "\n".join(command.output)
            assert matches(done.stdout, command.output), f"{place}printed\n{done.stdout}\ninstead of\n{wanted}"

    def start(self, command):
        process = subprocess.Popen(
            ["bash", "-c", f"exec {command.text}"], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
        )
        self.running.append(process)
        printed = []
        threading.Thread(target=lambda: printed.extend(process.stdout), daemon=True).start()

        def is_ready():
            text = "".join(printed)
            assert process.poll() is None, f"{self.page}:{command.line}: {command.text} ended:\n{text}"
            return matches(text, [*command.output, "..."])

        wait_until(is_ready, 2 * PATIENCE, f"{self.page}:{command.line}: {command.output}")
