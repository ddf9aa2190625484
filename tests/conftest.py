"""Fixtures that several packages' tests share."""

import os
import sys
from pathlib import Path

import pytest

from pipeline.execution import pin_instructions

ROOT = Path(__file__).parents[1]
pin_instructions()  # as stages do: what tests make in their own process are the same bytes

# These make much once for all their tests. pytest-xdist deals the first of all tests to one process in one piece.
TOGETHER = ("tests/end_to_end", "tests/homes/test_production.py", "tests/sources/test_masses.py", "tests/experiments/test_realism.py")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Put the tests that share a costly fixture first, so that no two processes make it."""
    items.sort(key=lambda item: not item.nodeid.startswith(TOGETHER))


@pytest.fixture(scope="session", autouse=True)
def _own_cache(tmp_path_factory):
    """What is kept between runs on a machine (assets as USD) stays in the tests' own folder."""
    os.environ["SFGEN_CACHE"] = str(tmp_path_factory.getbasetemp() / "cache")


@pytest.fixture(scope="session")
def dataset_folder(tmp_path_factory):
    """A dataset of ten made-up homes in three shards; nobody writes to it."""
    sys.path.insert(0, str(ROOT / "tests" / "shards"))
    import made

    folder = tmp_path_factory.mktemp("datasets") / "made"
    made.fill(folder)
    return folder


@pytest.fixture(scope="session")
def furnished(tmp_path_factory):
    """A dataset of one real home with its stage and library; nobody writes to it."""
    from tests.export.furnished import fill

    folder = tmp_path_factory.mktemp("datasets") / "furnished"
    fill(folder)
    return folder
