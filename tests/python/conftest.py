"""Fixtures of the tests of the command: the built command, real models and data, a cache."""

import pytest
from command import Opendr, cache_folder, data_folder


@pytest.fixture(scope="session")
def shared():
    """The folder with real models and data."""
    folder = data_folder()
    if folder is None:
        pytest.skip("skipped: no OPENDR_TEST_DATA")
    return folder


@pytest.fixture(scope="session")
def cache():
    return cache_folder()


@pytest.fixture(scope="session")
def opendr(cache):
    return Opendr(cache)
