"""People who get rooms: "the two boys each get a room", "the grandparents have a bedroom", "four students, each with a room", "孩子们每人一间"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, Words
from pipeline.floorplan.language.owners import (
    FOR,
    POSSESSIVE,
    bedroom_of,
    heads,
    heads_at,
    joined,
    meant_for,
    named,
    nobodys,
    spoken_of,
    theirs,
    whose,
)

ENDS = {"stop", "line", "comma", "close", "colon"}
EACH = {
    "each", "apiece", "cadauno", "cadauna", "cada", "je", "jeweils", "jeder", "jedes", "jeein", "jeeine", "jeeinen",
    "每人", "每个人", "每位", "每名", "人均", "每个学生",
}  # fmt: skip
LIGHT = {"comma", "verb", "fill", "adverb", "det", "cue", "pron", "word", "num"}  # between people and the room that each of them gets
FAR = 9  # marks
LINKING = {"verb", "adverb", "fill"}  # between people and what they get
PHRASE = {"det", "num", "clf", "adj", "size", "bound", "amount"}
PARTS = {"det", "num", "clf", "adj", "size", "fill", "adverb", "verb", "relative", "bound"}  # what may stand in a phrase
PERSONS = {
    "student", "students", "studenten", "person", "persons", "people", "personen", "leute", "mitbewohner", "bewohner", "friends", "freunde",
    "flatmates", "roommates", "sharers", "residents", "estudiante", "estudiantes", "persona", "personas", "amigos", "companeros",
}  # fmt: skip
HAN_PERSONS = ("学生", "人", "室友", "同学", "朋友", "租客", "员工")


def housed(marks: Sequence[Mark]) -> list[Mark]:
    """Return the marks with the rooms of people named as theirs."""
    return _having(theirs(meant_for(_each(whose(list(marks))))))


def settled(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with bedrooms in the place of people who have one."""
    made = _persons(list(marks), heard)
    made = _couple(made) if heard.lexicon.language == "de" else made
    if any(m.kind == "owner" for m in made):
        made = spoken_of(_given(named(_left_out(made))))
    return made


def _each(marks: list[Mark]) -> list[Mark]:
    """Read "the two children have a room each" and "a room for each of the two children" as two rooms of children."""
    made = list(marks)
    for k, mark in enumerate(made):
        if mark.kind != "owner":
            continue
        place = heads_at(made, k)
        if place is None:
            continue
        count = made[place].number or 2.0
        number = Mark("num", "", count, False, made[k - 1].first, mark.last, mark.text)
        j = k + 1
        while j < min(len(made), k + FAR) and made[j].kind in LIGHT and not nobodys(made[j]):
            j += 1
        if j < len(made) and nobodys(made[j]):  # people, then the room
            behind = j + 1 < len(made) and _apiece(made[j + 1])
            if behind or any(map(_apiece, made[k + 1 : j])):
                return [*made[:place], number, replace(joined(made[j], mark), plural=True), *_each(made[j + 1 + behind :])]
        room = next((i for i in range(k - 1, max(-1, k - FAR), -1) if nobodys(made[i])), None)
        if room is not None and any(map(_apiece, made[room:k])):  # the room, then the people
            start = room - (room > 0 and (made[room - 1].kind == "num" or made[room - 1].value == "indefinite"))
            return [*made[:start], number, replace(joined(made[room], mark), plural=True), *_each(made[k + 1 :])]
    return made


def _having(marks: list[Mark]) -> list[Mark]:
    """Read "the grandparents have a bedroom with ...; the parents, a bedroom" as theirs."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark, before = marks[k], next((m for m in reversed(made) if m.kind != "det" and m.text not in POSSESSIVE), None)
        made.append(mark)
        k += 1
        if mark.kind != "owner" or (
            before is not None and (before.text in FOR or before.kind not in {"stop", "line", "comma", "join", "colon", "but"})
        ):
            continue
        j = k
        while j < len(marks) and (marks[j].kind in {"comma", "verb", "adverb"} or (marks[j].kind, marks[j].value) == ("cue", "has")):
            j += 1
        one = j < len(marks) and ((marks[j].kind, marks[j].value) == ("det", "indefinite") or marks[j].number == 1.0)
        room = j + 1
        while room < len(marks) and marks[room].kind in {"adj", "size"}:
            room += 1
        if j > k and one and room < len(marks) and (marks[room].kind, marks[room].value) == ("room", "bedroom"):
            made.pop()
            while made and made[-1].kind == "det":
                made.pop()
            made += [*marks[j:room], joined(marks[room], mark)]
            k = room + 1
    return made


def _couple(marks: list[Mark]) -> list[Mark]:
    """Read "das Paar" as people, not as a number."""
    made = list(marks)
    for k in range(1, len(made)):
        if made[k].kind == "num" and made[k].text == "paar" and made[k - 1].text in {"das", "dem", "des"}:
            made[k] = replace(made[k], kind="owner", value="primary", number=0.0)
    return made


def _left_out(marks: list[Mark]) -> list[Mark]:
    """Read "a bedroom for us, two for the kids" as two bedrooms of the kids."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        person = next((m for m in marks[k + 1 : k + 4] if m.kind not in {"det", "fill", "clf"}), None)
        counted = mark.kind == "num" and mark.number > 1 and person is not None and person.kind == "owner" and marks[k + 1].kind == "fill"
        place = next((i for i in range(k - 1, -1, -1) if marks[i].kind == "room"), None) if counted else None
        if place is None or person is None or not marks[place].value.startswith("bedroom") or marks[k - 1].kind not in ENDS | {"join"}:
            continue
        one = not marks[place].plural and not any(m.kind == "num" and m.number > 1 for m in marks[max(0, place - 3) : place])
        if one:
            made.append(replace(replace(bedroom_of(person, person.value), plural=True), first=mark.last, last=mark.last, text="zimmer"))
    return made


def _one(mark: Mark) -> bool:
    return (mark.kind, mark.value) == ("pron", "one") and mark.text.startswith("一")


def _given(marks: list[Mark]) -> list[Mark]:
    """Read "the parents (get) a bedroom", "the two kids a room each" as bedrooms of theirs; "with their own bedroom" is read elsewhere."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark = marks[k]
        j = k + 1
        while (
            j < len(marks)
            and j - k < 4
            and ((marks[j].kind in LINKING and not _apiece(marks[j])) or (marks[j].value == "has" and marks[j].text != "with"))
        ):
            j += 1
        start = j
        while j < len(marks) and (marks[j].kind in PHRASE or _apiece(marks[j]) or _one(marks[j])):
            j += 1
        phrase, relative = marks[start:j], marks[j:j]
        end = next((i for i in range(j, min(j + 6, len(marks))) if marks[i].text == "的"), 0)
        if end and marks[j].value == "has":  # "给老人一间带卫生间的卧室"
            relative, j = marks[j : end + 1], end + 1
        room = mark.kind == "owner" and j < len(marks) and bool(phrase) and nobodys(marks[j], mark.value)
        each = any(map(_apiece, phrase)) or (j + 1 < len(marks) and marks[j + 1].value == "each")
        every = k > 0 and (marks[k - 1].kind, marks[k - 1].value) == ("det", "each")
        fresh = any(m.kind in {"num", "clf"} or _one(m) or m.value == "indefinite" or _apiece(m) for m in phrase)
        if not room or not (fresh or every) or (any(m.value == "own" for m in phrase) and not (each or every)):
            made.append(mark)
            k += 1
            continue
        number = (
            max((heads(marks, i) for i in range(k + 1) if marks[i].value == mark.value), default=0.0)
            if each or every
            else next((m.number for m in phrase if m.kind == "num"), 1.0)
        )
        while made and (
            made[-1].kind in {"num", "clf"}
            or made[-1].value == "each"
            or (made[-1].kind, made[-1].value) in {("det", "both"), ("det", "definite")}
        ):
            made.pop()
        made.append(Mark("num", "", number or 1.0, False, mark.first, mark.first, ""))
        made += [*(m for m in phrase if m.kind in {"adj", "size"}), *relative]
        made.append(replace(replace(bedroom_of(marks[j], mark.value), plural=number > 1), text=f"{mark.text} {marks[j].text}"))
        made += [m for m in phrase if m.kind == "amount"]
        k = j + 1 + (j + 1 < len(marks) and marks[j + 1].value == "each")
    return made


def _persons(marks: list[Mark], heard: Words) -> list[Mark]:
    """Read "four students, each with a room of their own" as four bedrooms."""
    count = _headcount(marks, heard)
    place = next((k for k, m in enumerate(marks) if _apiece(m)), None)
    if not count or place is None:
        return marks
    j = place + 1
    while (
        j < len(marks)
        and j - place < 9
        and (marks[j].kind in PARTS | {"amount"} or marks[j].value in {"has", "one"} or marks[j].text == "的")
    ):
        j += 1
    room = marks[j] if j < len(marks) else None
    if room is None or not ((room.kind == "room" and room.value == "bedroom") or (room.kind == "unit" and room.value == "rooms")):
        return marks
    number = Mark("num", "", float(count), False, marks[place].first, marks[place].last, marks[place].text)
    amounts = [m for m in marks[place:j] if m.kind == "amount"]
    behind = marks[j + 1 :]
    if (
        behind
        and behind[0].kind == "join"
        and any(m.kind == "room" and m.value in {"bathroom", "wc"} for m in behind[1:4])
        and behind[1].kind != "num"
    ):
        shared = behind[1].value == "indefinite" or any(m.value == "shared" for m in behind[1:4])
        if not shared:  # "each with their own bedroom and bathroom"
            behind = [replace(behind[0], kind="cue", value="has", text="with"), replace(number, kind="det", value="own"), *behind[1:]]
    return [*marks[:place], number, replace(room, kind="room", value="bedroom", number=0.0, plural=True), *amounts, *behind]


def _apiece(mark: Mark) -> bool:
    """Whether a mark says that each of several people gets something."""
    return mark.value == "each" or mark.text.replace(" ", "") in EACH


def _headcount(marks: Sequence[Mark], heard: Words) -> int:
    """Return how many people are spoken of; 0 where nobody says."""
    for k, mark in enumerate(marks):
        words = mark.text.split()
        named = bool(PERSONS & set(words)) or mark.text.replace(" ", "").endswith(HAN_PERSONS)
        if mark.kind == "room" or not named:
            continue
        before = [m.number for m in marks[max(0, k - 2) : k] if m.kind == "num"]
        inside = [m.number for w in words if (m := heard.lexicon.trie.get(w, {}).get("")) is not None and m.kind == "num"]
        number = (before or inside or [0.0])[-1]
        if 1 < number <= 9:
            return int(number)
    return 0
