"""Base classes of targets."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Optional, TypeVar, Union

from opendr import _opendr
from opendr._errors import Unsupported
from opendr.engine._datum import Datum
from opendr.engine._image_reference import ImageReference
from opendr.engine.target._table import Table, data_frame, html_text
from opendr.engine.target.action import Action, ActionBase

if TYPE_CHECKING:
    import os

    import pandas
    from numpy.typing import NDArray

    from opendr._drawing import ClassNames
    from opendr.engine.data import Image

Self = TypeVar("Self", bound="BaseTarget")
T = TypeVar("T", bound="BaseTarget")


class BaseTarget(Datum):
    """Base class of annotations and predictions.

    Types that are only annotations inherit from this class and not from :class:`Target`.
    """

    def __str__(self) -> str:
        """OpenDR's text."""
        return _opendr.text(self)

    def to_json(self) -> str:
        """Returns the target as one JSON object (``docs/json.md``), the same on every surface.

        A single box, track or pose is written as a list of one.
        """
        return _opendr.json(self._as_value())

    @classmethod
    def from_json(cls: type[Self], text: Union[str, bytes]) -> Self:
        """Reads a target from the JSON of :meth:`to_json`.

        Raises:
            ValueError: The text is not the JSON of a target.
            TypeError: The target is of another class.
        """
        value = cls._from_value(_opendr.value_from_json(text.decode() if isinstance(text, bytes) else text))
        if not isinstance(value, cls):
            raise TypeError(f"the JSON is of a {type(value).__name__}, not of a {cls.__name__}; read it as that")
        return value

    def plot(
        self,
        image: Union[Image, NDArray[Any], str, os.PathLike[str], None] = None,
        class_names: Optional[ClassNames] = None,
    ) -> Image:
        """Returns the image with the target drawn on it: boxes, tracks, poses, maps, texts, or the class of the image.

        Args:
            image: An image as for ``infer``, which is copied. None stands for the image that a learner predicted this from: the
                object given to ``infer`` as long as the program refers to it, else the file that it was read from. The target
                itself does not keep it in memory, and copies and pickles of the target do not have it.
            class_names: Names of the class indices, by index; the target's own names when left out.

        Raises:
            opendr.Unsupported: The target has no place in an image: 3D boxes, transcriptions, actions, curves.
            opendr.InvalidInput: No image is given, and that of the prediction is not known or no longer exists.
        """
        from opendr import _viewing

        return _viewing.plot(self, image, class_names)

    def show(
        self,
        image: Union[Image, NDArray[Any], str, os.PathLike[str], None] = None,
        class_names: Optional[ClassNames] = None,
    ) -> None:
        """Shows the drawing of :meth:`plot`: in a notebook below the cell; else in a window, until a key is pressed; without
        OpenCV or a display as a file, whose path is printed.

        Raises:
            opendr.Unsupported: The target has no place in an image.
            opendr.InvalidInput: No image is given, and that of the prediction is not known or no longer exists.
        """
        from opendr._show import show_image

        show_image(self.plot(image, class_names))

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes the target to a file, in the format of the extension: ``.png``, ``.jpg``, ``.bmp`` or ``.webp`` the drawing of
        :meth:`plot`, ``.json`` the text of :meth:`to_json`, ``.csv`` the table of :meth:`to_pandas`, without pandas.

        Raises:
            opendr.Unsupported: The target cannot be written in this format; the message lists the possible extensions.
            opendr.InvalidInput: The image of the prediction is not known or no longer exists: ``plot(image).save(path)``.
            OSError: The file cannot be written.
        """
        from opendr import _viewing

        _viewing.save(self, path)

    def to_pandas(self) -> pandas.DataFrame:
        """Returns the target as a table with a row for each box, track, keypoint, text, word, class or number; docs/python.md
        lists the columns of each class. Columns and their types do not depend on the content; only the type of ``name`` follows its
        values.

        Raises:
            opendr.Unsupported: The target is a map of scores, which is no table: ``data`` is its array.
            ImportError: The package pandas is not installed.
        """
        table = self._table()
        if table is None:
            raise Unsupported(f"a {type(self).__name__} with these data is no table; its attribute data is the array")
        return data_frame(table)

    def _repr_png_(self) -> Optional[bytes]:
        """Returns the drawing of a prediction for a notebook; None where there is none."""
        from opendr import _viewing

        try:
            return _viewing.png(self)
        except Exception:  # The notebook shows the text.
            return None

    def _repr_html_(self) -> Optional[str]:
        """Returns the table for a notebook; None where there is a drawing, or no table."""
        try:
            table = None if self._has_drawing() else self._table()
            return None if table is None else html_text(table, type(self).__name__)
        except Exception:  # The notebook shows the text.
            return None

    #: The image of the prediction; None for targets that no learner predicted from an image.
    _image: Optional[ImageReference] = None

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_image"}

    def _is_drawn(self) -> bool:
        """Returns whether the target has a place in an image."""
        return False

    def _has_drawing(self) -> bool:
        """Returns whether :meth:`plot` needs no image."""
        return self._image is not None and self._as_value()._is_drawn() and self._image.exists()

    def _table(self) -> Optional[Table]:
        """Returns the columns of :meth:`to_pandas`; None where the target is no table."""
        whole = self._as_value()
        return None if whole is self else whole._table()

    #: The list class in which a single item is written.
    _list: ClassVar[Optional[type[Any]]] = None

    def _as_value(self) -> BaseTarget:
        """Returns the target that can be written as JSON: this one, or a list of only it."""
        return self if self._list is None else self._with_header_in(self._list([self]))

    @classmethod
    def _from_value(cls, value: Any) -> Any:
        """Inverts :meth:`_as_value`."""
        is_item = cls._list is not None and type(value) is cls._list and len(value) == 1
        return value._with_header_in(value[0]) if is_item else value

    def _with_header_in(self, other: T) -> T:
        """Returns ``other`` with this target's time stamp, frame id, action and image."""
        for name in self._header:
            setattr(other, name, getattr(self, name, None))
        other._image = self._image
        return other


class Target(BaseTarget):
    """Base class of types that are both annotations and predictions."""

    _data: Any = None
    _confidence: Any = None
    _action: Optional[ActionBase] = None
    _fields: ClassVar[tuple[str, ...]] = ("data", "confidence")

    @property
    def data(self) -> Any:
        """Content of the target; its type depends on the class."""
        return self._data

    @data.setter
    def data(self, data: Any) -> None:
        self._data = data

    @property
    def confidence(self) -> Any:
        """Score in [0, 1], or None."""
        return self._confidence

    @confidence.setter
    def confidence(self, confidence: Any) -> None:
        self._confidence = confidence

    @property
    def action(self) -> Optional[ActionBase]:
        """Movement of the robot to a better view; None where the learner predicts none."""
        return self._action

    @action.setter
    def action(self, action: Union[ActionBase, Sequence[float], None]) -> None:
        self._action = action if action is None or isinstance(action, ActionBase) else Action(action)
