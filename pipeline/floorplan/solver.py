"""Program → plan: slicing start, annealing, realisation; restarts until every condition holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline import seeds
from pipeline.entities.plan import Plan
from pipeline.errors import RefusedError
from pipeline.floorplan import anneal, slicing
from pipeline.floorplan.check import check
from pipeline.floorplan.completion import complete
from pipeline.floorplan.energy import TERMS, area, tree, useful_area
from pipeline.floorplan.grid import Labels
from pipeline.floorplan.layout import Wishes
from pipeline.floorplan.program import FloorProgram, RoomReq
from pipeline.floorplan.realisation import build
from pipeline.floorplan.stairwell import rectangle, stamp
from pipeline.floorplan.storeys import Storey, founded, storey

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
LEAST_CUT = 4  # cells
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
    plan = build(program, solved, rng)
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
    pairs = np.argwhere(np.triu((spec.need > 0) | (spec.ban > 0) | (spec.apart > 0), 1))
    one, other = pairs.T
    wishes = Wishes(
        np.column_stack([pairs, spec.need[one, other], spec.ban[one, other]]), spec.apart[one, other], spec.outside, spec.corner, spec.strict,
        square, spec.stair, spec.stair_room, spec.flight, spec.between, spec.habitable, spec.useful, tree(spec.link, spec.root), spec.near,
        gross, flexible, request.weights,
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
