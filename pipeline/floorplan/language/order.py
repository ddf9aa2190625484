"""Word order: marks of a language are brought into the order that the grammar reads (head, cue, object)."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.lexicon import Language, lexicon
from pipeline.floorplan.language.marks import Mark, Words

ENDS = {"stop", "line", "colon", "comma"}
ARTICLES = {"der", "die", "das", "den", "dem", "einer", "einem", "eine", "einen", "ein"}
MELTED = {"ins": "in", "im": "in", "zum": "zu", "zur": "zu", "vom": "von", "durchs": "durch"}  # prepositions with their article
HEADS = {"room", "suite"}
PLAIN_ARTICLES = {"der", "dem"}  # frames that begin with no preposition end at one
OTHERWISE = {"sind", "an", "ans", "mit", "von", "vom"}
LISTED = {"room", "det", "adj", "size", "num", "clf", "comma", "join"}
FARTHEST = 14  # marks between the two parts of a frame


def reorder(marks: list[Mark], heard: Words) -> list[Mark]:
    """Return the marks in the order that the grammar reads."""
    framed = _frames(_reached(marks) if "verb_last" in heard.lexicon.traits else marks, heard)
    if "verb_last" in heard.lexicon.traits:
        return _verbs_last(framed, heard)
    return _behind(framed) if "adjectives_behind" in heard.lexicon.traits else framed


REACHED = {"erreichbar", "zugaenglich", "erreichen", "betreten", "begehbar", "betretbar", "erschlossen"}


def _reached(marks: list[Mark]) -> list[Mark]:
    """Read "vom Flur aus sind Bad, Büro und Küche zu erreichen" as "vom Flur aus erreicht man Bad, Büro und Küche"."""
    made = list(marks)
    for k in range(len(made) - 3):
        start = k == 0 or made[k - 1].kind in {"stop", "line"}
        room = next((j for j in range(k + 1, min(k + 4, len(made))) if made[j].kind in HEADS), None)
        if (
            not start
            or made[k].kind not in {"cue", "fill"}
            or _plain(made[k].text.split()[0]) not in {"von", "ueber", "durch"}
            or room is None
        ):
            continue
        verb = next((j for j in range(room + 1, min(room + 3, len(made))) if made[j].kind == "verb"), None)
        end = next((j for j in range(room, len(made)) if made[j].kind in {"stop", "line"}), len(made))
        tail = next((j for j in range(room, end) if made[j].text in REACHED), None)
        if verb is None or tail is None or not any(m.kind == "comma" for m in made[verb:tail]):
            continue
        made[k] = replace(made[k], kind="cue", value="from")
        made[verb] = replace(made[verb], kind="cue", value="leads", text="erreicht man")
        made[tail] = replace(made[tail], kind="fill")
    return made


def _frames(marks: list[Mark], heard: Words) -> list[Mark]:
    """Make one cue of its two parts: "an ... grenzt" stands where "an" stood."""
    made = list(marks)
    if not heard.lexicon.frames:
        return made
    k = 0
    while k < len(made):
        found = _frame(made, k, heard)
        if found is not None:
            cue, after_first, second, after_second = found
            first = replace(
                made[k], kind="cmp" if cue in {"larger", "smaller"} else "cue", value=cue, last=made[after_first - 1].last, number=0.0
            )
            only = any(m.text in {"nur", "solo", "只", "只能", "only", "ausschliesslich"} for m in made[max(0, k - 2) : k])
            first.only = first.only or only
            tail = [m for m in made[second:after_second] if m.kind in ENDS]
            inside = made[after_first:second]
            none = [inside.pop()] if inside and inside[-1].kind == "neg" else []  # "厨房与卧室不相通"
            made[k:after_second] = [*none, first, *inside, *tail]
            k += len(none)
        k += 1
    return made


def _frame(marks: list[Mark], k: int, heard: Words) -> tuple[str, int, int, int] | None:
    for first, second, cue in _listed(heard.lexicon.language).get(_plain(marks[k].text.split(" ", 1)[0]), ()):
        start = _matches(marks, k, first)
        if start is None:
            continue
        named = False
        for j in range(start, min(len(marks), start + FARTHEST)):
            list_ends = marks[j].kind in ENDS and not (marks[j].kind == "comma" and (cue.startswith("thru") or _listing(marks, start, j)))
            if (
                list_ends
                or (first[0] in PLAIN_ARTICLES and marks[j].text.split(" ", 1)[0] in OTHERWISE)
                or (marks[j].kind == "cue" and marks[j].value not in {"has", "in", "door"} and _matches(marks, j, second) is None)
            ):
                break
            if named and cue == "open" and _matches(marks, j, first) is not None and _matches(marks, j, second) is None:
                break  # "eine Wohnung, in der die Küche in das Esszimmer übergeht"
            end = _matches(marks, j, second) if named else None
            if end is not None and not _goes_on(marks, end, second):
                return cue, start, j, end
            named = named or marks[j].kind in {"room", "suite", "pron", "every", "zone"}
    return None


def _listing(marks: list[Mark], start: int, k: int) -> bool:
    """Whether the comma at k stands in a list of rooms that began at start: "mit dem Flur, der Küche und dem Bad verbunden"."""
    inside = all(m.kind in LISTED for m in marks[start:k]) and marks[k - 1].kind == "room"
    j = k
    while j < len(marks) and marks[j].kind in LISTED:
        j += 1
    return inside and (marks[k].text == "、" or any(m.kind == "join" for m in marks[k:j]))


def _goes_on(marks: list[Mark], end: int, second: tuple[str, ...]) -> bool:
    """Whether the second part has an object of its own: "ins Bad geht man über den Flur", "卫生间和洗衣房都不能挨着餐厅"."""
    if end >= len(marks):
        return False
    if second == ("ueber",):
        return marks[end].kind not in ENDS | {"join"}
    return second[0] >= "\u3400" and marks[end - 1].kind == "cue" and marks[end].kind in HEADS | {"num", "zone"}


@functools.cache
def _listed(language: Language) -> dict[str, tuple[tuple[tuple[str, ...], tuple[str, ...], str], ...]]:
    """Return the frames of a language by their first word, prepositions without the article that melted into them."""
    made: dict[str, dict[tuple[tuple[str, ...], tuple[str, ...], str], None]] = {}
    for frames in lexicon(language).frames.values():
        for first, second, cue in frames:
            plain = tuple(map(_plain, first)), tuple(map(_plain, second)), cue
            made.setdefault(plain[0][0], {})[plain] = None
    return {word: tuple(sorted(found, key=lambda f: -len(f[0]) - len(f[1]))) for word, found in made.items()}


def _plain(word: str) -> str:
    return MELTED.get(word, word)


def _matches(marks: list[Mark], k: int, wanted: tuple[str, ...]) -> int | None:
    """Return where the marks go on after the words wanted, where they stand at k; adverbs between them are skipped."""
    need = list(wanted)
    while need and k < len(marks):
        have = [_plain(w) for w in marks[k].text.split()]
        if have == need[: len(have)]:
            need = need[len(have) :]
        elif have[: len(need)] == need and set(have[len(need) :]) <= ARTICLES:  # "in die Küche übergeht"
            need = []
        elif len(need) == len(wanted) or marks[k].kind not in {"adverb", "flag", "comma"}:
            return None
        k += 1
    return None if need else k


def _verbs_last(marks: list[Mark], heard: Words) -> list[Mark]:
    """Read "vier gleich große Zimmer" as bedrooms, and "25 m² großes Wohnzimmer" with its area behind the head."""
    made = list(marks)
    for k, mark in enumerate(made):
        if mark.kind == "room" and heard.tokens[mark.last - 1].text.lower().endswith("zimmern"):
            made[k] = replace(mark, plural=True)
        described = k > 1 and made[k - 1].kind in {"adj", "size"} and any(m.kind == "num" for m in made[max(0, k - 4) : k])
        if mark.kind == "unit" and mark.value == "rooms" and described:
            made[k] = replace(mark, kind="room", value="bedroom", plural=True)
        if (
            mark.kind == "det"
            and mark.text in {"die", "den"}
            and k + 1 < len(made)
            and made[k + 1].kind == "room"
            and made[k + 1].text.endswith("zimmer")
        ):
            made[k + 1] = replace(made[k + 1], plural=mark.text == "die")
    for k in range(len(made)):
        ends = k + 1 >= len(made) or made[k + 1].kind in ENDS | {"join"}
        if made[k].text == "sein" and made[k].kind == "det" and ends:
            made[k] = replace(made[k], kind="verb", value="")  # "sollen verbunden sein"
        _final(made, k)
    return _articles(made)


WITH_ARTICLE = {"ins", "im", "zum", "zur", "vom", "am", "ans", "beim", "durchs"}


def _articles(marks: Sequence[Mark]) -> list[Mark]:
    """Put the article that melted into a preposition in front of its room: "ins Bad" means a bathroom that is known."""
    made: list[Mark] = []
    for mark in marks:
        before = made[-1] if made else None
        if mark.kind in HEADS and before is not None and before.kind == "cue" and before.text.rsplit(" ", 1)[-1] in WITH_ARTICLE:
            made.append(Mark("det", "definite", 0.0, False, mark.first, mark.first, ""))
        made.append(mark)
    return made


HAVING = {"hat", "haben", "besitzt", "besitzen", "bekommt", "bekommen", "hatte"}


def _final(made: list[Mark], k: int) -> None:
    """Put a "hat" at the end of a clause in front of what is had: "eines, das ein eigenes Bad hat"."""
    ahead = made[k + 1].kind if k + 1 < len(made) else "stop"
    if made[k].text not in HAVING or ahead not in {"comma", "stop", "join", "line"} or not k or made[k - 1].kind not in {"room", "suite"}:
        return
    start = k - 1
    while start and made[start - 1].kind in {"det", "num", "adj", "size", "ord", "clf"}:
        start -= 1
    if start and made[start - 1].kind == "cue" and made[start - 1].value != "has":
        return  # "eine Wand mit dem Wohnzimmer haben"
    made.insert(start, made.pop(k))


def _behind(marks: list[Mark]) -> list[Mark]:
    """Read adjectives behind their noun: "dormitorio principal", "cocina abierta", "baño propio"."""
    made: list[Mark] = []
    for mark in marks:
        before = made[-1] if made else None
        behind = (before is not None and before.kind in {"room", "suite", "post"}) or (
            before is not None and before.kind == "size" and before.value == "post"
        )
        if behind and (mark.kind == "adj" or (mark.text == "individual" and before is not None and before.value.startswith("bedroom"))):
            made.append(replace(mark, kind="post", value=mark.value if mark.kind == "adj" else "plain"))
        elif behind and mark.kind == "det" and mark.value in {"own", "another"}:
            made.append(replace(mark, kind="post"))
        elif behind and mark.text == "mas" and before is not None and before.kind == "room":
            made.append(replace(mark, kind="post", value="another"))
        elif behind and mark.kind == "size":
            made.append(replace(mark, value="post"))
        elif behind and mark.kind == "adverb" and mark.text in {"muy", "mas", "bastante", "totalmente", "completamente"}:
            continue
        else:
            made.append(mark)
    return made
