"""Who is meant in front of a cue, how one gets from room to room, and sizes against each other."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from pipeline.floorplan.language.facts import HALLS, Clause, Group
from pipeline.floorplan.language.phrases import Element


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


WITH = {"con", "with", "mit"}
THROUGH = {"through", "via", "durch", "ueber", "por", "traves", "经", "过", "通"}
FINITE = {
    "come",
    "branch",
    "hang",
    "gehen",
    "liegen",
    "fuehren",
    "grenzen",
    "muenden",
    "haengen",
    "zweigen",
    "oeffnen",
    "schliessen",
    "abren",
    "dan",
    "salen",
    "open",
    "lead",
    "connect",
    "conectan",
    "comunican",
    "desembocan",
    "llevan",
    "conducen",
    "give",
    "parten",
    "erreicht",
    "gruppieren",
    "betritt",
}
HAVING = {"haben", "have", "tienen", "cuentan"}


def subject_of(clause: Clause, k: int, e: Element) -> Group:  # noqa: C901, PLR0911, PLR0912 - one branch per case: a grammar
    """Return the subject of a cue: the phrase in front, the list in front of a verb, or what the clause is about."""
    before = clause.sentence[k - 1] if k else None
    if not clause.run:
        cue = next((x for x in reversed(clause.sentence[:k]) if x.kind == "cue"), None)
        passed = before is not None and before.kind == "np" and cue is not None and bool(THROUGH & set(cue.text.split()))
        if passed and clause.objects and e.value in {"door", "leads"} and e.text.split()[0] not in THROUGH:
            return clause.objects  # "the garage is connected by way of the utility room to the kitchen"
        if clause.relative and clause.objects and "verb_last" not in clause.state.heard.lexicon.traits:
            return clause.objects  # "away from the parents' bedroom, which is next to ..."
        chained = before is not None and before.kind == "np" and cue is not None and cue.value == e.value == "near"
        return clause.objects if chained and clause.objects and not clause.relative else clause.subject  # "X next to Y next to Z"
    if (
        before is not None
        and before.kind in {"comma", "and"}
        and clause.objects
        and set(clause.objects) == {i for x in clause.run for i in x.ids}
        and not _named_again(clause, k)
    ):
        return clause.subject  # "a guest room with its own bath, away from ..."
    if before is not None and before.kind == "open":
        return tuple(clause.run[-1].ids)  # "a garage (joined to the hall)"
    apart = before is not None and before.kind == "comma" and len(clause.run) > 1
    last = clause.run[-1]
    if clause.relative or (apart and not clause.verb):
        return tuple(last.ids)
    if e.value == "avoid" and clause.objects:
        return clause.subject
    if e.text.split()[0] in WITH and e.value in {"door", "leads"} and not last.plural:
        return tuple(last.ids)  # "a kitchen and a living room with access to the terrace"
    if clause.single and len(clause.run) > 1 and {x.type for x in clause.run[:-1]} and not last.plural:
        return tuple(last.ids)  # "there is a living room, and the kitchen is open to it"
    verbal = (
        clause.verb
        or e.value in {"leads", "away", "apart"}
        or e.text.removeprefix("se ").split()[0] in FINITE
        or any(x.text in FINITE | HAVING for x in clause.sentence[_place(clause, last) + 1 : k])
        or any(x.det & {"both", "all"} for x in clause.run)
    )
    if not coordinate(clause):  # "study downstairs, all bedrooms upstairs, garage connected to ...": commas part statements
        return tuple(last.ids)
    heads = [x for x in clause.run if x.first == last.first and x.last == last.last]
    if len(heads) == len(clause.run) > 1 and e.value in {"door", "leads", "near"}:
        return tuple(clause.run[0].ids)  # "a living-dining-kitchen with access to the terrace": one room to whoever goes there
    if verbal or e.value == "wall":
        return ids_of(clause.run)
    if e.value != "door":
        return tuple(last.ids)
    tail = [last]
    for a, b in zip(reversed(clause.run[:-1]), reversed(clause.run[1:]), strict=True):
        between = clause.sentence[_place(clause, a) + 1 : _place(clause, b)]
        if any(x.kind == "comma" for x in between) or not any(x.kind == "and" for x in between):
            break
        tail.insert(0, a)
    return ids_of(tail)


def listed(clause: Clause) -> Group:
    """Return the rooms in front of a comparison: the last phrase, with those that an "and" joins to it."""
    return ids_of(clause.run if coordinate(clause) else clause.run[-1:])


def coordinate(clause: Clause) -> bool:
    """Whether the last two phrases in front of a cue are joined by more than a comma; one alone is."""
    ends = [_place(clause, x) for x in clause.run[-2:]]
    return len(ends) < 2 or any(x.kind in {"and", "or"} for x in clause.sentence[ends[0] : ends[1]])


def ids_of(phrases: Iterable[Element]) -> Group:
    """Return the rooms of phrases, each once."""
    return tuple(dict.fromkeys(i for x in phrases for i in x.ids))


def _place(clause: Clause, e: Element) -> int:
    return next((i for i, x in enumerate(clause.sentence) if x is e), 0)


def _named_again(clause: Clause, k: int) -> bool:
    """Whether what was said of last is named once more: "A adjoins B, and B, of 16 m², adjoins C"."""
    place = _place(clause, clause.run[-1])
    cue = max((i for i, x in enumerate(clause.sentence[:k]) if x.kind == "cue"), default=0)
    return any(x.kind in {"and", "comma"} for x in clause.sentence[cue + 1 : place])


BY = {"durch", "through", "por"}
THEN = {"then", "dann", "luego", "despues"}


def excepted(clause: Clause, k: int, e: Element) -> int:
    """Read "all rooms but the pantry open off the hall": those that are left out, and who goes on."""
    ahead = clause.sentence[k + 1] if k + 1 < len(clause.sentence) else None
    if ahead is not None and ahead.kind == "to" and clause.way is not None:  # "has access to the terrace but not to the living room"
        denied, j = clause.after(k + 2, "leads", clause.way.a)
        clause.state.say("not_connected", clause.way.a, denied, e)
        return max(j, k + 1)
    group, j = clause.after(k + 1, "except", ())
    if not group:
        return max(j, k + 1)
    clause.state.say("except", group, (), e)
    clause.left_out = group
    if [x.kind for x in clause.sentence[j : j + 2]] == ["comma", "relative"]:  # "... except the closet, which ..."
        clause.subject = clause.latest = group
        clause.run = [x for x in clause.sentence[k:j] if x.kind == "np"][-1:]
        return max(j, k + 1)
    left = tuple(i for i in clause.run[-1].ids if i not in group) if clause.run and set(group) < set(clause.run[-1].ids) else ()
    if left and "*" not in left:  # "all but the guest room have a bath"
        clause.run[-1].ids = list(left)
        clause.run, clause.latest, clause.subject = clause.run[-1:], left, left
        return max(j, k + 1)
    said = clause.state.facts[-2] if len(clause.state.facts) > 1 else None
    if said is not None and said.what in {"door", "leads", "own"} and set(group) < set(said.a):  # "all open onto the hall but the main one"
        clause.state.facts[-2] = replace(said, a=tuple(i for i in said.a if i not in group))
    clause.run, clause.latest = [x for x in clause.sentence[k:j] if x.kind == "np"][-1:], group
    every = next((x for x in clause.sentence[:k] if x.kind == "every"), None)
    if every is not None and not any(x.kind == "cue" for x in clause.sentence[:k]):  # "all rooms but the pantry open off the hall"
        clause.run, clause.latest = [every], ("*",)
    each = next((x for x in clause.sentence[:k] if x.kind == "np" and x.det & {"each", "all"}), None)
    if each is not None and clause.sentence[k - 1] is each and (rest := [i for i in each.ids if i not in group]):
        each.ids, clause.run, clause.latest, clause.subject = rest, [each], tuple(rest), tuple(rest)
    return max(j, k + 1)


def through(clause: Clause, k: int, e: Element) -> int:
    """Read "you pass through the dining room to reach the kitchen", and what must not be so."""
    first, j = clause.after(k + 1, "door", ())
    ends = j >= len(clause.sentence) or clause.sentence[j].kind in {"comma", "but"}
    left = tuple(i for i in (clause.run[-1].ids if clause.run else clause.subject) if i not in first)
    if first and ends and left and clause.negative is None and e.value == "thru":  # "浴室得穿过衣帽间才能到"
        clause.state.say("door", left, first, e)
        clause.latest = clause.objects = first
        clause.run = []
        return j
    if not first or j >= len(clause.sentence):
        return k + 1
    while j < len(clause.sentence) and clause.sentence[j].kind in {"verb", "comma"}:
        j += 1
    second, j = clause.after(j, "leads" if e.value == "thru" else "door", first)
    if not second:
        return max(j, k + 1)
    things, hosts = (second, first) if e.value == "thru" else (first, second)
    if clause.waiting is not None and clause.waiting[0].value in {"from", "leads"}:  # "from the bedroom through the closet into the bath"
        clause.state.say("door", first, clause.waiting[1], clause.waiting[0])
        clause.waiting = None
    none = clause.negative is not None or e.value == "thru_not"
    clause.negative = None
    clause.state.say("avoid" if none else "door", things, hosts, e)
    clause.subject = clause.latest = clause.objects = things
    clause.run = []
    return j


def door_between(clause: Clause, k: int, e: Element) -> int:
    """Read "a door between kitchen and bathroom"; return 0 where no door is spoken of."""
    if not any(x.kind == "flag" and x.value == "doors" for x in clause.sentence):
        return 0
    group, j = clause.after(k + 1, "between", ())
    near = [*clause.sentence[max(0, k - 2) : k], *clause.sentence[j : j + 4]]
    if len(group) != 2 or clause.negative or not any(x.kind == "flag" and x.value == "doors" for x in near):
        return 0
    wide = any(
        (x.kind == "adj" and x.value == "open") or x.text.endswith("abierto") for x in near
    )  # "an open doorway between kitchen and dining room"
    clause.state.say("open" if wide else "door", group[:1], group[1:], e)
    return j


def by_way_of(clause: Clause, k: int, e: Element) -> int:
    """Read "the garage is connected to the kitchen via a utility room": the way that was just said leads through it."""
    said = clause.state.facts[-1] if clause.state.facts else None
    if said is None or said.what not in {"door", "leads"} or not said.b or clause.run:
        return k + 1
    group, j = clause.after(k + 1, "door", (*said.a, *said.b))
    if group:
        clause.state.facts.pop()
        clause.state.say("door", said.a, group, e)
        clause.state.say("door", group, said.b, e)
        clause.latest, clause.objects, clause.run = group, group, []
    return max(j, k + 1)


def enter(clause: Clause, e: Element, group: Group, j: int) -> int:
    """Let a room be the one that one enters, and what follows go on from there."""
    if group and not group[0].startswith(("*", "<")):
        clause.state.understood(e.first, e.last)
        clause.state.entrance = clause.state.entrance or (group[0], e)
        clause.subject = clause.latest = clause.objects = group
        clause.run, clause.waiting = [], None
    return j


def entered(clause: Clause, j: int, e: Element, group: Group) -> int:
    """Read "you come in through the porch into the hall" and "you enter a vestibule, then a hall" on; 0 where no room follows."""
    rest = clause.sentence[j : j + 3]
    into = bool(rest) and rest[0].kind == "cue" and rest[0].value in {"in", "leads"} and e.text.split()[-1] in BY
    step = next((i for i, x in enumerate(rest[:2]) if x.text in THEN), None)
    if len(group) == 2 and any(x.text in THEN for x in clause.sentence[max(0, j - 4) : j]):  # both were read as one list
        clause.state.say("door", group[1:], group[:1], e)
        clause.state.entrance = (group[0], e)
        clause.subject = clause.latest = clause.objects = group[1:]
        clause.run, clause.waiting = [], None
        return j
    if not group or group[0].startswith(("*", "<")) or not (into or step is not None):
        return 0
    further, end = clause.after(j + 1 + (step or 0), "door", group)
    if not further:
        return 0
    clause.state.say("door", further, group, e)
    if not into or clause.stock.get(group[0]).type in HALLS:
        clause.state.entrance = (group[0], e)
    clause.subject = clause.latest = further
    clause.objects, clause.run, clause.waiting = further, [], None
    return end


def listing(clause: Clause, k: int) -> bool:
    """Whether behind the comma at k a list of what hangs on a hall goes on: "on both sides of the corridor lie two bedrooms, a bath and ..."."""
    assert clause.waiting is not None
    rest = clause.sentence[k + 1 :]
    hall = all(clause.stock.get(i).type in HALLS for i in clause.waiting[1] if i[0] not in "*<")
    plain = all(x.kind in {"np", "det", "size", "adj", "amount", "comma", "and"} and not x.banned for x in rest)
    return hall and plain and clause.waiting[0].value in {"door", "leads"} and any(x.kind == "and" for x in rest)
