"""Figures whose unit, limit or meaning is said elsewhere: tables, areas in a row, bounds that a heading states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, Words

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


CLOSERS = {"comma", "stop", "line", "close", "join", "open"}
DEALING = {"cue", "open", "verb", "colon", "fill", "word", "bound", "adverb"}  # between rooms and their areas
OVER = {"least", "or_more"}


def supplied(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks, figures and units still apart, with each unit and limit in its place."""
    made = _headed(_tabled(_dealt(_spread(_plus(list(marks), heard), heard))), heard)
    return _turned(_with(made), heard) if "verb_last" in heard.lexicon.traits else made


def _bound(heard: Words, value: str, like: Mark) -> Mark:
    """Return a mark of a limit in front of the figure `like`."""
    text = next(t for t, v in heard.lexicon.bounds.items() if v == value)
    return Mark("bound", value, 0.0, False, like.first, like.first, text)


def _area(mark: Mark) -> bool:
    return (mark.kind, mark.value) == ("unit", "area")


def _plus(marks: list[Mark], heard: Words) -> list[Mark]:
    """Read "14+ m²" as at least 14 m²."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        if mark.text == "+" and made and made[-1].kind == "num" and k + 1 < len(marks) and _area(marks[k + 1]):
            made.insert(len(made) - 1, _bound(heard, "least", made[-1]))
        elif (
            mark.text == "+"
            and len(made) > 1
            and _area(made[-1])
            and (k + 1 >= len(marks) or marks[k + 1].kind in {"stop", "line", "comma"})
        ):
            made.insert(len(made) - 2, _bound(heard, "least", made[-2]))
        else:
            made.append(mark)
    return made


def _spread(marks: list[Mark], heard: Words) -> list[Mark]:
    """Read "at least 12, but no more than 16 m²" as two limits in the same unit."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        if mark.kind != "num" or k < 1 or heard.lexicon.bounds.get(marks[k - 1].text) not in {"least", "most"}:
            continue
        j = k + 1
        while j < len(marks) and marks[j].kind in {"comma", "but", "join"}:
            j += 1
        bound = j < len(marks) and heard.lexicon.bounds.get(marks[j].text) in {"least", "most"}
        if j > k + 1 and bound and j + 2 < len(marks) and marks[j + 1].kind == "num" and _area(marks[j + 2]):
            made.append(replace(marks[j + 2], first=mark.last, last=mark.last))
    return made


def _dealt(marks: list[Mark]) -> list[Mark]:
    """Read "kitchen and bath with 12 and 6 m²", "(12 bzw. 6 m²)" as an area each."""
    for k in range(len(marks) - 3):
        number, join, second, unit = marks[k : k + 4]
        if number.kind != "num" or join.kind != "join" or second.kind != "num" or not _area(unit) or number.value != "figure":
            continue
        j = k - 1
        while j >= 0 and marks[j].kind in DEALING and k - j < 5:
            j -= 1
        rooms = [i for i in range(max(0, j - 4), j + 1) if marks[i].kind == "room"]
        if len(rooms) < 2 or rooms[-1] != j or j == k - 1 or not any(m.kind == "join" for m in marks[rooms[-2] : j]):
            continue
        if any(m.kind == "num" or m.plural for m in marks[rooms[-2] : j + 1]) or (rooms[-2] and marks[rooms[-2] - 1].kind == "num"):
            continue
        first = [number, replace(unit, first=number.last, last=number.last)]
        closed = k + 4 < len(marks) and marks[k + 4].kind == "close" and any(m.kind == "open" for m in marks[j:k])
        front = [*marks[: rooms[-2] + 1], *first, *marks[rooms[-2] + 1 : j + 1], second, unit]
        return [*front, *_dealt(marks[k + 4 + closed :])]
    return marks


def _tabled(marks: list[Mark]) -> list[Mark]:
    """Read "hall 5, bath 7 (all in m²)", "areas in m²: hall 5, bath 7" as areas."""
    lone = [
        k
        for k, m in enumerate(marks)
        if _area(m)
        and (k == 0 or marks[k - 1].kind not in {"num", "dash", "join", "hyphen"})
        and m.first < m.last
        and not (k + 1 < len(marks) and marks[k + 1].kind == "num")
    ]
    figures = [
        k
        for k in range(1, len(marks))
        if marks[k].kind == "num" and marks[k].value == "figure" and marks[k - 1].kind in {"room", "colon"}
        if any(m.kind == "room" for m in marks[max(0, k - 2) : k]) and (k + 1 >= len(marks) or marks[k + 1].kind in CLOSERS)
    ]
    if len(lone) != 1 or len(figures) < 2:
        return marks
    unit = marks[lone[0]]
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        if k == lone[0]:
            made.append(replace(mark, kind="fill", value=""))
        else:
            made.append(mark)
            if k in figures:
                made.append(replace(unit, first=mark.last, last=mark.last))
    return made


def _headed(marks: list[Mark], heard: Words) -> list[Mark]:
    """Read "minimum size kitchen: 14 m²" with the limit in front of the figure."""
    made = list(marks)
    for k in range(len(made) - 4):
        bound = heard.lexicon.bounds.get(made[k].text) in {"least", "most"} and made[k + 1].kind == "room"
        if bound and made[k + 2].kind == "colon" and made[k + 3].kind == "num" and _area(made[k + 4]):
            made[k : k + 3] = [made[k + 1], replace(made[k], first=made[k + 2].last, last=made[k + 2].last)]
    return made


def _turned(marks: list[Mark], heard: Words) -> list[Mark]:
    """Read "mehr als 90 m² dürfen es nicht sein" and "überschreitet 90 m² nicht" as a limit from above."""
    made = list(marks)
    for k in range(len(made) - 3):
        side = heard.lexicon.bounds.get(made[k].text)
        if side not in OVER | {"most", "or_less"} or made[k + 1].kind != "num" or not _area(made[k + 2]):
            continue
        end = next((j for j in range(k + 3, min(k + 8, len(made))) if made[j].kind not in {"verb", "pron", "adverb", "fill", "word"}), 0)
        behind = end + 1
        while end and behind < len(made) and made[behind].kind == "verb":
            behind += 1
        if end and made[end].text == "nicht" and (behind >= len(made) or made[behind].kind in CLOSERS):
            made[k] = replace(_bound(heard, "most" if side in OVER else "least", made[k + 1]), first=made[k].first, last=made[k].last)
            return [*made[:end], *_turned(made[end + 1 :], heard)]
    return made


def _with(marks: list[Mark]) -> list[Mark]:
    """Read "m. Bad" as "mit Bad": a metre needs a figure."""
    return [
        replace(m, kind="cue", value="has", number=0.0, text="mit")
        if m.kind == "unit" and m.text == "m" and k and marks[k - 1].kind in {"room", "home"}
        else m
        for k, m in enumerate(marks)
    ]
