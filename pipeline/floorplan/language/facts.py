"""What is known while a prompt is read: its rooms, the facts about them, and what pronouns may point at."""

from __future__ import annotations

from dataclasses import dataclass, field

from pipeline.floorplan.language import items as kinds
from pipeline.floorplan.language import lexicon
from pipeline.floorplan.language.inventory import Inventory
from pipeline.floorplan.language.items import Item
from pipeline.floorplan.language.tokens import Token

HALLS = {"hallway", "entry"}
PERSONAL = {"bathroom", "wc", "closet", "balcony", "office", "storage"}


GROUPS = {lexicon.DOOR, lexicon.LEADS, lexicon.OPEN, lexicon.NEAR, lexicon.WALL, lexicon.BAN, lexicon.THROUGH, "away"}


def named(group: tuple[str, ...]) -> tuple[str, ...]:
    """Return the rooms of a group, without placeholders."""
    return tuple(i for i in group if not i.startswith(("*", "<")))


@dataclass(frozen=True, slots=True)
class Fact:
    """Something said: `what` about rooms `a` (and `b`), read from tokens[first:last]. `every` names groups filled in later."""

    what: str
    a: tuple[str, ...]
    b: tuple[str, ...] = ()
    value: float = 0.0
    first: int = 0
    last: int = 0


@dataclass
class Reading:
    """State while reading: rooms, facts, and what pronouns point at."""

    tokens: list[Token]
    inventory: Inventory = field(default_factory=Inventory)
    facts: list[Fact] = field(default_factory=list)
    banned: list[tuple[str, Item]] = field(default_factory=list)
    amounts: list[tuple[Item, tuple[str, ...] | None]] = field(default_factory=list)  # None: the whole home
    entrance: str | None = None
    home: Item | None = None
    studio: Item | None = None
    storeys: tuple[int, Item] | None = None
    level: int | None = None
    past: list[tuple[str, ...]] = field(default_factory=list)  # groups named in earlier sentences, the latest last
    owner: str = ""
    owning: str = ""  # the bedroom of the owner whose rooms are being listed
    used: set[int] = field(default_factory=set)

    def understood(self, item: Item) -> None:
        """Mark an item's words as understood."""
        self.used.update(range(item.first, item.last))

    def say(self, what: str, a: tuple[str, ...], b: tuple[str, ...], item: Item, value: float = 0.0) -> None:
        """Record a fact. Whole groups ("*") and each-other mean something to few kinds of fact only."""
        if what not in GROUPS:
            a, b = named(a), named(b)
        if a or b:
            self.facts.append(Fact(what, a, b, value, item.first, item.last))


def heard(state: Reading, sentence: list[Item], k: int) -> list[tuple[str, ...]]:
    """Return the groups of rooms named before item k, the latest last."""
    return [*state.past, *(tuple(i.ids) for i in sentence[:k] if i.kind == kinds.ROOM and i.ids)]
