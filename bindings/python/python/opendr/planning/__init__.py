"""Planning: one module per task, created from the registry of learners."""

from __future__ import annotations

import sys

from opendr._registered import task_modules

task_modules(sys.modules[__name__])
