"""Reads the items of a prompt from left to right: which rooms there are, and what is said about them."""

from __future__ import annotations

from dataclasses import dataclass, field

from pipeline.floorplan.defaults import DEFAULTS
from pipeline.floorplan.language import items as kinds
from pipeline.floorplan.language import lexicon
from pipeline.floorplan.language.inventory import Inventory, Named
from pipeline.floorplan.language.items import Item
from pipeline.floorplan.language.tokens import Token

DEFINITE = {"the", "that", "this", "those", "these", "both", "all", "each", "every", "said", "its", "their", "same"}
MANY = {"both", "all", "each", "every", "those", "these"}
NEGATIONS = {"no", "without", "not", "never", "don't", "doesn't", "nor", "neither", "skip", "omit", "isn't"}
OWN = {"own", "private", "ensuite", "personal", "attached"}
OTHER = {"other", "remaining"}
NEEDLESS = ("needed", "necessary", "required", "wanted")
OPEN_ROOMS = {"kitchen", "dining_room", "living_room", "family_room"}
HALLS = {"hallway", "entry"}
ON_HALL = {"bedroom", "bathroom", "wc", "office", "closet", "storage", "utility", "playroom", "library", "media_room", "gym", "meeting_room"}
PERSONAL = {"bathroom", "wc", "closet", "balcony", "office", "storage"}


@dataclass(frozen=True, slots=True)
class Fact:
    """Something said: `what` about rooms `a` (and `b`), read from tokens[first:last]. `every` names groups filled in later."""

    what: str
    a: tuple[str, ...]
    b: tuple[str, ...] = ()
    value: float = 0.0
    first: int = 0
    last: int = 0


@dataclass
class Reading:
    """State while reading: rooms, facts, and what pronouns point at."""

    tokens: list[Token]
    inventory: Inventory = field(default_factory=Inventory)
    facts: list[Fact] = field(default_factory=list)
    banned: list[tuple[str, Item]] = field(default_factory=list)
    amounts: list[tuple[Item, tuple[str, ...] | None]] = field(default_factory=list)  # None: the whole home
    entrance: str | None = None
    home: Item | None = None
    studio: Item | None = None
    storeys: tuple[int, Item] | None = None
    level: int | None = None
    past: list[tuple[str, ...]] = field(default_factory=list)  # groups named in earlier sentences, the latest last
    owner: str = ""
    owning: str = ""  # the bedroom of the owner whose rooms are being listed
    used: set[int] = field(default_factory=set)

    def understood(self, item: Item) -> None:
        """Mark an item's words as understood."""
        self.used.update(range(item.first, item.last))

    def say(self, what: str, a: tuple[str, ...], b: tuple[str, ...], item: Item, value: float = 0.0) -> None:
        """Record a fact."""
        if a or b:
            self.facts.append(Fact(what, a, b, value, item.first, item.last))


def read(tokens: list[Token], parsed: list[list[Item]]) -> Reading:
    """Read all sentences."""
    state = Reading(tokens)
    for sentence in parsed:
        state.owner, state.owning = "", ""
        _mentions(state, sentence)
        _relations(state, sentence)
        state.past = _heard(state, sentence, len(sentence))
        state.level = state.level if any(i.kind == kinds.LEVEL and i.first == sentence[0].first for i in sentence) else None
    return state


# --- rooms -------------------------------------------------------------------------------------------------------------------


def _mentions(state: Reading, sentence: list[Item]) -> None:
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
        elif item.kind == kinds.PRONOUN and item.role == "group" and suites and item.words == "each":
            item.ids = list(suites)


def _storey(state: Reading, sentence: list[Item], k: int) -> None:
    """"Upstairs: two bedrooms" speaks of what follows, "two bedrooms upstairs" of what stands before."""
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
    """"Grandparents with their own bedroom, bathroom and kitchen": what follows the bedroom in the list is theirs too."""
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
    """A kitchenette in the one room of a studio is a function of that room, not a room."""
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


def _name(state: Reading, sentence: list[Item], k: int, suites: tuple[str, ...]) -> list[Named]:
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
    if not role and not ordinal and not item.mods and item.type not in PERSONAL and count == 1 and len(stock.of(item.type)) == 1 and not slots:
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


# --- relations ---------------------------------------------------------------------------------------------------------------


def _relations(state: Reading, sentence: list[Item]) -> None:
    """Read what the cues of a sentence say about the rooms around them."""
    subject: tuple[str, ...] = ()  # of the clause
    near: tuple[str, ...] = ()  # the latest group
    objects: tuple[str, ...] = ()  # of the latest cue
    index = 0
    while index < len(sentence):
        item = sentence[index]
        if item.kind == kinds.ENTER:
            group, index = _object_group(state, sentence, index + 1, wide=False)
            if group:
                state.entrance = group[0]
                near = subject = group
            continue
        if item.kind in {kinds.ROOM, kinds.PRONOUN, kinds.EVERY, kinds.HOME}:
            if item.kind == kinds.ROOM and item.role == "ensuite" and not item.ids and near:
                state.say("ensuite", near, (), item)
            if item.kind == kinds.HOME:
                near = ()
                index += 1
                continue
            group = _point(state, sentence, index, subject, near)
            if item.kind == kinds.ROOM or item.role in {"both", "one", "rest"} or item.kind == kinds.EVERY or not near:
                near = group
            if item.kind != kinds.PRONOUN or item.role != "it":
                objects = ()
            if not subject or item.role in {"group", "both", "one", "rest"}:
                subject = group
            elif item.words in {"that", "which"}:
                subject = near
            elif item.kind == kinds.PRONOUN and item.role == "it" and group:
                near = subject if not objects else near
        elif item.kind == kinds.AMOUNT:
            _amount(state, sentence, index, subject, near)
        elif item.kind == kinds.CUE:
            index, subject, near, objects = _cue(state, sentence, index, subject, near, objects)
            continue
        elif item.kind == kinds.MUTE and item.words in {"window to the outside", "windows to the outside"} and near:
            state.say("window", near, (), item)
        elif item.kind == kinds.WORD:
            _word(state, sentence, index, near)
        index += 1


def _heard(state: Reading, sentence: list[Item], k: int) -> list[tuple[str, ...]]:
    """Return the groups of rooms named before item k, the latest last."""
    return [*state.past, *(tuple(i.ids) for i in sentence[:k] if i.kind == kinds.ROOM and i.ids)]


def _word(state: Reading, sentence: list[Item], k: int, near: tuple[str, ...]) -> None:
    """Single words that say something about rooms: "daylight", "only", "open plan"."""
    word = sentence[k].words
    if word == "plan" and k and sentence[k - 1].words == "open":
        _open_plan(state, sentence, k)
    if word in {"daylight", "windows", "window"} and near:
        before = {i.words for i in sentence[max(0, k - 3) : k]}
        what = "no_window" if before & {"no", "without", "windowless"} else "window"
        state.say(what, near, (), sentence[k])
    if word == "only" and state.facts and state.facts[-1].what == lexicon.DOOR and near:
        state.say("only", state.facts[-1].a, (), sentence[k])


def _open_plan(state: Reading, sentence: list[Item], k: int) -> None:
    """"Open-plan kitchen/living/dining" joins the rooms of the list; "open-plan kitchen" is open to where one lives."""
    listed: list[str] = []
    for item in sentence[k + 1 :]:
        if item.kind == kinds.ROOM and item.type in OPEN_ROOMS:
            listed += item.ids
        elif item.kind not in {kinds.COMMA, kinds.AND, kinds.WORD} or item.words in {":", "with"}:
            break
    if len(listed) > 1:
        state.say("merge", tuple(dict.fromkeys(listed)), (), sentence[k])
    elif listed and state.inventory.get(listed[0]).type == "kitchen":
        state.say("open_kitchen", tuple(listed), (), sentence[k])


def _point(
    state: Reading, sentence: list[Item], k: int, subject: tuple[str, ...], near: tuple[str, ...]
) -> tuple[str, ...]:
    """Return the rooms that item k points at."""
    item = sentence[k]
    if item.kind == kinds.ROOM or item.ids:
        return tuple(item.ids)
    if item.kind == kinds.EVERY:
        return ("*" + item.type,)
    recent = _heard(state, sentence, k)
    if item.role == "it":
        return near or subject or (recent[-1] if recent else ())
    if item.role == "both":
        if near and len(near) == 2:
            return near
        return tuple(dict.fromkeys(i for g in recent[-2:] for i in g))
    if item.role in {"one", "rest"} and recent:
        plural = next((g for g in reversed(recent) if len(g) > 1), recent[-1])
        kind = state.inventory.get(plural[0]).type
        free = [r for r in state.inventory.of(kind) if r.open_slot]
        if item.role == "one":
            taken = free[:1]
            for room in taken:
                room.open_slot = False
            item.ids = [r.id for r in taken]
            return tuple(item.ids)
        return tuple(r.id for r in free)
    if item.role == "group":
        plural = next((g for g in reversed(recent) if len(g) > 1), None)
        return plural or near or subject
    return near


def _object_group(
    state: Reading, sentence: list[Item], start: int, wide: bool, subject: tuple[str, ...] = (), only: set[str] | None = None
) -> tuple[tuple[str, ...], int]:
    """Return the rooms named after a cue, and where reading goes on. `wide`: the whole list, commas included."""
    group: list[str] = []
    index = end = start
    comma = False
    while index < len(sentence):
        item = sentence[index]
        if item.kind == kinds.ROOM and item.ids:
            if group and not wide and comma:
                break
            if group and _starts_clause(sentence, index):
                break
            if only is not None and state.inventory.get(item.ids[0]).type not in only and not set(item.ids) <= set(subject):
                break
            if group and only is not None and comma and not (set(item.mods) & {"own", "its", "their", "a", "an", "private"}):
                break
            group += [i for i in item.ids if i not in group and i not in subject]
            comma = False
            end = index + 1
        elif item.kind == kinds.PRONOUN and not group:
            if item.role in {"each other"}:
                return ("<each other>",), index + 1
            # an object "it" points past the subject
            others = [g for g in _heard(state, sentence, index) if not set(g) & set(subject)]
            if item.role == "both":
                here = [tuple(i.ids) for i in sentence[:index] if i.kind == kinds.ROOM and not set(i.ids) & set(subject)]
                flat = list(dict.fromkeys(i for g in (here if len(here) > 1 else others) for i in g))
                group = _last_two(state, flat, subject)
            elif item.role == "it" and others:
                group = list(others[-1])
            end = index + 1
            break
        elif item.kind == kinds.EVERY and not group:
            return ("*" + item.type,), index + 1
        elif item.kind == kinds.COMMA:
            if item.words in {":", ")"} or (item.words == "(" and group):
                break
            comma = True
        elif item.kind == kinds.AND:
            comma = comma and wide
        elif item.kind == kinds.CUE or item.kind in {kinds.ENTER, kinds.HOME, kinds.LEVEL}:
            if group or item.cue not in {lexicon.BETWEEN, lexicon.HAS}:
                break
        elif item.kind == kinds.AMOUNT:
            if only is None and (group or item.unit in {"area", "length"}):
                break
            _amount(state, sentence, index, subject, subject)
        elif item.kind == kinds.MUTE and group and comma:
            break
        index += 1
    return tuple(group), end


def _last_two(state: Reading, flat: list[str], subject: tuple[str, ...]) -> list[str]:
    kinds_seen = {state.inventory.get(i).type for i in subject}
    rest = [i for i in flat if state.inventory.get(i).type not in kinds_seen]
    return rest[-2:]


def _starts_clause(sentence: list[Item], k: int) -> bool:
    """Whether the room at k, after a comma, is the subject of a cue of its own."""
    back = k - 1
    while back >= 0 and sentence[back].kind in {kinds.WORD, kinds.AND}:
        back -= 1
    if back < 0 or sentence[back].kind != kinds.COMMA:
        strong = k > 0 and any(i.kind == kinds.AND for i in sentence[max(0, k - 3) : k])
        if not strong:
            return False
    for item in sentence[k + 1 :]:
        if item.kind == kinds.WORD or item.kind == kinds.MUTE:
            continue
        verb = item.kind == kinds.CUE and item.cue not in {lexicon.HAS} and item.words not in {"on", "around", "along", "by", "near"}
        return verb and back >= 0 and sentence[back].kind == kinds.COMMA
    return False


def _cue(
    state: Reading, sentence: list[Item], k: int, subject: tuple[str, ...], near: tuple[str, ...], objects: tuple[str, ...]
) -> tuple[int, tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    """Read one cue; return where to go on, and the new subject, latest group and objects."""
    item = sentence[k]
    cue = item.cue
    unchanged = (k + 1, subject, near, objects)
    if k + 1 < len(sentence) and sentence[k + 1].kind == kinds.COMMA and sentence[k + 1].words != ":":
        return unchanged
    if cue == lexicon.HAS or item.words in {"on", "along", "around", "by", "near", "connects", "serves"}:
        ahead = next((i for i in sentence[k + 1 : k + 8] if i.kind not in {kinds.WORD}), None)
        if ahead is None or ahead.kind not in {kinds.ROOM, kinds.PRONOUN} or not (ahead.ids or ahead.kind == kinds.PRONOUN):
            if not (cue == lexicon.HAS and ahead is not None and ahead.kind == kinds.AMOUNT):
                return unchanged
            return unchanged
        if item.words in {"on", "along", "around"} and state.inventory.get(ahead.ids[0]).type not in HALLS if ahead.ids else False:
            return unchanged
    negative = any(i.words in {"not", "n't", "never", "shouldn't", "mustn't", "don't"} for i in sentence[max(0, k - 3) : k])
    chain = item.words in {"on to", "through to"}
    if not near and not subject and objects == ():
        subject = next(reversed(_heard(state, sentence, k)), ()) if cue != lexicon.HAS else ()
        near = subject
    source = objects if chain and objects else (subject if objects and not chain else (near or subject))
    if cue == lexicon.HAS:
        return _has(state, sentence, k, source, subject, near)
    wide = cue in {lexicon.LEADS, lexicon.OPEN, lexicon.BETWEEN}
    if cue == lexicon.DOOR and item.words in {"connects to", "connected to", "connected with", "with access to", "has access to", "linked to"}:
        wide = True
    if cue == lexicon.THROUGH:
        return _through(state, sentence, k, subject, near, objects)
    group, end = _object_group(state, sentence, k + 1, wide, subject=source)
    if not group:
        if cue == lexicon.OPEN and len(subject) + len(near) > 1:
            return unchanged
        return unchanged
    state.understood(item)
    halls = [i for i in group if not i.startswith(("*", "<")) and state.inventory.get(i).type in HALLS]
    if cue == lexicon.DOOR and halls and not objects and source and not source[0].startswith("*"):
        listed = _conjuncts(state, sentence, k)
        source = tuple(i for i in listed if state.inventory.get(i).type in ON_HALL and i not in halls) or source
    if group == ("<each other>",):
        listed = _conjuncts(state, sentence, k) or tuple(dict.fromkeys(subject + near))
        state.say("merge" if cue == lexicon.OPEN else cue, listed, (), item)
        return end, subject, near, ()
    if cue == lexicon.AWAY and source:
        state.say("away", source, group, item, 0.35)
    elif cue in {lexicon.NEAR, lexicon.WALL} and negative:
        state.say(lexicon.BAN, source, group, item)
    elif negative and cue in {lexicon.OPEN, lexicon.DOOR, lexicon.LEADS}:
        state.say("not_open" if cue == lexicon.OPEN else "not_connected", source, group, item)
    else:
        nook = cue == lexicon.DOOR and _before(sentence, k, {"nook", "alcove", "niche"})
        state.say("open" if nook else cue, source, group, item)
    only = "only" in item.words.split() or (end < len(sentence) and sentence[end].words == "only") or _before(sentence, k, {"only"}, 2)
    if only and cue == lexicon.DOOR:
        state.say("only", source, (), item)
    return end, source, source, group


def _before(sentence: list[Item], k: int, words: set[str], reach: int = 5) -> bool:
    return any(i.words in words for i in sentence[max(0, k - reach) : k])


def _conjuncts(state: Reading, sentence: list[Item], k: int) -> tuple[str, ...]:
    """Return the rooms of the list that ends just before item k."""
    group: list[str] = []
    for item in reversed(sentence[:k]):
        if item.kind == kinds.ROOM:
            group = [*item.ids, *group]
        elif item.kind in {kinds.CUE, kinds.HOME, kinds.ENTER, kinds.LEVEL} or (item.kind == kinds.COMMA and item.words in {":", "("}):
            if item.kind == kinds.CUE and item.cue == lexicon.HAS and group:
                break
            if group or item.kind != kinds.CUE:
                break
        elif item.kind == kinds.PRONOUN and item.role in {"both", "rest", "one"}:
            return tuple(group) or _point(state, sentence, sentence.index(item), (), ())
    return tuple(dict.fromkeys(group))


def _has(
    state: Reading, sentence: list[Item], k: int, source: tuple[str, ...], subject: tuple[str, ...], near: tuple[str, ...]
) -> tuple[int, tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    """"X with its own bathroom": rooms that belong to a room hang on it."""
    item = sentence[k]
    before = next((i for i in reversed(sentence[:k]) if i.kind in {kinds.ROOM, kinds.HOME, kinds.PRONOUN}), None)
    if before is not None and before.kind == kinds.HOME:
        return k + 1, subject, near, ()
    source = near or source or subject
    named = [i for i in source if not i.startswith("*")]
    owner = [i for i in named if state.inventory.get(i).type == "bedroom"]
    if not owner:
        living = [i for i in named if state.inventory.get(i).type in {"living_room", "kitchen", "dining_room", "studio_room", "office"}]
        if living and item.words in {"with", "has", "having"}:
            extra = {"balcony", "sunroom", "storage"}
            group, end = _object_group(state, sentence, k + 1, wide=False, subject=source, only=extra)
            if group and len(living) == 1:
                state.understood(item)
                state.say(lexicon.DOOR, group, tuple(living), item)
                return end, subject, tuple(living), ()
        return k + 1, subject, near, ()
    group, end = _object_group(state, sentence, k + 1, wide=True, subject=tuple(named), only=PERSONAL)
    if not group:
        return k + 1, subject, near, ()
    state.understood(item)
    for kind in dict.fromkeys(state.inventory.get(i).type for i in group):
        things = tuple(i for i in group if state.inventory.get(i).type == kind)
        state.say("own", things, tuple(owner), item)
    return end, tuple(owner), group, group


def _through(
    state: Reading, sentence: list[Item], k: int, subject: tuple[str, ...], near: tuple[str, ...], objects: tuple[str, ...]
) -> tuple[int, tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    group, end = _object_group(state, sentence, k + 1, wide=False)
    listed = subject
    rooms = [i for i in sentence[:k] if i.kind == kinds.ROOM]
    if not objects and rooms:
        listed = _conjuncts(state, sentence, k)
        listed = tuple(i for i in listed if i not in group) or subject
    if group and listed:
        state.understood(sentence[k])
        state.say(lexicon.THROUGH, listed, group, sentence[k])
    return end, subject, subject, objects


def _amount(state: Reading, sentence: list[Item], k: int, subject: tuple[str, ...], near: tuple[str, ...]) -> None:
    """Attach an amount to what it measures: the room beside it, or the home."""
    item = sentence[k]
    state.understood(item)
    if item.unit == "storeys":
        if item.number and 1 <= item.number:
            state.storeys = state.storeys or (int(item.number), item)
        return
    before = [i for i in sentence[:k] if i.kind in {kinds.ROOM, kinds.HOME}]
    latest = before[-1] if before else None
    words = [i.words for i in sentence[max(0, k - 3) : k + 3] if i.kind == kinds.WORD] + item.words.split()
    if set(words) & {"total", "altogether", "overall", "totalling"} or (words[:2] == ["in", "all"]):
        state.amounts.append((item, None))
        return
    if latest is not None and latest.kind == kinds.ROOM and latest.ids:
        target = tuple(latest.ids)
        # "a balcony off the living room (6 m2)" measures the balcony
        if set(latest.mods) & {"the", "that"} and subject and target[0] not in subject and item.unit == "area":
            target = tuple(i for i in (near or subject) if not i.startswith("*"))
        loose = sentence[k - 1].kind == kinds.COMMA and sentence[k - 1].words == "," and latest.first >= sentence[k - 1].first - 4
        usual = sum(DEFAULTS[state.inventory.get(i).type].area for i in target)
        whole = state.home is not None and loose and item.unit == "area" and (item.number or 0.0) > 2.5 * usual
        state.amounts.append((item, None if whole else target))
        return
    after = next((i for i in sentence[k + 1 :] if i.kind not in {kinds.WORD}), None)
    if latest is None and after is not None and after.kind == kinds.ROOM and after.ids:
        state.amounts.append((item, tuple(after.ids)))
    else:
        state.amounts.append((item, None))
