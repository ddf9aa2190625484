"""Failures to find a plan: programs of the prior, and programs read off plans of an independent generator.

A refusal, a crash and whatever the audit finds are failures alike. Nothing stops the run: each is printed with its seed and reason.
"""

import multiprocessing
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np

from benchmarks.planning import audit, trees
from pipeline.errors import SfgenError
from pipeline.execution import single_thread
from pipeline.floorplan import FloorProgram, complete, prior, solve, warm

SOURCES: dict[str, Callable[[np.random.Generator], FloorProgram]] = {"prior": prior, "trees": trees.program}
CHUNK = 250  # programs between two lines of progress
Attempt = tuple[float, list[str]]


def main(count: int, start: int = 0, sources: tuple[str, ...] = tuple(SOURCES), jobs: int = 2) -> int:
    """Solve programs number `start` to `start + count` of each source in `jobs` processes; print what failed, return how many did."""
    failed = 0
    for source in sources:
        spent: list[float] = []
        faulty = 0
        for number, (seconds, bad) in enumerate(attempts(source, start, count, jobs), start):
            spent.append(seconds)
            faulty += bool(bad)
            if bad:
                print(f"  {source} {number}: {'; '.join(bad)}", flush=True)
            if len(spent) % CHUNK == 0 or len(spent) == count:
                print(f"... {source}: {number + 1}, {faulty} failed", file=sys.stderr, flush=True)
        print(f"{source}: {faulty} of {count} failed; CPU ms mean {1e3 * np.mean(spent):.0f}", end="")
        print(f", p50 {1e3 * np.median(spent):.0f}, p99 {1e3 * np.percentile(spent, 99):.0f}, max {1e3 * max(spent):.0f}", flush=True)
        failed += faulty
    return failed


def attempts(source: str, start: int, count: int, jobs: int) -> Iterator[Attempt]:
    """Yield what became of each program, in their order; `jobs` processes share the work."""
    return in_processes(attempt, [(source, number) for number in range(start, start + count)], jobs)


def in_processes(measure: Callable[[Any], Any], work: Sequence[Any], jobs: int) -> Iterator[Any]:
    """Yield what is measured of each piece of work, in their order, by `jobs` processes that have compiled the planner."""
    if jobs <= 1:
        yield from map(measure, work)
        return
    # spawned, not forked: a child must not inherit the threads of libraries that are already at work
    with ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn"), initializer=_warm) as pool:
        yield from pool.map(measure, work, chunksize=5)


def _warm() -> None:
    single_thread()
    warm()


def attempt(one: tuple[str, int]) -> Attempt:
    """Solve one program, by source and number; return the solver's CPU seconds and what is wrong, each fault with its kind before a colon."""
    source, number = one
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
