"""Active perception: a camera moves to where a recogniser is certain (docs/active_perception.md).

    from opendr.active import Active

    active = Active(learner, camera_policy="runs/object/model")
    outcome = active.run("SphereView-Object-v1", seed=7)        # or "views.json", "hall.jpg", a rig of your own
    print(outcome.category, outcome.reason)
    for view in outcome.views:
        print(view.pose, view.category.confidence, view.category.action)

A rig of your own is an object with ``axes``, ``move`` and ``capture`` (:class:`Rig`).
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Optional, Protocol, Union

from opendr import _opendr
from opendr._input_value import PathLike
from opendr._native_base import NativeBase
from opendr._native_learner_active import NativeLearnerActive
from opendr.engine.data import Image
from opendr.engine.learners import BaseLearner
from opendr.engine.target import Action, Category

__all__ = ["Active", "Axis", "Outcome", "Pose", "Rig", "View"]


class Axis(NamedTuple):
    """An axis of a rig.

    Attributes:
        name: ``"azimuth"``, ``"elevation"``, ``"distance"``, ``"roll"`` or ``"zoom"``.
        step: What a deflection of 1 adds, in rad or in the unit of distance; negative where positive means less, as in a distance
            whose positive direction is closer.
        low: Smallest position.
        high: Largest position.
        wraps: Whether the axis goes round: ``high`` is ``low`` again and nothing stops it.
    """

    name: str
    step: float
    low: float
    high: float
    wraps: bool = False


class Pose(NamedTuple):
    """A place on a sphere around the subject, from which the camera looks at it.

    Attributes:
        azimuth: Angle about the vertical axis, counter-clockwise, in rad.
        elevation: Angle above the horizontal plane, in rad.
        distance: Distance from the subject, in the unit of the rig.
        fourth: Roll in rad, or magnification, whichever the fourth axis of the rig is.
    """

    azimuth: float
    elevation: float
    distance: float
    fourth: float = 0.0


class Rig(Protocol):
    """What a camera of your own has to offer: a gimbal, a drone, an arm.

    If it also has an attribute ``pose`` (a :class:`Pose`), that is read before the first image and after each motion. Without it the
    camera is assumed to begin at azimuth 0, elevation 0 and the middle of the distances, and to be where its motions lead.
    """

    @property
    def axes(self) -> Sequence[Axis]:
        """The axes in the order azimuth, elevation, distance, roll or zoom; 1 to 4, as many as the camera policy has."""
        ...

    def move(self, action: list[float]) -> Optional[Sequence[float]]:
        """Moves by a deflection of each axis, in [-1, 1], as far as its limits allow.

        Returns:
            None where nothing else stopped the motion; otherwise the deflections that were carried out.
        """
        ...

    def capture(self) -> Any:
        """Returns an image: an ``Image``, an array (layout guessed by the rule of ``Image``) or the path of a file."""
        ...


@dataclass(frozen=True)
class View:
    """A view of a run.

    Attributes:
        image: The image.
        pose: Where it was captured.
        category: The most likely class after it, with its probability; its ``action`` is the motion after the view, None after the
            last one.
        expected_gain: By how much the motion was expected to raise the probability of the true class; None after the last view.
        limits: For each axis of the motion what stopped it: ``"low"``, ``"high"``, ``"blocked"`` or None.
    """

    image: Image
    pose: Pose
    category: Category
    expected_gain: Optional[float]
    limits: tuple[Optional[str], ...]


@dataclass(frozen=True)
class Outcome:
    """A run from the first view to the stop.

    Attributes:
        views: The views, in their order.
        category: The most likely class, with the ``probabilities`` of all classes.
        reason: Why the run stopped: ``"confident"``, ``"budget"`` or ``"no_gain"``.
    """

    views: list[View]
    category: Category
    reason: str


class Active:
    """Makes a recogniser active: it moves the camera of a rig to where the recogniser is expected to be certain.

    Args:
        learner: A loaded learner of images with classes; a learner of active perception, which has a camera policy of its own; a
            learner written in Python; or a function from an ``Image`` to a target with classes or to the probabilities of all
            classes.
        camera_policy: A model of active perception whose camera policy moves the rig: a path, or a loaded learner.
        classes: Names of the classes, for a function.

    Raises:
        FileNotFoundError: No model is loaded, or there is none at the path.
        TypeError: The learner is neither a learner nor a function.
        ValueError: The camera policy is missing, or given to a learner that has one.
        opendr.Unsupported: The learner does not classify single images.
    """

    def __init__(
        self,
        learner: Union[BaseLearner, Callable[[Image], Any]],
        camera_policy: Union[None, PathLike, NativeLearnerActive] = None,
        *,
        classes: Optional[Sequence[str]] = None,
    ) -> None:
        policy: Any = None
        if isinstance(camera_policy, NativeLearnerActive):
            policy = camera_policy._handle
        elif camera_policy is not None:
            policy = os.fspath(camera_policy)
        recogniser: Any
        if isinstance(learner, NativeBase):
            if classes is not None:
                raise ValueError(f"{type(learner).__name__} has classes of its own; omit classes")
            recogniser, self._classes = learner._handle, learner.classes
        else:
            function = getattr(learner, "infer", learner)
            if not callable(function):
                raise TypeError(f"learner should be a learner or a function of an image, not {type(learner).__name__}")
            names = getattr(learner, "classes", None) if classes is None else classes
            if not names:
                raise ValueError("the names of the classes are missing; give them as classes")
            self._classes = list(names)
            recogniser = function, len(self._classes)
        self._active = _opendr.Active(recogniser, policy)

    def run(
        self,
        rig: Union[PathLike, Image, Rig],
        *,
        env_params: Optional[dict[str, Any]] = None,
        seed: Optional[int] = None,
        field_of_view: Optional[float] = None,
        out: Optional[PathLike] = None,
    ) -> Outcome:
        """Captures views and moves the rig until the class is certain, no motion is expected to help, or the budget is used.

        Args:
            rig: An environment (``"SphereView-Face-v1"``), the index of recorded views (``"views.json"``), a large image or its
                path, or a :class:`Rig` of your own.
            env_params: Parameters of the environment.
            seed: Seed of the episode in an environment; 0 by default.
            field_of_view: Horizontal field of view of a large image in rad; 1 by default.
            out: File to which the views are written side by side; a video for .gif, .mp4, .mov and .mkv.

        Returns:
            The run.

        Raises:
            FileNotFoundError: There is no such environment or file.
            ValueError: The rig has another number of axes than the camera policy, or an argument belongs to another kind of rig.
            Exception: What the rig raised.
        """
        options = {"env_params": env_params, "seed": seed, "field_of_view": field_of_view}
        given = os.fspath(rig) if isinstance(rig, (str, os.PathLike)) else rig
        images, text = self._active.run(given, options, None if out is None else os.fspath(out))
        run = json.loads(text)
        views = [self._view(image, view) for image, view in zip(images, run["views"])]
        best, probabilities = run["class"], run["probabilities"]
        return Outcome(views, self._category(best, probabilities[best], probabilities), run["reason"])

    def _view(self, image: Image, view: dict[str, Any]) -> View:
        category = self._category(view["class"], view["confidence"])
        action = view["action"]
        if action is not None:
            category.action = Action(action)
        limits = tuple(view["limits"][: len(action or ())])
        return View(image, Pose(**view["pose"]), category, view["expected_gain"], limits)

    def _category(self, index: int, confidence: float, probabilities: Optional[list[float]] = None) -> Category:
        name = self._classes[index] if index < len(self._classes) else None
        return Category(index, name, confidence, probabilities=probabilities)
