"""The walls of a room: the edges of its polygon, and the openings in them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.item import wrap_yaw
from pipeline.entities.plan import Opening

Floats = NDArray[np.float64]

WALL = 0.3  # an opening's segment is at most this far from the faces of its wall [m]
LEAST = 0.05  # of an opening that lies in a wall [m]


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
