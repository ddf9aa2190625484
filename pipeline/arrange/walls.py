"""The walls of a room: the edges of its polygon, the openings in them; poses with the back to them, and what openings cost there."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeline.arrange.item import Item, wrap_yaw, yaw_difference
from pipeline.arrays import Floats
from pipeline.entities.plan import Opening

WALL = 0.3  # an opening's segment is at most this far from the faces of its wall [m]
LEAST = 0.05  # of an opening that lies in a wall [m]
OVERHANG = 0.05  # an object may stand this far before an opening at no cost [m]
BEFORE_WINDOW = 1.5  # cost of hiding a window behind something high [m]
BEFORE_HOLE = 0.8  # cost of leaning on a wall that is not there [m]
ABOVE_SILL = 0.4  # what rises no more than this above a window's sill may stand before it [m]
CORNER = 0.3  # a side this near to a wall is nearly in the corner [m]
TOUCHING = 0.1  # a side this near to a wall is meant to be at it [m]
SQUARELY = 0.99  # cosine of the angle at which a side faces a wall
ANY_WALL = math.radians(100)  # a turn that goes on to the next wall, not to the one behind
FAR = 1.0  # what belongs to a wall is put to one that is no farther; what would rather, within the wall_reach of the settings [m]


@dataclass(frozen=True, slots=True)
class EdgeOpening:
    """An opening in one edge of a room: from `start` to `end` [m along the edge], `sill` to `head` [m above the floor]."""

    start: float
    end: float
    sill: float
    head: float
    window: bool


@dataclass(frozen=True, slots=True)
class Edge:
    """A wall: it starts at `start` (2,) and goes along the unit vector `along` (2,); the room lies on `inward` (2,)."""

    start: Floats
    along: Floats
    inward: Floats
    length: float
    yaw: float  # of an object that has its back to it [rad]
    openings: tuple[EdgeOpening, ...]

    def pose(self, s: float, off: float, z: float) -> Floats:
        """Return the pose of an object whose middle is `s` along the wall and `off` before it [m]."""
        x, y = self.start + s * self.along + off * self.inward
        return np.array([x, y, z, self.yaw])

    def along_of(self, points: Floats) -> Floats:
        """Return how far along the wall points (..., 2) lie [m]."""
        s: Floats = (points - self.start) @ self.along
        return s

    def off(self, points: Floats) -> Floats:
        """Return how far before the wall points (..., 2) lie [m]."""
        off: Floats = (points - self.start) @ self.inward
        return off


def edges_of(polygon: Floats, openings: Sequence[Opening]) -> list[Edge]:
    """Return the walls of a room polygon (n, 2), counter-clockwise."""
    walls = []
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        length = math.hypot(*(b - a))
        t = (b - a) / max(length, 1e-9)
        edge = Edge(a, t, np.array([-t[1], t[0]]), length, wrap_yaw(math.atan2(-t[1], -t[0])) + 0.0, ())
        walls.append(replace(edge, openings=tuple(own for o in openings if (own := _opening_in(edge, o)) is not None)))
    return walls


def _opening_in(edge: Edge, opening: Opening) -> EdgeOpening | None:
    """Return an opening as it lies in a wall, None for one of another."""
    s, off = edge.along_of(opening.segment), np.abs(edge.off(opening.segment))
    if off.max() >= WALL or min(edge.length, s.max()) - max(0.0, s.min()) <= LEAST:
        return None
    return EdgeOpening(float(s.min()), float(s.max()), opening.sill, opening.sill + opening.height, opening.kind == "window")


def hides_window(item: Item, opening: EdgeOpening) -> bool:
    """Whether an object is too high to stand before a window, or hangs on a wall."""
    high = item.mount == "floor" and float(item.placement.size[2]) > opening.sill + ABOVE_SILL
    return opening.window and (high or item.mount == "wall")


def opening_cost(item: Item, s: Floats, openings: Sequence[EdgeOpening]) -> Floats:
    """Return what standing before openings costs at places `s` (S,) along a wall: there is none to lean on. What hangs needs one."""
    cost = np.zeros(len(s))
    w = float(item.half[0])
    for opening in openings:
        before = np.minimum(s + w, opening.end) - np.maximum(s - w, opening.start) > OVERHANG
        if item.mount == "wall":
            cost[before] = np.inf
        elif not opening.window:
            cost[before] += BEFORE_HOLE
        elif hides_window(item, opening) and item.habit.kind != "bed":
            cost[before] += BEFORE_WINDOW
    return cost


def at_wall(item: Item, pose: Floats, walls: Sequence[Edge], reach: float, turn_cost: float, most: float = ANY_WALL) -> Floats | None:
    """Return the nearest pose (x, y, z, yaw) with the back to a wall, in the gap that is usual; None where none is within `reach` [m].

    Turning counts `turn_cost` metres per radian; by more than `most` [rad] nothing is turned.
    """
    w, d = item.half
    low, usual, high = item.habit.gap
    best: tuple[float, Floats] | None = None
    for edge in walls:
        if edge.length < 2 * w:
            continue
        s, off = float(edge.along_of(pose[:2])), float(edge.off(pose[:2]))
        gap = off - d
        turn = float(yaw_difference(edge.yaw, float(pose[3])))
        if turn > most or gap > reach + FAR:
            continue
        stop = min(max(s, w + low), edge.length - w - low)
        moved = math.hypot(stop - s, gap - usual)
        cost = moved + turn_cost * turn + float(opening_cost(item, np.array([stop]), edge.openings)[0])
        if cost < (best[0] if best else reach):
            best = cost, edge.pose(stop, d + (gap if low <= gap <= high else usual), float(pose[2]))
    return best[1] if best else None


def in_corner(pose: Floats, item: Item, walls: Sequence[Edge]) -> Floats:
    """Return a pose moved along its wall into the corner, where its side is nearly there and things of its category stand in corners: as near to it as they do."""
    if item.habit.corner is None:
        return pose
    least, usual, most = item.habit.corner
    ahead = np.array([math.cos(pose[3]), math.sin(pose[3])])
    gaps = []
    for edge in walls:
        away = float(edge.inward @ ahead)
        s, off = float(edge.along_of(pose[:2])), float(edge.off(pose[:2]))
        if abs(away) > SQUARELY and 0.0 < s < edge.length and abs(off - float(item.half[0])) < CORNER:
            gap = off - float(item.half[0])
            stays = max(usual, TOUCHING) < gap <= most
            gaps.append((0.0 if stays else gap - min(max(gap, least), usual), away))
    if not gaps:
        return pose
    gap, away = min(gaps, key=lambda candidate: (round(abs(candidate[0]), 6), candidate[1]))
    return np.array([*(pose[:2] - gap * away * ahead), pose[2], pose[3]])


def square(yaw: float, walls: Sequence[Edge], within: float) -> float:
    """Return a yaw turned to the nearest direction of a wall where that is `within` [rad], else the same."""
    squares = (np.array([edge.yaw for edge in walls])[:, None] + np.arange(4) * math.pi / 2).ravel()
    distance = yaw_difference(squares, yaw)
    best = int(np.argmin(np.round(distance, 6)))
    return wrap_yaw(float(squares[best])) if distance[best] <= within else wrap_yaw(yaw)
