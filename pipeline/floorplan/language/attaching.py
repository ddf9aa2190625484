"""Wishes for furniture taken out of a prompt, and the rooms that they are for."""

from __future__ import annotations

import bisect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pipeline.floorplan.language.furnishing import Claim, Scan
from pipeline.floorplan.language.vocabulary import STOPS, words
from pipeline.floorplan.program.consistency import ImpossibleError
from pipeline.floorplan.program.floor_program import MAX_PIECES, Evidence, FloorProgram, Furniture, RoomReq, Things
from pipeline.floorplan.program.furniture import natural


def read_furniture(prompt: str) -> tuple[str, list[Claim]]:
    """Return the prompt without its wishes for furniture (blanks in their place, so that places hold), and the wishes."""
    scan = Scan(prompt)
    claims = scan.run()
    return (masked(scan, claims) if claims else prompt), claims


def masked(scan: Scan, claims: Sequence[Claim]) -> str:
    """Blank the wishes, what joins them, and what leads to them."""
    covered = _covered(scan, claims)
    blank = list(covered)
    k = 0
    while k < len(scan.words):
        if not covered[k]:
            k += 1
            continue
        last = k
        while True:  # go on over what joins two wishes
            j = last + 1
            while j < len(scan.words) and not covered[j] and (step := scan.phrase(j, "and", "with", "article")[0]):
                j += step
            if j < len(scan.words) and covered[j]:
                blank[last : j + 1] = [True] * (j + 1 - last)
                last = j
            else:
                break
        _lead(scan, blank, k, last)
        k = last + 1
    text = list(scan.prompt)
    for w, gone in zip(scan.words, blank, strict=True):
        if gone:
            text[w.start : w.end] = " " * (w.end - w.start)
    return "".join(text)


def _covered(scan: Scan, claims: Sequence[Claim]) -> list[bool]:
    """Tell which words belong to a wish; "everywhere" belongs to the wish for the whole home that it stands by."""
    spans = sorted((c.start, c.end) for c in claims)
    covered = [False] * len(scan.words)
    k = 0
    for start, end in spans:
        while k < len(scan.words) and scan.words[k].start < start:
            k += 1
        j = k
        while j < len(scan.words) and scan.words[j].start < end:
            covered[j] = True
            j += 1
    marks = [(j, step) for j in range(len(scan.words)) if (step := scan.phrase(j, "home")[0])]
    for c in (c for c in claims if c.home):
        for j, step in marks:
            if c.start - 40 < scan.words[j].start < c.end + 40:
                covered[j : j + step] = [True] * step
    return covered


def _lead(scan: Scan, blank: list[bool], first: int, last: int) -> None:
    """Blank the "with" before a run of wishes, or, where a room of the same owner follows, the "and" after it."""
    lead = next((n for n in (3, 2, 1) if first - n >= 0 and scan.phrase(first - n, "with")[0] == n), 0)
    join = scan.phrase(last + 1, "and")[0]
    follows = range(last + 1 + join, min(last + 4 + join, len(scan.words)))
    shared = bool(join) and scan.words[last + 1].text not in STOPS and any(scan.phrase(j, "own_rooms")[0] for j in follows)
    if lead and shared:
        blank[last + 1 : last + 1 + join] = [True] * join
    elif lead:
        blank[first - lead : first] = [True] * lead


LONG = 400  # characters of a list of wishes
FAR = 24  # characters between a wish and the room that follows it


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
    named = list(mentions) if mentions is not None else mentioned(program)
    kinds = {r.id: r.type for r in program.rooms}
    stops = [-1, *(i for i, c in enumerate(prompt) if c in STOPS and not _decimal(prompt, i)), len(prompt)]
    made: dict[str, list[Claim]] = {}
    evidence: list[dict[str, Any]] = []
    for claim in claims:
        every = tuple(kinds) if claim.home and claim.kind in {"pieces", "openable"} else ()
        ids = every or _targets(claim, claims, named, kinds, prompt, stops)
        for room in ids or ("",):
            made.setdefault(room, []).append(claim)
            where = f"rooms.{room}.furniture" if room else "furniture"
            field = f"{where}.{claim.name if claim.kind == 'count' else claim.kind}"
            evidence.append({"start": claim.start, "end": claim.end, "text": prompt[claim.start : claim.end], "field": field})
    rooms = [_with(r, made[r.id], prompt) if r.id in made else r for r in program.rooms]
    own = combined(made[""], prompt, "the home") if "" in made else program.furniture
    cited = tuple(Evidence.model_validate(e) for e in evidence)
    return program.model_copy(update={"rooms": tuple(rooms), "furniture": own, "evidence": (*program.evidence, *cited)})


def mentioned(program: FloorProgram) -> list[Mention]:
    """Return where the prompt names rooms, in its order."""
    found: dict[tuple[int, int], list[str]] = {}
    ids = {r.id for r in program.rooms}
    for e in program.evidence:
        room = e.field.removeprefix("rooms.")
        if e.field.startswith("rooms.") and room in ids:
            found.setdefault((e.start, e.end), []).append(room)
    return [Mention(start, end, tuple(dict.fromkeys(rooms))) for (start, end), rooms in sorted(found.items())]


def combined(claims: Sequence[Claim], prompt: str, where: str) -> Furniture:
    """Return the wishes that claims of one room make together. Raises ImpossibleError naming words that clash."""
    counts: dict[str, Things] = {}
    fields: dict[str, Any] = {}
    for claim in claims:
        if max(claim.least, claim.most or 0) > MAX_PIECES:
            _clash(
                f"{max(claim.least, claim.most or 0)} things are asked for in {where}, and {MAX_PIECES} are the most",
                [claim],
                claim,
                prompt,
            )
        if claim.kind == "count":
            old = counts.get(claim.name, Things(category=claim.name))
            most = min((m for m in (old.max, claim.most) if m is not None), default=None)
            least = max(old.min, claim.least)
            if most is not None and least > most:
                _clash(f"{where} is to have at least {least} and at most {most} {claim.name.removeprefix('any_')}", claims, claim, prompt)
            counts[claim.name] = Things(category=claim.name, min=least, max=most)
        elif claim.kind == "pieces":
            most = min((m for m in (fields.get("most"), claim.most) if m is not None), default=None)
            least = max(fields.get("least") or 0, claim.least)
            if most is not None and least > most:
                _clash(f"{where} is to have at least {least} and at most {most} pieces", claims, claim, prompt)
            fields |= {"least": least or None, "most": most}
        elif claim.kind == "style":
            if fields.get("style", claim.name) != claim.name:
                _clash(f"{where} is to be both {fields['style']} and {claim.name}", claims, claim, prompt)
            fields["style"] = claim.name
        elif claim.kind == "openable":
            fields["openable"] = max(fields.get("openable", 0), claim.least)
        elif claim.value > 1.0:
            _clash(f"{claim.value:.0%} of {where} are to be free", [claim], claim, prompt)
        else:
            fields["walkable"] = max(fields.get("walkable", 0.0), claim.value)
    return Furniture.model_validate({**fields, "counts": tuple(counts.values())})


def _clash(message: str, claims: Sequence[Claim], claim: Claim, prompt: str) -> None:
    both = [c for c in claims if c.kind == claim.kind and c.name in ({claim.name} if claim.kind == "count" else {c.name})]
    words_said = [Evidence(start=c.start, end=c.end, text=prompt[c.start : c.end], field="furniture") for c in both]
    raise ImpossibleError(message, "keep one of the two", words_said)


def _with(room: RoomReq, claims: Sequence[Claim], prompt: str) -> RoomReq:
    return room.model_copy(update={"furniture": combined(claims, prompt, room.id)})


def _targets(  # noqa: PLR0911 - one return per rule
    claim: Claim, claims: Sequence[Claim], named: Sequence[Mention], kinds: Mapping[str, str], prompt: str, stops: Sequence[int]
) -> tuple[str, ...]:
    """Return the ids of the rooms that a claim means, () for the whole home."""
    if claim.home:
        return ()
    place = bisect.bisect_left(stops, claim.start)
    begin, end = stops[place - 1] + 1, stops[place]
    before = [m for m in named if begin <= m.start and m.end <= claim.start]
    if before and claim.kind != "count" and Scan(prompt[before[-1].end : before[-1].end + 40]).phrase(0, "dwelling")[0]:
        return ()  # "a two-bedroom flat with 30 pieces": the flat's
    after = [m for m in named if claim.end <= m.start and m.end <= end]
    if claim.inward and after and after[0].start - claim.end <= FAR:
        return after[0].ids
    if prompt[claim.end :].startswith("的") and after and after[0].start - claim.end <= 4:  # "带淋浴的卫生间"
        return after[0].ids
    if claim.kind == "style":
        return _styled(claim, claims, before, after, prompt)
    if before:
        nearest = before[-1]
        if _joined(prompt, nearest.end, claim.start, claims) or _natural(claim, nearest, kinds):
            return nearest.ids
        better = [m for m in [*reversed(before), *after, *named] if _natural(claim, m, kinds)]
        return (better[0] if better else nearest).ids
    if after and claim.kind != "count" and after[0].start - claim.end <= FAR // 2:
        return after[0].ids
    likely = [m for m in [*after, *named] if _natural(claim, m, kinds)]
    if claim.kind == "count" and likely and claim.least:
        return likely[0].ids
    earlier = [m for m in named if m.end <= claim.start]
    if earlier and begin and claim.kind != "walkable" and _pronoun(prompt[begin : claim.start]):
        return earlier[-1].ids
    return ()


def _styled(claim: Claim, claims: Sequence[Claim], before: Sequence[Mention], after: Sequence[Mention], prompt: str) -> tuple[str, ...]:
    """Return whose style it is: a room's where it stands in the room's list of wishes or right before its name, else the home's."""
    if before and _joined(prompt, before[-1].end, claim.start, claims):
        own = [c for c in claims if c is not claim and before[-1].end <= c.start < claim.start]
        said = {w.text for w in words(prompt[before[-1].end : claim.start])}
        if (
            own
            or said & {"in", "im", "with", "mit", "con", "de", "en", "is", "ist", "es"}
            or any("\u4e00" <= ch <= "\u9fff" for ch in claim_text(claim, prompt))
        ):
            return before[-1].ids
    if after and not prompt[claim.end : after[0].start].strip():
        scan = Scan(prompt[after[0].end : after[0].end + 40])
        if not scan.phrase(0, "dwelling")[0]:
            return after[0].ids
    return ()


def claim_text(claim: Claim, prompt: str) -> str:
    """Return the words of a claim."""
    return prompt[claim.start : claim.end]


def _joined(prompt: str, start: int, end: int, claims: Sequence[Claim]) -> bool:
    """Whether between two places stands nothing but other wishes and what joins them."""
    if end - start > LONG:
        return False
    text = list(prompt[start:end])
    for c in claims:
        for i in range(max(c.start, start), min(c.end, end)):
            text[i - start] = " "
    scan = Scan("".join(text))
    k = 0
    while k < len(scan.words):
        step = scan.phrase(k, "with", "and", "in", "article", "one")[0]
        if not step and scan.words[k].text not in {
            "each",
            "jeweils",
            "cada",
            "uno",
            "is",
            "are",
            "ist",
            "sind",
            ":",
            "(",
            "should",
            "must",
            "also",
            "auch",
            "furnished",
        }:
            return False
        k += step or 1
    return True


def _natural(claim: Claim, mention: Mention, kinds: Mapping[str, str]) -> bool:
    return claim.kind != "count" or any(kinds.get(i) in natural(claim.name) for i in mention.ids)


def _pronoun(text: str) -> bool:
    first = [w.text for w in words(text)][:3]
    return bool({"it", "its", "there", "this", "they", "es", "dort", "darin", "sie", "alli", "ahi", "este", "esta", "它"} & set(first))


def _decimal(prompt: str, i: int) -> bool:
    return prompt[i] == "." and 0 < i < len(prompt) - 1 and prompt[i - 1].isdigit() and prompt[i + 1].isdigit()
