"""The state of a sentence while it is read, shared by all that read its elements."""

from __future__ import annotations

from abc import ABC, abstractmethod

from pipeline.floorplan.language.facts import Fact, Group, Reading
from pipeline.floorplan.language.phrases import Element


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
