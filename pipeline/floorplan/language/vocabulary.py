"""The words in which furniture is wished for: how prompts are split, what alike words have in common, the phrases that are known."""

from __future__ import annotations

import functools
import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pipeline.floorplan.language.lexicon import LANGUAGES, Language
from pipeline.floorplan.language.lexicon import lexicon as spoken
from pipeline.floorplan.language.spelling import resolve
from pipeline.floorplan.program.furniture import lexicon

HAN = "\u3400-\u9fff"
WORD = re.compile(rf"\d+(?:[.,]\d+)?|[{HAN}]|[^\W\d_{HAN}]+(?:'[^\W\d_]+)?|[%.,;:!?()\n+&、。;,!?]")
STOPS = frozenset(".;!?\n。;!?")
COMMAS = STOPS | {",", "、"}
ENDINGS = ("en", "es", "as", "os", "em", "e", "n", "s", "a", "o")
FIGURES = re.compile(r"[0-9]+(?:[.,][0-9]+)?")
LEADING = frozenset({"through", "leading", "opening", "durch", "por"})  # behind a closet that one walks through
MOST = 1e6  # of any amount
HAN_DIGITS = {c: k for k, c in enumerate("零一二三四五六七八九")} | {"两": 2, "俩": 2}
ROOMS = frozenset({"room", "rooms", "area", "corner", "niche", "nook", "zone", "space", "raum", "ecke", "bereich"})


@dataclass(frozen=True, slots=True)
class Word:
    """A word, folded (no accents, lower case), its stem, and its place in the prompt."""

    text: str
    stem: str
    start: int
    end: int


def fold(text: str) -> str:
    """Return lower case without accents; sharp s as ss."""
    lower = unicodedata.normalize("NFKC", text).lower().replace("ß", "ss")
    return "".join(c for c in unicodedata.normalize("NFD", lower) if not unicodedata.combining(c))


@functools.lru_cache(maxsize=8192)
def stem(word: str) -> str:
    """Return a folded word without the endings of plurals, cases and genders of English, German and Spanish."""
    for _ in range(2):
        cut = next((e for e in ENDINGS if word.endswith(e) and len(word) - len(e) >= 3), "")
        word = word.removesuffix(cut) if cut else word
    return word


def words(text: str) -> list[Word]:
    """Split a text; Chinese into single characters. Hyphens part words."""
    found = []
    for match in WORD.finditer(text):
        folded = fold(match.group())
        found.append(Word(folded, stem(folded) if folded.isalpha() else folded, match.start(), match.end()))
    return found


def mended(found: Sequence[Word], language: Language | None) -> list[Word]:
    """Return the words with typing errors repaired, each in its place."""
    if language is None or "characters" in spoken(language).traits:
        return list(found)
    known = spoken(language).vocabulary
    made: list[Word] = []
    for word in found:
        unknown = word.text.isalpha() and word.text not in known and word.stem not in stems()
        parts = resolve(word.text, language, every=True) if unknown else (word.text,)
        made += [word] if parts == (word.text,) else [Word(p, stem(p), word.start, word.end) for p in parts]
    return made


@functools.cache
def stems() -> frozenset[str]:
    """Return the stems of all words that speak of furniture."""
    return frozenset(s for entries in phrases().values() for entry in entries for s in entry[0])


@functools.cache
def numbers() -> Mapping[str, int]:
    """Return the number words of all languages; articles are none."""
    articles = {fold(w) for kind in ("one", "article") for w in lexicon()["words"][kind]}
    single = ((w, node[""]) for language in LANGUAGES for w, node in spoken(language).trie.items() if w.isascii() and "" in node)
    return {w: int(m.number) for w, m in single if m.kind == "num" and w not in articles and m.number.is_integer()}


@functools.cache
def phrases() -> Mapping[str, tuple[tuple[tuple[str, ...], str, str, bool], ...]]:
    """Return by first stem: (stems, kind, name, whether an owner is needed), the longest first."""
    table: dict[str, list[tuple[tuple[str, ...], str, str, bool]]] = {}

    def add(form: str, kind: str, name: str) -> None:
        owned = form.startswith("@")
        stems = tuple(w.stem for w in words(form.removeprefix("@")))
        table.setdefault(stems[0], []).append((stems, kind, name, owned))

    data = lexicon()
    for name, forms in data["names"].items():
        for listed in forms.values():
            for form in listed:
                add(form, "name", name)
    for form in data["small"]:
        add(form, "small", form)
    for name, listed in data["styles"].items():
        for form in listed:
            add(form, "look", name)
    for name, listed in data["words"].items():
        for form in listed:
            if form != "-":
                add(str(form), name, form)
    for name, listed in data["owners"].items():
        for form in listed:
            add(form, "owner", name)
    return {k: tuple(sorted(v, key=lambda p: -len(p[0]))) for k, v in table.items()}
