"""From characters to marks: the phrases of a prompt with their meaning, numbers and amounts put together."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from pipeline.floorplan.language.lexicon import Language, Lexicon, Meaning, lexicon
from pipeline.floorplan.language.spelling import repair, uninflected_meaning
from pipeline.floorplan.language.text import Token, fold, tokenize

STOPS = {".", "!", "?", ";"}
PUNCTUATION = {",": "comma", ":": "colon", "(": "open", ")": "close", "/": "slash", "&": "and", "+": "and", "•": "bullet", "|": "comma", "*": "bullet"}  # fmt: skip
ENDS = {"stop", "line"}  # kinds of marks that end a sentence
HEADS = {"room", "suite"}
LEADING = {"det", "num", "ord", "adj", "size", "clf", "times"}  # in front of a head
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
    functions: tuple[str, ...] = ()  # what a room serves as besides
    parts: tuple[float, ...] = ()  # "bedrooms of 14, 12 and 10 m2": one each


@dataclass
class Words:
    """The tokens of a prompt as they are read: cleaned words beside the places in the prompt, and the language."""

    prompt: str
    tokens: list[Token]
    texts: list[str]
    lexicon: Lexicon


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
            if mark.kind != "hyphen":
                marks.append(mark)
        else:
            i += 1
    return _relabel(_numbers(_articles(marks, words), words), words)


def _articles(marks: list[Mark], words: Words) -> list[Mark]:
    """Tell an article from the pronoun that an accent sets apart ("el" and "él"): in front of a name it is the article."""
    if "accented_pronouns" not in words.lexicon.traits:
        return marks
    relabelled = list(marks)
    for k, mark in enumerate(marks[:-1]):
        plain = mark.kind == "pron" and mark.text in words.lexicon.sign("accented_pronoun") and words.tokens[mark.first].text == mark.text
        if plain and marks[k + 1].kind in NAMES:
            relabelled[k] = replace(mark, kind="det", value="definite")
    return relabelled


NAMES = {"room", "suite", "home", "adj", "size", "num", "ord", "fill", "owner", "word", "zone", "unit"}  # behind an article


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
        if i == 0 or words.texts[i - 1] == "\n":
            kind = "bullet"
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
        mark = marks[k]
        if mark.kind != "num" or mark.value == "figure":
            merged.append(mark)
            k += 1
            continue
        total, current, end = 0.0, mark.number, k + 1
        if mark.number >= 100:
            total, current = mark.number, 0.0
        while end < len(marks):
            ahead = marks[end]
            joined = ahead.kind == "join" and ahead.value == "and" and end + 1 < len(marks) and marks[end + 1].kind == "num"
            if joined and (current >= 20 or (total >= 100 and not current)) and marks[end + 1].value != "figure":
                ahead, step = marks[end + 1], 2
            else:
                step = 1
            if ahead.kind != "num" or ahead.value == "figure":
                break
            value = ahead.number
            if value >= 100:
                total, current = total + max(current, 1.0) * value, 0.0
            elif value == 10 and "characters" in words.lexicon.traits and 0 < current < 10:
                current *= 10
            elif current == 0 or (current % 10 == 0 and value < 10 and current >= 10):
                current += value
            else:
                break
            end += step
        merged.append(
            replace(mark, number=total + current, last=marks[end - 1].last, text=" ".join(words.texts[mark.first : marks[end - 1].last]))
        )
        k = end
    return merged


def _relabel(marks: Sequence[Mark], words: Words) -> list[Mark]:
    """Settle what depends on words far off: floors counted from the ground floor, studies where there are bedrooms."""
    lex, relabelled = words.lexicon, list(marks)
    ground = "floors_from_one" in lex.traits and any(m.kind == "level" and lex.sign("ground") & set(m.text.split()) for m in marks)
    bedrooms = any(m.kind == "room" and m.value.startswith("bedroom") and m.value != "bedroom/guest" for m in marks)
    for k, mark in enumerate(marks):
        if mark.kind == "level" and ground:  # with a ground floor, the first floor is the one above
            shifted = (n for n in (1, 2) if any(mark.text.endswith(t) for t in lex.sign(f"floor_{n}")))
            relabelled[k] = replace(mark, value=str(next(shifted, mark.value)))
        elif mark.kind == "every" and any(m.kind == "room" and m.text == mark.text.rsplit(" ", 1)[-1] for m in marks[:k]):
            relabelled[k] = replace(
                mark, kind="room", value="bedroom", plural=True
            )  # "todas las habitaciones" where so many were counted by that word
        elif mark.kind == "home" and k and bedrooms and mark.text in lex.sign("study"):
            relabelled[k] = replace(mark, kind="room", value="office")
    return relabelled


Bracket = tuple[tuple[str, ...], tuple[str, ...], str]  # "an ... grenzt": two parts and what they mean
BREAKS = {"stop", "line", "colon", "comma"}
LISTED = {"room", "det", "adj", "size", "num", "clf", "comma", "join"}
FARTHEST = 14  # marks between the two parts of a bracket


def reorder(marks: list[Mark], words: Words) -> list[Mark]:
    """Return the marks in the order that the reader reads."""
    reordered, traits = _join_brackets(marks, words), words.lexicon.traits
    if "verb_last" in traits:
        return list(_verbs_last(reordered, words))
    return _behind(reordered, words.lexicon) if "adjectives_behind" in traits else reordered


def _join_brackets(marks: list[Mark], words: Words) -> list[Mark]:
    """Make one relation of its two parts: "an ... grenzt" stands where "an" stood."""
    reordered, lex = list(marks), words.lexicon
    k = 0
    while k < len(reordered) if lex.frames else False:
        bracket = _bracket(reordered, k, lex)
        if bracket is not None:
            cue, start, second, end = bracket
            only = any(m.text in lex.sign("only") for m in reordered[max(0, k - 2) : k])
            kind = "cmp" if cue in {"larger", "smaller"} else "cue"
            first = replace(reordered[k], kind=kind, value=cue, last=reordered[start - 1].last, number=0.0, only=reordered[k].only or only)
            inside = reordered[start:second]
            none = [inside.pop()] if inside and inside[-1].kind == "neg" else []  # "厨房与卧室不相通"
            reordered[k:end] = [*none, first, *inside, *(m for m in reordered[second:end] if m.kind in BREAKS)]
            k += len(none)
        k += 1
    return reordered


def _bracket(marks: list[Mark], k: int, lex: Lexicon) -> tuple[str, int, int, int] | None:
    """Return (relation, end of its first part, place and end of the second) of a bracket that begins at mark k."""
    for first, second, cue in _brackets(lex.language).get(_plain(marks[k].text.split(" ", 1)[0], lex), ()):
        start = _matches(marks, k, first, lex)
        named = False
        for j in range(start, min(len(marks), start + FARTHEST)) if start is not None else ():
            mark, end = marks[j], _matches(marks, j, second, lex)
            comma = mark.kind == "comma" and cue.startswith("thru")
            article = first[0] in lex.sign("article_first") and mark.text.split(" ", 1)[0] in lex.sign("otherwise")
            other = mark.kind == "cue" and mark.value not in {"has", "in", "door"} and end is None
            again = named and end is None and cue == "open" and _matches(marks, j, first, lex) is not None
            if (mark.kind in BREAKS and not comma) or article or other or again:
                break
            if named and end is not None and not _goes_on(marks, end, second, lex):
                return cue, start or 0, j, end
            named = named or mark.kind in {*HEADS, "pron", "every", "zone"}
    return None


def _goes_on(marks: list[Mark], end: int, second: tuple[str, ...], lex: Lexicon) -> bool:
    """Whether the second part has an object of its own: "ins Bad geht man über den Flur", "卫生间和洗衣房都不能挨着餐厅"."""
    if end >= len(marks):
        return False
    if set(second) <= lex.sign("way_through"):
        return marks[end].kind not in BREAKS | {"join"}
    return "characters" in lex.traits and marks[end - 1].kind == "cue" and marks[end].kind in HEADS | {"num", "zone"}


@functools.cache
def _brackets(language: str) -> dict[str, tuple[Bracket, ...]]:
    """Return the brackets of a language by their first word, prepositions without the article that melted into them."""
    by_word: dict[str, dict[Bracket, None]] = {}
    lex = lexicon(language)
    for first, second, cue in (b for some in lex.frames.values() for b in some):
        plain = tuple(_plain(w, lex) for w in first), tuple(_plain(w, lex) for w in second), cue
        by_word.setdefault(plain[0][0], {})[plain] = None
    return {word: tuple(sorted(brackets, key=lambda f: -len(f[0]) - len(f[1]))) for word, brackets in by_word.items()}


def _plain(word: str, lex: Lexicon) -> str:
    return lex.compounds.melted.get(word, word)


def _matches(marks: list[Mark], k: int, wanted: tuple[str, ...], lex: Lexicon) -> int | None:
    """Return where the marks go on after the words wanted, where they stand at k; adverbs between them are skipped."""
    need = list(wanted)
    while need and k < len(marks):
        have = [_plain(w, lex) for w in marks[k].text.split()]
        if have == need[: len(have)]:
            need = need[len(have) :]
        elif have[: len(need)] == need and set(have[len(need) :]) <= lex.sign("article"):  # "in die Küche übergeht"
            need = []
        elif len(need) == len(wanted) or marks[k].kind not in {"adverb", "flag", "comma"}:
            return None
        k += 1
    return None if need else k


def _verbs_last(marks: list[Mark], words: Words) -> Iterator[Mark]:
    """Yield the marks with plurals that only articles tell, and articles out of prepositions."""
    relabelled, lex = list(marks), words.lexicon
    for k in range(len(relabelled)):
        mark, ahead = relabelled[k], relabelled[k + 1] if k + 1 < len(relabelled) else None
        if mark.kind == "room" and any(words.tokens[mark.last - 1].text.lower().endswith(t) for t in lex.sign("dative")):
            relabelled[k] = replace(mark, plural=True)
        described = k > 1 and relabelled[k - 1].kind in {"adj", "size"} and any(m.kind == "num" for m in relabelled[max(0, k - 4) : k])
        if (mark.kind, mark.value) == ("unit", "rooms") and described:
            relabelled[k] = replace(mark, kind="room", value="bedroom", plural=True)  # "vier gleich große Zimmer"
        uncounted = mark.text in lex.sign("plural_article") | lex.sign("plural_dative") and ahead is not None and ahead.kind == "room"
        if uncounted and ahead is not None and any(ahead.text.endswith(t) for t in lex.sign("uncounted")):
            relabelled[k + 1] = replace(ahead, plural=mark.text in lex.sign("plural_article"))
    for k, mark in enumerate(relabelled):
        if (
            mark.kind in HEADS
            and k
            and relabelled[k - 1].kind == "cue"
            and relabelled[k - 1].text.rsplit(" ", 1)[-1] in lex.sign("with_article")
        ):
            yield Mark("det", "definite", 0.0, False, mark.first, mark.first, "")  # "ins Bad" means a bathroom that is known
        yield mark


def _behind(marks: Sequence[Mark], lex: Lexicon) -> list[Mark]:
    """Read adjectives behind their noun: "dormitorio principal", "cocina abierta", "baño propio"."""
    relabelled: list[Mark] = []
    for mark in marks:
        before = relabelled[-1] if relabelled else None
        behind = before is not None and (before.kind in {*HEADS, "post"} or (before.kind, before.value) == ("size", "post"))
        if behind and (mark.kind == "adj" or (mark.kind == "det" and mark.value in {"own", "another"})):
            relabelled.append(replace(mark, kind="post"))
        elif behind and mark.kind == "size":
            relabelled.append(replace(mark, value="post"))
        elif not (behind and mark.kind == "adverb" and mark.text in lex.sign("very")):
            relabelled.append(mark)
    return relabelled
