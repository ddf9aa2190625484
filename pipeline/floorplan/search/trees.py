"""The constructive starts of one storey: annealed slicing trees in the outline that all storeys share."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pipeline.arrays import Ints
from pipeline.floorplan.program.floor_program import FloorProgram
from pipeline.floorplan.search import slicing
from pipeline.floorplan.search.grid import Labels
from pipeline.floorplan.search.layout import Wishes
from pipeline.floorplan.search.spec import tree
from pipeline.floorplan.search.storeys import Storey

SLICES = 1000  # slicing proposals per room and tree
SLICE_HOT, SLICE_COLD = 8.0, 0.05
LEAST_CUT = 4  # cells


@dataclass
class Effort:
    """What a search took: whole attempts, slicing searches and their proposals, annealing runs and their evaluated proposals."""

    attempts: int = 0
    slicings: int = 0
    sliced: int = 0
    runs: int = 0
    proposals: int = 0


class Outline(NamedTuple):
    """The building's rectangle [cells] that all storeys share, and how many of its corners are cut out."""

    width: int
    height: int
    cuts: int


class Trees:
    """The slicing searches of one storey in its outline: what all of them share."""

    def __init__(self, request: Storey, program: FloorProgram, outline: Outline) -> None:
        n, spec, self.outline = len(request.rooms), request.spec, outline
        self.request = request
        whole = outline.width * outline.height
        spare = whole - request.gross.sum()
        # a storey that is clearly smaller than the outline leaves a corner free
        self.voids = max(outline.cuts, int(spare > 0.1 * whole))
        empty = np.full(self.voids, max(spare, 1.0) / max(self.voids, 1))
        self.gross = np.concatenate([request.gross, empty])
        self.low = np.concatenate([request.gross_low, empty * 0.7])
        self.high = np.concatenate([request.gross_high, empty * 1.3])
        square = np.where(spec.square > 0, 0.6, 0.08) * 2.0**program.style.squareness
        flexible = request.weights.area * 4.0 / n * spec.area_weight * (request.gross_high > request.gross_low)
        pairs = np.argwhere(np.triu((spec.need > 0) | (spec.ban > 0) | (spec.apart > 0), 1))
        one, other = pairs.T
        numbers = np.ascontiguousarray(np.column_stack([pairs, spec.need[one, other], spec.ban[one, other]]))
        edges = tree(spec.link, spec.root)
        self.wishes = Wishes(spec, numbers, spec.apart[one, other], square, edges, self.gross, flexible, request.weights)

    def grow(self, rng: np.random.Generator, length: int, effort: Effort) -> tuple[Labels, float]:
        """Anneal one slicing tree; return its bordered grid and cost (infinite when a cut-out is misplaced)."""
        n, m, spec, (width, height, _) = len(self.request.rooms), self.gross.size, self.request.spec, self.outline
        order = rng.permutation(m)
        expr = np.empty(2 * m - 1, np.int64)
        expr[0] = order[0]
        expr[1::2], expr[2::2] = order[1:], np.where(np.arange(1, m) % 2, slicing.V, slicing.H)
        draws = rng.random((SLICES * m * length, slicing.DRAWS))
        effort.slicings += 1
        effort.sliced += draws.shape[0]
        rects, leaves, nodes = np.zeros((m, 4), np.int64), np.zeros((m, 4), np.int64), np.zeros((2 * m - 1, 7), np.int64)
        scratch = slicing.Scratch(expr.copy(), self.gross.copy(), leaves, nodes, np.zeros(2 * m - 1), np.zeros((n, 4)))
        heats, bounds = (SLICE_HOT, SLICE_COLD), (self.low, self.high)
        cost = slicing.search(expr, draws, heats, (width, height), n, bounds, self.wishes, scratch, rects)
        grid = np.full((height + 2, width + 2), n, np.int16)
        for i, (x0, y0, x1, y1) in enumerate(rects.tolist()):
            grid[y0 + 1 : y1 + 1, x0 + 1 : x1 + 1] = min(i, n)
        cut = rects[n:]
        x0, y0, x1, y1 = cut.T
        corners = ((x0 == 0) != (x1 == width)) & ((y0 == 0) != (y1 == height)) & (np.minimum(x1 - x0, y1 - y0) >= LEAST_CUT)
        if not corners.all() or (self.voids == 2 and not _same_side(cut)):
            return grid, np.inf
        if spec.stair_room >= 0:
            stamp(grid, spec.stair_room, tuple(spec.stair.tolist()), n)
        return grid, float(cost)


def _same_side(cut: Ints) -> bool:
    """Whether two cut-outs lie in different corners of one side, with building between them."""
    (ax0, ay0, ax1, ay1), (bx0, by0, bx1, by1) = cut.tolist()
    across = max(ax0, bx0) - min(ax1, bx1) >= LEAST_CUT and (ay0 == 0) == (by0 == 0)
    along = max(ay0, by0) - min(ay1, by1) >= LEAST_CUT and (ax0 == 0) == (bx0 == 0)
    return bool(across or along)


def rectangle(grid: Labels, room: int) -> tuple[int, int, int, int] | None:
    """Return a room's rectangle (x0, y0, x1, y1) [cells], or None when it is none."""
    ys, xs = np.nonzero(grid[1:-1, 1:-1] == room)
    box = (int(xs.min()), int(ys.min()), int(xs.max()) + 1, int(ys.max()) + 1)
    return box if xs.size == (box[2] - box[0]) * (box[3] - box[1]) else None


def stamp(grid: Labels, room: int, stair: tuple[int, ...], n: int) -> None:
    """Put the staircase where it stands on the other storeys; what it leaves goes to the rooms beside it, cell by cell."""
    x0, y0, x1, y1 = stair
    left = grid == room
    grid[y0 + 1 : y1 + 1, x0 + 1 : x1 + 1] = room
    left[y0 + 1 : y1 + 1, x0 + 1 : x1 + 1] = False
    while left.any():
        before = int(left.sum())
        for y, x in np.argwhere(left).tolist():
            beside = [int(grid[y + dy, x + dx]) for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0)) if not left[y + dy, x + dx]]
            beside = [b for b in beside if b not in {n, room}]
            if beside:
                grid[y, x], left[y, x] = beside[0], False
        if int(left.sum()) == before:
            grid[left] = n
            return
