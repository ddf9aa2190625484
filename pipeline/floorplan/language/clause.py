"""One sentence while it is read: what its words so far are about, who stands in front of a relation and behind it, sizes against each other, storeys."""

import itertools
import math
from collections.abc import Iterable
from dataclasses import replace

from pipeline.floorplan.language.phrases import backward, heads, listed_on_level
from pipeline.floorplan.language.rooms import FRONT, HALLS, PRIVATE, Group, Reading, name, named_rooms
from pipeline.floorplan.language.tokens import Token
from pipeline.floorplan.program.defaults import DEFAULTS

LIGHT = {"det", "size", "adj", "verb", "word", "flag"}  # between a relation and its room
WIDE = {"leads", "between", "chain", "avoid", "except"}  # relations to lists
ANAPHORA = {"it", "both", "group", "one", "rest", "some", "each", "all", "self", "pair"}
LISTING = {"comma", "and", "or"}
LIKE = 0.15  # two rooms are alike where they differ by less
BESIDE = {"near", "wall"}  # what such a relation joins lies on one storey
NAMED = {"doors", "corridors", "ceiling", "walls", "inner_walls", "outer_walls"}  # what a length may measure besides rooms
HUGE, LARGE, PAIR, MORE, LISTED = 5.0, 2.5, 2.4, 1.6, 1.3  # times the usual area of the room in front: from there on an area is the home's


def ids_of(phrases: Iterable[Token]) -> Group:
    """Return the rooms of phrases, each once."""
    return tuple(dict.fromkeys(i for x in phrases for i in x.ids))


class Clause:
    """The state of reading one sentence."""

    def __init__(self, state: Reading, sentence: list[Token]) -> None:
        self.state, self.sentence, self.stock = state, sentence, state.inventory
        self.run: list[Token] = []  # the list of phrases in front of the next relation
        self.subject: Group = ()
        self.latest: Group = ()
        self.objects: Group = ()
        self.waiting: tuple[Token, Group] | None = None  # a relation in front of its subject: "next to the kitchen lies ..."
        self.negative: Token | None = None
        self.verb = self.relative = self.single = False
        self.owner = self.owning = ""  # "the grandparents", and their bedroom
        self.only: Token | None = None
        self.factor: Token | None = None
        first = next((e for e in sentence if e.kind in {"np", "level", "zone", "every", "pron"} or e.value in {"other", "all"}), None)
        self.forward = first is not None and first.kind == "level"  # storeys stand in front of their rooms
        self.level: int | None = None
        self.left_out: Group = ()  # "except the guest room, each has ..."

    def near(self, k: int) -> Token | None:
        """Return the element at k, None beyond the ends."""
        return self.sentence[k] if 0 <= k < len(self.sentence) else None

    def ahead(self, k: int, *skipped: str) -> Token | None:
        """Return the first element from k on that is of no skipped kind."""
        return next((x for x in self.sentence[k:] if x.kind not in skipped), None)

    def says(self, e: Token, sign: str) -> bool:
        """Whether a word of an element belongs to a closed class."""
        return bool(self.state.words.lexicon.sign(sign) & set(e.text.split()))

    def ends(self, k: int) -> bool:
        """Whether a part of the sentence ends in front of k."""
        ahead = self.near(k)
        return ahead is None or ahead.kind in {"comma", "and"}

    def types(self, group: Group) -> set[str]:
        """Return the types of the rooms of a group."""
        return {self.stock.get(i).type for i in group if i[0] != "*"}

    def deny(self) -> bool:
        """Take the negation that is open, if there is one: what is said next is what it rules out."""
        e, self.negative = self.negative, None
        if e is not None:
            self.state.understood(e.first, e.last)
        return e is not None

    def negated(self, k: int) -> bool:
        """Whether a negation stands just in front of the element at k."""
        return any(x.kind == "neg" for x in self.sentence[max(0, k - 3) : k])

    def give(self, things: Group, owners: Group, e: Token) -> None:
        """Let rooms belong to others."""
        self.stock.belongings.update(things)
        self.state.say("own", things, owners, e)

    def measures(self, e: Token) -> None:
        """Note the areas of a phrase."""
        self.state.amounts += self.shares(e, e.ids)
        e.amounts = []

    def shares(self, e: Token, ids: Group) -> list[tuple[Token, Group | None]]:
        """Return the amounts of a phrase, each with its rooms: of several areas one each."""
        areas = [m for m in e.amounts if m.is_size]
        dealt = [(m, ids[k : k + 1] if len(areas) > 1 else ids) for k, m in enumerate(areas)]
        return [*dealt, *((m, ids) for m in e.amounts if not m.is_size)]

    def goes_on(self, rooms: Group, objects: Group = (), subject: Group = ()) -> None:
        """Set what is spoken of behind a relation."""
        self.latest, self.objects, self.subject = rooms, objects or rooms, subject or rooms
        self.run, self.verb, self.relative = [], False, False

    def stands_for(self, e: Token, ids: Group) -> None:
        """Let an element that is no phrase be the list in front of the next relation."""
        e.ids = self.latest = ids
        self.run = [Token("np", first=e.first, last=e.last, text=e.text, ids=ids)]

    def push(self, k: int, e: Token, ids: Group) -> None:
        """Take a group into the list in front of the next relation."""
        before = next((x for x in reversed(self.sentence[:k]) if x.kind not in {"det", "size", "adj"}), None)
        if before is None or not self.run or before.kind not in {*LISTING, "np", "amount", "open", "close"}:
            self.run, self.verb, self.single = [], False, False
        elif self.objects and set(ids_of(self.run)) == set(self.objects):
            self.run = []  # what was given to somebody is no part of a new list
        self.run.append(e)
        e.ids = self.latest = ids
        if self.waiting and not set(ids) <= set(self.waiting[1]):
            self.subject = tuple(dict.fromkeys((*self.subject, *ids)))
        self.subject = self.subject or ids

    def rooms_at(self, k: int) -> Group:
        """Return the rooms of the phrase at k."""
        return name(self.state, self.sentence, k, backward(self.sentence, k, self.level if self.forward else None))

    def point(self, e: Token, k: int, but: Group) -> Group:  # noqa: PLR0911 - one answer per pronoun
        """Return the rooms that a pronoun stands for: after "but" the subject still, as an object what is not the subject `but`."""
        if e.value == "it" and k and self.sentence[k - 1].kind == "but" and self.subject:
            return self.subject
        here = [x.ids for x in self.sentence[:k] if x.kind in {"np", "zone"} and x.ids]
        groups = [*self.state.past, *here]
        if e.value == "it":
            if but:
                return next((g for g in reversed(groups if here else self.state.past) if not set(g) & set(but)), ())
            return here[0] if here else self.state.topic
        each = tuple(dict.fromkeys(i for g in reversed(groups) for i in g if i not in but))  # of one alone, each
        if e.value == "both":
            return groups[-1] if groups and len(groups[-1]) > 1 else each[:2]
        plural: Group = next((g for g in reversed(groups) if len(g) > 1), groups[-1] if groups else ())
        if not plural or plural[0].startswith("*"):
            return plural
        kind = self.stock.get(plural[0]).type
        kind = self.state.parted if e.value == "rest" and any(r.open_slot for r in self.stock.of(self.state.parted)) else kind
        if e.value == "group" and len(plural) == 1:
            two = len(each) == 2 and any(x.kind == "verb" for x in self.sentence[k + 1 : k + 2])  # "... They are joined."
            return each if two else tuple(i for i in each if i[0] != "*" and self.stock.get(i).type == kind)
        free = [r for r in self.stock.of(kind) if r.open_slot]
        if e.value in {"rest", "some"}:
            return tuple(r.id for r in free) or plural
        if e.value == "one":
            self.state.parted = kind
            for room in free[: int(e.number or 1)]:
                room.open_slot = False
            return tuple(r.id for r in free[: int(e.number or 1)])
        return plural

    # who stands in front

    def place(self, e: Token) -> int:
        """Return where an element stands."""
        return next((i for i, x in enumerate(self.sentence) if x is e), 0)

    def coordinate(self) -> bool:
        """Whether the last two phrases in front of a relation are joined by more than a comma; one alone is."""
        ends = [self.place(x) for x in self.run[-2:]]
        return len(ends) < 2 or any(x.kind in {"and", "or"} for x in self.sentence[ends[0] : ends[1]])

    def rooms_in_front(self) -> Group:
        """Return the rooms in front of a comparison: the last phrase, with those that an "and" joins to it."""
        return ids_of(self.run if self.coordinate() else self.run[-1:])

    def subjects(self, k: int, e: Token) -> Group:
        """Return who stands in front of a relation: the phrase, the list in front of a verb, or what the clause is about."""
        before = self.near(k - 1)
        if not self.run:
            chained = before is not None and before.kind == "np" and e.value == "near"
            return self.objects if self.objects and self.relative != chained else self.subject  # "X next to Y, which is next to ..."
        last = self.run[-1]
        cue_at = max((i for i, x in enumerate(self.sentence[:k]) if x.kind == "cue"), default=0)
        one = bool(self.objects) and set(self.objects) == set(ids_of(self.run))
        one = one and not any(x.kind in LISTING for x in self.sentence[cue_at + 1 : self.place(last)])
        if one and before is not None and before.kind in LISTING:  # "a guest room with its own bath, away from ..."
            return self.subject
        door = e.value in {"door", "leads"} and self.says(e, "with") and not last.plural  # "a kitchen and a hall with a door to ..."
        finite = any(self.says(x, "finite") for x in (*self.sentence[self.place(last) + 1 : k], e))  # of more than one
        joined = self._coordinated() and (finite or not self.run[-2].introduces)  # no "a hall and the bath must"
        new = last.definite and not joined and not any(x.definite for x in self.run[:-1])
        alone = new or self.relative or (door and not self.verb) or (self.single and not last.plural) or not self.coordinate()
        verbal = self.verb or e.value in {"leads", "away", "apart", "wall"} or finite
        if alone or not (verbal or e.value == "door"):
            return last.ids
        return ids_of(self.run if verbal else self.run[-1 - self._coordinated() :])

    def _coordinated(self) -> int:
        """Return how many phrases in front of the last one "and" joins to it, without a comma."""
        ends = [self.place(x) for x in self.run]
        between = ({x.kind for x in self.sentence[a + 1 : b]} for a, b in itertools.pairwise(ends))
        return sum(1 for _ in itertools.takewhile(lambda kinds: "and" in kinds and "comma" not in kinds, reversed(list(between))))

    # who stands behind

    def after(self, k: int, cue: str, left: Group) -> tuple[Group, int]:
        """Return the rooms named after a relation, and where reading goes on."""
        group: list[str] = []
        end, joined, first = k, "", None
        while (e := self.near(k)) is not None:
            if e.kind == "np":
                if e.banned or (group and not joined) or (first is not None and not self._continues(k, cue, joined, first, len(group))):
                    break
                here = {self.stock.get(i).level for i in named_rooms(left)} if cue in BESIDE else set()
                ids = name(self.state, self.sentence, k, self.level if self.forward else here.pop() if len(here) == 1 else None)
                self.measures(e)
                group += [i for i in ids if i not in group and i not in left]
                first, joined, end = first or e, "", k + 1
            elif not group and (anaphor := self._anaphor(k, e, left)) is not None:
                return anaphor
            elif e.kind == "cue" and e.value in {"in", "leads"} and joined and cue in WIDE and not (joined == "comma" and self.relative):
                joined = "and"  # "leads to the bath and into the kitchen"
            elif e.kind in LISTING and (group or e.kind != "comma"):
                joined = "comma" if e.kind == "comma" and joined != "and" else "and"
            elif not self._passed(e, bool(group), joined, cue):
                break
            k += 1
        return tuple(group), end

    def _passed(self, e: Token, named: bool, joined: str, cue: str) -> bool:
        """Whether an element may stand inside the list behind a relation."""
        if e.kind in {"det", "size", "adj", "word", "owner", "relative"}:
            return True
        if e.kind == "to" and joined:  # "open to the dining room and to the kitchen"
            self.state.understood(e.first, e.last)
            return True
        return (e.kind == "colon" and not named and cue == "leads") or (e.kind in {"verb", "open", "to"} and not named)

    def _anaphor(self, k: int, e: Token, left: Group) -> tuple[Group, int] | None:
        """Return the rooms that a pronoun, a zone or "everything" behind a relation stand for; None for other elements."""
        phrase = (ahead := self.near(k + 1)) is not None and ahead.kind == "np"
        if e.kind in {"pron", "det"} and e.value in ANAPHORA and not (e.kind == "det" and phrase):
            return tuple(i for i in self.point(e, k, left) if i not in left), k + 1
        if e.kind == "zone":
            zone(self, k, e)
            return e.ids, k + 1
        if e.kind == "every":
            return ("*",), k + 1
        return None

    def _continues(self, k: int, cue: str, joined: str, first: Token, count: int) -> bool:  # noqa: PLR0911 - one answer per case
        """Whether a list after a relation goes on with the phrase at k, or a new statement begins there."""
        e = self.sentence[k]
        ahead = self.ahead(k + 1, "det", "amount", "adj", "flag", "word")
        if cue == "between" and joined == "and" and count == 1:
            return True
        if (cue == "open" and e.type in PRIVATE and not e.definite) or (cue == "cmp" and "equal" in e.adjectives):
            return False  # "a kitchen open to the living room and a terrace": nothing stands open to these
        gives = ahead is not None and ahead.kind == "cue" and (ahead.value not in {"except", "has"} or self.says(ahead, "having"))
        if gives or (ahead is not None and ahead.kind in {"verb", "cmp", "neg", "factor"}):
            return False  # the phrase is the subject of a statement of its own
        closed = count == len(first.ids) and [x.kind for x in self.sentence[k - 2 : k]] == ["comma", "and"]
        halls = not closed and bool(self.types(self.latest or self.subject) & HALLS)
        if cue in {"leads", "door"} and self.relative and e.introduces and not first.introduces and not halls:
            return False  # "a living room that opens to the kitchen, one bedroom and one bath"; "a hall that ..., and a kitchen"
        if cue == "leads" and joined == "comma" and e.number and not first.number and not any(x.kind == "and" for x in self.sentence[k:]):
            return False
        if cue in WIDE or joined == "comma":
            return cue in WIDE - {"between"}
        if cue in FRONT and e.introduces:
            return "indefinite" in first.det and cue == "near"
        return e.definite or not first.definite or cue == "open"


# sizes against each other


def factor(c: Clause, k: int, e: Token) -> int | None:
    """Note a factor; "twice the living room" compares at once."""
    c.factor = e
    ahead = c.ahead(k + 1, "relative", "det")
    return compare(c, k, e) if ahead is not None and ahead.kind == "np" else k + 1


def compare(c: Clause, k: int, e: Token) -> int:
    """Read "at least 1.5 times as large as the largest bedroom"."""
    left = c.rooms_in_front() or (c.objects if c.relative else ()) or c.subject
    if e.value == "alike":
        rooms = c.latest if len(c.latest) > 1 else ids_of(c.run)
        c.state.say("area_equal", named_rooms(rooms if len(rooms) > 1 else c.subject), (), e, LIKE)
        return k + 1
    right, j = c.after(k + 1, "cmp", left)
    if not right and len(c.run) > 1:  # "a kitchen and a living room larger than the kitchen"
        left, (right, j) = c.run[-1].ids, c.after(k + 1, "cmp", c.run[-1].ids)
    behind = c.near(j)
    if c.factor is None and behind is not None and behind.kind == "factor":  # "客厅要比厨房大一倍"
        c.factor, j = behind, j + 1
    value = (c.factor.number or 1.0) if c.factor else 1.0
    if left and right:
        for said in filter(None, (e, c.factor, behind if behind is not None and behind.kind == "size" else None)):
            c.state.understood(said.first, said.last)
        if e.value == "equal" and c.factor is None and c.negative is None:
            c.state.say("area_equal", (*left, *right), (), e, LIKE)
            left = ()
        turned = (e.value == "smaller") != (value < 1.0)
        a, b = (right, left) if turned != (c.negative is not None) else (left, right)  # "half the size of", "not larger than"
        for x in a:
            c.state.say("area_order", (x,), tuple(i for i in b if i != x), e, 1.0 / value if value < 1.0 else value)
        c.deny()
    size = c.ahead(j, "comma", "verb")  # "the kitchen is larger than the bath, about 18 m²"
    c.factor, c.latest, c.run = None, left if size is not None and size.kind == "amount" else right, []
    return max(j, k + 1)


# where rooms lie: storeys and wings


def level(c: Clause, k: int, e: Token) -> None:
    """Put rooms on a storey: those named before it, or, where it comes first, those that follow."""
    c.state.levels.append(e)
    ahead = c.near(k + 1)
    start = max((j for j, x in enumerate(c.sentence[:k]) if x.kind == "comma"), default=k)
    part = ids_of(x for x in c.sentence[start:k] if x.kind == "np")
    closes = c.forward and part and (ahead is None or ahead.kind == "comma")  # "upstairs two bedrooms, the kitchen downstairs"
    if not closes and (c.forward or heads(c.sentence, k)):
        c.forward, c.level, c.run = True, int(e.value), []
        return
    owners = c.subject if c.objects and c.latest == c.objects else ()  # "a guest room with bath, downstairs"
    for room in map(c.stock.get, named_rooms(part if closes else ids_of(listed_on_level(c.sentence, k)) or (*c.latest, *owners))):
        room.level = int(e.value)
    c.state.heights |= {i.removeprefix("*zone_"): int(e.value) for i in c.latest if i.startswith("*")}


def zone(c: Clause, k: int, e: Token) -> None:
    """Take the rooms of a zone into the list."""
    members = tuple(c.stock.zone(e.value))
    c.state.zones.setdefault(e.value, (members, e))
    c.push(k, e, members or (f"*zone_{e.value}",))


def wing(c: Clause, _: int, e: Token) -> None:
    """Read "the bedrooms in one wing": they are a zone."""
    c.state.understood(e.first, e.last)
    ids, c.run = ids_of(c.run), []
    if not named_rooms(ids):
        c.state.wings += tuple(i.removeprefix("*zone_") for i in ids if i != "*")
        return
    known = next((n for n, (members, _) in c.state.zones.items() if set(members) == set(ids)), None)
    name_of = known or ("bedroom" if c.types(ids) == {"bedroom"} else f"wing_{len(c.state.wings) + 1}")
    c.state.zones.setdefault(name_of, (ids, e))
    c.state.wings += (name_of,)


PLACES_AND_SIZES = {"level": level, "wing": wing, "zone": zone, "factor": factor, "cmp": compare}  # readers of kinds of tokens


# amounts


def measures_home(c: Clause, k: int, token: Token, ids: Group, set_off: bool) -> bool:
    """Whether an area is the home's: more than the rooms in front would take, right behind them or `set_off` by a comma."""
    if token.total or token.value != "area" or not ids:
        return token.total
    rooms, usual = [x for x in c.sentence if x.kind == "np"], [DEFAULTS[c.stock.get(i).type].area for i in ids]
    if set_off and k > 1 and c.sentence[k - 2].kind == "home" and token.number > MORE * max(usual):
        return True  # "a two-bedroom flat, 55 m2, with a kitchen of 5 m2"
    if sum(bool(x.amounts) for x in rooms) != (not set_off):
        return False
    times = token.number / sum(usual)
    home = any(x.kind == "home" and not x.amounts for x in c.sentence[:k])
    named = [x for x in rooms if x.first < token.first]
    if set_off:
        return times > (LISTED if len(named) > 2 else MORE if home else LARGE if len(ids) > 1 else PAIR if len(named) > 1 else math.inf)
    closes = len(named) == len(rooms) and (len(rooms) > 2 or home)
    return times > (LARGE if closes else HUGE if home else math.inf)


def attach(c: Clause, k: int, token: Token, *, home: bool = False) -> None:
    """Attach an amount that stands by itself, or behind the word for the home."""
    state = c.state
    before, ahead = c.near(k - 1), c.near(k + 1)
    alone = len(state.topic) == 1 and state.past[-1:] == [state.topic] and any(x.kind in {"cue", "verb"} for x in c.sentence[:k])
    alone = alone and token.number < LARGE * DEFAULTS[c.stock.get(state.topic[0]).type].area  # "Una cocina. Que tenga 18 m2."
    rooms = () if home else named_rooms(c.latest) or (state.topic if alone else ())
    if token.value == "storeys":
        state.storeys = state.storeys or ((int(token.number), token) if token.number >= 1 else None)
    elif token.value == "rooms":  # of one and a half, the half is to sleep in
        state.rooms = state.rooms or (2 if token.number == 1.5 else int(token.number), token)
    elif token.total or any((x.kind, x.value) == ("flag", "total") for x in c.sentence[max(0, k - 2) : k + 2]):
        state.amounts.append((token, None))
    elif token.value == "length":
        named = next((x for x in reversed(c.sentence[:k]) if x.kind == "np" or x.value in NAMED), None)
        what = next((x.value for x in (named, ahead) if x is not None and x.value in NAMED), "")
        state.amounts.append((replace(token, value=what), None) if what else (token, rooms or None))
    elif token.value == "area" and before is not None and (before.kind, before.value) == ("cue", "in") and not home:
        state.amounts.append((token, None))  # "ten rooms in 40 m2"
    elif token.value == "area" and c.latest == ("*",):
        state.amounts.append((token, c.latest))  # "every room at least 9 m2"
    elif token.value != "car":
        before = next((x for x in reversed(c.sentence[:k]) if x.kind != "word"), None)
        set_off = before is not None and before.kind in {"comma", "and"}
        limit = set_off and token.bound in {"least", "most"} and c.objects == c.latest  # "a study near the bedroom, at least 10 m²"
        rooms = (named_rooms(c.subject) if limit else ()) or rooms
        state.amounts.append((token, rooms if rooms and not (set_off and measures_home(c, k, token, rooms, True)) else None))
