"""The program while it is put together from rooms and facts."""

from __future__ import annotations

from typing import Any

from pipeline.floorplan.language.facts import Fact
from pipeline.floorplan.language.marks import Words
from pipeline.floorplan.language.text import spread


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
