"""Which rooms the phrases of a sentence name: new ones, and those that were named before."""

from __future__ import annotations

from pipeline.floorplan.language import items as kinds
from pipeline.floorplan.language import lexicon
from pipeline.floorplan.language.facts import PERSONAL, Reading
from pipeline.floorplan.language.inventory import Named
from pipeline.floorplan.language.items import Item

DEFINITE = {"the", "that", "this", "those", "these", "both", "all", "each", "every", "said", "its", "their", "same"}
MANY = {"both", "all", "each", "every", "those", "these"}
NEGATIONS = {"no", "without", "not", "never", "don't", "doesn't", "nor", "neither", "skip", "omit", "isn't"}
OWN = {"own", "private", "ensuite", "personal", "attached"}
OTHER = {"other", "remaining"}
NEEDLESS = ("needed", "necessary", "required", "wanted")


def mentions(state: Reading, sentence: list[Item]) -> None:
    """Find out which rooms each phrase of the sentence names; make those that are new."""
    suites: tuple[str, ...] = ()  # suites that "each has a bedroom" speaks of
    has = False
    for k, item in enumerate(sentence):
        if item.kind == kinds.LEVEL:
            _storey(state, sentence, k)
        elif item.kind == kinds.WORD and item.words in lexicon.OWNERS:
            state.owner, state.owning = item.words, ""
        elif item.kind == kinds.CUE:
            has = item.cue == lexicon.HAS or (has and item.words == "and")
        elif item.kind in {kinds.HOME, kinds.MUTE, kinds.ENTER}:
            state.understood(item)
            if item.kind == kinds.HOME:
                state.home = state.home or item
                state.studio = state.studio or (item if item.type else None)
        elif item.kind == kinds.EVERY and item.type:
            item.ids = [r.id for r in state.inventory.of(item.type)]
            state.understood(item)
        elif item.kind in {kinds.ROOM, kinds.SUITE}:
            item.mods = _mods(sentence, k)
            state.understood(item)
            if _negated(state, sentence, k):
                state.banned.append((item.type, item))
                item.kind = kinds.MUTE
                continue
            if _functional(state, sentence, k):
                continue
            item.ids = [r.id for r in _name(state, sentence, k, suites if has or item.type == "bedroom" else ())]
            if item.kind == kinds.SUITE:
                suites = tuple(item.ids)
                state.say("suite", tuple(item.ids), (), item)
                item.kind = kinds.ROOM
            _adjectives(state, item)
            _belongings(state, item)
        elif item.kind == kinds.PRONOUN and item.words in {"each", "each of them"}:
            beds = [i.ids for i in sentence[:k] if i.kind == kinds.ROOM and i.type == "bedroom" and len(i.ids) > 1]
            suites = suites or (tuple(beds[-1]) if beds else ())
            item.ids = list(suites)


def _storey(state: Reading, sentence: list[Item], k: int) -> None:
    """Read "Upstairs: two bedrooms" speaks of what follows, "two bedrooms upstairs" of what stands before."""
    item = sentence[k]
    state.understood(item)
    following = sentence[k + 1] if k + 1 < len(sentence) else None
    ends = following is None or following.kind in {kinds.AND, kinds.CUE} or (following.kind == kinds.COMMA and following.words == ",")
    if k == 0 or not ends:
        state.level = item.level
        return
    for earlier in reversed(sentence[:k]):
        if earlier.kind == kinds.LEVEL:
            break
        if earlier.kind == kinds.ROOM:
            for room in (state.inventory.get(i) for i in earlier.ids):
                room.level = item.level


def _belongings(state: Reading, item: Item) -> None:
    """Read "Grandparents with their own bedroom, bathroom and kitchen": what follows the bedroom in the list is theirs too."""
    if len(item.ids) != 1 or not state.owner:
        return
    room = state.inventory.get(item.ids[0])
    if room.type == "bedroom" and set(item.mods) & {"own"}:
        state.owning = room.id
    elif state.owning and room.type == "bathroom" and not room.role:
        state.say("own", (room.id,), (state.owning,), item)
    elif state.owning and room.type == "kitchen":
        room.role = state.inventory.get(state.owning).role
        state.say("door", (room.id,), (state.owning,), item)


def _mods(sentence: list[Item], k: int) -> list[str]:
    words: list[str] = []
    for item in reversed(sentence[:k]):
        if item.kind == kinds.WORD:
            words.insert(0, item.words)
        elif item.kind == kinds.PRONOUN and item.words in {"that", "both", "each", "one", "these", "all of them"}:
            words.insert(0, item.words)
            if item.words in {"both", "each", "that", "one"} and item.last == _next_first(sentence, item):
                item.kind = kinds.WORD
        elif item.kind == kinds.AMOUNT and item.unit == "rooms":
            continue
        else:
            break
        if len(words) == 6:
            break
    return words


def _next_first(sentence: list[Item], item: Item) -> int:
    later = [i.first for i in sentence if i.first >= item.last]
    return min(later, default=-1)


def _negated(state: Reading, sentence: list[Item], k: int) -> bool:
    item = sentence[k]
    after = [i.words for i in sentence[k + 1 : k + 5] if i.kind in {kinds.WORD, kinds.MUTE}]
    following = sentence[k + 1] if k + 1 < len(sentence) else None
    if set(item.mods) & NEGATIONS:
        limit = any(w in {"narrower", "smaller", "less", "wider", "longer"} for w in after[:2]) or (
            following is not None and following.kind == kinds.AMOUNT
        )
        return not limit
    # "a balcony is not needed"
    if "not" in after[:2] and any(w in NEEDLESS for w in after[:4]):
        return True
    # a list under one negation: "no balcony, garage or cellar"
    for before in range(k - 1, -1, -1):
        earlier = sentence[before]
        if earlier.kind == kinds.AND and earlier.words == "or":
            continue
        if earlier.kind == kinds.COMMA and any(i.kind == kinds.AND and i.words == "or" for i in sentence[k:] + sentence[before:k]):
            continue
        if earlier.kind == kinds.WORD and earlier.words in {"a", "an", "any"}:
            continue
        return earlier.kind == kinds.MUTE and any(b is earlier for _, b in state.banned) and not item.mods
    return False


def _functional(state: Reading, sentence: list[Item], k: int) -> bool:
    """Tell whether a phrase names a function of a room, as a kitchenette in the one room of a studio does."""
    item = sentence[k]
    surface = " ".join(t.text for t in state.tokens[item.first : item.last])
    mains = state.inventory.of("studio_room")
    before = sentence[k - 1] if k else None
    back = [i for i in sentence[:k] if i.kind in {kinds.CUE, kinds.ROOM}]
    joined = bool(back) and back[-1].kind == kinds.CUE and back[-1].cue == lexicon.HAS
    if item.type == "kitchen" and surface.startswith("kitchenette") and mains and joined:
        mains[0].functions.add("cooking")
        item.kind = kinds.MUTE
        return True
    if surface in {"dining area", "eating area", "dining space"} and joined and before is not None:
        kitchen = state.inventory.of("kitchen")
        if kitchen and back[-2:-1] and back[-2].type == "kitchen":
            kitchen[0].functions.add("dining")
            item.kind = kinds.MUTE
            return True
    return False


def _count(item: Item) -> tuple[int | None, int]:
    """Return (number of rooms, ordinal) that the words in front say."""
    number, ordinal = None, 0
    for word in item.mods:
        if word in lexicon.ORDINALS:
            ordinal = lexicon.ORDINALS[word]
        elif word.isdigit():
            number = int(word)
        elif word in lexicon.NUMBERS and word not in {"half", "single", "double", "twin", "dozen", "couple"}:
            number = int(lexicon.NUMBERS[word])
        elif word in {"another", "single"}:
            number = 1
    return number, ordinal


def _name(  # noqa: C901, PLR0911, PLR0912 - one branch per way to name a room: a grammar
    state: Reading, sentence: list[Item], k: int, suites: tuple[str, ...]
) -> list[Named]:
    """Return the rooms that the phrase k names."""
    item, stock = sentence[k], state.inventory
    number, ordinal = _count(item)
    roles = [lexicon.ADJECTIVES[w] for w in item.mods if w in lexicon.ADJECTIVES]
    role = item.role if item.role not in {"landing", "ensuite", "shared"} else ""
    if item.type in {"bedroom", "office"} and roles:
        role = role or roles[-1]
    surface = " ".join(t.text for t in state.tokens[item.first : item.last])
    level = 1 if item.role == "landing" else state.level
    # what follows a room's name as its own bathroom or kitchen is told apart by the owner
    if item.type in {"bedroom", "kitchen", "bathroom"} and not role and state.owner and set(item.mods) & {"own"}:
        role = lexicon.OWNERS[state.owner] if item.type != "bathroom" else role
    if item.type == "kitchen" and roles == ["primary"]:
        role = "primary"
    definite = bool(set(item.mods) & DEFINITE) and not (set(item.mods) & OWN)
    many = item.plural or bool(set(item.mods) & MANY)
    other = bool(set(item.mods) & OTHER)
    following = sentence[k + 1] if k + 1 < len(sentence) else None
    compound = (following is not None and following.kind == kinds.HOME) or (
        number is not None and item.type == "bedroom" and following is not None and following.kind == kinds.WORD
        and len(sentence) > k + 2 and sentence[k + 2].kind == kinds.HOME
    )  # fmt: skip
    if suites and item.type == "bedroom" and not role and ordinal == 0:
        return [stock.get(i) for i in suites]
    if compound and item.type in {"bedroom", "bathroom"}:
        return [stock.add(item.type, "", surface, None, open_slot=True) for _ in range(number or 1)]
    if item.role == "ensuite" and _predicate(sentence, k):
        return []
    if item.role == "ensuite" and definite:
        old = [r for r in stock.of("bathroom") if "suite" in r.surface]
        if old:
            return old[:1]
    if suites and item.type in {"bathroom", "closet"} and (set(item.mods) & OWN) and not item.plural:
        return [stock.specialise(item.type, "", surface) or stock.add(item.type, "", surface, level) for _ in suites]
    if definite and not (number == 1 and not set(item.mods) & {"the", "that", "this"}):
        found = stock.refer(item.type, role, surface, many or (number or 0) > 1, other, ordinal, state.level)
        last = surface.split()[-1]
        if item.type == "hallway" and not any(last in r.surface.split() for r in found):
            found = [r for r in stock.of("entry") if last in r.surface.split()] or found
        if not found and item.type == "hallway":
            found = stock.refer("entry", "", surface, False, False, 0, state.level)
        if not found and role == "primary" and "the" in item.mods and item.type == "bedroom" and not many:
            made = stock.specialise(item.type, role, surface)
            return [made] if made else [stock.add(item.type, role, surface, level)]
        if found:
            if number and number > 1 and len(found) > number:
                found = found[:number]
            for room in found:
                if role and not room.role:
                    room.role = role
            if len(found) == 1 and (role or ordinal):
                found[0].open_slot = False
            return found
    return _new(state, item, role, surface, number, ordinal, level)


def _new(state: Reading, item: Item, role: str, surface: str, number: int | None, ordinal: int, level: int | None) -> list[Named]:
    stock = state.inventory
    slots = [r for r in stock.of(item.type) if r.open_slot]
    count = number or (2 if item.plural and item.type not in {"staircase", "closet", "storage"} else 1)
    if not role and number is not None and number > 1 and len(slots) == number == len(stock.of(item.type)):
        return slots  # "two-bedroom flat ... two bedrooms"
    if role and number is None and not item.plural:
        same = [r for r in stock.of(item.type) if r.role == role]
        if same and not (set(item.mods) & {"another", "a", "an"}):
            return same[:1]
    if ordinal > 1 and not role and item.type == "bedroom":
        rest = [r for r in stock.of("bedroom") if r.role != "primary"]
        if len(stock.of("bedroom")) >= ordinal and rest:
            rest[0].open_slot = False
            return rest[:1]
    if item.type in {"hallway", "staircase"} and stock.of(item.type) and not (ordinal > 1 or {"another", "own"} & set(item.mods)):
        return stock.refer(item.type, "", surface, False, False, 0, level) or stock.of(item.type)[:1]
    if (
        not role
        and not ordinal
        and not item.mods
        and item.type not in PERSONAL
        and count == 1
        and len(stock.of(item.type)) == 1
        and not slots
    ):
        return stock.of(item.type)  # a bare name: "dining next to both"
    made: list[Named] = []
    for _ in range(count):
        fresh = "another" in item.mods or (count > 1 and not role) or len(made) >= len(slots)
        taken = None if fresh else stock.specialise(item.type, role, surface)
        made.append(taken or stock.add(item.type, role, surface, level, open_slot=count > 1))
    if item.role == "shared":
        for room in made:
            room.role = room.role or "shared"
    return made


def _predicate(sentence: list[Item], k: int) -> bool:
    """Whether "en suite" says something about the bathroom named just before it."""
    return k > 0 and sentence[k - 1].kind in {kinds.ROOM, kinds.PRONOUN} and not sentence[k].mods


def _adjectives(state: Reading, item: Item) -> None:
    """Sizes and kinds in the words in front: "a very large living room", "an eat-in kitchen"."""
    text = " ".join(item.mods)
    for words, factor in lexicon.BIG.items():
        if f" {words} " in f" {text} ":
            for i in item.ids:
                state.inventory.get(i).size = factor
            break
    if {"largest", "biggest"} & set(item.mods) and item.ids:
        others = tuple(r.id for r in state.inventory.of(item.type))
        state.say("largest", tuple(item.ids), others, item)
    if "smaller" in item.mods and item.ids:
        rest = tuple(r.id for r in state.inventory.of(item.type) if r.id not in item.ids)
        state.say("area_order", rest[:1], tuple(item.ids), item, 1.0)
    if {"similar", "equal", "identical"} & set(item.mods) and len(item.ids) > 1:
        state.say("area_equal", tuple(item.ids), (), item, 0.15)
    if {"open"} & set(item.mods) and item.type == "kitchen":
        state.say("open_kitchen", tuple(item.ids), (), item)
