"""From characters to marks: the phrases of a prompt with their meaning, numbers and amounts put together."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from pipeline.floorplan.language.lexicon import Language, Lexicon, Meaning, lexicon
from pipeline.floorplan.language.spelling import repair, uninflected_meaning
from pipeline.floorplan.language.text import Token, fold, tokenize
from pipeline.floorplan.program.floor_program import Evidence

STOPS = {".", "!", "?", ";"}
PUNCTUATION = {",": "comma", ":": "colon", "(": "open", ")": "close", "/": "slash", "&": "and", "+": "and", "•": "bullet", "|": "comma", "*": "bullet"}  # fmt: skip
ENDS = {"stop", "line"}  # kinds of marks that end a sentence
HEADS = {"room", "suite"}
LEADING = {"det", "num", "ord", "adj", "size", "clf", "times"}  # in front of a head
FEET, SQUARE_FEET = 0.3048, 0.092903
USUAL_HEIGHT = 15.0  # a length from here on, said of a room or a home, is an area ("60 metros")
BOUNDS = {"least": "least", "or_more": "least", "most": "most", "or_less": "most"}
ARROWS = {"<->", "->", "=>", "→"}


@dataclass(slots=True)
class Mark:
    """Words of a prompt and their meaning. `first`, `last`: tokens[first:last]. Amounts have `number`, `high`, `bound` and a unit in `value`."""

    kind: str
    value: str = ""
    number: float = 0.0
    plural: bool = False
    first: int = 0
    last: int = 0
    text: str = ""
    only: bool = False
    high: float | None = None
    bound: str = ""
    total: bool = False  # said of everything together
    side: float | None = None  # the shorter side of "4 x 5 m"
    # what a noun phrase has (kind "np"; `number`: how many, 0 where it is not said)
    type: str = ""
    role: str = ""
    ordinal: int = 0
    index: int = 0
    part: int = 0  # "two of the four": 2
    det: set[str] = field(default_factory=set)
    adjectives: set[str] = field(default_factory=set)
    size: float = 1.0
    amounts: list["Mark"] = field(default_factory=list)
    suite: bool = False
    compound: bool = False  # "a two-bedroom flat": the number is the whole count
    removes: bool = False  # a negation of what was there
    functions: set[str] = field(default_factory=set)
    banned: bool = False
    ids: tuple[str, ...] = ()  # the rooms that it means
    taken: list["Mark"] = field(default_factory=list)  # what stands in front of its head and behind it

    @property
    def is_size(self) -> bool:
        """Whether it is an area that some room has, and no limit."""
        return (self.kind, self.value) == ("amount", "area") and self.bound not in {"least", "most"}

    @property
    def definite(self) -> bool:
        """Whether the phrase points at rooms that are known."""
        return bool(self.det & {"definite", "all", "both", "each", "other"}) and "own" not in self.det

    @property
    def introduces(self) -> bool:
        """Whether the phrase makes rooms of its own."""
        if self.definite or self.part or "own" in self.det or self.banned or self.ordinal:
            return False
        return bool(self.number or self.det & {"indefinite", "another"})


@dataclass
class Words:
    """The tokens of a prompt as they are read: cleaned words beside the places in the prompt, and the language."""

    prompt: str
    tokens: list[Token]
    texts: list[str]
    lexicon: Lexicon

    def quote(self, first: int, last: int, field: str) -> Evidence:
        """Return the words of tokens[first:last], of one at least, as evidence of a field."""
        tokens = self.tokens[first:last] or self.tokens[first : first + 1]
        start, end = min(t.start for t in tokens), max(t.end for t in tokens)
        return Evidence(start=start, end=end, text=self.prompt[start:end], field=field)


def sentences_of(marks: Sequence[Mark]) -> Iterator[list[Mark]]:
    """Yield the marks of each sentence, its end with it."""
    sentence: list[Mark] = []
    for mark in marks:
        sentence.append(mark)
        if mark.kind in ENDS:
            yield sentence
            sentence = []
    if sentence:
        yield sentence


def listen(prompt: str, language: Language) -> Words:
    """Return the words of a prompt, typing errors repaired."""
    lex = lexicon(language)
    tokens = tokenize(prompt)
    written = [fold(t.text) for t in tokens]
    tokens, texts = repair(tokens, lex.compounds.complete(written, lex.vocabulary, lex.joins), lex)
    texts = [lex.tenses.get(t, lex.behind.get(texts[k - 1], {}).get(t, t) if k else t) for k, t in enumerate(texts)]
    return Words(prompt, tokens, texts, lex)


def segment(words: Words) -> list[Mark]:
    """Return the marks of a prompt in reading order; numbers and units still stand apart."""
    marks: list[Mark] = []
    i = 0
    while i < len(words.texts):
        mark = _mark(words, i)
        if mark.last > i:
            i = mark.last
            marks.append(mark)
        else:
            i += 1
    between = ([x.kind for x in marks[max(k - 1, 0) : k + 2 : 2]] for k in range(len(marks)))  # "kitchen-diner" is written as one
    marks = [m for m, beside in zip(marks, between, strict=True) if m.kind != "hyphen" or beside == ["room", "room"]]
    return _relabel(_numbers(marks, words), words)


def _mark(words: Words, i: int) -> Mark:  # noqa: PLR0911 - one branch per case: a grammar
    token, text, lex = words.tokens[i], words.texts[i], words.lexicon
    entry = lex.find(words.texts, i)
    if token.number is not None and (entry is None or entry[0] == i + 1):
        return Mark("num", "figure", token.number, False, i, i + 1, text)
    if entry is not None:
        end, meaning, only = entry
        return _mark_of(words, i, end, meaning, only)
    if text in ARROWS:
        return Mark("cue", "chain", 0.0, False, i, i + 1, text)
    if text == "\n":
        return Mark("line", "", 0.0, False, i, i + 1, text)
    if text in STOPS:
        after = words.texts[i + 1] if i + 1 < len(words.texts) else "\n"
        short = text == "." and i > 0 and words.texts[i - 1] in lex.abbreviations and after != "\n"
        return Mark("hyphen" if short else "stop", "", 0.0, False, i, i + 1, text)
    if text in {"-", "–", "—", "~", "="}:
        spaced = i > 0 and words.tokens[i - 1].end < token.start and i + 1 < len(words.texts) and words.tokens[i + 1].start > token.end
        numbers = i > 0 and words.tokens[i - 1].number is not None
        kind = "dash" if numbers or text == "~" else ("comma" if spaced else "hyphen")
        return Mark(kind, "", 0.0, False, i, i + 1, text)
    if text in PUNCTUATION:
        kind = PUNCTUATION[text]
        return Mark("join", "and", 0.0, False, i, i + 1, text) if kind == "and" else Mark(kind, "", 0.0, False, i, i + 1, text)
    if (stem := uninflected_meaning(text, lex)) is not None:
        return _mark_of(words, i, i + 1, stem, only=False)
    return Mark("word", "", 0.0, False, i, i + 1, text)


def _mark_of(words: Words, i: int, end: int, meaning: Meaning, only: bool) -> Mark:
    text = " ".join(words.texts[i:end])
    return Mark(meaning.kind, meaning.value, meaning.number, meaning.plural, i, end, text, only)


def _numbers(marks: Sequence[Mark], words: Words) -> list[Mark]:
    """Put number words together: "one hundred and ten", "setenta y cinco", "二十五"."""
    merged: list[Mark] = []
    k = 0
    while k < len(marks):
        end, number = _number(marks, k, "characters" in words.lexicon.traits)
        text = " ".join(words.texts[marks[k].first : marks[end - 1].last])
        merged.append(marks[k] if end == k + 1 else replace(marks[k], number=number, last=marks[end - 1].last, text=text))
        k = end
    return merged


def _number(marks: Sequence[Mark], k: int, written_by_tens: bool) -> tuple[int, float]:
    """Return where the number words end that begin at mark k, and their value; where there are none, the mark itself."""
    total = current = 0.0
    end = k
    while end < len(marks):
        joined = end > k and (marks[end].kind, marks[end].value) == ("join", "and")
        word = marks[end + joined] if end + joined < len(marks) else None
        turned = word is not None and 0 < current < 10 and 20 <= word.number < 100  # "fünfundsiebzig"
        if (
            word is None
            or (joined and not (turned or current >= 20 or (total >= 100 and not current)))
            or word.kind != "num"
            or word.value == "figure"
        ):
            break
        if word.number >= 100:
            total, current = total + max(current, 1.0) * word.number, 0.0
        elif word.number == 10 and written_by_tens and 0 < current < 10:
            current *= 10
        elif (joined and turned) or (current % 10 == 0 and (not current or word.number < 10)):
            current += word.number
        else:
            break
        end += 1 + joined
    return max(end, k + 1), total + current


def _relabel(marks: Sequence[Mark], words: Words) -> list[Mark]:
    """Settle what depends on words far off: floors counted from a ground floor, studies where there are bedrooms."""
    lex, relabelled = words.lexicon, list(marks)
    ground = "floors_from_one" in lex.traits and any(m.kind == "level" and lex.sign("ground") & set(m.text.split()) for m in marks)
    bedrooms = any(m.kind == "room" and m.value.startswith("bedroom") and m.value != "bedroom/guest" for m in marks)
    for k, mark in enumerate(marks):
        if mark.kind == "level" and ground:
            shifted = (n for n in (1, 2) if any(mark.text.endswith(t) for t in lex.sign(f"floor_{n}")))
            relabelled[k] = replace(mark, value=str(next(shifted, mark.value)))
        elif mark.kind == "every" and any(m.kind == "room" and m.text == mark.text.rsplit(" ", 1)[-1] for m in marks[:k]):
            relabelled[k] = replace(mark, kind="room", value="bedroom", plural=True)  # "todas las habitaciones": so many were counted
        elif mark.kind == "home" and k and bedrooms and mark.text in lex.sign("study"):
            relabelled[k] = replace(mark, kind="room", value="office")
    return relabelled


# amounts: figures whose unit or meaning stands elsewhere too


def _kind_at(marks: Sequence[Mark], k: int) -> str:
    return marks[k].kind if 0 <= k < len(marks) else "stop"


def amounts(marks: Sequence[Mark], words: Words) -> list[Mark]:
    """Put amounts together: "at least 18 m²", "10 to 12 m²", "4 x 5 m", "seven square metres or more"."""
    merged: list[Mark] = []
    k = 0
    while k < len(marks):
        amount = _Amount(marks, words.lexicon).read(k)
        if amount is None:
            merged.append(marks[k])
            k += 1
        else:
            mark, end = amount
            mark.first, mark.last = marks[k].first, marks[end - 1].last
            mark.text = " ".join(words.texts[mark.first : mark.last])
            if mark.value == "share" and _kind_at(marks, end) == "cmp":  # "30 % larger than"
                times = 1.0 + mark.number if marks[end].value == "larger" else 1.0 / max(1.0 - mark.number, 0.1)
                mark = replace(mark, kind="factor", value="", number=times)
            merged.append(mark)
            k = end
    return merged


class _Amount:
    """Reads one amount: limits in front, a number or a range or sides, a unit, limits behind."""

    def __init__(self, marks: Sequence[Mark], lex: Lexicon) -> None:
        self.marks, self.lex = marks, lex
        self.bound, self.ranged, self.total = "", False, False

    def read(self, k: int) -> tuple[Mark, int] | None:
        """Return the amount that begins at mark k, and where it ends."""
        i = self._lead(k)
        if _kind_at(self.marks, i) != "num" or i - k > 4:
            return None
        low, high, side, unit, i = self._numbers(i)
        if unit is None:
            return None
        i = self._limits(i, unit)
        factor, value = unit.number, unit.value
        if side is not None and value == "length":
            return Mark("amount", "area", low * factor * factor, bound=self.bound, side=side * factor), i
        extent = any(m.text in self.lex.sign("extent") or m.value == "wide" for m in self.marks[i : i + 2])  # "20 m high", "20 m de ancho"
        if value == "length" and not extent and factor >= FEET - 0.01 and low * factor >= USUAL_HEIGHT:
            value, factor = "area", (1.0 if factor == 1.0 else SQUARE_FEET)
        top = None if high is None else high * factor
        return Mark("amount", value, low * factor, high=top, bound=self.bound, total=self.total), i

    def _lead(self, k: int) -> int:
        i = k
        while i < len(self.marks):
            mark = self.marks[i]
            limit, start = self.lex.bounds.get(mark.text), mark.text in self.lex.range_from
            light = i > k and mark.kind in {"fill", "det"} and mark.value in {"", "unbuilt", "indefinite"}
            if limit is None and not start and not light:
                break
            self.bound = BOUNDS.get(limit, self.bound or "about") if limit else self.bound
            self.ranged = self.ranged or start
            self.total = self.total or (mark.kind, mark.value) == ("flag", "total")
            i += 1
        return i

    def _numbers(self, i: int) -> tuple[float, float | None, float | None, Mark | None, int]:
        marks, low, i = self.marks, self.marks[i].number, i + 1
        high = side = unit = None
        i += _kind_at(marks, i) in {"hyphen", "dash"} and _kind_at(marks, i + 1) == "unit"
        if _kind_at(marks, i) == "unit":
            unit, i = marks[i], i + 1
        crossed = i < len(marks) and (marks[i].kind == "times" or marks[i].text in self.lex.sign("crossing"))
        if _kind_at(marks, i + 1) == "num" and _kind_at(marks, i + 2) == "unit" and marks[i].kind != "comma":
            second, after = marks[i + 1].number, marks[i + 2]
            joins = marks[i].kind == "dash" or marks[i].text in self.lex.range_to
            if (unit is None or after.value == unit.value) and crossed:
                return low * second, None, min(low, second), after, i + 3
            if (unit is None or after.value == unit.value) and joins and (second > low or (self.ranged and low > 0)):
                low, high = sorted((low, second))
                unit, i = after, i + 3
        return low, high, side, unit, i

    def _limits(self, i: int, unit: Mark) -> int:
        marks = self.marks
        if i + 1 < len(marks) and marks[i].value == "total" and self.lex.bounds.get(marks[i + 1].text, "about") != "about":
            self.total, i = True, i + 1  # "50 m2 in total at most"
        behind = self.lex.bounds.get(marks[i].text, "about") if i < len(marks) and unit.value != "share" else "about"
        added = i < len(marks) and marks[i].text == "+" and _kind_at(marks, i + 1) in {"room", "suite", "det", "adj", "size", "pron"}
        if behind != "about" and not added and _kind_at(marks, i + 1) != "num":
            self.bound, i = BOUNDS[behind], i + 1
        return i
