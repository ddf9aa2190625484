"""What an amount measures: the room beside it, or the whole home."""

from __future__ import annotations

from dataclasses import replace

from pipeline.floorplan.defaults import DEFAULTS
from pipeline.floorplan.language.facts import Group, Reading
from pipeline.floorplan.language.marks import Mark
from pipeline.floorplan.language.phrases import Element

LISTED = 1.3  # the same behind a list of three rooms and more
NAMED = {"doors", "corridors", "ceiling", "walls", "inner_walls", "outer_walls"}  # what a length may measure besides rooms
EACH = 1.6  # an area of so many usual areas a room, behind the rooms that a home is told by, is the home's
HUGE = 5.0  # the same behind a room of a home that has no area yet
WHOLE = 1.6  # an area of so many usual areas of the room in front of it, set off by a comma, is the home's


def belongs(state: Reading, sentence: list[Element], e: Element, mark: Mark) -> bool:
    """Whether an amount right behind a room measures the home: "... kitchen and bath 85 m²"."""
    if mark.value != "area" or not e.ids:
        return False
    if mark.last <= e.first:  # "1BR 1BA 550 sf galley kitchen"
        before = [x for x in sentence if x.kind == "np" and x.last <= mark.first]
        return len(before) > 1 and mark.number > 3 * sum(DEFAULTS[state.inventory.get(i).type].area for i in e.ids)
    if mark.total:
        return True
    usual = sum(DEFAULTS[state.inventory.get(i).type].area for i in e.ids)
    k = next(i for i, x in enumerate(sentence) if x is e)
    rooms = [x for x in sentence if x.kind == "np"]
    measured = [x for x in rooms if x.amounts]
    last = not any(x.kind == "np" and x.first >= mark.last for x in sentence[k + 1 :])
    listed = len(rooms) > 2 or (
        any(x.kind == "home" and not x.amounts for x in sentence[:k]) and mark.first == e.last and mark.text[0].isdigit()
    )
    if len(measured) == 1 and rooms.index(e) and mark.number > HUGE * usual:
        return True  # "1BR 1BA 550 sf, galley kitchen"
    total = k + 1 < len(sentence) and sentence[k + 1].kind == "flag" and sentence[k + 1].value == "total"
    each = mark.number / len(e.ids)  # "un piso de tres dormitorios de unos 95 metros cuadrados"
    if k and sentence[k - 1].kind == "home" and len(e.ids) > 1 and not sentence[k - 1].amounts and each > EACH * usual / len(e.ids):
        return True
    huge = home_before(sentence, k) and mark.number > HUGE * usual
    return total or (len(measured) == 1 and huge) or (listed and len(measured) == 1 and last and mark.number > 2.5 * usual)


def share(state: Reading, sentence: list[Element], k: int, rooms: Group) -> int:
    """Deal the area of one open space, said beside the words for it at k, out to its rooms; return where reading goes on."""
    ahead, before = sentence[k + 1 : k + 2], sentence[k - 1 : k]
    near = [x for x in (*ahead, *before) if x.kind == "amount" and x.value == "area" and x.mark is not None]
    if not near or near[0].mark is None:
        return k + 1
    mark, usual = near[0].mark, [DEFAULTS[state.inventory.get(i).type].area for i in rooms]
    state.amounts = [(m, ids) for m, ids in state.amounts if m is not mark]
    state.understood(mark.first, mark.last)
    state.amounts.append((replace(mark, parts=tuple(round(mark.number * u / sum(usual), 2) for u in usual)), rooms))
    return k + 1 + (near[0] in ahead)


def home_before(sentence: list[Element], k: int) -> bool:
    """Whether a home without an area of its own is spoken of before k."""
    return any(x.kind == "home" and not x.amounts for x in sentence[:k])


def attach(state: Reading, sentence: list[Element], k: int, mark: Mark, latest: Group, home: bool = False) -> None:  # noqa: PLR0911 - one branch per case: a grammar
    """Attach an amount that stands by itself, or behind the word for the home."""
    state.understood(mark.first, mark.last)
    if mark.value == "storeys":
        if mark.number >= 1:
            state.storeys = state.storeys or (int(mark.number), mark)
        return
    if mark.value == "rooms":
        count = 2 if mark.number == 1.5 else int(mark.number)  # of one and a half, the half is to sleep in
        state.rooms = state.rooms or (count, mark)
        return
    if mark.value == "car":
        return
    around = [x for x in sentence[max(0, k - 2) : k + 2] if x.kind == "flag"]
    if mark.total or any(x.value == "total" for x in around):
        state.amounts.append((mark, None))
        return
    if mark.value == "length":
        before = next((x for x in reversed(sentence[:k]) if x.kind in {"flag", "np"} and x.value not in {"wide", "only"}), None)
        after = sentence[k + 1] if k + 1 < len(sentence) else None
        for x in (before, after):
            if x is not None and x.kind == "flag" and x.value in NAMED:
                state.amounts.append(
                    (Mark(mark.kind, x.value, mark.number, False, mark.first, mark.last, mark.text, bound=mark.bound), None)
                )
                return
    if mark.value == "area" and k and sentence[k - 1].kind == "cue" and sentence[k - 1].value == "in":
        state.amounts.append((mark, None))  # "ten rooms in 40 m2"
        return
    if mark.value == "area" and latest == ("*",) and k and sentence[k - 1].kind in {"every", "verb", "det"}:
        state.amounts.append((mark, latest))  # "every room at least 9 m2"
        return
    rooms = tuple(i for i in latest if not i.startswith(("*", "<")))
    if home or not rooms:
        state.amounts.append((mark, None))
        return
    if _closes(state, sentence, k, mark, rooms):
        state.amounts.append((mark, None))
        return
    state.amounts.append((mark, rooms))


def _closes(state: Reading, sentence: list[Element], k: int, mark: Mark, rooms: Group) -> bool:
    """Whether an area set off by a comma or a colon is the home's: more than the room in front would take."""
    if mark.value != "area" or not k:
        return False
    before = next((x.kind for x in reversed(sentence[:k]) if x.kind != "word"), "")
    if before not in {"comma", "and"}:
        return False
    usual = sum(DEFAULTS[state.inventory.get(i).type].area for i in rooms)
    named = [x for x in sentence[:k] if x.kind == "np"]
    home = any(x.kind == "home" for x in sentence[:k])
    measured = any(x.amounts for x in named)
    if len(named) > 2 and not measured and mark.number > LISTED * usual:
        return True
    return not measured and mark.number > WHOLE * usual and (home or (len(named) > 1 and mark.number > 2.5 * usual))
