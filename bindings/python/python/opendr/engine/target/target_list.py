"""Base classes of lists of targets."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, ClassVar, Generic, NoReturn, Optional, TypeVar, Union, overload

from opendr.engine._checks import text
from opendr.engine.target.base_target import Target

T = TypeVar("T", bound=Target)


class TargetList(Target, Generic[T]):
    """The targets of one datum, in a mutable list: ``data`` is the list itself.

    ``timestamp`` and ``frame_id`` are those of the datum. ``classes`` names the class indices: ``classes[0]`` is
    class 0; it is empty where classes have no names.
    """

    _item: ClassVar[type[Any]] = Target
    _fields: ClassVar[tuple[str, ...]] = ("data",)

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if "_item" in vars(cls):
            cls._item._list = cls

    def __init__(self, items: Optional[Iterable[T]] = None) -> None:
        self.data = [] if items is None else items

    @property
    def data(self) -> list[T]:
        """The items."""
        items: list[T] = self._data
        return items

    @data.setter
    def data(self, data: Iterable[T]) -> None:
        # A list is referenced, not copied, as in OpenDR.
        items = data if isinstance(data, list) else list(self._iterable(data))
        for item in items:
            self._check(item)
        self._data = items

    @property
    def confidence(self) -> float:
        """Mean of the items' current scores; 0 for an empty list."""
        scores = [float(item.confidence) for item in self.data]
        return sum(scores) / max(len(scores), 1)

    @confidence.setter
    def confidence(self, confidence: object) -> NoReturn:
        raise AttributeError("the confidence of a list is the mean of its items' and cannot be set; set that of the items")

    def __len__(self) -> int:
        return len(self.data)

    def __iter__(self) -> Iterator[T]:
        return iter(self.data)

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> list[T]: ...
    def __getitem__(self, index: Union[int, slice]) -> Union[T, list[T]]:
        return self.data[index]

    def append(self, item: T) -> None:
        """Adds an item at the end.

        Raises:
            TypeError: The item is of another class.
        """
        self._check(item)
        self.data.append(item)

    def _check(self, item: object) -> None:
        if not isinstance(item, self._item):
            raise TypeError(f"a {type(self).__name__} contains {self._item.__name__} objects, not {item!r}")

    def _iterable(self, items: Iterable[T]) -> Iterable[T]:
        if isinstance(items, (str, bytes)) or not isinstance(items, Iterable):
            raise TypeError(f"a {type(self).__name__} needs a list of {self._item.__name__}, not {items!r}")
        return items


class NamedTargetList(TargetList[T]):
    """A list of targets with classes."""

    _fields: ClassVar[tuple[str, ...]] = ("data", "classes")

    def __init__(self, items: Optional[Iterable[T]] = None, *, classes: Iterable[str] = ()) -> None:
        super().__init__(items)
        self.classes: list[str] = [text(name, "a name in classes") for name in classes]

    @property
    def boxes(self) -> list[T]:
        """The items; the same list as ``data``."""
        return self.data
