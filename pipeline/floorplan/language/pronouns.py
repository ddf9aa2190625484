"""Pronouns, determiners and flags that stand alone, and the amounts that are said of rooms."""

from __future__ import annotations

from dataclasses import replace

from pipeline.floorplan.language.facts import SOCIAL, Clause, Group, Reading
from pipeline.floorplan.language.marks import Mark
from pipeline.floorplan.language.naming import name
from pipeline.floorplan.language.objects import one_each
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.remarks import merge_after, storey, windows
from pipeline.floorplan.language.ways import listed
from pipeline.floorplan.program.defaults import DEFAULTS

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


ONE_THAT = {"in", "ensuite", "near", "door"}  # what tells the second of "one bathroom for guests and one inside the master"


def pronoun(clause: Clause, k: int, e: Element) -> int:
    """Read a pronoun: the rooms that it stands for are spoken of next."""
    ahead = next((x for x in clause.sentence[k + 1 :] if x.kind not in {"det", "verb"}), None)
    if e.value == "rest" and ahead is not None and ahead.kind in {"level", "colon"}:
        return every(clause, k, e)
    if e.text == "which" and k and clause.sentence[k - 1].kind == "comma" and clause.latest and not clause.latest[0].startswith("*"):
        clause.subject, clause.objects = clause.latest, ()  # "from the hall, which also gives access to ..."
        clause.run = [Element("np", "", e.first, e.last, e.text, ids=list(clause.latest))]
        return k + 1
    told = ahead is not None and (ahead.kind in {"owner", "level"} or (ahead.kind == "cue" and ahead.value in ONE_THAT))
    joined = k > 0 and clause.sentence[k - 1].kind in {"and", "comma"}
    like = clause.run[-1] if clause.run else None
    if e.value == "one" and told and joined and like is not None and like.kind == "np" and (like.number == 1.0 or "indefinite" in like.det):
        room = clause.stock.add(clause.stock.get(like.ids[0]).type, "", e.text, None)
        e.ids, clause.latest = [room.id], (room.id,)  # "one bathroom for guests and one inside the master"
        clause.run = clause.run if ahead is not None and ahead.kind == "level" else []
        clause.subject = (room.id,)
        clause.state.understood(e.first, e.last)
        return k + 1
    whole = e.value == "group" and e.text.split()[0] in {"todos", "todas", "all", "alle"} and len(clause.run) > 1
    group = (
        tuple(i for x in clause.run for i in x.ids)
        if whole
        else clause.point(e, k, clause.subject if e.value == "it" and (clause.objects or clause.run) else ())
    )
    spoken = [i for g in (clause.subject, *reversed(clause.state.past)) for i in g if not i.startswith("*")]
    bed = next((i for i in spoken if clause.stock.get(i).type == "bedroom"), None)
    if e.value == "rest" and bed is not None and (count := _others(clause, e)):
        group = _made(clause, bed, count)
    if e.value in {"group", "both"} and set(group) > set(clause.left_out):
        group = tuple(i for i in group if i not in clause.left_out)
    e.ids = list(group)
    if group:
        clause.state.understood(e.first, e.last)
        clause.run = [Element("np", "", e.first, e.last, e.text, ids=list(group))]
        clause.latest = group
        if e.value in {"one", "rest", "group", "both", "some"} or not clause.subject:
            clause.subject = group
    return k + 1


def _others(clause: Clause, e: Element) -> int:
    """Return how many "the other two" are."""
    lex = clause.state.heard.lexicon
    numbers = [m.number for w in e.text.split() if (m := lex.trie.get(w, {}).get("")) is not None and m.kind == "num"]
    return int(numbers[0]) if numbers else (2 if "beiden" in e.text else 0)


def _made(clause: Clause, like: str, count: int) -> Group:
    """Return so many rooms that nothing was said of, new ones where they are too few."""
    kind = clause.stock.get(like).type
    spoken = {i for x in clause.sentence for i in x.ids} | {i for g in clause.state.past[-1:] for i in g}
    free = [r for r in clause.stock.of(kind) if r.open_slot] or [r for r in clause.stock.of(kind) if r.id not in spoken]
    while len(free) < count:
        free.append(clause.stock.add(kind, "", "other", None))
    return tuple(r.id for r in free[:count])


def determiner(clause: Clause, k: int, e: Element) -> int:  # noqa: PLR0911 - one answer per case: a grammar
    """Read "both", "each", "all", "the other" where no room follows."""
    last = k + 1 >= len(clause.sentence) or clause.sentence[k + 1].kind in {"comma", "close"}
    if (
        (e.value == "each" or e.text in {"cada uno", "cada una"})
        and last
        and k
        and clause.sentence[k - 1].kind == "np"
        and len(clause.latest) == 1
    ):
        one_each(clause, e)
        return k + 1
    if e.value == "other" and next((x.kind for x in clause.sentence[k + 1 :] if x.kind != "verb"), "") in {"level", "colon"}:
        return every(clause, k, e)
    if e.value == "all" and k and clause.sentence[k - 1].kind == "every":
        return k + 1
    if e.value == "all" and clause.run[-1:] and clause.run[-1].det & {"all", "each"} and clause.sentence[k - 1] is clause.run[-1]:
        clause.run, clause.subject = clause.run[-1:], tuple(clause.run[-1].ids)  # "..., 所有卧室都从走廊进出"
        return k + 1
    if e.value == "all" and len(clause.run) > 1 and not any(x.kind == "np" for x in clause.sentence[k + 1 : k + 2]):
        clause.subject = clause.latest = tuple(
            dict.fromkeys(i for x in clause.run for i in x.ids)
        )  # "kitchen, two bedrooms, bath - all off the hall"
        clause.run = [Element("np", "", e.first, e.last, e.text, ids=list(clause.latest))]
        return k + 1
    ahead = clause.sentence[k + 1].kind if k + 1 < len(clause.sentence) else ""
    if e.value == "all" and not clause.run and clause.objects and k and clause.sentence[k - 1].kind == "comma" and ahead == "cue":
        both = tuple(dict.fromkeys((*clause.subject, *clause.objects)))  # "卫生间和厕所分开,都从走廊进"
        clause.subject = clause.latest = both
        clause.run = [Element("np", "", e.first, e.last, e.text, ids=list(both))]
        return k + 1
    if e.value == "other" and ahead in {"verb", "amount"}:  # "one bedroom of 16 m2, the other of 10"
        return pronoun(clause, k, Element("pron", "rest", e.first, e.last, e.text))
    if e.value in {"both", "each", "all"} and ahead != "np":
        return pronoun(clause, k, Element("pron", "both" if e.value == "both" else "group", e.first, e.last, e.text))
    return k + 1


def every(clause: Clause, k: int, e: Element) -> int:
    """Read "every room", "the rest": all rooms."""
    clause.state.understood(e.first, e.last)
    e.ids = ["*"]
    clause.push(k, e, ("*",))
    return k + 1


def cast(clause: Clause, who: Element, role: str) -> None:
    """Give rooms their user: bedrooms that have none yet."""
    for room in (clause.stock.get(i) for i in who.ids):
        room.role = room.role or (role if room.type == "bedroom" else "")


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
