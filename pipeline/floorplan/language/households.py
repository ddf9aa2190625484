"""People who have rooms: "the parents get a bedroom with bath", "the two kids a room each", "die Oma hat ihr eigenes", "奶奶的房间"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, Words

ENDS = {"stop", "line", "comma", "close", "colon"}
LINKING = {"verb", "adverb", "fill"}  # between people and what they get
PHRASE = {"det", "num", "clf", "adj", "size", "bound", "amount"}
EACH = {"每 人", "每 个 人", "每 位", "je ein", "je eine", "je einen"}
TOO = {"auch", "ebenfalls", "ebenso", "too", "also", "as well", "tambien", "也", "也 是", "也 有"}
OF = {"der", "des", "von", "de", "del", "for", "fuer", "para"}


def settled(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with bedrooms in the place of people who have one."""
    made = _couple(list(marks)) if heard.lexicon.language == "de" else list(marks)
    if any(m.kind == "owner" for m in made):
        made = _theirs(_bathed(_given(_named(_left_out(made)))))
    return _completed(made)


def _couple(marks: list[Mark]) -> list[Mark]:
    """Read "das Paar" as people, not as a number."""
    made = list(marks)
    for k in range(1, len(made)):
        if made[k].kind == "num" and made[k].text == "paar" and made[k - 1].text in {"das", "dem", "des"}:
            made[k] = replace(made[k], kind="owner", value="primary", number=0.0)
    return made


def _bedroom(mark: Mark, role: str, *, plural: bool = False) -> Mark:
    return replace(mark, kind="room", value=f"bedroom/{role}", number=0.0, plural=plural)


def _is_room(mark: Mark, role: str) -> bool:
    """Whether a mark names a bedroom that people of a role may have, or just a room."""
    return (mark.kind == "room" and mark.value in {"bedroom", f"bedroom/{role}"}) or (mark.kind == "unit" and mark.value == "rooms")


def _named(marks: list[Mark]) -> list[Mark]:
    """Read "奶奶的房间" and "das Zimmer der Großmutter" as one room."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark = marks[k]
        of = k + 2 < len(marks) and mark.kind == "owner" and marks[k + 1].text in {"的", "'s"} and _is_room(marks[k + 2], mark.value)
        if of or (k + 1 < len(marks) and mark.kind == "owner" and marks[k + 1].kind == "unit" and _is_room(marks[k + 1], mark.value)):
            end = k + (2 if of else 1)
            made.append(replace(_bedroom(mark, mark.value), last=marks[end].last, text=f"{mark.text} {marks[end].text}"))
            k = end + 1
        elif mark.kind == "unit" and mark.value == "rooms" and (j := _person(marks, k + 1)) and not (made and made[-1].kind == "num"):
            made.append(replace(_bedroom(mark, marks[j].value), last=marks[j].last, text=f"{mark.text} {marks[j].text}"))
            k = j + 1
        else:
            made.append(mark)
            k += 1
    return made


def _person(marks: Sequence[Mark], k: int) -> int:
    """Return the place of the people whose room stands in front of k: "of the grandmother"; 0 for none."""
    start = k
    while k < len(marks) and k - start < 3 and (marks[k].text in OF or marks[k].kind in {"det", "fill"}):
        k += 1
    return k if start < k < len(marks) and marks[k].kind == "owner" and marks[start].text in OF else 0


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
            made.append(replace(_bedroom(person, person.value, plural=True), first=mark.last, last=mark.last, text="zimmer"))
    return made


def _one(mark: Mark) -> bool:
    return (mark.kind, mark.value) == ("pron", "one") and mark.text.startswith("一")


def _count(marks: Sequence[Mark], k: int) -> float:
    """Return how many people stand at k: "the two kids"; 0 where nobody says."""
    for m in reversed(marks[max(0, k - 3) : k]):
        if m.kind == "num" and m.number > 1:
            return m.number
        if (m.kind, m.value) == ("det", "both"):
            return 2.0
        if m.kind not in {"det", "clf", "fill"}:
            break
    return 0.0


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
            and ((marks[j].kind in LINKING and marks[j].text not in EACH) or (marks[j].value == "has" and marks[j].text != "with"))
        ):
            j += 1
        start = j
        while j < len(marks) and (marks[j].kind in PHRASE or marks[j].text in EACH or _one(marks[j])):
            j += 1
        phrase, relative = marks[start:j], marks[j:j]
        end = next((i for i in range(j, min(j + 6, len(marks))) if marks[i].text == "的"), 0)
        if end and marks[j].value == "has":  # "给老人一间带卫生间的卧室"
            relative, j = marks[j : end + 1], end + 1
        room = mark.kind == "owner" and j < len(marks) and bool(phrase) and _is_room(marks[j], mark.value)
        each = any(m.text in EACH or m.value == "each" for m in phrase) or (j + 1 < len(marks) and marks[j + 1].value == "each")
        every = k > 0 and (marks[k - 1].kind, marks[k - 1].value) == ("det", "each")
        fresh = any(m.kind in {"num", "clf"} or _one(m) or m.value in {"indefinite", "each"} or m.text in EACH for m in phrase)
        if not room or not (fresh or every) or (any(m.value == "own" for m in phrase) and not (each or every)):
            made.append(mark)
            k += 1
            continue
        number = (
            max((_count(marks, i) for i in range(k + 1) if marks[i].value == mark.value), default=0.0)
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
        made.append(replace(_bedroom(marks[j], mark.value, plural=number > 1), text=f"{mark.text} {marks[j].text}"))
        made += [m for m in phrase if m.kind == "amount"]
        k = j + 1 + (j + 1 < len(marks) and marks[j + 1].value == "each")
    return made


def _bathed(marks: list[Mark]) -> list[Mark]:
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
            made[-1:] = [_bedroom(mark, mark.value), *given]
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
                made[-1] = _bedroom(mark, mark.value)
    return made


def _completed(marks: list[Mark]) -> list[Mark]:
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


def _theirs(marks: list[Mark]) -> list[Mark]:
    """Read "zwischen ihren Zimmern" as the bedrooms of those who were spoken of last."""
    made = list(marks)
    for k in range(1, len(made)):
        room = made[k].kind == "unit" and made[k].value == "rooms" and (made[k - 1].kind, made[k - 1].value) == ("det", "own")
        place = next((i for i in range(k - 1, -1, -1) if made[i].kind == "owner"), None) if room else None
        if place is not None:
            count = _count(made, place)
            made[k] = _bedroom(made[k], made[place].value, plural=True)
            made[k - 1] = replace(made[k - 1], kind="num", value="", number=count) if count else replace(made[k - 1], value="all")
    return made
