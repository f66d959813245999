"""Fixtures of the tests of text in images."""

import pytest
from command import Opendr, cache_folder, data_folder
from signs import write_signs


@pytest.fixture(scope="session")
def networks():
    """The folder with PaddleOCR's networks."""
    folder = data_folder()
    if folder is None:
        pytest.skip("skipped: no OPENDR_TEST_DATA")
    return folder / "models/found"


@pytest.fixture(scope="session")
def opendr(networks):
    return Opendr(cache_folder())


@pytest.fixture(scope="session")
def signs(tmp_path_factory):
    """A data set of ten signs with text."""
    return write_signs(tmp_path_factory.mktemp("signs"))
