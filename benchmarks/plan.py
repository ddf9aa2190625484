"""Floor plans, measured; the figures stand in docs/floorplan.md: `python -m benchmarks.plan` (all, with small counts), or some of them by name.

python -m benchmarks.plan scores --count 5          the 20 prompts on 5 seeds, from the words alone and given the rooms, links and areas of the ground truth
python -m benchmarks.plan times --count 200         CPU ms for 5, 8 and 12 rooms, and how much search they buy
python -m benchmarks.plan failures --count 10000    programs of the prior, and of an independent generator
"""

import argparse
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import knobs
from pipeline.experiments.prompts import evaluate_prompts, read_prompts, report
from pipeline.floorplan import FloorProgram, complete, parse, warm
from pipeline.floorplan.program.floor_program import Entrance, Link, Range, RoomReq
from pipeline.floorplan.solver import search
from tests.floorplan.attempts import SOURCES, attempt

CASES = Path(__file__).resolve().parents[1] / "manifests" / "prompts" / "benchmark.yaml"
HOMES = {
    5: "living_room kitchen bedroom bathroom entry",
    8: knobs.FLAT,
    12: "living_room kitchen dining_room hallway bedroom bedroom bedroom bathroom bathroom wc utility office",
}
COUNTS = {"scores": 5, "times": 200, "failures": 200}
CHUNK = 250  # programs between two lines of progress


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.plan", description="Floor plans, measured.")
    parser.add_argument("what", nargs="*", choices=[*COUNTS, []], help="default: all")
    parser.add_argument("--count", type=int, help="seeds or programs")
    parser.add_argument("--start", type=int, default=0, help="failures: number of the first program")
    parser.add_argument("--jobs", type=int, default=2, help="failures: processes")
    parser.add_argument("--source", choices=SOURCES, action="append", help="failures: programs of these only")
    chosen = parser.parse_args(arguments)
    failed = 0
    for what in chosen.what or COUNTS:
        count = chosen.count or COUNTS[what]
        print(f"-- {what}", flush=True)
        if what == "failures":
            failed += failures(count, chosen.start, chosen.source or tuple(SOURCES), chosen.jobs)
        else:
            {"scores": scores, "times": times}[what](count)
    return min(1, failed)


def scores(seeds: int) -> None:
    """Print the scores of the benchmark's prompts."""
    cases = read_prompts(CASES)
    for title, program in (("from the words alone", lambda case: parse(case["prompt"])), ("given the ground truth", truth)):
        print(f"{title}:\n{report(evaluate_prompts(cases, seeds, program))}")


def truth(case: Mapping[str, Any]) -> FloorProgram:
    """Return the program of a case's ground-truth graph: its rooms with their areas, its links, its entrance."""
    rooms = []
    for row in case["graph"]["rooms"]:
        levels = row.get("levels", [row.get("level", 0)])
        area = Range(target=row["area"], stated=True)
        rooms.append(RoomReq(id=row["id"].lower(), type=row["type"], role=row.get("role", ""), level=min(levels), area=area))
    links = tuple(Link(a=e["a"].lower(), b=e["b"].lower(), kind=e["kind"], stated=True) for e in case["graph"]["edges"])
    into = case["graph"].get("entrance")
    entrance = Entrance(into=into, stated=into is not None)
    return FloorProgram(rooms=tuple(rooms), links=links, storeys=case.get("storeys", 1), entrance=entrance, only=True)


def times(seeds: int) -> None:
    """Print CPU times from program to plan in a warm process, and the effort, per number of rooms."""
    warm()
    print(
        f"CPU ms, program to plan, {seeds} seeds\nrooms   mean    p50    p99    max   runs  proposals/room (least)  slicings  proposals/room"
    )
    for count, types in HOMES.items():
        program = complete(FloorProgram(rooms=knobs.rooms_of(types), only=True))
        spent, efforts = [], []
        for seed in range(seeds):
            start = time.process_time()
            efforts.append(search(program, seed).effort)
            spent.append(1e3 * (time.process_time() - start))
        runs, proposals, slicings, sliced = np.array([(e.runs, e.proposals, e.slicings, e.sliced) for e in efforts], float).T
        print(
            f"{count:5d} {np.mean(spent):6.1f} {np.median(spent):6.1f} {np.percentile(spent, 99):6.1f} {max(spent):6.1f}"
            f" {runs.mean():6.1f}  {proposals.mean() / count:8.0f} ({proposals.min() / count:.0f})"
            f" {slicings.mean():16.1f} {sliced.mean() / count:10.0f}"
        )


def failures(count: int, start: int, sources: Sequence[str], jobs: int) -> int:
    """Solve programs number `start` to `start + count` of each source in `jobs` processes; print what failed with its reasons, return how many did."""
    failed = 0
    for source in sources:
        spent: list[float] = []
        faulty = 0
        work = [(source, number) for number in range(start, start + count)]
        for (_, number), (seconds, bad) in zip(work, knobs.in_processes(attempt, work, jobs), strict=True):
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


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
