"""Ways said with verbs of going: "from the foyer you step into ...", "has a door to", "... and to a second bedroom", "you enter by ... to ..."."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, sentences_of

SEEN = {"ve", "vea", "ver", "verse", "vean", "see", "seen", "sehen", "sieht", "sichtbar"}
ACCESS = {"door", "doors", "access", "puerta", "acceso", "salida", "tuer", "zugang", "ausgang", "exit", "entrance", "entrada"}
INTO = {"to", "into", "onto", "in", "al", "a", "ins", "in den", "in die", "in das", "zum", "zur"}
TOWARDS = {"to", "into", "onto", "al", "a"}  # behind an "and" that takes up the way before it
LIGHT = {"fill", "verb", "adverb", "comma", "word", "det", "join"}  # between a starting point and the verb of going
WAYS = {"leads", "door", "from_to", "thru", "again"}
LONG = 7  # marks between a starting point and where one comes from there


def ways(marks: Sequence[Mark]) -> list[Mark]:
    """Return the marks with each way said by a cue."""
    made: list[Mark] = []
    for sentence in sentences_of(marks):
        made += _again(_through(_entering(_going(_access(_unseen(sentence))))))
    return made


def _into(mark: Mark) -> bool:
    """Whether a mark says where one comes to; an English article does not."""
    return mark.text in INTO and (mark.kind != "det" or mark.text == "al")


def room_at(marks: Sequence[Mark], k: int) -> int | None:
    """Return the place of the room that a phrase beginning at k names."""
    while k < len(marks) and (marks[k].kind in {"det", "adj", "size", "num", "ord", "adverb"} or marks[k].text == "el"):
        k += 1
    return k if k < len(marks) and marks[k].kind in {"room", "suite"} else None


def _unseen(marks: list[Mark]) -> list[Mark]:
    """Take what is only seen for no way: "que desde la entrada se vea el salón"; and read "tanto con A como con B" as both."""
    made = list(marks)
    if any(m.text in SEEN for m in marks):
        made = [replace(m, kind="word") if (m.kind, m.value) == ("cue", "from") else m for m in made]
    for k, mark in enumerate(made):
        if mark.text in {"entrada", "entrance"} and mark.kind == "room" and k and _beside(made, k):
            made[k] = replace(mark, kind="word")  # "un aseo junto a la entrada": near the door, no room of its own
        if "tanto" in mark.text.split() and (both := next((j for j in range(k + 2, len(made)) if made[j].text == "como"), 0)):
            made[both] = replace(made[both], kind="join", value="and", text="y")
            made[k] = replace(mark, text=mark.text.replace(" tanto", ""))
            del made[both + 1 : both + 1 + (made[both + 1].text in {"con", "a", "en", "al"})]
            return made
        if (mark.text, mark.kind) == ("por", "det") and not any(m.kind == "room" for m in made[k + 1 : k + 4]):
            made[k] = replace(mark, kind="fill", value="")
    return made


def _beside(marks: list[Mark], k: int) -> bool:
    """Whether the entrance at k is only where something lies, and nowhere a room that is listed."""
    near = next((m for m in reversed(marks[:k]) if m.kind != "det" and m.text != "el"), None)
    return near is not None and (near.kind, near.value) == ("cue", "near")


def _access(marks: list[Mark]) -> list[Mark]:
    """Read "has no door to the kitchen" as not joined to it: the door is what is had, not the kitchen."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        if (mark.kind, mark.value) == ("cue", "has"):
            ahead = next((m for m in marks[k + 1 : k + 4] if m.kind not in {"neg", "det", "adverb", "adj", "fill"}), None)
            if ahead is not None and ahead.kind == "cue" and ahead.value in {"door", "leads"} and ACCESS & set(ahead.text.split()):
                made.append(replace(mark, kind="verb", value=""))
                continue
        made.append(mark)
    return made


def _going(marks: list[Mark]) -> list[Mark]:
    """Read "from the foyer you step into the living room" and "from the hall to the bedrooms"."""
    made = list(marks)
    for k, mark in enumerate(marks):
        if (mark.kind, mark.value) != ("cue", "from"):
            continue
        start = room_at(made, k + 1)
        if start is None:
            pronoun = k + 1 < len(made) and made[k + 1].kind == "pron"
            start = k + 1 if pronoun else None
        if start is None:
            continue
        j = start + 1
        while (
            j < min(len(made) - 1, start + LONG)
            and (made[j].kind in LIGHT or made[j].value in {"only", "one", "1.0"})
            and not (_into(made[j]) and room_at(made, j + 1) is not None)
        ):
            j += 1
        if j >= len(made):
            continue
        going = (
            (made[j].kind, made[j].value) == ("cue", "leads")
            or made[j].kind == "enter"
            or (made[j].kind, made[j].value) == ("flag", "reachable")
            or _into(made[j])
        )
        if going and room_at(made, j + 1) is not None:
            made[j] = replace(made[j], kind="cue", value="leads")
            del made[start + 1 : j]  # "one should be able to"
            return [*made[: start + 2], *_going(made[start + 2 :])]
    return made


def _entering(marks: list[Mark]) -> list[Mark]:
    """Read "se pasa por un vestíbulo al salón", "you come in through the porch to the hall": the second room lies behind the first."""
    made = list(marks)
    for k, mark in enumerate(marks):
        which = k > 0 and (marks[k - 1].text in {"which", "that"} or marks[k - 1].kind == "relative")
        if mark.kind == "enter" and which and k + 1 < len(marks) and marks[k + 1].kind == "cue":
            made[k] = replace(mark, kind="verb")  # "the kitchen, which you enter from the dining room"
            made[k + 1] = replace(marks[k + 1], value="door")
            continue
        if mark.kind != "enter" or mark.text.split()[-1] not in {"por", "through", "via", "durch", "by", "ueber"}:
            continue
        room = room_at(made, k + 1)
        if room is not None and room + 1 < len(made) and _into(made[room + 1]) and room_at(made, room + 2) is not None:
            made[room + 1] = replace(made[room + 1], kind="cue", value="leads")
    return made


def _through(marks: list[Mark]) -> list[Mark]:
    """Read "connects to the kitchen through the utility room" as by way of it."""
    made = list(marks)
    for k in range(2, len(marks) - 1):
        way = any(m.kind == "cue" and m.value in {"leads", "door"} for m in marks[max(0, k - 5) : k])
        if (
            way
            and marks[k].kind == "fill"
            and marks[k].text == "through"
            and marks[k - 1].kind == "room"
            and room_at(marks, k + 1) is not None
        ):
            made[k] = replace(marks[k], kind="cue", value="by")
    return made


def _again(marks: list[Mark]) -> list[Mark]:
    """Read "leads to the master bedroom with its own bath and to a second bedroom": the way goes on behind what the first has."""
    made = list(marks)
    way = had = False
    for k, mark in enumerate(marks):
        if mark.kind == "cue":
            way, had = way or mark.value in WAYS, mark.value == "has" if mark.value in WAYS | {"has"} else had
        joined = k > 0 and marks[k - 1].kind in {"join", "comma"} and marks[k - 1].value != "to"
        turned = k > 0 and marks[k - 1].kind == "but"  # "not to the living room but to the hall"
        if way and ((had and joined) or turned) and mark.text in TOWARDS and _into(mark) and room_at(marks, k + 1) is not None:
            made[k] = replace(mark, kind="cue", value="again")
    return made
