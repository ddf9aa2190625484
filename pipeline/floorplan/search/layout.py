"""What a layout of rectangles, the leaves of a slicing tree, is worth. Units: cells of the grid."""

from typing import NamedTuple

from pipeline.arrays import Floats, Ints
from pipeline.floorplan.search.energy import ZONE_WEIGHT, Terms, overlap, share_error, stair_fit, stair_snug
from pipeline.floorplan.search.spec import Spec
from pipeline.geometry.compiled import borrowing

LONG = 1.8  # ratio of sides from which a room that should be square is penalised as a corridor


@borrowing
def contact(rect: Ints, a: int, b: int) -> int:
    """Return the length of the wall that two rectangles share [cells]."""
    if rect[a, 2] == rect[b, 0] or rect[b, 2] == rect[a, 0]:
        return int(max(0, min(rect[a, 3], rect[b, 3]) - max(rect[a, 1], rect[b, 1])))
    if rect[a, 3] == rect[b, 1] or rect[b, 3] == rect[a, 1]:
        return int(max(0, min(rect[a, 2], rect[b, 2]) - max(rect[a, 0], rect[b, 0])))
    return 0


@borrowing
def _corners(rect: Ints, room: int, width: int, height: int, n: int) -> int:
    """Count the corners of the outline that a rectangle owns: its own corners with the outside, or a void, behind both sides."""
    count = 0
    for k in range(4):
        x, y = rect[room, 2 * (k % 2)], rect[room, 1 + 2 * (k // 2)]
        beside, above = x == (width if k % 2 else 0), y == (height if k // 2 else 0)
        for v in range(n, rect.shape[0]):
            if x == rect[v, 2 - 2 * (k % 2)] and rect[v, 1] < y + (k // 2 == 0) <= rect[v, 3]:
                beside = True
            if y == rect[v, 3 - 2 * (k // 2)] and rect[v, 0] < x + (k % 2 == 0) <= rect[v, 2]:
                above = True
        count += beside and above
    return count


class Wishes(NamedTuple):
    """What the layout of n rooms is scored by, beside the storey's numbers."""

    spec: Spec
    pairs: Ints  # (k, 4) the rooms of which something is asked together: both, and their rows of `need` and `ban`
    far: Floats  # (k,) their row of `apart`
    square: Floats  # (n,) what sides cost that are unlike
    edges: Ints  # (k, 2) room and parent on the ways from the entrance, nearest first
    wanted: Floats  # (m,) areas up to wall centre lines [cells], and
    area_weight: Floats  # (n,) what missing them costs, for rooms whose area is flexible
    weights: Terms


@borrowing
def topology_cost(rect: Ints, width: int, height: int, n: int, gross: Floats, wishes: Wishes, travel: Floats) -> float:
    """Return the weighted terms that the topology decides, as `energy` has them: circulation, exterior, corner_light, useful_area."""
    habitable, useful, edges, weights = wishes.spec.habitable, wishes.spec.useful, wishes.edges, wishes.weights
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
    total = weights.exterior * share_error(lit, max(wall, 1))
    total += weights.corner_light * share_error(corners, 4.0 + m - n)
    total += weights.useful_area * share_error(own, whole)
    for k in range(n):
        for way in range(4):
            travel[k, way] = 0.0
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
    return float(total + 4.0 * weights.circulation * detours / max(n - 1, 1))


@borrowing
def count_wall_lines(rect: Ints) -> int:
    """Count the lines on which walls lie, as term `alignment` does: every line but the last has a rectangle that starts there."""
    count = 2
    for axis in range(2):
        for a in range(rect.shape[0]):
            fresh = 1
            for b in range(a):
                if rect[b, axis] == rect[a, axis]:
                    fresh = 0
                    break
            count += fresh
    return count


@borrowing
def cost(rect: Ints, width: int, height: int, n: int, gross: Floats, wishes: Wishes, most: float, travel: Floats) -> float:
    """Score a layout of rectangles; leaves from `n` on are voids that must lie in a corner. Smaller is better.

    No part is negative: what is beyond `most` already is not looked at further, and only known to be beyond it.
    Each part adds to the running total that it is given, so that the sum is formed in one order.
    """
    diagonal = (width * width + height * height) ** 0.5
    total = _of_pairs(0.0, rect, wishes, diagonal, most)
    if total > most:
        return float(total)
    total = _of_rooms(total, rect, width, height, n, gross, wishes, most)
    if total > most:
        return float(total)
    total = _of_voids(_of_order(total, rect, wishes, diagonal), rect, width, height, n)
    total = _of_stairs(_of_nearness(total, rect, wishes, diagonal), rect, n, wishes, diagonal)
    total += wishes.weights.alignment * count_wall_lines(rect)
    if total > most:
        return float(total)
    return float(total) + topology_cost(rect, width, height, n, gross, wishes, travel)


@borrowing
def _of_pairs(total: float, rect: Ints, wishes: Wishes, diagonal: float, most: float) -> float:
    """Add what rooms cost that lack the wall which they are to share, share one that they may not, or are too close."""
    pairs, far = wishes.pairs, wishes.far
    for k in range(pairs.shape[0]):
        a, b, need = pairs[k, 0], pairs[k, 1], pairs[k, 2]
        across = min(rect[a, 2], rect[b, 2]) - max(rect[a, 0], rect[b, 0])  # negative: a gap
        along = min(rect[a, 3], rect[b, 3]) - max(rect[a, 1], rect[b, 1])
        run = max(across, along) if min(across, along) == 0 else 0
        if run < need:
            total += 11.0 + 8.0 * (need - run) / need + 18.0 * (max(0, -across) + max(0, -along)) / diagonal
        elif pairs[k, 3] > 0 and run > 0:
            total += 8.0 + 0.4 * run
        if far[k] > 0.0:
            dx = 0.5 * (rect[a, 0] + rect[a, 2] - rect[b, 0] - rect[b, 2])
            dy = 0.5 * (rect[a, 1] + rect[a, 3] - rect[b, 1] - rect[b, 3])
            off = (dx * dx + dy * dy) ** 0.5 / diagonal
            if off < far[k]:
                total += 6.0 + 50.0 * (far[k] - off)
        if total > most:
            break
    return total


@borrowing
def _of_rooms(total: float, rect: Ints, width: int, height: int, n: int, gross: Floats, wishes: Wishes, most: float) -> float:
    """Add what rooms cost that are narrow, long, larger or smaller than wanted, or without the outside walls or the corner that they need."""
    spec, square, area_weight, wanted = wishes.spec, wishes.square, wishes.area_weight, wishes.wanted
    least, wide, narrow = spec.strict, spec.least, wishes.weights.min_width * spec.unit * spec.unit
    for a in range(n):
        w, h = rect[a, 2] - rect[a, 0], rect[a, 3] - rect[a, 1]
        short, long = min(w, h), max(w, h)
        if short < least[a]:
            total += 6.0 + 8.0 * (least[a] - short) / least[a]
        ratio = long / short
        total += square[a] * (ratio - 1.0)
        if ratio > LONG and square[a] > 0.2:
            total += 5.0 * (ratio - LONG)
        if short < wide[a]:  # term min_width charges its whole area at once: here as far as it is too narrow, a slope to walk down
            total += 2.0 * narrow * w * h * (wide[a] - short) / wide[a]
        off = w * h / gross[a]
        total += 3.0 * (max(off, 1.0 / off) - 1.0)
        if area_weight[a] > 0.0:
            off = gross[a] / wanted[a]
            total += area_weight[a] * (max(off, 1.0 / off) - 1.0)
        if spec.outside[a] > 0:
            best = _outside(rect, a, width, height, n)
            if best < spec.outside[a]:
                total += 8.0 + 7.0 * (spec.outside[a] - best) / spec.outside[a]
        if spec.corner[a] > 0 and _corners(rect, a, width, height, n) == 0:
            total += 12.0
        if total > most:
            break
    return total


@borrowing
def _outside(rect: Ints, a: int, width: int, height: int, n: int) -> int:
    """Return the longest stretch of outside wall of a rectangle [cells], walls to voids included."""
    w, h = rect[a, 2] - rect[a, 0], rect[a, 3] - rect[a, 1]
    best = max(h * (rect[a, 0] == 0 or rect[a, 2] == width), w * (rect[a, 1] == 0 or rect[a, 3] == height))
    for v in range(n, rect.shape[0]):
        best = max(best, contact(rect, a, v))
    return int(best)


@borrowing
def _of_order(total: float, rect: Ints, wishes: Wishes, diagonal: float) -> float:
    """Add what rooms cost that are not between the two between which they are asked."""
    between = wishes.spec.between
    for k in range(between.shape[0]):
        a, b, c = between[k, 0], between[k, 1], between[k, 2]
        ahead = 0.0
        for axis in range(2):
            middle = rect[a, axis] + rect[a, axis + 2]
            ahead += 0.25 * (rect[b, axis] + rect[b, axis + 2] - middle) * (rect[c, axis] + rect[c, axis + 2] - middle)
        if ahead > 0.0:
            total += 6.0 + 20.0 * ahead**0.5 / diagonal
    return total


@borrowing
def _of_voids(total: float, rect: Ints, width: int, height: int, n: int) -> float:
    """Add what voids cost that are not in a corner, or long."""
    for v in range(n, rect.shape[0]):
        sides = ((rect[v, 0] == 0) != (rect[v, 2] == width)) + ((rect[v, 1] == 0) != (rect[v, 3] == height))
        total += 15.0 * (2 - sides)
        w, h = rect[v, 2] - rect[v, 0], rect[v, 3] - rect[v, 1]
        total += 0.5 * (max(w, h) / min(w, h) - 1.0)
    return total


@borrowing
def _of_nearness(total: float, rect: Ints, wishes: Wishes, diagonal: float) -> float:
    """Add the distances of rooms that belong together."""
    near = wishes.spec.near
    for k in range(near.shape[0]):
        a, b = int(near[k, 0]), int(near[k, 1])
        dx = 0.5 * (rect[a, 0] + rect[a, 2] - rect[b, 0] - rect[b, 2])
        dy = 0.5 * (rect[a, 1] + rect[a, 3] - rect[b, 1] - rect[b, 3])
        total += ZONE_WEIGHT * near[k, 2] * (dx * dx + dy * dy) ** 0.5 / diagonal
    return total


@borrowing
def _of_stairs(total: float, rect: Ints, n: int, wishes: Wishes, diagonal: float) -> float:
    """Add what the staircase costs: off its place on the other storey, or too small for its flights."""
    stair, stair_room, flight, weights = wishes.spec.stair, wishes.spec.stair_room, wishes.spec.flight, wishes.weights
    if stair_room >= 0:
        w = min(rect[stair_room, 2], stair[2]) - max(rect[stair_room, 0], stair[0])
        h = min(rect[stair_room, 3], stair[3]) - max(rect[stair_room, 1], stair[1])
        both = float(max(0, w) * max(0, h))
        own = float((rect[stair_room, 2] - rect[stair_room, 0]) * (rect[stair_room, 3] - rect[stair_room, 1]))
        whole = float((stair[2] - stair[0]) * (stair[3] - stair[1]))
        gap = max(0, -w) + max(0, -h)
        total += n * (2.0 * stair_fit(both, whole) + stair_snug(both, whole, own)) + 12.0 * gap / diagonal
    elif flight[0] >= 0:
        w, h = rect[flight[0], 2] - rect[flight[0], 0], rect[flight[0], 3] - rect[flight[0], 1]
        both = overlap(w, h, flight[1], flight[2])
        whole = float(flight[1] * flight[2])
        total += n * (weights.stair_fit * stair_fit(both, whole) + weights.stair_snug * stair_snug(both, whole, float(w * h)))
    return total
