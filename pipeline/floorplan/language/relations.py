"""What the words for relations say: who is joined to whom, who has what, how one gets from room to room, sizes against each other."""

from pipeline.floorplan.language.clause import LIGHT, LISTING, Clause, ids_of, named_rooms
from pipeline.floorplan.language.lexicon import kinds
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.rooms import HALLS, PERSONAL, SOCIAL, Group

DENIED = {"near": "ban", "wall": "ban", "away": "near", "open": "not_open", "avoid": "avoid"}  # what "not" makes of a relation
HOSTS = kinds("hosts")
NO_PARTS = {"bedroom", "living_room", "family_room", "garage"}  # nothing that another room has
SECLUDED = {"storage", "closet", "wc", "bathroom", "balcony", "utility"}  # "X in Y": X opens off Y


def relate(c: Clause, k: int, e: Element) -> int | None:  # noqa: PLR0911 - one answer per kind of relation
    """Read one relation; return where to go on."""
    if e.value == "has":
        return has(c, k, e)
    if e.value == "except":
        return except_rooms(c, k, e)
    if e.value.startswith("thru"):
        return through(c, k, e)
    c.relative = c.relative or bool(c.state.heard.lexicon.sign("relative_cue") & set(e.text.split()[:3]))  # "que da al"
    left, group, j = _sides(c, k, e)
    if not group:
        return _alone(c, k, e)
    if e.value == "in" and (c.negative is not None or (k and c.sentence[k - 1].kind == "and") or not _inside(c, left, group)):
        c.latest, c.run = group, [x for x in c.sentence[k:j] if x.kind == "np"][-1:]
        return j
    if c.sentence[j - 1].kind == "zone" and e.value in {"door", "in"}:
        return j
    behind = c.near(j)
    only = e.only or c.only is not None or c.says(e, "only") or (behind is not None and behind.value == "only")
    if e.value == "chain":
        left = c.objects or left
    if e.value == "from" and left and behind is not None and behind.value == "leads" and c.ends(j + 1):
        j += 1  # "the bath one reaches from the hall"
    elif e.value == "from" and _leads_on(c, j):
        c.goes_on(group)
        c.objects = ()
        return j
    if not left:  # "off the foyer are a wc and the living room"
        c.waiting = (e, group)
        c.subject, c.latest, c.run, c.verb = (), group, [], False
        return j
    _emit(c, e, left, group)
    if only and e.value in {"door", "from"}:
        c.state.say("only", left, (), e)
    c.only = None
    c.goes_on(group, subject=left)
    return j


def _sides(c: Clause, k: int, e: Element) -> tuple[Group, Group, int]:
    """Return who stands in front of a relation, who behind it, and where reading goes on."""
    ahead = c.near(k + 1)
    first = k == 0 or c.sentence[k - 1].kind in LISTING
    left = () if ahead is not None and ahead.value == "pair" and first else c.subjects(k, e)  # "dazwischen liegt das Bad"
    wide = ahead is not None and ahead.kind == "np" and (len(left) > 2 or (len(left) > 1 and ahead.definite))
    group, j = c.after(k + 1, "leads" if e.value == "door" and c.says(e, "to_many") else e.value, () if wide else left)
    return tuple(i for i in left if i not in group), group, j


def _leads_on(c: Clause, j: int) -> bool:
    """Whether "from the garage" goes on with "you get into ..."."""
    ahead = c.ahead(j, "verb", "det", "flag", "adj", "word", "pron")
    return ahead is not None and ahead.kind == "cue" and ahead.value == "leads"


def _inside(c: Clause, left: Group, group: Group) -> bool:
    """Whether "X in Y" means that X opens off Y, as a cupboard in the hall does."""
    kinds, hosts = c.types(left), c.types(group)
    if not kinds or not hosts:
        return False
    return kinds == {"balcony"} or hosts <= HALLS or (kinds <= SECLUDED and hosts <= {*HALLS, "bedroom", "kitchen", "utility"})


def _alone(c: Clause, k: int, e: Element) -> int | None:
    """Read a relation that nothing follows: "next to each other", "kitchen and bath adjacent"."""
    ahead = c.near(k + 1)
    mutual = ahead is not None and ahead.kind == "reciprocal"
    if mutual or (e.value == "wall" and c.run):  # "the two bedrooms must not share a wall with one another"
        rooms = next((g for g in (c.latest, ids_of(c.run)) if len(g) > 1), c.subject)
        _emit(c, e, rooms[:1], rooms[1:])
        c.subject = c.latest = rooms
        return k + 1 + mutual
    if e.value == "between" and e.text in c.state.heard.lexicon.sign("amid"):
        c.state.understood(e.first, e.last)  # "... as a buffer in between" points back at what was said
    return None


def _emit(c: Clause, e: Element, left: Group, group: Group) -> None:
    """Record a relation between rooms, or that there is none."""
    cue = "door" if e.value in {"from", "chain", "in"} else e.value
    kinds = c.types((*left, *group))
    if cue == "apart":  # a kitchen apart from the living room has a door; a bedroom apart from it lies away
        if c.negative is not None and kinds <= SOCIAL:
            c.deny()
            cue = "open"  # "the kitchen is not separated from the living room"
        else:
            cue = "not_open" if kinds <= SOCIAL and not any(i[0] == "*" for i in (*left, *group)) else "away"
    if c.negative is not None:
        c.deny()
        through, at = (cue == "door" and c.says(e, "through")), (cue == "door" and c.says(e, "at"))
        c.state.say("avoid" if through else "ban" if at else DENIED.get(cue, "not_connected"), left, group, e)
    elif cue == "ensuite":
        c.give(left, group, e)
    else:
        c.state.say(cue, left, group, e)


def complete(c: Clause) -> None:
    """Give a relation that stood in front of its subject what followed."""
    assert c.waiting is not None
    (cue, group), c.waiting = c.waiting, None
    rooms = tuple(i for i in c.subject if i not in group)
    if rooms:
        _emit(c, cue, rooms, group)


# ways


def except_rooms(c: Clause, k: int, e: Element) -> int:
    """Read "all rooms but the pantry open off the hall": those that are left out, and who goes on."""
    group, j = c.after(k + 1, "except", ())
    c.state.say("except", group, (), e)
    c.left_out = group
    each = next((x for x in c.sentence[:k] if x.kind == "every" or (x.kind == "np" and set(x.ids) > set(group))), None)
    if each is not None and not any(x.kind == "cue" for x in c.sentence[:k]):
        each.ids = [i for i in each.ids if i not in group]
        c.run, c.latest, c.subject = [each], tuple(each.ids), tuple(each.ids)
        return max(j, k + 1)
    c.run, c.latest = [x for x in c.sentence[k:j] if x.kind == "np"][-1:], group
    return max(j, k + 1)


def through(c: Clause, k: int, e: Element) -> int:
    """Read "you pass through the dining room to reach the kitchen", and what must not be so."""
    first, j = c.after(k + 1, "door", ())
    while first and (x := c.near(j)) is not None and x.kind in {"verb", "comma"}:
        j += 1
    second, j = c.after(j, "leads" if e.value == "thru" else "door", first) if first else ((), k + 1)
    if not second:
        return max(j, k + 1)
    things, hosts = (second, first) if e.value == "thru" else (first, second)
    c.state.say("avoid" if c.deny() or e.value == "thru_not" else "door", things, hosts, e)
    c.goes_on(things)
    return j


def enter(c: Clause, e: Element, group: Group, j: int) -> int:
    """Let a room be the one that one enters, and what follows go on from there: "into the hall", ", then a hall"."""
    group = named_rooms(group)
    if not group:
        return j
    c.state.entrance = c.state.entrance or (group[0], e)
    c.goes_on(group)
    c.waiting = None
    return j


# who has what


def has(c: Clause, k: int, e: Element) -> int | None:
    """Read "X with its own bathroom", "the living room has a terrace": rooms that hang on the one named before."""
    before = next((x for x in reversed(c.sentence[:k]) if x.kind in {"np", "home", "pron", "every", "det", "level"}), None)
    at = next((j for j in range(k + 1, len(c.sentence)) if c.sentence[j].kind not in {*LIGHT, "amount"}), None)
    thing = c.sentence[at] if at is not None and c.sentence[at].kind == "np" else None
    owners = _owners(c, k, e, before, thing)
    if not owners:
        return None
    kind = c.stock.get(owners[0]).type
    negative, c.negative = c.negated(k), None
    if kind == "bedroom":
        return None if negative else _give(c, k, e, owners)
    if thing is None or at is None or kind not in HOSTS or len(owners) > 1 or thing.banned or negative:
        return None
    if kind == "hallway" and thing.type == "bedroom" and not thing.definite:  # "a corridor with two bedrooms and a bathroom"
        group, j = c.after(at, "leads", owners)
        c.state.say("door", group, owners, e)
        c.latest, c.run = group, [thing]
        return j
    if thing.type in NO_PARTS or (thing.ids and thing.definite):
        return None
    ids = c.rooms_at(at)
    opened = thing.type in {"kitchen", "dining_room"} and kind in {*SOCIAL, "studio_room"}
    c.state.say("open" if opened else "door", ids, owners, e)
    c.measures(thing)
    c.latest, c.run, c.subject, c.objects = ids, [thing], c.subject or owners, ids
    return at + 1


def _owners(c: Clause, k: int, e: Element, before: Element | None, thing: Element | None) -> Group:
    """Return who has what follows: the phrase in front, or the list in front of a verb; nobody where the home has it."""
    if before is None or before.kind == "home" or not (c.run or c.subject):
        return ()
    own = thing is not None and "own" in thing.det
    if before.kind == "level" and (c.forward or not c.run or not own):
        return ()
    if before.value == "it" and c.state.homes and before.ids and all(i[0] != "*" and c.stock.get(i).whole for i in before.ids):
        return ()  # "a one-bedroom flat. It needs a study": the flat
    near = c.sentence[k - 1]
    if not c.run and near.kind == "np" and near.ids and set(near.ids) <= set(c.objects) and c.says(e, "with"):
        return named_rooms(tuple(near.ids))  # "the living room leads to a hall with two bedrooms"
    owners = named_rooms(tuple(c.run[-1].ids) if c.run else c.subject)
    if len(c.run) > 1 and (c.verb or c.says(e, "having") or c.says(e, "every")) and not any(x.part for x in c.run):
        listed = named_rooms(ids_of(c.run))
        owners = listed if c.types(listed) == {"bedroom"} else owners
    return owners


def _give(c: Clause, k: int, e: Element, owners: Group) -> int:
    """Give bedrooms what follows: bathrooms, closets, balconies, as many as there are owners."""
    j, end, joined = k + 1, k + 1, ""
    given: Group = ()
    while (x := c.near(j)) is not None:
        if x.kind == "np" and x.type == "bedroom" and not given and not x.ids and any(y.suite for y in c.sentence[:k]):
            x.ids, joined, end = list(owners), "", j + 1  # "each suite has a bedroom of 18 m², its own bathroom ..."
            c.measures(x)
        elif x.kind == "np":
            if x.banned or x.type not in PERSONAL or (given and not joined) or not _theirs(c, j, owners, joined):
                break
            ids = _things(c, j, owners)
            c.give(ids, owners, x)
            c.measures(x)
            given, joined, end = ids, "", j + 1
        elif x.kind in LISTING:
            joined = "comma" if x.kind == "comma" and joined != "and" else "and"
        elif x.kind not in LIGHT - {"verb"} and x.value != "has":
            break
        j += 1
    if given:
        c.latest, c.subject, c.objects, c.verb = given, owners, given, False
        c.run = [Element("np", first=e.first, last=e.last, ids=list(given), type=c.stock.get(given[0]).type)]
    return end


def _theirs(c: Clause, j: int, owners: Group, joined: str) -> bool:
    """Whether the room at j is the owners' own, and not one of the home's that a list goes on with."""
    x, own = c.sentence[j], "own" in c.sentence[j].det
    after = c.near(j + 1)
    both = after is not None and after.value in {"both", "all"} and not own and c.ends(j + 2)  # "two bedrooms with a bath for both"
    number = x.number or 1
    if (
        x.role in {"shared", "guest"}
        or (x.definite and (len(owners) > 1 or len(c.stock.of(x.type)) > 1 or x.ids or not c.ends(j + 1)))
        or number > len(owners)
        or (both and len(owners) > 1)
        or (len(owners) > 2 and 1 < number < len(owners))
    ):
        return False
    if joined == "comma" and not own:
        rest = next((y for y in c.sentence[j + 1 :] if not (y.kind in {"comma", "det"} or (y.kind == "np" and y.type in PERSONAL))), None)
        return rest is not None and rest.kind == "and"  # "with a bath, closet and balcony"
    return not joined or own or not ("another" in x.det or x.number or x.type == "wc")


def _things(c: Clause, j: int, owners: Group) -> Group:
    """Return one room for each owner: those that were counted first, then new ones."""
    x = c.sentence[j]
    ids = list(x.ids) or [r.id for r in c.stock.of(x.type) if x.definite]
    role = x.role if x.role == "primary" and len(owners) == 1 else ""
    slots = [r for r in c.stock.of(x.type) if r.open_slot and r.id not in ids and r.id not in c.stock.belongings]
    while len(ids) < len(owners):
        if slots:
            room = slots.pop(0)
            room.open_slot, room.surface = False, x.text
        else:
            room = c.stock.add(x.type, role, x.text, c.stock.get(owners[0]).level)
        ids.append(room.id)
    x.ids = ids[: len(owners)] if x.type == "bathroom" else ids
    for room in (c.stock.get(i) for i in x.ids):
        room.size = x.size if x.size != 1.0 else room.size
    return tuple(x.ids)
