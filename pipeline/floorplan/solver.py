"""Program → plan: slicing start, annealing, straightened lines, openings; restarts until every condition holds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pipeline import seeds
from pipeline.entities.plan import Plan, Room
from pipeline.errors import RefusedError
from pipeline.floorplan import anneal, energy, slicing, trace
from pipeline.floorplan.check import check
from pipeline.floorplan.completion import complete
from pipeline.floorplan.grid import INNER, OUTER, Labels
from pipeline.floorplan.openings import Run, place
from pipeline.floorplan.program import FloorProgram
from pipeline.floorplan.storeys import UNIT, Storey, storey

TRIES = 24  # whole attempts before a program is refused
STARTS = 3  # slicing trees per attempt
SLICES = 700  # slicing proposals per room and start
PROPOSALS = 160  # annealing proposals per room and run
HOT, COLD, PENALTY = 1.2, 0.01, 40.0
ASPECTS = (1.0, 1.6)


def solve(program: FloorProgram, seed: int, keys: tuple[int, ...] = ()) -> Plan:
    """Return a plan that meets every hard condition of the program; the same for the same (program, seed, keys).

    Raises RefusedError when the program contradicts itself or no attempt meets it.
    """
    program = complete(program)
    check(program)
    for attempt in range(TRIES):
        rng = seeds.generator(seed, "plan", *keys, attempt)
        plan = _attempt(program, rng, attempt)
        if plan is not None:
            return plan
    raise RefusedError(
        f"no floor plan found in {TRIES} attempts for {len(program.rooms)} rooms in {program.total_area.target:.0f} m2",
        "ask for fewer links to one room, a larger total area, or drop a separation",
    )


def _attempt(program: FloorProgram, rng: np.random.Generator, attempt: int) -> Plan | None:
    request = storey(program, 0)
    grid = _storey_grid(request, program, rng, attempt)
    if grid is None:
        return None
    return _build(program, [(request, grid)], rng)


def _storey_grid(request: Storey, program: FloorProgram, rng: np.random.Generator, attempt: int) -> Labels | None:
    """Return a grid without violations: the best of several slicing trees, annealed."""
    starts = [_slice(request, program, rng) for _ in range(STARTS)]
    best = min(starts, key=lambda s: s[1])[0]
    n = len(request.rooms)
    effort = 1 + attempt // 6
    draws = rng.random((PROPOSALS * n * effort, anneal.DRAWS))
    fixed = np.zeros(n + 1, np.int64)
    grid, _, hard, _, _ = anneal.anneal(best, request.spec, request.weights, fixed, draws, HOT, COLD, PENALTY)
    return grid if hard <= 1e-9 else None


def _slice(request: Storey, program: FloorProgram, rng: np.random.Generator) -> tuple[Labels, float]:
    """Anneal one slicing tree in an outline of a drawn aspect; return its bordered grid and cost."""
    n = len(request.rooms)
    spec = request.spec
    low, high = max(program.footprint.min_aspect, ASPECTS[0]), max(program.footprint.max_aspect, program.footprint.min_aspect)
    aspect = np.exp(rng.uniform(np.log(low), np.log(high)))
    whole = request.gross.sum()
    width = max(int(round((whole * aspect) ** 0.5)), 2)
    height = max(int(round(whole / width)), 2)
    expr = np.empty(2 * n - 1, np.int64)
    expr[0] = 0
    order = rng.permutation(n)
    expr[0] = order[0]
    for k in range(1, n):
        expr[2 * k - 1] = order[k]
        expr[2 * k] = slicing.V if k % 2 else slicing.H
    draws = rng.random((SLICES * n, slicing.DRAWS))
    square = np.where(spec.square > 0, 0.6, 0.08) * 2.0 ** program.style.squareness
    rects, cost = slicing.search(
        expr,
        draws,
        6.0,
        0.05,
        width,
        height,
        n,
        request.gross,
        request.gross_low,
        request.gross_high,
        spec.need,
        spec.ban,
        spec.outside,
        spec.strict,
        square,
        spec.apart,
        spec.stair,
        spec.stair_room,
        request.weights[10:],
    )
    grid = np.full((height + 2, width + 2), n, np.int16)
    for i, (x0, y0, x1, y1) in enumerate(rects.tolist()):
        grid[y0 + 1 : y1 + 1, x0 + 1 : x1 + 1] = i
    return grid, float(cost)


def _build(program: FloorProgram, storeys: list[tuple[Storey, Labels]], rng: np.random.Generator) -> Plan | None:
    """Turn the grids into rooms and openings; None when an opening finds no place."""
    rooms: list[Room] = []
    runs: list[Run] = []
    for request, grid in storeys:
        n = len(request.rooms)
        walls = trace.walls(grid, n)
        corners = [trace.outline(grid, i) for i in range(n)]
        metres = [np.array(c, dtype=float) * UNIT for c in corners]
        sides = [_inner_sides(grid, corners[i], i, n) for i in range(n)]
        for i, room in enumerate(request.rooms):
            polygon = np.round(trace.faces(corners[i], metres[i], sides[i]), 4)
            rooms.append(Room(room.id, room.type, polygon, request.level, role=room.role))
        runs += _runs(request, walls, rooms)
    depth = _depths(program)
    openings = place(program, rooms, runs, depth, rng)
    if openings is None:
        return None
    return Plan(tuple(rooms), openings, program.entrance.into or rooms[0].room_id, 2 * INNER, 2 * OUTER)


def _inner_sides(grid: Labels, corners: trace.Corners, room: int, n: int) -> list[bool]:
    """Whether each side of a room's outline has another room behind any part of it."""
    sides = []
    for (x0, y0), (x1, y1) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if y0 == y1:
            row = y0 if x1 > x0 else y0 + 1
            behind = grid[row, min(x0, x1) + 1 : max(x0, x1) + 1]
        else:
            column = x0 + 1 if y1 > y0 else x0
            behind = grid[min(y0, y1) + 1 : max(y0, y1) + 1, column]
        sides.append(bool(np.any(behind != n)))
    return sides


def _runs(request: Storey, walls: list[trace.Wall], rooms: list[Room]) -> list[Run]:
    """Return the stretches of wall that openings can stand in: where both rooms' inner faces lie opposite each other."""
    by_id = {r.room_id: r for r in rooms}
    runs: list[Run] = []
    for wall in walls:
        names = (request.rooms[wall.a].id,) + ((request.rooms[wall.b].id,) if wall.b >= 0 else ())
        axis = 1 if wall.vertical else 0
        face = [_face(by_id[name].polygon, wall, low) for name, low in zip(names, (wall.a_low, not wall.a_low), strict=False)]
        if any(f is None for f in face):
            continue
        spans: list[tuple[float, float, float]] = [f for f in face if f is not None]
        start = max(max(f[0] for f in spans), wall.start * UNIT)
        end = min(min(f[1] for f in spans), wall.end * UNIT)
        if end - start < 0.5:
            continue
        line = (spans[0][2] + spans[1][2]) / 2 if len(spans) == 2 else spans[0][2] + (OUTER if wall.a_low else -OUTER)
        point, along, inward = np.zeros(2), np.zeros(2), np.zeros(2)
        point[1 - axis], point[axis] = line, start
        along[axis] = 1.0
        inward[1 - axis] = -1.0 if wall.a_low else 1.0
        runs.append(Run(names, np.round(point, 4), along, inward, end - start, request.level, wall.vertical))
    return runs


def _face(polygon: NDArray[np.float64], wall: trace.Wall, low: bool) -> tuple[float, float, float] | None:
    """Return (start, end, line) of the polygon's side that faces the wall; `low`: the room lies on its low side."""
    axis = 1 if wall.vertical else 0
    at, middle = wall.at * UNIT, (wall.start + wall.end) / 2 * UNIT
    best: tuple[float, float, float] | None = None
    for p, q in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        if p[1 - axis] != q[1 - axis]:
            continue
        line, start, end = float(p[1 - axis]), float(min(p[axis], q[axis])), float(max(p[axis], q[axis]))
        distance = at - line if low else line - at
        if 0 < distance < 2.5 * OUTER and start < middle < end and (best is None or distance < abs(best[2] - at)):
            best = (start, end, line)
    return best


def _depths(program: FloorProgram) -> dict[str, int]:
    """Return each room's distance from the entrance in openings."""
    depth = {program.entrance.into or program.rooms[0].id: 0}
    frontier = list(depth)
    while frontier:
        room = frontier.pop(0)
        for k in program.links:
            other = k.b if k.a == room else (k.a if k.b == room else None)
            if other is not None and k.kind != "wall" and other not in depth:
                depth[other] = depth[room] + 1
                frontier.append(other)
    return {r.id: depth.get(r.id, 99) for r in program.rooms}


__all__ = ["energy", "solve"]
