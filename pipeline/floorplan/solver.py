"""Program → plan: slicing start, annealing, realisation; restarts until every condition holds."""

from typing import NamedTuple

import numpy as np

from pipeline import seeds
from pipeline.entities.plan import Plan
from pipeline.errors import RefusedError
from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.consistency import check
from pipeline.floorplan.program.floor_program import FloorProgram, RoomReq
from pipeline.floorplan.realise.realisation import build
from pipeline.floorplan.search import anneal
from pipeline.floorplan.search.energy import Terms, area, useful_area
from pipeline.floorplan.search.grid import Labels
from pipeline.floorplan.search.storeys import Storey, storey, stretch_storeys
from pipeline.floorplan.search.trees import Effort, Outline, Trees, rectangle

TRIES = 24  # whole attempts before a program is refused
LENGTHS = (1, 1, 2, 2, 4, 4, 4, 4, 8)  # how much longer attempts search
EASE = (3, 4, 7)  # attempts from which what nobody stated is let go, step by step
BOLD, OVERHANG = 12, 0.04  # attempts from which a storey may hang over the one below by more than this share of the outline
SLOT = 3  # cells of outside between two rooms that one can leave free
EASED_ASPECT = 2.2  # of the outline then
STARTS, MOST_STARTS = 4, 9  # slicing trees per attempt: usual, and while all of them lack something
RUNS = 2  # annealing runs per storey and attempt, from the best of these
PROPOSALS, LONGEST = 80, 3  # annealing proposals that are evaluated per room and run; how much longer runs get
DRAWN = 2.5  # how many are drawn at most for one that is evaluated: some change nothing
HOT, COLD, PENALTY = 1.2, 0.01, 40.0


class Solution(NamedTuple):
    """A plan, what finding it took, and its energy terms, summed over storeys."""

    plan: Plan
    effort: Effort
    terms: Terms


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
    program = stretch_storeys(program)
    effort = Effort()
    for attempt in range(TRIES):
        effort.attempts += 1
        rng = seeds.generator(seed, "plan", *keys, attempt)
        outcome = _attempt(program, rng, attempt, effort)
        if outcome is not None:
            return Solution(outcome[0], effort, outcome[1])
    raise RefusedError(
        f"no floor plan found in {TRIES} attempts for {len(program.rooms)} rooms in {program.total_area.target:.0f} m2",
        "ask for fewer links to one room, a larger total area, or drop a separation",
    )


def _attempt(program: FloorProgram, rng: np.random.Generator, attempt: int, effort: Effort) -> tuple[Plan, Terms] | None:
    ease = sum(attempt >= k for k in EASE)
    requests = [storey(program, level, None, ease) for level in range(program.storeys)]
    outline = _outline(program, requests, rng, ease)
    length = LENGTHS[min(attempt, len(LENGTHS) - 1)]
    solved: list[tuple[Storey, Labels]] = []
    terms: list[Terms] = []
    stair: tuple[int, int, int, int] | None = None
    for level in range(program.storeys):
        request = requests[level] if stair is None else storey(program, level, stair, ease)
        layout = _storey_grid(request, program, outline, rng, length, effort)
        if layout is None:
            return None
        grid = layout[0]
        if attempt < BOLD and (_has_slots(grid) or (solved and _hangs(grid, solved[-1]))):
            return None
        terms.append(layout[1])
        if program.storeys > 1 and stair is None:
            stair = rectangle(grid, next(i for i, r in enumerate(request.rooms) if r.type == "staircase"))
            if stair is None:
                return None
        solved.append((request, grid))
    plan = build(program, solved, rng)
    return None if plan is None else (plan, _as_built(terms, plan, solved))


def _as_built(terms: list[Terms], plan: Plan, storeys: list[tuple[Storey, Labels]]) -> Terms:
    """Return the terms, summed over the storeys; those of areas are taken from the plan itself: its walls have left the raster."""
    areas = {r.room_id: r.area for r in plan.rooms}
    built = [(request.spec, np.array([areas[r.id] for r in request.rooms])) for request, _ in storeys]
    return Terms(*(float(sum(values)) for values in zip(*terms, strict=True)))._replace(
        area=sum(area(room_areas, spec.target, spec.area_weight) for spec, room_areas in built),
        useful_area=sum(useful_area(room_areas, spec.useful) for spec, room_areas in built),
    )


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


def _has_slots(grid: Labels) -> bool:
    """Whether rooms stand so close to each other with nothing between that one could only fill it: slots outside of less than three cells."""
    for outside in (grid == grid[0, 0], (grid == grid[0, 0]).T):
        for width in range(1, SLOT):
            between = np.logical_and.reduce([outside[:, k : outside.shape[1] - width - 1 + k] for k in range(1, width + 1)])
            if np.any(between & ~outside[:, : -width - 1] & ~outside[:, width + 1 :]):
                return True
    return False


def _storey_grid(
    request: Storey, program: FloorProgram, outline: Outline, rng: np.random.Generator, length: int, effort: Effort
) -> tuple[Labels, Terms] | None:
    """Return a grid without violations: the best of several annealing runs, each from one of the best slicing trees; and its terms."""
    starts: list[tuple[float, Labels]] = []
    trees = Trees(request, program, outline)
    for trial in range(MOST_STARTS):
        cells, cost = trees.grow(rng, length, effort)
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
    best: tuple[Labels, Terms] | None = None
    least, most = np.inf, PROPOSALS * n * min(length, LONGEST)
    for _, cells in sorted(starts, key=lambda s: s[0])[:RUNS]:
        draws = rng.random((int(DRAWN * most), anneal.DRAWS))
        grid, soft, hard, terms, _, evaluated = anneal.run(cells, request.spec, request.weights, fixed, draws, HOT, COLD, PENALTY, most)
        effort.runs += 1
        effort.proposals += evaluated
        if hard <= 1e-9 and soft < least:
            best, least = (grid, terms), soft
    return best
