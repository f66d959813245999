"""The command: ``python -m opendr``, or the script ``opendr`` of the wheel."""

from __future__ import annotations

import sys

from opendr import _opendr


def main() -> int:
    """Runs the command with the arguments of the process and returns its exit code.

    Learners of installed packages (entry points of the group ``opendr.learners``) are available.
    """
    from opendr._registered import register_installed

    register_installed()
    return _opendr.main(["opendr", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
