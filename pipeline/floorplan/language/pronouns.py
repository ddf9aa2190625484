"""What words that point say: "it", "both", "the other two", "all of them", "one of them for guests", "every room"."""

from __future__ import annotations

from pipeline.floorplan.language.clause import Clause
from pipeline.floorplan.language.facts import Group
from pipeline.floorplan.language.owning import one_each
from pipeline.floorplan.language.phrases import Element

ONE_THAT = {"in", "ensuite", "near", "door"}  # what tells the second of "one bathroom for guests and one inside the master"


def pronoun(clause: Clause, k: int, e: Element) -> int:
    """Read a pronoun: the rooms that it stands for are spoken of next."""
    ahead = next((x for x in clause.sentence[k + 1 :] if x.kind not in {"det", "verb"}), None)
    if e.value == "rest" and ahead is not None and ahead.kind in {"level", "colon"}:
        return every(clause, k, e)
    if e.text == "which" and k and clause.sentence[k - 1].kind == "comma" and clause.latest and not clause.latest[0].startswith("*"):
        clause.subject, clause.objects = clause.latest, ()  # "from the hall, which also gives access to ..."
        clause.run = [Element("np", "", e.first, e.last, e.text, ids=list(clause.latest))]
        return k + 1
    told = ahead is not None and (ahead.kind in {"owner", "level"} or (ahead.kind == "cue" and ahead.value in ONE_THAT))
    joined = k > 0 and clause.sentence[k - 1].kind in {"and", "comma"}
    like = clause.run[-1] if clause.run else None
    if e.value == "one" and told and joined and like is not None and like.kind == "np" and (like.number == 1.0 or "indefinite" in like.det):
        room = clause.stock.add(clause.stock.get(like.ids[0]).type, "", e.text, None)
        e.ids, clause.latest = [room.id], (room.id,)  # "one bathroom for guests and one inside the master"
        clause.run = clause.run if ahead is not None and ahead.kind == "level" else []
        clause.subject = (room.id,)
        clause.state.understood(e.first, e.last)
        return k + 1
    whole = e.value == "group" and e.text.split()[0] in {"todos", "todas", "all", "alle"} and len(clause.run) > 1
    group = (
        tuple(i for x in clause.run for i in x.ids)
        if whole
        else clause.point(e, k, clause.subject if e.value == "it" and (clause.objects or clause.run) else ())
    )
    spoken = [i for g in (clause.subject, *reversed(clause.state.past)) for i in g if not i.startswith("*")]
    bed = next((i for i in spoken if clause.stock.get(i).type == "bedroom"), None)
    if e.value == "rest" and bed is not None and (count := _others(clause, e)):
        group = _made(clause, bed, count)
    if e.value in {"group", "both"} and set(group) > set(clause.left_out):
        group = tuple(i for i in group if i not in clause.left_out)
    e.ids = list(group)
    if group:
        clause.state.understood(e.first, e.last)
        clause.run = [Element("np", "", e.first, e.last, e.text, ids=list(group))]
        clause.latest = group
        if e.value in {"one", "rest", "group", "both", "some"} or not clause.subject:
            clause.subject = group
    return k + 1


def _others(clause: Clause, e: Element) -> int:
    """Return how many "the other two" are."""
    lex = clause.state.heard.lexicon
    numbers = [m.number for w in e.text.split() if (m := lex.trie.get(w, {}).get("")) is not None and m.kind == "num"]
    return int(numbers[0]) if numbers else (2 if "beiden" in e.text else 0)


def _made(clause: Clause, like: str, count: int) -> Group:
    """Return so many rooms that nothing was said of, new ones where they are too few."""
    kind = clause.stock.get(like).type
    spoken = {i for x in clause.sentence for i in x.ids} | {i for g in clause.state.past[-1:] for i in g}
    free = [r for r in clause.stock.of(kind) if r.open_slot] or [r for r in clause.stock.of(kind) if r.id not in spoken]
    while len(free) < count:
        free.append(clause.stock.add(kind, "", "other", None))
    return tuple(r.id for r in free[:count])


def determiner(clause: Clause, k: int, e: Element) -> int:  # noqa: PLR0911 - one answer per case: a grammar
    """Read "both", "each", "all", "the other" where no room follows."""
    last = k + 1 >= len(clause.sentence) or clause.sentence[k + 1].kind in {"comma", "close"}
    if (
        (e.value == "each" or e.text in {"cada uno", "cada una"})
        and last
        and k
        and clause.sentence[k - 1].kind == "np"
        and len(clause.latest) == 1
    ):
        one_each(clause, e)
        return k + 1
    if e.value == "other" and next((x.kind for x in clause.sentence[k + 1 :] if x.kind != "verb"), "") in {"level", "colon"}:
        return every(clause, k, e)
    if e.value == "all" and k and clause.sentence[k - 1].kind == "every":
        return k + 1
    if e.value == "all" and clause.run[-1:] and clause.run[-1].det & {"all", "each"} and clause.sentence[k - 1] is clause.run[-1]:
        clause.run, clause.subject = clause.run[-1:], tuple(clause.run[-1].ids)  # "..., 所有卧室都从走廊进出"
        return k + 1
    if e.value == "all" and len(clause.run) > 1 and not any(x.kind == "np" for x in clause.sentence[k + 1 : k + 2]):
        clause.subject = clause.latest = tuple(
            dict.fromkeys(i for x in clause.run for i in x.ids)
        )  # "kitchen, two bedrooms, bath - all off the hall"
        clause.run = [Element("np", "", e.first, e.last, e.text, ids=list(clause.latest))]
        return k + 1
    ahead = clause.sentence[k + 1].kind if k + 1 < len(clause.sentence) else ""
    if e.value == "all" and not clause.run and clause.objects and k and clause.sentence[k - 1].kind == "comma" and ahead == "cue":
        both = tuple(dict.fromkeys((*clause.subject, *clause.objects)))  # "卫生间和厕所分开,都从走廊进"
        clause.subject = clause.latest = both
        clause.run = [Element("np", "", e.first, e.last, e.text, ids=list(both))]
        return k + 1
    if e.value == "other" and ahead in {"verb", "amount"}:  # "one bedroom of 16 m2, the other of 10"
        return pronoun(clause, k, Element("pron", "rest", e.first, e.last, e.text))
    if e.value in {"both", "each", "all"} and ahead != "np":
        return pronoun(clause, k, Element("pron", "both" if e.value == "both" else "group", e.first, e.last, e.text))
    return k + 1


def every(clause: Clause, k: int, e: Element) -> int:
    """Read "every room", "the rest": all rooms."""
    clause.state.understood(e.first, e.last)
    e.ids = ["*"]
    clause.push(k, e, ("*",))
    return k + 1


def cast(clause: Clause, who: Element, role: str) -> None:
    """Give rooms their user: bedrooms that have none yet."""
    for room in (clause.stock.get(i) for i in who.ids):
        room.role = room.role or (role if room.type == "bedroom" else "")
