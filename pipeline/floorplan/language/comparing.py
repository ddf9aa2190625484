"""Sizes against each other: "at least 1.5 times as large as", "half the size of", "all the same size"."""

from __future__ import annotations

from pipeline.floorplan.language.clause import Clause
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.subjects import listed


def factor(clause: Clause, k: int, e: Element) -> int:
    """Note a factor; "twice the living room" compares at once."""
    clause.factor = e
    ahead = next((x for x in clause.sentence[k + 1 :] if x.kind not in {"relative", "det"}), None)
    if ahead is not None and ahead.kind == "np":
        return compare(clause, k, e)
    return k + 1


def compare(clause: Clause, k: int, e: Element) -> int:
    """Read "at least 1.5 times as large as the largest bedroom"."""
    left = listed(clause) or clause.subject or clause.latest
    if e.value == "alike":
        rooms = tuple(i for x in clause.run for i in x.ids) if len(clause.latest) < 2 else clause.latest
        rooms = rooms if len(rooms) > 1 else clause.subject
        clause.state.say("area_equal", tuple(i for i in rooms if not i.startswith("*")), (), e, 0.15)
        return k + 1
    right, j = clause.after(k + 1, "cmp", left)
    ahead = next((x for x in clause.sentence[k + 1 : j] if x.kind == "np"), None)
    if ahead is not None and "largest" in ahead.adjectives:
        right = tuple(r.id for r in clause.stock.of(ahead.type))
    value = clause.factor.number or 1.0 if clause.factor else 1.0
    if clause.factor is None:
        behind = clause.sentence[j] if j < len(clause.sentence) else None
        if behind is not None and behind.kind == "factor":
            value, j = behind.number or 1.0, j + 1
    if left and right:
        clause.state.understood(e.first, e.last)
        clause.state.understood(*((clause.factor.first, clause.factor.last) if clause.factor else (e.first, e.last)))
    clause.factor = None
    a, b = (right, left) if e.value == "smaller" else (left, right)
    if value < 1.0:  # "half the size of"
        a, b, value = b, a, 1.0 / value
    if clause.negative:
        a, b, clause.negative = b, a, None
    if e.value == "equal" and a and b:
        clause.state.say("area_equal", (*a, *b), (), e, 0.15)
    elif a and b:
        for x in a:
            clause.state.say("area_order", (x,), tuple(i for i in b if i != x), e, value)
    clause.latest, clause.run = right, []
    return max(j, k + 1)


def superlative(clause: Clause, e: Element) -> None:
    """Read "the living room should be the largest room"."""
    if e.value in {"largest", "smallest"} and len(clause.latest) == 1:
        clause.state.say(f"{e.value}_of_all", clause.latest, (), e)
