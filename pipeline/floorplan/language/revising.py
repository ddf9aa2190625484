"""What a prompt rules out. Counts that it takes back ("one bedroom, no, make that two") are frames."""

from __future__ import annotations

from collections.abc import Sequence

from pipeline.floorplan.language.marks import HEADS, Mark, Words
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.text import spread
from pipeline.floorplan.program.consistency import ImpossibleError
from pipeline.floorplan.program.floor_program import Evidence

CONFLICTS = {
    "homes": ("{} homes are asked for", "ask for one home at a time"),
    "conflict": ("two counts are asked for: {!r}", "keep one of them"),
}
RELATIONS = {"near", "door", "open", "wall", "away", "apart", "leads", "between"}
NAMES = {"bedroom", "living_room", "kitchen"}  # what a home has, not a room that is ruled out


def refuse(marks: Sequence[Mark], words: Words) -> None:
    """Refuse several homes, two counts of one thing, and amounts that nothing has: "-3 bedrooms", "0 m2", "no rooms"."""
    named = any(m.kind in HEADS for m in marks)
    for k, mark in enumerate(marks):
        place = words.tokens[mark.first].start if mark.first < len(words.tokens) else 0
        minus = mark.kind in {"num", "amount"} and place > 1 and words.prompt[place - 1] in "-−" and words.prompt[place - 2] == " "
        lead = k and marks[k - 1].kind in {"cue", "fill", "bound", "of", "det", "verb"}
        none = mark.kind == "amount" and not mark.number and mark.value in {"area", "rooms"}
        empty = (mark.kind, mark.value) == ("unit", "rooms") and k and marks[k - 1].kind == "neg" and not named
        if mark.kind in CONFLICTS or (minus and lead) or none or empty:
            start, end = spread(words.tokens[marks[k - 1 if empty else k].first : max(mark.last, mark.first + 1)])
            evidence = Evidence(start=start, end=end, text=words.prompt[start:end], field="rooms")
            what, advice = CONFLICTS.get(mark.kind, ("no home has {!r}", "ask for numbers above zero"))
            said = f"{mark.number:g}" if mark.kind == "homes" else ("-" if minus else "") + evidence.text
            raise ImpossibleError(what.format(said), advice, [evidence])


def ban(sentence: list[Element]) -> None:
    """Mark the noun phrases that are ruled out."""
    for k, e in enumerate(sentence):
        if e.kind == "neg":
            j = _target(sentence, k + 1)
            if j is not None:
                _negate(sentence, k, j)
                continue
            _any(sentence, k)
            if k + 1 == len(sentence) or sentence[k + 1].kind in {"comma", "close", "but"}:
                _behind(sentence, k)


def _negate(sentence: list[Element], k: int, j: int) -> None:
    """Apply the negation at k to the phrase at j."""
    e, phrase = sentence[k], sentence[j]
    if _relation_follows(sentence, j):
        _any(sentence, k)  # "no kitchen next to the bedroom"
    elif not phrase.definite or e.removes:
        e.kind = "used"
        _list(sentence, j)


def _target(sentence: list[Element], k: int) -> int | None:
    """Return the noun phrase that a negation in front of k rules out; None where it turns a relation or says nothing of rooms."""
    for j, e in enumerate(sentence[k:], k):
        if e.kind == "np":
            return None if e.number is not None and any(x.kind == "colon" for x in sentence[k:j]) else j
        colon = e.kind == "colon" and all(x.kind in {"verb", "word"} for x in sentence[k:j])  # "not needed: balcony, garage"
        if e.kind not in {"verb", "adj", "det", "owner", "size", "word", "relative"} and not colon and (e.kind, e.value) != ("cue", "has"):
            return None
    return None


def _any(sentence: list[Element], k: int) -> None:
    """Let "a bedroom" behind a negated relation mean any bedroom, not a new one: "must not be reached through a bedroom"."""
    cue = False
    for e in sentence[k + 1 :]:
        if e.kind in {"comma", "but"}:
            return
        cue = cue or (e.kind == "cue" and e.value in RELATIONS)
        if cue and e.kind == "np" and "indefinite" in e.det and e.number is None:
            e.det = {"all"}


def _behind(sentence: list[Element], k: int) -> None:
    """Mark what a negation behind it rules out: "Kinderzimmer gibt es keine", "balcony: no"; not what it says of a room that is counted."""
    e = next((x for x in reversed(sentence[:k]) if x.kind not in {"verb", "colon", "det", "word"}), None)
    if e is not None and e.kind == "np":
        e.banned = e.number is None and not e.definite and not e.amounts
        sentence[k].kind = "used" if e.banned else "neg"


def _relation_follows(sentence: list[Element], j: int) -> bool:
    """Whether a relation follows at once, which is what is negated."""
    e = next((x for x in sentence[j + 1 :] if x.kind != "verb"), None)
    return e is not None and e.kind == "cue" and e.value in RELATIONS


def _list(sentence: list[Element], j: int) -> None:
    """Mark a list under one negation: "no balcony, garage or cellar"."""
    sentence[j].banned = True
    joined = ""
    titled = next((x.kind for x in reversed(sentence[:j]) if x.kind in {"colon", "neg", "used"}), "") == "colon"
    for i in range(j + 1, len(sentence)):
        e = sentence[i]
        if e.kind in {"comma", "and", "or"}:
            joined = e.kind if joined != "or" else joined
            continue
        if e.kind != "np" or not joined or e.number is not None or e.amounts or e.definite or e.det & {"own", "another"}:
            return
        if (joined == "and" and "indefinite" in e.det) or e.adjectives & {"open", "combined"}:
            return  # "no balcony and a garage"
        rest = next((x for x in sentence[i + 1 :] if x.kind not in {"np", "comma", "det"}), None)
        if joined == "comma" and not titled and (rest is None or rest.kind != "or"):
            return
        statement = sentence[i + 1] if i + 1 < len(sentence) and sentence[i + 1].kind in {"cue", "verb", "neg"} and joined != "or" else None
        had = next((x for x in sentence[i + 1 :] if x.kind == "np"), None)
        if statement is not None and not (statement.value == "has" and had is not None and had.type in NAMES):
            return  # it has a statement of its own, unless it is the home that has what follows
        e.banned, joined = True, ""
