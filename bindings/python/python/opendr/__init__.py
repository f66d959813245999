"""OpenDR: the open deep-learning toolkit for robotics.

    import opendr

    detector = opendr.learner("centernet")      # downloaded once, verified by SHA-256
    for box in detector.infer("street.jpg"):
        print(box.class_name, box.left, box.top, box.width, box.height, box.confidence)

Modules and classes are those of OpenDR: ``opendr.engine.data``, ``opendr.engine.target``, ``opendr.engine.learners``,
``opendr.engine.datasets``, ``opendr.perception.<task>``. NumPy is imported when the first array is created.
"""

from __future__ import annotations

import sys

from opendr._upstream import Finder

# True for type checkers. The module `typing` takes ten times as long to import as the rest.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from opendr._errors import (
        DeviceError,
        FormatError,
        IntegrityError,
        InternalError,
        InvalidInput,
        InvalidParam,
        IoError,
        NetworkError,
        NotFound,
        OpenDRError,
        Unsupported,
    )
    from opendr._opendr import __version__
    from opendr._pipeline import Pipeline
    from opendr._registered import check_learner, learner, learners, list_models, register
    from opendr._source import Source

__all__ = [
    "DeviceError",
    "FormatError",
    "IntegrityError",
    "InternalError",
    "InvalidInput",
    "InvalidParam",
    "IoError",
    "NetworkError",
    "NotFound",
    "OpenDRError",
    "Pipeline",
    "Source",
    "Unsupported",
    "__version__",
    "check_learner",
    "learner",
    "learners",
    "list_models",
    "register",
]

# Last, so that modules with files take precedence.
sys.meta_path.append(Finder)

#: The modules of the names, imported on first access, so that `import opendr` alone is fast.
_HOMES = {
    "Pipeline": "opendr._pipeline",
    "Source": "opendr._source",
    "__version__": "opendr._opendr",
    **dict.fromkeys(("check_learner", "learner", "learners", "list_models", "register"), "opendr._registered"),
}


# Type checkers use the imports above and report other names as missing.
if not TYPE_CHECKING:

    def __getattr__(name):
        from importlib import import_module

        if name not in __all__:
            raise AttributeError(f"module 'opendr' has no attribute {name!r}")
        home = import_module(_HOMES.get(name, "opendr._errors"))
        value = globals()[name] = getattr(home, name)
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
