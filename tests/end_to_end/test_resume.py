"""`sfgen shard` with the real factory, killed between its first and its last commit and started again."""

import os
import shutil
import signal
import subprocess
import sys
import time

import checkout
import pytest

from sfgen.check import check

HOMES = 12  # in shards of 4
SHARDS = 3
RUN = """
import sys
from pathlib import Path
from stages import shard
shard.main(Path(sys.argv[1]), count=12, out=Path(sys.argv[2]), seed=5, workers=1, prompts=Path(sys.argv[1]) / "tiny.txt")
"""
# One furnished room a home, and half an hour less of looking for places.
TINY = "A studio of 25 m2 with two pieces of furniture and a bathroom.\nA studio of 30 m2 and a bathroom.\n"
QUICK = {
    **checkout.SMALL,
    "shard": {"homes": 4, "chunk": 4, "room_attempts": 1, "preview": 64},
    "postopt": {"separate": {"candidates": 4, "rounds": 2}, "walkable": {"iterations": 2}},
}


def start(root, out):
    environment = {**os.environ, "PYTHONPATH": str(checkout.ROOT), "OMP_NUM_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, "-c", RUN, str(root), str(out)], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )


def commits(folder):
    return sorted(folder.glob("commits/shard-*.json"))


def stamps(folder):
    """Place and time of every file of a committed shard; its parts and claims are working files, which a kill may leave."""
    names = [c.stem for c in commits(folder)]
    working = {".parts", ".claims"}
    files = [
        p for p in folder.rglob("*") if p.is_file() and not working & set(p.parts) and any(n in str(p.relative_to(folder)) for n in names)
    ]
    return {p: (p.stat().st_mtime_ns, p.stat().st_ino) for p in files}


def snapshot(folder):
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@pytest.mark.slow
def test_a_killed_run_resumes_to_the_same_bytes(root, tmp_path):
    small = tmp_path / "checkout"
    shutil.copytree(root, small, ignore=shutil.ignore_patterns("report", "raw", "shards", "samples"))
    (small / "tiny.txt").write_text(TINY)
    checkout.write_params(small, QUICK)
    whole, cut = tmp_path / "whole", tmp_path / "cut"
    killed = start(small, cut)
    end = time.monotonic() + 1200
    while not commits(cut):
        assert time.monotonic() < end
        assert killed.poll() is None
        time.sleep(0.02)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    assert 1 <= len(commits(cut)) < SHARDS
    before = stamps(cut)
    undisturbed, resumed = start(small, whole), start(small, cut)
    assert (undisturbed.wait(), resumed.wait()) == (0, 0)
    assert snapshot(whole) == snapshot(cut)
    after = stamps(cut)
    assert {p: after[p] for p in before} == before
    assert check(cut).homes == HOMES
