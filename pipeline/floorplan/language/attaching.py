"""Wishes for furniture, and the rooms that they are for."""

from __future__ import annotations

import bisect
import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NoReturn

from pipeline.floorplan.language.furnishing import STOPS, Claim, Scan
from pipeline.floorplan.program.consistency import ImpossibleError
from pipeline.floorplan.program.floor_program import MAX_PIECES, Evidence, FloorProgram, Furniture, Things
from pipeline.floorplan.program.furniture import impossible, natural

LONG = 400  # characters of a list of wishes
FAR = 24  # characters between a wish and the room that follows it
CLOSE = 4  # the same where nothing but a particle stands between


@dataclass(frozen=True, slots=True)
class Mention:
    """Words of the prompt that name rooms."""

    start: int
    end: int
    ids: tuple[str, ...]


def attach(program: FloorProgram, claims: Sequence[Claim], prompt: str, mentions: Sequence[Mention] | None = None) -> FloorProgram:
    """Return the program with the wishes in its rooms and in `furniture`, and their evidence.

    `mentions` are where rooms are named; by default the program's evidence tells. Raises ImpossibleError for wishes that clash.
    """
    if not claims:
        return program
    place = _Place(program, claims, prompt, list(mentions) if mentions is not None else room_mentions(program))
    by_room: dict[str, list[Claim]] = {}
    evidence = []
    for claim in claims:
        every = tuple(r.id for r in program.rooms) if claim.home and claim.kind in {"pieces", "openable"} else ()
        rooms = every or place.of(claim) or ("",)
        one = replace(claim, least=1) if claim.plural and len(rooms) > 1 else claim  # "two bedrooms with wardrobes"
        for room in rooms:
            by_room.setdefault(room, []).append(one)
            where = f"rooms.{room}.furniture" if room else "furniture"
            field = f"{where}.{claim.name if claim.kind == 'count' else claim.kind}"
            evidence.append(Evidence(start=claim.start, end=claim.end, text=prompt[claim.start : claim.end], field=field))
    furnished = [
        r.model_copy(update={"furniture": combine_claims(by_room[r.id], prompt, r.id)}) if r.id in by_room else r for r in program.rooms
    ]
    own = combine_claims(by_room[""], prompt, "the home") if "" in by_room else program.furniture
    return program.model_copy(update={"rooms": tuple(furnished), "furniture": own, "evidence": (*program.evidence, *evidence)})


def room_mentions(program: FloorProgram) -> list[Mention]:
    """Return where the prompt names rooms, in its order."""
    by_span: dict[tuple[int, int], list[str]] = {}
    ids = {r.id for r in program.rooms}
    for e in program.evidence:
        room = e.field.removeprefix("rooms.")
        if e.field.startswith("rooms.") and room in ids:
            by_span.setdefault((e.start, e.end), []).append(room)
    return [Mention(start, end, tuple(dict.fromkeys(rooms))) for (start, end), rooms in sorted(by_span.items())]


def combine_claims(claims: Sequence[Claim], prompt: str, where: str) -> Furniture:
    """Return the wishes that claims of one room make together. Raises ImpossibleError naming words that clash."""
    counts: dict[str, Things] = {}
    fields: dict[str, Any] = {}

    def narrowed(claim: Claim, least: int, most: int | None, what: str) -> tuple[int, int | None]:
        least, most = max(least, claim.least), min((m for m in (most, claim.most) if m is not None), default=None)
        if most is not None and least > most:
            _clash(f"{where} is to have at least {least} and at most {most} {what}", claims, claim, prompt)
        return least, most

    for claim in claims:
        many = max(claim.least, claim.most or 0)
        if many > MAX_PIECES:
            _clash(f"{many} things are asked for in {where}, and {MAX_PIECES} are the most", [claim], claim, prompt)
        if claim.kind == "count":
            old = counts.get(claim.name, Things(category=claim.name))
            least, most = narrowed(claim, old.min, old.max, claim.name.removeprefix("any_"))
            counts[claim.name] = Things(category=claim.name, min=least, max=most)
        elif claim.kind == "pieces":
            least, most = narrowed(claim, fields.get("least") or 0, fields.get("most"), "pieces")
            fields |= {"least": least or None, "most": most}
        elif claim.kind == "style":
            if fields.setdefault("style", claim.name) != claim.name:
                _clash(f"{where} is to be both {fields['style']} and {claim.name}", claims, claim, prompt)
        elif claim.kind == "openable":
            fields["openable"] = max(fields.get("openable", 0), claim.least)
        elif claim.value > 1.0:
            _clash(f"{claim.value:.0%} of {where} are to be free", [claim], claim, prompt)
        else:
            fields["walkable"] = max(fields.get("walkable", 0.0), claim.value)
    return Furniture.model_validate({**fields, "counts": tuple(counts.values())})


def _clash(message: str, claims: Sequence[Claim], claim: Claim, prompt: str) -> NoReturn:
    both = [c for c in claims if c.kind == claim.kind and (c.name == claim.name or claim.kind != "count")]
    raise ImpossibleError(
        message, "keep one of the two", [Evidence(start=c.start, end=c.end, text=prompt[c.start : c.end], field="furniture") for c in both]
    )


class _Place:
    """Tells which rooms a claim means."""

    def __init__(self, program: FloorProgram, claims: Sequence[Claim], prompt: str, named: Sequence[Mention]) -> None:
        self.claims, self.prompt, self.named = claims, prompt, named
        self.kinds: Mapping[str, str] = {r.id: r.type for r in program.rooms}
        self.stops = [-1, *(i for i, c in enumerate(prompt) if c in STOPS and not _decimal(prompt, i)), len(prompt)]

    @functools.cached_property
    def scan(self) -> Scan:
        """Return the words of the prompt."""
        return Scan(self.prompt)

    def _at(self, place: int) -> int:
        """Return the first word from a place on."""
        return bisect.bisect_left([w.start for w in self.scan.words], place)

    def of(self, claim: Claim) -> tuple[str, ...]:  # noqa: PLR0911 - one answer per rule
        """Return the ids of the rooms that a claim means, () for the whole home."""
        if claim.home:
            return ()
        place = bisect.bisect_left(self.stops, claim.start)
        begin, end = self.stops[place - 1] + 1, self.stops[place]
        before = [m for m in self.named if begin <= m.start and m.end <= claim.start]
        after = [m for m in self.named if claim.end <= m.start and m.end <= end]
        gap = after[0].start - claim.end if after else FAR + 1
        if before and claim.kind != "count" and self.scan.length(self._at(before[-1].end), "dwelling"):
            return ()  # "a two-bedroom flat with 30 pieces": the flat's
        if (claim.inward and gap <= FAR and "," not in self.prompt[claim.end : after[0].start]) or (
            gap <= CLOSE and self.scan.length(self._at(claim.end), "of")
        ):  # "带淋浴的卫生间"
            return after[0].ids
        if claim.kind == "style":
            return self._styled(claim, before, after)
        if before:
            near = self._joined(before[-1].end, claim.start) or self._natural(claim, before[-1])
            likely = [] if near else [m for m in [*reversed(before), *after, *self.named] if self._natural(claim, m)]
            if not near and not likely and any(impossible(self.kinds[i], claim.name) for i in before[-1].ids):
                return ()  # "a one-bedroom flat, with a tub"
            return (likely or before[-1:])[0].ids
        if claim.kind != "count" and gap <= FAR // 2:
            return after[0].ids
        likely = [m for m in [*after, *self.named] if self._natural(claim, m)]
        if claim.kind == "count" and likely and claim.least:
            return likely[0].ids
        earlier = [m for m in self.named if m.end <= claim.start]
        first = self._at(begin)
        stands_for = any(self.scan.length(k, "stands_for") for k in range(first, first + 3) if k < self._at(claim.start))
        return earlier[-1].ids if earlier and begin and claim.kind != "walkable" and stands_for else ()

    def _styled(self, claim: Claim, before: Sequence[Mention], after: Sequence[Mention]) -> tuple[str, ...]:
        """Return whose style it is: a room's where it stands in the room's list of wishes or right before its name, else the home's."""
        if before and self._joined(before[-1].end, claim.start):
            own = any(c is not claim and before[-1].end <= c.start < claim.start for c in self.claims)
            led = any(self.scan.length(k, "in", "with", "is") for k in range(self._at(before[-1].end), self._at(claim.start)))
            if own or led or "characters" in self.scan.traits:
                return before[-1].ids
        if after and not self.prompt[claim.end : after[0].start].strip() and not self.scan.length(self._at(after[0].end), "dwelling"):
            return after[0].ids
        return ()

    def _joined(self, start: int, end: int) -> bool:
        """Whether between two places stands nothing but other wishes and what joins them."""
        k = self._at(start)
        while end - start <= LONG and k < len(self.scan.words) and self.scan.words[k].start < end:
            word = self.scan.words[k]
            inside = any(c.start <= word.start < c.end for c in self.claims)
            step = 1 if inside or word.text in ":(" else self.scan.length(k, "with", "and", "in", "article", "one", "is")
            if not step:
                return False
            k += step
        return end - start <= LONG

    def _natural(self, claim: Claim, mention: Mention) -> bool:
        return claim.kind != "count" or any(self.kinds.get(i) in natural(claim.name) for i in mention.ids)


def _decimal(prompt: str, i: int) -> bool:
    return prompt[i] == "." and 0 < i < len(prompt) - 1 and prompt[i - 1].isdigit() and prompt[i + 1].isdigit()
