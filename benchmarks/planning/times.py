"""CPU time from program to plan in a warm process, and how much search it buys."""

import time

import numpy as np

from benchmarks.planning import record
from pipeline.floorplan import FloorProgram, complete
from pipeline.floorplan.program.floor_program import RoomReq, RoomType
from pipeline.floorplan.solver import search

HOMES: dict[int, tuple[RoomType, ...]] = {
    5: ("living_room", "kitchen", "bedroom", "bathroom", "entry"),
    8: ("living_room", "kitchen", "bedroom", "bedroom", "bathroom", "hallway", "wc", "balcony"),
    12: (
        "living_room", "kitchen", "dining_room", "hallway", "bedroom", "bedroom", "bedroom", "bathroom", "bathroom", "wc", "utility", "office",
    ),
}  # fmt: skip
BARS = {5: 40, 8: 90, 12: 200}


def home(count: int) -> FloorProgram:
    """Return the program whose planning is timed."""
    return complete(FloorProgram(rooms=tuple(RoomReq(id=f"r{i}", type=k) for i, k in enumerate(HOMES[count])), only=True))


def main(seeds: int) -> None:
    """Print times and effort per number of rooms; keep them in benchmarks/records/planning.json."""
    figures = []
    search(home(5), 0)  # compiles
    print(
        f"CPU ms, program to plan, {seeds} seeds\nrooms  bar   mean    p50    p99    max  p99/mean   runs  proposals/room (least)  slicings  proposals/room"
    )
    for count in HOMES:
        program, times, efforts = home(count), [], []
        for seed in range(seeds):
            start = time.process_time()
            efforts.append(search(program, seed).effort)
            times.append(1e3 * (time.process_time() - start))
        mean, tail = float(np.mean(times)), float(np.percentile(times, 99))
        print(
            f"{count:5d} {BARS[count]:4d} {mean:6.1f} {np.median(times):6.1f} {tail:6.1f} {max(times):6.1f} {tail / mean:9.1f}"
            f" {np.mean([e.runs for e in efforts]):6.1f}  {np.mean([e.proposals for e in efforts]) / count:8.0f} ({min(e.proposals for e in efforts) / count:.0f})"
            f" {np.mean([e.slicings for e in efforts]):16.1f} {np.mean([e.sliced for e in efforts]) / count:10.0f}"
        )
        figures.append({"rooms": count, "bar_ms": BARS[count], "mean_ms": round(mean, 1), "p99_ms": round(tail, 1)})
        figures[-1] |= {"proposals": round(min(e.proposals for e in efforts) / count), "runs": min(e.runs for e in efforts)}
    record.keep("times", seeds, figures)
