"""A plan as its file has it: rings and openings that nobody has checked yet, and the repairs that are made on the way."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

from pipeline.arrays import Floats
from pipeline.entities.plan import OpeningKind, Room, Swing
from pipeline.errors import RefusedError

Faces = Literal["inner", "centre", ""]  # what polygons are: inner wall faces, walls' centre lines, or to be found out
Where = Literal["all", "some", "none"]  # which doors the file states: all, as many as it knows, or it has no word of doors

MAX_ROOMS, MAX_OPENINGS, MAX_CORNERS = 100, 1000, 400
REMEDY = "see docs/floorplan.md for what a plan of your own must be"


@dataclass(frozen=True, slots=True)
class Repair:
    """Something of the file that was changed, or (code "closed") found to be so: a short `code`, the room or opening, and what it is, in words."""

    code: str
    where: str
    text: str


@dataclass(slots=True)
class SketchRoom:
    """A room: `ring` (n, 2) in the file's unit, then in metres; `type` as the file spells it, then one of ours."""

    room_id: str
    type: str
    ring: Floats
    level: int = 0
    height: float = 2.7
    role: str = ""
    functions: tuple[str, ...] = ()

    def room(self) -> Room:
        """Return it as a room of a plan."""
        return Room(self.room_id, self.type, self.ring, self.level, round(self.height, 3), self.role, functions=self.functions)


@dataclass(slots=True)
class SketchOpening:
    """An opening. `rooms` may be empty (whatever lies on both sides); `segment` (2, 2) or `at` (2,) or neither says where."""

    opening_id: str
    kind: OpeningKind
    rooms: tuple[str, ...] = ()
    segment: Floats | None = None
    at: Floats | None = None
    width: float | None = None
    height: float | None = None
    sill: float | None = None
    swing: Swing | None = None
    level: int = 0


@dataclass(slots=True)
class Sketch:
    """A plan before it is checked. `inner_wall` and `outer_wall` [m] are None where the file does not say.

    `foreign`: it was not drawn for this but is a house of a dataset: what cannot stand in it is left out, and that is stated.
    """

    rooms: list[SketchRoom]
    openings: list[SketchOpening]
    faces: Faces = ""
    doors: Where = "all"
    entrance: str = ""
    inner_wall: float | None = None
    outer_wall: float | None = None
    storey_height: float | None = None
    units: str = ""
    foreign: bool = False
    repairs: list[Repair] = field(default_factory=list)

    def move(self, change: Callable[[Floats], Floats]) -> None:
        """Change all coordinates."""
        for room in self.rooms:
            room.ring = change(room.ring)
        for o in self.openings:
            o.segment = None if o.segment is None else change(o.segment)
            o.at = None if o.at is None else change(o.at)

    def repair(self, code: str, where: str, text: str) -> None:
        """State a repair."""
        self.repairs.append(Repair(code, where, text))


def identifiers(names: list[str], fallback: str) -> list[str]:
    """Return ids that may be a path or a prim's name, one per name and all different."""
    ids: list[str] = []
    for number, name in enumerate(names):
        plain = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")[:32] or f"{fallback}_{number}"
        plain = plain if plain[0].isalpha() else f"{fallback}_{plain}"[:32]
        wanted, k = plain, 2
        while wanted in ids:
            wanted, k = f"{plain}_{k}", k + 1
        ids.append(wanted)
    return ids


class OwnPlanError(RefusedError):
    """A plan of the user's own that cannot be built."""

    code = "own_plan"

    def __init__(self, why: str, remedy: str) -> None:
        self.why = why
        super().__init__(f"the plan cannot be built: {why}", remedy)


def refuse(message: str, remedy: str = REMEDY) -> OwnPlanError:
    """Return the refusal of a plan that is well-formed and cannot be."""
    return OwnPlanError(message, remedy)
