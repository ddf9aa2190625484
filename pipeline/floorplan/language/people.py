"""Rooms told by who they are for: "the two boys each get a room", "the nanny, whose room ...", "the grandparents have a bedroom"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark
from pipeline.floorplan.language.wayfinding import room_at

ENDS = {"stop", "line"}
WHOSE = {"whose", "cuya", "cuyo", "cuyas", "cuyos", "dessen", "deren"}
EACH = {"each", "apiece", "cada uno", "cada una", "je", "jeweils", "jeder", "jedes", "cada"}
LIGHT = {"comma", "verb", "fill", "adverb", "det", "cue", "pron", "word", "num"}  # between people and the room that each of them gets
FAR = 9  # marks


def housed(marks: Sequence[Mark]) -> list[Mark]:
    """Return the marks with the rooms of people named as theirs."""
    return _one_for(_nounless(_partial(_counted(_having(_theirs(_for(_each(_whose(_bracketed(list(marks)))))))))))


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


def _one_for(marks: list[Mark]) -> list[Mark]:
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


def _bedroom(mark: Mark) -> bool:
    return (mark.kind, mark.value) == ("room", "bedroom") or (mark.kind == "unit" and mark.value == "rooms")


def _of(mark: Mark, owner: Mark) -> Mark:
    """Return a bedroom of somebody."""
    first, last = min(mark.first, owner.first), max(mark.last, owner.last)
    return replace(mark, kind="room", value=f"bedroom/{owner.value}", number=0.0, first=first, last=last)


def _whose(marks: list[Mark]) -> list[Mark]:
    """Read "the nanny, whose room is next to the nursery, has her own bath" as "the nanny's room is ..., has ..."."""
    made = list(marks)
    for k in range(len(made) - 3, -1, -1):
        if made[k].kind != "owner":
            continue
        j = k + 1 + (made[k + 1].kind == "comma")
        if j + 1 < len(made) and made[j].text in WHOSE and _bedroom(made[j + 1]):
            made[k : j + 2] = [_of(made[j + 1], made[k])]
    return made


def _each(marks: list[Mark]) -> list[Mark]:
    """Read "the two children have a room each" and "a room for each of the two children" as two rooms of children."""
    made = list(marks)
    for k, mark in enumerate(made):
        if mark.kind != "owner":
            continue
        near = [m for m in reversed(made[max(0, k - 3) : k]) if (m.kind == "num" and m.number > 1) or (m.kind, m.value) == ("det", "both")]
        count = near[0].number or 2.0 if near else 0.0
        if not count:
            continue
        number = Mark("num", "", count, False, made[k - 1].first, mark.last, mark.text)
        j = k + 1
        while j < min(len(made), k + FAR) and made[j].kind in LIGHT and not _bedroom(made[j]):
            j += 1
        if j < len(made) and _bedroom(made[j]):  # people, then the room
            behind = j + 1 < len(made) and made[j + 1].text in EACH
            if behind or any(m.text in EACH for m in made[k + 1 : j]):
                start = max(i for i in range(k) if made[i] is near[0])
                return [*made[:start], number, replace(_of(made[j], mark), plural=True), *_each(made[j + 1 + behind :])]
        room = next((i for i in range(k - 1, max(-1, k - FAR), -1) if _bedroom(made[i])), None)
        if room is not None and any(m.text in EACH or m.value == "each" for m in made[room:k]):  # the room, then the people
            start = room - (room > 0 and (made[room - 1].kind == "num" or made[room - 1].value == "indefinite"))
            return [*made[:start], number, replace(_of(made[room], mark), plural=True), *_each(made[k + 1 :])]
    return made


def _for(marks: list[Mark]) -> list[Mark]:
    """Read "a small room for the baby" as the baby's."""
    made = list(marks)
    for k in range(len(made) - 1, -1, -1):
        if k >= len(made) or made[k].kind != "owner":
            continue
        link = _link(made, k)
        j = link - 1
        while j > 0 and made[j].kind in {"post", "size", "adj", "amount"}:
            j -= 1
        if link > 0 and made[j].kind == "room" and made[j].value == "bedroom":
            made[j : k + 1] = [_of(made[j], made[k]), *made[j + 1 : link]]
        elif link > 0 and made[j].kind == "amount" and made[j].value == "rooms":  # "two rooms for the boys"
            made[j : k + 1] = [replace(made[j], kind="num", value=""), replace(_of(made[j], made[k]), plural=True)]
    return made


def _link(marks: Sequence[Mark], k: int) -> int:
    """Return the place of the "for" in front of the people at k; -1 where there is none."""
    j = k - 1
    while j > 0 and (marks[j].kind in {"det", "adj"} or marks[j].text in POSSESSIVE) and marks[j].text.split()[0] not in FOR:
        j -= 1
    return j if j >= 0 and marks[j].text and marks[j].text.split()[0] in FOR else -1


def _theirs(marks: list[Mark]) -> list[Mark]:
    """Read "the nanny's room", and in Spanish "la de los niños" by itself."""
    made = list(marks)
    for k in range(len(made) - 1, -1, -1):
        article = k > 0 and made[k - 1].text.split(" ")[-1] in {"la", "el", "al"} and not (k > 1 and made[k - 2].kind in {"room", "post"})
        if k < len(made) and made[k].kind == "adj" and made[k].text.startswith(("de ", "para ")) and article:
            made[k] = _of(made[k], made[k])  # "menos el de invitados"
        if k >= len(made) or made[k].kind != "owner":
            continue
        link = _link(made, k)
        if k + 1 < len(made) and _bedroom(made[k + 1]) and (made[k + 1].kind == "room" or made[k + 1].text == "room"):
            made[k : k + 2] = [_of(made[k + 1], made[k])]
        elif link > 0 and made[link - 1].text in {"la", "el", "al"} and not (link > 1 and made[link - 2].kind in {"room", "post"}):
            made[link : k + 1] = [_of(replace(made[k], first=made[link].first), made[k])]
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
            before is not None and (before.text in FOR or before.kind not in ENDS | {"comma", "join", "colon", "line", "but"})
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
            made += [*marks[j:room], _of(marks[room], mark)]
            k = room + 1
    return made


COMPARED = {"smaller", "larger", "1.35", "1.3", "0.75"}
FOR = {"para", "for", "fuer", "de", "del", "von"}
POSSESSIVE = {
    "el",
    "mi",
    "mis",
    "su",
    "sus",
    "my",
    "our",
    "his",
    "her",
    "their",
    "nuestro",
    "nuestra",
    "nuestros",
    "mein",
    "meine",
    "unser",
    "unsere",
}
BEING = {"son", "seran", "are", "sind"}


def _counted(marks: list[Mark]) -> list[Mark]:
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
            return _counted([*made[:start], made[k], made[j], *([] if light else between), *made[k + 1 :]])
    return made
