"""Models that OpenDR trained itself. `opendr` finds them by itself; `FOLDER` is where they lie."""

from pathlib import Path

FOLDER = Path(__file__).parent / "weights"
