"""Tables of targets: one row per box, keypoint, word or class."""

from __future__ import annotations

import csv
import html
import io
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

if TYPE_CHECKING:
    import pandas

    from opendr.engine.target.bounding_box import BoundingBox
    from opendr.engine.target.bounding_box_3d import BoundingBox3D
    from opendr.engine.target.tracking_annotation import TrackingAnnotation

    Named = Union[BoundingBox, BoundingBox3D, TrackingAnnotation]

#: Maximum number of rows of a table in a notebook.
_MAX_ROWS = 40


class Column(NamedTuple):
    """The values of a column, and their type in pandas; None for a column whose values decide it."""

    values: Sequence[Any]
    dtype: Optional[str] = "float64"


Table = dict[str, Column]


def texts(values: Iterable[Optional[str]]) -> Column:
    """Returns a column of texts."""
    return Column(list(values), "str")


def floats(values: Iterable[Optional[float]]) -> Column:
    """Returns a column of numbers."""
    return Column(list(values), "float64")


def ints(values: Iterable[Optional[int]]) -> Column:
    """Returns a column of integers, some of which may be missing."""
    return Column(list(values), "Int64")


def label(item: Named, classes: Sequence[str]) -> str:
    """Returns the name of an item's class, or its index as a text where it has no name."""
    if isinstance(item.name, str):
        return item.name
    return item.class_name or (classes[item.name] if 0 <= item.name < len(classes) else str(item.name))


def class_columns(items: Sequence[Named], classes: Sequence[str]) -> Table:
    """Returns the classes of items, by index or label, and by name."""
    return {
        "name": Column([item.name for item in items], None),
        "class_name": texts(label(item, classes) for item in items),
    }


def box_columns(boxes: Sequence[Union[BoundingBox, TrackingAnnotation]], classes: Sequence[str]) -> Table:
    """Returns classes, places in the image and scores of boxes."""
    place = {side: floats(getattr(box, side) for box in boxes) for side in ("left", "top", "width", "height")}
    return {**class_columns(boxes, classes), **place, "confidence": floats(box.confidence for box in boxes)}


def box_3d_columns(boxes: Sequence[BoundingBox3D], classes: Sequence[str]) -> Table:
    """Returns classes, places in space and in the image, and scores of 3D boxes."""
    rows = [[*box.location.tolist(), *box.dimensions.tolist(), *box.bbox2d.tolist()] for box in boxes]
    names = ("x", "y", "z", "length", "height", "width", "x0", "y0", "x1", "y1")
    place = {name: floats(row[at] for row in rows) for at, name in enumerate(names)}
    angles = {name: floats(getattr(box, name) for box in boxes) for name in ("rotation_y", "alpha", "truncated")}
    occluded = ints(box.occluded for box in boxes)
    scores = floats(box.confidence for box in boxes)
    return {**class_columns(boxes, classes), **place, **angles, "occluded": occluded, "confidence": scores}


def data_frame(table: Table) -> pandas.DataFrame:
    """Returns a table as ``pandas.DataFrame``.

    Raises:
        ImportError: The package is not installed.
    """
    try:
        import pandas
    except ImportError as error:
        raise ImportError(f"to_pandas() needs the package pandas ({error}): pip install pandas") from error
    return pandas.DataFrame(
        {name: pandas.Series(column.values, dtype=column.dtype) for name, column in table.items()}
    )


def csv_text(table: Table) -> str:
    """Returns a table as the text of a CSV file with a header; missing values are empty."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(table)
    writer.writerows(zip(*(column.values for column in table.values())))
    return text.getvalue()


def html_text(table: Table, caption: str) -> str:
    """Returns a table as HTML; the first rows of a long one."""
    rows = list(zip(*(column.values for column in table.values())))
    count = f"{len(rows)} row{'' if len(rows) == 1 else 's'}"
    left_out = f", of which the first {_MAX_ROWS}" if len(rows) > _MAX_ROWS else ""
    lines = [f"<table><caption>{html.escape(caption)}: {count}{left_out}</caption>", _html_row("th", table)]
    lines += [_html_row("td", map(_cell, row)) for row in rows[:_MAX_ROWS]]
    return "\n".join([*lines, "</table>"])


def _html_row(tag: str, cells: Iterable[str]) -> str:
    return f"<tr>{''.join(f'<{tag}>{html.escape(cell)}</{tag}>' for cell in cells)}</tr>"


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)
