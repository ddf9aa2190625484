"""From characters to tokens: the phrases of a prompt with their meaning, numbers and amounts put together."""

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from pipeline.floorplan.language.lexicon import Language, Lexicon, Meaning, lexicon
from pipeline.floorplan.language.spelling import repair, uninflected_meaning
from pipeline.floorplan.language.text import Word, fold, split_words
from pipeline.floorplan.program.floor_program import Evidence

STOPS = {".", "!", "?", ";"}
PUNCTUATION = {",": "comma", ":": "colon", "(": "open", ")": "close", "/": "slash", "&": "and", "+": "and", "•": "bullet", "|": "comma", "*": "bullet"}  # fmt: skip
ENDS = {"stop", "line"}  # kinds of tokens that end a sentence
HEADS = {"room", "suite"}
PHRASE = {"det", "num", "size", "adj", "room", "suite", "clf"}
LEADING = {"det", "num", "ord", "adj", "size", "clf", "times"}  # in front of a head
# metres or feet in a length -> square metres in that of an area, and from how many on those of a room or a home are square ones ("60 metros")
SQUARES = {1.0: (1.0, 8.0), 0.3048: (0.092903, 49.0)}
BOUNDS = {"least": "least", "or_more": "least", "most": "most", "or_less": "most"}
ARROWS = {"<->", "->", "=>", "→"}


@dataclass(slots=True)
class Token:
    """Words of a prompt and their meaning. `first`, `last`: words[first:last]. Amounts have `number`, `high`, `bound` and a unit in `value`."""

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
    amounts: list["Token"] = field(default_factory=list)
    suite: bool = False
    compound: bool = False  # "a two-bedroom flat": the number is the whole count
    removes: bool = False  # a negation of what was there
    functions: set[str] = field(default_factory=set)
    banned: bool = False
    ids: tuple[str, ...] = ()  # the rooms that it means
    taken: list["Token"] = field(default_factory=list)  # what stands in front of its head and behind it

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
    """A prompt as it is read: cleaned words beside the places in the prompt, and the language."""

    prompt: str
    written: list[Word]
    texts: list[str]
    lexicon: Lexicon

    def quote(self, first: int, last: int, field: str) -> Evidence:
        """Return the words of words[first:last], of one at least, as evidence of a field."""
        written = self.written[first:last] or self.written[first : first + 1]
        start, end = min(w.start for w in written), max(w.end for w in written)
        return Evidence(start=start, end=end, text=self.prompt[start:end], field=field)


def sentences_of(tokens: Sequence[Token]) -> Iterator[list[Token]]:
    """Yield the tokens of each sentence, its end with it; one that takes something back goes on the sentence before: "100 m². Sorry, 110 m²"."""
    sentence: list[Token] = []
    for k, token in enumerate(tokens):
        sentence.append(token)
        if token.kind not in ENDS:
            continue
        ahead = next((m.kind for m in tokens[k + 1 :] if m.kind not in {"fill", "comma", "neg"}), "")
        if ahead == "fix":
            sentence[-1] = replace(token, kind="comma")
        else:
            yield sentence
            sentence = []
    if sentence:
        yield sentence


def read_words(prompt: str, language: Language) -> Words:
    """Return the words of a prompt, typing errors repaired."""
    lex = lexicon(language)
    folded = [fold(w.text) for w in split_words(prompt)]
    written, texts = repair(split_words(prompt), lex.compounds.complete(folded, lex.vocabulary, lex.joins), lex)
    texts = [lex.tenses.get(t, lex.behind.get(texts[k - 1], {}).get(t, t) if k else t) for k, t in enumerate(texts)]
    return Words(prompt, written, texts, lex)


def segment(words: Words) -> list[Token]:
    """Return the tokens of a prompt in reading order; numbers and units still stand apart."""
    tokens: list[Token] = []
    i = 0
    while i < len(words.texts):
        token = _token(words, i)
        i = token.last
        if not (token.text == "." and tokens and tokens[-1].text == "."):  # "..." is one stop
            tokens.append(token)
    between = ([x.kind for x in tokens[max(k - 1, 0) : k + 2 : 2]] for k in range(len(tokens)))  # "kitchen-diner" is written as one
    tokens = [m for m, beside in zip(tokens, between, strict=True) if m.kind != "hyphen" or beside == ["room", "room"]]
    return _relabel(_numbers(tokens, words), words)


def _token(words: Words, i: int) -> Token:  # noqa: PLR0911 - one branch per case: a grammar
    word, text, lex = words.written[i], words.texts[i], words.lexicon
    entry = lex.find(words.texts, i)
    if word.number is not None and (entry is None or entry[0] == i + 1):
        return Token("num", "figure", word.number, False, i, i + 1, text)
    if entry is not None:
        end, meaning, only = entry
        return _token_of(words, i, end, meaning, only)
    if text in ARROWS:
        return Token("cue", "chain", 0.0, False, i, i + 1, text)
    if text == "\n":
        return Token("line", "", 0.0, False, i, i + 1, text)
    if text in STOPS:
        after = words.prompt[words.written[i + 1].start] if i + 1 < len(words.texts) else "\n"
        measure = lex.find(words.texts, i - 1) if i else None  # "14 x 16 ft. One bedroom"
        ends = after == "\n" or (after.isupper() and measure is not None and measure[1].kind == "unit")
        short = text == "." and i > 0 and words.texts[i - 1] in lex.abbreviations and not ends
        return Token("hyphen" if short else "stop", "", 0.0, False, i, i + 1, text)
    if text in {"-", "–", "—", "~", "="}:
        spaced = i > 0 and words.written[i - 1].end < word.start and i + 1 < len(words.texts) and words.written[i + 1].start > word.end
        numbers = i > 0 and words.written[i - 1].number is not None
        kind = "dash" if numbers or text == "~" else ("comma" if spaced else "hyphen")
        return Token(kind, "", 0.0, False, i, i + 1, text)
    if text in PUNCTUATION:
        kind = PUNCTUATION[text]
        return Token("join", "and", 0.0, False, i, i + 1, text) if kind == "and" else Token(kind, "", 0.0, False, i, i + 1, text)
    if (stem := uninflected_meaning(text, lex)) is not None:
        return _token_of(words, i, i + 1, stem, only=False)
    return Token("word", "", 0.0, False, i, i + 1, text)


def _token_of(words: Words, i: int, end: int, meaning: Meaning, only: bool) -> Token:
    text = " ".join(words.texts[i:end])
    return Token(meaning.kind, meaning.value, meaning.number, meaning.plural, i, end, text, only)


def _numbers(tokens: Sequence[Token], words: Words) -> list[Token]:
    """Put number words together: "one hundred and ten", "setenta y cinco", "二十五"."""
    merged: list[Token] = []
    k = 0
    while k < len(tokens):
        end, number = _number(tokens, k, "characters" in words.lexicon.traits)
        text = " ".join(words.texts[tokens[k].first : tokens[end - 1].last])
        merged.append(tokens[k] if end == k + 1 else replace(tokens[k], number=number, last=tokens[end - 1].last, text=text))
        k = end
    return merged


def _number(tokens: Sequence[Token], k: int, written_by_tens: bool) -> tuple[int, float]:
    """Return where the number words end that begin at token k, and their value; where there are none, the token itself."""
    total = current = 0.0
    end = k
    while end < len(tokens):
        joined = end > k and (tokens[end].kind, tokens[end].value) == ("join", "and")
        word = tokens[end + joined] if end + joined < len(tokens) else None
        turned = word is not None and 0 < current < 10 and 20 <= word.number < 100  # "fünfundsiebzig"
        goes_on = not joined or turned or current >= 20 or (total >= 100 and not current)
        if word is None or not goes_on or word.kind != "num" or word.value == "figure":
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


def _relabel(tokens: Sequence[Token], words: Words) -> list[Token]:
    """Settle what depends on words far off: floors counted from a ground floor, studies where there are bedrooms, how many "each child" are."""
    lex, relabelled = words.lexicon, list(tokens)
    kids = [a for a, b in itertools.pairwise(m for m in tokens if m.kind != "clf") if b.value == "child" or b.text in lex.sign("child")]
    ground = "floors_from_one" in lex.traits and any(m.kind == "level" and lex.sign("ground") & set(m.text.split()) for m in tokens)
    bedrooms = any(m.kind == "room" and m.value.startswith("bedroom") and m.value != "bedroom/guest" for m in tokens)
    for k, token in enumerate(tokens):
        if token.kind == "level" and ground:
            shifted = (n for n in (1, 2) if any(token.text.endswith(t) for t in lex.sign(f"floor_{n}")))
            relabelled[k] = replace(token, value=str(next(shifted, token.value)))
        elif token.value == "each" and any(token is a for a in kids):
            relabelled[k] = replace(token, number=next((a.number for a in kids if a.kind == "num"), 0.0))
        elif token.kind == "every" and any(m.kind == "room" and m.text.startswith(token.text.rsplit(" ", 1)[-1]) for m in tokens[:k]):
            relabelled[k] = replace(token, kind="room", value="bedroom", plural=True)  # "todas las habitaciones": so many were counted
        elif token.text == "?" and any(m.kind in {"neg", "needless"} or m.text in lex.sign("nope") for m in tokens[k + 1 : k + 2]):
            relabelled[k] = replace(token, kind="colon")  # "Garage? No thanks"
        elif token.kind == "neg" and token.text in lex.sign("still"):  # "weder ... noch", but "noch zwei Bäder"
            here = itertools.takewhile(lambda m: m.kind not in ENDS, reversed(tokens[:k]))
            relabelled[k] = token if any(m.kind == "neg" for m in here) else replace(token, kind="fill")
        elif token.kind == "home" and k and bedrooms and token.text in lex.sign("study"):
            relabelled[k] = replace(token, kind="room", value="office")
    return relabelled


def _top_level(tokens: Sequence[Token]) -> list[Token]:
    """Return the tokens with a number for "the top floor": the highest storey of those that are counted, else the one above those that are named from the ground on, else the upper of two."""
    counted = max((int(t.number) for t in tokens if t.value == "storeys"), default=0)
    named = {int(t.value) for t in tokens if t.kind == "level" and t.value.isdigit()}
    top = counted - 1 if counted > 1 else max(1, next(n for n in itertools.count() if n not in named))
    return [replace(t, value=str(top)) if (t.kind, t.value) == ("level", "top") else t for t in tokens]


def on_each_level(tokens: Sequence[Token]) -> list[Token]:
    """Say storey by storey what is said of each: "a bathroom on each floor" is one downstairs, one upstairs; of two where nobody has counted them."""
    spread = _top_level(tokens)
    count = next((int(t.number) for t in tokens if t.value == "storeys" and t.number > 1), 2)
    for said in [t for t in tokens if t.value == "each_floor"]:
        k = next(j for j, t in enumerate(spread) if t is said)
        start, end = k, k + 1
        while start and spread[start - 1].kind in PHRASE:
            start -= 1
        leads = not any(t.kind == "room" for t in spread[start:k])
        first = start - 1  # of two rooms that an "and" joins both are on each floor, of a longer list the last
        while first > 0 and (spread[start - 1].kind, spread[start - 1].value) == ("join", "and") and spread[first - 1].kind in PHRASE:
            first -= 1
        opens = next((j for j in range(first, 0, -1) if spread[j - 1].kind in ENDS), 0)
        if not leads and 0 <= first < start - 1 and not any(t.kind == "room" for t in spread[opens:first]):
            start = first
        while leads and end < len(spread) and spread[end].kind not in {"comma", "stop"} and spread[end].value != "each_floor":
            end += 1
        rooms = spread[k + 1 : end] if leads else spread[start:k]
        if any(t.kind == "room" for t in rooms):
            levels = [replace(said, kind="level", value=str(level)) for level in range(count)]
            listed = [[level, *map(replace, rooms)] if leads else [*map(replace, rooms), level] for level in levels]
            comma = Token("comma", first=said.last, last=said.last, text=",")
            spread[k if leads else start : end] = [t for item in listed for t in (*item, comma)][:-1]
    return spread


# amounts: figures whose unit or meaning stands elsewhere too


def _kind_at(tokens: Sequence[Token], k: int) -> str:
    return tokens[k].kind if 0 <= k < len(tokens) else "stop"


def amounts(tokens: Sequence[Token], words: Words) -> list[Token]:
    """Put amounts together: "at least 18 m²", "10 to 12 m²", "4 x 5 m", "seven square metres or more"."""
    merged: list[Token] = []
    k = 0
    while k < len(tokens):
        amount = _Amount(tokens, words.lexicon).read(k)
        if amount is None:
            merged.append(tokens[k])
            k += 1
        else:
            token, end = amount
            token.first, token.last = tokens[k].first, tokens[end - 1].last
            token.text = " ".join(words.texts[token.first : token.last])
            if token.value == "share" and _kind_at(tokens, end) == "cmp":  # "30 % larger than"
                times = 1.0 + token.number if tokens[end].value == "larger" else 1.0 / max(1.0 - token.number, 0.1)
                token = replace(token, kind="factor", value="", number=times)
            merged.append(token)
            k = end
    return merged


class _Amount:
    """Reads one amount: limits in front, a number or a range or sides, a unit, limits behind."""

    def __init__(self, tokens: Sequence[Token], lex: Lexicon) -> None:
        self.tokens, self.lex = tokens, lex
        self.bound, self.ranged, self.total = "", False, False

    def read(self, k: int) -> tuple[Token, int] | None:
        """Return the amount that begins at token k, and where it ends."""
        i = self._lead(k)
        if _kind_at(self.tokens, i) != "num" or i - k > 4:
            return None
        low, high, side, unit, i = self._numbers(i)
        unit = unit or self._taken_back(i - 1)
        if unit is None:
            return None
        i = self._limits(i, unit)
        factor, value = unit.number, unit.value
        if side is not None and value == "length":
            return Token("amount", "area", low * factor * factor, bound=self.bound, side=side * factor), i
        around = [*self.tokens[max(k - 1, 0) : k], *self.tokens[i : i + 2]]
        extent = any(t.text in self.lex.sign("extent") or t.value == "wide" for t in around)  # "20 m high", "20 m de ancho"
        square, least = SQUARES.get(factor, (0.0, math.inf))
        if value == "length" and not extent and low >= least:
            value, factor = "area", square
        top = None if high is None else high * factor
        return Token("amount", value, low * factor, high=top, bound=self.bound, total=self.total), i

    def _lead(self, k: int) -> int:
        i = k
        while i < len(self.tokens):
            token = self.tokens[i]
            limit, start = self.lex.bounds.get(token.text), token.text in self.lex.range_from
            light = i > k and token.kind in {"fill", "det"} and token.value in {"", "unbuilt", "indefinite"}
            if limit is None and not start and not light:
                break
            self.bound = BOUNDS.get(limit, self.bound or "about") if limit else self.bound
            self.ranged = self.ranged or start
            self.total = self.total or (token.kind, token.value) == ("flag", "total")
            i += 1
        return i

    def _numbers(self, i: int) -> tuple[float, float | None, float | None, Token | None, int]:
        tokens, low, i = self.tokens, self.tokens[i].number, i + 1
        high = side = unit = None
        last = next((j for j in (i, i + 1, i + 2) if _kind_at(tokens, j) == "unit"), i)
        between = {"hyphen", "dash"} | ({"word", "fill"} if tokens[last:] and tokens[last].value == "area" else set())  # "60ish m2"
        i = last if all(_kind_at(tokens, j) in between for j in range(i, last)) else i
        if _kind_at(tokens, i) == "unit":
            unit, i = tokens[i], i + 1
        k = i + self._sided(i)  # "12 m long and 8 m wide"
        both = k > i and _kind_at(tokens, k) in {"join", "comma"} and self._sided(k + 3)
        crossed = k < len(tokens) and (tokens[k].kind == "times" or tokens[k].text in self.lex.sign("crossing") or both)
        if _kind_at(tokens, k + 1) == "num" and _kind_at(tokens, k + 2) == "unit" and (both or tokens[k].kind != "comma"):
            second, after = tokens[k + 1].number, tokens[k + 2]
            first = low * (unit.number / after.number if unit else 1.0)  # "2 m by 60 cm"
            joins = tokens[k].kind == "dash" or tokens[k].text in self.lex.range_to
            if (unit is None or after.value == unit.value) and crossed:
                return first * second, None, min(first, second), after, k + 3 + self._sided(k + 3)
            if (unit is None or after.value == unit.value) and joins and (second > low or (self.ranged and low > 0)):
                low, high = sorted((low, second))
                unit, i = after, k + 3
        return low, high, side, unit, i

    def _sided(self, k: int) -> bool:
        """Whether the word at k says along which side a length is measured."""
        return k < len(self.tokens) and (self.tokens[k].value == "wide" or self.tokens[k].text in self.lex.sign("sides"))

    def _taken_back(self, k: int) -> Token | None:
        """Return the unit of the area that the bare figure at k corrects: "160 m2 is too much, go with 145"."""
        before, figure, behind = (_kind_at(self.tokens, k - 1), self.tokens[k], _kind_at(self.tokens, k + 1))
        corrects = before == "fix" and figure.value == "figure" and figure.number >= SQUARES[1.0][1] and behind in {*ENDS, "comma"}
        return next((t for t in reversed(self.tokens[: k * corrects]) if (t.kind, t.value) == ("unit", "area")), None)

    def _limits(self, i: int, unit: Token) -> int:
        tokens = self.tokens
        if i + 1 < len(tokens) and tokens[i].value == "total" and self.lex.bounds.get(tokens[i + 1].text, "about") != "about":
            self.total, i = True, i + 1  # "50 m2 in total at most"
        behind = self.lex.bounds.get(tokens[i].text, "about") if i < len(tokens) and unit.value != "share" else "about"
        added = i < len(tokens) and tokens[i].text == "+" and _kind_at(tokens, i + 1) in {"room", "suite", "det", "adj", "size", "pron"}
        if behind != "about" and not added and _kind_at(tokens, i + 1) != "num":
            self.bound, i = BOUNDS[behind], i + 1
        return i
