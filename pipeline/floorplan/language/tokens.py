"""From characters to marks: the phrases of a prompt with their meaning, numbers and amounts put together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from pipeline.floorplan.language.lexicon import LANGUAGES, STRONG, Language, Lexicon, Meaning, lexicon
from pipeline.floorplan.language.spelling import inflected, repair
from pipeline.floorplan.language.text import Token, fold, tokenize

STOPS = {".", "!", "?", ";"}
PUNCTUATION = {
    ",": "comma",
    ":": "colon",
    "(": "open",
    ")": "close",
    "/": "slash",
    "&": "and",
    "+": "and",
    "•": "bullet",
    "|": "comma",
    "*": "bullet",
}
ENDS = {"stop", "line"}  # kinds of marks that end a sentence
ARROWS = {"<->", "->", "=>", "→"}
FOREIGN = STRONG | {"num", "adj", "cue"}  # what a word of another language may mean in a mixed prompt


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
    found: list[Mark] = []
    for mark in marks:
        found.append(mark)
        if mark.kind in ENDS:
            yield found
            found = []
    if found:
        yield found


def listen(prompt: str, language: Language) -> Words:
    """Return the words of a prompt, typing errors repaired."""
    lex = lexicon(language)
    tokens = tokenize(prompt)
    written = [fold(t.text) for t in tokens]
    tokens, texts = repair(tokens, lex.compounds.completed(written, lex.vocabulary, lex.joins), lex)
    texts = [lex.tenses.get(t, lex.behind.get(texts[k - 1], {}).get(t, t) if k else t) for k, t in enumerate(texts)]
    return Words(prompt, tokens, texts, lex)


def segment(heard: Words) -> list[Mark]:
    """Return the marks of a prompt in reading order; numbers and units still stand apart."""
    made: list[Mark] = []
    i = 0
    while i < len(heard.texts):
        mark = _mark(heard, i)
        if mark.last > i:
            i = mark.last
            if mark.kind != "hyphen":
                made.append(mark)
        else:
            i += 1
    return _settled(_numbers(_articles(made, heard), heard), heard)


def _articles(marks: list[Mark], heard: Words) -> list[Mark]:
    """Tell an article from the pronoun that an accent sets apart ("el" and "él"): in front of a name it is the article."""
    if "accented_pronouns" not in heard.lexicon.traits:
        return marks
    made = list(marks)
    for k, mark in enumerate(marks[:-1]):
        plain = mark.kind == "pron" and mark.text in heard.lexicon.sign("accented_pronoun") and heard.tokens[mark.first].text == mark.text
        if plain and marks[k + 1].kind in NAMES:
            made[k] = replace(mark, kind="det", value="definite")
    return made


NAMES = {"room", "suite", "home", "adj", "size", "num", "ord", "fill", "owner", "word", "zone", "unit"}  # behind an article


def _mark(heard: Words, i: int) -> Mark:  # noqa: PLR0911 - one branch per case: a grammar
    token, text, lex = heard.tokens[i], heard.texts[i], heard.lexicon
    found = lex.find(heard.texts, i)
    if token.number is not None and (found is None or found[0] == i + 1):
        return Mark("num", "figure", token.number, False, i, i + 1, text)
    if found is not None:
        end, meaning, only = found
        return _meant(heard, i, end, meaning, only)
    if text in ARROWS:
        return Mark("cue", "chain", 0.0, False, i, i + 1, text)
    if text == "\n":
        return Mark("line", "", 0.0, False, i, i + 1, text)
    if text in STOPS:
        after = heard.texts[i + 1] if i + 1 < len(heard.texts) else "\n"
        short = text == "." and i > 0 and heard.texts[i - 1] in lex.abbreviations and after != "\n"
        return Mark("hyphen" if short else "stop", "", 0.0, False, i, i + 1, text)
    if text in {"-", "–", "—", "~", "="}:
        spaced = i > 0 and heard.tokens[i - 1].end < token.start and i + 1 < len(heard.texts) and heard.tokens[i + 1].start > token.end
        numbers = i > 0 and heard.tokens[i - 1].number is not None
        kind = "dash" if numbers or text == "~" else ("comma" if spaced else "hyphen")
        if i == 0 or heard.texts[i - 1] == "\n":
            kind = "bullet"
        return Mark(kind, "", 0.0, False, i, i + 1, text)
    if text in PUNCTUATION:
        kind = PUNCTUATION[text]
        return Mark("join", "and", 0.0, False, i, i + 1, text) if kind == "and" else Mark(kind, "", 0.0, False, i, i + 1, text)
    stem = inflected(text, lex)
    if stem is not None:
        return _meant(heard, i, i + 1, stem, only=False)
    for other in LANGUAGES:
        if other != lex.language:
            foreign = lexicon(other).find(heard.texts, i)
            if (
                foreign is not None
                and foreign[1].kind in FOREIGN
                and (foreign[1].kind in STRONG or foreign[0] > i + 1 or len(text) > 3 or (foreign[1].kind == "num" and len(text) > 2))
            ):
                return _meant(heard, i, foreign[0], foreign[1], foreign[2])
    return Mark("word", "", 0.0, False, i, i + 1, text)


def _meant(heard: Words, i: int, end: int, meaning: Meaning, only: bool) -> Mark:
    text = " ".join(heard.texts[i:end])
    return Mark(meaning.kind, meaning.value, meaning.number, meaning.plural, i, end, text, only)


def _numbers(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Put number words together: "one hundred and ten", "setenta y cinco", "二十五"."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark = marks[k]
        if mark.kind != "num" or mark.value == "figure":
            made.append(mark)
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
            elif value == 10 and "characters" in heard.lexicon.traits and 0 < current < 10:
                current *= 10
            elif current == 0 or (current % 10 == 0 and value < 10 and current >= 10):
                current += value
            else:
                break
            end += step
        made.append(
            replace(mark, number=total + current, last=marks[end - 1].last, text=" ".join(heard.texts[mark.first : marks[end - 1].last]))
        )
        k = end
    return made


def _settled(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Settle what depends on words far off: narrow plots, floors counted from the ground floor, studies where there are bedrooms."""
    lex, made = heard.lexicon, list(marks)
    ground = "floors_from_one" in lex.traits and any(m.kind == "level" and lex.sign("ground") & set(m.text.split()) for m in marks)
    bedrooms = any(m.kind == "room" and m.value.startswith("bedroom") for m in marks)
    for k, mark in enumerate(marks):
        ahead = [m.kind for m in marks[k + 1 : k + 5] if m.kind not in {"adj", "num", "look", "size"}] if mark.value == "slim" else []
        if ahead[:1] == ["home"] or ahead[:2] == ["room", "home"] or (mark.value == "slim" and k and marks[k - 1].kind == "home"):
            made[k] = replace(mark, kind="flag", value="narrow")  # "a narrow three-bedroom townhouse": a narrow room is only that
        elif mark.kind == "level" and ground:  # with a ground floor, the first floor is the one above
            shifted = (n for n in (1, 2) if any(mark.text.endswith(t) for t in lex.sign(f"floor_{n}")))
            made[k] = replace(mark, value=str(next(shifted, mark.value)))
        elif mark.kind == "every" and any(m.kind == "room" and m.text == mark.text.rsplit(" ", 1)[-1] for m in marks[:k]):
            made[k] = replace(
                mark, kind="room", value="bedroom", plural=True
            )  # "todas las habitaciones" where so many were counted by that word
        elif mark.kind == "home" and k and bedrooms and mark.text in lex.sign("study"):
            made[k] = replace(mark, kind="room", value="office")
    return made
