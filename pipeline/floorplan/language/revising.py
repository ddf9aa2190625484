"""What a prompt takes back or leaves open: "one bedroom, no, make that two", "four, but three are enough", "a study or a guest room"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from pipeline.floorplan.language.text import spread
from pipeline.floorplan.language.tokens import ENDS, Mark, Words
from pipeline.floorplan.program.consistency import ImpossibleError
from pipeline.floorplan.program.floor_program import Evidence

LIGHT = {"fill", "adverb", "comma", "det", "hyphen", "dash", "bound", "verb", "adj", "colon", "word", "open", "close", "bullet", "but"}
INNER = {"adj", "size", "clf", "adverb", "look", "fill"}  # may stand between a number and its room
NAMED = {"room", "suite", "home"}
CHOICE = {"num", "det", "adj", "size", "clf", "times"}


@dataclass(slots=True)
class Revised:
    """The marks that hold, and the words that were left aside: the second of two rooms of which one is wanted."""

    marks: list[Mark]
    aside: list[Mark] = field(default_factory=list)


def revise(marks: Sequence[Mark], heard: Words) -> Revised:
    """Return the marks with corrections carried out and of every "A or B" the first.

    Raises ImpossibleError where two counts contradict each other ("three bedrooms but only two"), with both.
    """
    _negative(marks, heard)
    made = _corrected(list(_told(marks, heard)))
    _contradicted(made, heard)
    return _chosen(_few(made))


def _told(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Tell "Balkon: nein" from a correction."""
    made = list(marks)
    for k, mark in enumerate(made):
        between = k and k + 1 < len(made) and made[k - 1].kind == made[k + 1].kind == "room"
        nope = mark.kind in {"fix", "fill", "word"} and mark.text in heard.lexicon.sign("nope") and k and made[k - 1].kind == "colon"
        if nope or (mark.kind == "fix" and between and mark.text in heard.lexicon.sign("not_towards")):  # 不对 between two rooms
            made[k] = replace(mark, kind="neg")
    return made


def _counted(marks: Sequence[Mark], k: int) -> int | None:
    """Return the place of the room that the number at k counts; in front of it or, as in Chinese, behind."""
    if marks[k].kind != "num":
        return None
    j = next((j for j in range(k + 1, len(marks)) if marks[j].kind not in INNER), len(marks))
    if j < len(marks) and marks[j].kind in NAMED:
        return j
    return k - 1 if k and marks[k - 1].kind in NAMED else None


def _earlier(marks: Sequence[Mark], k: int, room: Mark | None) -> tuple[int, int] | None:
    """Return the places of the last number, or "a", before k, and of what it counts."""

    def same(place: int) -> bool:
        return room is None or marks[place].value.partition("/")[0] == room.value.partition("/")[0]

    numbers = ((j, place) for j in range(k - 1, -1, -1) if (place := _counted(marks, j)) is not None and place < k and same(place))
    articles = (
        (j - 1, j)
        for j in range(k - 1, 0, -1)
        if marks[j].kind in NAMED and same(j) and (marks[j - 1].kind, marks[j - 1].value) in {("det", "indefinite"), ("pron", "one")}
    )
    return next(numbers, None) or next(articles, None)


def _corrected(marks: list[Mark]) -> list[Mark]:
    """Carry out "no, make that two" and "three are enough": the second number holds."""
    k = 0
    while k < len(marks):
        kind = marks[k].kind
        if kind == "fix":
            j = next((j for j in range(k + 1, min(k + 7, len(marks))) if marks[j].kind not in LIGHT), len(marks))
        elif kind == "enough":
            near = (*range(k - 1, max(-1, k - 6), -1), *range(k + 1, min(len(marks), k + 4)))
            j = next((j for j in near if marks[j].kind == "num"), len(marks))
        else:
            k += 1
            continue
        after = marks[j] if j < len(marks) else None
        if after is not None and (after.kind, after.value) == ("pron", "one"):
            after = marks[j] = replace(after, kind="num", value="1", number=1.0)
        if after is not None and after.kind == "amount":
            old = next((i for i in range(k - 1, -1, -1) if marks[i].kind == "amount" and marks[i].value == after.value), None)
            if old is not None:
                marks[old] = after
                del marks[k : j + 1]
                continue
        if after is not None and after.kind == "num":
            room = _counted(marks, j)
            named = room if room is not None and room > j and marks[room].kind == "room" else None
            place = _earlier(marks, min(j, k), marks[named] if named is not None else None)
            if place is not None:
                marks[place[0]] = replace(marks[place[0]], kind="num", value="", number=after.number)
                marks[place[1]] = replace(marks[place[1]], plural=after.number > 1)
                start, end = min(j, k), max(j, k, named or 0) + 1
                while end < len(marks) and marks[end].kind == "clf":
                    end += 1
                while start and marks[start - 1].kind in {
                    "neg",
                    "comma",
                    "hyphen",
                    "dash",
                    "but",
                    "fill",
                }:  # "un dormitorio, no, mejor dos"
                    start -= 1
                del marks[start:end]
                k = start
                continue
        marks[k : k + 1] = [] if kind == "fix" else [replace(marks[k], kind="verb")]
    return marks


def _contradicted(marks: Sequence[Mark], heard: Words) -> None:
    """Refuse "three bedrooms but only two": one of the counts is wrong, and nobody said which."""
    for k, said in enumerate(marks):
        one = (said.kind, said.value) == ("pron", "one")
        number = 1.0 if one else said.number if said.kind == "num" else 0.0
        before = next((m for m in reversed(marks[max(0, k - 5) : k]) if m.kind not in {"verb", "fill", "flag", "adverb", "det"}), None)
        if not number or before is None or before.kind != "but":
            continue
        room = _counted([*marks[:k], replace(said, kind="num"), *marks[k + 1 :]], k)
        named = marks[room] if room is not None and room > k else None
        end = (room if named is not None and room is not None else k) + 1
        end = next((i for i in range(end, len(marks)) if marks[i].kind not in {"clf", "fill"}), len(marks))
        goes_on = end < len(marks) and marks[end].kind not in {*ENDS, "comma"}
        if goes_on or (one and named is None) or (named is not None and ("/" in named.value or named.kind != "room")):
            continue
        place = _earlier(marks, k, named)
        if place is not None and marks[place[0]].number not in {0.0, number} and marks[place[1]].kind == "room":
            words = [_cited(heard, marks, *sorted(place)), _cited(heard, marks, k, end - 1)]
            what = marks[place[1]].value.partition("/")[0].replace("_", " ")
            raise ImpossibleError(
                f"{marks[place[0]].number:g} {what}s are asked for, and then {number:g}", "keep one of the two counts", words
            )


def _negative(marks: Sequence[Mark], heard: Words) -> None:
    """Refuse "-3 bedrooms", "0 m2", "0 rooms" and "no rooms": nothing has so many or is so large."""
    named = any(m.kind in {"room", "suite"} for m in marks)
    for k, mark in enumerate(marks):
        place = heard.tokens[mark.first].start if mark.first < len(heard.tokens) else 0
        minus = mark.kind in {"num", "amount"} and place > 1 and heard.prompt[place - 1] in "-−" and heard.prompt[place - 2] == " "
        lead = k and marks[k - 1].kind in {"cue", "fill", "bound", "of", "det", "verb"}
        none = mark.kind == "amount" and not mark.number and mark.value in {"area", "rooms"}
        empty = (mark.kind, mark.value) == ("unit", "rooms") and k and marks[k - 1].kind == "neg" and not named
        if (minus and lead) or none or empty:
            words = _cited(heard, marks, k - 1 if empty else k, k)
            text = ("-" if minus else "") + words.text
            raise ImpossibleError(f"no home has {text!r}", "ask for numbers above zero", [words])


def _cited(heard: Words, marks: Sequence[Mark], first: int, last: int) -> Evidence:
    start, end = spread(heard.tokens[marks[first].first : max(marks[last].last, marks[first].first + 1)])
    return Evidence(start=start, end=end, text=heard.prompt[start:end], field="rooms")


def _few(marks: list[Mark]) -> list[Mark]:
    """Read "two or three bedrooms" and "2-3 bedrooms" as the smaller of both, which every home that fits has."""
    for k in range(len(marks) - 3, -1, -1):
        a, between, b = marks[k : k + 3]
        joined = (between.kind == "join" and between.value in {"or", "to"}) or between.kind in {"dash", "hyphen", "to"}
        place = _counted(marks, k + 2) if a.kind == b.kind == "num" and joined and a.number < b.number else None
        if place is not None and place > k + 2 and marks[place].kind == "room":
            del marks[k + 1 : k + 3]
    return marks


def _chosen(marks: list[Mark]) -> Revised:
    """Of "a study or a guest room" take the first; the second stands aside."""
    aside: list[Mark] = []
    negated = False
    k = 0
    while k < len(marks):
        mark = marks[k]
        denied = mark.kind in {"neg", "except"} or (mark.kind == "cue" and mark.value in {"except", "avoid", "away"})
        negated = (negated or denied) and mark.kind not in ENDS
        k += 1
        if (mark.kind, mark.value) != ("join", "or") or negated or k < 2 or marks[k - 2].kind not in {"room", "suite"}:
            continue
        j = next((j for j in range(k, len(marks)) if marks[j].kind not in CHOICE), len(marks))
        if j == len(marks) or marks[j].kind not in {"room", "suite"} or _pointed(marks, k - 2) or _pointed(marks, j):
            continue
        ahead = next((m for m in marks[j + 1 :] if m.kind not in {"verb", "flag"}), None)
        if ahead is None or ahead.kind not in {"neg", "needless", "cmp"}:  # "a kitchen or a bathroom must not lie beside it"
            aside += marks[k - 1 : j + 1]
            del marks[k - 1 : j + 1]
            k -= 1
    return Revised(marks, aside)


def _pointed(marks: Sequence[Mark], k: int) -> bool:
    """Whether the room at k was named before: it has a definite article, or a relation leads to it."""
    j = k - 1
    while j >= 0 and marks[j].kind in CHOICE:
        if marks[j].kind == "det" and marks[j].value not in {"indefinite", "another", "some"}:
            return True
        j -= 1
    return j >= 0 and marks[j].kind == "cue" and marks[j].value not in {"has", "in"}
