"""What rooms have, and which rooms stand behind a cue."""

from __future__ import annotations

from pipeline.floorplan.language.facts import HALLS, PERSONAL, SOCIAL, Clause, Group
from pipeline.floorplan.language.naming import name
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.remarks import storey, written_as_one, zone

FINITE = {
    "has",
    "have",
    "gets",
    "get",
    "contains",
    "needs",
    "need",
    "requires",
    "must have",
    "should have",
    "necesita",
    "necesitan",
    "debe tener",
    "tiene",
    "tienen",
    "cuenta con",
    "dispone de",
    "hat",
    "haben",
    "bekommt",
}
HOSTS = {
    "living_room",
    "family_room",
    "studio_room",
    "dining_room",
    "kitchen",
    "hallway",
    "entry",
    "office",
    "garage",
    "media_room",
    "bathroom",
}


def measures(clause: Clause, e: Element) -> None:
    """Note the areas of a phrase."""
    for mark in e.amounts:
        clause.state.understood(mark.first, mark.last)
        clause.state.amounts.append((mark, tuple(e.ids)))
    e.amounts = []


def has(clause: Clause, k: int, e: Element) -> int:  # noqa: C901, PLR0911, PLR0912 - one branch per case: a grammar
    """Read "X with its own bathroom", "the living room has a terrace": rooms that hang on the one named before."""
    sentence, stock = clause.sentence, clause.stock
    before = next((x for x in reversed(sentence[:k]) if x.kind in {"np", "home", "pron", "every", "det", "level"}), None)
    if before is None or before.kind == "home" or not (clause.run or clause.subject):
        return k + 1
    whole = before.kind == "pron" and before.ids and all(not i.startswith("*") and stock.get(i).whole for i in before.ids)
    if whole and clause.state.homes:
        return k + 1  # "a one-bedroom flat. It needs a study": the flat
    ahead = _next_phrase(sentence, k + 1)
    if before.kind == "level" and (clause.forward or not clause.run or ahead is None or "own" not in sentence[ahead].det):
        return k + 1
    own = ahead is not None and "own" in sentence[ahead].det and clause.run[-1:] and clause.run[-1].type == "bedroom"
    finite = e.text in FINITE and len(clause.run) == 1  # "the largest bedroom, of 18 m2, has one of the baths"
    opened = next((x.kind for x in reversed(sentence[:k]) if x.kind in {"open", "close"}), "") == "open"  # "主卧(16㎡,带卫生间)"
    single = (
        "bare_nouns" in clause.state.heard.lexicon.traits
        and len(clause.run) == 1
        and clause.run[0].number is None
        and not clause.run[0].suite
    )  # "客厅朝南,带阳台"
    if clause.run and not (opened or single) and sentence[k - 1].kind == "comma" and not clause.verb and not own and not finite:
        return k + 1
    owners = tuple(i for i in (clause.run[-1].ids if clause.run else clause.subject) if not i.startswith("*"))
    near = sentence[k - 1]
    if not clause.run and near.kind == "np" and near.ids and set(near.ids) <= set(clause.objects) and e.text in {"with", "con", "mit"}:
        owners = tuple(near.ids)  # "the living room leads to a hall with two bedrooms"
    if clause.run and len(clause.run) > 1 and (clause.verb or e.text in {"have", "both have"}):
        listed = tuple(dict.fromkeys(i for x in clause.run for i in x.ids if not i.startswith("*")))
        owners = listed if not any(x.part for x in clause.run) and {stock.get(i).type for i in listed} == {"bedroom"} else owners
    if not owners:
        return k + 1
    kind = stock.get(owners[0]).type
    negative = clause.negated(k)
    clause.negative = None
    if kind == "bedroom":
        return _belongs(clause, k, e, owners) if not negative else k + 1
    if ahead is None or kind not in HOSTS or len(owners) > 1 or sentence[ahead].banned:
        return k + 1
    thing = sentence[ahead]
    if kind == "kitchen" and thing.type == "dining_room" and thing.text != "dining room":
        stock.get(owners[0]).functions.add("dining")
        clause.state.understood(thing.first, thing.last)
        return ahead + 1
    if kind == "studio_room" and thing.type == "kitchen":
        stock.get(owners[0]).functions.add("cooking")
        thing.banned = True
        clause.state.understood(thing.first, thing.last)
        return ahead + 1
    if thing.type == "balcony" and kind in {"bathroom", "hallway"}:
        return k + 1  # "两室一厨一卫带阳台": the home has it
    sides = any(x.kind == "wing" for x in sentence[ahead:])  # "a corridor with the kitchen on one side and the bedrooms on the other"
    if kind == "hallway" and (sides or (thing.type == "bedroom" and not thing.definite)):  # "a corridor with two bedrooms and a bathroom"
        group, j = clause.after(ahead, "leads", owners)
        clause.state.say("door", group, owners, e)
        clause.latest, clause.run = group, [thing]
        return j
    if thing.type in {"bedroom", "living_room", "family_room", "garage"} or (thing.ids and thing.definite):
        return k + 1
    ids = tuple(name(clause.state, sentence, ahead, storey(clause, ahead)))
    clause.state.understood(e.first, thing.last)
    opened = thing.type in {"kitchen", "dining_room"} and kind in {"living_room", "kitchen", "dining_room", "studio_room", "family_room"}
    clause.state.say("open" if opened else "door", ids, owners, e)
    measures(clause, thing)
    clause.latest, clause.run, clause.subject, clause.objects = ids, [thing], clause.subject or owners, ids
    return ahead + 1


def _next_phrase(sentence: list[Element], k: int) -> int | None:
    for j in range(k, len(sentence)):
        if sentence[j].kind == "np":
            return j
        if sentence[j].kind not in {"det", "size", "adj", "flag", "verb", "word", "amount"}:
            return None
    return None


def _belongs(clause: Clause, k: int, e: Element, owners: Group) -> int:
    """Give bedrooms what follows: bathrooms, closets, balconies, as many as there are owners."""
    sentence, stock = clause.sentence, clause.stock
    j, end, joined = k + 1, k + 1, ""
    given: Group = ()
    while j < len(sentence):
        x = sentence[j]
        if x.kind == "np":
            if x.type == "bedroom" and not given and not x.ids and any(y.suite for y in sentence[:k]):
                x.ids = list(owners)
                clause.state.understood(x.first, x.last)
                measures(clause, x)
                joined, end = "", j + 1
                j += 1
                continue
            if x.banned or x.type not in PERSONAL or (given and not joined):
                break
            own = bool(x.det & {"own"})
            after = sentence[j + 1 : j + 3]  # "two bedrooms with a bath for both"
            both = bool(after) and after[0].kind in {"det", "pron"} and after[0].value in {"both", "all"} and "own" not in x.det
            both = both and not any(y.kind in {"cue", "verb", "np"} for y in after[1:])
            public = (both and len(owners) > 1) or x.role in {"shared", "guest"} or (x.number or 1) > len(owners) or x.definite
            public = public or (len(owners) > 2 and 1 < (x.number or 1) < len(owners))  # "three bedrooms with two baths"
            if given and not own and _placed(sentence, j):
                break  # "with a closet and a bath that one enters by the closet"
            if public or (joined == "comma" and not own and not _list_ends(sentence, j)):
                break
            if (joined and "another" in x.det) or (joined == "and" and not own and x.number is not None):
                break
            if joined and x.type == "wc" and not own:
                break
            ids = _things(clause, j, owners)
            clause.state.understood(e.first, e.last)
            clause.state.understood(x.first, x.last)
            hosts = given if "through" in x.adjectives and given else owners
            clause.give(ids, hosts, x)
            measures(clause, x)
            given, joined, end = ids, "", j + 1
        elif x.kind in {"and", "comma"}:
            joined = "and" if x.kind == "and" or joined == "and" else "comma"
        elif x.kind == "amount" and not given and x.value in {"area", "length"} and x.mark is not None:
            clause.state.amounts.append((x.mark, owners))
            clause.state.understood(x.first, x.last)
            end, joined = j + 1, ""
        elif x.kind not in {"det", "size", "adj", "word", "flag"} and not (x.kind == "cue" and x.value == "has"):
            break
        j += 1
    if given:
        clause.latest, clause.subject, clause.objects = given, owners, given
        clause.run = [Element("np", "", e.first, e.last, "", ids=list(given), type=stock.get(given[0]).type)]
        clause.verb = False
    return end


def _placed(sentence: list[Element], j: int) -> bool:
    """Whether it is said of the room at j where it hangs."""
    ahead = next((x for x in sentence[j + 1 :] if x.kind not in {"amount", "relative", "flag", "word"}), None)
    return ahead is not None and ahead.kind == "cue" and ahead.value in {"door", "from"}


def _list_ends(sentence: list[Element], j: int) -> bool:
    """Whether "and" with a personal room closes the list that the phrase at j stands in: "with a bath, closet and balcony"."""
    for x in sentence[j + 1 :]:
        if x.kind == "and":
            return True
        if not (x.kind in {"comma", "det"} or (x.kind == "np" and x.type in PERSONAL)):
            return False
    return False


def _things(clause: Clause, j: int, owners: Group) -> Group:
    """Return one room for each owner: those that were counted first, then new ones."""
    x, stock = clause.sentence[j], clause.stock
    ids = list(x.ids)
    role = x.role if x.role == "primary" and len(owners) == 1 else ""
    slots = [r for r in stock.of(x.type) if r.open_slot and r.id not in ids and not stock.owned(r.id)]
    if not ids and x.number is None and not slots and len(owners) == 1 and "own" not in x.det and x.definite:
        ids = name(clause.state, clause.sentence, j, None)
    while len(ids) < len(owners):
        if slots:
            room = slots.pop(0)
            room.open_slot, room.surface = False, x.text
        else:
            room = stock.add(x.type, role, x.text, None)
            room.level = stock.get(owners[0]).level
        ids.append(room.id)
    x.ids = ids[: len(owners)] if len(ids) > len(owners) and x.type == "bathroom" else ids
    if x.size != 1.0:
        for room in (stock.get(i) for i in x.ids):
            room.size = x.size
    return tuple(x.ids)


def one_each(clause: Clause, e: Element) -> None:
    """Read "three bedrooms. And a bathroom for each."."""
    thing = clause.stock.get(clause.latest[0])
    owners = next((g for g in reversed(clause.state.past) if len(g) > 1 and clause.stock.get(g[0]).type == "bedroom"), ())
    if thing.type not in PERSONAL or not owners:
        return
    ids = [thing.id, *(clause.stock.add(thing.type, "", e.text, None).id for _ in owners[1:])]
    clause.give(tuple(ids), owners, e)


CLOSED = {"balcony", "garage", "bathroom", "wc", "closet", "storage", "utility", "bedroom"}
CONNECTS = {"connect", "connects", "connecting", "links", "linking", "joins", "joining", "une", "conecta", "comunica", "verbindet"}
WIDE = {"leads", "between", "chain", "avoid", "except"}


def objects(clause: Clause, k: int, cue: str, left: Group) -> tuple[Group, int]:  # noqa: C901, PLR0912, PLR0915 - one branch per kind of element: a grammar
    """Return the rooms named after a cue, and where reading goes on."""
    group: list[str] = []
    sentence = clause.sentence
    index = end = k
    joined = ""
    first: Element | None = None
    last: Element | None = None
    while index < len(sentence):
        e = sentence[index]
        if e.kind == "np":
            comma = any(x.kind == "comma" for x in sentence[index - 3 : index])
            clausal = cue == "cmp" and joined and ((comma and bool(e.amounts)) or "equal" in e.adjectives)
            pair = cue == "between" and joined == "and" and len(group) == 1
            again = e.ids or (
                first is not None and e.definite and not e.plural and (e.type, e.text, e.role) == (first.type, first.text, first.role)
            )
            if (
                e.banned
                or (group and joined and again and first is not None and not first.plural and first.type == e.type)  # "A by B, and B by C"
                or (group and (not joined or clausal))
                or (group and first is not None and not pair and not _continues(clause, index, cue, joined, first))
            ):
                break
            private = {clause.stock.get(i).type for i in left if not i.startswith("*")} == {"bedroom"}
            if private and cue == "leads" and joined == "comma" and e.type in SOCIAL:
                break  # a bedroom leads to its bath, and the list of rooms goes on
            ids = name(clause.state, sentence, index, clause.level if clause.forward else None)
            clause.state.understood(e.first, e.last)
            measures(clause, e)
            if e.adjectives & {"largest"} and cue != "cmp":
                clause.state.say("largest", tuple(ids), tuple(r.id for r in clause.stock.of(e.type)), e)
            group += [i for i in ids if i not in group and i not in left]
            if e.type in SOCIAL and (j := written_as_one(clause, index, e)):  # "around a kitchen-living room"
                clause.state.say("merge", (*ids, *name(clause.state, sentence, j, None)), (), e)
            first, last, joined, end = first or e, e, "", index + 1
        elif (
            e.kind in {"pron", "det"}
            and not group
            and e.value in {"it", "both", "group", "one", "rest", "some", "each", "all", "self", "pair"}
        ):
            if e.kind == "det" and any(x.kind == "np" for x in sentence[index + 1 : index + 2]):
                index += 1
                continue
            if e.value == "self":
                clause.state.say("itself", left, (), e)
                return (), index + 1
            found = clause.point(e, index, left)
            clause.state.understood(e.first, e.last)
            return tuple(i for i in found if i not in left), index + 1
        elif e.kind == "owner" and not group and not any(x.kind in {"np", "word"} for x in sentence[index + 1 : index + 2]):
            return _theirs(clause, e, left), index + 1
        elif e.kind == "zone" and not group:
            zone(clause, index, e)
            return tuple(e.ids), index + 1
        elif e.kind == "every" and not group:
            clause.state.understood(e.first, e.last)
            return ("*",), index + 1
        elif (
            e.kind == "cue"
            and e.value in {"in", "leads"}
            and joined
            and cue in WIDE
            and not (joined == "comma" and (clause.relative or clause.negative is not None))
        ) or (group and (e.value == "has" or e.kind == "to") and cue == "leads" and CONNECTS & set(sentence[k - 1].text.split())):
            joined = joined or "and"  # "connects the kitchen with the garage"
        elif e.kind == "wing" and cue == "leads" and group:
            clause.state.understood(e.first, e.last)
        elif e.kind == "flag" and not group and any(x.kind == "np" for x in sentence[index + 1 : index + 3]):
            clause.state.understood(e.first, e.last)  # "next to a step-free bathroom"
            clause.state.flags.setdefault(e.value, e)
        elif e.kind in {"comma", "and", "or"}:
            if not group and e.kind == "comma":
                break
            joined = "and" if e.kind in {"and", "or"} else (joined or "comma")
        elif (
            e.kind in {"det", "size", "adj", "verb", "word", "owner", "open", "to", "relative"}
            and not (e.kind == "to" and group and not joined)
            and not (e.kind in {"verb", "open"} and group)
        ) or (e.kind == "colon" and not group and cue == "leads"):
            pass
        elif e.kind == "open" and group and [x.kind for x in sentence[index + 1 : index + 3]] == ["amount", "close"] and last is not None:
            last.amounts += [x.mark for x in sentence[index + 1 : index + 2] if x.mark is not None]  # "the kitchen (9 m2), the bath (5 m2)"
            measures(clause, last)
            index += 2
        elif e.kind == "amount" and group and sentence[index - 1].kind == "np":
            break
        else:
            break
        index += 1
    return tuple(group), end


def _theirs(clause: Clause, owner: Element, left: Group) -> Group:
    """Return the bedroom of those who are named alone: "next to the parents'", "junto al de los padres"."""
    found = [r.id for r in clause.stock.of("bedroom") if r.role == owner.value and r.id not in left]
    clause.state.understood(owner.first, owner.last)
    owner.ids = found or [clause.stock.add("bedroom", owner.value, owner.text, None).id]
    return tuple(owner.ids)


def _denies(sentence: list[Element], but: Element) -> bool:
    """Whether "however does not" ends the sentence: what stands in front of it is its subject."""
    k = next(i for i, x in enumerate(sentence) if x is but)
    rest = [x.kind for x in sentence[k + 1 :] if x.kind not in {"verb", "word"}]
    return rest[:1] == ["neg"] and rest[1:2] in ([], ["comma"])


def _ends_list(sentence: list[Element], k: int) -> bool:
    """Whether what stands from k on is the end of a list of known rooms: "..., the kitchen and the bath"."""
    rest = sentence[k:]
    rooms = [x for x in rest if x.kind == "np"]
    plain = all(x.kind in {"np", "det", "adj", "size", "comma", "and"} for x in rest)
    return plain and all(x.definite and not x.banned for x in rooms) and len(rooms) > 1 and any(x.kind == "and" for x in rest)


def _continues(clause: Clause, index: int, cue: str, joined: str, first: Element) -> bool:  # noqa: PLR0911 - one answer per case: a grammar
    """Whether a list after a cue goes on with the phrase at index, or a new statement begins there."""
    e, sentence = clause.sentence[index], clause.sentence
    if cue == "open" and e.type in CLOSED and not e.definite:
        return False  # "a kitchen open to the living room and a terrace": nothing stands open to these
    ahead = next((x for x in sentence[index + 1 :] if x.kind not in {"det", "amount", "adj", "flag", "word"}), None)
    starts = ahead is not None and (
        ahead.kind in {"verb", "cmp", "neg", "relative", "factor"}
        or (ahead.kind == "but" and _denies(sentence, ahead))
        or (ahead.kind == "cue" and ahead.value != "except" and (ahead.value != "has" or ahead.text in FINITE) and cue != "avoid")
    )
    if starts and not (ahead is not None and ahead.kind == "relative"):
        return False
    many = any(clause.stock.get(i).type in HALLS for i in (clause.latest or clause.subject) if not i.startswith("*"))
    if clause.relative and cue == "leads" and joined == "comma" and e.introduces and first.definite and not many:
        return False  # "a living room that opens to the kitchen, one bedroom and one bath"
    if (
        cue in {"leads", "chain"}
        and joined == "comma"
        and e.number is not None
        and first.number is None
        and not any(x.kind == "and" for x in sentence[index:])
    ):
        return False
    if cue in WIDE:
        return not (cue == "between" and joined == "comma")
    if joined == "comma":
        return cue == "door" and first.definite and e.definite and _ends_list(sentence, index)
    new = bool(e.det & {"indefinite", "another"}) or e.number is not None
    if cue in {"door", "near", "open", "wall", "from", "ensuite", "cmp", "via"} and new and not e.definite:
        return bool(first.det & {"indefinite"}) and cue == "near"
    return not (e.definite != first.definite and not e.definite and cue != "open")
