"""Which rooms noun phrases and pronouns name: new ones, and those that were named before."""

from __future__ import annotations

from pipeline.floorplan.language.facts import SOCIAL, Group, Named, Reading
from pipeline.floorplan.language.phrases import Element

ALONE = {"living_room", "kitchen", "dining_room", "hallway", "entry", "utility", "garage", "staircase", "family_room", "studio_room"}
PLURAL_NAMES = {"staircase", "closet", "storage"}  # their plural often means one
THEIRS = {"child", "guest", "elder", "staff", "carer"}  # who has a room of another name than just a bedroom
ROLES = {"primary", "guest", "child", "elder", "staff", "carer", "shared", "ensuite"}


def listed(sentence: list[Element], k: int, room: Named) -> bool:
    """Whether a phrase spells out a count in front of a colon or a bracket: "three bedrooms: a master, two for the kids"."""
    for j in range(k - 1, -1, -1):
        e = sentence[j]
        if e.kind in {"colon", "open"}:
            return any(room.id in x.ids and len(x.ids) > 1 for x in sentence[:j])
    return False


def conjoined(sentence: list[Element], k: int) -> bool:
    """Whether the same kind of room was counted in the same list, so that this one comes on top."""
    kind = sentence[k].type
    for e in reversed(sentence[:k]):
        if e.kind in {"cue", "colon", "open", "verb", "comma"}:
            return False
        if e.kind == "np" and e.type == kind:
            return True
    return False


def repeated(sentence: list[Element], k: int) -> bool:
    """Whether a room of the type was named earlier in the sentence."""
    return any(e.kind == "np" and e.type == sentence[k].type for e in sentence[:k])


def close(room: Named, role: str, surface: str, level: int | None = None) -> Named:
    """Take a room that was only counted: its role, name and storey are known now."""
    room.open_slot = False
    room.role = room.role or role
    room.surface = surface
    room.level = room.level if room.level is not None else level
    return room


def name(state: Reading, sentence: list[Element], k: int, level: int | None) -> list[str]:
    """Return the ids of the rooms that the phrase k names; make those that are missing."""
    e = sentence[k]
    if not e.ids:
        e.ids = [r.id for r in _named(state, sentence, k, level)]
    if level is not None:
        for room in (state.inventory.get(i) for i in e.ids):
            room.level = level if room.level is None and not e.definite else room.level
    for room in (state.inventory.get(i) for i in e.ids):
        room.span = room.span or (e.first, e.last)
        room.functions |= e.functions
        if e.size != 1.0:
            room.size = e.size
    return e.ids


def _named(state: Reading, sentence: list[Element], k: int, level: int | None) -> list[Named]:  # noqa: PLR0911, PLR0912 - one answer per kind of phrase
    e, stock = sentence[k], state.inventory
    same = [r for r in stock.of(e.type) if e.role == "landing" or not is_landing(r)]
    role = e.role if e.role in ROLES else ""
    if e.suite:
        return _suites(state, sentence, k, role, level)
    suites = next((x.ids for x in reversed(sentence[:k]) if x.suite and x.ids), None) if e.type == "bedroom" and not role else None
    if suites and not e.ordinal and e.number is None:
        return [stock.get(i) for i in suites]
    if e.type == "hallway" and e.definite:
        word = e.text.rsplit(maxsplit=1)[-1]
        halls = [r for r in stock.rooms if r.type in {"hallway", "entry"} and word in r.surface.split()]
        if halls:
            return halls[:1]
    if e.part:
        free = [r for r in same if r.open_slot] or same
        total = int(e.number or 0)
        while len(same) < max(total, e.part):
            free.append(stock.add(e.type, "", e.text, level, open_slot=True))
            same = stock.of(e.type)
        return [close(r, role, e.text) for r in free[: e.part]]
    if "another" in e.det and not e.definite:
        return [stock.add(e.type, role, e.text, level, open_slot=(e.number or 1) > 1) for _ in range(int(e.number or 1))]
    if e.index:
        return [_indexed(state, e, role, level)]
    if e.ordinal:
        return _ordinal(state, e, role, level)
    if "other" in e.det:
        return _others(state, sentence, k, role, level)
    if role:
        found = _by_role(state, sentence, k, role, level)
        if found:
            return found
    elif same:
        return _known(state, sentence, k, level)
    count = int(e.number or (2 if "both" in e.det or (e.plural and e.type not in PLURAL_NAMES) else 1))
    return [stock.add(e.type, role, e.text, level, open_slot=count > 1) for _ in range(count)]


def _others(state: Reading, sentence: list[Element], k: int, role: str, level: int | None) -> list[Named]:
    """Return "the other two bedrooms": those that nothing was said of, new ones where they are too few."""
    e, stock = sentence[k], state.inventory
    same = stock.of(e.type)
    last = {i for g in state.past[-1:] for i in g} | {i for x in sentence[:k] for i in x.ids} | set(state.topic)
    rest = [r for r in same if r.open_slot] or [r for r in same if r.id not in last] or ([] if len(same) == 1 else same[-1:])
    many = e.plural or (e.number or 0) > 1
    if e.number is not None and e.type == "bedroom":
        told = last | {g[0] for g in state.past if len(g) == 1}
        rest = [r for r in rest if r.open_slot or r.id not in told]
        while len(rest) < e.number:
            rest.append(stock.add(e.type, role, e.text, level))
    return (rest if many else [close(r, "", e.text) for r in rest[:1]]) or [stock.add(e.type, role, e.text, level)]


def fresh(state: Reading, e: Element, level: int | None, owner: str) -> list[str]:
    """Return a room that somebody has of their own: one that was only counted, or a new one."""
    role = e.role if e.role in ROLES else ""
    theirs = [r for r in state.inventory.of(e.type) if r.role == owner and e.type == "bedroom"]
    slots = theirs or [r for r in state.inventory.of(e.type) if r.open_slot and not r.role and (level is None or r.level in {None, level})]
    room = close(slots[0], role, e.text) if slots else state.inventory.add(e.type, role, e.text, level)
    e.ids = [room.id]
    return e.ids


def _suites(state: Reading, sentence: list[Element], k: int, role: str, level: int | None) -> list[Named]:
    e, stock = sentence[k], state.inventory
    count = int(e.number or (2 if e.plural else 1))
    same = [r for r in stock.of("bedroom") if r.role == role] if role else []
    if same and not e.introduces:
        return same
    slots = [r for r in stock.of("bedroom") if r.open_slot and not r.role and (r.whole or e.definite or listed(sentence, k, r))]
    made = [close(r, role, e.text) for r in slots[:count]]
    return made + [stock.add("bedroom", role, e.text, level) for _ in range(count - len(made))]


def _indexed(state: Reading, e: Element, role: str, level: int | None) -> Named:
    stock = state.inventory
    for room in stock.of(e.type):
        if room.index == e.index:
            return room
    free = [r for r in stock.of(e.type) if not r.index and r.open_slot]
    room = free[0] if free else stock.add(e.type, role, e.text, level)
    room.index, room.open_slot = e.index, False
    return room


def _ordinal(state: Reading, e: Element, role: str, level: int | None) -> list[Named]:
    stock = state.inventory
    same = stock.of(e.type)
    if e.text[:1] in {"次", "侧"} and same:  # "次卧": a bedroom beside the main one, which nobody else has
        here = [r for r in same if r.surface == e.text and not r.open_slot] or [r for r in same if r.open_slot and not r.role]
        if here or all(r.role for r in same):
            return [close(here[0], role, e.text)] if here else [stock.add(e.type, role, e.text, level)]
    if len(same) >= e.ordinal:
        rest = same if e.ordinal == 1 else [r for r in same if r.role != "primary"]
        loose = [r for r in rest if r.open_slot] or rest[-1:]
        return [close(loose[0], role, e.text)] if loose else same[:1]
    if any(r.whole for r in same):
        state.say("beyond", tuple(r.id for r in same), (), e, float(e.ordinal))
        return same[-1:]
    while len(stock.of(e.type)) < e.ordinal - 1:
        stock.add(e.type, "", e.text, level, open_slot=True)
    return [stock.add(e.type, role, e.text, level)]


def _counted_later(sentence: list[Element], k: int, room: Named) -> bool:
    """Whether a room is one of a number that comes later in the list that the phrase at k stands in."""
    for e in sentence[k + 1 :]:
        if e.kind not in {"np", "comma", "and", "det"}:
            return False
        if room.id in e.ids and e.number is not None:
            return True
    return False


def _by_role(state: Reading, sentence: list[Element], k: int, role: str, level: int | None) -> list[Named]:  # noqa: PLR0911 - one branch per case: a grammar
    """Return the rooms of a role; one that was only counted may take it."""
    e, stock = sentence[k], state.inventory
    same = stock.of(e.type)
    found = [r for r in same if r.role == role]
    many = e.plural or bool(e.det & {"all", "both", "each"}) or (e.number or 0) > 1
    if found and not (e.introduces and not many):
        return found if many or len(found) == 1 else found[:1]
    if e.type == "bathroom":
        if role in {"ensuite", "primary"}:
            return []
        slots = [r for r in same if r.open_slot and not r.role]
        plain = [r for r in same if not r.role and not state.inventory.owned(r.id)]
        if slots:
            return [close(slots[0], role, e.text)]
        bare = "bare_nouns" in state.heard.lexicon.traits and not e.det and e.number is None  # no articles there
        return [close(plain[0], role, e.text)] if (e.definite or bare) and len(plain) == 1 else []
    if e.type != "bedroom":
        plain = [r for r in same if not r.role]
        return [close(plain[0], role, e.text)] if plain and e.definite and not repeated(sentence, k) else []
    slots = [
        r
        for r in same
        if r.open_slot
        and not r.role
        and (e.definite or r.whole or listed(sentence, k, r) or not conjoined(sentence, k))
        and not (r.extra and r.span is not None and r.span[0] > e.first)  # "the main bedroom ...; two more bedrooms"
        and not (role == "primary" and r.surface[:1] in {"次", "侧"})
        and (
            e.definite or r.whole or "bare_nouns" in state.heard.lexicon.traits or not _counted_later(sentence, k, r)
        )  # "maid's room, two bedrooms"
        and ((e.definite and level is None) or r.level is None or r.level == level)  # counted on another storey: others
    ]
    if many and slots:
        count = int(e.number or len(slots))
        return [close(r, role, e.text) for r in slots[:count]]
    if slots:
        return [close(slots[0], role, e.text)]
    plain = [r for r in same if not r.role and not (r.extra and r.span is not None and r.span[0] > e.first)]
    if len(plain) == 1 and len(same) == 1 and e.definite and not many:
        return [close(plain[0], role, e.text)]
    return []


LANDINGS = {"landing", "rellano", "descansillo", "galerie", "treppenabsatz"}


def is_landing(room: Named) -> bool:
    """Whether a hallway is the one at the head of the stairs: "the hall" is another."""
    return room.type == "hallway" and bool(LANDINGS & set(room.surface.split()))


def _known(state: Reading, sentence: list[Element], k: int, level: int | None) -> list[Named]:  # noqa: C901, PLR0911, PLR0912 - one branch per case: a grammar
    """Return the rooms that a phrase without role points at, where there are such rooms."""
    e, stock = sentence[k], state.inventory
    same = [r for r in stock.of(e.type) if not (r.extra and r.span is not None and r.span[0] > e.first)]
    same = [r for r in same if e.role == "landing" or not is_landing(r)]
    if not e.plural and not e.number and e.type in {"bathroom", "bedroom"}:  # "... a bath; further a guest bath"
        same = [r for r in same if not (r.role in ROLES and r.span is not None and r.span[0] > e.last)]
    if e.type == "bedroom" and not (
        e.plural or e.number or e.det & {"all", "both", "each", "other"}
    ):  # "das Kinderzimmer ..., das Schlafzimmer ..."
        same = [r for r in same if r.role not in THEIRS or e.text.rsplit(maxsplit=1)[-1] in r.surface.split()]
    if not same:  # "..., another bath" comes later
        return [stock.add(e.type, "", e.text, level)]
    if level is not None:
        here = [r for r in same if r.level in {None, level}]
        if not here and not e.definite and not e.plural:
            return [stock.add(e.type, "", e.text, level)]
        same = here or same
    many = e.plural or bool(e.det & {"all", "both", "each"}) or (e.number or 0) > 1
    if not many and len(same) > 1 and e.adjectives & {"largest", "smallest"}:
        return same[:1] if "largest" in e.adjectives else same[-1:]
    if many:
        number = int(e.number or (2 if "both" in e.det and e.type == "bedroom" else 0))
        if number > len(same) and all(not r.whole for r in same) and e.definite:
            while len(stock.of(e.type)) < number:
                stock.add(e.type, "", e.text, level, open_slot=True)
            same = stock.of(e.type)
        elif number > len(same):
            state.say("beyond", tuple(r.id for r in same), (), e, float(number))
        elif 0 < number < len(same):
            last = [r for g in state.past[-1:] for r in (stock.get(i) for i in g) if r.type == e.type]
            loose = [r for r in same if r.open_slot]
            return last if len(last) == number else (loose if len(loose) >= number else same)[:number]
        return same
    if (
        not e.det
        and e.type == "bathroom"
        and "bare_nouns" not in state.heard.lexicon.traits
        and all(stock.owned(r.id) or r.role == "ensuite" for r in same)
    ):
        return [stock.add(e.type, "", e.text, level)]  # "a master with en suite, ..., bathroom"
    if not e.det and (_repeated_bare(sentence, k) or (e.type == "storage" and all(e.text != r.surface for r in same))):
        return [stock.add(e.type, "", e.text, level)]
    if len(same) > 1 and "bare_nouns" in state.heard.lexicon.traits and not e.det and e.number is None and all(r.open_slot for r in same):
        return same  # no plural there: "两间卧室 ... 卧室都朝走廊"
    if len(same) > 1:
        if e.number == 1 and (loose := [r for r in same if r.open_slot and not r.role]):
            return [close(loose[0], "", e.text)]  # "one bedroom ..., the other ..."
        word = e.text.rsplit(maxsplit=1)[-1]
        same = [r for r in same if word in r.surface.split()] or same
        recent = [r for r in same if any(r.id in x.ids for x in sentence[:k])]
        plain = [r for r in same if not r.role]
        return (recent[-1:] if e.definite and recent else plain or same)[:1]
    return same[:1]


def _repeated_bare(sentence: list[Element], k: int) -> bool:
    """Whether a list names the same kind of room again: "bedroom, bedroom, bath"."""
    ahead = sentence[k + 1] if k + 1 < len(sentence) else None
    han = sentence[k].text[:1] >= "\u3400"  # "一间书房,书房远离卧室"
    if sentence[k].type in ALONE or (ahead is not None and (ahead.kind in {"verb", "neg"} or (han and ahead.kind == "cue"))):
        return False
    for j in range(k - 1, -1, -1):
        e = sentence[j]
        if e.kind == "np":
            if e.type == sentence[k].type:
                spoken = k + 1 < len(sentence) and sentence[k + 1].kind in {"cue", "verb", "neg", "flag", "cmp"}  # Chinese has no articles
                return not (spoken and sentence[k - 1].kind == "comma") and (
                    not j or sentence[j - 1].kind not in {"cue", "enter", "det", "cmp"}
                )
        elif e.kind not in {"comma", "and", "amount", "open", "close"}:
            return False
    return False


def point(state: Reading, before: list[Element], e: Element, but: Group) -> Group:  # noqa: PLR0911 - one answer per pronoun
    """Return the rooms that a pronoun stands for after the elements `before`; as an object it does not point at the subject `but`."""
    here = [tuple(x.ids) for x in before if x.kind in {"np", "zone", "owner"} and x.ids]
    heard = [*state.past, *here]
    if e.value == "it":
        if here and but:
            return next((g for g in reversed(heard) if not set(g) & set(but)), ())
        if but:
            return next((g for g in reversed(state.past) if not set(g) & set(but)), ())
        return here[0] if here else (state.topic or (state.past[-1] if state.past else ()))
    if e.value == "pair":  # "in between"
        if not here and len(state.topic) == 2:
            return state.topic
        twins: Group = next((g for g in reversed(heard) if len(g) == 2 and not all(map(state.inventory.owned, g))), ())
        if any(x.kind == "zone" for x in before) or (not twins and sum(not set(g) <= set(but) for g in here) > 2):
            return ()
        return twins or tuple(dict.fromkeys(i for g in reversed(heard) for i in g if i not in but))[:2]
    if e.value == "both":
        pair: Group = next((g for g in reversed(heard) if len(g) == 2), ())
        single = dict.fromkeys(i for g in reversed(heard) for i in g if i not in but)
        return pair if pair and pair == heard[-1] else (tuple(single)[:2] if len(single) > 1 else pair)
    plural: Group = next((g for g in reversed(heard) if len(g) > 1), heard[-1] if heard else ())
    if e.value == "group" and len(plural) == 1 and not plural[0].startswith("*"):
        kind = state.inventory.get(plural[0]).type
        same = [i for g in heard for i in g if not i.startswith("*") and state.inventory.get(i).type == kind]
        plural = tuple(dict.fromkeys(same))
    if e.value in {"one", "rest", "some"} and plural and not plural[0].startswith("*"):
        return _part(state, e, plural)
    return plural


def _part(state: Reading, e: Element, plural: Group) -> Group:
    """Return one of a group, or those of it that nothing was said of yet."""
    kind = state.inventory.get(plural[0]).type
    free = [r for r in state.inventory.of(kind) if r.open_slot]
    if e.value != "one":
        return tuple(r.id for r in free) or plural
    count = int(e.number or 1)
    for room in free[:count]:
        room.open_slot = False
    return tuple(r.id for r in free[:count])


def and_follows(sentence: list[Element], comma: Element) -> bool:
    """Whether a comma parts a list of social rooms that an "and" closes: "open-plan living, dining and kitchen area"."""
    k = next(i for i, x in enumerate(sentence) if x is comma)
    for x in sentence[k + 1 :]:
        if x.kind == "and":
            return True
        if x.kind != "comma" and not (x.kind == "np" and x.type in SOCIAL):
            return False
    return False
