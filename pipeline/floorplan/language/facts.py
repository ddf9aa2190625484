"""What is known while a prompt is read: its rooms, the facts about them, and what pronouns may point at."""

from __future__ import annotations

from dataclasses import dataclass, field

from pipeline.floorplan.language.inventory import Inventory
from pipeline.floorplan.language.marks import Mark, Words
from pipeline.floorplan.language.phrases import Element

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
