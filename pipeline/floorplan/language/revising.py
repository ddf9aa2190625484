"""What a prompt takes back or leaves open: "one bedroom, no, make that two", "four, but three are enough", "a study or a guest room"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from pipeline.floorplan.language.marks import ENDS, Mark, Words
from pipeline.floorplan.language.text import spread
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
    made = _corrected(_changed(_not_towards(answered(marks))))
    made = _content(made)
    _contradicted(made, heard)
    return _chosen(_few(made))


EARLIER = {
    "zuerst",
    "urspruenglich",
    "anfangs",
    "erst",
    "originally",
    "first",
    "initially",
    "primero",
    "originalmente",
    "inicialmente",
    "原",
    "本",
    "起",
}
NOW = {"jetzt", "nun", "now", "ahora", "现 在", "doch"}


def answered(marks: Sequence[Mark]) -> list[Mark]:
    """Read "Balkon: nein" as none."""
    said = {"nein", "no", "none", "keiner", "keine", "ninguno"}
    return [
        replace(m, kind="neg") if m.kind in {"fix", "fill", "word"} and m.text in said and k and marks[k - 1].kind == "colon" else m
        for k, m in enumerate(marks)
    ]


def _changed(marks: Sequence[Mark]) -> list[Mark]:
    """Read "first we wanted three baths, now only two" as a correction."""
    made, before = list(marks), False
    for k, mark in enumerate(made):
        before = (before or bool(EARLIER & set(mark.text.split()))) and mark.kind not in ENDS
        if before and mark.text in NOW and mark.kind not in {"fix", "room", "home"}:
            made[k] = replace(mark, kind="fix")
    return made


def _not_towards(marks: Sequence[Mark]) -> list[Mark]:
    """Read 不对 between two rooms as "not towards", elsewhere it takes back what was said."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        ahead = marks[k + 1].kind if k + 1 < len(marks) else ""
        if mark.kind == "fix" and mark.text == "不 对" and ahead == "room" and made and made[-1].kind == "room":
            middle = mark.first + 1
            made += [replace(mark, kind="neg", last=middle, text="不"), replace(mark, kind="fill", first=middle, text="对")]
        else:
            made.append(mark)
    return made


def _counted(marks: Sequence[Mark], k: int) -> int | None:
    """Return the place of the room that the number at k counts; in front of it or, as in Chinese, behind."""
    if marks[k].kind != "num":
        return None
    j = k + 1
    while j < len(marks) and marks[j].kind in INNER:
        j += 1
    if j < len(marks) and marks[j].kind in NAMED:
        return j
    return k - 1 if k and marks[k - 1].kind in NAMED else None


def _same(a: Mark, b: Mark | None) -> bool:
    """Whether two rooms are of one type, or the second is not named."""
    return b is None or a.value.partition("/")[0] == b.value.partition("/")[0]


def _earlier(marks: Sequence[Mark], k: int, room: Mark | None) -> tuple[int, int] | None:
    """Return the places of the last number before k, and of what it counts."""
    for j in range(k - 1, -1, -1):
        place = _counted(marks, j)
        if place is not None and place < k and _same(marks[place], room):
            return j, place
    return None


def _indefinite(marks: Sequence[Mark], k: int, room: Mark | None) -> tuple[int, int] | None:
    """Return the places of "a bedroom" before k."""
    for j in range(k - 1, 0, -1):
        if marks[j].kind in NAMED and _same(marks[j], room):
            article = marks[j - 1]
            return (j - 1, j) if (article.kind, article.value) in {("det", "indefinite"), ("pron", "one")} else None
    return None


def _set(marks: list[Mark], place: tuple[int, int], number: float) -> None:
    """Put another number in front of a room."""
    k, room = place
    marks[k] = replace(marks[k], kind="num", value="", number=number)
    marks[room] = replace(marks[room], plural=number > 1)


def _corrected(marks: list[Mark]) -> list[Mark]:
    k = 0
    while k < len(marks):
        if marks[k].kind == "fix":
            j = k + 1
            while j < len(marks) and marks[j].kind in LIGHT and j - k < 6:
                j += 1
            after = marks[j] if j < len(marks) else None
            if after is not None and after.kind == "amount":
                old = next((i for i in range(k - 1, -1, -1) if marks[i].kind == "amount" and marks[i].value == after.value), None)
                if old is not None:
                    marks[old] = after
                    del marks[k : j + 1]
                    continue
            elif after is not None and (after.kind == "num" or (after.kind, after.value) == ("pron", "one")):
                after = after if after.kind == "num" else replace(after, kind="num", value="1.0", number=1.0)
                marks[j] = after
                room = _counted(marks, j)
                name = marks[room] if room is not None and room > j else None
                place = _earlier(marks, k, name) or _indefinite(marks, k, name)
                if place is not None:
                    _set(marks, place, after.number)
                    end = (room if name is not None and room is not None else j) + 1
                    while end < len(marks) and marks[end].kind == "clf":
                        end += 1
                    start = k
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
            del marks[k]
            continue
        k += 1
    return marks


def _content(marks: list[Mark]) -> list[Mark]:
    """Read "we thought of four bedrooms but three are enough": the second number holds."""
    k = 0
    while k < len(marks):
        if marks[k].kind == "enough":
            near = [j for j in (*range(k - 1, max(-1, k - 6), -1), *range(k + 1, min(len(marks), k + 4))) if marks[j].kind == "num"]
            if near:
                j = near[0]
                room = _counted(marks, j)
                name = marks[room] if room is not None and room > j and marks[room].kind == "room" else None
                place = _earlier(marks, j, name)
                if place is not None:
                    _set(marks, place, marks[j].number)
                    first, last = min(j, k), max(j, k, room if name is not None and room is not None else 0)
                    del marks[first : last + 1]
                    k = first
                    continue
            marks[k] = replace(marks[k], kind="verb")
        k += 1
    return marks


def _contradicted(marks: Sequence[Mark], heard: Words) -> None:
    """Refuse "three bedrooms but only two": one of the counts is wrong, and nobody said which."""
    for k, said in enumerate(marks):
        mark = replace(said, number=1.0) if (said.kind, said.value) == ("pron", "one") else said
        if not mark.number or mark.kind not in {"num", "pron"}:
            continue
        before = k - 1
        while before >= 0 and marks[before].kind in {"verb", "fill", "flag", "adverb", "det"} and k - before < 5:
            before -= 1
        lead = [m for m in marks[max(before, 0) : k] if m.kind == "but"]
        if not lead:
            continue
        room = _counted([*marks[:k], replace(mark, kind="num"), *marks[k + 1 :]], k)
        name = marks[room] if room is not None and room > k else None
        if mark.kind == "pron" and name is None:
            continue
        if name is not None and ("/" in name.value or name.kind != "room"):
            continue
        end = (room if name is not None and room is not None else k) + 1
        while end < len(marks) and marks[end].kind in {"clf", "fill"}:
            end += 1
        if end < len(marks) and marks[end].kind not in {*ENDS, "comma"}:
            continue
        place = _earlier(marks, k, name)
        if place is not None and marks[place[0]].number != mark.number and marks[place[1]].kind == "room":
            words = [_cited(heard, marks, *sorted(place)), _cited(heard, marks, k, end - 1)]
            what = marks[place[1]].value.partition("/")[0].replace("_", " ")
            raise ImpossibleError(
                f"{marks[place[0]].number:g} {what}s are asked for, and then {mark.number:g}", "keep one of the two counts", words
            )


def _negative(marks: Sequence[Mark], heard: Words) -> None:
    """Refuse "-3 bedrooms", "0 m2", "0 rooms" and "no rooms": nothing has so many or is so large."""
    named = any(m.kind in {"room", "suite"} for m in marks)
    for k, mark in enumerate(marks):
        place = heard.tokens[mark.first].start if mark.first < len(heard.tokens) else 0
        minus = mark.kind in {"num", "amount"} and place > 1 and heard.prompt[place - 1] in "-−" and heard.prompt[place - 2] == " "
        lead = k and marks[k - 1].kind in {"cue", "fill", "bound", "of", "det", "verb"}
        none = mark.kind == "amount" and not mark.number and mark.value in {"area", "rooms"}
        empty = mark.kind == "unit" and mark.value == "rooms" and k and marks[k - 1].kind == "neg" and not named
        if (minus and lead) or none or empty:
            words = _cited(heard, marks, k - 1 if empty else k, k)
            text = ("-" if minus else "") + words.text
            raise ImpossibleError(f"no home has {text!r}", "ask for numbers above zero", [words])


def _cited(heard: Words, marks: Sequence[Mark], first: int, last: int) -> Evidence:
    start, end = spread(heard.tokens[marks[first].first : max(marks[last].last, marks[first].first + 1)])
    return Evidence(start=start, end=end, text=heard.prompt[start:end], field="rooms")


def _few(marks: list[Mark]) -> list[Mark]:
    """Read "two or three bedrooms" and "2-3 bedrooms" as the smaller of both, which every home that fits has."""
    k = 0
    while k + 2 < len(marks):
        a, between, b = marks[k : k + 3]
        joined = (between.kind == "join" and between.value in {"or", "to"}) or between.kind in {"dash", "hyphen", "to"}
        place = _counted(marks, k + 2) if a.kind == b.kind == "num" and joined and a.number < b.number else None
        if place is not None and place > k + 2 and marks[place].kind == "room":
            del marks[k + 1 : k + 3]
        k += 1
    return marks


def _chosen(marks: list[Mark]) -> Revised:
    """Of "a study or a guest room" take the first; the second stands aside."""
    aside: list[Mark] = []
    k = 0
    negated = False
    while k < len(marks):
        mark = marks[k]
        negated = (
            negated or mark.kind in {"neg", "except"} or (mark.kind == "cue" and mark.value in {"except", "avoid", "away"})
        ) and mark.kind not in ENDS
        if mark.kind == "join" and mark.value == "or" and not negated and k and marks[k - 1].kind in {"room", "suite"}:
            j = k + 1
            while j < len(marks) and marks[j].kind in CHOICE:
                j += 1
            open_ends = j < len(marks) and marks[j].kind in {"room", "suite"} and not _pointed(marks, k - 1) and not _pointed(marks, j)
            if open_ends and not _ahead(marks, j + 1):
                aside += marks[k : j + 1]
                del marks[k : j + 1]
                continue
        k += 1
    return Revised(marks, aside)


def _pointed(marks: Sequence[Mark], k: int) -> bool:
    """Whether the room at k was named before: it has a definite article, or a cue leads to it."""
    j = k - 1
    while j >= 0 and marks[j].kind in CHOICE:
        if marks[j].kind == "det" and marks[j].value not in {"indefinite", "another", "some"}:
            return True
        j -= 1
    return j >= 0 and marks[j].kind == "cue" and marks[j].value not in {"has", "in"}


def _ahead(marks: Sequence[Mark], k: int) -> bool:
    """Whether something is said of both rooms, as of "a kitchen or a bathroom must not lie beside it"."""
    while k < len(marks) and marks[k].kind in {"verb", "flag"}:
        k += 1
    return k < len(marks) and marks[k].kind in {"neg", "needless", "cmp"}
