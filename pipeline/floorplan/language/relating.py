"""What stands before and behind a cue: who is joined to whom, who owns what."""

from __future__ import annotations

from pipeline.floorplan.language.facts import HALLS, SOCIAL, Clause, Fact, Group
from pipeline.floorplan.language.lexicon import ONLY
from pipeline.floorplan.language.objects import CLOSED, has, objects
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.ways import (
    THROUGH,
    _place,
    by_way_of,
    coordinate,
    door_between,
    enter,
    excepted,
    ids_of,
    subject_of,
    through,
)

MUTUAL = {"near", "wall", "away", "apart", "open", "door"}  # may be said of two rooms at the end: "kitchen and bath adjacent"
TOWARDS = {"zu", "zum", "zur", "in", "ins", "auf", "an", "nach", "to", "into", "onto", "al"}  # something follows, though no room
AT = {"am", "an der", "an dem", "liegt am", "liegen am", "liegen an"}  # where a room lies
SINGULAR = {"is", "lies", "sits", "stands", "opens", "esta", "este", "es", "sea", "queda", "ist", "liegt", "se encuentra"}


def relate(clause: Clause, k: int, e: Element) -> int:  # noqa: C901, PLR0911, PLR0912 - one answer per kind of cue
    """Read one cue; return where to go on."""
    state = clause.state
    if e.value == "has":
        return has(clause, k, e)
    if e.value == "except":
        return excepted(clause, k, e)
    if e.value == "by":
        return by_way_of(clause, k, e)
    if e.value.startswith("thru"):
        return through(clause, k, e)
    if e.value == "again":
        return _again(clause, k, e)
    clause.relative = clause.relative or e.text.startswith(("que ", "al que ", "a la que ", "por el que ", "desde el que "))
    if e.value == "between" and (after := door_between(clause, k, e)):
        return after
    if e.value == "from" and e.text.split()[-1] in THERE and (there := _there(clause, k)):
        state.understood(e.first, e.last)
        clause.subject = clause.latest = there
        clause.run, clause.objects = [], ()
        return k + 1
    left, group, j = _both_sides(clause, k, e)
    if not group:
        return _alone(clause, k, e)
    apart = k > 0 and clause.sentence[k - 1].kind == "and"  # "a bath, and in the bedroom ..."
    if e.value == "in" and not left and (held := _holding(clause, e, group, j)):
        return held
    if e.value == "in" and (apart or not _inside(clause, left, group)):
        clause.latest, clause.run = group, [x for x in clause.sentence[k:j] if x.kind == "np"][-1:]
        return j
    if clause.sentence[j - 1].kind == "zone" and e.value in {"door", "in"}:
        return j
    state.understood(e.first, e.last)
    if e.value == "from_to":
        return _from_to(clause, e, left, group, j)
    only = (
        e.only
        or e.text.split(" ")[0] in ONLY
        or (clause.only is not None)
        or (j < len(clause.sentence) and clause.sentence[j].kind == "flag" and clause.sentence[j].value == "only")
    )
    if e.value == "chain":
        left = clause.objects or left
    if e.value == "from" and left and _entered(clause, j):
        j += 1
    elif e.value == "from" and _leads_on(clause, j):
        clause.subject = clause.latest = group
        clause.objects = ()
        clause.run = []
        return j
    if not left and e.text.endswith("有"):  # beside something that is no room
        return k + 1
    first = not any(x.kind in {"np", "pron", "level"} for x in clause.sentence[:k])
    home = any(x.kind == "home" for x in clause.sentence[:k])
    if e.text.startswith("entered") and home and not left:
        return enter(clause, e, group, j)  # "the flat is entered through the kitchen"
    if e.value == "leads" and not left and first and all(clause.stock.get(i).type in HALLS for i in group if i[0] not in "*<"):
        return enter(clause, e, group, j)  # "se entra a un vestíbulo ..."
    door = k > 0 and (clause.sentence[k - 1].kind, clause.sentence[k - 1].value) == ("flag", "doors")
    if not left and door and e.value == "leads" and len(group) == 2:  # "a door connects the office and the kitchen"
        state.say("door", group[:1], group[1:], e)
        return j
    if not left and clause.negative is not None and clause.waiting is not None and clause.waiting[0].value == "from":
        left, clause.waiting = clause.waiting[1], None  # "from the kitchen no door may lead into the bedroom"
    if not left or _inverted(clause, k, j):
        clause.waiting = (e, group)
        clause.subject, clause.latest, clause.run, clause.verb = (), group, [], False
        return j
    _emit(clause, e, left, group)
    if only and e.value in {"door", "from"}:
        state.say("only", left, (), e)
    clause.only = None
    clause.subject, clause.latest, clause.objects, clause.run, clause.verb, clause.relative = left, group, group, [], False, False
    return j


def _from_to(clause: Clause, e: Element, left: Group, group: Group, j: int) -> int:
    """Read "the hall goes from the kitchen to the bathroom"."""
    clause.subject = left
    clause.state.say("leads", left, group, e)
    further, j = objects(clause, j + 1, "leads", left) if j < len(clause.sentence) and clause.sentence[j].kind == "to" else ((), j)
    if further:
        clause.state.say("leads", left, further, e)
    clause.latest, clause.run = further or group, []
    return j


COUNTERS = {"theke", "tresen", "kochinsel", "bar", "kuecheninsel", "halbwand"}


def _by_counter(clause: Clause) -> bool:
    """Whether rooms are parted by furniture alone."""
    return any(COUNTERS & set(x.text.split()) for x in clause.sentence)


def _social(clause: Clause, left: Group, group: Group) -> bool:
    return {clause.stock.get(i).type for i in (*left, *group) if i[0] not in "*<"} <= SOCIAL


def _by_door(clause: Clause, e: Element) -> bool:
    """Whether a door is what parts two rooms."""
    k = _place(clause, e)
    for x in clause.sentence[k + 1 :]:
        if x.kind == "flag":
            return x.value == "doors"
        if x.kind in {"comma", "verb", "and"}:
            return False
    return False


def _again(clause: Clause, k: int, e: Element) -> int:
    """Read "... and to a second bedroom": the way before goes there as well."""
    said = clause.way
    group, j = objects(clause, k + 1, "leads", said.a if said else ())
    if said and group:
        clause.state.say(said.what, said.a, group, e)
        clause.latest, clause.objects, clause.run, clause.verb = group, group, [], False
    return max(j, k + 1)


def _elliptic(clause: Clause, j: int) -> bool:
    """Whether a sentence of cues without a verb goes on with another one: what it speaks of was named before."""
    rest = [x.kind for x in clause.sentence[j : j + 2]]
    return rest == ["comma", "cue"] and not any(x.kind == "verb" for x in clause.sentence)


def _both_sides(clause: Clause, k: int, e: Element) -> tuple[Group, Group, int]:
    """Return who stands in front of a cue, who behind it, and where reading goes on."""
    ahead = clause.sentence[k + 1] if k + 1 < len(clause.sentence) else None
    first = k == 0 or clause.sentence[k - 1].kind in {"comma", "and"}
    left = () if ahead is not None and ahead.value == "pair" and first else subject_of(clause, k, e)  # "dazwischen liegt das Bad"
    wide = ahead is not None and ahead.kind == "np" and (len(left) > 2 or (len(left) > 1 and ahead.definite))
    to_many = bool(DOORS & set(e.text.split())) or e.text in {"与", "和", "跟", "同"}
    cue = "leads" if e.value == "door" and to_many else e.value
    group, j = objects(clause, k + 1, cue, () if wide else left)
    if not group and e.value == "between" and left and first:  # "两间卧室中间是客厅"
        left = ()
        group, j = objects(clause, k + 1, e.value, ())
    if group and not left and k == 0 and _elliptic(clause, j):  # "The dining room ...; open to the kitchen, with a door to the hall"
        left = clause.state.topic
    return tuple(i for i in left if i not in group), group, j  # "all rooms round a hall: kitchen, bath, all off the hall"


DOORS = {
    "tueren",
    "schiebetueren",
    "durchgaenge",
    "zugaenge",
    "verbindungen",
    "ausgaenge",
    "verbindungstueren",
    "erschliesst",
}  # to many rooms
THERE = {"dort", "there", "ahi", "alli", "那 里", "里"}


def _there(clause: Clause, k: int) -> Group:
    """Return the room that "from there" means: the one that was spoken of last."""
    past = clause.objects or (clause.latest if k else ()) or (clause.state.past[-1] if clause.state.past else ())
    return past if len(past) == 1 and not past[0].startswith(("*", "<")) else clause.state.topic


def _alone(clause: Clause, k: int, e: Element) -> int:
    """Read a cue that nothing follows: "next to each other", "kitchen and bath adjacent"."""
    ahead = clause.sentence[k + 1] if k + 1 < len(clause.sentence) else None
    mutual = ahead is not None and ahead.kind == "reciprocal"
    rest = next((x for x in clause.sentence[k + 1 :] if x.kind not in {"det", "verb"} and (x.kind, x.value) != ("flag", "doors")), None)
    ends = rest is None or rest.kind in {"comma", "but", "close"}  # "cocina y salón comunicados por una puerta corredera"
    rooms = ids_of(clause.run) or clause.subject
    listed_alone = (
        ends and e.value in MUTUAL and e.text.split()[-1] not in TOWARDS and len(rooms) > 1 and "*" not in rooms and coordinate(clause)
    )
    if e.text == "by" and not mutual:
        return k + 1
    if mutual or listed_alone or (e.value == "wall" and (clause.run or clause.subject)):
        _mutual(clause, e)
        return k + 1 + mutual
    if e.value == "between" and rest is None and e.text == "in between":
        clause.state.understood(e.first, e.last)  # "... as a buffer in between" points back at what was said
    return k + 1


def _holding(clause: Clause, e: Element, group: Group, j: int) -> int:
    """Read "in the corridor are three bedrooms and a bath", "in the main bedroom there is a closet": what is named next hangs on it; 0 for none."""
    verb = next((i for i in range(j, min(j + 6, len(clause.sentence))) if clause.sentence[i].kind == "verb"), None)
    if len(group) != 1 or verb is None or any(x.kind in {"np", "cue", "neg"} for x in clause.sentence[j:verb]):
        return 0
    ahead = next((x for x in clause.sentence[verb + 1 :] if x.kind not in {"det", "adj", "size", "verb", "word", "flag"}), None)
    host = clause.stock.get(group[0]).type if group[0][0] not in "*<" else ""
    usual = {"hallway": BEHIND_HALLS, "entry": BEHIND_HALLS, "bedroom": {"bathroom", "closet", "balcony", "wc"}}
    if ahead is None or ahead.kind != "np" or ahead.banned or ahead.type not in usual.get(host, {"balcony", "storage", "utility"}):
        return 0
    for x in clause.sentence[j:verb]:
        measured = x.kind == "amount" and x.mark is not None
        if measured and x.mark is not None:
            clause.state.amounts.append((x.mark, group))
            clause.state.understood(x.first, x.last)
    things, end = clause.after(verb + 1, "leads", group)
    if things:
        clause.state.say("own" if host == "bedroom" and len(things) == 1 else "door", things, group * len(things), e)
        clause.latest, clause.subject, clause.objects, clause.run, clause.verb = things, group, things, [], False
    return end if things else 0


BEHIND_HALLS = {
    "bedroom",
    "bathroom",
    "wc",
    "kitchen",
    "living_room",
    "dining_room",
    "closet",
    "storage",
    "office",
    "utility",
    "library",
    "playroom",
}


def _inside(clause: Clause, left: Group, group: Group) -> bool:
    """Whether "X in Y" means that X opens off Y, as a cupboard in the hall does."""
    kinds = {clause.stock.get(i).type for i in left if not i.startswith("*")}
    hosts = {clause.stock.get(i).type for i in group if not i.startswith("*")}
    if (kinds == {"balcony"} and len(hosts) == 1) or (kinds and hosts and hosts <= HALLS):
        return True  # "three bedrooms in the hallway" open off it
    return (
        bool(kinds)
        and kinds <= {"storage", "closet", "wc", "bathroom", "balcony", "utility"}
        and bool(hosts)
        and hosts <= {"hallway", "entry", "bedroom", "kitchen", "utility"}
    )


def _leads_on(clause: Clause, j: int) -> bool:
    """Whether "from the garage" goes on with "you get into ..."."""
    for x in clause.sentence[j:]:
        if x.kind == "cue":
            return x.value == "leads"
        if x.kind not in {"verb", "det", "flag", "adj", "word", "pron"}:
            return False
    return False


def _entered(clause: Clause, j: int) -> bool:
    """Whether "reached from the kitchen" ends there: a verb of going without an object."""
    if j >= len(clause.sentence) or clause.sentence[j].kind != "cue" or clause.sentence[j].value != "leads":
        return False
    ahead = clause.sentence[j + 1] if j + 1 < len(clause.sentence) else None
    return ahead is None or ahead.kind in {"comma", "stop", "and"}


def _inverted(clause: Clause, k: int, j: int) -> bool:
    """Whether the subject follows: "off the foyer are a wc and the living room", "next to the kitchen, a pantry"."""
    before = [x for x in clause.sentence[:k] if x.kind in {"np", "pron", "every", "zone", "home"}]
    if before and clause.run:
        return False
    if before and not (
        k and clause.sentence[k - 1].kind in {"comma", "and"} and j < len(clause.sentence) and clause.sentence[j].kind == "verb"
    ):
        return False
    return any(x.kind == "np" and not x.banned for x in clause.sentence[j:])


def _emit(clause: Clause, e: Element, left: Group, group: Group) -> None:
    state, cue = clause.state, "door" if e.value in {"from", "chain", "in"} else e.value
    kinds = {clause.stock.get(i).type for i in left if not i.startswith("*")}
    if cue == "open" and e.text == "open to" and not clause.verb and kinds & CLOSED:
        cue = "leads"  # "the bedroom and the toilet open to a hallway"
    if cue == "apart" and _by_door(clause, e):
        cue = "door"  # "separated from the living area by a door"
        left = clause.objects if clause.objects and clause.stock.get(clause.objects[0]).type in HALLS else left
    if cue == "apart" and (clause.negative is not None or _by_counter(clause)) and _social(clause, left, group):
        clause.negative, cue = None, "open"  # "only a counter parts the kitchen from the living room"
    if cue == "apart":  # a kitchen apart from the living room has a door; a bedroom apart from it lies away
        kinds = {clause.stock.get(i).type for i in (*left, *group) if not i.startswith("*")}
        if kinds <= {"bathroom", "wc"}:
            return  # two rooms instead of one
        cue = "not_open" if kinds <= SOCIAL else "away"
    if clause.negative is not None:
        left, clause.negative = _none(clause, left), None
        through = cue == "door" and bool(THROUGH & set(e.text.split()))
        what = (
            "avoid"
            if through
            else "ban"
            if cue == "door" and e.text in AT
            else {"near": "ban", "wall": "ban", "away": "near", "open": "not_open", "avoid": "avoid"}.get(cue, "not_connected")
        )
        state.say(what, left, group, e)
        if cue in {"leads", "door"} and what == "not_connected":
            clause.way = Fact(cue, left, group)  # "not to the living room but to the hall"
    elif cue == "ensuite":
        state.say("own", left, group, e)
        clause.stock.belongings.update(left)
    else:
        state.say(cue, left, group, e)
        clause.way = state.facts[-1] if cue in {"leads", "door"} and state.facts else clause.way


def _none(clause: Clause, left: Group) -> Group:
    """Return all rooms of the kind that "no bedroom" names."""
    named = next((x for x in clause.run[-1:] if clause.negative is not None and x.first >= clause.negative.last), None)
    near = named is not None and clause.negative is not None and named.first - clause.negative.last < 2 and not named.definite
    same = tuple(r.id for r in clause.stock.of(named.type)) if named is not None and near and len(left) == 1 else ()
    return same or left


def _mutual(clause: Clause, e: Element) -> None:
    """Read "next to each other", "the two bedrooms must not share a wall with one another"."""
    rooms = tuple(i for x in clause.run for i in x.ids)
    rooms = clause.latest if len(clause.latest) > 1 and e.value != "open" else rooms
    rooms = rooms if len(rooms) > 1 else clause.subject
    clause.state.understood(e.first, e.last)
    if clause.negative is not None or e.value in {"away", "apart"}:
        unlinked = clause.negative is not None and e.value in {"door", "open"}
        clause.negative = None
        if unlinked:
            clause.state.say("not_connected" if e.value == "door" else "not_open", rooms[:1], rooms[1:], e)
            return
        clause.state.say("ban", rooms, rooms, e)
        if e.value in {"away", "apart"}:
            clause.state.say("away", rooms[:1], rooms[1:], e)
    else:
        clause.state.say("merge" if e.value == "open" else e.value, rooms, (), e)
        clause.subject = clause.latest = rooms
