"""Reads sentences from left to right: what each kind of element says about the rooms around it."""

from collections.abc import Callable, Mapping
from dataclasses import replace

from pipeline.floorplan.language.clause import LIKE, Clause, compare, factor, ids_of, level, named_rooms, wing
from pipeline.floorplan.language.marks import Mark
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.relations import complete, enter, relate
from pipeline.floorplan.language.rooms import PERSONAL, SOCIAL, Group, Reading
from pipeline.floorplan.program.defaults import DEFAULTS

NAMED = {"doors", "corridors", "ceiling", "walls", "inner_walls", "outer_walls"}  # what a length may measure besides rooms
HUGE, LARGE, MORE, LISTED = 5.0, 2.5, 1.6, 1.3  # times the usual area of the room in front: from there on an area is the home's


def read(state: Reading, sentence: list[Element]) -> None:
    """Read one sentence."""
    c = Clause(state, sentence)
    k = 0
    while k < len(c.sentence):
        e = c.sentence[k]
        k = (READERS[e.kind](c, k, e) if e.kind in READERS else None) or k + 1
    if c.waiting:
        complete(c)
    state.topic = named_rooms(c.subject) or state.topic
    state.past = [*state.past, *(tuple(e.ids) for e in c.sentence if e.ids and e.kind == "np")][-12:]


# each reads one kind of element and returns where reading goes on, None for the next one


def _np(c: Clause, k: int, e: Element) -> None:
    if e.banned:
        _ban(c, e)
        return
    before = c.near(k - 1)
    said = before is not None and before.kind in {"np", "pron"} and not e.det
    if e.role == "ensuite" and e.type == "bathroom" and not e.ids and said:  # "one of them en suite"
        baths = named_rooms(c.latest)
        hosts = sorted(c.stock.of("bedroom"), key=lambda r: r.role != "primary")[: len(baths)]
        for bath in map(c.stock.get, baths):
            bath.role = "ensuite"
        c.give(baths, tuple(r.id for r in hosts), e)
        return
    if c.owner and "own" in e.det and not e.ids and e.type == "bathroom":  # "the parents have a private bathroom"
        free = [r for r in c.stock.of(e.type) if r.open_slot and not r.role]
        e.ids = [(free[0] if free else c.stock.add(e.type, "", e.text, None)).id]
    ids = c.rooms_at(k)
    if c.left_out and e.det & {"each", "all"} and set(ids) > set(c.left_out):
        ids, c.run = tuple(i for i in ids if i not in c.left_out), []
    _own(c, e, ids)
    for mark, rooms in c.shares(e, ids):
        whole = (e.compound and mark.last <= e.first) or _measures_home(c, k, mark, tuple(e.ids), set_off=False)
        c.state.amounts.append((mark, None if whole else rooms))
    c.push(k, e, ids)
    _describe_rooms(c, k, e, ids)


def _describe_rooms(c: Clause, k: int, e: Element, ids: tuple[str, ...]) -> None:
    """Record what adjectives say of rooms."""
    same = tuple(r.id for r in c.stock.of(e.type))
    if "melted" in e.adjectives:  # "lounge diner"
        c.state.say("merge", (*ids, *c.rooms_at(k + 2)), (), e)
    elif e.adjectives & {"open", "combined"} and e.type == "kitchen" and "closed_plan" not in c.state.flags:
        c.state.say("open_kitchen", ids, (), e)
    if "closed" in e.adjectives and e.type == "kitchen":
        c.state.say("closed", ids, (), e)
    if e.suite:
        c.state.say("suite", ids, (), e)
    for what in e.adjectives & {"largest", "smallest"} if not c.factor else ():
        c.state.say(what, ids, same, e)
    if "equal" in e.adjectives and len(ids) > 1:
        c.state.say("area_equal", ids, (), e, LIKE)


def _own(c: Clause, e: Element, ids: tuple[str, ...]) -> None:
    """Read "grandparents with their own bedroom, bathroom and small kitchen": what follows in the list is theirs."""
    room = c.stock.get(ids[0]) if c.owner else None
    if room is None:
        return
    if room.type == "bedroom" and "own" in e.det:
        room.role = room.role or c.owner
        c.owning = room.id
    elif c.owning and c.waiting is None and room.type == "bathroom" and not room.role and room.id not in c.stock.belongings:
        if room.level in {None, c.stock.get(c.owning).level}:  # what is named upstairs later is not theirs
            c.give(ids, (c.owning,), e)
    elif c.owning and room.type == "kitchen":
        room.role = c.stock.get(c.owning).role
        c.state.say("door", ids, (c.owning,), e)


def _ban(c: Clause, e: Element) -> None:
    if e.role == "ensuite":
        e.banned = False  # nothing is made of "no en suite"
        return
    c.state.understood(e.first, e.last)
    if not (e.type == "bedroom" and e.role) and not (e.type == "kitchen" and "/" in e.value):
        c.state.banned.append((e.type, e))  # "no guest room" leaves the other bedrooms, "no kitchen-diner" a kitchen


def _home(c: Clause, k: int, e: Element) -> None:
    c.state.homes.append(e)
    if e.value and c.state.studio is None:
        c.state.studio = e
    for mark in e.amounts:
        _attach(c, k, mark, home=True)
    c.run = []


def _note(c: Clause, k: int, e: Element) -> None:
    """Note an amount, people, "which", a negation, or a "but", which ends one: "not open, but next to the dining room"."""
    if e.kind == "amount":
        _attach(c, k, e)
    elif e.kind == "owner":
        c.owner, c.owning = e.value, ""
    elif e.kind == "relative":
        c.relative = not c.says(e, "where")
    elif e.kind in {"neg", "but"}:
        c.negative = e if e.kind == "neg" else None


def _verb(c: Clause, k: int, e: Element) -> None:
    before = next((x for x in reversed(c.sentence[:k]) if x.kind not in {"word", "flag"}), None)
    if before is not None and before.kind in {"and", "comma"} and c.subject and c.objects:
        c.run = []  # "the bedroom has a bath and is ...": the subject goes on
    c.verb, c.single = True, c.says(e, "singular")


def _comma(c: Clause, k: int, _: Element) -> None:
    ahead = c.near(k + 1)
    if c.negative is not c.sentence[k - 1] and (ahead is None or ahead.kind not in {"cue", "cmp", "or", "neg"}):
        c.negative = None


def _adj(c: Clause, k: int, e: Element) -> None:
    before, ahead = c.near(k - 1), c.near(k + 1)
    kind = before.kind if before is not None else ""
    ends = ahead is None or ahead.kind in {"comma", "and"}
    if e.value in {"largest", "smallest"} and len(c.latest) == 1 and (c.verb or (kind == "np" and ends)):  # "客厅最大"
        c.state.say(f"{e.value}_of_all", c.latest, (), e)


def _enter(c: Clause, k: int, e: Element) -> int | None:
    group, j = c.after(k + 1, "enter", ())
    return max(enter(c, e, group or c.latest, j if group else k + 1), k + 1)


def _outside(c: Clause, _: int, e: Element) -> None:
    here = [i for i in named_rooms((*c.latest, *c.subject)) if c.stock.get(i).type not in {"bathroom", "wc", "closet"}]
    c.state.outside = (c.owning or next(iter(here), ""), e)


def _pron(c: Clause, k: int, e: Element) -> None:
    """Read a pronoun: the rooms that it stands for are spoken of next."""
    group = c.point(e, k, c.subject if e.value == "it" and (c.objects or c.run) else ())
    e.ids = list(group)
    if group:
        c.stands_for(e, group)
        c.subject = group if e.value != "it" or not c.subject else c.subject


def _det(c: Clause, k: int, e: Element) -> None:
    """Read "both", "each", "all", "the other" where no room follows."""
    before, ahead = c.near(k - 1), c.near(k + 1)
    kind = ahead.kind if ahead is not None else ""
    behind = c.ahead(k + 1, "verb")
    if e.value == "each" and c.ends(k + 1) and _one_each(c, before, e):
        return
    if e.value == "other" and behind is not None and behind.kind == "level" and not any(r.open_slot for r in c.stock.of(c.state.parted)):
        _every(c, k, e)
        return
    if e.value == "all" and c.run and kind != "np":
        again = c.run[-1].det & {"all", "each"} and before is c.run[-1]  # "..., 所有卧室都从走廊进出"
        group = tuple(c.run[-1].ids) if again else ids_of(c.run)
        if again or len(c.run) > 1:  # "kitchen, two bedrooms, bath - all off the hall"
            c.stands_for(e, group)
            c.subject = group
            return
    if e.value in {"other", "both", "each", "all"} and kind != "np":
        value = {"other": "rest", "both": "both"}.get(e.value, "group")
        e.kind, e.value = "pron", value
        _pron(c, k, e)
        return


def _one_each(c: Clause, before: Element | None, e: Element) -> bool:
    """Read "three bedrooms. And a bathroom for each."."""
    owners = next((g for g in reversed(c.state.past) if len(g) > 1 and c.types(g) == {"bedroom"}), ())
    if before is None or before.kind != "np" or len(c.latest) != 1 or not c.types(c.latest) <= PERSONAL:
        return False
    thing = c.stock.get(c.latest[0])
    c.give((thing.id, *(c.stock.add(thing.type, "", e.text, None).id for _ in owners[1:])), owners, e)
    return bool(owners)


def _every(c: Clause, k: int, e: Element) -> None:
    """Read "every room", "the rest": all rooms."""
    c.push(k, e, ("*",))


def _flag(c: Clause, k: int, e: Element) -> None:
    """Read one flag."""
    c.state.flags.setdefault(e.value, e)
    if e.value == "daylight":
        _windows(c, k, e)
        return
    if e.value == "only":
        c.only = e
    elif e.value == "no_through":
        c.state.say("no_through", named_rooms(c.latest) or ("*bedroom",), (), e)
    elif e.value == "open_plan" and c.negated(k):
        c.state.flags["closed_plan"] = e
        c.state.understood(e.first, e.last)
        c.deny()
    elif e.value == "open_plan":
        social = tuple(i for i in named_rooms(ids_of(c.run)) if c.stock.get(i).type in SOCIAL)
        if len(social) > 1:
            c.state.say("merge", social, (), e)


def _windows(c: Clause, k: int, e: Element) -> None:
    """Read "no windows in the bedroom", "the bath needs daylight"."""
    rooms, negative = named_rooms((c.rooms_in_front() if c.verb else c.latest) or c.latest or c.subject), c.negated(k)
    if rooms:
        c.state.say("no_window" if negative else "window", rooms, (), e)
    c.deny()


def _measures_home(c: Clause, k: int, mark: Mark, ids: Group, *, set_off: bool) -> bool:
    """Whether an area is the home's: more than the rooms in front would take, right behind them or `set_off` by a comma."""
    rooms, behind = [x for x in c.sentence if x.kind == "np"], c.near(k + 1)
    if mark.value == "area" and (mark.total or (behind is not None and behind.value == "total")):
        return True
    if mark.value != "area" or not ids or sum(bool(x.amounts) for x in rooms) != (not set_off):
        return False
    times = mark.number / sum(DEFAULTS[c.stock.get(i).type].area for i in ids)
    home = any(x.kind == "home" and not x.amounts for x in c.sentence[:k])
    named = [x for x in rooms if x.first < mark.first]
    if set_off:
        return (len(named) > 2 and times > LISTED) or (home and times > MORE) or (len(named) > 1 and times > LARGE)
    closes = len(named) == len(rooms) and (len(rooms) > 2 or (home and mark.text[0].isdigit()))
    return (times > HUGE and (home or len(named) > 1)) or (closes and times > LARGE)


def _attach(c: Clause, k: int, mark: Mark, *, home: bool = False) -> None:
    """Attach an amount that stands by itself, or behind the word for the home."""
    state = c.state
    around = c.sentence[max(0, k - 2) : k + 2]
    before, ahead = c.near(k - 1), c.near(k + 1)
    rooms = () if home else named_rooms(c.latest)
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
        before = next((x for x in reversed(c.sentence[:k]) if x.kind != "word"), None)
        set_off = before is not None and before.kind in {"comma", "and"}
        state.amounts.append((mark, rooms if rooms and not (set_off and _measures_home(c, k, mark, rooms, set_off=True)) else None))


READERS: Mapping[str, Callable[[Clause, int, Element], int | None]] = {
    "np": _np, "home": _home, "amount": _note, "owner": _note, "verb": _verb, "relative": _note, "neg": _note, "comma": _comma, "but": _note,
    "adj": _adj, "enter": _enter, "outside": _outside, "level": level, "wing": wing, "zone": Clause.zone,
    "pron": _pron, "det": _det, "every": _every, "flag": _flag, "cue": relate, "factor": factor, "cmp": compare,
}  # fmt: skip
