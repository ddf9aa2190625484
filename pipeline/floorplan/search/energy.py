"""The twelve energy terms of a floor plan, and the measure of what must not be violated.

Terms, names and forms follow the twelve weights of Infinigen's room solver (v1.7.0), of which the paper's "twelve reward
functions" are the best reading; ours differ where said: areas are absolute, not shares, and each term is normalised so that one
set of weights serves homes of any size. Each term is a pure function of the plan's measures; smaller is better; 0 is ideal
except for `alignment`.
"""

from typing import NamedTuple

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.floorplan.search.grid import Labels, Measures, ell_opening, hull_area, inner_area, notch_width, opening, simple
from pipeline.floorplan.search.spec import Spec
from pipeline.geometry.compiled import borrowing


class Terms(NamedTuple):
    """A number for each term: its value in a plan, or its weight; the usual weights where none is given.

    A new term is a function below, a line here and in `terms`, and its knob in `program.floor_program.Style`.
    """

    circulation: float = 5.0
    area: float = 24.0
    squareness: float = 1.6
    convexity: float = 40.0
    simplicity: float = 2.4
    exterior: float = 2.0
    corner_light: float = 1.0
    alignment: float = 0.5
    useful_area: float = 10.0
    min_width: float = 0.5
    stair_fit: float = 12.0
    stair_snug: float = 8.0


TERMS = Terms._fields
NOTHING = Terms(*(0.0,) * len(TERMS))
TONGUE = 0.76  # m between inner faces: no part of a room is narrower
ZONE_WEIGHT = 12.0  # weight of what belongs together, beside the twelve
SLIM, STEEP = 2.2, 4.0  # ratio of sides from which on a room is a corridor, and how much more it costs then
SPLIT = 4.5  # m2 charged when a room falls apart at a neck; the legacy solver charges 45 in its units of 0.25 m2 x 0.4


@borrowing
def weighted_sum(values: Terms, weights: Terms) -> float:
    """Return the sum of terms times weights."""
    total = 0.0
    for k in range(len(values)):
        total += values[k] * weights[k]
    return total


@borrowing
def share_error(own: float, whole: float) -> float:
    """Return (own share of the whole - 1)^2: the form of the terms 6, 7 and 9."""
    return (own / whole - 1.0) ** 2 * 4.0


@borrowing
def circulation(out: Measures, edges: Ints) -> float:
    """Term 1: ways from the entrance that double back.

    Mean over rooms of (|D|_1 / (max(D_right, D_left) + max(D_up, D_down)) - 1)^2, where D is the travel in the four directions
    along the tree of links, each hop from centroid to the middle of the common wall to centroid.
    """
    n = out.cells.size - 1
    travel = out.travel
    for way in range(4):
        for room in range(n):
            travel[room, way] = 0.0
    total = 0.0
    for k in range(edges.shape[0]):
        room, parent = edges[k, 0], edges[k, 1]
        for way in range(4):
            travel[room, way] = travel[parent, way]
        if out.run[room, parent] == 0:
            continue
        straight, whole = 0.0, 0.0
        for axis in range(2):
            through = out.middle[parent, room, axis]
            for leg in range(2):
                step = through - out.centre[parent, axis] if leg == 0 else out.centre[room, axis] - through
                travel[room, 2 * axis + (step < 0.0)] += abs(step)
            ahead, back = travel[room, 2 * axis], travel[room, 2 * axis + 1]
            straight += max(ahead, back)
            whole += ahead + back
        if straight > 0.0:
            total += (whole / straight - 1.0) ** 2
    return total / max(n - 1, 1) * 4.0


@borrowing
def area(areas: Floats, target: Floats, area_weight: Floats) -> float:
    """Term 2: mean over rooms of max(q, 1/q) - 1 with q = inner area / target (absolute, unlike the legacy shares).

    Rooms count as `area_weight` says: corridors of no stated area take what is left.
    """
    total = 0.0
    for i in range(target.size):
        q = max(areas[i], 0.05) / target[i]
        total += area_weight[i] * (max(q, 1.0 / q) - 1.0)
    return total / target.size * 4.0


@borrowing
def squareness(box: Ints, square: Ints) -> float:
    """Term 3: mean over square types of q - 1 with q = max(w/h, h/w) of the bounding box; what is beyond SLIM counts STEEP times more."""
    total, count = 0.0, 0
    for i in range(square.size):
        if square[i] > 0:
            w, h = box[i, 2] - box[i, 0], box[i, 3] - box[i, 1]
            ratio = max(w, h) / max(min(w, h), 1)
            total += ratio - 1.0 + STEEP * max(ratio - SLIM, 0.0)
            count += 1
    return total / max(count, 1) * 4.0


@borrowing
def convexity(shape: Floats, cells: Ints) -> float:
    """Term 4: mean over rooms of (hull area / area - 1)^2; hull areas in column 0."""
    n = shape.shape[0]
    total = 0.0
    for i in range(n):
        total += (shape[i, 0] / max(cells[i], 1) - 1.0) ** 2
    return float(total / n * 4.0)


@borrowing
def simplicity(corners: Ints, n: int) -> float:
    """Term 5: mean over rooms of (vertices / 4 - 1)^2; an L-shaped room counts 0.25."""
    total = 0.0
    for i in range(n):
        total += ((corners[i, 0] + corners[i, 1]) / 4.0 - 1.0) ** 2
    return total / n * 4.0


@borrowing
def exterior(walls: Ints, habitable: Ints) -> float:
    """Term 6: (share of the outline that habitable rooms own - 1)^2."""
    n = habitable.size
    own, whole = 0, 0
    for i in range(n):
        whole += walls[i, n]
        own += walls[i, n] * habitable[i]
    return share_error(own, max(whole, 1))


@borrowing
def corner_light(outline_corners: Ints, habitable: Ints) -> float:
    """Term 7: (share of the outline's convex corners that habitable rooms own - 1)^2."""
    own, whole = 0, 0
    for i in range(habitable.size):
        whole += outline_corners[i]
        own += outline_corners[i] * habitable[i]
    return share_error(own, max(whole, 1))


@borrowing
def alignment(columns: Ints, rows: Ints) -> float:
    """Term 8: number of distinct lines on which walls lie."""
    total = 0
    for k in range(columns.size):
        total += columns[k]
    for k in range(rows.size):
        total += rows[k]
    return float(total)


@borrowing
def useful_area(areas: Floats, useful: Ints) -> float:
    """Term 9: (share of the area that is useful - 1)^2."""
    own, whole = 0.0, 0.0
    for i in range(areas.size):
        own += areas[i] * useful[i]
        whole += areas[i]
    return share_error(own, max(whole, 1e-9))


@borrowing
def min_width(shape: Floats) -> float:
    """Term 10: area [m2] that squares of half and of the whole wanted width miss (column 1), and a charge per room that splits (2)."""
    total = 0.0
    for i in range(shape.shape[0]):
        total += shape[i, 1] + SPLIT * shape[i, 2]
    return total


@borrowing
def overlap(w: int, h: int, long: int, short: int) -> float:
    """Cells that a staircase of w x h shares with the rectangle of its flights, laid into it as well as it goes."""
    return float(min(max(w, h), long) * min(w, h, short))


@borrowing
def stair_fit(both: float, stair: float) -> float:
    """Term 11: (share of the flights' rectangle that the staircase covers - 1)^2."""
    return (both / max(stair, 1.0) - 1.0) ** 2


@borrowing
def stair_snug(both: float, stair: float, own: float) -> float:
    """Term 12: (IoU of staircase and the flights' rectangle - 1)^2."""
    return (both / max(own + stair - both, 1.0) - 1.0) ** 2


@borrowing
def zone_spread(out: Measures, near: Floats) -> float:
    """Return what zones ask for, weighted: distances of centroids / diagonal, meant over each zone's pairs."""
    total = 0.0
    for k in range(near.shape[0]):
        a, b = int(near[k, 0]), int(near[k, 1])
        dx, dy = out.centre[a, 0] - out.centre[b, 0], out.centre[a, 1] - out.centre[b, 1]
        total += near[k, 2] * (dx * dx + dy * dy) ** 0.5
    if total == 0.0:
        return 0.0
    width, height = out.columns.size - 1, out.rows.size - 1
    return float(ZONE_WEIGHT * total / (width * width + height * height) ** 0.5)


@borrowing
def room_shape(grid: Labels, out: Measures, spec: Spec, i: int, shape: Floats) -> None:  # noqa: PLR0912 - compiled
    """Write what depends on the cells of room i alone to `shape[i]`: hull [cells], area missed [m2], 1 if it splits, violation."""
    w, h = out.box[i, 2] - out.box[i, 0], out.box[i, 3] - out.box[i, 1]
    cells = out.cells[i]
    square_metre = spec.unit * spec.unit
    half = (spec.least[i] + 1) // 2
    shape[i, 2] = 0.0
    shape[i, 3] = 0.0
    if cells == w * h:
        shape[i, 0] = float(cells)
        short = min(w, h)
        shape[i, 1] = square_metre * cells * ((short < spec.least[i]) + (short < half))
        if short < spec.strict[i]:
            shape[i, 3] = 0.5 + (spec.strict[i] - short) / spec.strict[i]
        return
    notch = 0
    if out.corners[i, 1] == 1:
        notch = notch_width(grid, i, out.box)
        shape[i, 0] = cells + 0.5 * (w * h - cells)
    else:
        shape[i, 0] = hull_area(grid, i, out.box)
    shape[i, 1] = 0.0
    tongue = min(int(np.ceil((TONGUE + 2.0 * max(spec.half.inner, spec.half.outer)) / spec.unit - 1e-9)), spec.strict[i])
    for part in range(4):
        side = spec.least[i] if part == 0 else (half if part == 1 else (tongue if part == 2 else spec.strict[i]))
        if notch > 0:
            reached, pieces = ell_opening(w, h, notch, (w * h - cells) // notch, side)
        else:
            reached, pieces = opening(grid, i, out.box, side)
        if part < 2:
            shape[i, 1] += square_metre * (cells - reached)
            if pieces > 1:
                shape[i, 2] = 1.0
        elif part == 2:
            if pieces > 1 or reached < cells:
                shape[i, 3] += 0.3 + (cells - reached) / cells
        elif side > 1:
            if reached == 0:
                shape[i, 3] += 1.0
            elif spec.corridor[i] > 0 and (pieces > 1 or reached < cells):
                shape[i, 3] += 0.3 + (cells - reached) / cells


@borrowing
def terms(
    grid: Labels, out: Measures, spec: Spec, edges: Ints, areas: Floats, shape: Floats, stale: Ints, exact: bool
) -> tuple[Terms, float]:
    """Return the terms and the hard violation (0: none); write inner areas to `areas` (n,).

    `shape` (n, 4) keeps what `room_shape` found; only rooms that `stale` (n+1,) marks are looked at again, and
    those of more than four corners only if `exact`: else terms and violation are lower bounds. Infinity when a room is not one simple piece.
    """
    n = spec.target.size
    for i in range(n):
        if not simple(out, i):
            return NOTHING, np.inf
    hard = 0.0
    bent = 0
    for i in range(n):
        areas[i] = inner_area(out, i, n, spec.unit, spec.half)
        if stale[i] > 0:
            if exact or out.corners[i, 1] == 0:
                room_shape(grid, out, spec, i, shape)
            else:
                shape[i, 0] = float(out.cells[i])
                shape[i, 1], shape[i, 2], shape[i, 3] = 0.0, 0.0, 0.0
        hard += shape[i, 3]
        bent += out.corners[i, 1] > 0
    if bent < spec.nonrect:
        hard += 0.3 * (spec.nonrect - bent)
    fit, snug = 0.0, 0.0
    room = spec.flight[0]
    if room >= 0:
        rectangle = float(spec.flight[1] * spec.flight[2])
        w, h = out.box[room, 2] - out.box[room, 0], out.box[room, 3] - out.box[room, 1]
        both = overlap(w, h, spec.flight[1], spec.flight[2])
        fit, snug = n * stair_fit(both, rectangle), n * stair_snug(both, rectangle, float(w * h))
        hard += 0.5 * out.corners[room, 1]  # storeys share the staircase: a rectangle
    values = Terms(
        circulation=circulation(out, edges),
        area=area(areas, spec.target, spec.area_weight),
        squareness=squareness(out.box, spec.square),
        convexity=convexity(shape, out.cells),
        simplicity=simplicity(out.corners, n),
        exterior=exterior(out.walls, spec.habitable),
        corner_light=corner_light(out.outline_corners, spec.habitable),
        alignment=alignment(out.columns, out.rows),
        useful_area=useful_area(areas, spec.useful),
        min_width=min_width(shape),
        stair_fit=fit,
        stair_snug=snug,
    )
    return values, hard + violations(out, spec, areas)


@borrowing
def violations(out: Measures, spec: Spec, areas: Floats) -> float:  # noqa: C901, PLR0912 - a list of independent conditions
    """Hard conditions on walls and areas: 0 when all hold, else roughly the number of violated ones."""
    n = spec.target.size
    width, height = out.columns.size - 1, out.rows.size - 1
    diagonal = (width * width + height * height) ** 0.5
    hard = 0.0
    total = 0.0
    for a in range(n):
        total += areas[a] * spec.inside[a]
        if areas[a] < spec.low[a]:
            hard += 0.1 + 2.0 * (spec.low[a] - areas[a]) / spec.low[a]
        elif areas[a] > spec.high[a]:
            hard += 0.1 + 2.0 * (areas[a] - spec.high[a]) / spec.high[a]
        if out.run[a, n] < spec.outside[a]:
            hard += 0.5 + (spec.outside[a] - out.run[a, n]) / spec.outside[a]
        if out.walls[a, n] < spec.outside_sum[a]:
            hard += 0.2 + (spec.outside_sum[a] - out.walls[a, n]) / spec.outside_sum[a]
        if spec.corner[a] > 0 and out.outline_corners[a] == 0:
            hard += 1.0
        for b in range(n):
            if spec.order[a, b] > 0.0 and areas[a] < spec.order[a, b] * areas[b]:
                hard += 0.1 + 1.0 - areas[a] / (spec.order[a, b] * areas[b])
            if b <= a:
                continue
            if out.run[a, b] < spec.need[a, b]:
                hard += 0.5 + (spec.need[a, b] - out.run[a, b]) / spec.need[a, b]
            if spec.ban[a, b] > 0 and out.walls[a, b] > 0:
                hard += 0.5 + 0.1 * out.walls[a, b]
            if spec.apart[a, b] > 0.0:
                dx = out.centre[a, 0] - out.centre[b, 0]
                dy = out.centre[a, 1] - out.centre[b, 1]
                far = (dx * dx + dy * dy) ** 0.5 / diagonal
                if far < spec.apart[a, b]:
                    hard += 0.2 + 3.0 * (spec.apart[a, b] - far)
    for k in range(spec.between.shape[0]):
        a, b, c = spec.between[k, 0], spec.between[k, 1], spec.between[k, 2]
        ahead = (out.centre[b, 0] - out.centre[a, 0]) * (out.centre[c, 0] - out.centre[a, 0])
        ahead += (out.centre[b, 1] - out.centre[a, 1]) * (out.centre[c, 1] - out.centre[a, 1])
        if ahead > 0.0:
            hard += 0.2 + 3.0 * ahead**0.5 / diagonal
    if total < spec.total[0]:
        hard += 0.1 + 3.0 * (spec.total[0] - total) / spec.total[0]
    elif total > spec.total[1]:
        hard += 0.1 + 3.0 * (total - spec.total[1]) / spec.total[1]
    return hard
