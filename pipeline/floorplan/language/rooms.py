"""The rooms of a prompt and the facts about them, and which rooms phrases name: those that numbers and articles introduce, and those named before."""

import itertools
from dataclasses import dataclass, field

from pipeline.errors import RefusedError
from pipeline.floorplan.language.phrases import ROLES, backward, heads
from pipeline.floorplan.language.tokens import Token, Words
from pipeline.floorplan.program.consistency import ImpossibleError
from pipeline.floorplan.program.floor_program import MAX_ROOMS

SHORT = {"bedroom": "bed", "bathroom": "bath", "hallway": "hall", "staircase": "stairs"}  # ids of rooms that are not called as their type
HALLS = {"hallway", "entry"}
SOCIAL = {"kitchen", "dining_room", "living_room", "family_room"}
PERSONAL = {"bathroom", "wc", "closet", "balcony", "office", "storage", "sunroom"}  # what a bedroom may have of its own
PRIVATE = {"balcony", "garage", "bathroom", "wc", "closet", "storage", "utility", "bedroom"}  # nothing stands open to these
ZONES = {"bedroom": ("bedroom",), "living": ("living_room", "dining_room", "family_room"), "work": ("office", "meeting_room")}
FRONT = {"door", "near", "open", "wall", "from", "ensuite", "cmp", "via"}  # relations to one room, behind which a list begins anew
GROUPS = {"door", "leads", "open", "near", "wall", "ban", "avoid", "away", "no_through"}  # may be said of all rooms
ALONE = {"living_room", "kitchen", "dining_room", "hallway", "entry", "utility", "garage", "staircase", "family_room", "studio_room"}
PLURAL_NAMES = {"staircase", "closet", "storage", "hallway"}  # their plural often means one
THEIRS = {"child", "guest", "elder", "staff", "carer"}  # who has a room of another name than just a bedroom


@dataclass(slots=True)
class Named:
    """A room of the prompt. `open_slot`: one of several that were only counted, to be told apart by later words."""

    id: str
    type: str
    role: str = ""
    surface: str = ""
    open_slot: bool = False
    whole: bool = False  # one of a count of all such rooms: "a two-bedroom flat"
    extra: bool = False  # "another bathroom": none of those named in front
    index: int = 0
    stated: bool = True
    span: tuple[int, int] | None = None  # the words that named it first
    level: int | None = None
    low: float | None = None
    high: float | None = None
    target: float | None = None
    size: float = 1.0
    functions: set[str] = field(default_factory=set)
    exterior_length: float | None = None
    window: str = "auto"
    min_width: float | None = None


class Inventory:
    """All rooms so far, in the order of their first mention."""

    def __init__(self) -> None:
        self.rooms: list[Named] = []
        self.belongings: set[str] = set()

    def of(self, kind: str) -> list[Named]:
        """Return the rooms of a type."""
        return [r for r in self.rooms if r.type == kind]

    def get(self, room_id: str) -> Named:
        """Return the room of an id."""
        return next(r for r in self.rooms if r.id == room_id)

    def add(self, kind: str, role: str, surface: str, level: int | None, open_slot: bool = False) -> Named:
        """Add a room."""
        if len(self.rooms) > MAX_ROOMS:
            raise RefusedError(f"more than {MAX_ROOMS} rooms are asked for", f"ask for {MAX_ROOMS} at most")
        base, known = SHORT.get(kind, kind.removesuffix("_room")), {r.id for r in self.rooms}
        names = (base if n == 1 else f"{base}_{n}" for n in itertools.count(len(self.of(kind)) + 1))
        room = Named(next(n for n in names if n not in known), kind, role, surface, open_slot, level=level)
        self.rooms.append(room)
        return room

    def zone(self, name: str) -> list[str]:
        """Return the rooms that the name of a zone means."""
        return [r.id for r in self.rooms if r.type in ZONES.get(name, ()) or (r.type == "bedroom" and r.role == name)]


Group = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Fact:
    """Something said: `what` about rooms `a` (and `b`), read from words[first:last]."""

    what: str
    a: Group
    b: Group = ()
    value: float = 0.0
    first: int = 0
    last: int = 0


@dataclass
class Reading:
    """State while reading."""

    words: Words
    inventory: Inventory = field(default_factory=Inventory)
    facts: list[Fact] = field(default_factory=list)
    banned: list[tuple[str, Token]] = field(default_factory=list)
    amounts: list[tuple[Token, Group | None]] = field(default_factory=list)  # None: the whole home
    flags: dict[str, Token] = field(default_factory=dict)
    looks: list[Token] = field(default_factory=list)
    levels: list[Token] = field(default_factory=list)  # words for storeys
    zones: dict[str, tuple[Group, Token]] = field(default_factory=dict)
    wings: tuple[str, ...] = ()  # zones that lie in parts of their own
    heights: dict[str, int] = field(default_factory=dict)  # the storey of zones, and of all other rooms ("*")
    entrance: tuple[str, Token] | None = None
    outside: tuple[str, Token] | None = None  # the owner of a door of its own
    homes: list[Token] = field(default_factory=list)
    studio: Token | None = None
    storeys: tuple[int, Token] | None = None
    rooms: tuple[int, Token] | None = None  # "a three-room flat"
    people: Token | None = None  # how many live there
    parted: str = ""  # of which type of room one was spoken of apart
    topic: Group = ()  # what the last sentence was about
    past: list[Group] = field(default_factory=list)  # groups named in earlier sentences, the latest last
    used: set[int] = field(default_factory=set)

    def understood(self, first: int, last: int) -> None:
        """Token words as understood."""
        self.used.update(range(first, last))

    def say(self, what: str, a: Group, b: Group, element: Token, value: float = 0.0) -> None:
        """Record a fact. Whole groups ("*...") mean something to few kinds of fact only."""
        if what not in GROUPS:
            a, b = (tuple(i for i in g if not i.startswith("*")) for g in (a, b))
        a, b = (("*",) if "*" in g else g for g in (a, b))  # "all rooms are off the hall: kitchen, bath ..."
        if what in {"except", "only"}:
            self.understood(element.first, element.last)
        if a or b:
            self.facts.append(Fact(what, tuple(dict.fromkeys(a)), tuple(dict.fromkeys(b)), value, element.first, element.last))


def _many(e: Token) -> bool:
    return e.plural or bool(e.det & {"all", "both", "each"}) or e.number > 1


def _word(e: Token) -> str:
    return e.text.rsplit(maxsplit=1)[-1]


def close(room: Named, role: str, surface: str, level: int | None = None) -> Named:
    """Take a room that was only counted: its role, name and storey are known now."""
    room.open_slot = False
    room.role = room.role or role
    room.surface = surface
    room.level = room.level if room.level is not None else level
    return room


def _is_spelt_out(sentence: list[Token], k: int, room: Named) -> bool:
    """Whether a phrase spells out a count in front of a colon or a bracket: "three bedrooms: a master, two for the kids"."""
    j = next((j for j in range(k - 1, -1, -1) if sentence[j].kind in {"colon", "open"}), 0)
    return any(room.id in x.ids and len(x.ids) > 1 for x in sentence[:j])


def _before(sentence: list[Token], k: int, *breaks: str) -> Token | None:
    """Return the phrase of the same type in front of k, with none of the kinds that break a list between."""
    for e in reversed(sentence[:k]):
        if e.kind in breaks:
            return None
        if e.kind == "np" and e.type == sentence[k].type:
            return e
    return None


def _is_listed_again(sentence: list[Token], k: int) -> bool:
    """Whether a bare noun is the next item of a list that has it already: "bedroom 12 m2, bedroom 10 m2" are two; those of a role by their sizes."""
    first, here = _before(sentence, k, "cue", "colon", "verb"), sentence[k]
    items = [here] if first is None else [first, here]
    bare = not any(e.det or e.number or e.plural or (e.role and not e.amounts) for e in items)
    ends = k + 1 == len(sentence) or sentence[k + 1].kind not in {"cue", "verb"}  # of "..., bathroom next to it" it is the subject
    if any(a.kind == "cmp" and b is first for a, b in itertools.pairwise(sentence)):
        return False  # "卧室要比书房大,书房里放..."
    return first is not None and bare and ends and here.type not in ALONE and sentence[k - 1].kind in {"comma", "join"}


def named_rooms(group: Group) -> Group:
    """Return the rooms of a group, without "all rooms" and zones."""
    return tuple(i for i in group if not i.startswith("*"))


def name(state: Reading, sentence: list[Token], k: int, level: int | None) -> Group:
    """Return the ids of the rooms that the phrase k names; make those that are missing."""
    e, stock = sentence[k], state.inventory
    e.ids = e.ids or tuple(r.id for r in _resolve_phrase(state, sentence, k, level))
    for room in (stock.get(i) for i in e.ids):
        room.span = room.span or (e.first, e.last)
        room.functions |= e.functions
        room.size = e.size if e.size != 1.0 else room.size
    return e.ids


def _resolve_phrase(state: Reading, sentence: list[Token], k: int, level: int | None) -> list[Named]:  # noqa: PLR0911 - one answer per kind of phrase
    e, stock, role = sentence[k], state.inventory, sentence[k].role
    same = stock.of(e.type)
    suites = next((x.ids for x in reversed(sentence[:k]) if x.suite and x.ids), ()) if e.type == "bedroom" and not role else ()
    if suites and not e.ordinal and not e.number:
        return [stock.get(i) for i in suites]
    halls = [r for r in stock.rooms if r.type in {"hallway", "entry"} and _word(e) in r.surface.split()]
    if e.type == "hallway" and e.definite and halls:
        return halls[:1]
    if e.part:
        state.parted = e.type
        _fill(state, e, max(int(e.number), e.part))
        same = stock.of(e.type)
        return [close(r, role, e.text) for r in ([r for r in same if r.open_slot] or same)[: e.part]]
    if e.index:
        free = [r for r in same if not r.index and r.open_slot]
        room = next((r for r in same if r.index == e.index), None) or (free[0] if free else stock.add(e.type, role, e.text, level))
        room.index, room.open_slot = e.index, False
        return [room]
    if e.ordinal:
        return _ordinal(state, e, role, level)
    if "other" in e.det:
        return _others(state, sentence, k, role, level)
    known = same and not _is_listed_again(sentence, k)
    rooms = (_by_role if role else _known_rooms)(state, sentence, k, level) if known or (role and not same) else []
    return rooms or _new(state, e, int(e.number or (2 if "both" in e.det or (e.plural and e.type not in PLURAL_NAMES) else 1)), role, level)


def _new(state: Reading, e: Token, count: int, role: str, level: int | None) -> list[Named]:
    return [state.inventory.add(e.type, role, e.text, level, open_slot=count > 1) for _ in range(count)]


def _fill(state: Reading, e: Token, count: int) -> None:
    """Add rooms of a phrase's type that nothing is said of yet until there are so many."""
    while len(state.inventory.of(e.type)) < count:
        state.inventory.add(e.type, "", e.text, None, open_slot=True)


def _others(state: Reading, sentence: list[Token], k: int, role: str, level: int | None) -> list[Named]:
    """Return "the other two bedrooms": those that nothing was said of, new ones where they are too few."""
    e, same = sentence[k], state.inventory.of(sentence[k].type)
    mentioned = {i for g in state.past[-1:] for i in g} | {i for x in sentence[:k] for i in x.ids} | set(state.topic)
    rest = [r for r in same if r.open_slot] or [r for r in same if r.id not in mentioned] or same[1:]
    if e.number:
        return rest[-int(e.number) :] + _new(state, e, int(e.number) - len(rest), role, level)
    return (rest if _many(e) else [close(r, "", e.text) for r in rest[:1]]) or _new(state, e, 1, role, level)


def _ordinal(state: Reading, e: Token, role: str, level: int | None) -> list[Named]:
    same = state.inventory.of(e.type)
    if len(same) >= e.ordinal:
        rest = same if e.ordinal == 1 else [r for r in same if r.role != "primary"]
        return [close(r, role, e.text) for r in ([r for r in rest if r.open_slot] or rest[-1:] or same)[:1]]
    _within(state, e, e.ordinal)
    _fill(state, e, e.ordinal - 1)
    return _new(state, e, 1, role, level)


def _within(state: Reading, e: Token, count: float) -> None:
    """Refuse more rooms of a type than a whole count allows: "a two-bedroom flat ... the third bedroom"."""
    same = state.inventory.of(e.type)
    if count > MAX_ROOMS or (count > len(same) and any(r.whole for r in same)):
        words = dict.fromkeys(state.words.quote(*r.span, "rooms") for r in same if r.span is not None)
        what = f"{count:g} {e.type.replace('_', ' ')}s are asked for" + (f", and {len(same)} besides" if same else "")
        advice = "keep one of the two counts" if same else f"ask for {MAX_ROOMS} at most"
        raise ImpossibleError(what, advice, [*words, state.words.quote(max(e.first - 1, 0), e.last, "rooms")])


def _by_role(state: Reading, sentence: list[Token], k: int, level: int | None) -> list[Named]:
    """Return the rooms of a role; one that was only counted may take it."""
    e, same, many, role = sentence[k], state.inventory.of(sentence[k].type), _many(sentence[k]), sentence[k].role
    rooms = [r for r in same if r.role == role]
    if rooms and (many or not e.introduces):
        return rooms if many else rooms[:1]
    here = next((int(x.value) for x in sentence[k:] if x.kind == "level"), level)  # "a bedroom downstairs. The master goes upstairs"
    plain = [r for r in same if not r.role and r.id not in state.inventory.belongings and not _later(r, e.first)]
    plain = [r for r in plain if here is None or r.level in {None, here}]
    if e.type == "bathroom":
        bare = "bare_nouns" in state.words.lexicon.traits and not e.det and not e.number
        slots = [r for r in same if r.open_slot] or (plain if len(plain) == 1 and (e.definite or bare) else [])
        return [close(slots[0], role, e.text)] if slots and role not in {"ensuite", "primary"} else []
    listed = _before(sentence, k, "cue", "colon", "open", "verb", "comma")  # "two bedrooms and a guest room": none of the two
    others = listed.ids if listed is not None and not e.definite else ()
    free = [r for r in plain if r.open_slot and (r.level in {None, level} or (e.definite and level is None))]  # those of this storey
    slots = [r for r in free if r.whole or r.id not in others or _is_spelt_out(sentence, k, r)]
    if slots:
        following = [x for x in sentence[k + 1 :] if x.kind == "np" and x.type == e.type and x.role not in {"", role}]
        parents = int(role == "child" and len(slots) == len(same) > 2)  # they sleep in one of "four bedrooms"
        theirs = sum(int(x.number or 1) for x in following) or parents
        left = max(len(slots) - theirs, 1)  # "a 3-bedroom house, the kids' rooms ... and the parents' room"
        return [close(r, role, e.text) for r in slots[: int(e.number or left) if many else 1]]
    return [close(plain[0], role, e.text)] if len(plain) == 1 == len(same) and e.definite and not plain[0].extra else []


def _later(room: Named, place: int) -> bool:
    """Whether a room that is none of those named in front ("another bathroom") is first named behind a place."""
    return room.extra and room.span is not None and room.span[0] > place


def _known_rooms(state: Reading, sentence: list[Token], k: int, level: int | None) -> list[Named]:
    """Return the rooms that a phrase without role points at, where there are such rooms."""
    e, stock = sentence[k], state.inventory
    same = [r for r in stock.of(e.type) if not _later(r, e.first)]
    if not _many(e) and e.type in {"bathroom", "bedroom"}:  # "... a bath; further a guest bath"
        same = [r for r in same if not (r.role in ROLES and r.span is not None and r.span[0] > e.last)]
    if e.type == "bedroom" and not _many(e):  # "das Kinderzimmer ..., das Schlafzimmer ..."
        same = [r for r in same if r.role not in THEIRS or _word(e) in r.surface.split()]
    if level is not None:
        same = [r for r in same if r.level in {None, level}] or (same if e.definite else [])
    if _many(e):
        _within(state, e, e.number)
        return same
    bare_nouns, theirs = "bare_nouns" in state.words.lexicon.traits, all(r.id in stock.belongings or r.role == "ensuite" for r in same)
    owned = e.type == "bathroom" and not bare_nouns and theirs
    other = e.type == "storage" and all(e.text != r.surface for r in same)
    if not e.det and (owned or other):
        return _new(state, e, 1, "", level)  # "a master with en suite, ..., bathroom"
    if len(same) > 1:
        same = [r for r in same if _word(e) in r.surface.split()] or same
        one = next((r for r in same if not r.role), same[0])
        one.open_slot &= not e.adjectives & {"largest", "smallest"}  # "the others" are not it
        return [one]
    return same


# what numbers and articles introduce


def introduce(state: Reading, sentences: list[list[Token]]) -> None:
    """Make the rooms that numbers and indefinite articles introduce: whole counts first, so that later words may tell them apart."""
    for whole in (True, False):
        for sentence in sentences:
            first = next((e for e in sentence if e.kind in {"np", "level", "zone", "every"}), None)
            level = int(first.value) if first is not None and first.kind == "level" else None
            for k, e in enumerate(sentence):
                if e.kind == "level" and (not (level is None and k) or heads(sentence, k)):
                    level = int(e.value)
                suites = any(x.suite for x in sentence[: k + 1])  # "a suite: ... a bedroom": the suite's own
                theirs = e.suite or (suites and e.type == "bedroom" and not e.number)
                if e.kind == "np" and e.introduces and not e.ids and not theirs and _whole(sentence, k) == whole:
                    rooms = _introduce_rooms(state, sentence, k, backward(sentence, k, level)) if not whole else _count(state, e)
                    e.ids = tuple(r.id for r in rooms)


def _count(state: Reading, e: Token) -> list[Named]:
    _fill(state, e, int(e.number or 1))
    rooms = state.inventory.of(e.type)[: int(e.number or 1)]
    for room in rooms:
        room.whole, room.span = True, (e.first, e.last)
    return rooms


def _whole(sentence: list[Token], k: int) -> bool:
    """Whether the number of a phrase is the count of all such rooms: "a two-bedroom flat", "three baths in total"."""
    e = sentence[k]
    total = any(x.kind == "flag" and x.value == "total" for x in sentence[max(0, k - 1) : k + 2])
    return (e.compound and not e.role) or (e.number > 0 and total)


def _introduce_rooms(state: Reading, sentence: list[Token], k: int, level: int | None) -> list[Named]:
    """Return the rooms of a phrase with a number or an indefinite article."""
    e, stock, role = sentence[k], state.inventory, sentence[k].role
    count = int(e.number or (2 if e.plural and e.type not in PLURAL_NAMES else 1))
    same = stock.of(e.type)
    slots = [r for r in same if r.open_slot and (level is None or r.level in {None, level}) and not r.role]
    candidates = [r for r in slots if r.whole or _is_spelt_out(sentence, k, r)]
    if e.number > MAX_ROOMS or (e.number and not role and "another" not in e.det):
        _within(state, e, count)
    if slots and k > 1 and sentence[k - 1].kind == "verb" and (sentence[k - 2].kind, sentence[k - 2].value) == ("pron", "one"):
        return [close(r, role, e.text) for r in slots[:count]]  # "four bedrooms, one of which is a guest room"
    if role and role != "ensuite":
        if len(candidates) >= count:
            return [close(r, role, e.text) for r in candidates[:count]]
    elif not role and slots:
        if len(slots) == count == len(same) and count > 1:
            return slots
        distinct = all(r.whole for r in slots) or (e.number and count < len(slots) and "another" not in e.det)
        listed = _before(sentence, k, "cue", "colon", "open", "verb", "comma")
        if distinct and count <= len(slots) and (listed is None or listed is sentence[k - 1]):  # "two bedrooms: one bedroom with"
            return [close(r, "", e.text, level) for r in slots[:count]]
    here = [r for r in same if level is None or r.level in {None, level}]
    if here and count == 1 and not e.number and not role and e.type in ALONE and "another" not in e.det:
        return here[:1]
    rooms = _new(state, e, count, role, level)
    for room in rooms:
        room.extra, room.span = "another" in e.det, (e.first, e.last)
    return rooms
