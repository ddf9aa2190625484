"""A run killed with SIGKILL and started again equals an undisturbed one, byte for byte; what was committed is not touched."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import made
import pytest

from sfgen.check import check

ROOT = Path(__file__).parents[2]
RENAME, REPLACE = Path.rename, Path.replace
SHARDS = 6  # 24 homes in shards of 4


def start(folder, *stop):
    program = [sys.executable, str(Path(__file__).parent / "made.py"), str(folder), *map(str, stop)]
    return subprocess.Popen(program, env={**os.environ, "PYTHONPATH": str(ROOT)})


def commits(folder):
    return sorted(folder.glob("commits/shard-*.json"))


def stamps(folder):
    """Place and time of every file of a committed shard."""
    names = {c.stem for c in commits(folder)}
    files = [
        p
        for p in folder.rglob("*")
        if p.is_file() and any(n in str(p.relative_to(folder)) for n in names) and not {".parts", ".claims", ".staging"} & {*p.parts}
    ]
    return {p: (p.stat().st_mtime_ns, p.stat().st_ino) for p in files}


@pytest.mark.parametrize("wanted", [1, 3])
def test_killed_run_resumes_to_the_same_bytes(tmp_path, wanted):
    undisturbed = start(tmp_path / "a")
    killed = start(tmp_path / "b", 4 * wanted + 1)
    end = time.monotonic() + 300
    while len(commits(tmp_path / "b")) < wanted:
        assert time.monotonic() < end
        assert killed.poll() is None
        time.sleep(0.01)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    assert len(commits(tmp_path / "b")) == wanted < SHARDS
    before = stamps(tmp_path / "b")
    assert start(tmp_path / "b").wait() == 0
    assert undisturbed.wait() == 0
    assert made.snapshot(tmp_path / "a") == made.snapshot(tmp_path / "b")
    after = stamps(tmp_path / "b")
    assert {p: after[p] for p in before} == before
    assert check(tmp_path / "b").homes == 24


def test_stopped_at_any_step_of_a_commit(tmp_path, monkeypatch):
    """Stop the writer at every third step, one place later each time, as a kill would: it always resumes."""
    small = replace(made.HEADER, count=5)
    made.fill(tmp_path / "whole", small)
    steps = 0
    while True:
        folder = tmp_path / f"cut-{steps}"
        left = iter(range(steps))

        def cut(function, left=left):
            def stopped(*args, **kwargs):
                if next(left, None) is None:
                    raise KeyboardInterrupt
                return function(*args, **kwargs)

            return stopped

        with monkeypatch.context() as patched:
            patched.setattr(Path, "rename", cut(Path.rename))
            patched.setattr(Path, "replace", cut(Path.replace))
            patched.setattr(os, "fsync", cut(lambda _: None))
            try:
                made.fill(folder, small)
                break
            except KeyboardInterrupt:
                pass
            patched.setattr(Path, "rename", RENAME)
            patched.setattr(Path, "replace", REPLACE)
            patched.setattr(os, "fsync", lambda _: None)
            made.fill(folder, small)
        steps += 3
        assert made.snapshot(folder) == made.snapshot(tmp_path / "whole")
    assert steps > 60
