"""What is said without a room of its own: daylight, "in one open space", "at opposite ends", "in a row", "on each floor"."""

from __future__ import annotations

from pipeline.floorplan.language.clause import Clause
from pipeline.floorplan.language.facts import SOCIAL
from pipeline.floorplan.language.naming import name
from pipeline.floorplan.language.openness import merge_after, windows
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.places import storey
from pipeline.floorplan.language.quantities import share
from pipeline.floorplan.language.subjects import listed


def flag(clause: Clause, k: int, e: Element) -> int:
    """Read one flag; return where to go on."""
    clause.state.understood(e.first, e.last)
    clause.state.flags.setdefault(e.value, e)
    negative = clause.negated(k)
    if e.value == "daylight":
        return windows(clause, k, e, negative)
    if e.value == "ends" and len(clause.latest) == 2 and k and clause.sentence[k - 1].kind in {"np", "verb", "det", "word", "cue", "home"}:
        clause.state.say("away", clause.latest[:1], clause.latest[1:], e)
    elif e.value == "too" and clause.state.facts and k + 1 < len(clause.sentence) and clause.sentence[k + 1].kind == "np":
        last = clause.state.facts[-1]  # "..., ebenso das Bad"
        clause.state.say(last.what, tuple(name(clause.state, clause.sentence, k + 1, storey(clause, k + 1))), last.b, e)
    elif e.value == "too" and clause.run and clause.state.facts:
        last = clause.state.facts[-1]
        clause.state.say(last.what, listed(clause), last.b, e)
    elif e.value == "only":
        clause.only = e
        if clause.state.facts and clause.state.facts[-1].what in {"door", "leads"} and k and clause.sentence[k - 1].kind == "np":
            clause.state.say("only", clause.state.facts[-1].a, (), e)
    elif e.value == "each_floor":
        _each_floor(clause, e)
    elif e.value == "row" and len(clause.run) > 1:
        clause.state.say("door", tuple(i for x in clause.run for i in x.ids), (), e)
    elif e.value == "open_plan" and negative:
        clause.state.flags["closed_plan"] = e
        clause.negative = None
    elif e.value == "open_plan":
        social = tuple(i for x in clause.run for i in x.ids if not i.startswith("*") and clause.stock.get(i).type in SOCIAL)
        if len(social) > 1:
            clause.state.say("merge", social, (), e)
            return share(clause.state, clause.sentence, k, social)
        merge_after(clause, k + 1, e)
    return k + 1


def _each_floor(clause: Clause, e: Element) -> None:
    """Read "a toilet on each floor": one more for every storey but the first."""
    rooms = [clause.stock.get(i) for i in clause.latest if not i.startswith("*")]
    if len(rooms) != 1:
        return
    rooms[0].level = 0
    storeys = clause.state.storeys[0] if clause.state.storeys else 2
    for level in range(1, storeys):
        clause.stock.add(rooms[0].type, "", e.text, level)
    clause.state.levels.append(Element("level", str(storeys - 1), e.first, e.last, e.text))
