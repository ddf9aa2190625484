"""Figures whose unit or meaning is said elsewhere: tables, areas in a row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark

AREA = {
    "superficie",
    "area",
    "flaeche",
    "wohnflaeche",
    "gesamtflaeche",
    "nutzflaeche",
    "grundflaeche",
    "size",
    "groesse",
    "面 积",
    "建 筑 面 积",
}


def summed(marks: Sequence[Mark]) -> list[Mark]:
    """Read "ground floor 70 m2: ... upper floor 60 m2: ..." as a home of 130."""
    places = [k for k in range(1, len(marks)) if marks[k].kind == "amount" and marks[k].value == "area" and _heading(marks, k)]
    if len(places) < 2 or len({marks[k - 1].value or marks[k - 2].value for k in places}) < len(places):
        return list(marks)
    total = replace(marks[places[0]], number=sum(marks[k].number for k in places), total=True)
    return [total if k == places[0] else m for k, m in enumerate(marks) if k == places[0] or k not in places]


def _heading(marks: Sequence[Mark], k: int) -> bool:
    """Whether the amount at k belongs to a storey in front of a list."""
    level = next((m for m in reversed(marks[:k]) if m.kind not in {"open", "bound", "comma", "dash", "colon"}), None)
    after = marks[k + 1] if k + 1 < len(marks) else None
    return (
        level is not None
        and level is marks[k - 1 if marks[k - 1].kind == "level" else k - 2]
        and level.kind == "level"
        and after is not None
        and after.kind in {"colon", "close", "comma", "line", "cue"}
    )


def titled(marks: list[Mark]) -> list[Mark]:
    """Read the line "Superficie: 170 m2" of a table as the whole home's."""
    made = list(marks)
    for k in range(2, len(made)):
        if made[k].kind != "amount" or made[k].value != "area":
            continue
        j = k - 1
        while j >= 0 and made[j].kind in {"colon", "fill", "word", "unit", "flag", "bound"}:
            j -= 1
        title = made[j + 1 : k]
        alone = j < 0 or made[j].kind in {"line", "stop", "comma", "bullet"}
        ends = k + 1 >= len(made) or made[k + 1].kind in {"line", "stop", "comma", "bullet"}
        if alone and ends and any(m.text in AREA for m in title) and any(m.kind == "colon" for m in title):
            made[k] = replace(made[k], total=True)
    return made


ENDS = {"comma", "stop", "line", "join", "close", "open", "slash", "bullet"}
SMALLEST = 3.0  # [m2] a figure behind a room that may be its area
INDEXED = {"bedroom", "bathroom"}  # "bedroom 2" is a name, from MOST_NAMES on it is an area
MOST_NAMES = 5.0
OF = {"de", "of", "mit", "von"}
DASHES = {"-", "–", "—", "•", "*"}


def _of_item(marks: Sequence[Mark], k: int) -> bool:
    """Whether the comma at k parts a room from its area in an item of a list: "- open kitchen, approx. 35 m2 - storage"."""
    if marks[k].kind != "comma" or marks[k].text != "," or sum(m.kind in {"comma", "bullet"} and m.text in DASHES for m in marks) < 2:
        return False
    j = k + 1
    while j < len(marks) and marks[j].kind in {"bound", "num", "unit", "fill"}:
        j += 1
    ends = j >= len(marks) or marks[j].kind in {"line", "stop"} or marks[j].text in DASHES
    return ends and j > k + 1 and marks[j - 1].kind == "unit" and marks[j - 1].value == "area" and marks[k - 1].kind == "room"


def plain_areas(marks: Sequence[Mark]) -> list[Mark]:
    """Read "bedrooms 14 and 11 m2, living room 22, kitchen 9" and "dormitorios de 12 metros, un salón de 25": areas all of them."""
    made = [replace(m, value="area") if _metres(marks, k) else m for k, m in enumerate(marks) if not _of_item(marks, k)]
    units = [k for k in range(1, len(made)) if made[k].kind == "unit" and made[k].value == "area" and made[k - 1].kind == "num"]
    if not units:
        return made
    unit, told = made[units[0]], any(_of_room(made, k - 1) for k in units)
    for k in range(len(made) - 1, 0, -1):
        ends = k + 1 >= len(made) or made[k + 1].kind in ENDS
        room = _of_room(made, k)
        if not ends or room is None or made[k].kind != "num" or made[k].value != "figure" or made[k].number < SMALLEST:
            continue
        if not told and made[k - 1].text not in OF:
            continue
        if room.value.partition("/")[0] not in INDEXED or made[k].number >= MOST_NAMES or made[k - 1].kind != "room":
            made.insert(k + 1, replace(unit, first=made[k].last, last=made[k].last))
    return made


def _metres(marks: Sequence[Mark], k: int) -> bool:
    """Whether "metros" behind a room are square ones: "un salón de 20 metros"."""
    ahead = marks[k + 1] if k + 1 < len(marks) else None
    across = ahead is not None and (ahead.kind in {"long", "times"} or ahead.value in {"wide", "ceiling"} or ahead.text == "x")
    metres = k > 1 and marks[k].kind == "unit" and marks[k].value == "length" and marks[k].text == "metros" and not across
    return metres and marks[k - 1].kind == "num" and marks[k - 1].number >= MOST_NAMES and _of_room(marks, k - 1) is not None


def _of_room(marks: Sequence[Mark], k: int) -> Mark | None:
    """Return the room that the figure at k measures: right in front of it, or of figures in a row."""
    j = k - 1
    while j > 0 and (
        marks[j].kind in {"num", "bound", "post", "size"} or (marks[j].kind in {"join", "comma"} and marks[j - 1].kind == "num")
    ):
        j -= 1
    j -= j > 0 and marks[j].kind == "open"
    if j > 0 and (marks[j].value == "has" or marks[j].text in OF or marks[j].kind == "colon"):
        j -= 1
    return marks[j] if j >= 0 and marks[j].kind == "room" else None
