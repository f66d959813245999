#!/usr/bin/env python3
"""Writes what is made of the registries: the type stubs of the learners' modules, and the pages docs/learners.md,
docs/metrics.md and docs/datasets.md.

    bindings/python/stubs.py [--check]

With --check nothing is written: the exit code tells whether the files are those of the registry.
"""

import difflib
import inspect
import sys
import textwrap
from pathlib import Path

from opendr import _opendr
from opendr._native_learner import OF_SEVERAL_PARTS, NativeLearner
from opendr._native_learner_rl import NativeLearnerRL
from opendr._reference import document
from opendr._registered import _DRAWING
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
TYPES = {"float": "float", "int": "int", "bool": "bool", "text": "str", "list": "list[Any]"}
#: What stands for a datum in `infer`, besides an object of its class.
ALSO = {"Audio": ["Timeseries"], "Image": ["NDArray[Any]", "str", "os.PathLike[str]"]}
HEADER = '''"""Learners of the task {task}. Made by bindings/python/stubs.py; do not edit."""

import os
from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple, Optional, Union, overload

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
    """The constructor's arguments: OpenDR's own by place, the learner's by name."""
    own = {field["name"]: field for field in (*entry["fit_params"], *entry["params"])}
    base = [
        f"{name}: {param_type(own[name])} = ..." if name in own
        else f"{name}: {getattr(parameter.annotation, '__name__', parameter.annotation)} = ..."
        for name, parameter in BaseLearner.__signature__.parameters.items()
    ]
    fields = keywords(own.values(), names(base))
    idle = [f"{name}: Any = ..." for name, _ in entry["without_effect"] if name not in {*own, *names(base)}]
    return ["self", *base, "*", *fields, *idle]


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
    ports, outputs = entry["ports"], entry["outputs"]
    result = outputs[0]["type"] if len(outputs) == 1 else f"{entry['class_name']}Outputs"
    live = [f"{name}: {param_type(field)} = ..." for field in entry["params"] if field["live"]
            for name in (field["name"], *field["aliases"])]
    live += [f"{name}: Any = ..." for name, _ in entry["without_effect"]]
    keywords = ["*", *live] if live else []
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


def fit(entry):
    """`fit` with the parameters of the training; nothing for a learner that does not train."""
    if not entry["fit"] and not entry["fit_in"]:
        return ""
    shown = ["self"]
    for name, parameter in list(inspect.signature(parent(entry).fit).parameters.items())[1:]:
        if parameter.kind == parameter.VAR_KEYWORD:
            continue
        if parameter.kind == parameter.KEYWORD_ONLY and "*" not in shown:
            shown.append("*")
        shown.append(f"{name}: {parameter.annotation}" + (" = ..." if parameter.default is not parameter.empty else ""))
    shown += keywords(entry["fit_params"], names(shown))
    return call("fit", shown, "dict[str, Any]", note="  # type: ignore[override]")


def parent(entry):
    return NativeLearnerRL if entry["fit_in"] else NativeLearner


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
    return text + call("__init__", arguments(entry), "None") + infer(entry) + fit(entry)


def module(task, entries):
    kinds = {row["type"] for entry in entries for row in (*entry["ports"], *entry["outputs"])}
    kinds |= {kind for of in kinds for kind in ALSO.get(of, ()) if kind.isidentifier() and kind != "str"}
    functions = sorted({name for kind in kinds for name in _DRAWING.get(kind, ())})
    imports = "".join(f"from opendr._drawing import {name} as {name}\n" for name in functions)
    trains = any(entry["fit"] for entry in entries)
    parents = {parent(entry).__name__ for entry in entries}
    wanted = sorted(parents - {"NativeLearnerRL"}) + ["PathLike"] * any(entry["fit"] or entry["fit_in"] for entry in entries)
    imports += f"from opendr._native_learner import {', '.join(wanted)}\n" if wanted else ""
    imports += "from opendr._native_learner_rl import NativeLearnerRL\n" if "NativeLearnerRL" in parents else ""
    for home, wanted in (("data", False), ("target", True)):
        found = ", ".join(sorted(kind for kind in kinds if is_target(kind) == wanted))
        imports += f"from opendr.engine.{home} import {found}\n" if found else ""
    if trains:
        imports += "from opendr.engine.datasets import Dataset\nfrom opendr.engine.learners import Learner\n"
    return HEADER.format(task=task) + imports + "\n" + "\n".join(learner(entry) for entry in entries)


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


def stubs():
    files, listed = {}, {}
    for task, entries in by_task().items():
        package = entries[0]["package"]
        files[f"{package}/{task}.pyi"] = module(task, entries)
        listed.setdefault(package, []).append(f"from opendr.{package} import {task} as {task}\n")
    for package, lines in listed.items():
        files[f"{package}/__init__.pyi"] = f'"""{package.title()}: a module a task."""\n\n{"".join(sorted(lines))}'
    return files


def main():
    stale = False
    pages = {"learners.md": page(), "metrics.md": metrics_page(), "datasets.md": datasets_page()}
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
