"""Sizes: which room, or the home, an amount measures, and rooms against each other."""

from __future__ import annotations

from dataclasses import replace

from pipeline.floorplan.language.clause import Clause, ids_of, known
from pipeline.floorplan.language.facts import Group
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.tokens import Mark
from pipeline.floorplan.program.defaults import DEFAULTS

NAMED = {"doors", "corridors", "ceiling", "walls", "inner_walls", "outer_walls"}  # what a length may measure besides rooms
LIKE = 0.15  # two rooms are alike where they differ by less
HUGE, LARGE, MORE, LISTED = 5.0, 2.5, 1.6, 1.3  # times the usual area of the room in front: from there on an area is the home's


def usual(c: Clause, ids: Group) -> float:
    """Return the usual area of rooms together [m2]."""
    return sum(DEFAULTS[c.stock.get(i).type].area for i in ids)


def measures_home(c: Clause, k: int, mark: Mark, ids: Group) -> bool:
    """Whether an area right at the room k measures the home: "... kitchen and bath 85 m²"."""
    if mark.value != "area" or not ids:
        return False
    rooms = [x for x in c.sentence if x.kind == "np"]
    times = mark.number / usual(c, ids)
    before, behind = c.near(k - 1), c.near(k + 1)
    if mark.total or (behind is not None and behind.value == "total"):
        return True
    if sum(bool(x.amounts) for x in rooms) != 1:
        return False
    home = any(x.kind == "home" and not x.amounts for x in c.sentence[:k])
    told = before is not None and before.kind == "home" and not before.amounts and len(ids) > 1
    if told and times > MORE:  # "un piso de tres dormitorios de unos 95 metros cuadrados"
        return True
    last = not any(x.first >= mark.last for x in rooms)
    near = len(rooms) > 2 or (home and mark.first == c.sentence[k].last and mark.text[0].isdigit())
    return (times > HUGE and (home or rooms[0] is not c.sentence[k])) or (near and last and times > LARGE)


def attach(c: Clause, k: int, mark: Mark, *, home: bool = False) -> None:
    """Attach an amount that stands by itself, or behind the word for the home."""
    state = c.state
    around = c.sentence[max(0, k - 2) : k + 2]
    before, ahead = c.near(k - 1), c.near(k + 1)
    rooms = () if home else tuple(i for i in known(c.latest) if not i.startswith("<"))
    if mark.value == "storeys":
        state.storeys = state.storeys or ((int(mark.number), mark) if mark.number >= 1 else None)
    elif mark.value == "rooms":  # of one and a half, the half is to sleep in
        state.rooms = state.rooms or (2 if mark.number == 1.5 else int(mark.number), mark)
    elif mark.total or any(x.kind == "flag" and x.value == "total" for x in around):
        state.amounts.append((mark, None))
    elif mark.value == "length":
        named = next((x for x in reversed(c.sentence[:k]) if x.kind in {"flag", "np"} and x.value not in {"wide", "only"}), None)
        what = next((x.value for x in (named, ahead) if x is not None and x.kind == "flag" and x.value in NAMED), "")
        state.amounts.append((replace(mark, value=what), None) if what else (mark, rooms or None))
    elif mark.value == "area" and before is not None and (before.kind, before.value) == ("cue", "in") and not home:
        state.amounts.append((mark, None))  # "ten rooms in 40 m2"
    elif mark.value == "area" and c.latest == ("*",) and before is not None and before.kind in {"every", "verb", "det"}:
        state.amounts.append((mark, c.latest))  # "every room at least 9 m2"
    elif mark.value != "car":
        state.amounts.append((mark, rooms if rooms and not _closes(c, k, mark, rooms) else None))


def _closes(c: Clause, k: int, mark: Mark, rooms: Group) -> bool:
    """Whether an area set off by a comma is the home's: more than the room in front would take."""
    before = next((x.kind for x in reversed(c.sentence[:k]) if x.kind != "word"), "")
    named = [x for x in c.sentence[:k] if x.kind == "np"]
    if mark.value != "area" or before not in {"comma", "and"} or any(x.amounts for x in named):
        return False
    times = mark.number / usual(c, rooms)
    home = any(x.kind == "home" for x in c.sentence[:k])
    return (len(named) > 2 and times > LISTED) or (home and times > MORE) or (len(named) > 1 and times > LARGE)


def share(c: Clause, k: int, rooms: Group) -> int:
    """Deal the area of one open space, said beside the words for it at k, out to its rooms; return where reading goes on."""
    near = [x for x in (c.near(k + 1), c.near(k - 1)) if x is not None and x.kind == "amount" and x.value == "area" and x.mark is not None]
    if not near or near[0].mark is None:
        return k + 1
    mark = near[0].mark
    whole = usual(c, rooms)
    parts = tuple(round(mark.number * usual(c, (i,)) / whole, 2) for i in rooms)
    c.state.amounts = [(m, ids) for m, ids in c.state.amounts if m is not mark]
    c.state.amounts.append((replace(mark, parts=parts), rooms))
    return k + 1 + (near[0] is c.near(k + 1))


def factor(c: Clause, k: int, e: Element) -> int:
    """Note a factor; "twice the living room" compares at once."""
    c.factor = e
    ahead = c.ahead(k + 1, "relative", "det")
    return compare(c, k, e) if ahead is not None and ahead.kind == "np" else k + 1


def compare(c: Clause, k: int, e: Element) -> int:
    """Read "at least 1.5 times as large as the largest bedroom"."""
    left = c.listed() or c.subject or c.latest
    if e.value == "alike":
        rooms = c.latest if len(c.latest) > 1 else ids_of(c.run)
        c.state.say("area_equal", known(rooms if len(rooms) > 1 else c.subject), (), e, LIKE)
        return k + 1
    right, j = c.after(k + 1, "cmp", left)
    behind = c.near(j)
    if c.factor is None and behind is not None and behind.kind == "factor":
        c.factor, j = behind, j + 1
    value = (c.factor.number or 1.0) if c.factor else 1.0
    if left and right:
        c.state.understood(e.first, e.last)
        c.state.understood(*((c.factor.first, c.factor.last) if c.factor else (e.first, e.last)))
        turned = (e.value == "smaller") != (value < 1.0)
        a, b = (right, left) if turned != (c.negative is not None) else (left, right)  # "half the size of", "not larger than"
        if e.value == "equal":
            c.state.say("area_equal", (*a, *b), (), e, LIKE)
        for x in a if e.value != "equal" else ():
            c.state.say("area_order", (x,), tuple(i for i in b if i != x), e, 1.0 / value if value < 1.0 else value)
        c.deny()
    c.factor, c.latest, c.run = None, right, []
    return max(j, k + 1)
