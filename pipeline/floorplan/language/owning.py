"""What rooms have: "a bedroom with its own bathroom", "the living room has a terrace"."""

from __future__ import annotations

from pipeline.floorplan.language.clause import Clause
from pipeline.floorplan.language.facts import PERSONAL, Group
from pipeline.floorplan.language.naming import name
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.places import storey

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
