"""A constructive start: annealed slicing trees, whose leaves are rectangles of exactly the wanted areas.

A tree is a normalised Polish expression (Wong and Liu, DAC 1986): operands are room indices, `V` puts its two children side by
side, `H` one above the other. Areas are met by construction, so the search is only for the topology: who touches whom.
Units: cells of the grid.
"""

from typing import NamedTuple

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.floorplan.search.layout import Wishes, cost
from pipeline.geometry.compiled import borrowing

V, H = -2, -3
DRAWS = 4  # uniform numbers that one proposal takes


@borrowing
def lay_out(expr: Ints, gross: Floats, width: int, height: int, rect: Ints, work: Ints, sums: Floats) -> bool:
    """Write the rectangle (x0, y0, x1, y1) of each leaf to `rect` (m, 4); False when a leaf would have no width.

    `work` (2m-1, 7) and `sums` (2m-1,) are scratch.
    """
    size = expr.size
    top = 0
    for k in range(size):
        if expr[k] >= 0:
            sums[k] = gross[expr[k]]
        else:
            right = work[top - 1, 6]
            left = work[top - 2, 6]
            work[k, 0] = left
            work[k, 1] = right
            sums[k] = sums[left] + sums[right]
            top -= 2
        work[top, 6] = k
        top += 1
    root = size - 1
    work[root, 2], work[root, 3], work[root, 4], work[root, 5] = 0, 0, width, height
    for k in range(size - 1, -1, -1):
        x0, y0, x1, y1 = work[k, 2], work[k, 3], work[k, 4], work[k, 5]
        if expr[k] >= 0:
            room = expr[k]
            rect[room, 0], rect[room, 1], rect[room, 2], rect[room, 3] = x0, y0, x1, y1
            continue
        left, right = work[k, 0], work[k, 1]
        work[left, 2], work[left, 3], work[left, 4], work[left, 5] = x0, y0, x1, y1
        work[right, 2], work[right, 3], work[right, 4], work[right, 5] = x0, y0, x1, y1
        axis = 0 if expr[k] == V else 1
        low, high = work[k, 2 + axis], work[k, 4 + axis]
        cut = low + int((high - low) * (sums[left] / sums[k]) + 0.5)
        if cut <= low or cut >= high:
            return False
        work[left, 4 + axis] = cut
        work[right, 2 + axis] = cut
    return True


@borrowing
def _valid(expr: Ints) -> bool:
    """Whether every prefix holds more operands than operators and no two equal operators stand side by side."""
    operands = 0
    operators = 0
    for k in range(expr.size):
        if expr[k] >= 0:
            operands += 1
        else:
            operators += 1
            if operators >= operands or (k > 0 and expr[k - 1] == expr[k]):
                return False
    return True


@borrowing
def _mutate(expr: Ints, draws: Floats) -> bool:
    """Change `expr` in place by one move; False when the result would be no normalised expression."""
    size = expr.size
    i = int(draws[1] * size)
    if draws[0] < 0.45:  # swap two rooms
        j = int(draws[2] * size)
        while expr[i] < 0:
            i = (i + 1) % size
        while expr[j] < 0 or j == i:
            j = (j + 1) % size
        expr[i], expr[j] = expr[j], expr[i]
        return True
    if draws[0] < 0.65:  # complement a chain of cuts
        while expr[i] >= 0:
            i = (i + 1) % size
        while i > 0 and expr[i - 1] < 0:
            i -= 1
        while i < size and expr[i] < 0:
            expr[i] = V if expr[i] == H else H
            i += 1
        return True
    # move an element to another place: reshapes the tree
    j = int(draws[2] * size)
    element = expr[i]
    step = 1 if j > i else -1
    if draws[0] < 0.85:
        j = min(max(i + step, 0), size - 1)
    k = i
    while k != j:
        expr[k] = expr[k + step]
        k += step
    expr[j] = element
    return _valid(expr)


class Scratch(NamedTuple):
    """What a search of m leaves, n of them rooms, works on."""

    trial: Ints  # (2m-1,) the proposed expression
    areas: Floats  # (m,) areas as they are now
    rect: Ints  # (m, 4) rectangles of the proposal
    nodes: Ints  # (2m-1, 7) and
    sums: Floats  # (2m-1,) as `lay_out` wants them
    travel: Floats  # (n, 4) as `topology_cost` wants it


@borrowing
def search(  # noqa: PLR0912 - compiled: loops instead of slices compile faster
    expr: Ints,
    draws: Floats,
    heats: tuple[float, float],
    outline: tuple[int, int],
    n: int,
    bounds: tuple[Floats, Floats],
    wishes: Wishes,
    scratch: Scratch,
    best_rect: Ints,
) -> float:
    """Anneal the tree and the areas of flexible rooms, between both bounds; write the best rectangles (m, 4) and return their cost.

    `expr` ends as the last tree.
    """
    hot, cold = heats
    width, height = outline
    low, high = bounds
    trial, areas, rect, nodes, sums, travel = scratch
    m = areas.size
    if m == 1:
        best_rect[0, 2], best_rect[0, 3] = width, height
        return cost(best_rect, width, height, n, areas, wishes, np.inf, travel)
    now = 1e9
    best = 1e9
    if lay_out(expr, areas, width, height, rect, nodes, sums):
        now = cost(rect, width, height, n, areas, wishes, np.inf, travel)
    steps = draws.shape[0]
    for k in range(steps):
        for i in range(expr.size):
            trial[i] = expr[i]
        room = -1
        old = 0.0
        if draws[k, 0] > 0.94:
            room = int(draws[k, 1] * m)
            old = areas[room]
            areas[room] = low[room] + (high[room] - low[room]) * draws[k, 2]
            good = high[room] > low[room]
        else:
            good = _mutate(trial, draws[k])
        if good and lay_out(trial, areas, width, height, rect, nodes, sums):
            # the draw says how much worse the proposal may be
            heat = hot * (cold / hot) ** (k / steps)
            most = now - heat * np.log(draws[k, 3] + 1e-300)
            new = cost(rect, width, height, n, areas, wishes, most, travel)
            if new <= most:
                now = new
                for i in range(expr.size):
                    expr[i] = trial[i]
                room = -1
                if new < best:
                    best = new
                    for i in range(m):
                        for j in range(4):
                            best_rect[i, j] = rect[i, j]
        if room >= 0:
            areas[room] = old
    return best
