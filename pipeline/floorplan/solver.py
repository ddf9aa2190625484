"""Program → plan: slicing start, annealing, straightened lines, openings; restarts until every condition holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline import seeds
from pipeline.entities.plan import Plan, Room
from pipeline.errors import RefusedError
from pipeline.floorplan import anneal, lines, slicing, trace
from pipeline.floorplan.chamfers import chamfered
from pipeline.floorplan.check import check
from pipeline.floorplan.completion import complete
from pipeline.floorplan.defaults import OUTSIDE
from pipeline.floorplan.energy import TERMS, area, tree, useful_area
from pipeline.floorplan.grid import Halves, Labels
from pipeline.floorplan.openings import Run, place
from pipeline.floorplan.program import FloorProgram, RoomReq
from pipeline.floorplan.stairwell import rectangle, stamp
from pipeline.floorplan.storeys import EDGE, UNIT, Storey, founded, storey

TRIES = 24  # whole attempts before a program is refused
LENGTHS = (1, 1, 2, 2, 4, 4, 4, 4, 8)  # how much longer attempts search
EASE = (3, 4, 7)  # attempts from which what nobody stated is let go, step by step
BOLD, OVERHANG = 12, 0.04  # attempts from which a storey may hang over the one below by more than this share of the outline
SLOT = 3  # cells of outside between two rooms that one can leave free
EASED_ASPECT = 2.2  # of the outline then
STARTS, MOST_STARTS = 4, 9  # slicing trees per attempt: usual, and while all of them lack something
RUNS = 2  # annealing runs per storey and attempt, from the best of these
SLICES = 700  # slicing proposals per room and start
PROPOSALS, LONGEST = 180, 3  # annealing proposals per room and run; how much longer runs get
HOT, COLD, PENALTY = 1.2, 0.01, 40.0
SHARES = (1.0, 0.4, 0.0)  # how much of their freedom the walls' lines use; less when openings then find no place
LEAST_CUT = 4  # cells
HALL_TRUST = 0.02  # how much the lines care for the area of an unstated hallway, beside that of a room
STOREY_HEIGHT, CEILING = 3.0, 0.3  # floor to floor at least, thickness of what lies between [m]
SLICE_HOT, SLICE_COLD = 6.0, 0.05


@dataclass
class Effort:
    """What a search took: whole attempts, slicing searches and their proposals, annealing runs and their evaluated proposals."""

    attempts: int = 0
    slicings: int = 0
    sliced: int = 0
    runs: int = 0
    proposals: int = 0


class Solution(NamedTuple):
    """A plan, what finding it took, and its twelve energy terms (12,), summed over storeys."""

    plan: Plan
    effort: Effort
    terms: NDArray[np.float64]


def solve(program: FloorProgram, seed: int, keys: tuple[int, ...] = ()) -> Plan:
    """Return a plan that meets every hard condition of the program; the same for the same (program, seed, keys).

    Raises RefusedError when the program contradicts itself or no attempt meets it.
    """
    return search(program, seed, keys).plan


def warm() -> Plan:
    """Plan a studio, so that all kernels of planning are compiled and in the cache: before workers start, which would each compile them."""
    return solve(FloorProgram(rooms=(RoomReq(id="room", type="studio_room"), RoomReq(id="bath", type="bathroom"))), 0)


def search(program: FloorProgram, seed: int, keys: tuple[int, ...] = ()) -> Solution:
    """Return what `solve` returns, and the effort."""
    program = complete(program)
    check(program)
    program = founded(program)
    effort = Effort()
    for attempt in range(TRIES):
        effort.attempts += 1
        rng = seeds.generator(seed, "plan", *keys, attempt)
        made = _attempt(program, rng, attempt, effort)
        if made is not None:
            return Solution(made[0], effort, made[1])
    raise RefusedError(
        f"no floor plan found in {TRIES} attempts for {len(program.rooms)} rooms in {program.total_area.target:.0f} m2",
        "ask for fewer links to one room, a larger total area, or drop a separation",
    )


class Outline(NamedTuple):
    """The building's rectangle [cells] that all storeys share, and how many of its corners are cut out."""

    width: int
    height: int
    cuts: int


def _attempt(program: FloorProgram, rng: np.random.Generator, attempt: int, effort: Effort) -> tuple[Plan, NDArray[np.float64]] | None:
    ease = sum(attempt >= k for k in EASE)
    requests = [storey(program, level, None, ease) for level in range(program.storeys)]
    outline = _outline(program, requests, rng, ease)
    length = LENGTHS[min(attempt, len(LENGTHS) - 1)]
    solved: list[tuple[Storey, Labels]] = []
    terms = np.zeros(len(TERMS))
    stair: tuple[int, int, int, int] | None = None
    for level in range(program.storeys):
        request = requests[level] if stair is None else storey(program, level, stair, ease)
        made = _storey_grid(request, program, outline, rng, length, effort)
        if made is None:
            return None
        grid = made[0]
        if attempt < BOLD and (_slotted(grid) or (solved and _hangs(grid, solved[-1]))):
            return None
        terms += made[1]
        if program.storeys > 1 and stair is None:
            stair = rectangle(grid, next(i for i, r in enumerate(request.rooms) if r.type == "staircase"))
            if stair is None:
                return None
        solved.append((request, grid))
    plan = _build(program, solved, rng)
    return None if plan is None else (plan, _as_built(terms, plan, solved))


def _as_built(terms: NDArray[np.float64], plan: Plan, storeys: list[tuple[Storey, Labels]]) -> NDArray[np.float64]:
    """Return the terms with those of areas taken from the plan itself: its walls have left the raster."""
    areas = {r.room_id: r.area for r in plan.rooms}
    found = terms.copy()
    found[[TERMS.index("area"), TERMS.index("useful_area")]] = 0.0
    for request, _ in storeys:
        spec, made = request.spec, np.array([areas[r.id] for r in request.rooms])
        found[TERMS.index("area")] += area(made, spec.target, spec.heed)
        found[TERMS.index("useful_area")] += useful_area(made, spec.useful)
    return found


def _outline(program: FloorProgram, requests: list[Storey], rng: np.random.Generator, ease: int = 0) -> Outline:
    """Draw the building's rectangle: large enough for the largest storey and for what is cut out of its corners."""
    shape = program.footprint.shape
    if shape == "any":
        shape = ("rectangle", "L", "T")[int(rng.integers(3))]
    cuts = {"rectangle": 0, "L": 1, "T": 2}[shape]
    low = max(program.footprint.min_aspect * (1.03 if program.footprint.stated else 1.0), 1.0)
    high = max(program.footprint.max_aspect, low)
    if ease and not program.footprint.stated:
        high = max(high, EASED_ASPECT)
    aspect = np.exp(rng.uniform(np.log(low), np.log(high)))
    whole = max(r.gross.sum() for r in requests) * (1.0 + (0.16, 0.2)[cuts - 1] * (cuts > 0))
    width = max(round(float(whole * aspect) ** 0.5), 2)
    return Outline(width, max(round(float(whole / width)), 2), cuts)


def _hangs(grid: Labels, below: tuple[Storey, Labels]) -> bool:
    """Whether much of a storey has nothing under it."""
    bare = below[1] == len(below[0].rooms)
    return bool(np.sum((grid != grid[0, 0]) & bare) > OVERHANG * grid.size)


def _slotted(grid: Labels) -> bool:
    """Whether rooms stand so close to each other with nothing between that one could only fill it: slots outside of less than three cells."""
    for outside in (grid == grid[0, 0], (grid == grid[0, 0]).T):
        for width in range(1, SLOT):
            between = np.logical_and.reduce([outside[:, k : outside.shape[1] - width - 1 + k] for k in range(1, width + 1)])
            if np.any(between & ~outside[:, : -width - 1] & ~outside[:, width + 1 :]):
                return True
    return False


def _storey_grid(
    request: Storey, program: FloorProgram, outline: Outline, rng: np.random.Generator, length: int, effort: Effort
) -> tuple[Labels, NDArray[np.float64]] | None:
    """Return a grid without violations: the best of several annealing runs, each from one of the best slicing trees; and its terms."""
    starts: list[tuple[float, Labels]] = []
    for trial in range(MOST_STARTS):
        cells, cost = _slice(request, program, outline, rng, length, effort)
        if np.isfinite(cost):
            soft, hard, _ = anneal.score(cells, request.spec, request.weights, 0.0)
            starts.append((soft + PENALTY * min(hard, 10.0 if request.spec.stair_room >= 0 else np.inf), cells))
        # annealing mends small things, not a missing neighbour
        if trial >= STARTS - 1 and starts and min(s[0] for s in starts) < PENALTY:
            break
    n = len(request.rooms)
    fixed = np.zeros(n + 1, np.int64)
    if request.spec.stair_room >= 0:
        fixed[request.spec.stair_room] = 1
    best: tuple[Labels, NDArray[np.float64]] | None = None
    least = np.inf
    for _, cells in sorted(starts, key=lambda s: s[0])[:RUNS]:
        draws = rng.random((PROPOSALS * n * min(length, LONGEST), anneal.DRAWS))
        grid, soft, hard, terms, _, evaluated = anneal.run(cells, request.spec, request.weights, fixed, draws, HOT, COLD, PENALTY)
        effort.runs += 1
        effort.proposals += evaluated
        if hard <= 1e-9 and soft < least:
            best, least = (grid, terms), soft
    return best


def _slice(
    request: Storey, program: FloorProgram, outline: Outline, rng: np.random.Generator, length: int, effort: Effort
) -> tuple[Labels, float]:
    """Anneal one slicing tree in the outline; return its bordered grid and cost (infinite when a cut-out is misplaced)."""
    n, spec, width, height = len(request.rooms), request.spec, outline.width, outline.height
    spare = width * height - request.gross.sum()
    # a storey that is clearly smaller than the outline leaves a corner free
    voids = max(outline.cuts, int(spare > 0.1 * width * height))
    empty = np.full(voids, max(spare, 1.0) / max(voids, 1))
    gross = np.concatenate([request.gross, empty])
    m = n + voids
    order = rng.permutation(m)
    expr = np.empty(2 * m - 1, np.int64)
    expr[0] = order[0]
    for k in range(1, m):
        expr[2 * k - 1] = order[k]
        expr[2 * k] = slicing.V if k % 2 else slicing.H
    draws = rng.random((SLICES * m * length, slicing.DRAWS))
    square = np.where(spec.square > 0, 0.6, 0.08) * 2.0**program.style.squareness
    low = np.concatenate([request.gross_low, empty * 0.7])
    high = np.concatenate([request.gross_high, empty * 1.3])
    flexible = request.weights[1] * 4.0 / n * spec.heed * (request.gross_high > request.gross_low)
    wishes = slicing.Wishes(
        spec.need, spec.ban, spec.outside, spec.corner, spec.strict, square, spec.apart, spec.stair, spec.stair_room, spec.flight, spec.between,
        spec.habitable, spec.useful, tree(spec.link, spec.root), gross, flexible, request.weights,
    )  # fmt: skip
    effort.slicings += 1
    effort.sliced += draws.shape[0]
    rects, cost = slicing.search(expr, draws, SLICE_HOT, SLICE_COLD, width, height, n, gross, low, high, wishes)
    grid = np.full((height + 2, width + 2), n, np.int16)
    for i, (x0, y0, x1, y1) in enumerate(rects.tolist()):
        grid[y0 + 1 : y1 + 1, x0 + 1 : x1 + 1] = min(i, n)
    cut = rects[n:]
    corners = [
        (x0 == 0) != (x1 == width) and (y0 == 0) != (y1 == height) and min(x1 - x0, y1 - y0) >= LEAST_CUT for x0, y0, x1, y1 in cut.tolist()
    ]
    if not all(corners) or (voids == 2 and not _same_side(cut)):
        return grid, np.inf
    if spec.stair_room >= 0:
        stamp(grid, spec.stair_room, tuple(spec.stair.tolist()), n)
    return grid, float(cost)


def _same_side(cut: NDArray[np.int64]) -> bool:
    """Whether two cut-outs lie in different corners of one side, with building between them."""
    (ax0, ay0, ax1, ay1), (bx0, by0, bx1, by1) = cut.tolist()
    across = max(ax0, bx0) - min(ax1, bx1) >= LEAST_CUT and (ay0 == 0) == (by0 == 0)
    along = max(ay0, by0) - min(ay1, by1) >= LEAST_CUT and (ax0 == 0) == (bx0 == 0)
    return bool(across or along)


def _build(program: FloorProgram, storeys: list[tuple[Storey, Labels]], rng: np.random.Generator) -> Plan | None:
    """Turn the grids into rooms and openings; None when an opening finds no place."""
    depth = _depths(program)
    flights = _flights(storeys)
    draw = rng.bit_generator.state
    for share in SHARES:
        rng.bit_generator.state = draw
        rooms: list[Room] = []
        runs: list[Run] = []
        for request, grid in storeys:
            _realise(program, request, grid, share, rooms, runs, flights)
        if not _within(program, storeys, rooms):
            continue
        openings = place(program, rooms, runs, depth, rng)
        if openings is not None:
            shell, entrance = program.shell, program.entrance.into or rooms[0].room_id
            storey_height = max(STOREY_HEIGHT, shell.ceiling + CEILING)
            plan = Plan(tuple(rooms), openings, entrance, shell.inner_wall, shell.outer_wall, round(storey_height, 3))
            if program.footprint.corners == "plain":
                return plan
            return chamfered(program, plan, lambda made: _within(program, storeys, made))
    return None


def _flights(storeys: list[tuple[Storey, Labels]]) -> list[bool]:
    """Return which sides of a staircase have a room behind them on any storey: it is one room, and its walls stand above each other."""
    found: list[list[bool]] = []
    for request, grid in storeys if len(storeys) > 1 else []:
        room = next(i for i, r in enumerate(request.rooms) if r.type == "staircase")
        found.append(_inner_sides(grid, trace.outline(grid, room), len(request.rooms)))
    return [any(sides) for sides in zip(*found, strict=True)]


def _realise(
    program: FloorProgram, request: Storey, grid: Labels, share: float, rooms: list[Room], runs: list[Run], flights: list[bool]
) -> None:
    """Append a storey's rooms and the stretches of wall that openings can stand in; lines move by `share` of what they may."""
    spec, n = request.spec, len(request.rooms)
    corners = [trace.outline(grid, i) for i in range(n)]
    sides = [flights if flights and r.type == "staircase" else _inner_sides(grid, corners[i], n) for i, r in enumerate(request.rooms)]
    found = lines.find(grid, UNIT)
    tight = np.array([r.type == "hallway" or r.min_width is not None for r in request.rooms])
    slack = np.where(tight, (spec.strict * UNIT - request.clear) / 2, lines.FARTHEST)
    trust = np.where(np.array([r.type in {"hallway", "entry"} and not r.area.stated for r in request.rooms]), HALL_TRUST, 1.0)
    held = np.zeros(found.at.size, dtype=bool)
    for i in (i for i, r in enumerate(request.rooms) if r.type == "staircase"):
        held |= lines.outer(found, grid, n)  # outside walls and stairs stand above each other
        held[lines.corner_lines(found, corners[i])] = True
    at = lines.fit(found, corners, sides, spec.target, trust, np.maximum(slack, 0.0), held, share, spec.half)
    for i, room in enumerate(request.rooms):
        if room.type == "staircase" and request.level > 0:
            continue  # one room with its lowest level
        polygon = np.round(trace.faces(corners[i], at[lines.corner_lines(found, corners[i])], sides[i], spec.half), 3)
        rooms.append(Room(room.id, room.type, polygon, request.level, program.shell.ceiling, room.role))
    runs += _runs(request, trace.walls(grid, n), rooms, found, at)


def _within(program: FloorProgram, storeys: list[tuple[Storey, Labels]], rooms: list[Room]) -> bool:
    """Whether the rooms' true areas keep every bound."""
    area = {r.room_id: r.area for r in rooms}
    for request, _ in storeys:
        spec = request.spec
        areas = np.array([area[r.id] for r in request.rooms])
        if np.any(areas < spec.low / (1 + EDGE)) or np.any(areas > spec.high * (1 + EDGE)):
            return False
        if np.any(areas[:, None] * (1 + EDGE) < spec.order * areas[None, :]):
            return False
    wish = program.total_area
    inside = sum(r.area for r in rooms if r.type not in OUTSIDE)
    return not wish.stated or (wish.min or 0.0) <= inside <= (wish.max or np.inf)


def _inner_sides(grid: Labels, corners: trace.Corners, n: int) -> list[bool]:
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


def _runs(request: Storey, walls: list[trace.Wall], rooms: list[Room], found: lines.Lines, at: NDArray[np.float64]) -> list[Run]:
    """Return the stretches of wall that openings can stand in: where both rooms' inner faces lie opposite each other."""
    by_id, half = {r.room_id: r for r in rooms}, request.spec.half
    runs: list[Run] = []
    for wall in walls:
        names = (request.rooms[wall.a].id,) + ((request.rooms[wall.b].id,) if wall.b >= 0 else ())
        axis = 1 if wall.vertical else 0
        line = float(at[found.upright[wall.start, wall.at] if wall.vertical else found.level[wall.at, wall.start]])
        ends = [_crossing(found, at, wall, k) for k in (wall.start, wall.end)]
        middle = (ends[0] + ends[1]) / 2
        lows = (wall.a_low, not wall.a_low)
        faces = [_face(by_id[name].polygon, axis, line, middle, low, half) for name, low in zip(names, lows, strict=False)]
        if any(f is None for f in faces):
            continue
        spans = [f for f in faces if f is not None]
        start, end = max(f[0] for f in spans), min(f[1] for f in spans)
        if len(spans) == 1:  # a face may run on behind a room that the wall turns to
            start, end = max(start, ends[0] + half.inner), min(end, ends[1] - half.inner)
            line = spans[0][2] + (half.outer if wall.a_low else -half.outer)
        if end - start < 0.5:
            continue
        point, along, inward = np.zeros(2), np.zeros(2), np.zeros(2)
        point[1 - axis], point[axis] = line, start
        along[axis] = 1.0
        inward[1 - axis] = -1.0 if wall.a_low else 1.0
        thick = half.inner if len(spans) == 2 else half.outer
        runs.append(Run(names, np.round(point, 3), along, inward, round(end - start, 3), request.level, wall.vertical, thick))
    return runs


def _crossing(found: lines.Lines, at: NDArray[np.float64], wall: trace.Wall, k: int) -> float:
    """Return the coordinate [m] at which a wall's stretch ends: that of the line that meets it there."""
    beside = found.level[k] if wall.vertical else found.upright[:, k]
    ids = [beside[i] for i in (wall.at - 1, wall.at) if 0 <= i < beside.size and beside[i] >= 0]
    return float(at[ids[0]]) if ids else k * UNIT


def _face(
    polygon: NDArray[np.float64], axis: int, line: float, middle: float, low: bool, half: Halves
) -> tuple[float, float, float] | None:
    """Return (start, end, line) of the polygon's side that faces a wall; `low`: the room lies on its low side."""
    for p, q in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        if p[1 - axis] != q[1 - axis]:
            continue
        face, start, end = float(p[1 - axis]), float(min(p[axis], q[axis])), float(max(p[axis], q[axis]))
        distance = line - face if low else face - line
        if 0.5 * min(half) < distance < 1.5 * max(half) and start < middle < end:
            return start, end, face
    return None


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
