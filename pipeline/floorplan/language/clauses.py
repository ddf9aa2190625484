"""What the cues of a sentence say about the rooms around them: joined, open, near, apart, owned, avoided, larger."""

from __future__ import annotations

from dataclasses import replace

from pipeline.floorplan.language.facts import ROLES, SOCIAL, Clause, Fact, Group
from pipeline.floorplan.language.introductions import backward
from pipeline.floorplan.language.naming import fresh, name, point
from pipeline.floorplan.language.objects import objects
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.pronouns import attach, belongs, cast, determiner, every, flag, pronoun
from pipeline.floorplan.language.relating import SINGULAR, relate
from pipeline.floorplan.language.remarks import close, level, merge, no_door, storey, wing, written_as_one, zone
from pipeline.floorplan.language.ways import compare, entered, factor, listing, superlative

ELSEWHERE = {
    "level": level,
    "wing": wing,
    "zone": zone,
    "cue": relate,
    "factor": factor,
    "cmp": compare,
    "pron": pronoun,
    "det": determiner,
    "flag": flag,
    "every": every,
}  # what other modules read, by kind of element


def _known(fact: Fact) -> bool:
    """Whether a fact is about rooms, not about zones or all of them."""
    return not any(i.startswith(("*", "<")) for i in (*fact.a, *fact.b))


DENIED = {"door": "not_connected", "leads": "not_connected", "open": "not_open", "near": "ban", "wall": "ban"}  # what "does not" means


class Sentence(Clause):
    """Reads one sentence from left to right."""

    def read(self) -> None:
        """Read all elements."""
        no_door(self)
        k = 0
        while k < len(self.sentence):
            e = self.sentence[k]
            if e.kind in ELSEWHERE:
                k = ELSEWHERE[e.kind](self, k, e)
                continue
            handler = getattr(self, f"_{e.kind}", None)
            k = handler(k, e) if handler else k + 1
        if self.waiting:
            self._complete()
        close(self)
        self.state.topic = tuple(i for i in self.subject if not i.startswith("*")) or self.state.topic
        said = [tuple(e.ids) for e in self.sentence if e.ids and e.kind == "np"]
        self.state.past = [*self.state.past, *said][-12:]

    # one method per kind of element; each returns where reading goes on

    def _np(self, k: int, e: Element) -> int:  # noqa: PLR0912 - one branch per case: a grammar
        if e.banned:
            self._ban(e)
            return k + 1
        self.state.understood(e.first, e.last)
        before = self.sentence[k - 1] if k else None
        if (
            before is not None
            and before.kind == "pron"
            and before.value == "one"
            and before.ids
            and e.role
            and not e.ids
            and e.type == "bedroom"
        ):
            cast(self, before, e.role)  # "four bedrooms, one of them the guest room"
            e.ids = before.ids
        if e.role == "ensuite" and e.type == "bathroom" and not e.ids and self._predicate(k, e):
            self.state.say("ensuite", (), self.latest, e)
            return k + 1
        if (
            self.owner
            and not e.ids
            and ("own" in e.det or (self.owning and self.run and not e.det))
            and e.type in {"bedroom", "bathroom", "kitchen"}
        ):
            level = storey(self, k)
            ids = tuple(fresh(self.state, e, backward(self.sentence, k, None) if level is None else level, self.owner))
        else:
            ids = tuple(name(self.state, self.sentence, k, storey(self, k)))
        if self.left_out and e.det & {"each", "all"} and set(ids) > set(self.left_out):
            ids = tuple(i for i in ids if i not in self.left_out)
            e.ids = list(ids)
        self._own(e, ids)
        self._measure(e, ids)
        self.push(k, e, ids)
        if e.adjectives & {"open", "combined"} and "closed_plan" not in self.state.flags:
            merge(self, k, e)
        elif e.type in SOCIAL and (j := written_as_one(self, k, e)):
            self.state.say("merge", (*ids, *name(self.state, self.sentence, j, storey(self, k))), (), e)
        if "closed" in e.adjectives and e.type == "kitchen":
            self.state.say("closed", ids, (), e)
        if e.suite:
            self.state.say("suite", ids, (), e)
        if e.adjectives & {"largest", "smallest"} and not self.factor:
            others = tuple(r.id for r in self.stock.of(e.type))
            self.state.say("largest" if "largest" in e.adjectives else "smallest", ids, others, e)
        if "smaller" in e.adjectives:
            rest = tuple(r.id for r in self.stock.of(e.type) if r.id not in ids)
            self.state.say("area_order", rest[:1], ids, e, 1.0)
        if "equal" in e.adjectives and len(ids) > 1:
            self.state.say("area_equal", ids, (), e, 0.15)
        return k + 1

    def push(self, k: int, e: Element, ids: Group) -> None:
        """Take a group into the list in front of the next cue."""
        before = next((x for x in reversed(self.sentence[:k]) if x.kind not in {"det", "size", "adj"}), None)
        if (
            before is None
            or before.kind not in {"comma", "and", "or", "np", "amount", "open", "close", "colon"}
            or not self.run
            or before.kind == "colon"
        ):
            self.run = []
            self.verb = self.single = False
        elif self.objects and {i for x in self.run for i in x.ids} == set(self.objects):
            self.run = []  # what was given to somebody is no part of a new list
        self.run.append(e)
        e.ids = list(ids)
        if self.wing is not None:
            self.wing[1].extend(ids)
        self.latest = ids
        if self.waiting and not set(ids) <= set(self.waiting[1]):
            self.subject = tuple(dict.fromkeys((*self.subject, *ids))) if self.subject else ids
        if not self.subject:
            self.subject = ids

    def _predicate(self, k: int, e: Element) -> bool:
        """Whether "en suite" is said of a bathroom or a bedroom just named: "one of them en suite"."""
        before = self.sentence[k - 1] if k else None
        return before is not None and before.kind in {"np", "pron"} and not e.det and e.number is None

    def _own(self, e: Element, ids: Group) -> None:
        """Read "grandparents with their own bedroom, bathroom and small kitchen": what follows in the list is theirs."""
        if not self.owner:
            return
        room = self.stock.get(ids[0])
        if room.type == "bedroom" and "own" in e.det:
            room.role = room.role or self.owner
            self.owning = room.id
        elif self.waiting is None and self.owning and room.type == "bathroom" and not room.role and not self.stock.owned(room.id):
            self.give(ids, (self.owning,), e)
        elif self.owning and room.type == "kitchen":
            room.role = self.stock.get(self.owning).role
            self.state.say("door", ids, (self.owning,), e)

    def _measure(self, e: Element, ids: Group) -> None:
        for mark in e.amounts:
            whole = (e.compound and mark.last <= e.first) or belongs(self.state, self.sentence, e, mark)
            self.state.understood(mark.first, mark.last)
            self.state.amounts.append((mark, None if whole else ids))

    def _ban(self, e: Element) -> None:
        self.state.understood(e.first, e.last)
        if e.role == "ensuite":
            self.state.say("no_ensuite", tuple(r.id for r in self.stock.of("bathroom")) or ("*bathroom",), (), e)
        elif e.type == "kitchen" and e.mark is not None and "/" in e.mark.value:
            return  # "no kitchen-diner" leaves a kitchen
        elif not (e.type == "bedroom" and e.role):  # "no guest room" leaves the other bedrooms
            self.state.banned.append((e.type, e))

    def _home(self, k: int, e: Element) -> int:
        self.state.understood(e.first, e.last)
        self.state.homes.append(e)
        if e.value and self.state.studio is None:
            self.state.studio = e
        for mark in e.amounts:
            attach(self.state, self.sentence, k, mark, (), home=True)
        self.run = []
        return k + 1

    def _amount(self, k: int, e: Element) -> int:
        if e.mark is not None:
            attach(self.state, self.sentence, k, e.mark, self.latest)
        return k + 1

    def _owner(self, k: int, e: Element) -> int:
        self.state.understood(e.first, e.last)
        before = self.sentence[k - 1] if k else None
        if before is not None and before.kind == "pron" and before.value == "one" and before.ids:
            cast(self, before, e.value)
        self.owner, self.owning = e.value, ""
        return k + 1

    def _verb(self, k: int, e: Element) -> int:
        before = next((x for x in reversed(self.sentence[:k]) if x.kind not in {"word", "ignored", "flag"}), None)
        if before is not None and before.kind in {"and", "comma"} and self.subject and self.objects:
            self.run = []  # "the bedroom has a bath and is ...": the subject goes on
        self.verb = True
        self.single = e.text in SINGULAR
        return k + 1

    def _relative(self, k: int, e: Element) -> int:
        self.relative = e.text not in {"where", "wo", "donde"}
        self.state.understood(e.first, e.last)
        return k + 1

    def _neg(self, k: int, e: Element) -> int:
        ahead = self.sentence[k + 1] if k + 1 < len(self.sentence) else None
        if ahead is not None and ahead.kind == "to" and self.way is not None and self.way.what in DENIED and _known(self.way):
            group, j = self.after(k + 2, "leads", self.way.a)  # "has access to the terrace but not to the living room"
            if group:
                self.state.say(DENIED[self.way.what], self.way.a, group, e)
                return j
        ends = k + 1 >= len(self.sentence) or self.sentence[k + 1].kind in {"comma", "but", "close"}
        said = self.state.facts[-1] if self.state.facts else None
        rooms = tuple(i for x in self.run for i in x.ids if not i.startswith("*"))
        if ends and said is not None and rooms and said.what in DENIED and not set(rooms) & {*said.a, *said.b} and _known(said):
            of = said.b if {self.stock.get(i).type for i in said.b} != {self.stock.get(i).type for i in rooms} else said.a
            self.state.say(DENIED[said.what], rooms, of, e)  # "the bedrooms open onto the hall, the kitchen however does not"
            return k + 1
        self.negative = e
        return k + 1

    def _comma(self, k: int, _: Element) -> int:
        ahead = self.sentence[k + 1].kind if k + 1 < len(self.sentence) else ""
        if self.negative is not self.sentence[k - 1] and ahead not in {"cue", "cmp", "or", "neg"}:
            self.negative = None
        if self.waiting and listing(self, k):
            return k + 1  # "on both sides of the corridor lie two bedrooms, the kitchen and the bath"
        if self.waiting and self.subject and self.waiting[0].value != "from" and (self.verb or self.waiting[0].value == "between"):
            self._complete()
        return k + 1

    def _and(self, k: int, _: Element) -> int:
        ahead = [x.kind for x in self.sentence[k + 1 : k + 3]]
        if ahead[:1] == ["verb"] or ahead == ["np", "verb"]:
            self.negative = None  # "must not be open and should have a door to the hall"
        return k + 1

    def _but(self, k: int, _: Element) -> int:
        self.negative = None  # "not open, but next to the dining room"
        return k + 1

    def _no_bath(self, k: int, e: Element) -> int:
        rooms = tuple(name(self.state, self.sentence, k + 1, storey(self, k + 1)))
        self.state.say("no_ensuite", ("*bathroom",), rooms, e)
        return k + 2

    def _no_own(self, k: int, e: Element) -> int:
        rooms = tuple(i for i in (self.subject or self.latest) if not i.startswith("*") and self.stock.get(i).type == "bedroom")
        self.state.say("no_ensuite", ("*bathroom",), rooms, e)
        return k + 1

    def _adj(self, k: int, e: Element) -> int:
        before = self.sentence[k - 1] if k else None
        if before is not None and before.kind == "pron" and before.value == "one" and e.value in ROLES:
            cast(self, before, e.value)  # "four bedrooms, uno de ellos para invitados"
        if e.value == "equal" and before is not None and before.kind in {"det", "verb", "pron"} and len(self.latest) > 1:
            self.state.say("area_equal", self.latest, (), e, 0.15)
        social = tuple(i for x in self.run for i in x.ids if x.type in SOCIAL)
        alone = len(social) == sum(len(x.ids) for x in self.run)
        joined = before is not None and (before.kind in {"np", "reciprocal", "open"} or (before.kind == "verb" and alone))
        if e.value in {"open", "combined"} and len(social) > 1 and joined and not self.negated(k):
            self.state.say("merge", social, (), e)  # "living and dining room open"
        elif e.value == "open" and self.negative is not None and len(social) == 1 and self.stock.get(social[0]).type == "kitchen":
            self.state.say("closed", social, (), e)  # "the kitchen should not be open"
            self.negative = None
        ends = k + 1 >= len(self.sentence) or self.sentence[k + 1].kind in {"comma", "and"}
        if self.verb or (before is not None and before.kind == "np" and ends):  # "客厅最大"
            superlative(self, e)
        return k + 1

    def point(self, e: Element, k: int, but: Group) -> Group:
        """Return the rooms that a pronoun stands for: after "but" the subject still, as an object what is not the subject `but`."""
        same = self.subject if e.value == "it" and k and self.sentence[k - 1].kind == "but" else ()
        return same or point(self.state, self.sentence[:k], e, but)

    def _enter(self, k: int, e: Element) -> int:
        if self.run and k and self.sentence[k - 1].kind == "np" and e.text.startswith("se "):  # "al baño se entra por el pasillo"
            return relate(self, k, replace(e, kind="cue", value="door"))
        start = k + 1
        ahead = self.sentence[start : start + 3]
        if (
            len(ahead) > 1
            and (ahead[0].kind, ahead[0].value) in {("pron", "it"), ("pron", "group"), ("home", "")}
            and ahead[1].kind == "cue"
        ):
            start += 2  # "you enter it through the hall"
        group, j = self.after(start, "enter", ())
        if not group and self.latest:
            group, j = self.latest, k + 1
        if after := entered(self, j, e, group):
            return after
        if group and not group[0].startswith(("*", "<")):
            self.state.understood(e.first, e.last)
            self.state.entrance = (group[0], e)
            self.subject = self.latest = group
            self.run = []
            self.waiting = None
        return max(j, k + 1)

    def _outside(self, k: int, e: Element) -> int:
        self.state.understood(e.first, e.last)
        here = [
            i for i in (*self.latest, *self.subject) if not i.startswith("*") and self.stock.get(i).type not in {"bathroom", "wc", "closet"}
        ]
        self.state.outside = (self.owning or next(iter(here), ""), e)
        return k + 1

    def _via(self, k: int, e: Element) -> int:
        """Read "the only way into the bathroom is through the bedroom"."""
        things, j = self.after(k + 1, "via", ())
        hosts, j = self.after(j, "via", things)
        if things and hosts:
            self.state.say("door", things, hosts, e)
            self.state.say("only", things, (), e)
        return max(j, k + 1)

    def _complete(self) -> None:
        """Give a cue that stood in front of its subject what followed."""
        assert self.waiting is not None
        cue, group = self.waiting
        self.waiting = None
        rooms = tuple(i for i in self.subject if i not in group)
        if cue.value == "ensuite" and not rooms:  # "an en suite to the bedroom": the cue itself is the room
            bath = Element("np", "", cue.first, cue.last, cue.text, type="bathroom", role="ensuite")
            rooms = tuple(fresh(self.state, bath, None, ""))
            self.give(rooms, group, cue)
        elif rooms and cue.value == "ensuite":
            self.give(rooms, group, cue)  # "dem Schlafzimmer ist ein Bad zugeordnet"
        elif rooms:
            if self.negative:
                self.state.say("ban" if cue.value in {"near", "wall"} else "not_connected", rooms, group, cue)
            else:
                self.state.say("door" if cue.value == "from" else cue.value, rooms, group, cue)
                if self.only or cue.only:
                    self.state.say("only", rooms, (), cue)

    def after(self, k: int, cue: str, left: Group) -> tuple[Group, int]:
        """Return the rooms named after a cue, and where reading goes on."""
        return objects(self, k, cue, left)
