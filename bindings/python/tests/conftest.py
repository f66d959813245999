"""Fixtures for models and images. The tests use the installed package."""

import os
from pathlib import Path

import opendr
import pytest


@pytest.fixture(scope="session")
def test_data():
    folder = os.environ.get("OPENDR_TEST_DATA")
    if not folder:
        pytest.skip("no OPENDR_TEST_DATA")
    return Path(folder)


@pytest.fixture(scope="session")
def zoo(test_data):
    """Models are read from the test data, or downloaded into a cache that is kept between runs; tests must not fail offline."""
    cache = os.environ.get("OPENDR_TEST_CACHE")
    os.environ["OPENDR_MODEL_REPOSITORY"] = str(test_data / "models")
    if cache:
        os.environ["OPENDR_CACHE"] = str(Path(cache) / "opendr")


@pytest.fixture(scope="session")
def photo(test_data):
    return test_data / "data/photos/zidane.jpg"


@pytest.fixture(scope="session")
def nanodet(zoo):
    return opendr.learner("nanodet", device="cpu", verbose=False)


@pytest.fixture(scope="session")
def faces(zoo):
    """The fastest learner."""
    return opendr.learner("yunet/320", device="cpu", verbose=False)
