"""Base classes of learners.

A learner of your own is a subclass of :class:`Learner` whose annotated attributes are its parameters::

    class BrightSpots(Learner):
        \"""Detects spots that are brighter than their surroundings.\"""

        name = "bright_spots"
        task = "object_detection_2d"
        threshold: Annotated[float, Range(0.0, 1.0), "Spots below this score are dropped."] = 0.5

        def infer(self, image: Image) -> BoundingBoxList:
            ...

Parameters are keyword arguments of the constructor and attributes that check assigned values. Their types are
``float``, ``int``, ``bool``, ``str``, ``Literal["a", "b"]``, ``list[...]`` or ``Optional`` of these; ``Range``, ``Unit``,
``Live`` and a description follow the type. A learner whose predictions have class indices lists their names in
``classes``. A class in the entry-point group ``opendr.learners`` is listed with OpenDR's own learners.
"""

from __future__ import annotations

import copy
import inspect
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Annotated, Any, Callable, ClassVar, NoReturn, Optional

from opendr._errors import Unsupported
from opendr.engine._parameters import Live, Parameter, Range, Unit, declare, parameters, signature
from opendr.engine._ports import Init
from opendr.engine.datasets import Dataset

__all__ = ["BaseLearner", "Init", "Learner", "LearnerActive", "LearnerRL", "Live", "Range", "Unit"]


class BaseLearner(ABC):
    """Base class of all learners, with OpenDR's arguments and methods.

    Only ``infer`` must be implemented; other methods raise ``opendr.Unsupported`` unless a learner implements them.

    Raises:
        TypeError: An argument is of another type, or unknown.
        ValueError: An argument is out of range.
    """

    lr: Annotated[float, "Learning rate."] = 0.001
    iters: Annotated[int, "Iterations (for most learners: epochs) of training."] = 10
    batch_size: Annotated[int, "Samples per training step."] = 64
    optimizer: Annotated[str, "Optimizer: 'sgd', 'adam', ..."] = "sgd"
    lr_schedule: Annotated[str, "Learning rate schedule; empty: constant."] = ""
    backbone: Annotated[str, "Backbone of the network."] = "default"
    network_head: Annotated[str, "Head of the network."] = ""
    checkpoint_after_iter: Annotated[int, "Iterations between checkpoints; 0: no checkpoints."] = 0
    checkpoint_load_iter: Annotated[int, "Iteration of the checkpoint to resume from; 0: none."] = 0
    temp_path: Annotated[str, "Folder for checkpoints."] = ""
    device: Annotated[str, "Device: 'cpu', 'cuda', 'cuda:0', ...; 'auto' selects the best."] = "auto"
    threshold: Annotated[float, "Score below which predictions are dropped; 0: the learner's own threshold."] = 0.0
    scale: Annotated[float, "Scale factor of the input: below 1 is faster, above 1 finer."] = 1.0

    __signature__: ClassVar[inspect.Signature]

    if TYPE_CHECKING:

        def __init__(
            self,
            lr: float = 0.001,
            iters: int = 10,
            batch_size: int = 64,
            optimizer: str = "sgd",
            lr_schedule: str = "",
            backbone: str = "default",
            network_head: str = "",
            checkpoint_after_iter: int = 0,
            checkpoint_load_iter: int = 0,
            temp_path: str = "",
            device: str = "auto",
            threshold: float = 0.0,
            scale: float = 1.0,
            **params: Any,
        ) -> None: ...

    else:

        def __init__(self, *args: Any, **kwargs: Any) -> None:
            known = parameters(type(self))
            names = [name for name in known if isinstance(vars(BaseLearner).get(name), Parameter)]
            if len(args) > len(names):
                raise TypeError(f"{type(self).__name__} takes {len(names)} positional arguments, not {len(args)}")
            for name, value in zip(names, args):
                if name in kwargs:
                    raise TypeError(f"{type(self).__name__} got {name} twice; give it once")
                kwargs[name] = value
            for name, value in kwargs.items():
                if name not in known:
                    raise TypeError(f"{type(self).__name__} has no argument {name!r}; its arguments are {', '.join(known)}")
                setattr(self, name, value)
            self._model: Any = None

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        _declare(cls)

    @property
    def model(self) -> Any:
        """The model; None until one is loaded or trained."""
        return self._model

    @model.setter
    def model(self, model: Any) -> None:
        self._model = model

    @abstractmethod
    def infer(self, *args: Any, **kwargs: Any) -> Any:
        """Returns the prediction for one input; the arguments of this method are the learner's inputs."""

    def save(self, path: str) -> bool:
        """Writes the model into the folder ``path``.

        Raises:
            opendr.Unsupported: The learner does not support it.
        """
        self._cannot("save")

    def load(self, path: str) -> bool:
        """Reads a model from the folder ``path``.

        Raises:
            opendr.Unsupported: The learner does not support it.
        """
        self._cannot("load")

    def optimize(self, target_device: str) -> Any:
        """Makes the model faster on ``target_device``.

        Raises:
            opendr.Unsupported: The learner does not support it.
        """
        self._cannot("optimize")

    def reset(self) -> None:
        """Resets the state; does nothing for a learner without one."""

    def stream(self) -> Any:
        """Returns an object with its own state over the same model, for another camera or thread: a shallow copy, reset.

        A learner that changes its state in place (such as a list that grows) must implement this method.
        """
        other = copy.copy(self)
        other.reset()
        return other

    @staticmethod
    def get_hyperparameters() -> Optional[list[dict[str, Any]]]:
        """Returns the search space of the tuner; None if the learner defines none."""
        return None

    @staticmethod
    def get_objective_function() -> Optional[Callable[..., Any]]:
        """Returns the objective function of the tuner; None if the learner defines none."""
        return None

    def _cannot(self, what: str) -> NoReturn:
        raise Unsupported(f"{type(self).__name__} does not support {what}; use a learner that does")


def _declare(cls: Any) -> None:
    declare(cls)
    if cls.__init__ is BaseLearner.__init__:
        cls.__signature__ = signature(cls, positional=vars(BaseLearner))
    else:
        own = inspect.signature(cls.__init__)
        cls.__signature__ = own.replace(parameters=list(own.parameters.values())[1:])


# `__init_subclass__` is not called for the base class itself.
_declare(BaseLearner)


class Learner(BaseLearner):
    """A learner that trains on data sets: perception."""

    def fit(
        self,
        dataset: Dataset,
        val_dataset: Optional[Dataset] = None,
        logging_path: str = "",
        silent: bool = True,
        verbose: bool = True,
    ) -> dict[str, Any]:
        """Trains the learner.

        Args:
            dataset: Data set for training.
            val_dataset: Data set for evaluation.
            logging_path: Folder for TensorBoard's event files; empty: none.
            silent: Whether to print nothing.
            verbose: Whether to print all details.

        Returns:
            Statistics of the training.

        Raises:
            opendr.Unsupported: The learner does not support it.
        """
        self._cannot("fit")

    def eval(self, dataset: Dataset) -> dict[str, Any]:
        """Evaluates on ``dataset``, a ``DatasetIterator`` of pairs of datum and target, with the metric of the learner's
        task.

        Returns:
            The scalars by name, and under ``"report"`` the whole report.

        Raises:
            opendr.Unsupported: The learner has no task, or its task no metric.
        """
        from opendr import _opendr
        from opendr.engine._ports import ports_of
        from opendr.metrics import evaluate_function

        task = getattr(self, "task", None)
        if task is None:
            self._cannot("eval")
        ports = ports_of(type(self).infer, [])
        return evaluate_function(
            self.infer,
            dataset,
            {"metric": _opendr.metric_of(task)},
            reset=self.reset,
            types=[port["type"] for port in ports],
            classes=getattr(self, "classes", ()),
            name=getattr(self, "name", type(self).__name__),
        )


class LearnerRL(BaseLearner):
    """A learner that trains in environments: control and planning."""

    def fit(
        self,
        env: Any,
        val_env: Any = None,
        logging_path: str = "",
        silent: bool = True,
        verbose: bool = True,
    ) -> dict[str, Any]:
        """Trains in ``env`` and evaluates in ``val_env``; the other arguments are those of :meth:`Learner.fit`.

        Raises:
            opendr.Unsupported: The learner does not support it.
        """
        self._cannot("fit")

    def eval(self, env: Any) -> dict[str, Any]:
        """Evaluates in ``env``.

        Raises:
            opendr.Unsupported: The learner does not support it.
        """
        self._cannot("eval")


class LearnerActive(BaseLearner):
    """A learner that trains on data sets and in environments: active perception."""

    def fit(
        self,
        dataset: Dataset,
        env: Any,
        val_dataset: Optional[Dataset] = None,
        val_env: Any = None,
        logging_path: str = "",
        silent: bool = True,
        verbose: bool = True,
    ) -> dict[str, Any]:
        """Trains on ``dataset`` and in ``env``; the other arguments are those of :meth:`Learner.fit`.

        Raises:
            opendr.Unsupported: The learner does not support it.
        """
        self._cannot("fit")

    def eval(self, dataset: Dataset, env: Any) -> dict[str, Any]:
        """Evaluates on ``dataset`` and in ``env``.

        Raises:
            opendr.Unsupported: The learner does not support it.
        """
        self._cannot("eval")
