"""One storey's request in numbers, as the compiled searches take it."""

from typing import NamedTuple

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.floorplan.search.grid import Halves


class Spec(NamedTuple):
    """One storey's request in numbers, for n rooms. `unit` is the cell's side [m]."""

    unit: float
    root: int  # the room from which walks start
    target: Floats  # (n,) wanted inner areas [m2]
    low: Floats  # (n,) least and
    high: Floats  # (n,) largest inner area [m2]
    total: Floats  # (2,) bounds of the sum over `inside` [m2]
    inside: Ints  # (n,) counts for the total
    least: Ints  # (n,) wanted least width [cells]
    strict: Ints  # (n,) a square of this side must fit somewhere (everywhere, for circulation)
    square: Ints  # (n,) 1: a square shape is wanted
    habitable: Ints  # (n,)
    useful: Ints  # (n,)
    corridor: Ints  # (n,) 1: must be `strict` wide everywhere
    link: Ints  # (n, n) 1: joined by an opening
    need: Ints  # (n, n) straight common wall that is required [cells]
    ban: Ints  # (n, n) 1: must not share a wall
    outside: Ints  # (n,) straight outside wall that is required [cells]
    outside_sum: Ints  # (n,) outside wall in all that is required [cells]
    corner: Ints  # (n,) 1: must own a corner of the outline
    apart: Floats  # (n, n) least distance of centroids / diagonal
    order: Floats  # (n, n) area[a] >= order * area[b]
    stair_room: int  # index of the staircase, or -1
    stair: Ints  # (4,) its rectangle x0, y0, x1, y1 [cells]
    nonrect: int  # at least so many rooms that are not rectangles
    half: Halves  # half the thickness of walls [m]
    area_weight: Floats  # (n,) how much the wanted area counts
    flight: Ints  # (3,) index of the staircase or -1, longer and shorter side of what its flights take [cells]
    between: Ints  # (k, 3) room a lies between b and c: seen from its centroid, theirs lie in opposite halves
    near: Floats  # (k, 3) rooms a, b that belong together (members of a zone), and how much


def tree(link: Ints, root: int) -> Ints:
    """Return rows (room, parent) of the breadth-first tree of links from `root`, the root left out."""
    parents, order = {root: root}, [root]
    for here in order:
        for other in np.flatnonzero(link[here]).tolist():
            if other not in parents:
                parents[other] = here
                order.append(other)
    return np.array([(room, parents[room]) for room in order[1:]], np.int64).reshape(-1, 2)
