"""What rooms have: bathrooms, closets and balconies that belong to bedrooms, and what opens off the others."""

from __future__ import annotations

from pipeline.floorplan.language.clause import LIGHT, LISTING, Clause, ids_of, known
from pipeline.floorplan.language.facts import PERSONAL, SOCIAL, Group
from pipeline.floorplan.language.phrases import Element

HOSTS = {"living_room", "family_room", "studio_room", "dining_room", "kitchen", "hallway", "entry", "office", "garage", "media_room", "bathroom"}  # fmt: skip
NO_PARTS = {"bedroom", "living_room", "family_room", "garage"}  # nothing that another room has


def has(c: Clause, k: int, e: Element) -> int:  # noqa: PLR0911 - one answer per kind of owner
    """Read "X with its own bathroom", "the living room has a terrace": rooms that hang on the one named before."""
    before = next((x for x in reversed(c.sentence[:k]) if x.kind in {"np", "home", "pron", "every", "det", "level"}), None)
    at = next((j for j in range(k + 1, len(c.sentence)) if c.sentence[j].kind not in {*LIGHT, "amount"}), None)
    thing = c.sentence[at] if at is not None and c.sentence[at].kind == "np" else None
    owners = _owners(c, k, e, before, thing)
    if not owners:
        return k + 1
    kind = c.stock.get(owners[0]).type
    negative, c.negative = c.negated(k), None
    if kind == "bedroom":
        return k + 1 if negative else _give(c, k, e, owners)
    if thing is None or at is None or kind not in HOSTS or len(owners) > 1 or thing.banned or negative:
        return k + 1
    if kind == "kitchen" and thing.mark is not None and thing.mark.value == "dining_room/corner":  # "a kitchen with dining area"
        c.stock.get(owners[0]).functions.add("dining")
        return at + 1
    if kind == "hallway" and thing.type == "bedroom" and not thing.definite:  # "a corridor with two bedrooms and a bathroom"
        group, j = c.after(at, "leads", owners)
        c.state.say("door", group, owners, e)
        c.latest, c.run = group, [thing]
        return j
    if thing.type in NO_PARTS or (thing.ids and thing.definite):
        return k + 1
    ids = c.named(at)
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
        return known(tuple(near.ids))  # "the living room leads to a hall with two bedrooms"
    owners = known(tuple(c.run[-1].ids) if c.run else c.subject)
    if len(c.run) > 1 and (c.verb or c.says(e, "having") or c.says(e, "every")) and not any(x.part for x in c.run):
        listed = known(ids_of(c.run))
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
        or x.definite
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
    ids = list(x.ids)
    role = x.role if x.role == "primary" and len(owners) == 1 else ""
    slots = [r for r in c.stock.of(x.type) if r.open_slot and r.id not in ids and not c.stock.owned(r.id)]
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
