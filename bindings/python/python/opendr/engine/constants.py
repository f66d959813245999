"""Constants."""

from __future__ import annotations

import os

#: The server or folder that models come from before all others; empty where there is none of one's own.
OPENDR_SERVER_URL: str = os.environ.get("OPENDR_MODEL_REPOSITORY", "")
