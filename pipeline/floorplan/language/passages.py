"""Ways said without their own words: "through which you reach ...", "and the dining room onto the hall", "whose bathroom ..."."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import ENDS, Mark, Words
from pipeline.floorplan.language.wayfinding import ways

BY = {"durch", "ueber", "von", "aus", "por", "desde", "through", "via", "from"}  # in front of a relative pronoun
ARTICLES = {"das", "die", "den", "dem", "der", "el", "la", "los", "las"}
BRANCH = {"abgeht", "abgehen", "abzweigt", "abzweigen"}  # at the end of a German clause
LYING = {"liegen", "liegt", "grenzen", "anschliessen", "haengen", "haengt", "angeordnet", "aufgereiht"}
REACH = {"erreicht", "erreichen", "betritt", "betreten", "gelangt", "kommt"}
ONE = {("det", "indefinite"), ("pron", "one"), ("det", "other"), ("det", "another"), ("pron", "rest"), ("fill", "")}
WHOSE = {"whose", "cuyo", "cuya", "dessen", "deren"}
FACING = {"dan", "da", "abren", "abre", "salen"}  # "un pasillo al que dan los dormitorios"
INTO = {"al", "a", "onto", "to", "into", "ins", "in", "in den", "in die", "in das", "zum", "zur"}


def written_out(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with what is left unsaid put in."""
    marks = _two_doors(marks)
    return _whose(ways(_elliptic(_relative(_rather(marks)), heard)))


def _two_doors(marks: Sequence[Mark]) -> list[Mark]:
    """Read "the bath has two doors: one to the bedroom and one to the hall" as joined to both."""
    made = list(marks)
    for k in range(2, len(marks) - 2):
        counted = made[k].kind == "flag" and made[k].value == "doors" and made[k - 1].kind in {"num", "det"} and made[k - 2].value == "has"
        if not counted or made[k + 1].kind not in {"colon", "comma", "dash", "hyphen"}:
            continue
        rooms: list[Mark] = []
        j = k + 2
        while (start := _toward(made, j)) is not None and (place := _room_at(made, start)) is not None:
            rooms += [replace(made[j - 1], kind="join", value="and", text="and")] if rooms else []
            rooms += made[start : place + 1]
            j = place + 1 + (place + 1 < len(made) and made[place + 1].kind in {"comma", "join"})
        if rooms:
            end = j - (made[j - 1].kind in {"comma", "join"})
            return [*made[: k - 2], replace(made[k], kind="cue", value="door"), *rooms, *_two_doors(made[end:])]
    return made


def _toward(marks: Sequence[Mark], k: int) -> int | None:
    """Return where the room begins in "one to the hall"; None for anything else."""
    while k < len(marks) and (marks[k].number == 1.0 or (marks[k].kind, marks[k].value) in ONE):
        k += 1
    return k + 1 if k < len(marks) and (marks[k].text in INTO or marks[k].text == "with") else None


def _rather(marks: Sequence[Mark]) -> list[Mark]:
    """Read "rather two bathrooms than a dining room": what stands behind "than" where nothing is compared is not wanted."""
    made = list(marks)
    for k, mark in enumerate(marks):
        if (mark.kind, mark.text) != ("fill", "than"):
            continue
        start = max((i for i in range(k) if marks[i].kind in ENDS), default=-1) + 1
        ahead = marks[k + 1] if k + 1 < len(marks) else None
        named = ahead is not None and ((ahead.kind, ahead.value) == ("det", "definite") or ahead.kind in {"num", "amount", "pron"})
        compared = named and any(m.kind == "size" for m in marks[start:k])
        compared = compared or any(m.kind in {"cmp", "factor"} for m in marks[start:k])
        if not compared and any(m.kind == "room" for m in marks[start:k]):
            made[k] = replace(mark, kind="neg")
    return made


def _relative(marks: Sequence[Mark]) -> list[Mark]:
    """Read "a closet through which you reach the bathroom", "durch das man ins Bad kommt", "a la que solo se entra por la cocina"."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        if end := _branching(marks, k):
            made += [replace(marks[k], kind="relative", value="", text="que"), replace(marks[k], kind="cue", value="leads")]
            made += marks[k + 1 : end]
            k = end + 1
            continue
        pronoun = _pronoun(marks, k)
        way = _way(marks, k + pronoun) if pronoun else None
        if way is None:
            made.append(marks[k])
            k += 1
            continue
        made.append(replace(marks[k], kind="relative", value="", text="que", last=marks[k + pronoun - 1].last))
        made += [m for m in marks[k + pronoun : way] if m.kind == "flag"]
        cue = marks[way]
        entered = cue.kind == "enter"
        made.append(replace(cue, kind="cue", value="door" if entered else "leads"))
        k = way + 1
    return made


def _branching(marks: Sequence[Mark], k: int) -> int:
    """Return the place of the verb in "ein Flur, von dem alle Zimmer abgehen", k being that of "von dem"; 0 for any other clause."""
    beside = marks[k].text == "woran" or (marks[k].text == "an" and k + 1 < len(marks) and marks[k + 1].text in ARTICLES)
    if k < 2 or not (beside or marks[k].text in {"von der", "von dem"}) or marks[k - 1].kind != "comma" or marks[k - 2].kind != "room":
        return 0
    for j in range(k + 1, len(marks)):
        if marks[j].text in (LYING if beside else BRANCH):
            return j
        if marks[j].kind in ENDS:
            break
    return 0


def _pronoun(marks: Sequence[Mark], k: int) -> int:
    """Return how many marks "through which" takes at k; 0 where none stands there."""
    texts = [m.text for m in marks[k : k + 3]]
    if len(texts) > 2 and texts[1] in ARTICLES and texts[2] == "que" and (texts[0] in BY or texts[0] == "a"):
        return 3
    if len(texts) > 1 and texts[0] == "al" and texts[1] == "que":
        return 2
    if texts[0] in {"von dem", "von der", "aus dem"} and k and marks[k - 1].kind == "comma":  # "ein Flur, von dem aus man ins Bad kommt"
        return next((n for n in (2, 3) if len(texts) > n - 1 and texts[n - 1] == "man"), 0)
    if len(texts) > 2 and texts[0] in BY and texts[1] in ARTICLES and texts[2] == "man":
        return 3
    return 2 if len(texts) > 1 and texts[0] in BY and texts[1] == "which" else 0


def _way(marks: Sequence[Mark], k: int) -> int | None:
    """Return the place of the words for going behind a relative pronoun, if a room follows them."""
    for j in range(k, min(k + 4, len(marks) - 1)):
        mark = marks[j]
        if mark.text in FACING and marks[j + 1].kind in {"det", "room", "num"}:
            return j
        reached = (mark.kind, mark.value) == ("flag", "reachable")
        going = (mark.kind == "cue" and mark.value in {"in", "leads"}) or mark.kind == "enter" or mark.text in INTO or reached
        if going:
            return j if any(m.kind == "room" for m in marks[j + 1 : j + 4]) else None
        if mark.kind not in {"flag", "fill", "adverb", "verb", "word"}:
            return None
    return None


def _elliptic(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Read "..., and from the dining room to the hall", "and the dining room onto the hall" behind a way that was said with its verb."""
    made = list(marks)
    for k in range(1, len(made)):
        if made[k - 1].kind not in {"join", "comma"} or "or" in made[k - 1].value:
            continue
        start = max((i for i in range(k) if made[i].kind in ENDS), default=-1) + 1
        said = any(m.kind == "cue" and m.value in {"leads", "thru", "thru_to", "door"} for m in made[start:k])
        whence = (made[k].kind == "cue" and made[k].value == "from") or (heard.lexicon.language == "es" and made[k].text in {"del", "de"})
        if not said:
            continue
        j = _room_at(made, k + 1 if whence else k)
        if j is None or j + 2 >= len(made) or made[j + 1].text not in INTO or _room_at(made, j + 2) is None:
            continue
        if whence:
            made[k] = replace(made[k], kind="fill")
        made[j + 1] = replace(made[j + 1], kind="cue", value="leads")
    return made


def _whose(marks: Sequence[Mark]) -> list[Mark]:
    """Read "the bedroom, whose bathroom ..." as "with a bathroom", and "and another one to the hall" without its door."""
    made: list[Mark] = []
    skipped = 0
    for k, mark in enumerate(marks):
        j = k
        while j < len(marks) and ((marks[j].kind, marks[j].value) in {("det", "another"), ("pron", "one")} or marks[j].number == 1.0):
            j += 1
        if skipped > k:
            continue
        if mark.kind == "relative" and mark.text in WHOSE and _room_at(marks, k + 1) is not None:
            if made and made[-1].kind == "comma":
                made.pop()
            made.append(replace(mark, kind="cue", value="has", text="with"))
        elif (
            (mark.kind, mark.value) == ("det", "another") and made and made[-1].kind == "join" and j < len(marks) and marks[j].text in INTO
        ):
            skipped = j
        else:
            made.append(mark)
    return made


def _room_at(marks: Sequence[Mark], k: int) -> int | None:
    """Return the place of the room that a phrase beginning at k names."""
    while k < len(marks) and marks[k].kind in {"det", "adj", "size", "pron"}:
        k += 1
    return k if k < len(marks) and marks[k].kind == "room" else None
