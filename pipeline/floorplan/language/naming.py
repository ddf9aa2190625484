"""Which rooms a noun phrase names: new ones, and those that were named before."""

from __future__ import annotations

from pipeline.floorplan.check import ImpossibleError
from pipeline.floorplan.language.facts import Reading
from pipeline.floorplan.language.inventory import Named
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.text import spread
from pipeline.floorplan.program import MAX_ROOMS, Evidence

ALONE = {"living_room", "kitchen", "dining_room", "hallway", "entry", "utility", "garage", "staircase", "family_room", "studio_room"}
PLURAL_NAMES = {"staircase", "closet", "storage"}  # their plural often means one
ROLES = {"primary", "guest", "child", "elder", "staff", "carer", "shared", "ensuite"}


def heads(sentence: list[Element], k: int) -> bool:
    """Whether the level at k opens a new part of a sentence: "living room, kitchen, and upstairs two bedrooms"."""
    before, after = sentence[k - 1].kind if k else "", next((x for x in sentence[k + 1 :] if x.kind not in {"det", "flag"}), None)
    return before in {"comma", "and"} and after is not None and after.kind in {"np", "colon"}


def introduce(state: Reading, sentences: list[list[Element]]) -> None:
    """Make the rooms that numbers and indefinite articles introduce: whole counts first, so that later words may tell them apart."""
    for whole in (True, False):
        for sentence in sentences:
            level = _first_level(sentence)
            suites = False  # "a suite: ... a bedroom": the suite's own
            for k, e in enumerate(sentence):
                if e.kind == "level":
                    level = int(e.value) if not (level is None and k) or heads(sentence, k) else level
                if e.suite and e.kind == "np":
                    suites = True
                if (
                    e.kind == "np"
                    and e.introduces
                    and not e.ids
                    and not e.suite
                    and not (suites and e.type == "bedroom" and e.number is None)
                    and _whole(sentence, k) == whole
                ):
                    _few(state, e)
                    made = _count_all(state, e) if whole else _introduced(state, sentence, k, backward(sentence, k, level))
                    e.ids = [r.id for r in made]


def _few(state: Reading, e: Element) -> None:
    """Refuse more rooms than a program holds, with the words."""
    if (e.number or 0) > MAX_ROOMS:
        start, end = spread(state.heard.tokens[max(e.first - 1, 0) : e.last])
        words = [Evidence(start=start, end=end, text=state.heard.prompt[start:end], field="rooms")]
        raise ImpossibleError(f"{e.number:g} {e.type.replace('_', ' ')}s are asked for", f"ask for {MAX_ROOMS} rooms at most", words)


def _first_level(sentence: list[Element]) -> int | None:
    first = next((e for e in sentence if e.kind in {"np", "level"}), None)
    return int(first.value) if first is not None and first.kind == "level" else None


def backward(sentence: list[Element], k: int, level: int | None) -> int | None:
    """Return the storey of a phrase: of the level named before it, or behind it where sentences name levels behind."""
    if level is not None:
        return level
    parted = False
    for j, e in enumerate(sentence[k + 1 :], k + 1):
        if e.kind == "level":
            return None if heads(sentence, j) else int(e.value)
        parted = parted or e.kind == "comma"
        if e.kind in {"np", "and", "comma"}:
            continue
        if e.kind == "verb" and parted:  # "four bedrooms, the guest room is downstairs"
            break
        if e.kind in {"cue", "colon"}:
            break
    return None


def _whole(sentence: list[Element], k: int) -> bool:
    """Whether the number of a phrase is the count of all such rooms: "a two-bedroom flat", "three baths in total"."""
    e = sentence[k]
    if e.compound and not e.role:
        return True
    return any(x.kind == "flag" and x.value == "total" for x in sentence[k + 1 : k + 2]) and e.number is not None and not e.amounts


def _count_all(state: Reading, e: Element) -> list[Named]:
    stock = state.inventory
    while len(stock.of(e.type)) < int(e.number or 1):
        room = stock.add(e.type, "", e.text, None, open_slot=True)
        room.whole, room.span = True, (e.first, e.last)
    return stock.of(e.type)[: int(e.number or 1)]


def _introduced(state: Reading, sentence: list[Element], k: int, level: int | None) -> list[Named]:  # noqa: PLR0911 - one branch per case: a grammar
    """Return the rooms of a phrase with a number or an indefinite article."""
    e, stock = sentence[k], state.inventory
    count = int(e.number or (2 if e.plural and e.type not in PLURAL_NAMES else 1))
    same = stock.of(e.type)
    slots = [r for r in same if r.open_slot and (level is None or r.level in {None, level}) and not r.role]
    role = e.role if e.role in ROLES else ""
    if e.number is not None and not role and "another" not in e.det and count > len(same) and any(r.whole for r in same):
        state.say("beyond", tuple(r.id for r in same), (), e, float(count))
        return same
    if slots and e.type == "bathroom" and count == 1 and _had(sentence, k) and not any(r.id in x.ids for r in slots for x in sentence[:k]):
        return []  # "three baths. Two of the bedrooms have an en suite": of those that were counted
    if slots and _predicative(sentence, k):
        return [_close(slots[0], role, e.text)]
    if "another" not in e.det:
        if role and role != "ensuite":
            here = [r for r in same if r.role == role]
            if here and len(here) == count:
                return here
            wide = [r for r in slots if r.whole or _listed(sentence, k, r)]
            if len(wide) >= count and e.type != "bathroom":
                return [_close(r, role, e.text) for r in wide[:count]]
        elif not role and slots and not _contrasted(sentence, k):
            if len(slots) == count == len(same) and count > 1:
                return slots
            known = all(r.whole for r in slots) or (e.number is not None and count < len(slots) and len(slots) > 1)
            if known and count <= len(slots) and not _conjoined(sentence, k):
                return [_close(r, "", e.text, level) for r in slots[:count]]
        if count == 1 and e.number is None and not role and e.type in ALONE and same and not _repeated(sentence, k):
            return same[:1]
    made = [stock.add(e.type, role, e.text, level, open_slot=count > 1) for _ in range(count)]
    for room in made:
        room.extra, room.span = "another" in e.det, (e.first, e.last)
    return made


def _had(sentence: list[Element], k: int) -> bool:
    """Whether a bedroom has the room of the phrase at k."""
    before = [e for e in sentence[:k] if e.kind in {"np", "cue", "comma", "and", "pron"}][-2:]
    return (
        len(before) > 1
        and before[1].value == "has"
        and before[1].kind == "cue"
        and (before[0].type == "bedroom" or before[0].kind == "pron")
    )


def _contrasted(sentence: list[Element], k: int) -> bool:
    """Whether a count is told apart from the one in front by an adjective: "3 hab dobles, 1 hab individual"."""
    before = next((e for e in reversed(sentence[:k]) if e.kind == "np" and e.type == sentence[k].type), None)
    return before is not None and bool(before.said) and bool(sentence[k].said) and not before.said & sentence[k].said


def _predicative(sentence: list[Element], k: int) -> bool:
    """Whether a phrase says what one of several is: "four bedrooms, one of which is a guest room"."""
    return k > 1 and sentence[k - 1].kind == "verb" and sentence[k - 2].kind == "pron" and sentence[k - 2].value == "one"


def _listed(sentence: list[Element], k: int, room: Named) -> bool:
    """Whether a phrase spells out a count in front of a colon or a bracket: "three bedrooms: a master, two for the kids"."""
    for j in range(k - 1, -1, -1):
        e = sentence[j]
        if e.kind in {"colon", "open"}:
            return any(room.id in x.ids and len(x.ids) > 1 for x in sentence[:j])
    return False


def _conjoined(sentence: list[Element], k: int) -> bool:
    """Whether the same kind of room was counted in the same list, so that this one comes on top."""
    kind = sentence[k].type
    for e in reversed(sentence[:k]):
        if e.kind in {"cue", "colon", "open", "verb", "comma"}:
            return False
        if e.kind == "np" and e.type == kind:
            return True
    return False


def _repeated(sentence: list[Element], k: int) -> bool:
    return any(e.kind == "np" and e.type == sentence[k].type for e in sentence[:k])


def _close(room: Named, role: str, surface: str, level: int | None = None) -> Named:
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
    same = stock.of(e.type)
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
        return [_close(r, role, e.text) for r in free[: e.part]]
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
    rest = [r for r in same if r.open_slot] or [r for r in same if r.id not in last] or same[-1:]
    many = e.plural or (e.number or 0) > 1
    if e.number is not None and e.type == "bedroom":
        rest = [r for r in rest if r.open_slot or r.id not in last]
        while len(rest) < e.number:
            rest.append(stock.add(e.type, role, e.text, level))
    return (rest if many else [_close(r, "", e.text) for r in rest[:1]]) or [stock.add(e.type, role, e.text, level)]


def fresh(state: Reading, e: Element, level: int | None, owner: str) -> list[str]:
    """Return a room that somebody has of their own: one that was only counted, or a new one."""
    role = e.role if e.role in ROLES else ""
    theirs = [r for r in state.inventory.of(e.type) if r.role == owner and e.type == "bedroom"]
    slots = theirs or [r for r in state.inventory.of(e.type) if r.open_slot and not r.role and (level is None or r.level in {None, level})]
    room = _close(slots[0], role, e.text) if slots else state.inventory.add(e.type, role, e.text, level)
    e.ids = [room.id]
    return e.ids


def _suites(state: Reading, sentence: list[Element], k: int, role: str, level: int | None) -> list[Named]:
    e, stock = sentence[k], state.inventory
    count = int(e.number or (2 if e.plural else 1))
    same = [r for r in stock.of("bedroom") if r.role == role] if role else []
    if same and not e.introduces:
        return same
    slots = [r for r in stock.of("bedroom") if r.open_slot and not r.role and (r.whole or e.definite or _listed(sentence, k, r))]
    made = [_close(r, role, e.text) for r in slots[:count]]
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
    if len(same) >= e.ordinal:
        rest = same if e.ordinal == 1 else [r for r in same if r.role != "primary"]
        loose = [r for r in rest if r.open_slot] or rest[-1:]
        return [_close(loose[0], role, e.text)] if loose else same[:1]
    if any(r.whole for r in same):
        state.say("beyond", tuple(r.id for r in same), (), e, float(e.ordinal))
        return same[-1:]
    while len(stock.of(e.type)) < e.ordinal - 1:
        stock.add(e.type, "", e.text, level, open_slot=True)
    return [stock.add(e.type, role, e.text, level)]


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
            return [_close(slots[0], role, e.text)]
        bare = state.heard.lexicon.language == "zh" and not e.det and e.number is None  # no articles there
        return [_close(plain[0], role, e.text)] if (e.definite or bare) and len(plain) == 1 else []
    if e.type != "bedroom":
        plain = [r for r in same if not r.role]
        return [_close(plain[0], role, e.text)] if plain and e.definite and not _repeated(sentence, k) else []
    slots = [
        r
        for r in same
        if r.open_slot
        and not r.role
        and (e.definite or r.whole or _listed(sentence, k, r) or not _conjoined(sentence, k))
        and not (r.extra and r.span is not None and r.span[0] > e.first)  # "the main bedroom ...; two more bedrooms"
        and ((e.definite and level is None) or r.level is None or r.level == level)  # counted on another storey: others
    ]
    if many and slots:
        count = int(e.number or len(slots))
        return [_close(r, role, e.text) for r in slots[:count]]
    if slots:
        return [_close(slots[0], role, e.text)]
    plain = [r for r in same if not r.role and not (r.extra and r.span is not None and r.span[0] > e.first)]
    if len(plain) == 1 and len(same) == 1 and e.definite and not many:
        return [_close(plain[0], role, e.text)]
    return []


def _known(state: Reading, sentence: list[Element], k: int, level: int | None) -> list[Named]:  # noqa: C901, PLR0911, PLR0912 - one branch per case: a grammar
    """Return the rooms that a phrase without role points at, where there are such rooms."""
    e, stock = sentence[k], state.inventory
    same = [r for r in stock.of(e.type) if not (r.extra and r.span is not None and r.span[0] > e.first)]
    if not e.plural and not e.number and e.type in {"bathroom", "bedroom"}:  # "... a bath; further a guest bath"
        same = [r for r in same if not (r.role in ROLES and r.span is not None and r.span[0] > e.last)]
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
        number = int(e.number or 0)
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
        and state.heard.lexicon.language != "zh"
        and all(stock.owned(r.id) or r.role == "ensuite" for r in same)
    ):
        return [stock.add(e.type, "", e.text, level)]  # "a master with en suite, ..., bathroom"
    if not e.det and (_repeated_bare(sentence, k) or (e.type == "storage" and all(e.text != r.surface for r in same))):
        return [stock.add(e.type, "", e.text, level)]
    if len(same) > 1:
        if e.number == 1 and (loose := [r for r in same if r.open_slot and not r.role]):
            return [_close(loose[0], "", e.text)]  # "one bedroom ..., the other ..."
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
                return not j or sentence[j - 1].kind not in {"cue", "enter", "det"}
        elif e.kind not in {"comma", "and", "amount", "open", "close"}:
            return False
    return False
