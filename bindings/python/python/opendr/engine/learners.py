"""The classes that all learners come from.

A learner of one's own is a subclass of :class:`Learner` whose annotated attributes are its parameters::

    class BrightSpots(Learner):
        \"""Finds what is brighter than its surroundings.\"""

        name = "bright_spots"
        task = "object_detection_2d"
        threshold: Annotated[float, Range(0.0, 1.0), "Spots below this score are dropped."] = 0.5

        def infer(self, image: Image) -> BoundingBoxList:
            ...

Parameters are keyword arguments of the constructor and attributes that check what is assigned. Their types are
``float``, ``int``, ``bool``, ``str``, ``Literal["a", "b"]``, ``list[...]`` or ``Optional`` of these; ``Range``, ``Unit``,
``Live`` and a text that explains them follow the type. A learner whose answers have class numbers names them in
``classes``. Named in the entry-point group ``opendr.learners``, the class appears beside OpenDR's own learners.
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
    """What all learners have in common: OpenDR's arguments, and what can be done with any of them.

    Only ``infer`` must be written. What a learner does not write besides raises ``opendr.Unsupported``.

    Raises:
        TypeError: An argument is of another type, or unknown.
        ValueError: An argument is out of its range.
    """

    lr: Annotated[float, "Learning rate."] = 0.001
    iters: Annotated[int, "Iterations (for most learners: epochs) of training."] = 10
    batch_size: Annotated[int, "Samples a step of training."] = 64
    optimizer: Annotated[str, "How weights are changed: 'sgd', 'adam', ..."] = "sgd"
    lr_schedule: Annotated[str, "How the learning rate changes; empty: not at all."] = ""
    backbone: Annotated[str, "The network's body."] = "default"
    network_head: Annotated[str, "The network's head."] = ""
    checkpoint_after_iter: Annotated[int, "A checkpoint is written after as many iterations; 0: none."] = 0
    checkpoint_load_iter: Annotated[int, "The iteration whose checkpoint is resumed; 0: none."] = 0
    temp_path: Annotated[str, "Folder of checkpoints."] = ""
    device: Annotated[str, "Where it runs: 'cpu', 'cuda', 'cuda:0', ...; 'auto' takes the best."] = "auto"
    threshold: Annotated[float, "Answers below this score are dropped; 0: the learner's own threshold."] = 0.0
    scale: Annotated[float, "Factor on the size of the input: below 1 is faster, above 1 finer."] = 1.0

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
                raise TypeError(f"{type(self).__name__} takes {len(names)} arguments by place, not {len(args)}")
            for name, value in zip(names, args):
                if name in kwargs:
                    raise TypeError(f"{type(self).__name__} got {name} twice; give it once")
                kwargs[name] = value
            for name, value in kwargs.items():
                if name not in known:
                    raise TypeError(f"{type(self).__name__} has no argument {name!r}; there are {', '.join(known)}")
                setattr(self, name, value)
            self._model: Any = None

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        _declare(cls)

    @property
    def model(self) -> Any:
        """The model; None before one was loaded or trained."""
        return self._model

    @model.setter
    def model(self, model: Any) -> None:
        self._model = model

    @abstractmethod
    def infer(self, *args: Any, **kwargs: Any) -> Any:
        """Answers one input; a learner names its inputs in the parameters of this method."""

    def save(self, path: str) -> bool:
        """Writes the model into the folder ``path``.

        Raises:
            opendr.Unsupported: This learner cannot.
        """
        self._cannot("save")

    def load(self, path: str) -> bool:
        """Reads a model from the folder ``path``.

        Raises:
            opendr.Unsupported: This learner cannot.
        """
        self._cannot("load")

    def optimize(self, target_device: str) -> Any:
        """Makes the model faster on ``target_device``.

        Raises:
            opendr.Unsupported: This learner cannot.
        """
        self._cannot("optimize")

    def reset(self) -> None:
        """Forgets what was seen; a learner without a memory has nothing to forget."""

    def stream(self) -> Any:
        """A memory of its own over the same model, for another camera or thread: a shallow copy, reset.

        A learner whose memory is not replaced but changed in place (a list that grows) writes its own.
        """
        other = copy.copy(self)
        other.reset()
        return other

    @staticmethod
    def get_hyperparameters() -> Optional[list[dict[str, Any]]]:
        """What the tuner may change; None when the learner does not tell."""
        return None

    @staticmethod
    def get_objective_function() -> Optional[Callable[..., Any]]:
        """What the tuner minimises; None when the learner does not tell."""
        return None

    def _cannot(self, what: str) -> NoReturn:
        raise Unsupported(f"{type(self).__name__} cannot {what}; use a learner that can")


def _declare(cls: Any) -> None:
    declare(cls)
    if cls.__init__ is BaseLearner.__init__:
        cls.__signature__ = signature(cls, by_place=vars(BaseLearner))
    else:
        written = inspect.signature(cls.__init__)
        cls.__signature__ = written.replace(parameters=list(written.parameters.values())[1:])


# A class is no subclass of its own.
_declare(BaseLearner)


class Learner(BaseLearner):
    """A learner from data sets: perception."""

    def fit(
        self,
        dataset: Dataset,
        val_dataset: Optional[Dataset] = None,
        logging_path: str = "",
        silent: bool = True,
        verbose: bool = True,
    ) -> dict[str, Any]:
        """Trains.

        Args:
            dataset: What to train on.
            val_dataset: What to measure on.
            logging_path: Folder of TensorBoard's files; empty: none.
            silent: Whether to print nothing.
            verbose: Whether to print all details.

        Returns:
            Statistics of the training.

        Raises:
            opendr.Unsupported: This learner cannot.
        """
        self._cannot("fit")

    def eval(self, dataset: Dataset) -> dict[str, Any]:
        """Measures on ``dataset``, a ``DatasetIterator`` of pairs of datum and target, by the metric of the learner's task.

        Returns:
            The numbers by name, and under ``"report"`` all there is.

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
    """A learner from environments: control and planning."""

    def fit(
        self,
        env: Any,
        val_env: Any = None,
        logging_path: str = "",
        silent: bool = True,
        verbose: bool = True,
    ) -> dict[str, Any]:
        """Trains in ``env``, measures in ``val_env``; the other arguments as those of :meth:`Learner.fit`.

        Raises:
            opendr.Unsupported: This learner cannot.
        """
        self._cannot("fit")

    def eval(self, env: Any) -> dict[str, Any]:
        """Measures in ``env``.

        Raises:
            opendr.Unsupported: This learner cannot.
        """
        self._cannot("eval")


class LearnerActive(BaseLearner):
    """A learner from data sets and environments: active perception."""

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
        """Trains on ``dataset`` and in ``env``; the other arguments as those of :meth:`Learner.fit`.

        Raises:
            opendr.Unsupported: This learner cannot.
        """
        self._cannot("fit")

    def eval(self, dataset: Dataset, env: Any) -> dict[str, Any]:
        """Measures on ``dataset`` and in ``env``.

        Raises:
            opendr.Unsupported: This learner cannot.
        """
        self._cannot("eval")
