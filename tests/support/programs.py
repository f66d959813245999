"""The programs that tests start: built by `cargo xtask test`, or by cargo when a test is run by hand."""

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def example(package, name):
    """Returns the command of an example, to which its arguments are added."""
    folder = os.environ.get("OPENDR_EXAMPLES")
    if folder:
        program = Path(folder) / name
        assert program.is_file(), f"{program} is not built: add it to EXAMPLES in xtask/src/surfaces.rs"
        return [str(program)]
    return ["cargo", "run", "-q", "-p", f"opendr-{package}", "--example", name, "--"]
