"""Base classes of learners: OpenDR's arguments, and learners declared in Python."""

from __future__ import annotations

import inspect
from typing import Annotated, Any, Literal, NamedTuple, Optional

import numpy as np
import opendr
import pytest
from opendr import _opendr
from opendr._entry_points import learner_entry_points
from opendr._registered import register_installed
from opendr.engine import target
from opendr.engine._declaration import tables_from_class
from opendr.engine._ports import _NAMES
from opendr.engine.data import Image, Vector
from opendr.engine.learners import BaseLearner, Init, Learner, LearnerActive, LearnerRL, Live, Range, Unit
from opendr.engine.target import BoundingBoxList, Category, PoseList

OPENDR_ARGUMENTS = {
    "lr": 0.001,
    "iters": 10,
    "batch_size": 64,
    "optimizer": "sgd",
    "lr_schedule": "",
    "backbone": "default",
    "network_head": "",
    "checkpoint_after_iter": 0,
    "checkpoint_load_iter": 0,
    "temp_path": "",
    "device": "auto",
    "threshold": 0.0,
    "scale": 1.0,
}


class Plain(Learner):
    """Detects nothing."""

    def infer(self, batch: Any) -> Any:
        return []


class BrightSpots(Learner):
    """Finds what is brighter
    than its surroundings.

    More about it.
    """

    name = "bright_spots"
    task = "object_detection_2d"
    threshold: Annotated[float, Range(0.0, 1.0), "Spots below this score are dropped.", Live()] = 0.5
    radius: Annotated[int, Range(1, 99), Unit("px"), "Size of a spot."] = 3
    mode: Annotated[Literal["fast", "fine"], "How it looks."] = "fast"
    limit: Annotated[Optional[int], "Spots at most."] = None
    sizes: Annotated[list[int], Range(1, 9), "Sizes of spots."] = [1, 2]  # noqa: RUF012
    invert: Annotated[bool, "Whether dark is bright."] = False

    def infer(self, image: Image, start: Annotated[Optional[PoseList], Init()] = None) -> BoundingBoxList:
        return BoundingBoxList()


def test_opendr_arguments():
    assert {name: getattr(Plain(), name) for name in OPENDR_ARGUMENTS} == OPENDR_ARGUMENTS
    signature = inspect.signature(Plain)
    assert {name: parameter.default for name, parameter in signature.parameters.items()} == OPENDR_ARGUMENTS
    assert inspect.signature(BaseLearner) == signature
    learner = Plain(1, np.int64(5), device="cuda:1")
    assert (learner.lr, type(learner.lr), learner.iters, learner.device) == (1.0, float, 5, "cuda:1")
    assert (learner.get_hyperparameters(), learner.get_objective_function(), learner.model) == (
        None,
        None,
        None,
    )


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("lr", "0.1", "lr should be a float"),
        ("lr", None, "lr should be a float"),
        ("iters", 1.5, "iters should be an int"),
        ("iters", True, "iters should be an int"),
        ("batch_size", "8", "batch_size should be an int"),
        ("optimizer", 3, "optimizer should be a str"),
        ("checkpoint_load_iter", [], "checkpoint_load_iter should be an int"),
        ("device", None, "device should be a str"),
        ("scale", {}, "scale should be a float"),
    ],
)
def test_wrong_types(name, value, message):
    with pytest.raises(TypeError, match=message):
        Plain(**{name: value})
    learner = Plain()
    with pytest.raises(TypeError, match=message):
        setattr(learner, name, value)
    assert getattr(learner, name) == OPENDR_ARGUMENTS[name]


def test_unknown_and_doubled_arguments():
    with pytest.raises(TypeError, match="no argument 'epochs'; its arguments are lr, iters"):
        Plain(epochs=3)
    with pytest.raises(TypeError, match="lr twice"):
        Plain(0.1, lr=0.1)
    with pytest.raises(TypeError, match="13 positional arguments"):
        Plain(*range(14))
    with pytest.raises(ValueError, match="lr = nan is not finite"):
        Plain(lr=float("nan"))


@pytest.mark.parametrize("base", [BaseLearner, Learner, LearnerRL, LearnerActive])
def test_infer_must_be_written(base):
    with pytest.raises(TypeError, match="abstract"):
        base()


def test_what_is_not_written_is_unsupported():
    learner = Plain()
    for call in [
        lambda: learner.save("model"),
        lambda: learner.load("model"),
        lambda: learner.optimize("cpu"),
        lambda: learner.fit(None),
        lambda: learner.eval(None),
    ]:
        with pytest.raises(NotImplementedError, match="Plain does not support") as caught:
            call()
        assert isinstance(caught.value, opendr.Unsupported)
    assert learner.reset() is None


def test_declared_parameters():
    learner = BrightSpots(threshold=1, radius=np.int32(4))
    assert (learner.threshold, learner.radius, learner.mode, learner.lr) == (1.0, 4, "fast", 0.001)
    assert BrightSpots().threshold == BrightSpots.threshold == 0.5
    parameters = inspect.signature(BrightSpots).parameters
    assert parameters["threshold"].default == 0.5
    assert parameters["mode"].kind is inspect.Parameter.KEYWORD_ONLY
    learner.sizes.append(5)
    assert (learner.sizes, BrightSpots().sizes) == ([1, 2, 5], [1, 2])
    learner.limit = None


@pytest.mark.parametrize(
    ("params", "error", "message"),
    [
        ({"threshold": 1.5}, ValueError, "threshold = 1.5 is out of range 0.0 to 1.0"),
        ({"threshold": float("nan")}, ValueError, "out of range"),
        ({"radius": 0}, ValueError, "radius = 0"),
        ({"mode": "slow"}, ValueError, "mode = 'slow': give one of fast, fine"),
        ({"mode": 1}, TypeError, "mode should be a str"),
        ({"limit": "3"}, TypeError, "limit should be an int"),
        ({"sizes": [10]}, ValueError, "sizes = 10"),
        ({"sizes": ["a"]}, TypeError, "sizes should be a list"),
        ({"sizes": "12"}, TypeError, "sizes should be a list"),
        ({"invert": 1}, TypeError, "invert should be a bool"),
    ],
)
def test_declared_parameters_are_checked(params, error, message):
    with pytest.raises(error, match=message):
        BrightSpots(**params)


def test_subclasses_change_defaults():
    class Brighter(BrightSpots):
        """Finds brighter spots."""

        threshold = 0.75

    class Own(BrightSpots):
        """Has its own constructor."""

        def __init__(self, extra: int) -> None:
            super().__init__(radius=extra)

    assert Brighter().threshold == 0.75
    assert [param["default"] for param in tables_from_class(Brighter)["params"]][0] == 0.75
    with pytest.raises(ValueError, match="out of range"):
        Brighter(threshold=2)
    assert (Own(7).radius, Own(7).threshold) == (7, 0.5)
    assert list(inspect.signature(Own).parameters) == ["extra"]


def test_wrong_declarations():
    with pytest.raises(ValueError, match="x = 3"):

        class OutOfRange(Learner):
            x: Annotated[int, Range(0, 2), "Text."] = 3

    with pytest.raises(TypeError, match="NoDefault.x has no default"):

        class NoDefault(Learner):
            x: Annotated[int, "Text."]

    with pytest.raises(TypeError, match="WrongType.x has the unsupported type"):

        class WrongType(Learner):
            x: Annotated[complex, "Text."] = 1j


def test_tables():
    tables = tables_from_class(BrightSpots)
    params = {param.pop("name"): param for param in tables.pop("params")}
    assert tables == {
        "name": "bright_spots",
        "class_name": "BrightSpots",
        "task": "object_detection_2d",
        "about": "Finds what is brighter than its surroundings.",
        "ports": [
            {"name": "image", "type": "Image", "init": False, "optional": False},
            {"name": "start", "type": "PoseList", "init": True, "optional": True},
        ],
        "outputs": [{"name": "boxes", "type": "BoundingBoxList"}],
    }
    assert list(params) == ["threshold", "radius", "mode", "limit", "sizes", "invert"]
    assert params["threshold"] == {
        "doc": "Spots below this score are dropped.",
        "kind": "float",
        "optional": False,
        "choices": [],
        "range": (0.0, 1.0),
        "unit": "",
        "live": True,
        "default": 0.5,
    }
    assert (params["radius"]["unit"], params["radius"]["range"]) == ("px", (1, 99))
    assert params["mode"]["choices"] == ["fast", "fine"]
    assert (params["limit"]["kind"], params["limit"]["optional"], params["limit"]["default"]) == (
        "int",
        True,
        None,
    )
    assert [params[name]["kind"] for name in ("sizes", "invert")] == ["list", "bool"]


class Found(NamedTuple):
    boxes: BoundingBoxList
    weather: Category


def test_usual_names_are_the_registrys():
    for entry in _opendr.entries():
        if len(entry["outputs"]) == 1:
            (output,) = entry["outputs"]
            assert output["name"] == _NAMES[getattr(target, output["type"])]


def test_several_outputs():
    class Both(Plain):
        """Returns two outputs."""

        name = "both"
        task = "object_detection_2d"

        def infer(self, vector: Vector) -> Found:
            return Found(BoundingBoxList(), Category(0))

    outputs = [{"name": "boxes", "type": "BoundingBoxList"}, {"name": "weather", "type": "Category"}]
    assert tables_from_class(Both)["outputs"] == outputs


def test_tables_name_all_that_is_missing():
    class Nothing(Learner):
        name = "no name"
        x: Annotated[int, Range(0, 2)] = 1

        def infer(self, batch, *others):
            return None

    with pytest.raises(TypeError) as caught:
        tables_from_class(Nothing)
    for wanted in [
        "Nothing cannot be registered",
        "name should be",
        "task should be",
        "the docstring is missing",
        "x has no description",
        "'batch' of infer",
        "infer takes *others",
        "infer has no return annotation",
    ]:
        assert wanted in str(caught.value)
    with pytest.raises(TypeError, match="is not a learner"):
        tables_from_class(int)
    with pytest.raises(TypeError, match="infer is not implemented"):
        tables_from_class(Learner)


def test_plugins_that_cannot_be_registered(tmp_path, monkeypatch):
    (tmp_path / "spots_plugin.py").write_text("class Spots: ...\n")
    info = tmp_path / "spots_plugin-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: spots-plugin\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[opendr.learners]\nspots = spots_plugin:Spots\nbroken = spots_plugin:Missing\nabsent = no_such_module:X\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    assert {point.name for point in learner_entry_points()} >= {"absent", "broken", "spots"}
    with pytest.warns(RuntimeWarning) as caught:
        register_installed()
    absent, broken, spots = sorted(str(warning.message) for warning in caught)
    assert absent.startswith("the learner 'absent' (no_such_module:X) is skipped: ModuleNotFoundError")
    assert broken.startswith("the learner 'broken' (spots_plugin:Missing) is skipped: AttributeError")
    assert spots.startswith("the learner 'spots' (spots_plugin:Spots) is skipped: TypeError")
