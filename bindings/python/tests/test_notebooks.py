"""The notebooks of docs/notebooks run from the first cell to the last in a Jupyter kernel, without a network.

A kernel, and not only the code of the cells: what a cell displays is chosen by IPython from the representations of the object.
"""

from __future__ import annotations

import base64
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient
from opendr.engine.data import Image

FOLDER = Path(__file__).parents[3] / "docs/notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
#: An address at which nothing listens.
NOWHERE = "http://127.0.0.1:9"


def run(notebook, folder):
    NotebookClient(notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()
    return [output for cell in notebook.cells for output in cell.get("outputs", [])]


def of_type(outputs, kind):
    return [output["data"][kind] for output in outputs if kind in output.get("data", {})]


@pytest.fixture
def offline(monkeypatch):
    for name in ("http_proxy", "https_proxy", "HTTP_PROXY", "HTTPS_PROXY", "PIP_INDEX_URL"):
        monkeypatch.setenv(name, NOWHERE)
    monkeypatch.delenv("OPENDR_MODEL_REPOSITORY", raising=False)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook(path, offline, tmp_path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    outputs = run(notebook, tmp_path)
    assert [output["text"] for output in outputs if output.get("name") == "stderr"] == []
    for number, image in enumerate(of_type(outputs, "image/png")):
        file = tmp_path / f"output-{number}.png"
        file.write_bytes(base64.b64decode(image))
        assert Image.open(file).data.std() > 10, "an empty image"
    assert of_type(outputs, "image/png") and of_type(outputs, "text/html")


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_stored_without_outputs(path):
    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            assert cell.outputs == [] and cell.execution_count is None
    assert notebook.metadata == {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}


def test_there_are_notebooks():
    page = (FOLDER.parent / "python.md").read_text("utf-8")
    assert len(NOTEBOOKS) >= 3
    assert all(f"(notebooks/{path.name})" in page for path in NOTEBOOKS)


CELLS = """
import numpy as np
from opendr.engine.data import Image
from opendr.engine.target import BoundingBox, BoundingBoxList
boxes = BoundingBoxList([BoundingBox(0, 10, 20, 30, 40, 0.9)], classes=["person"])
boxes
---
Image(np.full((96, 128, 3), 40, np.uint8))
---
image = Image(np.full((96, 128, 3), 40, np.uint8))
boxes.show(image)
---
from opendr.engine._image_reference import ImageReference
boxes._image = ImageReference.to(image)
boxes
---
del image
boxes
---
boxes.data.append("no box")
boxes
"""


def test_what_a_notebook_displays(tmp_path):
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell.strip()) for cell in CELLS.split("---")])
    kinds = [set(output["data"]) for output in run(notebook, tmp_path)]
    table, image = {"text/html", "text/plain"}, {"image/png", "text/plain"}
    # With an image its drawing, without one its table, and its text where neither can be made.
    assert kinds == [table, image, image, image, table, {"text/plain"}]
