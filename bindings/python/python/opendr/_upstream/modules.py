"""Modules and names of OpenDR, created from the table."""

from __future__ import annotations

import functools
import types
from collections.abc import Mapping
from importlib import import_module
from importlib.machinery import ModuleSpec
from typing import Any, Optional

from opendr._upstream.absent import absent
from opendr._upstream.rows import HERE, Absent, Home, Learner, Runs

#: OpenDR's packages and further modules in the table.
TASKS = (
    "control.mobile_manipulation",
    "control.multi_object_search",
    "control.single_demo_grasp",
    "engine",
    "perception.active_perception",
    "perception.activity_recognition",
    "perception.binary_high_resolution",
    "perception.compressive_learning",
    "perception.continual_slam",
    "perception.face_recognition",
    "perception.facial_expression_recognition",
    "perception.fall_detection",
    "perception.gesture_recognition",
    "perception.heart_anomaly_detection",
    "perception.multimodal_human_centric",
    "perception.object_detection_2d",
    "perception.object_detection_3d",
    "perception.object_tracking_2d",
    "perception.object_tracking_3d",
    "perception.panoptic_segmentation",
    "perception.pose_estimation",
    "perception.semantic_segmentation",
    "perception.skeleton_based_action_recognition",
    "perception.speech_recognition",
    "perception.speech_transcription",
    "planning.end_to_end_planning",
    "simulation.human_model_generation",
    "utils.ambiguity_measure",
    "utils.hyperparameter_tuner",
    "utils.io",
)


def rows(task: str) -> types.ModuleType:
    """Returns the module of the table for a package, e.g. ``"perception.pose_estimation"``."""
    return import_module(f"opendr._upstream.tasks.{task.rpartition('.')[2]}")


def learner(task: str, name: str) -> Optional[Learner]:
    """Returns the row of a learner, or None."""
    # Policies and grasps of OpenDR's control are among our own packages.
    among = [task] if task in TASKS else [other for other in TASKS if other.startswith("control.")]
    found = (getattr(rows(other), "LEARNERS", {}).get(name) for other in among)
    return next((row for row in found if row is not None), None)


@functools.lru_cache(maxsize=None)
def paths(task: str) -> Mapping[str, Mapping[str, Home]]:
    """Returns the module paths of a package, including the package itself, with the names of each and their homes. The
    classes of a module are also in the packages above it."""
    found: dict[str, dict[str, Home]] = {}
    for path, names in rows(task).MODULES.items():
        parts = [f"opendr.{task}", *filter(None, path.split("."))]
        # The engine has a class of that name.
        classes = {name: home for name, home in names.items() if name[0].isupper() and name != "Dataset"}
        for count in range(1, len(parts)):
            found.setdefault(".".join(parts[:count]), {}).update(classes)
        found.setdefault(".".join(parts), {}).update(names)
    return found


def names_of(module: str) -> Mapping[str, Home]:
    """Returns OpenDR's names in a module; empty for modules that OpenDR does not have."""
    task = _task(module)
    return {} if task is None else paths(task).get(module, {})


def _task(module: str) -> Optional[str]:
    """Returns the package of a module path, or None."""
    inner = module.partition(".")[2]
    return next((task for task in TASKS if inner == task or inner.startswith(f"{task}.")), None)


def spec_of(module: str) -> Optional[ModuleSpec]:
    """Returns the spec of a module of the table without a file, or None."""
    task = _task(module)
    if task is None or module not in paths(task):
        return None
    loader: Any = _Loader()
    return ModuleSpec(module, loader, origin="opendr._upstream", is_package=True)


class _Loader:
    def create_module(self, spec: ModuleSpec) -> None:
        return None

    def exec_module(self, module: types.ModuleType) -> None:
        module.__doc__ = f"OpenDR's {module.__name__[len('opendr.') :]}."
        add_names(module)


def add_names(module: types.ModuleType) -> None:
    """Adds OpenDR's names to a module, each created on first access; existing names are kept."""
    names = names_of(module.__name__)

    def __getattr__(name: str) -> Any:
        if name not in names:
            raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
        value = module.__dict__[name] = _value(module.__name__, name, names[name])
        return value

    own = module.__dict__.get("__all__", [])
    module.__dict__.update(__getattr__=__getattr__, __all__=sorted({*own, *names}))


def _value(module: str, name: str, home: Home) -> Any:
    if isinstance(home, Absent):
        return absent(name, module, f"{name} is not available yet; {home.use}")
    if isinstance(home, Runs):
        return _runner(module, name, home)
    if home != HERE:
        return getattr(import_module(home), name)
    found = vars(import_module(f"opendr.{_task(module)}")).get(name)
    return found or _not_built(name, module)


def _runner(module: str, name: str, home: Runs) -> Any:
    """Returns the class of a learner of OpenDR whose networks another one runs; the same in all module paths of the package."""
    from opendr._native_class import native_class

    home_task = _task(module) or ""
    package = import_module(f"opendr.{home_task}")
    if module != package.__name__:
        return getattr(package, name)
    path, _, of = home.by.partition(":")
    base = getattr(import_module(path), of, None)
    if base is None:
        return _not_built(name, module)
    # The row is that of the package in which OpenDR has the class.
    of_package, _, task = home_task.rpartition(".")
    return native_class({**base._entry, "class_name": name, "package": of_package, "task": task}, module)


def _not_built(name: str, module: str) -> Any:
    return absent(name, module, f"{name} is not in this build of opendr; install a build with all learners")
