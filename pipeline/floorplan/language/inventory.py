"""The rooms that a prompt speaks of: what is new, and what points at a room that was named before."""

from __future__ import annotations

from dataclasses import dataclass, field

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
    level: int | None = None
    low: float | None = None
    high: float | None = None
    target: float | None = None
    size: float = 1.0
    functions: set[str] = field(default_factory=set)
    exterior: str | None = None
    exterior_length: float | None = None
    window: str = "auto"
    objects: int | None = None
    walkable: float | None = None
    min_width: float | None = None
    spans: list[tuple[int, int, str]] = field(default_factory=list)


class Inventory:
    """All rooms so far, in the order of their first mention."""

    def __init__(self) -> None:
        self.rooms: list[Named] = []

    def of(self, kind: str) -> list[Named]:
        """Return the rooms of a type."""
        return [r for r in self.rooms if r.type == kind]

    def get(self, room_id: str) -> Named:
        """Return the room of an id."""
        return next(r for r in self.rooms if r.id == room_id)

    def add(self, kind: str, role: str, surface: str, level: int | None, open_slot: bool = False) -> Named:
        """Add a room."""
        count = len(self.of(kind)) + 1
        base = NAMES[kind]
        name = base if count == 1 else f"{base}_{count}"
        while any(r.id == name for r in self.rooms):
            count += 1
            name = f"{base}_{count}"
        room = Named(name, kind, role, surface, open_slot, level)
        self.rooms.append(room)
        return room

    def specialise(self, kind: str, role: str, surface: str) -> Named | None:
        """Take one of the rooms that were only counted, and tell it apart."""
        for room in self.rooms:
            if room.type == kind and room.open_slot and not (role and room.role and room.role != role):
                room.open_slot = False
                room.role = role or room.role
                room.surface = surface
                return room
        return None

    def refer(self, kind: str, role: str, surface: str, many: bool, other: bool, ordinal: int, level: int | None) -> list[Named]:
        """Return the rooms that a definite phrase points at; empty when there are none yet."""
        same = self.of(kind)
        if level is not None:
            same = [r for r in same if r.level in {None, level}] or same
        if role:
            return [r for r in same if r.role == role]
        if not same:
            return []
        if other:
            loose = [r for r in same if r.open_slot]
            return loose or same[-1:]
        if ordinal > 1:
            rest = [r for r in same if r.role != "primary"]
            loose = [r for r in rest if r.open_slot] or rest
            return loose[:1] if len(same) >= ordinal else []
        if many:
            return same
        if len(same) > 1:
            last = surface.rsplit(maxsplit=1)[-1]
            exact = [r for r in same if last in r.surface.split()]
            same = exact or same
        plain = [r for r in same if not r.role]
        return (plain or same)[:1]
