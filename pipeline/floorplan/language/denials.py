"""Noes that stand apart from what they deny: "neither A nor B may ...", "must not be smaller than 10 m²", "the kitchen does not"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import ENDS, Mark
from pipeline.floorplan.language.wayfinding import room_at

NEITHER = {"neither", "ni", "weder", "ninguno de", "ninguna de"}
NOR = {"nor", "ni", "noch", "or", "o"}
LIGHT = {"verb", "fill", "adverb", "word", "det", "pron", "cue", "flag"}  # between a negation and the bound that it turns
TURNED = {"least": "most", "most": "least"}
OTHER = {"another", "other", "otro", "otra", "ein anderes", "anderes", "anderen", "otros"}
GOING = {"door", "leads", "by", "thru", "in"}


def denied(marks: Sequence[Mark]) -> list[Mark]:
    """Return the marks with each negation in front of what it denies."""
    return _passages(_turned(_neither(_but(list(marks)))))


def _but(marks: list[Mark]) -> list[Mark]:
    """Read "every bedroom but the guest room has ..." as all except that one."""
    made = list(marks)
    for k in range(2, len(made) - 1):
        whole = made[k - 1].kind == "room" and made[k - 2].value in {"each", "all"}
        room = room_at(made, k + 1) if made[k].kind == "but" and whole else None
        if room is not None and room + 1 < len(made) and made[room + 1].kind in {"cue", "verb"}:
            made[k] = replace(made[k], kind="cue", value="except")
    return made


def _neither(marks: list[Mark]) -> list[Mark]:
    """Read "neither the bath nor the WC may touch the dining room" as "the bath and the WC may not ..."."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark = marks[k]
        first = room_at(marks, k + 1) if mark.kind == "neg" and mark.text in NEITHER else None
        second = None
        if first is not None and first + 1 < len(marks) and marks[first + 1].text in NOR:
            second = room_at(marks, first + 2)
        if first is not None and second is not None and second + 1 < len(marks) and marks[second + 1].kind in {"verb", "cue"}:
            made += [*marks[k + 1 : first + 1], replace(marks[first + 1], kind="join", value="and", text="and")]
            made += [*marks[first + 2 : second + 1], replace(mark, text="not")]
            k = second + 1
        elif mark.kind == "neg" and mark.text == "neither" and k + 1 < len(marks) and marks[k + 1].kind == "verb":
            made += [replace(mark, kind="pron", value="both"), replace(mark, text="not", first=mark.last)]
            k += 1
        else:
            made.append(mark)
            k += 1
    return made


def _turned(marks: list[Mark]) -> list[Mark]:
    """Read "no puede medir menos de 10 m²" as at least 10: the negation turns the bound."""
    made = list(marks)
    gone: set[int] = set()
    for k, mark in enumerate(marks):
        if mark.kind != "amount" or mark.bound not in TURNED:
            continue
        j = k - 1
        while j >= 0 and marks[j].kind in LIGHT and (marks[j].kind != "cue" or marks[j].value == "has"):
            j -= 1
        spoken = any(m.kind in {"verb", "word", "fill", "cue"} for m in marks[j + 1 : k])
        if j >= 0 and marks[j].kind == "neg" and spoken:
            made[k] = replace(mark, bound=TURNED[mark.bound])
            gone.add(j)
    return [m for k, m in enumerate(made) if k not in gone]


def _passages(marks: list[Mark]) -> list[Mark]:
    """Read "no bedroom reached only through another bedroom" as no bedroom being a thoroughfare."""
    for k, mark in enumerate(marks):
        if mark.kind != "neg":
            continue
        end = next((j for j in range(k, len(marks)) if marks[j].kind in ENDS), len(marks))
        rooms = [j for j in range(k, end) if marks[j].kind == "room" and marks[j].value.startswith("bedroom")]
        if len(rooms) != 2 or any(m.kind == "room" for j, m in enumerate(marks[k:end], k) if j not in rooms):
            continue
        between = marks[rooms[0] + 1 : rooms[1]]
        other = any(m.text in OTHER or m.value in {"another", "other"} for m in between[-2:])
        if other and any(m.kind == "cue" and m.value in GOING for m in between):
            flag = Mark("flag", "thoroughfare", first=marks[rooms[0]].first, last=marks[rooms[1]].last, text="through room")
            return [*marks[: k + 1], flag, *_passages(marks[rooms[1] + 1 :])]
    return marks
