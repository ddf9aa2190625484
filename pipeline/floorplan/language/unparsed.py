"""What nothing was made of: words that are in no vocabulary, and words that say something and are evidence of nothing."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pipeline.floorplan.language.facts import Reading
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.tokens import Mark

EMPTY = {"fill", "ignored", "adverb", "verb", "join", "but", "comma", "stop", "line", "colon", "open", "close", "slash", "bullet", "dash", "hyphen", "clf", "times", "relative", "home", "long", "bound", "enough", "fix", "unit", "to", "reciprocal", "look"}  # fmt: skip
READ = {"used", "corner"}  # what was read with its neighbours
# flags that hold wherever they stand, and such as only underline what is said
STRESS = {"total", "only", "closed", "luxury", "wheelchair", "step_free", "single", "no_hall", "shape_l", "shape_t", "rectangle", "narrow", "chamfered"}  # fmt: skip
POINTING = {"each", "other", "own", "another"}  # determiners that say something
LEADING = {"num", "ord", "adj", "size", "det", "clf", "times", "amount", "fill", "look"}  # in front of a room


def unparsed(
    state: Reading, parsed: list[list[Element]], evidence: Sequence[Mapping[str, Any]], marks: Sequence[Mark]
) -> Iterator[tuple[int, int]]:
    """Yield what nothing was made of: words that are in no vocabulary, and words that say something and stand in no evidence."""
    tokens = state.heard.tokens
    places = [{k for k, t in enumerate(tokens) if e["start"] <= t.start and t.end <= e["end"]} for e in evidence]
    cited = _consumed(state, parsed, places, evidence)
    for k, mark in enumerate(marks):
        if mark.last > mark.first and (mark.kind == "word" or not cited & set(range(mark.first, mark.last))) and _says(state, marks, k):
            yield tokens[mark.first].start, tokens[mark.last - 1].end


def _consumed(state: Reading, parsed: list[list[Element]], places: Sequence[set[int]], evidence: Sequence[Mapping[str, Any]]) -> set[int]:
    """Return the tokens that something was made of: evidence, what belongs to a phrase in it, and words that only help a statement."""
    cited = state.used.union(*places)
    stated = set().union(
        *(p for p, e in zip(places, evidence, strict=True) if e["field"].split(".")[0] != "rooms" or e["field"].count(".") > 1)
    )
    roles = {r.role for r in state.inventory.rooms}
    starred = any("*" in f.a + f.b for f in state.facts) or any(ids == ("*",) for _, ids in state.amounts)
    for sentence in parsed:
        ends = [-1, *(k for k, e in enumerate(sentence) if e.kind in {"comma", "but"}), len(sentence)]
        for a, b in itertools.pairwise(ends):
            part = sentence[a + 1 : b]
            told = bool(part) and bool(stated & set(range(min(e.first for e in part), max(e.last for e in part))))
            told = told or any(e.kind == "flag" and e.value in STRESS for e in part)
            for k, e in enumerate(part):
                if (
                    e.kind in READ
                    or (e.kind == "owner" and (e.value in roles or any(x.kind in {"np", "home"} for x in part[:k])))
                    or (e.kind == "every" and (starred or told))
                    or (e.kind == "flag" and e.value in STRESS)
                    or (told and (e.kind in {"flag", "det", "pron"} or (e.kind, e.value) in {("cue", "from"), ("adj", "open")}))
                ):
                    cited.update(range(e.first, e.last))
                elif e.kind == "np" and (e.ids or e.banned):
                    cited.update(i for m in e.taken for i in range(m.first, m.last))
    return cited


def _says(state: Reading, marks: Sequence[Mark], k: int) -> bool:
    """Whether the mark at k says something by itself."""
    mark = marks[k]
    if mark.kind in EMPTY or (mark.kind == "det" and mark.value not in POINTING):
        return False
    if mark.kind == "cue":
        return mark.value not in {"has", "in"} and mark.text not in state.heard.lexicon.sign("quiet")
    if mark.kind == "pron" and mark.value in {"it", "one"}:
        return False
    if (mark.kind, mark.value) in {("adj", "closed"), ("adj", "plain")} or (k and mark.kind == "size" and marks[k - 1].kind == "amount"):
        return False  # what is not open is apart anyway; "20 m² groß"
    ahead = marks[k + 1] if k + 1 < len(marks) else None
    head = next((m for m in marks[k + 1 :] if m.kind not in LEADING | {"owner", "word"}), None)
    if mark.kind in LEADING and head is not None and head.kind == "home":
        return False  # "a shared student flat"
    return not (mark.kind == "num" and ahead is not None and ahead.kind in {"owner", "fill", "word", "verb"})  # "three generations"
