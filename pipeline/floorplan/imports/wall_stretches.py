"""The walls between rooms as their polygons show them: straight stretches with the same rooms on both sides."""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from pipeline.arrays import Floats
from pipeline.entities.plan import Room

THICKEST = 0.65  # [m] rooms that face each other across more have no common wall
TOUCH = 0.03  # [m] rooms nearer than this touch: no wall lies between them
PARALLEL = 0.999  # cosine: walls within 2.5 degrees of each other
LEAST_RUN = 0.24  # [m] the narrowest window with its jambs


@dataclass(frozen=True, slots=True)
class Stretch:
    """A straight piece of wall: its centre line from `start` (2,) along the unit vector `along`, `length` [m].

    The first room of `rooms` lies on its left; one room: the other side is outside. `thickness` [m] is the wall's.
    """

    rooms: tuple[str, ...]
    start: Floats
    along: Floats
    length: float
    thickness: float
    level: int

    @property
    def left(self) -> Floats:
        """Unit normal into the first room."""
        return np.array([-self.along[1], self.along[0]])

    def at(self, low: float, high: float) -> Floats:
        """Return the segment (2, 2) between two places along the stretch, to 0.1 mm."""
        return np.round(np.array([self.start + low * self.along, self.start + high * self.along]), 4) + 0.0


def stretches(rooms: Sequence[Room], level: int, outer: float) -> list[Stretch]:
    """Return all stretches of one storey; `rooms` are those on it, `outer` [m] the thickness of outside walls."""
    shapes = {r.room_id: shapely.Polygon(r.polygon) for r in rooms}
    segments: list[Stretch] = []
    for room in rooms:
        for start, end, along in edges(room.polygon):
            length = float(np.linalg.norm(end - start))
            out = np.array([along[1], -along[0]])
            taken: list[tuple[float, float]] = []
            for other in rooms:
                if other is room or shapes[room.room_id].distance(shapes[other.room_id]) > THICKEST:
                    continue
                for low, high, gap in _facing(start, along, out, length, other.polygon):
                    taken.append((low, high))
                    middle = shapely.Point(start + (low + high) / 2 * along + gap / 2 * out)
                    between = any(s.contains(middle) for name, s in shapes.items() if name not in {room.room_id, other.room_id})
                    # each pair is met from both sides; the first of the list keeps it
                    if rooms.index(room) < rooms.index(other) and high - low >= LEAST_RUN and not between:
                        line = start + low * along + gap / 2 * out
                        segments.append(Stretch((room.room_id, other.room_id), line, along, high - low, max(gap, 0.0), level))
            segments += [
                Stretch((room.room_id,), start + low * along + outer / 2 * out, along, high - low, outer, level)
                for low, high in _left_over(taken, length)
                if high - low >= LEAST_RUN
            ]
    return segments


def touching_share(rooms: Sequence[Room], level: int) -> tuple[int, int]:
    """Return how many stretches between rooms have no thickness, and how many have one."""
    between = [s for s in stretches(rooms, level, 0.24) if len(s.rooms) == 2]
    thin = sum(s.thickness < TOUCH for s in between)
    return thin, len(between) - thin


def edges(ring: Floats) -> Iterator[tuple[Floats, Floats, Floats]]:
    """Yield start, end and direction (2,) of each edge of a ring (n, 2)."""
    for p, q in itertools.pairwise([*ring, ring[0]]):
        yield p, q, (q - p) / np.linalg.norm(q - p)


def _facing(start: Floats, along: Floats, out: Floats, length: float, polygon: Floats) -> Iterator[tuple[float, float, float]]:
    """Yield (low, high, gap) of the parts of an edge that edges of another polygon face."""
    for p, q, other in edges(polygon):
        if float(other @ along) > -PARALLEL:
            continue
        gap = float(((p + q) / 2 - start) @ out)
        low, high = max(0.0, float((q - start) @ along)), min(length, float((p - start) @ along))
        if -TOUCH <= gap <= THICKEST and high > low:
            yield low, high, gap


def _left_over(taken: list[tuple[float, float]], length: float) -> list[tuple[float, float]]:
    """Return the intervals of [0, length] that none of `taken` covers."""
    free, reached = [], 0.0
    for low, high in sorted(taken):
        if low > reached:
            free.append((reached, low))
        reached = max(reached, high)
    if length > reached:
        free.append((reached, length))
    return free
