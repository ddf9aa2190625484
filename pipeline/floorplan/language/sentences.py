"""Reads sentences from left to right: what each kind of element says about the rooms around it."""

from collections.abc import Callable, Mapping

from pipeline.floorplan.language.clause import LIGHT, LIKE, LISTING, PLACES_AND_SIZES, Clause, attach, ids_of, measures_home
from pipeline.floorplan.language.lexicon import kinds
from pipeline.floorplan.language.rooms import HALLS, PERSONAL, PRIVATE, SOCIAL, Group, Named, Reading, named_rooms
from pipeline.floorplan.language.tokens import Token

DENIED = {"near": "ban", "wall": "ban", "away": "near", "open": "not_open", "avoid": "avoid"}  # what "not" makes of a relation
HOSTS = kinds("hosts")
NO_PARTS = {"bedroom", "living_room", "family_room", "garage"}  # nothing that another room has
SECLUDED = {"storage", "closet", "wc", "bathroom", "balcony", "utility"}  # "X in Y": X opens off Y


def read(state: Reading, sentence: list[Token]) -> None:
    """Read one sentence."""
    c = Clause(state, sentence)
    k = 0
    while k < len(c.sentence):
        e = c.sentence[k]
        k = (READERS[e.kind](c, k, e) if e.kind in READERS else None) or k + 1
    if c.waiting is not None:  # a relation that stood in front of its subject
        cue, group = c.waiting
        if rooms := tuple(i for i in c.subject if i not in group):
            _emit(c, cue, rooms, group)
    state.topic = named_rooms(c.subject) or state.topic
    state.past = [*state.past, *(e.ids for e in c.sentence if e.ids and e.kind == "np")][-12:]


# each reads one kind of element and returns where reading goes on, None for the next one


def _np(c: Clause, k: int, e: Token) -> None:
    if e.banned:
        if not (e.type == "bedroom" and e.role) and not (e.type in {"kitchen", "bathroom"} and "/" in e.value):
            c.state.banned.append((e.type, e))  # "no guest room" leaves the other bedrooms, "no kitchen-diner" a kitchen
        return
    before = c.near(k - 1)
    said = before is not None and before.kind in {"np", "pron"} and not e.det
    if e.role == "ensuite" and e.type == "bathroom" and not e.ids and said:  # "one of them en suite"
        baths = named_rooms(c.latest)
        hosts = sorted(c.stock.of("bedroom"), key=lambda r: r.role != "primary")[: len(baths)]
        for bath in map(c.stock.get, baths):
            bath.role = "ensuite"
        c.give(baths, tuple(r.id for r in hosts), e)
        return
    ids = c.rooms_at(k)
    if c.left_out and e.det & {"each", "all"}:
        ids, c.run = tuple(i for i in ids if i not in c.left_out), []
    if c.owner:
        _own(c, e, c.stock.get(ids[0]))
    for token, rooms in c.shares(e, ids):
        whole = (e.compound and token.last <= e.first) or measures_home(c, k, token, e.ids, False)
        c.state.amounts.append((token, None if whole else rooms))
    c.push(k, e, ids)
    _describe_rooms(c, k, e, ids)


def _own(c: Clause, e: Token, room: Named) -> None:
    """Read "grandparents with their own bedroom, bathroom and small kitchen": what follows in the list is theirs."""
    if room.type == "bedroom" and "own" in e.det:
        room.role = room.role or c.owner
        c.owning = room.id
    elif c.owning and room.type == "bathroom" and not room.role and room.level in {None, c.stock.get(c.owning).level}:
        c.give((room.id,), (c.owning,), e)
    elif c.owning and room.type == "kitchen":
        room.role = c.stock.get(c.owning).role
        c.state.say("door", (room.id,), (c.owning,), e)


def _describe_rooms(c: Clause, k: int, e: Token, ids: tuple[str, ...]) -> None:
    """Record what adjectives say of rooms."""
    if "melted" in e.adjectives:  # "lounge diner"
        c.state.say("merge", (*ids, *c.rooms_at(k + 2)), (), e)
    elif e.adjectives & {"open", "combined"} and e.type == "kitchen":
        c.state.say("open_kitchen", ids, (), e)
    closed, largest = "closed" in e.adjectives and e.type == "kitchen", "largest" in e.adjectives and not c.factor
    for what in (n for n, said in {"closed": closed, "suite": e.suite, "largest": largest}.items() if said):
        c.state.say(what, ids, (), e)
    if "equal" in e.adjectives and len(ids) > 1:
        c.state.say("area_equal", ids, (), e, LIKE)


def _note(c: Clause, k: int, e: Token) -> None:
    """Note what changes how the words behind it are read: a verb, "which", a negation, and what ends one; and what stands by itself."""
    ahead = c.near(k + 1)
    if e.kind == "amount":
        attach(c, k, e)
    elif e.kind == "home":
        c.state.homes.append(e)
        c.state.studio = c.state.studio or (e if e.value else None)
        for token in e.amounts:
            attach(c, k, token, home=True)
        c.run = []
    elif e.kind == "owner":
        c.owner, c.owning = e.value, ""
    elif e.kind == "outside":
        here = [i for i in named_rooms((*c.latest, *c.subject)) if c.stock.get(i).type not in {"bathroom", "wc", "closet"}]
        c.state.outside = (c.owning or next(iter(here), ""), e)
    elif e.kind == "verb":
        before = c.near(k - 1)
        goes_on = before is not None and before.kind in {"and", "comma"} and c.subject and c.objects
        c.run = [] if goes_on else c.run  # "the bedroom has a bath and is ...": the bedroom is
        c.verb, c.single = True, c.says(e, "singular")
    elif e.kind == "relative":
        c.relative = bool(k) and not c.says(e, "where")
    elif e.kind in {"neg", "but"}:  # "not open, but next to the dining room"
        c.negative = e if e.kind == "neg" else None
    elif e.kind == "comma" and c.negative is not c.sentence[k - 1] and (ahead is None or ahead.kind not in {"cue", "cmp", "or", "neg"}):
        c.negative = None
    elif e.kind == "every":
        c.push(k, e, ("*",))
    elif e.value == "largest" and len(c.latest) == 1 and (c.verb or c.ends(k + 1)):  # "客厅最大"
        c.state.say("largest_of_all", c.latest, (), e)


def _enter(c: Clause, k: int, e: Token) -> int:
    """Let a room be the one that one enters, and what follows go on from there: "into the hall", ", then a hall"."""
    named, j = c.after(k + 1, "enter", ())
    if group := named_rooms(named or c.latest):
        c.state.entrance = c.state.entrance or (group[0], e)
        c.goes_on(group)
        c.waiting = None
    return max(j, k + 1)


def _pron(c: Clause, k: int, e: Token) -> None:
    """Read a pronoun: the rooms that it stands for are spoken of next."""
    verb = any(x.kind == "verb" for x in c.sentence[k + 1 : k + 2])
    behind = c.near(k + 2) if e.value == "one" and verb else None
    named = behind.ids if behind is not None else ()  # "one is a guest room"
    known = e.value == "it" and (c.objects or len(c.run) > verb)  # but "there is one bath, it is ..."
    group = named or c.point(e, k, c.subject if known else ())
    if group:
        c.stands_for(e, group)
        c.subject = group if e.value != "it" or not c.subject else c.subject


def _det(c: Clause, k: int, e: Token) -> None:
    """Read "both", "each", "all", "the other" where no room follows."""
    before, ahead = c.near(k - 1), c.near(k + 1)
    kind = ahead.kind if ahead is not None else ""
    again = bool(c.run) and bool(c.run[-1].det & {"all", "each"}) and before is c.run[-1]  # "..., 所有卧室都从走廊进出"
    if e.value == "all" and kind != "np" and (again or len(c.run) > 1):  # "kitchen, two bedrooms, bath - all off the hall"
        c.subject = c.run[-1].ids if again else ids_of(c.run)
        c.stands_for(e, c.subject)
    elif e.value == "each" and c.ends(k + 1) and before is not None and before.kind in {"word", "comma"}:  # "climbs into every cupboard"
        c.state.understood(e.first, e.last)
    elif e.value == "each" and c.ends(k + 1) and before is not None and before.kind == "np" and len(c.latest) == 1 and not c.objects:
        return  # "a bathroom for each": of whom is not said
    elif e.value == "other" and kind in {"level", "verb"} and not any(r.open_slot for r in c.stock.of(c.state.parted)):
        c.push(k, e, ("*",))
    elif e.value in {"other", "both", "each", "all"} and kind != "np":
        e.kind, e.value = "pron", {"other": "rest", "both": "both"}.get(e.value, "group")
        _pron(c, k, e)


def _flag(c: Clause, k: int, e: Token) -> None:
    """Read one flag."""
    c.state.flags.setdefault(e.value, e)
    if e.value == "daylight":  # "no windows in the bedroom", "the bath needs daylight"
        rooms = named_rooms((c.rooms_in_front() if c.verb else ()) or c.latest)
        c.state.say("no_window" if c.negated(k) else "window", rooms, (), e)
        c.deny()
    elif e.value == "only":
        c.only = e
    elif e.value == "no_through":
        c.state.say("no_through", named_rooms(c.latest) or ("*bedroom",), (), e)
    elif e.value == "open_plan":
        social = tuple(i for i in named_rooms(ids_of(c.run)) if c.stock.get(i).type in SOCIAL)
        if len(social) > 1:
            c.state.say("merge", social, (), e)


# relations


def relate(c: Clause, k: int, e: Token) -> int | None:  # noqa: PLR0911 - one answer per kind of relation
    """Read one relation; return where to go on."""
    if (way := {"has": has, "except": except_rooms}.get(e.value, through if e.value.startswith("thru") else None)) is not None:
        return way(c, k, e)
    c.relative = c.relative or bool(c.state.words.lexicon.sign("relative_cue") & set(e.text.split()[:3]))  # "que da al"
    left, group, j = _sides(c, k, e)
    if not group:
        return _alone(c, k, e)
    if c.sentence[j - 1].kind == "zone" and e.value in {"door", "in"}:  # "on the living side"
        return j
    hosts = c.types(group)  # "X in Y" means that X opens off Y, as a cupboard in the hall does
    opens_off = bool(left and hosts) and (hosts <= HALLS or c.types(left) <= SECLUDED)
    if e.value == "in" and (c.negative is not None or (k and c.sentence[k - 1].kind == "and") or not opens_off):
        c.latest, c.run = group, [x for x in c.sentence[k:j] if x.kind == "np"][-1:]
        return j
    behind = c.near(j)
    only = e.only or c.only is not None or c.says(e, "only") or (behind is not None and behind.value == "only")
    if e.value == "chain":
        left = c.objects or left
    if e.value == "from" and left and behind is not None and behind.value == "leads" and c.ends(j + 1):
        j += 1  # "the bath one reaches from the hall"
    elif e.value == "from" and (ahead := c.ahead(j, "verb", "det", "flag", "adj", "word", "pron")) is not None and ahead.value == "leads":
        c.goes_on(group)
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


def _sides(c: Clause, k: int, e: Token) -> tuple[Group, Group, int]:
    """Return who stands in front of a relation, who behind it, and where reading goes on."""
    ahead = c.near(k + 1)
    left = () if ahead is not None and ahead.value == "pair" else c.subjects(k, e)  # "dazwischen liegt das Bad"
    wide = ahead is not None and ahead.kind == "np" and (len(left) > 2 or (len(left) > 1 and ahead.definite))
    group, j = c.after(k + 1, "leads" if e.value == "door" and c.says(e, "to_many") else e.value, () if wide else left)
    left = tuple(i for i in left if i not in group)
    # "a bedroom, a bath and a kitchen, all open to the living room": nothing stands open to the first two
    if e.value == "open" and c.negative is None:
        left = tuple(i for i in left if i[0] == "*" or c.stock.get(i).type not in PRIVATE) or left
    return left, group, j


def _alone(c: Clause, k: int, e: Token) -> int | None:
    """Read a relation that nothing follows: "kitchen and bath next to each other"."""
    ahead = c.near(k + 1)
    mutual = ahead is not None and ahead.kind == "reciprocal"
    if e.value == "between" and e.text in c.state.words.lexicon.sign("amid"):
        c.state.understood(e.first, e.last)  # "... as a buffer in between" points back at what was said
    if not mutual and e.value != "wall":  # "the two bedrooms must not share a wall"
        return None
    rooms = next((g for g in (c.latest, ids_of(c.run)) if len(g) > 1), c.subject)
    _emit(c, e, rooms[:1], rooms[1:])
    c.subject = c.latest = rooms
    return k + 1 + mutual


def _emit(c: Clause, e: Token, left: Group, group: Group) -> None:
    """Record a relation between rooms, or that there is none."""
    cue = "door" if e.value in {"from", "chain", "in"} else e.value
    kinds = c.types((*left, *group))
    if cue == "apart":  # a kitchen apart from the living room has a door; a bedroom apart from it lies away
        social = kinds <= SOCIAL and not any(i[0] == "*" for i in (*left, *group))
        cue = "away" if not social else "open" if c.deny() else "not_open"  # "the kitchen is not separated from the living room"
    if c.negative is not None:
        c.deny()
        through, at = (cue == "door" and c.says(e, "through")), (cue == "door" and c.says(e, "at"))
        c.state.say("avoid" if through else "ban" if at else DENIED.get(cue, "not_connected"), left, group, e)
    elif cue == "ensuite":
        c.give(left, group, e)
    else:
        c.state.say(cue, left, group, e)


def except_rooms(c: Clause, k: int, e: Token) -> int:
    """Read "all rooms but the pantry open off the hall": those that are left out, and who goes on."""
    group, j = c.after(k + 1, "except", ())
    c.state.say("except", group, (), e)
    c.left_out = group
    each = next((x for x in c.sentence[:k] if x.kind == "every" or set(x.ids) > set(group)), None)
    if each is not None and not any(x.kind == "cue" for x in c.sentence[:k]):
        each.ids = tuple(i for i in each.ids if i not in group)
        c.run, c.latest, c.subject = [each], each.ids, each.ids
    else:
        c.run, c.latest = [x for x in c.sentence[k:j] if x.kind == "np"][-1:], group
    return max(j, k + 1)


def through(c: Clause, k: int, e: Token) -> int:
    """Read "you pass through the dining room to reach the kitchen", and what must not be so."""
    first, j = c.after(k + 1, "door", ())
    j += bool(first) and c.ends(j)  # "durchs Wohnzimmer, um ins Schlafzimmer zu kommen"
    second, j = c.after(j, "leads" if e.value == "thru" else "door", first) if first else ((), k + 1)
    if not second:
        return max(j, k + 1)
    things, hosts = (second, first) if e.value == "thru" else (first, second)
    c.state.say("avoid" if c.deny() or e.value == "thru_not" else "door", things, hosts, e)
    c.goes_on(things)
    return j


# who has what


def has(c: Clause, k: int, e: Token) -> int | None:
    """Read "X with its own bathroom", "the living room has a terrace": rooms that hang on the one named before."""
    before = next((x for x in reversed(c.sentence[:k]) if x.kind in {"np", "home", "pron", "every", "det", "level"}), None)
    at = next((j for j in range(k + 1, len(c.sentence)) if c.sentence[j].kind not in {*LIGHT, "amount"}), None)
    thing = c.sentence[at] if at is not None and c.sentence[at].kind == "np" else None
    owners = _owners(c, e, before)
    if not owners:
        return None
    kind = c.stock.get(owners[0]).type
    negative, c.negative = c.negated(k), None
    if kind == "bedroom":
        return None if negative else _give(c, k, e, owners)
    mine = thing is not None and not thing.banned and not (thing.ids and thing.definite)
    if thing is None or at is None or kind not in HOSTS or len(owners) > 1 or negative or not mine:
        return None
    if kind == "hallway" and thing.type == "bedroom" and not thing.definite:  # "a corridor with two bedrooms and a bathroom"
        group, j = c.after(at, "leads", owners)
        c.state.say("door", group, owners, e)
        c.latest, c.run = group, [thing]
        return j
    if thing.type in NO_PARTS:
        return None
    ids = c.rooms_at(at)
    opened = thing.type in {"kitchen", "dining_room"} and kind not in HALLS
    c.state.say("open" if opened else "door", ids, owners, e)
    c.measures(thing)
    c.latest, c.run, c.subject, c.objects = ids, [thing], c.subject or owners, ids
    return at + 1


def _owners(c: Clause, e: Token, before: Token | None) -> Group:
    """Return who has what follows: the phrase in front, or the list in front of a verb; nobody where the home has it."""
    if before is None or before.kind in {"home", "level"} or not (c.run or c.subject):
        return ()
    if before.value == "it" and c.state.homes and before.ids and all(i[0] != "*" and c.stock.get(i).whole for i in before.ids):
        return ()  # "a one-bedroom flat. It needs a study": the flat
    if not c.run and before.ids and set(before.ids) <= set(c.objects) and c.says(e, "with"):
        return named_rooms(before.ids)  # "the living room leads to a hall with two bedrooms"
    owners = named_rooms(c.run[-1].ids if c.run else c.subject)
    if len(c.run) > 1 and (c.verb or c.says(e, "having")) and not any(x.part for x in c.run):
        listed = named_rooms(ids_of(c.run))
        owners = listed if c.types(listed) == {"bedroom"} else owners
    return owners


def _give(c: Clause, k: int, e: Token, owners: Group) -> int:
    """Give bedrooms what follows: bathrooms, closets, balconies, as many as there are owners."""
    j, end, joined, bare = k + 1, k + 1, "", False
    given: Group = ()
    while (x := c.near(j)) is not None:
        if x.kind == "np" and x.type == "bedroom" and not given and not x.ids and any(y.suite for y in c.sentence[:k]):
            x.ids, joined, end = owners, "", j + 1  # "each suite has a bedroom of 18 m², its own bathroom ..."
            c.measures(x)
        elif x.kind == "np":
            if x.banned or x.type not in PERSONAL or (given and not joined) or not _theirs(c, j, owners, joined, bare=bare):
                break
            ids = _things(c, j, owners)
            bare = bare if given else not (x.det or x.number)
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
        c.run = [Token("np", first=e.first, last=e.last, ids=given, type=c.stock.get(given[0]).type)]
    return end


def _theirs(c: Clause, j: int, owners: Group, joined: str, *, bare: bool) -> bool:
    """Whether the room at j is the owners' own, and not one of the home's that a list goes on with; `bare`: the list began without an article."""
    x, own, number = c.sentence[j], "own" in c.sentence[j].det, c.sentence[j].number or 1
    new = joined == "comma" and bare and not own and (x.number or "indefinite" in x.det)  # "with terrace, a bath and a study"
    known = x.definite and (len(owners) > 1 or len(c.stock.of(x.type)) > 1 or bool(x.ids))
    if new or x.role in {"shared", "guest"} or known or number > len(owners) or 1 < number < len(owners):
        return False
    if joined == "comma" and not own:
        rest = [y for y in c.sentence[j + 1 :] if not (y.kind in {"comma", "det"} or (y.kind == "np" and y.type in PERSONAL))]
        last = next((y for y in c.sentence if rest and y.kind == "np" and y.first >= rest[0].last), None)
        return bool(rest) and rest[0].kind == "and" and (last is None or last.type in PERSONAL)  # "with a bath, closet and balcony"
    return not joined or own or not ("another" in x.det or x.number or x.type == "wc")


def _things(c: Clause, j: int, owners: Group) -> Group:
    """Return one room for each owner: those that were counted first, then new ones."""
    x = c.sentence[j]
    ids = list(x.ids)
    role = x.role if x.role == "primary" and len(owners) == 1 else ""
    slots = [r for r in c.stock.of(x.type) if r.open_slot and r.id not in ids]
    while len(ids) < len(owners):
        if slots:
            room = slots.pop(0)
            room.open_slot, room.surface = False, x.text
        else:
            room = c.stock.add(x.type, role, x.text, c.stock.get(owners[0]).level)
        ids.append(room.id)
    x.ids = tuple(ids[: len(owners)] if x.type == "bathroom" else ids)
    for room in (c.stock.get(i) for i in x.ids):
        room.size = x.size if x.size != 1.0 else room.size
        room.functions |= x.functions
    return x.ids


READERS: Mapping[str, Callable[[Clause, int, Token], int | None]] = {
    **dict.fromkeys(("amount", "home", "owner", "outside", "verb", "relative", "neg", "but", "comma", "every", "adj"), _note), **PLACES_AND_SIZES,
    "np": _np, "enter": _enter, "pron": _pron, "det": _det, "flag": _flag, "cue": relate,
}  # fmt: skip
