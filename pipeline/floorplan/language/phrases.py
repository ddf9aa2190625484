"""From marks to the elements of sentences: noun phrases with all that stands in front of and behind a room's name, and what lies between them."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from pipeline.floorplan.language.marks import Mark, Words

PREMODIFIERS = {"det", "num", "ord", "adj", "size", "clf", "times"}
DROPPED = {
    "fill",
    "adverb",
    "word",
    "clf",
    "hyphen",
    "bullet",
    "unit",
    "times",
    "dash",
    "num",
    "ignored",
    "bound",
    "ord",
    "long",
    "enough",
    "fix",
    "activity",
}
MOST_INDEX = 12
LONGEST = 150  # marks of a sentence; a longer one is read in parts, cut at commas
ALSO = {"also", "tambien", "ademas", "y ademas", "ausserdem", "und ausserdem", "dazu", "zudem", "ferner"}  # begin a new part of a list
WITH = {"mit", "with", "con"}
OTHERS = {"two": 2.0, "beiden": 2.0, "zwei": 2.0, "dos": 2.0, "three": 3.0, "drei": 3.0, "tres": 3.0}  # "the other two bedrooms"
RELATIVES = {"der", "die", "das", "dem", "den", "that"}


@dataclass(slots=True)
class Element:
    """A noun phrase (kind "np") or another thing said, read from tokens[first:last]."""

    kind: str
    value: str = ""
    first: int = 0
    last: int = 0
    text: str = ""
    number: float | None = None
    type: str = ""
    role: str = ""
    plural: bool = False
    ordinal: int = 0
    index: int = 0
    part: int = 0  # "two of the four": 2
    det: set[str] = field(default_factory=set)
    adjectives: set[str] = field(default_factory=set)
    said: set[str] = field(default_factory=set)  # adjectives as written
    size: float = 1.0
    amounts: list[Mark] = field(default_factory=list)
    suite: bool = False
    compound: bool = False  # "a two-bedroom flat": the number is the whole count
    functions: set[str] = field(default_factory=set)
    only: bool = False
    banned: bool = False
    ids: list[str] = field(default_factory=list)
    mark: Mark | None = None

    @property
    def definite(self) -> bool:
        """Whether the phrase points at rooms that are known."""
        return bool(self.det & {"definite", "all", "both", "each", "other"}) and "own" not in self.det

    @property
    def introduces(self) -> bool:
        """Whether the phrase makes rooms of its own."""
        if self.definite or self.part or "own" in self.det or self.banned or self.ordinal:
            return False
        return self.number is not None or bool(self.det & {"indefinite", "another"})


def sentences(marks: Sequence[Mark], heard: Words) -> list[list[Element]]:
    """Return the elements of each sentence."""
    found: list[list[Mark]] = [[]]
    for k, mark in enumerate(marks):
        if mark.kind == "line":
            kind = _line(marks, k, heard)
            if kind == "stop":
                found.append([])
            elif kind == "comma":
                found[-1].append(Mark("comma", "", 0.0, False, mark.first, mark.last, ","))
        elif mark.kind == "stop":
            numbered = len(found[-1]) > 0 and found[-1][-1].kind == "num" and found[-1][-1].value == "figure" and _starts(marks, k - 1)
            if numbered:
                found[-1].pop()
                if found[-1]:
                    found[-1].append(Mark("comma", "", 0.0, False, mark.first, mark.last, ","))
            else:
                found.append([])
        elif mark.kind == "comma" and len(found[-1]) > LONGEST:
            found.append([])
        else:
            found[-1].append(mark)
    return [e for e in (_elements(s) for s in found if s) if e]


def _starts(marks: Sequence[Mark], k: int) -> bool:
    return k == 0 or marks[k - 1].kind in {"line", "comma"}


def _line(marks: Sequence[Mark], k: int, heard: Words) -> str:
    """Tell whether a line break ends a sentence, parts a list, or only wraps a text."""
    before = marks[k - 1].kind if k else "stop"
    after = marks[k + 1] if k + 1 < len(marks) else None
    if after is None or before in {"stop", "comma", "colon", "bullet"}:
        return ""
    if after.kind == "line":
        return "stop"
    place = heard.tokens[after.first].start
    initial = heard.prompt[place]
    short = _short(heard.prompt)
    return "comma" if after.kind in {"bullet", "num"} or short or initial.isupper() or initial > "\u2e80" else ""


@functools.lru_cache(maxsize=4)
def _short(prompt: str) -> bool:
    """Whether a prompt is a list: no line of it is long."""
    return max(map(len, prompt.splitlines())) < 48


def _elements(marks: list[Mark]) -> list[Element]:
    """Return the elements of one sentence."""
    made: list[Element] = []
    pre: list[Mark] = []
    k = 0
    after_numbers = _postposed(marks)
    while k < len(marks):
        mark = marks[k]
        if mark.kind in {"room", "suite"}:
            compound = k + 1 < len(marks) and marks[k + 1].kind == "home"
            heads = _heads(mark)
            for head in heads[:-1]:
                made += [_phrase(head, pre, compound), Element("and", "", mark.first, mark.first, "")]
                made[-2].adjectives.update({"combined"} if head.value != "bedroom" else ())
                pre = [p for p in pre if p.kind != "num"]
            phrase = _phrase(heads[-1], pre, compound)
            k = _behind(marks, k + 1, phrase, after_numbers)
            while len(heads) > 1 and k < len(marks) and marks[k].kind == "amount":
                made[-2 * len(heads) + 2].amounts.append(marks[k])
                k += 1
            made.append(phrase)
            pre = []
            continue
        if mark.kind == "pron" and _heads_phrase(marks, k + 1) and marks[k + 1].value != "bathroom/ensuite":
            mark = _as_determiner(mark)
        if mark.kind == "home":
            pre, sized = [p for p in pre if p.kind != "amount"], [p for p in pre if p.kind == "amount"]
            made += [*_loose(pre), _plain(mark)]
            made[-1].amounts += sized
            pre = []
            k += 1
            continue
        behind = bool(made) and made[-1].kind in {"np", "home"} and not pre and not _ahead(marks, k)
        if mark.kind == "amount" and behind and mark.value in {"area", "length"}:
            made[-1].amounts.append(mark)
        elif mark.kind in PREMODIFIERS or (mark.kind == "amount" and mark.value == "area"):
            pre.append(mark)
        elif mark.kind in {"fill", "adverb", "look", "hyphen", "dash"} and pre:
            if mark.kind == "look":
                made.append(_plain(mark))
        else:
            made += _loose(pre, mark)
            pre = []
            if mark.kind not in DROPPED or mark.kind == "word":
                made.append(_plain(mark))
        k += 1
    return made + _loose(pre)


def _ahead(marks: Sequence[Mark], k: int) -> bool:
    """Whether the amount at k is said of the room that follows: "mit 25 m² großem Wohnzimmer"."""
    if not _heads_phrase(marks, k + 1) or marks[k].kind != "amount":
        return False
    return marks[k + 1].kind == "size" or marks[k].text.split()[0] in WITH


def _heads_phrase(marks: Sequence[Mark], k: int) -> bool:
    """Whether a room's name follows, with nothing between but what stands in front of one."""
    while k < len(marks) and marks[k].kind in {"num", "ord", "adj", "size"}:
        k += 1
    return k < len(marks) and marks[k].kind in {"room", "suite"}


def _as_determiner(mark: Mark) -> Mark:
    """Read "one bath", "they both", "the others" in front of a room as what determines it."""
    if mark.value == "one":
        return replace(mark, kind="num", value="", number=1.0)
    return replace(mark, kind="det", value={"rest": "other", "both": "both", "group": "all"}.get(mark.value, "definite"))


def _heads(mark: Mark) -> list[Mark]:
    """Return one head per room of a double name: "lounge diner" is a living room and, open to it, a dining room."""
    return [replace(mark, value=part) for part in mark.value.split("+")] if mark.kind == "room" else [mark]


def _postposed(marks: Sequence[Mark]) -> bool:
    """Whether numbers stand behind what they count, as in "卧室两间、卫生间一间"."""
    kinds = [m.kind for m in marks if m.kind in {"room", "num", "clf"}]
    first = next((k for k, x in enumerate(kinds) if x == "room"), None)
    return first == 0 and kinds[1:3] == ["num", "clf"]


def _loose(pre: Sequence[Mark], ahead: Mark | None = None) -> list[Element]:
    owned = ahead is not None and ahead.kind == "owner"  # "four bedrooms, two for the kids"
    kept = {"amount", "adj"} if owned else {"amount", "adj", "det"}
    made = [_plain(m) for m in pre if m.kind in kept or (m.kind == "num" and (m.value == "1.0" or owned))]
    for e in made:
        if e.kind == "num":  # "two baths, one en suite"
            e.kind, e.value = "pron", "one"
        elif e.kind == "det" and e.text in RELATIVES:  # "ein Bad, das vom Flur erreichbar ist"
            e.kind = "relative"
    return made


def _plain(mark: Mark) -> Element:
    kind = "and" if mark.kind == "slash" else mark.kind
    if mark.kind == "join":
        kind = "comma" if mark.text in ALSO else mark.value
    return Element(kind, mark.value, mark.first, mark.last, mark.text, number=mark.number, only=mark.only, mark=mark)


def _phrase(mark: Mark, pre: Sequence[Mark], compound: bool) -> Element:  # noqa: C901, PLR0912 - one branch per case: a grammar
    """Put a noun phrase together from its head and what stands in front of it."""
    kind, _, role = mark.value.partition("/") if mark.kind == "room" else ("bedroom", "", mark.value)
    made = Element(
        "np",
        "",
        mark.first,
        mark.last,
        mark.text,
        type=kind,
        role=role,
        plural=mark.plural,
        suite=mark.kind == "suite",
        compound=compound,
        mark=mark,
        functions=set(mark.functions) | ({"dining"} if role == "diner" else set()),
    )
    if role in {"diner", "corner"}:
        made.role = ""
    for part in pre:
        if part.kind == "num" or (part.kind == "det" and part.value == "another"):
            if part.kind == "num" and part.number == int(part.number) and part.number > 0:
                made.number = part.number
            made.banned = made.banned or (part.kind == "num" and part.number == 0)
            made.det.update({"another"} if part.kind == "det" else ())
        elif part.kind == "det":
            if part.value == "partitive":
                if made.number is None:
                    made.det.add("definite")
                    continue
                made.part, made.number = int(made.number), None
            made.det.add(part.value)
            if part.value == "other" and made.number is None:
                made.number = next((OTHERS[w] for w in part.text.split() if w in OTHERS), None)
        elif part.kind == "ord":
            made.ordinal = int(part.number)
        elif part.kind == "adj":
            made.adjectives.add(part.value)
            made.said.add(part.text)
            if (
                part.value in {"primary", "guest", "child", "shared"}
                and not made.role
                and kind in {"bedroom", "bathroom", "kitchen", "office"}
            ):
                made.role = part.value
        elif part.kind == "size":
            made.size = part.number
            made.adjectives.add("sized")
        elif part.kind == "amount":
            made.amounts.append(part)
    if made.role == "shared" and kind != "bathroom":
        made.role = ""
    return made


def _behind(marks: Sequence[Mark], k: int, phrase: Element, postposed: bool) -> int:  # noqa: PLR0912 - one branch per case: a grammar
    """Read what belongs to a noun phrase behind its head: adjectives, an index, a number, areas; return where reading goes on."""
    while k < len(marks):
        mark = marks[k]
        if mark.kind == "det" and mark.value == "own" and not _heads_phrase(marks, k + 1):
            phrase.det.add("own")
            phrase.last = mark.last
        elif mark.kind == "post":
            if mark.value in {"own", "another"}:
                phrase.det.add(mark.value)
            elif mark.value in {"primary", "guest", "child", "shared"}:
                phrase.role = phrase.role or mark.value
            elif mark.value == "ensuite":
                phrase.role = "ensuite"
            else:
                phrase.adjectives.add(mark.value)
                phrase.said.add(mark.text)
            phrase.last = mark.last
        elif mark.kind == "size" and mark.value == "post":
            phrase.size = mark.number
        elif mark.kind == "num" and _counts(marks, k, phrase, postposed):
            value = int(mark.number)
            clf = k + 1 < len(marks) and marks[k + 1].kind == "clf"
            if clf or phrase.plural or (k and marks[k - 1].kind in {"colon", "times"}):
                phrase.number = float(value)
            else:
                phrase.index = value
            k += 1 if clf else 0
        elif (
            mark.kind in {"colon", "times"}
            and k + 1 < len(marks)
            and marks[k + 1].kind == "num"
            and (mark.kind == "times" or _ends(marks, k + 2))
        ) or mark.kind == "clf":
            pass
        else:
            return k
        k += 1
    return k


def _ends(marks: Sequence[Mark], k: int) -> bool:
    return k >= len(marks) or marks[k].kind in {"comma", "join", "clf", "stop", "open", "close", "slash"}


def _counts(marks: Sequence[Mark], k: int, phrase: Element, postposed: bool) -> bool:
    """Whether the number at k belongs to the phrase in front of it rather than to what follows."""
    if phrase.number is not None and not postposed:
        return False
    if marks[k].number != int(marks[k].number) or not 0 < marks[k].number <= MOST_INDEX:
        return False
    after = marks[k + 1].kind if k + 1 < len(marks) else "stop"
    if after == "clf":
        further = marks[k + 2].kind if k + 2 < len(marks) else "stop"
        return postposed or further not in {"room", "suite", "adj", "size"}
    return marks[k].value == "figure" and (_ends(marks, k + 1) or after in {"colon", "amount", "verb", "cue", "level", "line"})
