"""Recovers a dataset from what power cuts leave of it: everything is made again, byte for byte, and nothing that was promised is lost."""

import gc
import hashlib
import shutil
import tempfile
from dataclasses import replace
from pathlib import Path

import made
import powercut

from pipeline.errors import ContentError
from pipeline.shards import add_part, claims, commit_shard, gather
from sfgen.check import check
from sfgen.place import DatasetError

HEADER = replace(made.HEADER, count=3, shard_size=2)


def record(scratch):
    """Make a dataset on the recording disk; returns the events and the files of the whole dataset."""
    folder = (scratch / "recorded" / "set").resolve()
    folder.parent.mkdir(parents=True)
    machine = claims._machine
    claims._machine = lambda: {**machine(), "boot": "before the power cut"}
    try:
        with powercut.Recorder(folder.parent).at_work() as recorder:
            with made.opened(folder, HEADER, scratch / "source") as dataset:
                for number in (0, 1):
                    for index in HEADER.indices(number):
                        dataset.take(number, index)
                        add_part(dataset, number, gather(number, *made.home(index)))
                    commit_shard(dataset, number)
                    recorder.mark(f"shard-0000{number}")
            recorder.mark("whole")
    finally:
        claims._machine = machine
    return recorder.events, made.snapshot(folder)


def faults(state, promised, whole, scratch):
    """Put a state on disk, look at it, recover it; returns what is wrong, and whether it was reported instead of recovered."""
    powercut.put(state, scratch / "after")
    folder = scratch / "after" / "set"
    folder.mkdir(exist_ok=True)
    found = []
    there = {path.removeprefix("set/"): data for path, data in state.items() if data is not None}
    for name in promised:
        mine = [path for path in whole if name in path] if name != "whole" else list(whole)
        found += [f"{path} of {name} is lost" for path in mine if there.get(path) != whole[path]]
    try:
        check(folder)
        if there != whole:
            found.append("verify does not notice")
    except DatasetError as error:
        if "whole" in promised and "or is at work" not in str(error):  # the names of claims that were removed may be back
            found.append(f"verify complains: {error}")
    try:
        made.fill(folder, HEADER, source=scratch / "source")
    except ContentError as error:
        return found, str(error)
    except Exception as error:  # noqa: BLE001 - what the user would get to see as a traceback
        return [*found, f"{type(error).__name__}: {error}"], ""
    if made.snapshot(folder) != whole:
        found.append("other bytes after recovering")
    return found, ""


def run(count, seed=0, say=lambda *_: None):
    """Recover from so many power cuts, each distinct state once; returns (distinct states, reported, faults)."""
    base = "/dev/shm" if Path("/dev/shm").is_dir() else None
    with tempfile.TemporaryDirectory(dir=base) as place:
        scratch = Path(place)
        events, whole = record(scratch)
        gc.freeze()
        seen, reported, wrong = set(), {}, []
        for number, (state, promised) in enumerate(powercut.states(events, count, seed)):
            key = hashlib.sha256(repr((sorted(state.items()), promised)).encode()).digest()
            if key in seen:
                continue
            seen.add(key)
            found, told = faults(state, promised, whole, scratch)
            wrong += [f"cut {number}: {fault}" for fault in found]
            if told:
                reported[told.split(";")[0]] = reported.get(told.split(";")[0], 0) + 1
            say(number, len(seen), wrong)
        shutil.rmtree(scratch / "after", ignore_errors=True)
    return len(seen), reported, wrong
