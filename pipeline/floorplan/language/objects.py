"""Which rooms stand behind a cue, and where the list of them ends."""

from __future__ import annotations

from pipeline.floorplan.language.clause import Clause
from pipeline.floorplan.language.facts import HALLS, SOCIAL, Group
from pipeline.floorplan.language.naming import name
from pipeline.floorplan.language.openness import written_as_one
from pipeline.floorplan.language.owning import FINITE, measures
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.places import zone

CLOSED = {"balcony", "garage", "bathroom", "wc", "closet", "storage", "utility", "bedroom"}
CONNECTS = {"connect", "connects", "connecting", "links", "linking", "joins", "joining", "une", "conecta", "comunica", "verbindet"}
WIDE = {"leads", "between", "chain", "avoid", "except"}


def objects(clause: Clause, k: int, cue: str, left: Group) -> tuple[Group, int]:  # noqa: C901, PLR0912, PLR0915 - one branch per kind of element: a grammar
    """Return the rooms named after a cue, and where reading goes on."""
    group: list[str] = []
    sentence = clause.sentence
    index = end = k
    joined = ""
    first: Element | None = None
    last: Element | None = None
    while index < len(sentence):
        e = sentence[index]
        if e.kind == "np":
            comma = any(x.kind == "comma" for x in sentence[index - 3 : index])
            clausal = cue == "cmp" and joined and ((comma and bool(e.amounts)) or "equal" in e.adjectives)
            pair = cue == "between" and joined == "and" and len(group) == 1
            again = e.ids or (
                first is not None and e.definite and not e.plural and (e.type, e.text, e.role) == (first.type, first.text, first.role)
            )
            if (
                e.banned
                or (group and joined and again and first is not None and not first.plural and first.type == e.type)  # "A by B, and B by C"
                or (group and (not joined or clausal))
                or (group and first is not None and not pair and not _continues(clause, index, cue, joined, first))
            ):
                break
            private = {clause.stock.get(i).type for i in left if not i.startswith("*")} == {"bedroom"}
            if private and cue == "leads" and joined == "comma" and e.type in SOCIAL:
                break  # a bedroom leads to its bath, and the list of rooms goes on
            ids = name(clause.state, sentence, index, clause.level if clause.forward else None)
            clause.state.understood(e.first, e.last)
            measures(clause, e)
            if e.adjectives & {"largest"} and cue != "cmp":
                clause.state.say("largest", tuple(ids), tuple(r.id for r in clause.stock.of(e.type)), e)
            group += [i for i in ids if i not in group and i not in left]
            if e.type in SOCIAL and (j := written_as_one(clause, index, e)):  # "around a kitchen-living room"
                clause.state.say("merge", (*ids, *name(clause.state, sentence, j, None)), (), e)
            first, last, joined, end = first or e, e, "", index + 1
        elif (
            e.kind in {"pron", "det"}
            and not group
            and e.value in {"it", "both", "group", "one", "rest", "some", "each", "all", "self", "pair"}
        ):
            if e.kind == "det" and any(x.kind == "np" for x in sentence[index + 1 : index + 2]):
                index += 1
                continue
            if e.value == "self":
                clause.state.say("itself", left, (), e)
                return (), index + 1
            found = clause.point(e, index, left)
            clause.state.understood(e.first, e.last)
            return tuple(i for i in found if i not in left), index + 1
        elif e.kind == "owner" and not group and not any(x.kind in {"np", "word"} for x in sentence[index + 1 : index + 2]):
            return _theirs(clause, e, left), index + 1
        elif e.kind == "zone" and not group:
            zone(clause, index, e)
            return tuple(e.ids), index + 1
        elif e.kind == "every" and not group:
            clause.state.understood(e.first, e.last)
            return ("*",), index + 1
        elif (
            e.kind == "cue"
            and e.value in {"in", "leads"}
            and joined
            and cue in WIDE
            and not (joined == "comma" and (clause.relative or clause.negative is not None))
        ) or (group and (e.value == "has" or e.kind == "to") and cue == "leads" and CONNECTS & set(sentence[k - 1].text.split())):
            joined = joined or "and"  # "connects the kitchen with the garage"
        elif e.kind == "wing" and cue == "leads" and group:
            clause.state.understood(e.first, e.last)
        elif e.kind == "flag" and not group and any(x.kind == "np" for x in sentence[index + 1 : index + 3]):
            clause.state.understood(e.first, e.last)  # "next to a step-free bathroom"
            clause.state.flags.setdefault(e.value, e)
        elif e.kind in {"comma", "and", "or"}:
            if not group and e.kind == "comma":
                break
            joined = "and" if e.kind in {"and", "or"} else (joined or "comma")
        elif (
            e.kind in {"det", "size", "adj", "verb", "word", "owner", "open", "to", "relative"}
            and not (e.kind == "to" and group and not joined)
            and not (e.kind in {"verb", "open"} and group)
        ) or (e.kind == "colon" and not group and cue == "leads"):
            pass
        elif e.kind == "open" and group and [x.kind for x in sentence[index + 1 : index + 3]] == ["amount", "close"] and last is not None:
            last.amounts += [x.mark for x in sentence[index + 1 : index + 2] if x.mark is not None]  # "the kitchen (9 m2), the bath (5 m2)"
            measures(clause, last)
            index += 2
        elif e.kind == "amount" and group and sentence[index - 1].kind == "np":
            break
        else:
            break
        index += 1
    return tuple(group), end


def _theirs(clause: Clause, owner: Element, left: Group) -> Group:
    """Return the bedroom of those who are named alone: "next to the parents'", "junto al de los padres"."""
    found = [r.id for r in clause.stock.of("bedroom") if r.role == owner.value and r.id not in left]
    clause.state.understood(owner.first, owner.last)
    owner.ids = found or [clause.stock.add("bedroom", owner.value, owner.text, None).id]
    return tuple(owner.ids)


def _denies(sentence: list[Element], but: Element) -> bool:
    """Whether "however does not" ends the sentence: what stands in front of it is its subject."""
    k = next(i for i, x in enumerate(sentence) if x is but)
    rest = [x.kind for x in sentence[k + 1 :] if x.kind not in {"verb", "word"}]
    return rest[:1] == ["neg"] and rest[1:2] in ([], ["comma"])


def _ends_list(sentence: list[Element], k: int) -> bool:
    """Whether what stands from k on is the end of a list of known rooms: "..., the kitchen and the bath"."""
    rest = sentence[k:]
    rooms = [x for x in rest if x.kind == "np"]
    plain = all(x.kind in {"np", "det", "adj", "size", "comma", "and"} for x in rest)
    return plain and all(x.definite and not x.banned for x in rooms) and len(rooms) > 1 and any(x.kind == "and" for x in rest)


def _continues(clause: Clause, index: int, cue: str, joined: str, first: Element) -> bool:  # noqa: PLR0911 - one answer per case: a grammar
    """Whether a list after a cue goes on with the phrase at index, or a new statement begins there."""
    e, sentence = clause.sentence[index], clause.sentence
    if cue == "open" and e.type in CLOSED and not e.definite:
        return False  # "a kitchen open to the living room and a terrace": nothing stands open to these
    ahead = next((x for x in sentence[index + 1 :] if x.kind not in {"det", "amount", "adj", "flag", "word"}), None)
    starts = ahead is not None and (
        ahead.kind in {"verb", "cmp", "neg", "relative", "factor"}
        or (ahead.kind == "but" and _denies(sentence, ahead))
        or (ahead.kind == "cue" and ahead.value != "except" and (ahead.value != "has" or ahead.text in FINITE) and cue != "avoid")
    )
    if starts and not (ahead is not None and ahead.kind == "relative"):
        return False
    many = any(clause.stock.get(i).type in HALLS for i in (clause.latest or clause.subject) if not i.startswith("*"))
    if clause.relative and cue == "leads" and joined == "comma" and e.introduces and first.definite and not many:
        return False  # "a living room that opens to the kitchen, one bedroom and one bath"
    if (
        cue in {"leads", "chain"}
        and joined == "comma"
        and e.number is not None
        and first.number is None
        and not any(x.kind == "and" for x in sentence[index:])
    ):
        return False
    if cue in WIDE:
        return not (cue == "between" and joined == "comma")
    if joined == "comma":
        return cue == "door" and first.definite and e.definite and _ends_list(sentence, index)
    new = bool(e.det & {"indefinite", "another"}) or e.number is not None
    if cue in {"door", "near", "open", "wall", "from", "ensuite", "cmp", "via"} and new and not e.definite:
        return bool(first.det & {"indefinite"}) and cue == "near"
    return not (e.definite != first.definite and not e.definite and cue != "open")
