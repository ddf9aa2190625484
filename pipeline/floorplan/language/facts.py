"""What is known while a prompt is read: its rooms, and the facts about them."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field

from pipeline.errors import RefusedError
from pipeline.floorplan.language.marks import Mark, Words
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.program.floor_program import MAX_ROOMS

MOST = MAX_ROOMS + 1

SHORT = {"bedroom": "bed", "bathroom": "bath", "hallway": "hall", "staircase": "stairs"}  # ids of rooms that are not called as their type


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
        base, known = SHORT.get(kind, kind.removesuffix("_room")), {r.id for r in self.rooms}
        names = (base if n == 1 else f"{base}_{n}" for n in itertools.count(len(self.of(kind)) + 1))
        room = Named(next(n for n in names if n not in known), kind, role, surface, open_slot, level=level)
        self.rooms.append(room)
        return room

    def zone(self, name: str) -> list[str]:
        """Return the rooms that the name of a zone means."""
        return [r.id for r in self.rooms if r.type in ZONES.get(name, ()) or (r.type == "bedroom" and r.role == name)]


GROUND_FLOOR = 0
HALLS = {"hallway", "entry"}
SOCIAL = {"kitchen", "dining_room", "living_room", "family_room"}
PERSONAL = {"bathroom", "wc", "closet", "balcony", "office", "storage", "sunroom"}  # what a bedroom may have of its own
PRIVATE = {"balcony", "garage", "bathroom", "wc", "closet", "storage", "utility", "bedroom"}  # nothing stands open to these
ZONES = {"bedroom": ("bedroom",), "living": ("living_room", "dining_room", "family_room"), "work": ("office", "meeting_room")}
FRONT = {"door", "near", "open", "wall", "from", "ensuite", "cmp", "via"}  # relations to one room, behind which a list begins anew
GROUPS = {"no_ensuite", "door", "leads", "open", "near", "wall", "ban", "avoid", "away", "no_through"}  # may be said of all rooms
Group = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Fact:
    """Something said: `what` about rooms `a` (and `b`), read from tokens[first:last]."""

    what: str
    a: Group
    b: Group = ()
    value: float = 0.0
    first: int = 0
    last: int = 0


@dataclass
class Reading:
    """State while reading."""

    heard: Words
    inventory: Inventory = field(default_factory=Inventory)
    facts: list[Fact] = field(default_factory=list)
    banned: list[tuple[str, Element]] = field(default_factory=list)
    amounts: list[tuple[Mark, Group | None]] = field(default_factory=list)  # None: the whole home
    flags: dict[str, Element] = field(default_factory=dict)
    looks: list[Element] = field(default_factory=list)
    zones: dict[str, tuple[Group, Element]] = field(default_factory=dict)
    levels: list[Element] = field(default_factory=list)  # words for storeys
    wings: tuple[str, ...] = ()  # zones that lie in parts of their own
    heights: dict[str, int] = field(default_factory=dict)  # the storey of zones, and of all other rooms ("*")
    entrance: tuple[str, Element] | None = None
    outside: tuple[str, Element] | None = None  # the owner of a door of its own
    homes: list[Element] = field(default_factory=list)
    studio: Element | None = None
    storeys: tuple[int, Mark] | None = None
    rooms: tuple[int, Mark] | None = None  # "a three-room flat"
    people: Mark | None = None  # how many live there
    parted: str = ""  # of which type of room one was spoken of apart
    topic: Group = ()  # what the last sentence was about
    past: list[Group] = field(default_factory=list)  # groups named in earlier sentences, the latest last
    used: set[int] = field(default_factory=set)

    def understood(self, first: int, last: int) -> None:
        """Mark words as understood."""
        self.used.update(range(first, last))

    def say(self, what: str, a: Group, b: Group, element: Element, value: float = 0.0) -> None:
        """Record a fact. Whole groups ("*...") mean something to few kinds of fact only."""
        if what not in GROUPS:
            a, b = (tuple(i for i in g if not i.startswith("*")) for g in (a, b))
        a, b = (("*",) if "*" in g else g for g in (a, b))  # "all rooms are off the hall: kitchen, bath ..."
        if what in {"except", "only"}:
            self.understood(element.first, element.last)
        if a or b:
            self.facts.append(Fact(what, tuple(dict.fromkeys(a)), tuple(dict.fromkeys(b)), value, element.first, element.last))
