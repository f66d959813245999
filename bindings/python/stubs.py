#!/usr/bin/env python3
"""Writes what is made of the registries: the type stubs of the learners' modules, the pages docs/learners.md,
docs/metrics.md and docs/datasets.md, and of the table of OpenDR's names the end of docs/python.md.

    bindings/python/stubs.py [--check]

With --check nothing is written: the exit code tells whether the files are those of the registry.
"""

import difflib
import inspect
import re
import sys
import textwrap
from pathlib import Path

import opendr
from opendr import _opendr
from opendr._native_learner import OF_SEVERAL_PARTS
from opendr._reference import document
from opendr._registered import _DRAWING
from opendr._upstream.modules import TASKS, names_of, rows
from opendr._upstream.rows import HERE, Absent
from opendr._upstream.rows import arguments as arguments_of
from opendr.engine.learners import BaseLearner

STUBS = Path(__file__).parent / "python/opendr"
DOCS = Path(__file__).parents[2] / "docs"
PAGE_HEADER = """# Learners

Made by `bindings/python/stubs.py` from the registry; do not edit. Names and parameters are the same on every surface:
`opendr infer NAME --PARAMETER VALUE`, keyword arguments in Python, JSON in C. `opendr models` lists the pretrained models.
Those that train have parameters of `fit` besides: flags of `opendr fit NAME`, keyword arguments of the class, kept for
`fit`, and of `fit` itself in Python, `"params"` among the options of `opendr_fit` in C.

Every Python class takes OpenDR's 13 arguments besides (`lr`, `iters`, `batch_size`, ..., `device`); those that train are
kept for `fit`. A parameter marked *live* may change while the learner runs, and can be given to one call of `infer`.
"""
METRICS_HEADER = """# Metrics

Made by `bindings/python/stubs.py` from the registry; do not edit. `opendr eval` measures a learner by the metric of its
task, or by the one that `--metric` names; `opendr score` measures files of answers; `opendr.metrics.Metric` in Python and
`opendr::metrics` in Rust count whatever they are given. The numbers stand under these names in the JSON of `opendr eval`
(`scalars`), in the dictionary that `eval` returns in Python, and in the JSON of `opendr_eval` in C. A number that could
not be computed (a class without objects) is left out. `<k>` in a name stands for something that varies.

Besides, `tables` has numbers by class or sequence (`name`, `columns`, `rows` of label and numbers), `figures` what
`--out` draws (curves with their points, confusion matrices with their counts), `headline` the number to quote, `worst`
the samples that were answered worst, `problems` what was left out as broken.

Where a metric ranks answers by their scores, `eval` lowers a learner's `threshold` to 0.01 unless you have set it.
"""
DATASETS_HEADER = """# Data sets

Made by `bindings/python/stubs.py` from the registry; do not edit. `opendr data check|stats|view|convert` work on each,
`opendr eval` on those whose targets the metric takes; in Python `ExternalDataset(path, "coco").open()` reads them. The
format is recognised where none is named. Pictures and other bulky data are read when they are asked for.

What is broken (a file that is cut off or missing, a class that there is none of, a box outside its picture, NaN) is told
with file and line or key. The first ends the work; with `--skip-broken` it is left out, counted and listed.
`opendr data check` lists everything.
"""
UPSTREAM_MARK = "## Names, arguments and demos of OpenDR 3.0\n"
UPSTREAM_TEXT = """
Made by `bindings/python/stubs.py` from the table in `opendr/_upstream`, which the package itself works by; do not edit
what follows. It has {names} names in {modules} module paths: {here} are here, {missing} say what to use instead of
them. Module paths of OpenDR (`opendr.perception.object_detection_2d.ssd.ssd_learner`) lead to the classes here. Their
arguments by place are in OpenDR's order, for the constructor, `infer`, `fit`, `eval`, `optimize`, `download`, `load`
and `save`; ours are given by name.
"""
DEMOS_TEXT = """
Programs in `projects/python/perception` of OpenDR were followed line by line. They want `device="cpu"` where there is no
CUDA device, and data that they do not download. In all of them `fit` and `eval` give numbers by name and one
`"report"`, `optimize` writes a smaller model and wants `output`, and one picture gives one prediction.
"""
MISSING_TEXT = """These can be imported; their use raises `opendr.Unsupported`.
"""
IDLE_TEXT = """These are taken, with a `UserWarning`, beside those that [learners.md](learners.md) lists.
"""
TYPES = {"float": "float", "int": "int", "bool": "bool", "text": "str", "list": "list[Any]"}
#: What stands for a datum in `infer`, besides an object of its class.
ALSO = {"Audio": ["Timeseries"], "Image": ["NDArray[Any]", "str", "os.PathLike[str]"]}
#: What signatures name, and where it is.
HOMES = {"Dataset": "opendr.engine.datasets", "Learner": "opendr.engine.learners", "PathLike": "opendr._native_learner"}
#: Learners whose parent says itself what `infer` gives.
OWN_INFER = {
    "FallDetectorLearner",
    "ObjectTracking2DDeepSortLearner",
    "ObjectTracking3DVpitLearner",
    "SiamRPNLearner",
}
HEADER = '''"""Learners of the task {task}. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
'''


def param_type(field):
    kind = TYPES[field["kind"]]
    if field["choices"]:
        kind = f"Literal[{', '.join(map(repr, field['choices']))}]"
    return f"Optional[{kind}]" if field["optional"] else kind


def input_type(port):
    kinds = [port["type"], *ALSO.get(port["type"], ["ArrayLike"] if stands_for_array(port["type"]) else [])]
    return f"Union[{', '.join(kinds)}]" if len(kinds) > 1 else kinds[0]


def stands_for_array(kind):
    return not is_target(kind) and kind not in OF_SEVERAL_PARTS


def is_target(kind):
    from opendr.engine import target

    return hasattr(target, kind)


def arguments(entry):
    """The constructor's arguments: OpenDR's own by place, all others by name."""
    fields = (*entry["fit_params"], *entry["params"])
    own = {name: field for field in fields for name in (field["name"], *field["aliases"])}
    base = {name: parameter.annotation for name, parameter in BaseLearner.__signature__.parameters.items()}

    def shown(name):
        kind = param_type(own[name]) if name in own else getattr(base.get(name), "__name__", "Any")
        return f"{name}: {kind} = ..."

    places = [argument.name for argument in made(entry)._positional]
    rest = [name for name in (*base, *own, *dict(entry["without_effect"])) if name not in places]
    return ["self", *map(shown, places), *["*"] * bool(rest), *map(shown, dict.fromkeys(rest))]


def made(entry):
    """The class of a learner."""
    return opendr.learners()[entry["name"]]


def keywords(fields, without=()):
    """Parameters as keywords, each also under its names in OpenDR."""
    given = [(name, field) for field in fields for name in (field["name"], *field["aliases"])]
    return [f"{name}: {param_type(field)} = ..." for name, field in given if name not in without]


def names(shown):
    return {argument.split(":")[0] for argument in shown}


def call(name, parameters, result, overloaded=False, note=""):
    mark = "    @overload\n" if overloaded else ""
    return f"{mark}    def {name}({', '.join(parameters)}) -> {result}: ...{note}\n"


def infer(entry):
    """`infer`; nothing where the parent's own says more."""
    if "infer" in vars(parent(entry)) and entry["class_name"] in OWN_INFER:
        return ""
    ports, outputs = entry["ports"], entry["outputs"]
    result = outputs[0]["type"] if len(outputs) == 1 else f"{entry['class_name']}Outputs"
    live = {name: param_type(field) for field in entry["params"] if field["live"]
            for name in (field["name"], *field["aliases"])}
    live.update({name: "Any" for name, _ in entry["without_effect"]})
    # An object with run_nms, too.
    live.update(dict.fromkeys({"custom_nms"} & live.keys(), "Any"))
    taken = {port["name"] for port in ports}
    places = {argument.name: live.pop(argument.ours or argument.name, "Any")
              for argument in arguments_of(made(entry)._row.infer) if argument.ours not in taken}
    places = [f"{name}: {kind} = ..." for name, kind in places.items()]
    live = [f"{name}: {kind} = ..." for name, kind in live.items()]
    keywords = [*places, *(["*", *live] if live else [])]
    rest = [
        f"{port['name']}: Optional[{input_type(port)}] = ..." if port["optional"] or port["init"]
        else f"{port['name']}: {input_type(port)}"
        for port in ports[1:]
    ]
    first, one = ports[0]["name"], input_type(ports[0])
    if rest:
        return call("infer", ["self", f"{first}: {one}", *rest, *keywords], result)
    # A str is a sequence of str, an array one of arrays: the first that fits is meant.
    overlap = "" if not stands_for_array(ports[0]["type"]) else "  # type: ignore[overload-overlap]"
    return "".join((
        call("infer", ["self", f"{first}: {one}", *keywords], result, True, overlap),
        call("infer", ["self", f"{first}: Sequence[{one}]", *keywords], f"list[{result}]", True),
        call("infer", ["self", f"{first}: Iterator[{one}]", *keywords], f"Iterator[{result}]", True),
    ))


def method(entry, name, result, more=()):
    """A method with OpenDR's arguments by place, and ours by name."""
    ours = dict(list(inspect.signature(getattr(parent(entry), name)).parameters.items())[1:])
    fields = {key: field for field in more for key in (field["name"], *field["aliases"])}

    def shown(key, known):
        if key in fields:
            return f"{key}: {param_type(fields[key])} = ..."
        parameter = ours.get(known)
        if parameter is None:
            return f"{key}: Any = ..."
        return f"{key}: {parameter.annotation}" + (" = ..." if parameter.default is not parameter.empty else "")

    row = arguments_of(getattr(made(entry)._row, name))
    renamed = {argument.ours for argument in row if argument.ours not in (None, argument.name)}
    usual = [key for key, parameter in ours.items() if parameter.kind == parameter.POSITIONAL_OR_KEYWORD]
    places = {argument.name: argument.ours or argument.name for argument in row} or {key: key for key in usual}
    taken = {*places, *places.values()} - renamed
    others = [key for key, parameter in ours.items() if parameter.kind == parameter.VAR_KEYWORD]
    stars = [f"**{key}: Any" for key in others if name != "fit"]
    rest = [key for key in ours if key not in {*taken, *others}]
    rest += [key for key in fields if key not in {*taken, *rest}]
    # What has two names may be given under either.
    given = [shown(key, known) for key, known in places.items()]
    given = [optional(text) if known in renamed else text for text, known in zip(given, places.values())]
    left = [*(["*"] if rest else []), *(optional(shown(key, key)) for key in rest), *stars]
    first = next((index for index, text in enumerate(given) if text.endswith("= ...")), len(given))
    given = [text if index < first else optional(text) for index, text in enumerate(given)]
    head = "    @classmethod\n" if name == "download" else ""
    return head + call(name, ["cls" if head else "self", *given, *left], result)


def optional(argument):
    return argument if argument.endswith("= ...") else f"{argument} = ..."


def methods(entry):
    """The methods whose arguments are the learner's own."""
    row = made(entry)._row
    text = ""
    if entry["fit"] or entry["fit_in"] or row.fit:
        text += method(entry, "fit", "dict[str, Any]", entry["fit_params"])
    results = {"eval": "dict[str, Any]", "optimize": "dict[str, Any]", "load": "bool", "download": "str"}
    for name, result in results.items():
        if getattr(row, name):
            text += method(entry, name, result)
    for name, instead in row.methods.items():
        if instead:
            text += call(name, ["self", "*args: Any", "**kwargs: Any"], "NoReturn")
    return text


def parent(entry):
    return made(entry).__mro__[1]


def learner(entry):
    text = ""
    if len(entry["outputs"]) > 1:
        fields = "".join(f"    {output['name']}: {output['type']}\n" for output in entry["outputs"])
        text += f"class {entry['class_name']}Outputs(NamedTuple):\n{fields}\n"
    doc = textwrap.indent(document(entry).rstrip(), "    ")
    text += f'class {entry["class_name"]}({parent(entry).__name__}):\n    """{doc.lstrip()}\n    """\n\n'
    # What every learner has is of the base's type: a narrower one would not do for what is written there.
    own = [field for field in entry["params"] if field["name"] not in BaseLearner.__signature__.parameters]
    text += "".join(f"    {field['name']}: {param_type(field)}\n" for field in own)
    return text + call("__init__", arguments(entry), "None") + infer(entry) + methods(entry)


def module(package, task, entries):
    kinds = {row["type"] for entry in entries for row in (*entry["ports"], *entry["outputs"])}
    kinds |= {kind for of in kinds for kind in ALSO.get(of, ()) if kind.isidentifier() and kind != "str"}
    own = {entry["class_name"] for entry in entries}
    homes = {name: "opendr._drawing" for kind in kinds for name in _DRAWING.get(kind, ())}
    others = {name: home for name, home in names_of(f"opendr.{package}.{task}").items() if name not in {*homes, *own}}
    homes.update({name: home for name, home in others.items() if home != HERE and not isinstance(home, Absent)})
    by_home = sorted(homes.items(), key=lambda it: it[::-1])
    imports = "".join(f"from {home} import {name} as {name}\n" for name, home in by_home)
    text = "\n".join(learner(entry) for entry in entries)
    text += "".join(f"\n{absent(name, home)}" for name, home in sorted(others.items()) if isinstance(home, Absent))
    parents = {(parent(entry).__module__, parent(entry).__name__) for entry in entries}
    wanted = parents | {(module, name) for name, module in HOMES.items() if re.search(rf"\b{name}\b", text)}
    wanted |= {(f"opendr.engine.{'target' if is_target(kind) else 'data'}", kind) for kind in kinds}
    for home in sorted({module for module, _ in wanted}):
        imports += f"from {home} import {', '.join(sorted(name for module, name in wanted if module == home))}\n"
    return HEADER.format(task=task) + imports + "\n" + text


def absent(name, home):
    if not name[0].isupper():
        return call(name, ["*args: Any", "**kwargs: Any"], "NoReturn").removeprefix("    ")
    text = f'class {name}:\n    """Not here yet: {home.use}."""\n\n'
    return text + call("__init__", ["self", "*args: Any", "**kwargs: Any"], "NoReturn")


def by_task():
    tasks = {}
    for entry in _opendr.entries():
        # The test learner is of no release.
        if entry["name"] != "counter":
            tasks.setdefault(entry["task"], []).append(entry)
    return tasks


def cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def param_row(field):
    kind = ", ".join(f"`{choice}`" for choice in field["choices"]) or TYPES[field["kind"]]
    if field["range"]:
        kind += f", {field['range'][0]:g} to {field['range'][1]:g} {field['unit']}".rstrip()
    notes = ["*live*"] if field["live"] else []
    notes += [f"in OpenDR `{alias}`" for alias in field["aliases"]]
    name, doc = f"`{field['name']}`", " ".join([field["doc"], *([f"({', '.join(notes)})"] if notes else [])])
    return f"| {name} | {cell(kind)} | `{field['default']!r}` | {cell(doc)} |\n"


def port_text(port):
    note = ", with the first input of a stream" if port["init"] else ", optional" if port["optional"] else ""
    return f"`{port['name']}` ({port['type']}{note})"


def page():
    text = PAGE_HEADER
    for task, entries in by_task().items():
        text += f"\n## {task}\n"
        for entry in entries:
            inputs = ", ".join(map(port_text, entry["ports"]))
            outputs = ", ".join(f"`{output['name']}` ({output['type']})" for output in entry["outputs"])
            text += f"\n### {entry['class_name']}: `{entry['name']}`\n\n{entry['about']}\n\n"
            text += f"Takes {inputs}; gives {outputs}.\n\n"
            text += PARAMS_HEADER
            text += "".join(map(param_row, entry["params"]))
            if entry["fit_params"]:
                text += "\n" + FIT_HEADER + "".join(map(param_row, entry["fit_params"]))
            if entry["without_effect"]:
                text += "\n| argument of OpenDR's class without effect here | why |\n|---|---|\n"
                text += "".join(f"| `{name}` | {cell(reason)} |\n" for name, reason in entry["without_effect"])
    return text


FIT_HEADER = "| parameter of `fit` | values | default | |\n|---|---|---|---|\n"
PARAMS_HEADER = "| parameter | values | default | |\n|---|---|---|---|\n"


def metrics_page():
    text = METRICS_HEADER
    for table in _opendr.metrics():
        text += f"\n## `{table['name']}`\n\n{table['about']}\n\n"
        text += f"Compares a {table['prediction']} with a {table['truth']}.\n\n| number | |\n|---|---|\n"
        text += "".join(f"| `{name}` | {cell(doc)} |\n" for name, doc in table["numbers"])
        if table["params"]:
            text += "\n" + PARAMS_HEADER + "".join(map(param_row, table["params"]))
    return text


def datasets_page():
    text = DATASETS_HEADER + "\n| format | also | targets | files |\n|---|---|---|---|\n"
    for table in _opendr.formats():
        also = ", ".join(f"`{alias}`" for alias in table["aliases"])
        text += f"| `{table['name']}`: {cell(table['about'])} | {also} | {', '.join(table['targets'])} | {cell(table['layout'])} |\n"
    return text


def table_of_opendr(page):
    """docs/python.md with its end made anew."""
    text, demos, idle, missing = page[: page.index(UPSTREAM_MARK)] + UPSTREAM_MARK, "", "", ""
    names = {}
    for task in TASKS:
        for path, found in rows(task).MODULES.items():
            for name, home in found.items():
                names.setdefault((task, name), (path, home))
        for name, row in sorted(getattr(rows(task), "LEARNERS", {}).items()):
            demos += f"| `{name}` | {row.demos} | {cell('; '.join(row.differs))} |\n"
            idle += idle_arguments(name, row)
    for (task, name), (path, home) in sorted(names.items(), key=lambda item: item[0][::-1]):
        if isinstance(home, Absent):
            module = ".".join(filter(None, (task, path)))
            missing += f"| `{name}` | `opendr.{module}` | {cell(home.use)} |\n"
    count = sum(isinstance(home, Absent) for _, home in names.values())
    modules = {".".join(filter(None, (task, path))) for task in TASKS for path in rows(task).MODULES}
    text += UPSTREAM_TEXT.format(names=len(names), modules=len(modules), here=len(names) - count, missing=count)
    text += f"\n### Demos\n{DEMOS_TEXT}\n| learner | demos | what remained different |\n|---|---|---|\n{demos}"
    text += f"\n### Not here yet\n\n{MISSING_TEXT}\n| name | module | instead |\n|---|---|---|\n{missing}"
    text += f"\n### Arguments without effect\n\n{IDLE_TEXT}\n| learner | arguments | why |\n|---|---|---|\n{idle}"
    return text


def idle_arguments(name, row):
    """Rows of arguments that the table says to have no effect, by their reasons."""
    reasons = {}
    for method in ("init", "infer", "fit", "eval", "optimize", "download", "load", "save"):
        for argument in arguments_of(getattr(row, method)):
            if argument.ours is None:
                place = argument.name if method == "init" else f"{method}({argument.name})"
                reasons.setdefault(argument.reason, []).append(f"`{place}`")
    return "".join(f"| `{name}` | {', '.join(places)} | {cell(reason)} |\n" for reason, places in reasons.items())


def stubs():
    files, listed = {}, {}
    for task, entries in by_task().items():
        package = entries[0]["package"]
        files[f"{package}/{task}.pyi"] = module(package, task, entries)
        listed.setdefault(package, []).append(f"from opendr.{package} import {task} as {task}\n")
    for package, lines in listed.items():
        files[f"{package}/__init__.pyi"] = f'"""{package.title()}: a module a task."""\n\n{"".join(sorted(lines))}'
    return files


def main():
    stale = False
    pages = {"learners.md": page(), "metrics.md": metrics_page(), "datasets.md": datasets_page()}
    pages["python.md"] = table_of_opendr((DOCS / "python.md").read_text())
    files = {**{DOCS / name: text for name, text in pages.items()}, **{STUBS / name: text for name, text in stubs().items()}}
    for path, text in files.items():
        there = path.read_text() if path.is_file() else ""
        if "--check" not in sys.argv[1:]:
            path.write_text(text)
        elif there != text:
            stale = True
            sys.stdout.writelines(difflib.unified_diff(there.splitlines(True), text.splitlines(True), str(path), "registry"))
    packages = {path.parent for path in files if path.is_relative_to(STUBS)}
    extra = {path for package in packages for path in package.glob("*.pyi")} - files.keys()
    for path in extra:
        print(f"{path}: no such task")
    return int(stale or bool(extra))


if __name__ == "__main__":
    sys.exit(main())
