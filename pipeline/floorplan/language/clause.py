"""One sentence while it is read: what its words so far are about, who stands in front of a relation and behind it, sizes against each other, storeys."""

import itertools
from collections.abc import Iterable

from pipeline.floorplan.language.marks import Mark
from pipeline.floorplan.language.phrases import Element, backward, heads
from pipeline.floorplan.language.rooms import FRONT, HALLS, PRIVATE, SOCIAL, Group, Reading, name

LIGHT = {"det", "size", "adj", "verb", "word", "flag"}  # between a relation and its room
WIDE = {"leads", "between", "chain", "avoid", "except"}  # relations to lists
STANDINS = {"it", "both", "group", "one", "rest", "some", "each", "all", "self", "pair"}
LISTING = {"comma", "and", "or"}
LIKE = 0.15  # two rooms are alike where they differ by less
BESIDE = {"near", "wall"}  # what such a relation joins lies on one storey


def named_rooms(group: Group) -> Group:
    """Return the rooms of a group, without "all rooms" and zones."""
    return tuple(i for i in group if not i.startswith("*"))


def ids_of(phrases: Iterable[Element]) -> Group:
    """Return the rooms of phrases, each once."""
    return tuple(dict.fromkeys(i for x in phrases for i in x.ids))


class Clause:
    """The state of reading one sentence."""

    def __init__(self, state: Reading, sentence: list[Element]) -> None:
        self.state, self.sentence = state, sentence
        self.stock = state.inventory
        self.run: list[Element] = []  # the list of phrases in front of the next relation
        self.subject: Group = ()
        self.latest: Group = ()
        self.objects: Group = ()
        self.waiting: tuple[Element, Group] | None = None  # a relation in front of its subject: "next to the kitchen lies ..."
        self.negative: Element | None = None
        self.verb = self.relative = self.single = False
        self.owner = self.owning = ""
        self.only: Element | None = None
        self.factor: Element | None = None
        first = next(
            (e for e in sentence if e.kind in {"np", "level", "zone", "every", "pron"} or e.value in {"other", "both", "all"}), None
        )
        self.forward = first is not None and first.kind == "level"  # storeys stand in front of their rooms
        self.level: int | None = None
        self.left_out: Group = ()  # "except the guest room, each has ..."

    def near(self, k: int) -> Element | None:
        """Return the element at k, None beyond the ends."""
        return self.sentence[k] if 0 <= k < len(self.sentence) else None

    def ahead(self, k: int, *skipped: str) -> Element | None:
        """Return the first element from k on that is of no skipped kind."""
        return next((x for x in self.sentence[k:] if x.kind not in skipped), None)

    def says(self, e: Element, sign: str) -> bool:
        """Whether a word of an element belongs to a closed class."""
        return bool(self.state.heard.lexicon.sign(sign) & set(e.text.split()))

    def part(self, k: int) -> Group:
        """Return the rooms named between the last comma and k."""
        start = max((j for j, x in enumerate(self.sentence[:k]) if x.kind == "comma"), default=-1)
        return ids_of(x for x in self.sentence[start + 1 : k] if x.kind == "np") if start >= 0 else ()

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

    def give(self, things: Group, owners: Group, e: Element) -> None:
        """Let rooms belong to others."""
        self.stock.belongings.update(things)
        self.state.say("own", things, owners, e)

    def measures(self, e: Element) -> None:
        """Note the areas of a phrase."""
        self.state.amounts += self.shares(e, tuple(e.ids))
        e.amounts = []

    def shares(self, e: Element, ids: Group) -> list[tuple[Mark, Group | None]]:
        """Return the amounts of a phrase, each with its rooms: of several areas one each."""
        areas = [m for m in e.amounts if m.is_size]
        dealt = [(m, ids[k : k + 1] if len(areas) > 1 else ids) for k, m in enumerate(areas)]
        return [*dealt, *((m, ids) for m in e.amounts if not m.is_size)]

    def goes_on(self, rooms: Group, objects: Group = (), subject: Group = ()) -> None:
        """Set what is spoken of behind a relation."""
        self.latest, self.objects, self.subject = rooms, objects or rooms, subject or rooms
        self.run, self.verb, self.relative = [], False, False

    def stands_for(self, e: Element, ids: Group) -> None:
        """Let an element that is no phrase be the list in front of the next relation."""
        e.ids, self.latest = list(ids), ids
        self.run = [Element("np", first=e.first, last=e.last, text=e.text, ids=list(ids))]

    def push(self, k: int, e: Element, ids: Group) -> None:
        """Take a group into the list in front of the next relation."""
        before = next((x for x in reversed(self.sentence[:k]) if x.kind not in {"det", "size", "adj"}), None)
        if before is None or not self.run or before.kind not in {*LISTING, "np", "amount", "open", "close"}:
            self.run = []
            self.verb = self.single = False
        elif self.objects and set(ids_of(self.run)) == set(self.objects):
            self.run = []  # what was given to somebody is no part of a new list
        self.run.append(e)
        e.ids, self.latest = list(ids), ids
        if self.waiting and not set(ids) <= set(self.waiting[1]):
            self.subject = tuple(dict.fromkeys((*self.subject, *ids)))
        self.subject = self.subject or ids

    def rooms_at(self, k: int) -> Group:
        """Return the rooms of the phrase at k."""
        return tuple(name(self.state, self.sentence, k, backward(self.sentence, k, self.level if self.forward else None)))

    def point(self, e: Element, k: int, but: Group) -> Group:  # noqa: PLR0911 - one answer per pronoun
        """Return the rooms that a pronoun stands for: after "but" the subject still, as an object what is not the subject `but`."""
        if e.value == "it" and self.subject and k and self.sentence[k - 1].kind == "but":
            return self.subject
        here = [tuple(x.ids) for x in self.sentence[:k] if x.kind in {"np", "zone", "owner"} and x.ids]
        groups = [*self.state.past, *here]
        if e.value == "it":
            if but:
                return next((g for g in reversed(groups if here else self.state.past) if not set(g) & set(but)), ())
            return here[0] if here else (self.state.topic or (self.state.past[-1] if self.state.past else ()))
        single = tuple(dict.fromkeys(i for g in reversed(groups) for i in g if i not in but))
        if e.value == "both":
            return groups[-1] if groups and len(groups[-1]) > 1 else single[:2]
        plural: Group = next((g for g in reversed(groups) if len(g) > 1), groups[-1] if groups else ())
        if not plural or plural[0].startswith("*"):
            return plural
        kind = self.stock.get(plural[0]).type
        kind = self.state.parted if e.value == "rest" and any(r.open_slot for r in self.stock.of(self.state.parted)) else kind
        if e.value == "group" and len(plural) == 1:
            same = [i for g in groups for i in g if i[0] != "*" and self.stock.get(i).type == kind]
            return tuple(dict.fromkeys(same))
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

    def place(self, e: Element) -> int:
        """Return where an element stands."""
        return next((i for i, x in enumerate(self.sentence) if x is e), 0)

    def coordinate(self) -> bool:
        """Whether the last two phrases in front of a relation are joined by more than a comma; one alone is."""
        ends = [self.place(x) for x in self.run[-2:]]
        return len(ends) < 2 or any(x.kind in {"and", "or"} for x in self.sentence[ends[0] : ends[1]])

    def rooms_in_front(self) -> Group:
        """Return the rooms in front of a comparison: the last phrase, with those that an "and" joins to it."""
        return ids_of(self.run if self.coordinate() else self.run[-1:])

    def subjects(self, k: int, e: Element) -> Group:
        """Return who stands in front of a relation: the phrase, the list in front of a verb, or what the clause is about."""
        before = self.near(k - 1)
        if not self.run:
            cue = next((x for x in reversed(self.sentence[:k]) if x.kind == "cue"), None)
            chained = before is not None and before.kind == "np" and cue is not None and cue.value == e.value == "near"
            if self.objects and self.relative != chained:
                return self.objects  # "away from the bedroom, which is next to ...", "X next to Y next to Z"
            return self.subject
        last = self.run[-1]
        comma = before is not None and before.kind == "comma"
        if before is not None and before.kind in LISTING and self.objects and set(self.objects) == set(ids_of(self.run)):
            cue_at = max((i for i, x in enumerate(self.sentence[:k]) if x.kind == "cue"), default=0)
            if not any(x.kind in LISTING for x in self.sentence[cue_at + 1 : self.place(last)]):
                return self.subject  # "a guest room with its own bath, away from ..."
        alone = (
            self.relative
            or (comma and len(self.run) > 1 and not self.verb)
            or (
                e.value in {"door", "leads"} and self.says(e, "with") and not last.plural and not self.verb
            )  # "a kitchen and a hall with a door to ..."
            or (self.single and len(self.run) > 1 and not last.plural)
            or not self.coordinate()  # "study downstairs, all bedrooms upstairs, garage connected to ...": commas part statements
        )
        if alone:
            return tuple(last.ids)
        verbal = (
            self.verb
            or e.value in {"leads", "away", "apart", "wall"}
            or self.says(e, "finite")
            or any(self.says(x, "finite") for x in self.sentence[self.place(last) + 1 : k])
        )
        if verbal:
            return ids_of(self.run)
        return self._tail() if e.value == "door" else tuple(last.ids)

    def _tail(self) -> Group:
        """Return the phrases at the end of the list that "and" joins."""
        tail = self.run[-1:]
        for a, b in itertools.pairwise(reversed(self.run)):
            between = [x.kind for x in self.sentence[self.place(b) + 1 : self.place(a)]]
            if "comma" in between or "and" not in between:
                break
            tail.insert(0, b)
        return ids_of(tail)

    # who stands behind

    def after(self, k: int, cue: str, left: Group) -> tuple[Group, int]:
        """Return the rooms named after a relation, and where reading goes on."""
        group: list[str] = []
        end, joined = k, ""
        first = None
        while (e := self.near(k)) is not None:
            if e.kind == "np":
                if (
                    e.banned
                    or (group and not joined)
                    or (first is not None and not self._continues(k, cue, joined, first, left, len(group)))
                ):
                    break
                here = {self.stock.get(i).level for i in named_rooms(left)} if cue in BESIDE else set()
                ids = name(self.state, self.sentence, k, self.level if self.forward else here.pop() if len(here) == 1 else None)
                self.measures(e)
                if self.sentence[k - 1].kind == "to":  # "open to the dining room and to the kitchen"
                    self.state.understood(self.sentence[k - 1].first, self.sentence[k - 1].last)
                group += [i for i in ids if i not in group and i not in left]
                first, joined, end = first or e, "", k + 1
            elif not group and (standin := self._standin(k, e, left)) is not None:
                return standin
            elif e.kind == "cue" and e.value in {"in", "leads"} and joined and cue in WIDE and not (joined == "comma" and self.relative):
                joined = "and"  # "leads to the bath and into the kitchen"
            elif e.kind in LISTING:
                joined = "comma" if e.kind == "comma" and joined != "and" else "and"
            elif not self._passed(e, bool(group), joined, cue):
                break
            k += 1
        return tuple(group), end

    def _passed(self, e: Element, named: bool, joined: str, cue: str) -> bool:
        """Whether an element may stand inside the list behind a relation."""
        if e.kind in {"det", "size", "adj", "word", "owner", "relative"}:
            return True
        if e.kind == "colon":
            return not named and cue == "leads"
        return (e.kind in {"verb", "open"} and not named) or (e.kind == "to" and (not named or bool(joined)))

    def _standin(self, k: int, e: Element, left: Group) -> tuple[Group, int] | None:
        """Return the rooms that a pronoun, a zone, people or "everything" behind a relation stand for; None for other elements."""
        ahead = self.near(k + 1)
        phrase = ahead is not None and ahead.kind == "np"
        if e.kind in {"pron", "det"} and e.value in STANDINS and not (e.kind == "det" and phrase):
            ids = self.point(e, k, left)
            return tuple(i for i in ids if i not in left), k + 1
        if e.kind == "zone":
            self.zone(k, e)
            return tuple(e.ids), k + 1
        if e.kind == "every":
            return ("*",), k + 1
        return None

    def zone(self, k: int, e: Element) -> None:
        """Take the rooms of a zone into the list."""
        members = self.stock.zone(e.value)
        e.ids = members or [f"*zone_{e.value}"]
        self.state.zones.setdefault(e.value, (tuple(members), e))
        self.push(k, e, tuple(e.ids))

    def _continues(self, k: int, cue: str, joined: str, first: Element, left: Group, count: int) -> bool:  # noqa: PLR0911 - one answer per case
        """Whether a list after a relation goes on with the phrase at k, or a new statement begins there."""
        e = self.sentence[k]
        ahead = self.ahead(k + 1, "det", "amount", "adj", "flag", "word")
        if cue == "between" and joined == "and" and count == 1:
            return True
        if (cue == "open" and e.type in PRIVATE and not e.definite) or (cue == "cmp" and "equal" in e.adjectives):
            return False  # "a kitchen open to the living room and a terrace": nothing stands open to these
        if ahead is not None and self._starts(ahead, cue):
            return False
        if cue == "leads" and joined == "comma":
            if self.types(left) == {"bedroom"} and e.type in SOCIAL:
                return False  # a bedroom leads to its bath, and the list of rooms goes on
            halls = bool(self.types(self.latest or self.subject) & HALLS)
            if self.relative and e.introduces and first.definite and not halls:
                return False  # "a living room that opens to the kitchen, one bedroom and one bath"
            if e.number and not first.number and not any(x.kind == "and" for x in self.sentence[k:]):
                return False
        if cue in WIDE:
            return cue != "between"
        if joined == "comma":
            return False
        if cue in FRONT and e.introduces:
            return "indefinite" in first.det and cue == "near"
        return e.definite or not first.definite or cue == "open"

    def _starts(self, ahead: Element, cue: str) -> bool:
        """Whether what follows a phrase makes it the subject of a statement of its own."""
        if ahead.kind == "cue":
            return ahead.value != "except" and (ahead.value != "has" or self.says(ahead, "having")) and cue != "avoid"
        return ahead.kind in {"verb", "cmp", "neg", "factor"}


# sizes against each other


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
    if c.factor is None and behind is not None and behind.kind == "factor":  # "客厅要比厨房大一倍"
        c.factor, j = behind, j + 1
    value = (c.factor.number or 1.0) if c.factor else 1.0
    if left and right:
        for said in filter(None, (e, c.factor)):
            c.state.understood(said.first, said.last)
        turned = (e.value == "smaller") != (value < 1.0)
        a, b = (right, left) if turned != (c.negative is not None) else (left, right)  # "half the size of", "not larger than"
        for x in a:
            c.state.say("area_order", (x,), tuple(i for i in b if i != x), e, 1.0 / value if value < 1.0 else value)
        c.deny()
    c.factor, c.latest, c.run = None, right, []
    return max(j, k + 1)


# where rooms lie: storeys and wings


def level(c: Clause, k: int, e: Element) -> None:
    """Put rooms on a storey: those named before it, or, where it comes first, those that follow."""
    c.state.levels.append(e)
    ahead = c.near(k + 1)
    part = c.part(k)
    closes = c.forward and part and (ahead is None or ahead.kind == "comma")  # "upstairs two bedrooms, the kitchen downstairs"
    if not closes and (c.forward or heads(c.sentence, k) or ("*" in c.latest and ahead is not None and ahead.kind == "colon")):
        c.state.heights |= {"*": int(e.value)} if "*" in c.latest and not c.forward else {}
        c.forward, c.level, c.run = True, int(e.value), []
        return
    owners = c.subject if c.objects and c.latest == c.objects else ()  # "a guest room with bath, downstairs"
    for room in map(c.stock.get, named_rooms(part if closes else (*c.latest, *owners))):
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
