"""What is known while a prompt is read: its rooms, the facts about them, the sentence at hand, and the program as it is put together."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import Any

from pipeline.errors import RefusedError
from pipeline.floorplan.language.marks import Mark, Words
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.text import spread
from pipeline.floorplan.program.floor_program import MAX_ROOMS

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


HALLS = {"hallway", "entry"}
GROUPS = {"no_ensuite", "door", "leads", "open", "near", "wall", "ban", "avoid", "away", "no_through"}
SOCIAL = {"kitchen", "dining_room", "living_room", "family_room"}
PERSONAL = {"bathroom", "wc", "closet", "balcony", "office", "storage", "sunroom"}
ROLES = {"primary", "guest", "child"}  # said by an adjective
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
        self.understood(element.first, element.last)
        if a or b:
            self.facts.append(Fact(what, tuple(dict.fromkeys(a)), tuple(dict.fromkeys(b)), value, element.first, element.last))


class Clause(ABC):
    """One sentence while it is read from left to right: what the words so far are about, and what its readers ask of each other."""

    def __init__(self, state: Reading, sentence: list[Element]) -> None:
        self.state, self.sentence = state, sentence
        self.stock = state.inventory
        self.run: list[Element] = []  # the list of phrases in front of the next cue
        self.subject: Group = ()
        self.latest: Group = ()
        self.objects: Group = ()
        self.waiting: tuple[Element, Group] | None = None  # a cue in front of its subject: "next to the kitchen lies ..."
        self.negative: Element | None = None
        self.way: Fact | None = None  # the last way that was said
        self.verb = self.relative = self.single = False
        self.only: Element | None = None
        self.factor: Element | None = None
        self.owner = ""
        self.owning = ""
        first = next((e for e in sentence if e.kind in {"np", "level", "zone", "every"}), None)
        self.forward = first is not None and first.kind == "level"
        self.level: int | None = None
        self.left_out: Group = ()  # "except the guest room, each has ..."
        self.wing: tuple[Element, list[str]] | None = None  # words for a wing in front of its rooms

    def negated(self, k: int) -> bool:
        """Whether a negation stands just in front of the element at k."""
        return any(x.kind == "neg" for x in self.sentence[max(0, k - 3) : k])

    @abstractmethod
    def push(self, k: int, e: Element, ids: Group) -> None:
        """Take a group into the list in front of the next cue."""

    @abstractmethod
    def after(self, k: int, cue: str, left: Group) -> tuple[Group, int]:
        """Return the rooms named after a cue, and where reading goes on."""

    @abstractmethod
    def point(self, e: Element, k: int, but: Group) -> Group:
        """Return the rooms that a pronoun stands for."""

    def give(self, things: Group, owners: Group, e: Element) -> None:
        """Let rooms belong to others."""
        self.stock.belongings.update(things)
        self.state.say("own", things, owners, e)


class Draft:
    """The program while it is put together, as plain data for pydantic."""

    def __init__(self, heard: Words) -> None:
        self.prompt, self.tokens = heard.prompt, heard.tokens
        self.links: dict[tuple[str, str], dict[str, Any]] = {}
        self.forbids: list[dict[str, Any]] = []
        self.relations: list[dict[str, Any]] = []
        self.evidence: list[dict[str, Any]] = []
        self.zones: list[dict[str, Any]] = []
        self.fields: dict[str, Any] = {}

    def cite(self, first: int, last: int, field: str) -> None:
        """Note that `field` was read from tokens[first:last]."""
        start, end = spread(self.tokens[first:last] or self.tokens[first : first + 1])
        made = {"start": start, "end": end, "text": self.prompt[start:end], "field": field}
        if made not in self.evidence[-40:]:
            self.evidence.append(made)

    def link(self, a: str, b: str, kind: str, fact: Fact) -> None:
        """Add a link, or sharpen the one there is."""
        if a == b:
            return
        key = (min(a, b), max(a, b))
        old = self.links.get(key)
        if old is None or (old["kind"] in {"any", "wall"} and kind not in {"any", "wall"}):
            self.links[key] = {"a": a, "b": b, "kind": kind, "stated": True}
        self.cite(fact.first, fact.last, f"links.{a}-{b}")

    def linked(self, a: str) -> set[str]:
        """Return the rooms that a room is joined to by an opening."""
        return {k[1] if k[0] == a else k[0] for k, v in self.links.items() if a in k and v["kind"] != "wall"}

    def relate(self, kind: str, a: str, b: str | None, value: float, fact: Fact, c: str | None = None) -> None:
        """Add a relation once."""
        made = {"kind": kind, "a": a, "b": b, "value": value} | ({"c": c} if c else {})
        if made not in self.relations:
            self.relations.append(made)
            self.cite(fact.first, fact.last, f"relations.{kind}.{a}")

    def forbid(self, what: str, a: str, b: str | None, avoid: str | None, first: int, last: int) -> None:
        """Add a prohibition once."""
        made = {"what": what, "a": a, "b": b, "avoid": avoid}
        if made not in self.forbids:
            self.forbids.append(made)
            self.cite(first, last, f"forbids.{what}.{a}")
