"""Failures to find a plan: programs of the prior, and programs read off plans of an independent generator.

A refusal, a crash and whatever the audit finds are failures alike. Nothing stops the run: each is printed with its seed and reason.
A run of LEAST programs or more is kept in benchmarks/records/failures.json as it goes; one that was stopped goes on with `--start`.
"""

from __future__ import annotations

import multiprocessing
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np

from benchmarks.planning import audit, record, times, trees
from pipeline.errors import SfgenError
from pipeline.floorplan import FloorProgram, complete, prior, solve

SOURCES: dict[str, Callable[[np.random.Generator], FloorProgram]] = {"prior": prior, "trees": trees.program}
RECORD = "failures.json"
COMMAND = "python -m benchmarks.plan failures"
LEAST = 1000  # programs of a run that is kept
CHUNK = 250  # programs between two lines of progress
Json = dict[str, Any]
Attempt = tuple[float, list[str]]


def main(count: int, start: int = 0, sources: tuple[str, ...] = tuple(SOURCES), jobs: int = 2) -> int:
    """Solve programs number `start` to `start + count` of each source in `jobs` processes; print what failed, return how many did."""
    commit = record.commit()
    failed = 0
    for source in sources:
        spent: list[float] = []
        known = record.read(RECORD)
        follows = any(r["start"] + r["count"] == start for r in known.get("sources", {}).get(source, ()))
        run: Json = {"start": start, "count": 0, "cpu_s": 0.0, "slowest_s": 0.0, "commit": commit, "failures": []}
        for number, (seconds, bad) in enumerate(attempts(source, start, count, jobs), start):
            spent.append(seconds)
            if bad:
                run["failures"].append({"seed": number, "why": bad})
                print(f"  {source} {number}: {'; '.join(bad)}", flush=True)
            run |= {"count": len(spent), "cpu_s": round(sum(spent), 1), "slowest_s": round(max(spent), 2)}
            if len(spent) % CHUNK == 0 or len(spent) == count:
                print(f"... {source}: {number + 1}, {len(run['failures'])} failed", file=sys.stderr, flush=True)
                if count >= LEAST or follows:
                    record.write(RECORD, kept(known, source, run))
        print(f"{source}: {len(run['failures'])} of {count} failed; CPU ms mean {1e3 * np.mean(spent):.0f}", end="")
        print(f", p50 {1e3 * np.median(spent):.0f}, p99 {1e3 * np.percentile(spent, 99):.0f}, max {1e3 * max(spent):.0f}", flush=True)
        failed += len(run["failures"])
    return failed


def kept(known: Mapping[str, Any], source: str, run: Json) -> Json:
    """Return the record with a run added: runs of its source that end before it stay, and one of the same commit that it goes on grows."""
    runs = [r for r in known.get("sources", {}).get(source, ()) if r["start"] + r["count"] <= run["start"]]
    last = runs[-1] if runs else None
    if last and last["commit"] == run["commit"] and last["start"] + last["count"] == run["start"]:
        run = last | {
            "count": last["count"] + run["count"],
            "cpu_s": round(last["cpu_s"] + run["cpu_s"], 1),
            "slowest_s": max(last["slowest_s"], run["slowest_s"]),
            "failures": [*last["failures"], *run["failures"]],
        }
        runs.pop()
    sources = {**known.get("sources", {}), source: [*runs, run]}
    most = max(sum(r["count"] for r in found) for found in sources.values())
    return {"command": f"{COMMAND} --count {most}", "sources": sources}


def attempts(source: str, start: int, count: int, jobs: int) -> Iterator[Attempt]:
    """Yield what became of each program, in their order; `jobs` processes share the work."""
    numbers = range(start, start + count)
    if jobs <= 1:
        yield from (attempt(source, k) for k in numbers)
        return
    # spawned, not forked: a child must not inherit the threads of libraries that are already at work
    with ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn"), initializer=_warm) as pool:
        yield from pool.map(attempt, [source] * count, numbers, chunksize=5)


def _warm() -> None:
    solve(times.home(5), 0)  # loads what is compiled: no program pays for it


def attempt(source: str, number: int) -> Attempt:
    """Solve one program; return the solver's CPU seconds and what is wrong, each fault with its kind before a colon."""
    start = time.process_time()
    try:
        program = complete(SOURCES[source](np.random.default_rng((number, 4))))
        start = time.process_time()
        plan = solve(program, number)
        spent = time.process_time() - start
        return spent, [f"fault: {f}" for f in audit.faults(program, plan)]
    except SfgenError as error:
        return time.process_time() - start, [f"refused: {error}"]
    except Exception as error:  # noqa: BLE001 - a crash is a failure, and no reason to stop counting
        where = traceback.extract_tb(error.__traceback__)[-1]
        return time.process_time() - start, [f"crash: {error!r} at {where.filename.rsplit('/', 1)[-1]}:{where.lineno}"]
