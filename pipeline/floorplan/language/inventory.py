"""The rooms that a prompt speaks of: what is new, and what points at a room that was named before."""

from __future__ import annotations

from dataclasses import dataclass, field

from pipeline.errors import RefusedError
from pipeline.floorplan.program import MAX_ROOMS

MOST = MAX_ROOMS + 1

NAMES = {
    "living_room": "living", "family_room": "family", "kitchen": "kitchen", "dining_room": "dining", "bedroom": "bed", "bathroom": "bath", "wc": "wc", "hallway": "hall", "entry": "entry", "closet": "closet", "utility": "utility", "storage": "storage",
    "garage": "garage", "balcony": "balcony", "staircase": "stairs", "office": "office", "studio_room": "studio", "media_room": "media", "gym": "gym", "library": "library", "playroom": "playroom", "meeting_room": "meeting", "workshop": "workshop",
    "sunroom": "sunroom",
}  # fmt: skip


@dataclass(slots=True)
class Named:
    """A room of the prompt. `open_slot`: one of several that were only counted, to be told apart by later words."""

    id: str
    type: str
    role: str = ""
    surface: str = ""
    open_slot: bool = False
    whole: bool = False  # one of a count of all such rooms: "a two-bedroom flat"
    extra: bool = False  # "another bathroom": none of those named in front
    index: int = 0
    stated: bool = True
    span: tuple[int, int] | None = None  # the words that named it first, as tokens
    level: int | None = None
    low: float | None = None
    high: float | None = None
    target: float | None = None
    size: float = 1.0
    functions: set[str] = field(default_factory=set)
    exterior: str | None = None
    exterior_length: float | None = None
    window: str = "auto"
    min_width: float | None = None


class Inventory:
    """All rooms so far, in the order of their first mention."""

    def __init__(self) -> None:
        self.rooms: list[Named] = []
        self.belongings: set[str] = set()

    def of(self, kind: str) -> list[Named]:
        """Return the rooms of a type."""
        return [r for r in self.rooms if r.type == kind]

    def get(self, room_id: str) -> Named:
        """Return the room of an id."""
        return next(r for r in self.rooms if r.id == room_id)

    def add(self, kind: str, role: str, surface: str, level: int | None, open_slot: bool = False) -> Named:
        """Add a room."""
        if len(self.rooms) >= MOST:
            raise RefusedError(f"more than {MAX_ROOMS} rooms are asked for", f"ask for {MAX_ROOMS} at most")
        count = len(self.of(kind)) + 1
        base = NAMES[kind]
        name = base if count == 1 else f"{base}_{count}"
        while any(r.id == name for r in self.rooms):
            count += 1
            name = f"{base}_{count}"
        room = Named(name, kind, role, surface, open_slot, level=level)
        self.rooms.append(room)
        return room

    def owned(self, room_id: str) -> bool:
        """Whether a room belongs to another one."""
        return room_id in self.belongings
