"""Doors, openings and walls as subjects: "a door connects A and B", "a wide opening between A and B", "connect A to B", "A - B: open"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import ENDS, Mark, Words, sentences_of

LEADING = {"det", "adj", "size", "num", "ord"}
JOIN = {"connect", "connects", "link", "links", "join", "joins", "connecting", "linking", "joining", "merge", "merging", "combine"}
JOIN |= {"conecta", "conectar", "comunica", "comunicar", "une", "unir", "enlaza", "conecte", "junta", "fusiona", "unificar", "separates"}
OPENERS = {"merge", "merging", "combine", "fusiona", "junta", "unificar"}
WITH = {"and", "to", "with", "from", "y", "con", "a", "al", "e", "into", "&"}
GAPS = {
    "opening",
    "openings",
    "transition",
    "connection",
    "passage",
    "access",
    "apertura",
    "abertura",
    "conexion",
    "transicion",
    "hueco",
    "link",
}
WIDE = {"wide", "large", "big", "open", "broad", "generous", "amplia", "gran", "abierta", "ancha", "amplio", "abierto", "full width"}
SHARED = {"shared", "common", "comun", "compartida", "compartido"}
WALLS = {"wall", "walls", "pared", "muro", "tabique"}
LIGHT = {"det", "adj", "size", "fill", "word", "verb", "adverb", "look", "post"}


def phrased(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with what doors, openings and walls join said of the rooms themselves."""
    if heard.lexicon.language not in {"en", "es"}:
        return list(marks)
    made: list[Mark] = []
    for sentence in sentences_of(marks):
        made += _noted(_ordered(_subject(_ended(sentence))))
    return made


def phrase(marks: Sequence[Mark], k: int) -> int:
    """Return the end of the noun phrase that begins at k; 0 where none does."""
    while k < len(marks) and (marks[k].kind in LEADING or marks[k].text == "el"):
        k += 1
    if k >= len(marks) or marks[k].kind not in {"room", "suite"}:
        return 0
    k += 1
    while k < len(marks) and marks[k].kind in {"adj", "post"} and marks[k - 1].kind in {"room", "post"} and marks[k].text != "open":
        k += 1
    return k


def pair(marks: Sequence[Mark], k: int) -> tuple[int, int, int] | None:
    """Return (end of the first phrase, begin of the second, its end) of "A and B", "A to B" at k."""
    first = phrase(marks, k)
    if not first or first + 1 >= len(marks) or marks[first].text not in WITH:
        return None
    second = phrase(marks, first + 1)
    if not second and marks[first].text == "to" and marks[first + 1].text == "the":
        second = phrase(marks, first + 1)
    return (first, first + 1, second) if second else None


def joined(marks: Sequence[Mark], k: int, end: int, found: tuple[int, int, int], cue: str, none: bool, start: int) -> list[Mark]:
    """Return the sentence with marks[start:end] said as "A <cue> B" (not, where `none`), apart from what stands around it."""
    first, second, _ = found
    at = marks[first]
    texts = {"door": "connected to", "open": "opened up to", "wall": "shares a wall with", "leads": "leads to"}
    made = list(marks[k:first])
    made += [Mark("neg", "", 0.0, False, at.first, at.first, "not")] if none else []
    made.append(Mark("cue", cue, 0.0, False, at.first, at.last, texts[cue]))
    made += marks[second:end]
    before, after = list(marks[:start]), list(marks[end:])
    parted = Mark("stop", "", 0.0, False, marks[start].first, marks[start].first, ".")
    while before and before[-1].kind in {"comma", "join"}:
        before.pop()
    if any(m.kind in {"room", "suite", "home"} for m in before):
        before.append(parted)
    else:
        before = []
    if after and after[0].kind not in ENDS:
        after = [parted, *(after[1:] if after[0].kind in {"comma", "join"} else after)]
    return [*before, *made, *after]


def _noun(marks: Sequence[Mark], k: int) -> tuple[str, int] | None:
    """Return what a door, an opening or a common wall that stands at k does, and where it ends."""
    j, wide, shared = k, False, False
    while j < len(marks) and (marks[j].kind in LIGHT or marks[j].value == "wide") and marks[j].text not in GAPS | WALLS and j - k < 4:
        wide = wide or marks[j].text in WIDE
        shared = shared or marks[j].text in SHARED
        j += 1
    if j >= len(marks):
        return None
    if (marks[j].kind, marks[j].value) == ("flag", "doors"):
        return ("open" if wide and marks[j].text in {"archway", "doorway"} else "door"), j + 1
    if marks[j].text in GAPS:
        return ("open" if wide or marks[j].text.startswith(("open", "aper", "aber", "hue")) else "door"), j + 1
    if shared and (marks[j].text in WALLS or marks[j].value == "partition"):
        return "wall", j + 1
    return None


def _subject(marks: list[Mark]) -> list[Mark]:
    """Read "a door connects A and B", "a door leads from A into B", "a wide opening between A and B"."""
    for k in range(len(marks)):
        begins = k == 0 or marks[k - 1].kind in {
            "comma",
            "join",
            "colon",
            "neg",
            "verb",
            "fill",
            "word",
            "needless",
            "but",
            "cue",
            "pron",
            "adverb",
        }
        noun = _noun(marks, k) if begins and marks[k].kind not in {"verb", "word"} else None
        if noun is None or (k and marks[k - 1].kind == "cue" and marks[k - 1].value not in {"has", "in"}):
            continue
        cue, j = noun
        if j + 2 >= len(marks):
            continue
        start = k
        none = False
        while start and marks[start - 1].kind in {"neg", "verb", "fill", "word", "pron", "needless", "adverb"}:
            start -= 1
            none = none or marks[start].kind == "neg"
        lead = marks[j].text.split()[-1]
        found = None
        if marks[j].value == "between" or marks[j].text in JOIN:
            if marks[j].value == "between" and cue == "door" and marks[j - 1].kind == "flag":
                continue  # a door between two rooms is read elsewhere
            found = pair(marks, j + 1)
        elif marks[j].kind == "cue" and (marks[j].value in {"from", "from_to"} or lead == "from"):
            found = pair(marks, j + 1)
        if found is not None:
            listed = found[2] + 1 < len(marks) and marks[found[2]].kind in {"comma", "join"} and phrase(marks, found[2] + 1)
            if listed:
                continue  # more than two
            return joined(marks, j + 1, found[2], found, cue, none, start)
    return marks


def _ordered(marks: list[Mark]) -> list[Mark]:
    """Read "connect A to B", "do not link A and B", "merge A and B"."""
    for k, mark in enumerate(marks):
        begins = k == 0 or marks[k - 1].kind in {"neg", "fill", "verb", "comma", "word"} or marks[k - 1].text in {"and", "please"}
        if mark.text not in JOIN or not begins or any(m.kind == "room" for m in marks[max(0, k - 3) : k] if marks[k - 1].kind != "comma"):
            continue
        found = pair(marks, k + 1)
        if found is None:
            continue
        start = k
        none = False
        while start and marks[start - 1].kind in {"neg", "verb", "fill", "word", "pron"}:
            start -= 1
            none = none or marks[start].kind == "neg"
        end = found[2]
        listed = False
        while end + 1 < len(marks) and marks[end].kind in {"comma", "join"} and (more := phrase(marks, end + 1)):
            end, listed = more, True
        if listed and marks[found[0]].text == "and":
            continue
        return joined(marks, k + 1, end, found, "open" if mark.text in OPENERS else ("leads" if listed else "door"), none, start)
    return marks


BETWEEN_THEM: tuple[tuple[str, ...], ...] = (
    ("have", "a", "connecting", "door"),
    ("have", "a", "door", "between", "them"),
    ("have", "a", "door", "in", "between"),
    ("with", "a", "door", "between", "them"),
    ("with", "a", "connecting", "door"),
    ("with", "a", "door", "in", "between"),
    *((*verb, "by", "a", "door") for verb in (("connected",), ("joined",), ("linked",))),
    ("connect",),
    ("con", "una", "puerta", "entre", "ellos"),
    ("con", "una", "puerta", "entre", "ellas"),
    ("con", "puerta", "entre", "ambos"),
)
OPEN_BETWEEN = (
    ("without", "a", "wall", "between", "them"),
    ("with", "no", "wall", "between", "them"),
    ("with", "no", "wall", "in", "between"),
    ("without", "a", "wall", "in", "between"),
    ("are", "not", "separated", "by", "a", "wall"),
    ("knocked", "into", "one"),
    ("knocked", "through"),
    ("merge",),
    ("merge", "into", "one", "space"),
    ("merge", "into", "one"),
    ("with", "an", "opening", "in", "between"),
    ("with", "a", "wide", "opening", "in", "between"),
)
BETWEEN_THEM += (
    ("se", "comunican"),
    ("se", "comunican", "por", "una", "puerta"),
    ("se", "comunica"),
    ("se", "comunica", "por", "una", "puerta"),
)
NEAR = (("juntos",), ("juntas",), ("uno", "al", "lado", "del", "otro"), ("una", "al", "lado", "de", "la", "otra"))
APART = (("far", "apart"), ("well", "apart"), ("apart",), ("at", "opposite", "ends"), ("at", "opposite", "ends", "of", "the", "house"))
# By their first word: what is said of two rooms that were just named, with the cue that it amounts to and the cue's words.
TOLD_OF_BOTH: dict[str, list[tuple[tuple[str, ...], str, str]]] = {}
for _listed, _cue, _text in (
    (BETWEEN_THEM, "door", "connected"),
    (OPEN_BETWEEN, "open", "open"),
    (NEAR, "near", "junto a"),
    (APART, "away", "far from"),
):
    for _words in _listed:
        TOLD_OF_BOTH.setdefault(_words[0], []).append((_words, _cue, _text))


def _ended(marks: list[Mark]) -> list[Mark]:
    """Read "A and B, with a door between them", "A and B without a wall between them", "keep A and B apart"."""
    for k in range(1, len(marks)):
        for words, cue, text in TOLD_OF_BOTH.get(marks[k].text.partition(" ")[0], ()):
            end = _spells(marks, k, words)
            if not end or (end < len(marks) and marks[end].kind not in ENDS | {"comma", "but", "close"}):
                continue
            j = k
            while j and marks[j - 1].kind in {"comma", "verb", "fill", "word", "neg"}:
                j -= 1
            none = [m for m in marks[j:k] if m.kind == "neg"]
            if not j or marks[j - 1].kind != "room" or not any(m.text in {"and", "y", "e"} for m in marks[max(0, j - 4) : j]):
                continue
            at = marks[k]
            said = [
                Mark("cue", cue, 0.0, False, at.first, marks[end - 1].last, text),
                Mark("reciprocal", "", 0.0, False, at.last, at.last, "each other"),
            ]
            verb = Mark("verb", "", 0.0, False, at.first, at.first, "are")
            return [*(m for m in marks[:j] if m.text != "keep"), *none, verb, *said, *marks[end:]]
    return marks


def _spells(marks: Sequence[Mark], k: int, words: Sequence[str]) -> int:
    """Return where the marks go on behind these words at k; 0 where they are others."""
    need = list(words)
    while need and k < len(marks):
        have = [w for w in marks[k].text.split() if w]
        if have != need[: len(have)]:
            return 0
        need, k = need[len(have) :], k + 1
    return 0 if need else k


def _noted(marks: list[Mark]) -> list[Mark]:
    """Read "A - B: door", "A/B: connecting door", "A -> B open", "door: A - B" as notes of what lies between two rooms."""
    start = 0
    titled = _noun(marks, 0)
    if titled and titled[1] < len(marks) and marks[titled[1]].kind == "colon":
        start = titled[1] + 1
    first = phrase(marks, start)
    if not first or first + 1 >= len(marks):
        return marks
    dash = (marks[first].kind == "comma" and marks[first].text in {"-", "–", "—"}) or marks[first].kind == "slash"
    arrow = marks[first].kind == "cue" and marks[first].value == "chain"
    second = phrase(marks, first + 1)
    if not (dash or arrow) or not second:
        return marks
    j, none = second, False
    if start:
        cue, end = (titled or ("door", 0))[0], j
    else:
        while j < len(marks) and marks[j].kind in {"colon", "comma", "open", "neg", "det", "dash", "hyphen"}:
            none = none or marks[j].kind == "neg"
            j += 1
        if j >= len(marks):
            return marks
        noun = _noun(marks, j)
        opened = marks[j].text in {"open", "open plan", "abierto", "abierta"}
        shut = marks[j].text in {"closed", "cerrado", "cerrada"}
        if not (noun or opened or shut):
            return marks
        cue, end = ("open", j + 1) if opened else (noun or ("door", j + 1))
    if end < len(marks) and marks[end].kind not in ENDS | {"comma", "close", "join"}:
        return marks
    end += end < len(marks) and marks[end].kind == "close"
    said = joined(marks, start, second, (first, first + 1, second), cue, none, start)
    return [*(said[: second - start + none]), *(replace(m, kind="stop") if m.kind == "comma" else m for m in marks[end:])]
