"""Characters and words of a prompt."""

import functools
import re
import unicodedata
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict

from pipeline import yaml_text
from pipeline.errors import UsageError

FILE = Path(__file__).resolve().parents[3] / "manifests" / "lexicon" / "characters.yaml"
LONGEST = 20_000  # characters of a prompt
MOST_WORDS = 2_500  # and Chinese characters: reading takes time in proportion to them
HALVES = {"½": 0.5, "1½": 1.5}


@dataclass(frozen=True, slots=True)
class Word:
    """A word (lower case) = prompt[start:end] as written; `number` is the value of figures."""

    text: str
    start: int
    end: int
    number: float | None = None


@functools.cache
def characters() -> Mapping[str, Any]:
    """Return how words are written in any of the languages; `word` is the pattern of one."""
    rules: dict[str, Any] = yaml_text.parse(FILE.read_text(encoding="utf-8"))
    han, short = rules["han"], "|".join(rules["short"])
    whole = "|".join(re.escape(w) + (r"(?!\d)" if w[-1].isdecimal() else "") for w in rules["whole"])
    number = r"\d+(?:[.,]\d{3})+(?![\d])|\d+(?:[.,]\d+)?"
    signs = r"<->|->|=>|→|[<>]=|[<>](?=\s*\d|$)|[≤≥]|1½|½|[%.,;:!?()/&~+=*•|–—\-×。、;:!?()\n\[\]]"
    word = re.compile(rf"{number}|[{han}]|{whole}|[^\W\d_{han}]+(?:'(?:{short})\b)?'?|{signs}", re.IGNORECASE)
    return rules | {"word": word, "alike": str.maketrans(*rules["alike"])}


def clean(prompt: str) -> tuple[str, list[int]]:
    """Return the prompt in lower case, compatibility forms resolved, invisible and control characters taken out, and the place of each character.

    Traditional Chinese characters become simplified ones. Invisible characters inside a word leave no gap.
    """
    marks, alike = characters()["marks"], characters()["alike"]
    cleaned: list[str] = []
    places: list[int] = []
    for place, char in enumerate(prompt):
        if char.isascii() and (char.isalnum() or char == " "):
            cleaned.append(char.lower())
            places.append(place)
            continue
        kind = unicodedata.category(char)
        if kind in {"Cf", "Mn"} and char != "\u0301" and unicodedata.combining(char) == 0:
            continue
        if char in "\n\r\u2028\u2029":
            out = "\n"
        elif kind[0] in "CZ":
            out = " "
        else:
            out = marks.get(char) or (char if char in "²½" else unicodedata.normalize("NFKC", char).lower().translate(alike))
        for piece in out:
            if unicodedata.combining(piece) and cleaned:  # a letter and its accent, written apart
                joined = unicodedata.normalize("NFC", cleaned[-1] + piece)
                if len(joined) == 1:
                    cleaned[-1] = joined
                continue
            cleaned.append(marks.get(piece, piece))
            places.append(place)
    return "".join(cleaned), places


@functools.lru_cache(maxsize=16)  # a prompt is read several times: for its language, its furniture, its rooms
def split_words(prompt: str) -> tuple[Word, ...]:
    """Split a prompt into words, figures and marks; Chinese into single characters."""
    text, places = clean(prompt)
    found = []
    for match in characters()["word"].finditer(text):
        raw = match.group()
        if raw[0].isalpha() and raw.endswith("'") and not raw.endswith(characters()["plural_genitive"]):
            raw = raw[:-1]
        found.append(Word(raw, places[match.start()], places[match.end() - 1] + 1, _number(raw)))
    return tuple(found)


def check_length(prompt: str) -> None:
    """Raise UsageError for a prompt that is empty or too long, in characters or words."""
    if not prompt.strip():
        raise UsageError("the prompt is empty", 'say what you want, e.g. "a two-bedroom flat with an open kitchen"')
    if len(prompt) > LONGEST:
        raise UsageError(f"the prompt is {len(prompt)} characters long", f"keep it under {LONGEST}")
    if (count := len(split_words(prompt))) > MOST_WORDS:
        raise UsageError(f"the prompt has {count} words and tokens", f"keep it under {MOST_WORDS}")


def _number(raw: str) -> float | None:
    if raw in HALVES or not raw[0].isdecimal():
        return HALVES.get(raw)
    if re.fullmatch(r"\d+([.,]\d{3})+", raw):  # 1,900 and 1.900 are thousands
        return float(re.sub(r"[.,]", "", raw))
    return float(raw.replace(",", "."))


def has_minus(prompt: str, place: int) -> bool:
    """Whether a minus sign stands right before the number at a place of a prompt; "2-3" and "level-2" are none."""
    return place > 1 and prompt[place - 1] in "-−–" and (prompt[place - 2] in " (" or is_han(prompt[place - 2]))


def is_han(char: str) -> bool:
    """Whether a character is a Chinese one."""
    first, _, last = characters()["han"]
    return bool(first <= char <= last)


def fold(word: str) -> str:
    """Return a word without accents; umlauts and sharp s as two letters."""
    if word.isascii():
        return word
    for letter, two in characters()["apart"].items():
        word = word.replace(letter, two)
    return word if word.isascii() else bare(word)


def bare(word: str) -> str:
    """Return a word without accents and umlauts: how it looks when they are dropped."""
    return "".join(c for c in unicodedata.normalize("NFD", word.casefold()) if not unicodedata.combining(c))


def words(phrase: str) -> tuple[str, ...]:
    """Return the folded words of a phrase of a lexicon."""
    plain, ascii_only = phrase.replace("-", " "), phrase.isascii()
    if not ascii_only and all(map(is_han, phrase)):
        return tuple(phrase.translate(characters()["alike"]))
    if plain.replace(" ", "").isalpha() and (ascii_only or not any(map(is_han, plain))):
        return tuple(fold(w) for w in plain.split())
    return tuple(fold(t.text) for t in split_words(phrase) if t.text != "-")


SHORTEST = 3  # letters of a part of a compound


class Plurals(BaseModel):
    """How a language makes plurals: `ends` tries patterns in turn on the last word, or (`every`) on every word but those of `fixed`."""

    model_config = ConfigDict(extra="forbid")
    ends: dict[str, str] = {}
    every: bool = False
    fixed: str = ""  # words that stay, e.g. prepositions
    heads: str = ""  # behind these the first word alone may change as well

    def of(self, phrase: str) -> Iterator[str]:
        """Yield the plurals of a phrase."""
        if not self.ends:
            return
        head, _, last = phrase.rpartition(" ")
        if not self.every:
            yield f"{head} {self._word(last)}".strip()
            return
        parts, fixed, heads = phrase.split(), set(self.fixed.split()), set(self.heads.split())
        yield " ".join(p if p in fixed else self._word(p) for p in parts)
        if len(parts) > 2 and parts[1] in heads:
            yield " ".join([self._word(parts[0]), *parts[1:]])

    def _word(self, word: str) -> str:
        return next((re.sub(end, replacement, word) for end, replacement in self.ends.items() if re.search(end, word)), word)


def forms(rule: Plurals, phrase: str) -> Iterator[tuple[str, bool]]:
    """Return (form, whether it is a plural) of an entry "singular|plural|plural"."""
    single, *many = phrase.split("|")
    yield single, False
    for form in many or rule.of(single):
        yield form, form != single


class Compounds(BaseModel):
    """How words are put together: what may stand at the joint, and tails that a list shares."""

    model_config = ConfigDict(extra="forbid")
    joints: tuple[str, ...] = ()
    tails: tuple[str, ...] = ()
    melted: dict[str, str] = {}  # prepositions with their article in one word

    def complete(self, texts: list[str], known: Collection[str], joins: Collection[str]) -> list[str]:
        """Return the words with "Arbeits- oder Gästezimmer" written out; the hyphen stays where it is."""
        expanded = list(texts)
        for k in range(len(texts) - 3 if self.tails else 0):
            if texts[k + 1] == "-" and texts[k + 2] in joins and texts[k].isalpha():
                last = next((t for t in texts[k + 3 :] if t.endswith(self.tails)), texts[k + 3])  # "Koch-, Ess- und Wohnbereich"
                tail = next((t for t in self.tails if last.endswith(t) and texts[k] + t in known), "")
                expanded[k] = texts[k] + tail
        return expanded

    def split(self, word: str, known: Collection[str], wanted: Collection[str]) -> tuple[str, ...]:
        """Split a compound into known words, one of them wanted; empty where it is none: "dreizimmerwohnung" is three words."""
        for cut in range(len(word) - SHORTEST, SHORTEST - 1, -1) if self.joints else ():
            head, rest = word[:cut], word[cut:]
            stem = next((head[: len(head) - len(j)] for j in self.joints if head.endswith(j) and head[: len(head) - len(j)] in known), None)
            if stem is None or len(stem) < SHORTEST:
                continue
            tail = (rest,) if rest in known else self.split(rest, known, wanted)
            if tail and (stem in wanted or any(t in wanted for t in tail)):
                return (stem, *tail)
        return ()


class Verbs(BaseModel):
    """The forms of verbs that a description uses, told from their infinitives; each is read as the present of the third person."""

    model_config = ConfigDict(extra="forbid")
    infinitives: str = ""
    ends: dict[str, str] = {}  # of an infinitive -> of the third person of one, the present first; the longest that fits
    plural: str = ""  # what the forms of many have besides
    known: dict[str, str] = {}  # of an infinitive -> of forms that are only known not to be errors
    irregular: dict[str, str] = {}  # infinitive -> all its forms, "one|many" where the plural is another
    twofold: str = ""  # forms that are other words too
    contracted: dict[str, str] = {}  # prepositions with their article in one word

    def forms(self, infinitive: str) -> list[tuple[str, str]]:
        """Return (of one, of many) for each tense of the third person, the present first: ("abre", "abren"), ("abrirá", "abrirán")."""
        irregular = self.irregular.get(infinitive)
        parted = (form.partition("|") for form in (irregular.split() if irregular else _with_ends(infinitive, self.ends)))
        return [(one, many or one + self.plural) for one, _, many in parted]

    def canonical(self) -> dict[str, str]:
        """Return folded form -> folded form of the present, for every tense of the verbs; words that mean something else besides are left out."""
        by_form: dict[str, str] = {}
        twofold = set(self.twofold.split())
        for present, *others in map(self.forms, self.infinitives.split()):
            for form, shown in ((fold(f), fold(s)) for pair in others for f, s in zip(pair, present, strict=True)):
                if form not in twofold and form != shown:
                    by_form.setdefault(form, shown)
        return by_form

    def further(self) -> list[str]:
        """Return the present, gerunds, participles and forms of "we" and "I", which are only known not to be errors."""
        return [w for verb in self.infinitives.split() for w in (*self.forms(verb)[0], *_with_ends(verb, self.known))]


def _with_ends(infinitive: str, table: Mapping[str, str]) -> list[str]:
    """Return the forms of a verb that a table of ends gives: those of the longest end that it has."""
    last = max((end for end in table if infinitive.endswith(end)), key=len, default="")
    return [infinitive.removesuffix(last) + end for end in table[last].split()] if last else []
