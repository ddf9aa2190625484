"""Power cuts, full and failing disks, kills: what was promised stays, the rest is made again, byte for byte."""

import errno
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import crashes
import made
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from pipeline.shards import commits, dataset, disk, library

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
def test_every_power_cut_is_recovered_from():
    distinct, reported, wrong = crashes.run(120)
    assert distinct > 80
    assert wrong == []
    assert reported == {}


@pytest.mark.slow
@pytest.mark.parametrize("writer", [commits, dataset, disk, library])
def test_a_writer_that_does_not_flush_is_caught(writer, monkeypatch):
    monkeypatch.setattr(writer, "sync", lambda _path: None)
    _, reported, wrong = crashes.run(150, seed=1)
    assert wrong or reported


STEPS = ((os, "mkdir"), (os, "rename"), (os, "replace"), (os, "link"), (os, "fsync"), (os, "open"), (Path, "write_bytes"))


STRIDE = 23  # writes between two failures


class Failing:
    """Lets `left` writes pass, then raises `error` for one, or for all."""

    def __init__(self, left, error, lasting):
        self.left, self.error, self.lasting = left, error, lasting

    def around(self, function):
        def call(*arguments, **how):
            self.left -= 1
            if self.left == -1 or (self.left < 0 and self.lasting):
                raise self.error
            return function(*arguments, **how)

        return call


@pytest.mark.slow
@pytest.mark.parametrize(
    ("error", "lasting"),
    [(OSError(errno.ENOSPC, "full"), True), (OSError(errno.EIO, "broken"), False), (KeyboardInterrupt(), False)],
    ids=["full", "broken", "interrupted"],
)
def test_a_write_that_fails_ends_the_run_and_nothing_is_lost(tmp_path, monkeypatch, error, lasting):
    """Fail at one write, some later at each turn: that error is what the run ends with, and the next one ends with the same bytes."""
    small = replace(made.HEADER, count=3, shard_size=2)
    made.fill(tmp_path / "whole", small)
    whole, steps, failed = made.snapshot(tmp_path / "whole"), 0, 0
    while True:
        folder, failing = tmp_path / f"cut-{steps}", Failing(steps, error, lasting)
        with monkeypatch.context() as patched:
            for owner, name in (*STEPS, (pq, "write_table"), (pa.ipc, "new_stream")):
                patched.setattr(owner, name, failing.around(getattr(owner, name)))
            try:
                made.fill(folder, small)
            except BaseException as ended:  # noqa: BLE001 - what it is, is the question
                failed += 1
                assert type(ended) is type(error) or error.strerror in str(ended), repr(ended)  # noqa: PT017
        if failing.left >= 0:
            break
        shutil.rmtree(folder / ".claims" / "owners", ignore_errors=True)  # this process, which is to have ended, lives on
        made.fill(folder, small)
        assert made.snapshot(folder) == whole
        steps += STRIDE
    assert failed > 0.6 * steps / STRIDE  # a link that fails becomes a copy, and so on
    assert steps > 200


@pytest.mark.slow
def test_killed_again_and_again():
    """Alone and in pairs, as `python tests/shards/kills.py` does it a thousand times."""
    done = subprocess.run(
        [sys.executable, str(ROOT / "tests" / "shards" / "kills.py"), "0", "12"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "12 kills" in done.stdout
