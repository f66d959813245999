"""Tables of targets: columns, types, and the page that lists them."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import opendr
import pandas
import pytest
from opendr.engine import target as targets
from opendr.engine.target import (
    BaseTranscription,
    BoundingBox,
    BoundingBox3DList,
    BoundingBoxList,
    Category,
    Heatmap,
    Pose,
    PoseList,
    RlTarget,
    SpeechCommand,
    TextRegionList,
    TrackingAnnotation3DList,
    TrackingAnnotationList,
    WhisperTranscription,
)
from test_target import every_target

PAGE = Path(__file__).parents[3] / "docs/python.md"
BOX = ["name", "class_name", "left", "top", "width", "height", "confidence"]


def documented():
    """Returns the columns by class name, as the page lists them; those of maps by the number of axes."""
    section = PAGE.read_text("utf-8").split("## Tables\n")[1].split("\n## ")[0]
    found = {}
    for row in re.findall(r"^\| (`.*)$", section, re.MULTILINE):
        kinds, _, columns = row.strip(" |").split(" | ")
        axes = ["2" if "height" in kinds else "1"] if "Heatmap" in kinds else [""]
        for kind in re.findall(r"`(\w+)`", kinds):
            found[kind + axes[0]] = re.findall(r"`(\w+)`", columns)
    return found


def test_the_page_lists_every_column():
    pages = documented()
    used = set()
    for target in every_target():
        kind = type(target).__name__.replace("CocoBoundingBox", "BoundingBox")
        kind += str(target.data.ndim) if kind == "Heatmap" else ""
        assert list(target.to_pandas().columns) == pages[kind]
        used.add(kind)
    assert used == set(pages)


@pytest.mark.parametrize("target", every_target(), ids=lambda target: type(target).__name__)
def test_columns_and_types_do_not_depend_on_the_content(target):
    table = target.to_pandas()
    assert isinstance(table, pandas.DataFrame)
    assert list(table.index) == list(range(len(table)))
    other = next((one for one in every_target() if type(one) is type(target) and one != target), None)
    if other is not None and not isinstance(target, (Heatmap, SpeechCommand, RlTarget)):
        kinds = {name: kind for name, kind in table.dtypes.items() if name != "name"}
        assert {name: kind for name, kind in other.to_pandas().dtypes.items() if name != "name"} == kinds


EMPTY = [BoundingBoxList, TrackingAnnotationList, BoundingBox3DList, TrackingAnnotation3DList, PoseList, TextRegionList]


@pytest.mark.parametrize("kind", EMPTY, ids=lambda kind: kind.__name__)
def test_empty_lists(kind):
    empty = kind().to_pandas()
    full = next(target for target in every_target() if type(target) is kind).to_pandas()
    assert len(empty) == 0
    assert list(empty.columns) == list(full.columns)
    assert {name: kind for name, kind in empty.dtypes.items() if name != "name"} == {
        name: kind for name, kind in full.dtypes.items() if name != "name"
    }


def test_boxes():
    boxes = [BoundingBox(1, 10.5, 20, 30, 40, 0.9), BoundingBox("dog", 1, 2, 3, 4), BoundingBox(7, 1, 2, 3, 4)]
    table = BoundingBoxList(boxes, classes=["person", "cat"]).to_pandas()
    assert list(table.columns) == BOX
    assert table["name"].tolist() == [1, "dog", 7]
    assert table["class_name"].tolist() == ["cat", "dog", "7"]
    assert table.loc[0, ["left", "top", "width", "height", "confidence"]].tolist() == [10.5, 20, 30, 40, 0.9]
    numbers = BoundingBoxList(boxes[:1]).to_pandas()
    assert numbers["name"].dtype == np.int64
    assert pandas.concat([table, numbers]).shape == (4, 7)


def test_poses():
    poses = PoseList([Pose([[1, 2]] * 18, 0.5, id=4), Pose([[3, 4.1]] * 17, 0.25, keypoint_confidences=[0.75] * 17)])
    table = poses.to_pandas()
    assert len(table) == 35
    assert table["pose"].tolist() == [0] * 18 + [1] * 17
    assert table["id"][0] == 4 and pandas.isna(table["id"][18])
    wrist = table[(table["pose"] == 1) & (table["keypoint"] == "l_wri")].iloc[0]
    assert (wrist["x"], wrist["y"], wrist["confidence"], wrist["pose_confidence"]) == (3, np.float32(4.1), 0.75, 0.25)
    # Joints beyond those of the skeleton have no names.
    assert Pose([[1, 2]] * 20, 1, skeleton="opendr18").to_pandas()["keypoint"].tolist()[17:] == ["l_ear", "18", "19"]


def test_maps():
    table = Heatmap(np.array([[0, 2, 2], [2, 5, 5]], np.uint32), {0: "road", 2: "car"}).to_pandas()
    assert table.to_dict("list") == {
        "name": [0, 2, 5],
        "class_name": ["road", "car", "5"],
        "pixels": [1, 3, 2],
        "share": pytest.approx([1 / 6, 3 / 6, 2 / 6]),
    }
    assert Heatmap(np.array([0.5, 0.25])).to_pandas().to_dict("list") == {"index": [0, 1], "value": [0.5, 0.25]}
    with pytest.raises(opendr.Unsupported, match="its attribute data is the array"):
        Heatmap(np.zeros((2, 3, 4), np.float32)).to_pandas()


def test_classes_and_words():
    scores = Category(1, "cat", 0.75, probabilities=[0.25, 0.75]).to_pandas()
    assert scores["name"].tolist() == [0, 1] and scores["confidence"].tolist() == [0.25, 0.75]
    assert pandas.isna(scores["class_name"][0]) and scores["class_name"][1] == "cat"
    assert Category(3, confidence=0.5).to_pandas()["confidence"].tolist() == [0.5]
    assert Category(3).to_pandas()["confidence"].isna().all()
    segments = [{"id": 0, "start": 0.5, "end": 1.5, "text": " left", "avg_logprob": -0.25}, {"text": " now"}]
    words = WhisperTranscription(" left now", segments).to_pandas()
    assert words["text"].tolist() == [" left", " now"] and words["start"][0] == 0.5
    assert pandas.isna(words["id"][1]) and words["avg_logprob"][0] == -0.25 and words["temperature"].isna().all()
    assert WhisperTranscription("left").to_pandas()["text"].tolist() == ["left"]
    assert BaseTranscription("left").to_pandas().to_dict("list") == {"text": ["left"]}
    command = SpeechCommand("stop", 0.75, (0.5, 1.25)).to_pandas()
    assert command.iloc[0].tolist() == ["stop", 0.75, 0.5, 1.25]
    assert RlTarget([0.5, -1.0]).to_pandas()["value"].tolist() == [0.5, -1.0]


@pytest.mark.parametrize("target", every_target(), ids=lambda target: type(target).__name__)
def test_csv_files_are_the_tables(target, tmp_path):
    target.save(tmp_path / "table.csv")
    read = pandas.read_csv(tmp_path / "table.csv")
    table = target.to_pandas()
    assert list(read.columns) == list(table.columns)
    assert len(read) == len(table)
    for name in table.columns:
        if pandas.api.types.is_numeric_dtype(table[name]):
            assert read[name].to_numpy(float) == pytest.approx(table[name].to_numpy(float, na_value=np.nan), nan_ok=True)


def test_pandas_is_imported_on_use_and_csv_needs_none(tmp_path):
    code = (
        "import sys; sys.modules['pandas'] = None\n"
        "from opendr.engine.target import BoundingBoxList\n"
        f"BoundingBoxList().save({str(tmp_path / 'empty.csv')!r})\n"
        "try:\n    BoundingBoxList().to_pandas()\n"
        "except ImportError as error:\n    print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "to_pandas() needs the package pandas" in done.stdout and "pip install pandas" in done.stdout
    assert (tmp_path / "empty.csv").read_text("utf-8") == ",".join(BOX) + "\n"
    code = "import sys, opendr.engine.target; print('pandas' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"


def test_every_target_class_has_a_table():
    names = {name for name in targets.__all__ if name not in ("Action", "ActionBase", "BaseTarget", "Target")}
    assert {type(target).__name__ for target in every_target()} == names
