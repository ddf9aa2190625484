"""Baths of their own: "the parents have their own", "the au pair has a bath of her own, the parents too", "two baths, one for the master bedroom"."""

from __future__ import annotations

from dataclasses import replace

from pipeline.floorplan.language.marks import Mark
from pipeline.floorplan.language.owners import bedroom_of
from pipeline.floorplan.language.wayfinding import room_at

ENDS = {"stop", "line", "comma", "close", "colon"}
TOO = {"auch", "ebenfalls", "ebenso", "too", "also", "as well", "tambien", "也", "也 是", "也 有"}


def bathed(marks: list[Mark]) -> list[Mark]:
    """Read "the au pair has a bath of her own, the parents too" and "the parents have their own" as said of their bedrooms."""
    made: list[Mark] = []
    given: list[Mark] = []  # "has a bath of their own", as it was said last
    for k, mark in enumerate(marks):
        made.append(mark)
        if mark.kind != "owner" or not (k == 0 or marks[k - 1].kind in ENDS | {"det", "join", "but", "num", "relative"}):
            continue
        j = k + 1
        while j < len(marks) and marks[j].kind in {"fill", "adverb", "verb"} and marks[j].text not in TOO:
            j += 1
        ahead = marks[j : j + 1]
        if ahead and ahead[0].text in TOO and given and (j + 1 >= len(marks) or marks[j + 1].kind in ENDS):
            made[-1:] = [bedroom_of(mark, mark.value), *given]
        elif ahead and ahead[0].value == "has":
            end = next((i for i in range(j + 1, len(marks)) if marks[i].kind in ENDS | {"room", "suite"}), len(marks))
            own = any(m.value == "own" for m in marks[j + 1 : end]) and end - j < 6
            bath = end < len(marks) and marks[end].kind == "room" and marks[end].value.startswith(("bathroom", "wc"))
            alone = end >= len(marks) or marks[end].kind in ENDS
            earlier = next((m for m in reversed(marks[:k]) if m.kind == "room" and m.value.startswith("bathroom")), None)
            if own and (bath or (alone and earlier is not None)):
                thing = marks[end] if bath else replace(earlier or mark, first=mark.last, last=mark.last)
                own_mark = next(m for m in marks[j + 1 : end] if m.value == "own")
                given = [replace(ahead[0], text="with"), own_mark, thing]
                made[-1] = bedroom_of(mark, mark.value)
    return made


def completed(marks: list[Mark]) -> list[Mark]:
    """Put in the bathroom that "their own" stands for at the end of a clause."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        own = (mark.kind, mark.value) == ("det", "own") and (k + 1 >= len(marks) or marks[k + 1].kind in ENDS | {"join"})
        has = any(m.value == "has" for m in marks[max(0, k - 3) : k])
        bath = next((m for m in reversed(marks[:k]) if m.kind == "room" and m.value.startswith("bathroom")), None)
        if own and has and bath is not None and marks[k - 1].kind != "room":
            made.append(replace(bath, value="bathroom", first=mark.last, last=mark.last))
    return made


def one_for(marks: list[Mark]) -> list[Mark]:
    """Read "two baths, one for the master bedroom" as one that belongs to it."""
    made = list(marks)
    for k in range(1, len(made) - 2):
        one = (
            made[k].text in {"uno", "una", "one"}
            and made[k].kind in {"fill", "num", "pron"}
            and made[k - 1].kind in {"comma", "colon", "open", "join"}
        )
        room = room_at(made, k + 2) if one and made[k + 1].text in {"para", "for"} else None
        if room is not None and made[room].value.startswith("bedroom"):
            made[k] = replace(made[k], kind="pron", value="one", number=1.0)
            made[k + 1] = replace(made[k + 1], kind="cue", value="ensuite")
            for j in range(room + 1, len(made) - 1):  # "... y otro accesible desde el pasillo"
                if made[j].kind == "det" and made[j].value in {"other", "another"} and made[j + 1].kind == "cue":
                    made[j] = replace(made[j], kind="pron", value="rest")
        elif one and made[k].kind == "fill" and made[k + 1].kind in {"cue", "level"}:
            made[k] = replace(made[k], kind="pron", value="one", number=1.0)
    return made
