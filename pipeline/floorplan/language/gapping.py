"""Verbs and rooms that stand elsewhere: "..., and the dining room with the living room", "onto the hall open the bedrooms", "they share another"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import ENDS, Mark, Words
from pipeline.floorplan.language.wayfinding import room_at

CLOSERS = {"stop", "line", "comma", "join", "close", "but"}
FACING = {"dan", "da", "dar", "salen", "sale", "salir", "abren", "abre", "abrir", "desembocan", "conducen", "llevan", "comunican", "asoman"}
PASSING = {"comunica", "comunican", "conecta", "conectan", "enlaza", "enlazan"}
TOWARDS = {"a", "al", "hacia", "con", "en", "to", "into", "onto", "towards", "desde"}
LOOKS = {"adj", "size", "look", "post"}


def regained(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with each verb and room in its place."""
    made = _doorways(list(marks))
    if heard.lexicon.language == "es":
        made = _most(_another(_gapped(_onto(_towards(made)))))
    return _measured(_rather(made, heard))


def _doorways(marks: list[Mark]) -> list[Mark]:
    """Read "con una puerta doble al comedor", "with a sliding door to the hall" as a way, whatever the door is like."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        j = k + 1
        while j < len(marks) and marks[j].kind in LOOKS | {"word", "bound"} and j - k < 4:
            j += 1
        had = next((m for m in reversed(made[-3:]) if m.kind == "cue"), None)
        door = (marks[k].kind, marks[k].value) == ("flag", "doors") and j < len(marks) and marks[j].text in TOWARDS
        if door and had is not None and had.value == "has" and room_at(marks, j + 1) is not None:
            made.append(Mark("cue", "door", 0.0, False, marks[k].first, marks[j].last, "con puerta a"))
            k = j + 1
        else:
            made.append(marks[k])
            k += 1
    return made


def _towards(marks: list[Mark]) -> list[Mark]:
    """Read "comunica a un lado con la cocina y al otro con la sala" as ways to both."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        j = k + 1
        while j < len(marks) and j - k < 4 and (marks[j].kind in {"wing", "fill", "adverb"} or marks[j].text in {"al", "otro", "un"}):
            j += 1
        with_it = j < len(marks) and marks[j].text == "con"
        if marks[k].text.rsplit(" ", 1)[-1] in PASSING and marks[k].kind == "cue" and with_it:
            made.append(replace(marks[k], value="door", text=marks[k].text + " con", last=marks[j].last))
            k = j + 1
        else:
            made.append(marks[k])
            k += 1
    return made


def _gapped(marks: list[Mark]) -> list[Mark]:
    """Read "la cocina linda con el comedor y el comedor con el salón": the second pair is joined as the first is."""
    made = list(marks)
    way: Mark | None = None
    for k, mark in enumerate(marks):
        if mark.kind in ENDS:
            way = None
        elif mark.kind == "cue" and mark.value in {"door", "near", "leads", "open"} and mark.text.endswith(" con"):
            way = mark
        if way is None or mark.text != "con" or (mark.kind, mark.value) != ("cue", "has") or room_at(marks, k + 1) is None:
            continue
        if marks[k - 1].kind == "join":  # "comunica con el salón y con el pasillo"
            made[k] = replace(mark, value="again")
            continue
        j = k - 1
        while j > 0 and marks[j].kind in {"comma", "amount", "adj", "size"}:
            j -= 1
        start = j
        while start > 0 and marks[start - 1].kind in {"det", "adj", "size"}:
            start -= 1
        other = marks[j].text in {"otro", "otra"} or marks[j].kind == "wing"
        lead = marks[start - 1].kind in {"join", "comma"} if start else False
        if (
            marks[j].kind == "room" and lead and start > 1 and marks[start - 2].kind in {"room", "comma", "post", "adj", "amount"}
        ) or other:
            made[k] = replace(way, first=mark.first, last=mark.last, only=False)
            if other:
                made[start:k] = [replace(m, kind="fill", value="") for m in marks[start:k]]
    return made


def _onto(marks: list[Mark]) -> list[Mark]:
    """Read "al pasillo dan los dormitorios y el baño", "a ambos lados del pasillo se abren ..." as what lies on the hall."""
    made = list(marks)
    for k, mark in enumerate(marks):
        begins = k == 0 or marks[k - 1].kind in CLOSERS or marks[k - 1].kind in {"relative", "colon"}
        if not begins or mark.text not in {"a", "al"} or (room := room_at(marks, k + 1)) is None:
            continue
        j = room + 1
        while j < len(marks) and (
            marks[j].kind in {"adverb", "fill", "post", "adj"} or (marks[j].kind == "verb") or marks[j].value == "only"
        ):
            if marks[j].text in FACING:
                break
            j += 1
        facing = j < len(marks) and marks[j].text.removeprefix("se ") in FACING and room_at(marks, j + 1) is not None
        if facing and marks[j].kind != "room":
            made[k] = replace(mark, kind="det", value="definite")
            made[j] = replace(marks[j], kind="cue", value="leads", text="da a")
            made[room + 1 : j] = [replace(m, kind="fill", value="") for m in marks[room + 1 : j]]
    return made


def _another(marks: list[Mark]) -> list[Mark]:
    """Read "la abuela tiene su baño; los demás comparten otro" as another bathroom."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        ends = k + 1 >= len(marks) or marks[k + 1].kind in CLOSERS
        said = k > 0 and (marks[k - 1].kind == "verb" or marks[k - 1].value == "has")
        last = next((m for m in reversed(made[:-1]) if m.kind == "room"), None)
        start = max((i for i in range(k) if marks[i].kind in ENDS), default=-1) + 1
        place = next((i for i in range(start, k) if marks[i].kind == "room"), None)
        first = marks[place] if place is not None else None
        single = place is not None and place > 0 and not marks[place].plural and marks[place - 1].value == "indefinite"
        placed = k + 1 < len(marks) and marks[k + 1].kind == "cue" and marks[k + 1].value in {"door", "near", "in", "from"}
        if (
            (mark.kind, mark.value) == ("det", "another")
            and placed
            and single
            and first is not None
            and marks[k - 1].kind in {"join", "comma"}
        ):
            made.append(replace(first, plural=False, first=mark.last, last=mark.last))  # "a bath by the kitchen and another in the bedroom"
        elif (mark.kind, mark.value) == ("det", "another") and ends and said and last is not None and not last.value.startswith("bedroom"):
            made.append(replace(last, plural=False, first=mark.last, last=mark.last))
    return made


def _rather(marks: list[Mark], heard: Words) -> list[Mark]:
    """Read "prefiero un salón que dos salas" as the first of the two."""
    made = list(marks)
    for k, mark in enumerate(marks):
        begin = max((i for i in range(k) if marks[i].kind in ENDS), default=-1) + 1
        said = heard.texts[marks[begin].first : mark.first] if begin < k else []
        rather = bool({"prefiere", "prefiero", "preferimos", "mejor", "rather", "prefer", "lieber"} & set(said))
        room = room_at(marks, k + 1)
        if (
            mark.text in {"que", "than", "als"}
            and rather
            and room is not None
            and any(m.kind == "room" and m.value == marks[room].value for m in marks[begin:k])
            and room > k + 1
        ):
            end = room + 1
            while end < len(marks) and marks[end].kind in LOOKS:
                end += 1
            made[k:end] = [replace(m, kind="fill", value="") for m in marks[k:end]]
    return made


def _most(marks: list[Mark]) -> list[Mark]:
    """Read "la estancia más tranquila" as any room, not as the living room; so is "otra estancia"."""
    made = list(marks)
    for k in range(len(marks) - 1):
        if (
            marks[k].text == "estancia"
            and marks[k + 1].text in {"mas", "menos"}
            and k + 2 < len(marks)
            and marks[k + 2].kind in {"adj", "word", "look"}
        ):
            made[k : k + 3] = [replace(m, kind="fill", value="") for m in marks[k : k + 3]]
    return made


def _measured(marks: list[Mark]) -> list[Mark]:
    """Read "..., m2 110" as the area of the home."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        pair = marks[k : k + 2]
        alone = k == 0 or marks[k - 1].kind in {"comma", "line", "stop", "colon", "bullet"}
        ends = k + 2 >= len(marks) or marks[k + 2].kind in CLOSERS
        if len(pair) > 1 and alone and ends and (pair[0].kind, pair[0].value) == ("unit", "area") and pair[1].value == "figure":
            made.append(
                replace(pair[0], kind="amount", value="area", number=pair[1].number * pair[0].number, last=pair[1].last, total=True)
            )
            k += 2
        else:
            made.append(marks[k])
            k += 1
    return made
