"""Where rooms lie: storeys, wings and zones."""

from __future__ import annotations

from dataclasses import replace

from pipeline.floorplan.language.clause import LIGHT, LISTING, Clause, ids_of, named_rooms
from pipeline.floorplan.language.facts import PERSONAL, SOCIAL, Group
from pipeline.floorplan.language.lexicon import kinds
from pipeline.floorplan.language.marks import Mark
from pipeline.floorplan.language.phrases import Element, heads
from pipeline.floorplan.program.defaults import DEFAULTS


def level(c: Clause, k: int, e: Element) -> None:
    """Put rooms on a storey: those named before it, or, where it comes first, those that follow."""
    c.state.levels.append(e)
    ahead = c.near(k + 1)
    part = c.part(k)
    if c.forward and part and (ahead is None or ahead.kind == "comma"):  # "upstairs two bedrooms, the kitchen downstairs"
        for room in (c.stock.get(i) for i in named_rooms(part)):
            room.level = int(e.value)
        return
    if c.forward or heads(c.sentence, k) or ("*" in c.latest and ahead is not None and ahead.kind == "colon"):
        c.state.heights |= {"*": int(e.value)} if "*" in c.latest and not c.forward else {}
        c.forward, c.level, c.run = True, int(e.value), []
        return
    owners = c.subject if c.objects and c.latest == c.objects else ()  # "a guest room with bath, downstairs"
    for room in (c.stock.get(i) for i in named_rooms((*c.latest, *owners))):
        room.level = int(e.value)
    c.state.heights |= {i.removeprefix("*zone_"): int(e.value) for i in c.latest if i.startswith("*")}


def wing(c: Clause, _: int, e: Element) -> None:
    """Read "the bedrooms in one wing": they are a zone."""
    c.state.understood(e.first, e.last)
    ids, c.run = ids_of(c.run), []
    if not ids or all(i.startswith("*") for i in ids):
        c.state.wings += tuple(i.removeprefix("*zone_") for i in ids if i != "*")
        return
    zone_name = next((n for n, (members, _) in c.state.zones.items() if members and set(members) == set(ids)), None)
    zone_name = zone_name or ("bedroom" if c.types(ids) == {"bedroom"} else f"wing_{len(c.state.wings) + 1}")
    c.state.zones.setdefault(zone_name, (ids, e))
    c.state.wings += (zone_name,)


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
    home_before = before is not None and before.kind == "home" and not before.amounts and len(ids) > 1
    if home_before and times > MORE:  # "un piso de tres dormitorios de unos 95 metros cuadrados"
        return True
    last = not any(x.first >= mark.last for x in rooms)
    near = len(rooms) > 2 or (home and mark.first == c.sentence[k].last and mark.text[0].isdigit())
    return (times > HUGE and (home or rooms[0] is not c.sentence[k])) or (near and last and times > LARGE)


def attach(c: Clause, k: int, mark: Mark, *, home: bool = False) -> None:
    """Attach an amount that stands by itself, or behind the word for the home."""
    state = c.state
    around = c.sentence[max(0, k - 2) : k + 2]
    before, ahead = c.near(k - 1), c.near(k + 1)
    rooms = () if home else tuple(i for i in named_rooms(c.latest) if not i.startswith("<"))
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


def factor(c: Clause, k: int, e: Element) -> int | None:
    """Note a factor; "twice the living room" compares at once."""
    c.factor = e
    ahead = c.ahead(k + 1, "relative", "det")
    return compare(c, k, e) if ahead is not None and ahead.kind == "np" else k + 1


def compare(c: Clause, k: int, e: Element) -> int:
    """Read "at least 1.5 times as large as the largest bedroom"."""
    left = c.rooms_in_front() or (c.objects if c.relative else ()) or c.subject or c.latest
    if e.value == "alike":
        rooms = c.latest if len(c.latest) > 1 else ids_of(c.run)
        c.state.say("area_equal", named_rooms(rooms if len(rooms) > 1 else c.subject), (), e, LIKE)
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


HOSTS = kinds("hosts")
NO_PARTS = {"bedroom", "living_room", "family_room", "garage"}  # nothing that another room has


def has(c: Clause, k: int, e: Element) -> int | None:  # noqa: PLR0911 - one answer per kind of owner
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
    if kind == "kitchen" and thing.mark is not None and thing.mark.value == "dining_room/corner":  # "a kitchen with dining area"
        c.stock.get(owners[0]).functions.add("dining")
        c.state.understood(thing.first, thing.last)
        return at + 1
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
        c.run = [Element("np", "", e.first, e.last, "", ids=list(given), type=c.stock.get(given[0]).type)]
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
    return not joined or own or not ("another" in x.det or x.number is not None or x.type == "wc")


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
