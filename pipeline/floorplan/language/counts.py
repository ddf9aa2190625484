"""Numbers apart from their rooms, and rooms left unsaid behind them: "the bedrooms (3)", "the bedrooms, which are three", "of which the biggest ..."."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import ENDS, Mark
from pipeline.floorplan.language.wayfinding import room_at

BEING = {"son", "seran", "are", "sind"}
COMPARED = {"smaller", "larger", "1.35", "1.3", "0.75"}


def counted(marks: Sequence[Mark]) -> list[Mark]:
    """Return the marks with numbers in front of their rooms, and the rooms that only their kind is said of."""
    return _nounless(_partial(_behind(_bracketed(list(marks)))))


def _bracketed(marks: list[Mark]) -> list[Mark]:
    """Read "the bedrooms (3) open onto the hall" with the number in front."""
    made = list(marks)
    for k in range(len(made) - 4, -1, -1):
        room, opened, number, closed = made[k : k + 4]
        if (
            room.kind == "room"
            and room.plural
            and (opened.kind, number.kind, closed.kind) == ("open", "num", "close")
            and number.number >= 2
        ):
            start = k - (k > 0 and made[k - 1].kind == "det")
            made[start : k + 4] = [number, room]
    return made


def _behind(marks: list[Mark]) -> list[Mark]:
    """Read "the bedrooms, which are three", "los dormitorios, que son tres" with the number in front."""
    made = list(marks)
    for k in range(1, len(made)):
        last = k + 1 >= len(made) or made[k + 1].kind in ENDS | {"comma", "join", "colon"}
        row = k > 1 and made[k - 1].kind == "comma" and made[k - 2].kind == "room" and made[k - 2].plural and k + 1 < len(made)
        row = row and made[k + 1].kind == "comma" and made[max(0, k - 3)].kind == "det"
        if made[k].kind != "num" or not last or (made[k - 1].text not in BEING and not row):
            continue
        j = k - 2
        while j >= 0 and (made[j].kind in {"relative", "comma", "pron", "adverb"} or made[j].text in {"que", "which"}):
            j -= 1
        if j < 0 or (made[j].kind in ENDS and k - 2 != j):
            continue
        if made[j].kind in ENDS:  # "The bedrooms open onto the hall. They are three."
            j = next(
                (i for i in range(j - 1, -1, -1) if made[i].kind == "room" and made[i].plural and not (i and made[i - 1].kind == "num")), -1
            )
        if j >= 0 and made[j].kind == "room" and made[j].plural:
            start = j - (j > 0 and made[j - 1].kind == "det")
            between = made[j + 1 : k - 1]
            light = all(m.kind in {"relative", "comma", "pron", "adverb"} or m.text == "que" for m in between)
            return _behind([*made[:start], made[k], made[j], *([] if light else between), *made[k + 1 :]])
    return made


def _nounless(marks: list[Mark]) -> list[Mark]:
    """Read "four bedrooms, of which the biggest has ..." with its noun, and "the two larger ones" behind the smaller ones as the other two."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        ahead = marks[k + 1] if k + 1 < len(marks) else None
        equal = (
            (mark.kind, mark.value) == ("cmp", "alike")
            and room_at(marks, k + 1) is not None
            and k > 0
            and marks[k - 1].kind in {"num", "det"}
        )
        made.append(replace(mark, kind="adj", value="equal") if equal else mark)  # "three equally large bedrooms"
        room = next((m for m in reversed(made) if m.kind == "room"), None)
        if room is None or ahead is None:
            continue
        alone = ahead.kind in {"cue", "verb", "comma"} or ahead.text in {"one", "ones"}
        article = len(made) > 1 and (made[-2].kind == "det" or made[-2].text == "el" or mark.text.startswith(("the ", "el ", "la ")))
        if mark.kind == "adj" and mark.value in {"largest", "smallest"} and alone and article and room.plural:
            while len(made) > 1 and made[-2].kind in {"pron", "det"}:
                del made[-2]
            made.append(replace(room, value=room.value.partition("/")[0], plural=False, first=mark.last, last=mark.last))
        elif (
            mark.kind == "ord"
            and ahead.kind in {"open", "amount", "colon"}
            and (many := next((m for m in made if m.kind == "room" and m.plural), None))
        ):
            made.append(
                replace(many, value=many.value.partition("/")[0], plural=False, first=mark.last, last=mark.last)
            )  # "second (12 m2)"
        elif mark.text == "ones" and len(made) > 2 and made[-2].value in COMPARED and any(m.kind == "room" and m.plural for m in made):
            number = next((m.number for m in made[-3:-1] if m.kind == "num"), 2.0)
            del made[-3 if made[-3].kind == "num" else -2 :]
            made.append(Mark("pron", "rest", number, False, mark.first, mark.last, "the other two" if number == 2.0 else "the others"))
    return made


def _partial(marks: list[Mark]) -> list[Mark]:
    """Read Spanish "uno de los baños" as one of them."""
    made = list(marks)
    for k in range(1, len(made)):
        if made[k].value == "partitive" and made[k - 1].kind == "fill" and made[k - 1].text in {"uno", "una"}:
            made[k - 1] = replace(made[k - 1], kind="num", value="1.0", number=1.0)
    return made
