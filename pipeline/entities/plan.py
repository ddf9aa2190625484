"""A floor plan: rooms as polygons of inner wall faces, and the openings between them."""

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

OpeningKind = Literal["door", "open", "portal", "window", "entrance"]


@dataclass(frozen=True, slots=True, eq=False)
class Room:
    """A room. `polygon` (n, 2) [m]: inner wall faces, counter-clockwise, not closed, no collinear vertex.

    `functions` are what it serves as besides what its type says, as far as somebody has said it.
    """

    room_id: str
    type: str
    polygon: NDArray[np.float64]
    level: int = 0
    height: float = 2.7
    role: str = ""
    name: str = ""
    functions: tuple[str, ...] = ()

    @property
    def area(self) -> float:
        """Area of the polygon [m2] (shoelace formula)."""
        here, there = self.polygon, self.polygon[[*range(1, len(self.polygon)), 0]]
        return float(0.5 * np.sum(here[:, 0] * there[:, 1] - there[:, 0] * here[:, 1]))


@dataclass(frozen=True, slots=True)
class Swing:
    """How a door leaf turns: into `room_id`, about the segment's end `hinge` (0 or 1), by up to `angle` [rad] > 0."""

    room_id: str
    hinge: int
    angle: float


@dataclass(frozen=True, slots=True)
class Opening:
    """A hole in a wall. `segment` (2, 2) [m] is the clear width on the wall's centre line.

    `rooms` are the two rooms that it joins, or one where the other side is outside. `sill` [m] above the floor.
    """

    opening_id: str
    kind: OpeningKind
    rooms: tuple[str, ...]
    segment: NDArray[np.float64]
    height: float
    sill: float = 0.0
    swing: Swing | None = None
    level: int = 0

    @property
    def width(self) -> float:
        """Clear width [m]."""
        return float(np.linalg.norm(self.segment[1] - self.segment[0]))


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """The rooms and openings of a home. `entrance` is the id of the room that one enters. Plans and rooms are told apart by identity.

    `inner_wall` and `outer_wall` are thicknesses [m]; storey k's floor lies at k * `storey_height` [m].
    """

    rooms: tuple[Room, ...]
    openings: tuple[Opening, ...]
    entrance: str
    inner_wall: float = 0.12
    outer_wall: float = 0.24
    storey_height: float = 3.0

    def room(self, room_id: str) -> Room:
        """Return the room of that id."""
        for room in self.rooms:
            if room.room_id == room_id:
                return room
        msg = f"no room {room_id!r} in the plan; rooms: {', '.join(r.room_id for r in self.rooms)}"
        raise KeyError(msg)

    def levels_of(self, room: Room) -> range:
        """Return the storeys that a room takes: a staircase goes on to the top."""
        top = max(r.level for r in self.rooms) if room.type == "staircase" else room.level
        return range(room.level, top + 1)

    def elevation(self, room_id: str) -> float:
        """Return the z of the room's floor [m]."""
        return self.room(room_id).level * self.storey_height


def hops(openings: Iterable[Iterable[str]], start: str) -> dict[str, int]:
    """Return how many openings, each between two rooms, lie on the shortest way from `start` to each room that one can reach."""
    beside = defaultdict(list)
    for a, b in openings:
        beside[a].append(b)
        beside[b].append(a)
    count, order = {start: 0}, [start]
    for here in order:
        for other in beside[here]:
            if other not in count:
                count[other] = count[here] + 1
                order.append(other)
    return count
