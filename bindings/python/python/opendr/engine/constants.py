"""Constants."""

from __future__ import annotations

import os

#: The server or folder that is searched for models first; empty by default.
OPENDR_SERVER_URL: str = os.environ.get("OPENDR_MODEL_REPOSITORY", "")
