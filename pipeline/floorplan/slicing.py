"""A constructive start: annealed slicing trees, whose leaves are rectangles of exactly the wanted areas.

A tree is a normalised Polish expression (Wong and Liu, DAC 1986): operands are room indices, `V` puts its two children side by
side, `H` one above the other. Areas are met by construction, so the search is only for the topology: who touches whom.
Units: cells of the grid.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline.geometry.compiled import compiled

V, H = -2, -3
DRAWS = 4  # uniform numbers that one proposal takes

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


@compiled
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
        share = sums[left] / sums[k]
        work[left, 2], work[left, 3], work[left, 4], work[left, 5] = x0, y0, x1, y1
        work[right, 2], work[right, 3], work[right, 4], work[right, 5] = x0, y0, x1, y1
        if expr[k] == V:
            cut = x0 + int((x1 - x0) * share + 0.5)
            if cut <= x0 or cut >= x1:
                return False
            work[left, 4] = cut
            work[right, 2] = cut
        else:
            cut = y0 + int((y1 - y0) * share + 0.5)
            if cut <= y0 or cut >= y1:
                return False
            work[left, 5] = cut
            work[right, 3] = cut
    return True


@compiled
def contact(rect: Ints, a: int, b: int) -> int:
    """Return the length of the wall that two rectangles share [cells]."""
    if rect[a, 2] == rect[b, 0] or rect[b, 2] == rect[a, 0]:
        return int(max(0, min(rect[a, 3], rect[b, 3]) - max(rect[a, 1], rect[b, 1])))
    if rect[a, 3] == rect[b, 1] or rect[b, 3] == rect[a, 1]:
        return int(max(0, min(rect[a, 2], rect[b, 2]) - max(rect[a, 0], rect[b, 0])))
    return 0


@compiled
def _corners(rect: Ints, room: int, width: int, height: int, n: int) -> int:
    """Count the corners of the outline that a rectangle owns: its own corners with the outside, or a void, behind both sides."""
    found = 0
    for k in range(4):
        x, y = rect[room, 2 * (k % 2)], rect[room, 1 + 2 * (k // 2)]
        beside, above = x == (width if k % 2 else 0), y == (height if k // 2 else 0)
        for v in range(n, rect.shape[0]):
            if x == rect[v, 2 - 2 * (k % 2)] and rect[v, 1] < y + (k // 2 == 0) <= rect[v, 3]:
                beside = True
            if y == rect[v, 3 - 2 * (k // 2)] and rect[v, 0] < x + (k % 2 == 0) <= rect[v, 2]:
                above = True
        found += beside and above
    return found


class Wishes(NamedTuple):
    """What the layout of n rooms is scored by; names as in `energy.Spec`, `square` are weights."""

    need: Ints
    ban: Ints
    outside: Ints
    corner: Ints
    least: Ints
    square: Floats
    apart: Floats
    stair: Ints
    stair_room: int
    flight: Ints
    between: Ints
    habitable: Ints
    useful: Ints
    edges: Ints  # (k, 2) room and parent on the ways from the entrance, nearest first
    wanted: Floats  # (m,) areas up to wall centre lines [cells], and
    heed: Floats  # (n,) what missing them costs, for rooms whose area is flexible
    weights: Floats  # (12,) of the terms of `energy`


@compiled
def leaning(rect: Ints, width: int, height: int, n: int, gross: Floats, wishes: Wishes) -> float:
    """Return the weighted terms that the topology decides, as `energy` has them: circulation, exterior, corner_light, useful_area."""
    habitable, useful, edges, weights = wishes.habitable, wishes.useful, wishes.edges, wishes.weights
    m = rect.shape[0]
    lit, wall, corners, own, whole = 0, 0, 0, 0.0, 0.0
    for a in range(n):
        w, h = rect[a, 2] - rect[a, 0], rect[a, 3] - rect[a, 1]
        beside = h * ((rect[a, 0] == 0) + (rect[a, 2] == width)) + w * ((rect[a, 1] == 0) + (rect[a, 3] == height))
        for v in range(n, m):
            beside += contact(rect, a, v)
        wall += beside
        lit += beside * habitable[a]
        if habitable[a] > 0:
            corners += _corners(rect, a, width, height, n)
        own += gross[a] * useful[a]
        whole += gross[a]
    total = 4.0 * weights[5] * (lit / max(wall, 1) - 1.0) ** 2
    total += 4.0 * weights[6] * (corners / (4.0 + m - n) - 1.0) ** 2
    total += 4.0 * weights[8] * (1.0 - own / whole) ** 2
    travel = np.zeros((n, 4))
    detours = 0.0
    for k in range(edges.shape[0]):
        room, parent = edges[k, 0], edges[k, 1]
        straight, length = 0.0, 0.0
        for axis in range(2):
            low, high = max(rect[room, axis], rect[parent, axis]), min(rect[room, axis + 2], rect[parent, axis + 2])
            here = 0.5 * (rect[parent, axis] + rect[parent, axis + 2])
            through = 0.5 * (low + high)
            there = 0.5 * (rect[room, axis] + rect[room, axis + 2])
            ahead = travel[parent, 2 * axis] + max(through - here, 0.0) + max(there - through, 0.0)
            back = travel[parent, 2 * axis + 1] + max(here - through, 0.0) + max(through - there, 0.0)
            travel[room, 2 * axis], travel[room, 2 * axis + 1] = ahead, back
            straight += max(ahead, back)
            length += ahead + back
        if straight > 0.0:
            detours += (length / straight - 1.0) ** 2
    return float(total + 4.0 * weights[0] * detours / max(n - 1, 1))


@compiled
def cost(rect: Ints, width: int, height: int, n: int, gross: Floats, wishes: Wishes) -> float:  # noqa: C901, PLR0912, PLR0915 - compiled
    """Score a layout of rectangles; leaves from `n` on are voids that must lie in a corner. Smaller is better."""
    need, ban, outside, corner, least, square, apart = (
        wishes.need,
        wishes.ban,
        wishes.outside,
        wishes.corner,
        wishes.least,
        wishes.square,
        wishes.apart,
    )
    stair, stair_room, flight, weights = wishes.stair, wishes.stair_room, wishes.flight, wishes.weights
    total = leaning(rect, width, height, n, gross, wishes)
    diagonal = (width * width + height * height) ** 0.5
    m = rect.shape[0]
    for a in range(n):
        w, h = rect[a, 2] - rect[a, 0], rect[a, 3] - rect[a, 1]
        short, long = min(w, h), max(w, h)
        if short < least[a]:
            total += 4.0 + 6.0 * (least[a] - short) / least[a]
        ratio = long / short
        total += square[a] * (ratio - 1.0)
        if ratio > 2.0 and square[a] > 0.2:
            total += 2.0 * (ratio - 2.0)
        off = w * h / gross[a]
        total += 3.0 * (max(off, 1.0 / off) - 1.0)
        if wishes.heed[a] > 0.0:
            off = gross[a] / wishes.wanted[a]
            total += wishes.heed[a] * (max(off, 1.0 / off) - 1.0)
        if outside[a] > 0:
            best = 0
            if rect[a, 0] == 0 or rect[a, 2] == width:
                best = h
            if (rect[a, 1] == 0 or rect[a, 3] == height) and w > best:
                best = w
            for v in range(n, m):
                best = max(best, contact(rect, a, v))
            if best < outside[a]:
                total += 6.0 + 6.0 * (outside[a] - best) / outside[a]
        if corner[a] > 0 and _corners(rect, a, width, height, n) == 0:
            total += 9.0
        for b in range(a + 1, n):
            if need[a, b] > 0:
                run = contact(rect, a, b)
                if run < need[a, b]:
                    gap = max(0, max(rect[a, 0], rect[b, 0]) - min(rect[a, 2], rect[b, 2]))
                    gap += max(0, max(rect[a, 1], rect[b, 1]) - min(rect[a, 3], rect[b, 3]))
                    total += 6.0 + 5.0 * (need[a, b] - run) / need[a, b] + 12.0 * gap / diagonal
            elif ban[a, b] > 0:
                run = contact(rect, a, b)
                if run > 0:
                    total += 5.0 + 0.2 * run
            if apart[a, b] > 0:
                dx = 0.5 * (rect[a, 0] + rect[a, 2] - rect[b, 0] - rect[b, 2])
                dy = 0.5 * (rect[a, 1] + rect[a, 3] - rect[b, 1] - rect[b, 3])
                far = (dx * dx + dy * dy) ** 0.5 / diagonal
                if far < apart[a, b]:
                    total += 3.0 + 30.0 * (apart[a, b] - far)
    for k in range(wishes.between.shape[0]):
        a, b, c = wishes.between[k, 0], wishes.between[k, 1], wishes.between[k, 2]
        ahead = 0.0
        for axis in range(2):
            middle = rect[a, axis] + rect[a, axis + 2]
            ahead += 0.25 * (rect[b, axis] + rect[b, axis + 2] - middle) * (rect[c, axis] + rect[c, axis + 2] - middle)
        if ahead > 0.0:
            total += 3.0 + 10.0 * ahead**0.5 / diagonal
    for v in range(n, m):
        sides = 0
        if (rect[v, 0] == 0) != (rect[v, 2] == width):
            sides += 1
        if (rect[v, 1] == 0) != (rect[v, 3] == height):
            sides += 1
        total += 15.0 * (2 - sides)
        w, h = rect[v, 2] - rect[v, 0], rect[v, 3] - rect[v, 1]
        total += 0.5 * (max(w, h) / min(w, h) - 1.0)
    if stair_room >= 0:
        w = min(rect[stair_room, 2], stair[2]) - max(rect[stair_room, 0], stair[0])
        h = min(rect[stair_room, 3], stair[3]) - max(rect[stair_room, 1], stair[1])
        both = float(max(0, w) * max(0, h))
        own = float((rect[stair_room, 2] - rect[stair_room, 0]) * (rect[stair_room, 3] - rect[stair_room, 1]))
        whole = float((stair[2] - stair[0]) * (stair[3] - stair[1]))
        gap = max(0, -w) + max(0, -h)
        total += n * (2.0 * (both / whole - 1.0) ** 2 + (both / (own + whole - both) - 1.0) ** 2) + 12.0 * gap / diagonal
    elif flight[0] >= 0:
        w, h = rect[flight[0], 2] - rect[flight[0], 0], rect[flight[0], 3] - rect[flight[0], 1]
        both = float(min(max(w, h), flight[1]) * min(w, h, flight[2]))
        whole = float(flight[1] * flight[2])
        total += n * (weights[10] * (both / whole - 1.0) ** 2 + weights[11] * (both / (w * h + whole - both) - 1.0) ** 2)
    return total


@compiled
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


@compiled
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


@compiled
def search(  # noqa: PLR0912 - compiled: loops instead of slices compile faster
    expr: Ints,
    draws: Floats,
    hot: float,
    cold: float,
    width: int,
    height: int,
    n: int,
    gross: Floats,
    low: Floats,
    high: Floats,
    wishes: Wishes,
) -> tuple[Ints, float]:
    """Anneal the tree and the areas of flexible rooms (between `low` and `high`); return the best rectangles and their cost."""
    m = gross.size
    if m == 1:
        only = np.zeros((1, 4), np.int64)
        only[0, 2], only[0, 3] = width, height
        return only, cost(only, width, height, n, gross, wishes)
    rect = np.zeros((m, 4), np.int64)
    best_rect = np.zeros((m, 4), np.int64)
    work = np.zeros((2 * m - 1, 7), np.int64)
    sums = np.zeros(2 * m - 1)
    now = 1e9
    best = 1e9
    trial = expr.copy()
    areas = gross.copy()
    if lay_out(expr, areas, width, height, rect, work, sums):
        now = cost(rect, width, height, n, areas, wishes)
    steps = draws.shape[0]
    for k in range(steps):
        heat = hot * (cold / hot) ** (k / steps)
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
        if good and lay_out(trial, areas, width, height, rect, work, sums):
            new = cost(rect, width, height, n, areas, wishes)
            if new <= now or draws[k, 3] < np.exp((now - new) / heat):
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
    return best_rect, best
