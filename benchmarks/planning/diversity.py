"""How different the plans of one program are over 100 seeds."""

from __future__ import annotations

import numpy as np
import shapely

from benchmarks.planning import record
from benchmarks.planning.times import home
from pipeline.entities.plan import Plan
from pipeline.floorplan import complete, parse, solve
from pipeline.floorplan.program.floor_program import FloorProgram

SIDE = 64  # raster of a plan's bounding box
PROMPTS = (
    "a three-bedroom house with two bathrooms, kitchen, dining room and living room",
    "a two-bedroom flat with an open kitchen and a balcony",
)


def label_map(plan: Plan) -> np.ndarray:
    """Return room indices on a raster of the plan's bounds (SIDE, SIDE), -1 in walls and outside; rooms in the program's order."""
    rooms = [r for r in plan.rooms if r.level == 0]
    points = np.vstack([r.polygon for r in rooms])
    low, high = points.min(axis=0), points.max(axis=0)
    # one scale for both axes, centred: plans are compared as drawn on one sheet
    step = (high - low).max() / SIDE
    centre = (low + high) / 2
    at = (np.arange(SIDE) + 0.5 - SIDE / 2) * step
    x, y = np.meshgrid(centre[0] + at, centre[1] + at)
    labels = np.full((SIDE, SIDE), -1, np.int64)
    for k, r in enumerate(rooms):
        labels[shapely.contains_xy(shapely.Polygon(r.polygon), x, y)] = k
    return labels


def iou(a: np.ndarray, b: np.ndarray) -> float:
    """Mean over rooms of intersection over union, for the best of the eight symmetries of the sheet."""
    best = 0.0
    for turn in range(8):
        c = np.rot90(b if turn < 4 else b.T, turn % 4)
        values = []
        for k in range(int(a.max()) + 1):
            one, two = a == k, c == k
            values.append((one & two).sum() / max((one | two).sum(), 1))
        best = max(best, float(np.mean(values)))
    return best


def contacts(plan: Plan) -> frozenset[tuple[str, str]]:
    """Return which rooms share at least 0.4 m of wall."""
    shapes = {r.room_id: shapely.Polygon(r.polygon) for r in plan.rooms if r.level == 0}
    found = set()
    for a, one in shapes.items():
        reach = one.buffer(plan.inner_wall + 0.02, join_style="mitre")
        for b, two in shapes.items():
            if a < b and not (near := reach.intersection(two)).is_empty:
                x0, y0, x1, y1 = near.bounds
                if max(x1 - x0, y1 - y0) > 0.4:
                    found.add((a, b))
    return frozenset(found)


def main(seeds: int) -> None:
    """Print the mean pairwise IoU and the number of different wall-contact graphs per program; keep them in benchmarks/records/planning.json."""
    programs: list[tuple[str, FloorProgram]] = [("8 rooms", home(8)), ("12 rooms", home(12)), *((p, complete(parse(p))) for p in PROMPTS)]
    figures = []
    for name, program in programs:
        plans = [solve(program, seed) for seed in range(seeds)]
        maps = [label_map(p) for p in plans]
        values = [iou(maps[i], maps[j]) for i in range(seeds) for j in range(i)]
        graphs = len({contacts(p) for p in plans})
        print(f"{name[:60]:60s} mean pairwise IoU {np.mean(values):.3f}; {graphs} wall-contact graphs of {seeds}", flush=True)
        figures.append({"program": name, "rooms": len(program.rooms), "iou": round(float(np.mean(values)), 3), "graphs": graphs})
    record.keep("diversity", seeds, figures)
