"""The whole factory, run once for all tests of a run."""

import fcntl
import os
import shutil
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
import checkout


@pytest.fixture(scope="session")
def root(tmp_path_factory):
    """The checkout with everything made; made once for all processes of a test run."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "end_to_end"
    with (folder.parent / "end_to_end.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "made").exists():
            shutil.rmtree(folder, ignore_errors=True)
            checkout.make(folder)
            (folder / "made").touch()
    return folder


@pytest.fixture
def broken(root, tmp_path):
    """A copy of the checkout that a test may damage: all but the raw data, the dataset and the report."""
    shutil.copytree(root, tmp_path / "checkout", ignore=shutil.ignore_patterns("raw", "shards", "report", "dvclive"))
    return tmp_path / "checkout"
