"""Notes and lists: "kitchen-bedroom: no door", "Ground: ... Upper: ...", "kitchen and dining together", "2 ZKBB", "one single"."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.jottings import jotted
from pipeline.floorplan.language.marks import Mark, Words

HEADINGS = {
    "ground": "0",
    "lower": "0",
    "baja": "0",
    "bajo": "0",
    "inferior": "0",
    "superior": "1",
    "primera": "1",
    "upper": "1",
    "top": "1",
    "alta": "1",
}  # in front of a colon
ATTIC = {"dg", "dachgeschoss"}
BESIDE = {"nebeneinander", "beieinander", "aneinander", "side by side"}
COUNTED = {"first": "1", "second": "2"}  # the same where a prompt has a ground floor
CLOSERS = {"comma", "stop", "line", "close", "join"}
SOCIAL = {"kitchen", "dining_room", "living_room", "family_room"}
SINGLE = {"single", "individual", "sencilla", "einzelne"}
LETTERS = {"k": "kitchen", "d": "hallway", "b": "bathroom", "t": "balcony"}  # "ZKDB": rooms, kitchen, hall, bathroom


def noted(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with shorthand of lists and notes written out."""
    made = jotted(_doors(_headed(_summed(_lettered(marks, heard))), heard), heard)
    made = _bare(_limited(_indexed(made)))
    made = _numbered(_singles(_together(_paired(_more(_one_with(_other(made)))))))
    return _beside(_largest(_no_two(made)))


def _other(marks: Sequence[Mark]) -> list[Mark]:
    """Read "one bedroom of 14 and another of 11 m2" as two bedrooms with their areas."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        room = next((m for m in reversed(made) if m.kind == "room"), None)
        j = k + 1 + (k + 1 < len(marks) and marks[k + 1].kind in {"fill", "bound"})
        area = marks[j] if j < len(marks) and marks[j].kind == "amount" and marks[j].value == "area" else None
        if (mark.kind, mark.value) != ("det", "another") or room is None or area is None:
            continue
        made.append(replace(room, first=mark.last, last=mark.last, plural=False))
        bare = [i for i in range(max(0, len(made) - 6), len(made)) if made[i].kind == "num" and made[i].value == "figure"]
        if bare and made[bare[-1] + 1].kind == "join":  # "of 14 and": the same unit
            number = made[bare[-1]]
            made[bare[-1]] = replace(area, number=number.number, high=None, bound="", first=number.first, last=number.last)
    return made


def _one_with(marks: Sequence[Mark]) -> list[Mark]:
    """Read "3 hab (una con baño)" as one of them."""
    made = list(marks)
    for k in range(1, len(marks) - 1):
        article = (marks[k].kind, marks[k].value) == ("det", "indefinite") and marks[k - 1].kind in {"open", "comma", "colon"}
        if article and (marks[k + 1].kind, marks[k + 1].value) == ("cue", "has"):
            made[k] = replace(marks[k], kind="pron", value="one", number=1.0)
    return made


def _more(marks: Sequence[Mark]) -> list[Mark]:
    """Read "dos habitaciones más", "two bedrooms more" as further ones."""
    made: list[Mark] = []
    for mark in marks:
        counted = len(made) > 1 and made[-1].kind == "room" and made[-2].kind == "num"
        if mark.text in {"mas", "more"} and counted and mark.kind in {"det", "fill", "adverb", "word", "join"}:
            made.insert(len(made) - 2, replace(made[-2], kind="det", value="another"))
        else:
            made.append(mark)
    return made


def _indexed(marks: Sequence[Mark]) -> list[Mark]:
    """Read "bedroom A ..., bedroom B ..." as the first and the second."""
    letters = {m.text for room, m in itertools.pairwise(marks) if room.kind == "room" and m.kind in {"det", "word", "fill"}}
    if not {"a", "b"} <= letters:
        return list(marks)
    made = list(marks)
    for k in range(1, len(made)):
        if made[k - 1].kind == "room" and made[k].text in "abcd" and made[k].kind in {"det", "word", "fill"}:
            made[k] = replace(made[k], kind="num", value="figure", number=float("abcd".index(made[k].text) + 1))
    return made


def _limited(marks: Sequence[Mark]) -> list[Mark]:
    """Read "no room larger than 18 m2" as a limit of every room, not of the home."""
    made = list(marks)
    for k in range(len(marks) - 2):
        none = made[k].kind == "neg" and (made[k + 1].kind, made[k + 1].value) == ("unit", "rooms")
        j = k + 2 + (made[k + 2].kind == "verb")
        if none and j < len(made) and made[j].kind == "amount" and made[j].value == "area" and made[j].bound in {"least", "most"}:
            amount = replace(made[j], bound="most" if made[j].bound == "least" else "least")
            return [*made[:k], replace(made[k + 1], kind="every", value="", first=made[k].first), amount, *_limited(made[j + 1 :])]
    return made


def _bare(marks: Sequence[Mark]) -> list[Mark]:
    """Read "bed 12, bath 4, kitchen 8, living 18" as areas [m2] where three rooms and more have a figure each, and no unit is named."""
    places = [
        k
        for k in range(1, len(marks))
        if marks[k].kind == "num" and marks[k].value == "figure" and marks[k - 1].kind == "room" and not marks[k - 1].plural
        if k + 1 >= len(marks) or marks[k + 1].kind in CLOSERS
    ]
    figures = [marks[k].number for k in places]
    measured = any(m.kind == "amount" and m.value == "area" and not m.total for m in marks)
    if len(figures) < 3 or measured or min(figures) < 2 or max(figures) > 60 or sum(figures) < 6 * len(figures):
        return list(marks)
    return [replace(m, kind="amount", value="area") if k in places else m for k, m in enumerate(marks)]


def _no_two(marks: Sequence[Mark]) -> list[Mark]:
    """Read "no two bedrooms share a wall" as said of all of them."""
    made = list(marks)
    for k in range(1, len(marks) - 2):
        two = made[k - 1].kind == "neg" and made[k].kind == "num" and made[k].number == 2 and made[k + 1].kind == "room"
        if two and made[k + 1].plural and any(m.kind in {"verb", "cue"} for m in made[k + 2 : k + 4]):
            made[k] = replace(made[k], kind="det", value="all", number=0.0)
    return made


ROOM = {"pieza", "habitacion", "estancia", "cuarto"}  # any room, where the largest of all is meant


def _largest(marks: Sequence[Mark]) -> list[Mark]:
    """Read "the largest room is the kitchen" and "el salón es la pieza más grande" as "the kitchen is the largest"."""
    made = list(marks)
    for k in range(len(made) - 2):
        if made[k].kind == "adj" and made[k].value == "largest" and (made[k + 1].kind, made[k + 1].value) == ("unit", "rooms"):
            j = k + 2
            while j < len(made) and made[j].kind in {"verb", "det", "adverb"}:
                j += 1
            if j < len(made) and made[j].kind == "room" and made[k + 2].kind == "verb":
                return [*made[:k], *made[k + 3 : j + 1], made[k + 2], made[k], *made[j + 1 :]]
    for k in range(3, len(made) - 1):
        said = made[k - 3].kind == "room" and made[k - 2].kind == "verb"
        if made[k].text in ROOM and said and made[k + 1].text == "mas grande":
            made[k : k + 2] = [replace(made[k + 1], kind="adj", value="largest", first=made[k].first)]
            return made
    return made


def _beside(marks: Sequence[Mark]) -> list[Mark]:
    """Read "they lie side by side" as "next to each other"."""
    made: list[Mark] = []
    for mark in marks:
        if mark.kind == "reciprocal" and mark.text in BESIDE and not (made and made[-1].kind == "cue"):
            made.append(replace(mark, kind="cue", value="near"))
        made.append(mark)
    return made


def _lettered(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Read German "3 ZKBB" as three rooms, kitchen, bathroom and balcony."""
    made: list[Mark] = []
    for mark in marks:
        made.append(mark)
        word = mark.text.rsplit(" ", 1)[-1]
        if heard.lexicon.language != "de" or mark.kind != "amount" or mark.value != "rooms" or not word.startswith("zk"):
            continue
        for k, letter in enumerate(word[1:], 1):
            kind = "balcony" if letter == "b" and "b" in word[:k] else LETTERS.get(letter, "")
            if kind:
                made += [Mark("comma", "", 0.0, False, mark.last, mark.last, ","), replace(mark, kind="room", value=kind, number=0.0)]
    return made


def _summed(marks: Sequence[Mark]) -> list[Mark]:
    """Read a plus between rooms as "and"."""
    return [replace(m, kind="join", value="and") if m.text == "+" and m.kind == "bound" else m for m in marks]


def _headed(marks: Sequence[Mark]) -> list[Mark]:
    """Read "Ground: kitchen, WC. Upper: two bedrooms" as storeys."""
    known = HEADINGS | (COUNTED if any(m.text == "ground" for m in marks) else {})
    made = list(marks)
    upper = any(m.kind == "level" and m.value == "1" and not ATTIC & set(m.text.split()) for m in marks)
    for k, mark in enumerate(marks):
        if mark.kind == "level" and upper and ATTIC & set(mark.text.split()):
            made[k] = replace(mark, value="2")  # "EG ..., OG ..., DG ..."
    for k, mark in enumerate(marks[:-1]):
        if mark.kind in {"word", "ord", "fill", "adj", "size"} and mark.text in known and marks[k + 1].kind == "colon":
            made[k] = replace(mark, kind="level", value=known[mark.text], number=0.0)
    return made


def _doors(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Read "no bathroom-kitchen door": the second room is no adjective of the door where another stands in front."""
    made: list[Mark] = []
    for mark in marks:
        paired = mark.kind == "ignored" and mark.text.endswith(" door") and bool(made) and made[-1].kind in {"room", "cue"}
        found = heard.lexicon.find(heard.texts[: mark.last - 1], mark.first) if paired else None
        if found is not None and found[1].kind == "room" and found[0] == mark.last - 1:
            cut = mark.last - 1
            made.append(replace(mark, kind="room", value=found[1].value, last=cut, text=mark.text.removesuffix(" door")))
            made.append(replace(mark, kind="flag", value="doors", first=cut, text="door"))
        else:
            made.append(mark)
    return made


def _paired(marks: Sequence[Mark]) -> list[Mark]:
    """Read "kitchen-bedroom: door", "kitchen - living: open" as a way between the two."""
    made = list(marks)
    for k in range(len(made) - 2):
        if made[k + 1].kind in {"flag", "adj"} and k > 1 and made[k - 1].text == "<->":  # "kitchen <-> living room open"
            made.insert(k + 1, Mark("colon", "", 0.0, False, made[k].last, made[k].last, ":"))
        way = {"flag": "door", "adj": "open"}.get(made[k + 2].kind, "") if made[k + 1].kind == "colon" and k + 2 < len(made) else ""
        ends = k + 3 >= len(made) or made[k + 3].kind in CLOSERS
        if not way or not ends or made[k].kind != "room" or made[k + 2].value not in {"doors", "open"}:
            continue
        j = k - 1 - (k > 1 and (made[k - 1].kind in {"comma", "slash", "dash"} or made[k - 1].text == "<->"))
        if j >= 0 and made[j].kind == "room" and (j == 0 or made[j - 1].kind in CLOSERS):
            cue = replace(made[k + 2], kind="cue", value=way)
            made[j + 1 : k + 3] = [cue, made[k], *([replace(made[k + 1], kind="fill")] * (k + 1 - j - 1))]
    return made


def _together(marks: Sequence[Mark]) -> list[Mark]:
    """Read "kitchen and dining together" as one open space; "together 40 m2" is a sum."""
    made = list(marks)
    for k, mark in enumerate(marks):
        ends = k + 1 >= len(marks) or marks[k + 1].kind in CLOSERS
        said = (mark.kind, mark.value) == ("flag", "total") or mark.kind == "reciprocal"
        if said and mark.text in {"together", "zusammen", "juntos", "juntas"} and ends and k > 2:
            joined = marks[k - 2].kind == "join" and {marks[k - 1].value, marks[k - 3].value} <= SOCIAL
            made[k] = replace(mark, kind="flag", value="open_plan") if joined else mark
    return made


def _singles(marks: Sequence[Mark]) -> list[Mark]:
    """Read "three double bedrooms and one single" as four bedrooms."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        ahead = marks[k + 1].kind if k + 1 < len(marks) else "stop"
        before = made[-1] if made else None
        counted = before is not None and (
            before.kind == "num" or (before.kind, before.value) in {("pron", "one"), ("det", "indefinite"), ("det", "another")}
        )
        beds = any(m.kind == "room" and m.value.startswith("bedroom") for m in made[-6:])
        if mark.text.removesuffix("es").removesuffix("s") in SINGLE and ahead in CLOSERS and counted and beds:
            assert before is not None
            number = before if before.kind == "num" else replace(before, kind="num", value="", number=1.0)
            made[-1:] = [replace(before, kind="det", value="another"), number]
            made.append(replace(mark, kind="room", value="bedroom", plural=number.number > 1))
        else:
            made.append(mark)
    return made


def _numbered(marks: Sequence[Mark]) -> list[Mark]:
    """Read "the first is twice the second" as said of the rooms that were counted before."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        ahead = marks[k + 1].kind if k + 1 < len(marks) else "stop"
        counted = next((m for m in reversed(made) if m.kind == "room" and m.plural), None)
        named = len(made) > 1 and made[-2].kind == "det" and made[-2].value == "definite"
        if (
            mark.kind == "ord"
            and named
            and counted is not None
            and ahead in {"verb", "factor", "cmp", "comma", "stop", "line", "cue", "amount"}
        ):
            made.append(replace(counted, plural=False, first=mark.last, last=mark.last))
    return made
