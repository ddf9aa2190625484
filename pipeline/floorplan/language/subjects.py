"""Who stands in front of a cue: the phrase, the list, or what the clause is about."""

from __future__ import annotations

from collections.abc import Iterable

from pipeline.floorplan.language.clause import Clause
from pipeline.floorplan.language.facts import Group
from pipeline.floorplan.language.phrases import Element

WITH = {"con", "with", "mit"}
THROUGH = {"through", "via", "durch", "ueber", "por", "traves", "经", "过", "通"}
FINITE = {
    "come",
    "branch",
    "hang",
    "gehen",
    "liegen",
    "fuehren",
    "grenzen",
    "muenden",
    "haengen",
    "zweigen",
    "oeffnen",
    "schliessen",
    "abren",
    "dan",
    "salen",
    "open",
    "lead",
    "connect",
    "conectan",
    "comunican",
    "desembocan",
    "llevan",
    "conducen",
    "give",
    "parten",
    "erreicht",
    "gruppieren",
    "betritt",
}
HAVING = {"haben", "have", "tienen", "cuentan"}


def subject_of(clause: Clause, k: int, e: Element) -> Group:  # noqa: C901, PLR0911, PLR0912 - one branch per case: a grammar
    """Return the subject of a cue: the phrase in front, the list in front of a verb, or what the clause is about."""
    before = clause.sentence[k - 1] if k else None
    if not clause.run:
        cue = next((x for x in reversed(clause.sentence[:k]) if x.kind == "cue"), None)
        passed = before is not None and before.kind == "np" and cue is not None and bool(THROUGH & set(cue.text.split()))
        if passed and clause.objects and e.value in {"door", "leads"} and e.text.split()[0] not in THROUGH:
            return clause.objects  # "the garage is connected by way of the utility room to the kitchen"
        if clause.relative and clause.objects and "verb_last" not in clause.state.heard.lexicon.traits:
            return clause.objects  # "away from the parents' bedroom, which is next to ..."
        chained = before is not None and before.kind == "np" and cue is not None and cue.value == e.value == "near"
        return clause.objects if chained and clause.objects and not clause.relative else clause.subject  # "X next to Y next to Z"
    if (
        before is not None
        and before.kind in {"comma", "and"}
        and clause.objects
        and set(clause.objects) == {i for x in clause.run for i in x.ids}
        and not _named_again(clause, k)
    ):
        return clause.subject  # "a guest room with its own bath, away from ..."
    if before is not None and before.kind == "open":
        return tuple(clause.run[-1].ids)  # "a garage (joined to the hall)"
    apart = before is not None and before.kind == "comma" and len(clause.run) > 1
    last = clause.run[-1]
    if clause.relative or (apart and not clause.verb):
        return tuple(last.ids)
    if e.value == "avoid" and clause.objects:
        return clause.subject
    if e.text.split()[0] in WITH and e.value in {"door", "leads"} and not last.plural:
        return tuple(last.ids)  # "a kitchen and a living room with access to the terrace"
    if clause.single and len(clause.run) > 1 and {x.type for x in clause.run[:-1]} and not last.plural:
        return tuple(last.ids)  # "there is a living room, and the kitchen is open to it"
    verbal = (
        clause.verb
        or e.value in {"leads", "away", "apart"}
        or e.text.removeprefix("se ").split()[0] in FINITE
        or any(x.text in FINITE | HAVING for x in clause.sentence[_place(clause, last) + 1 : k])
        or any(x.det & {"both", "all"} for x in clause.run)
    )
    if not coordinate(clause):  # "study downstairs, all bedrooms upstairs, garage connected to ...": commas part statements
        return tuple(last.ids)
    heads = [x for x in clause.run if x.first == last.first and x.last == last.last]
    if len(heads) == len(clause.run) > 1 and e.value in {"door", "leads", "near"}:
        return tuple(clause.run[0].ids)  # "a living-dining-kitchen with access to the terrace": one room to whoever goes there
    if verbal or e.value == "wall":
        return ids_of(clause.run)
    if e.value != "door":
        return tuple(last.ids)
    tail = [last]
    for a, b in zip(reversed(clause.run[:-1]), reversed(clause.run[1:]), strict=True):
        between = clause.sentence[_place(clause, a) + 1 : _place(clause, b)]
        if any(x.kind == "comma" for x in between) or not any(x.kind == "and" for x in between):
            break
        tail.insert(0, a)
    return ids_of(tail)


def listed(clause: Clause) -> Group:
    """Return the rooms in front of a comparison: the last phrase, with those that an "and" joins to it."""
    return ids_of(clause.run if coordinate(clause) else clause.run[-1:])


def coordinate(clause: Clause) -> bool:
    """Whether the last two phrases in front of a cue are joined by more than a comma; one alone is."""
    ends = [_place(clause, x) for x in clause.run[-2:]]
    return len(ends) < 2 or any(x.kind in {"and", "or"} for x in clause.sentence[ends[0] : ends[1]])


def ids_of(phrases: Iterable[Element]) -> Group:
    """Return the rooms of phrases, each once."""
    return tuple(dict.fromkeys(i for x in phrases for i in x.ids))


def _place(clause: Clause, e: Element) -> int:
    return next((i for i, x in enumerate(clause.sentence) if x is e), 0)


def _named_again(clause: Clause, k: int) -> bool:
    """Whether what was said of last is named once more: "A adjoins B, and B, of 16 m², adjoins C"."""
    place = _place(clause, clause.run[-1])
    cue = max((i for i, x in enumerate(clause.sentence[:k]) if x.kind == "cue"), default=0)
    return any(x.kind in {"and", "comma"} for x in clause.sentence[cue + 1 : place])
