"""Repair of typing errors against a closed vocabulary: edit distance, inflection, missing spaces, compounds."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence

from pipeline.floorplan.language.german import split as compound
from pipeline.floorplan.language.lexicon import Language, Lexicon, lexicon
from pipeline.floorplan.language.meaning import Meaning
from pipeline.floorplan.language.text import Token

SHORTEST, LONG = 4, 8  # one error from SHORTEST letters on, two from LONG on
LONGEST = 30  # no word of a home is longer
ROWS = ("qwertzuiop", "asdfghjkl", "yxcvbnm", "qwertyuiop", "zxcvbnm")
NEIGHBOURS = frozenset(p for r in ROWS for a, b in itertools.pairwise(r) for p in ((a, b), (b, a)))


def repair(tokens: Sequence[Token], texts: Sequence[str], lex: Lexicon) -> tuple[list[Token], list[str]]:
    """Return the tokens with their words of the vocabulary: inflected and mistyped ones replaced, run-together ones split."""
    made: list[Token] = []
    words: list[str] = []
    for token, text in zip(tokens, texts, strict=True):
        parts = (text,) if text in lex.vocabulary or not text.replace("'", "").isalpha() else resolve(text, lex.language)
        for part in parts:
            made.append(token)
            words.append(part)
    return made, words


@functools.lru_cache(maxsize=8192)
def resolve(word: str, language: Language) -> tuple[str, ...]:  # noqa: PLR0911 - one branch per case: a grammar
    """Return the known words that an unknown one stands for, or itself."""
    lex = lexicon(language)
    if len(word) > LONGEST or len(word) < 3 or "\u3400" <= word[0] <= "\u9fff":
        return (word,)
    if language == "es" and (alike := _alike(language).get(sound(word))):
        return (alike,)
    stem = _stem(word, lex)
    if stem:
        return (stem,)
    if word.endswith("'s") and word[:-2] in lex.vocabulary:
        return (word[:-2],)
    near, gap = _nearest(word, language)
    if gap == 1 and near:
        return (near,)
    parts = _split(word, lex)
    if parts:
        return parts
    if near:
        return (near,)
    for ending in lex.endings:  # mistyped and inflected
        if word.endswith(ending) and len(word) - len(ending) >= SHORTEST + 1:
            near, _ = _nearest(word[: -len(ending)], language)
            if near:
                return (near,)
    return (word,)


SOUNDS = (
    ("qu", "k"),
    ("ce", "se"),
    ("ci", "si"),
    ("ch", "x"),
    ("ll", "y"),
    ("h", ""),
    ("v", "b"),
    ("z", "s"),
    ("c", "k"),
    ("x", "ch"),
    ("ge", "je"),
    ("gi", "ji"),
)


def sound(word: str) -> str:
    """Return how a Spanish word sounds, near enough: "vaño" and "baño", "cosina" and "cocina" alike."""
    for written, heard in SOUNDS:
        word = word.replace(written, heard)
    return word


@functools.cache
def _alike(language: Language) -> dict[str, str]:
    """Return the words worth a repair by their sound, where only one sounds so."""
    lex = lexicon(language)
    made: dict[str, str] = {}
    for target in lex.targets:
        made[sound(target)] = "" if sound(target) in made else target
    return made


def inflected(word: str, lex: Lexicon) -> Meaning | None:
    """Return what the uninflected form of a word means by itself: "kleine" is "klein"."""
    for ending in lex.endings:
        if word.endswith(ending) and len(word) - len(ending) >= SHORTEST - 1:
            found: Meaning | None = lex.trie.get(word[: -len(ending)], {}).get("")
            if found is not None:
                return found
    return None


def _stem(word: str, lex: Lexicon) -> str:
    for ending in lex.endings:
        cut = word[: -len(ending)]
        if word.endswith(ending) and len(cut) >= 3:
            for known in (cut, cut + "e"):
                if known in lex.vocabulary:
                    return known
    return ""


def _split(word: str, lex: Lexicon) -> tuple[str, ...]:
    """Split "twobedroom" or "openkitchen": two known words, one of them worth a repair."""
    targets = _strong(lex.language)
    if lex.language == "de":
        return compound(word, lex.vocabulary, targets)
    for cut in range(len(word) - 3, 2, -1):
        a, b = word[:cut], word[cut:]
        if a in lex.vocabulary and b in lex.vocabulary and (a in targets or b in targets) and len(a) >= 3 and len(b) >= 3:
            return (a, b)
    return ()


@functools.cache
def _strong(language: Language) -> frozenset[str]:
    return frozenset(lexicon(language).targets)


def _nearest(word: str, language: Language) -> tuple[str, int]:
    """Return the one known word that is near enough, and its distance; ("", 9) where there is none or two are as near."""
    allowed = 0 if len(word) < SHORTEST else (1 if len(word) < LONG - 1 else 2)
    best, least, tied = "", 9.0, False
    mask, shelves = _letters(word), _shelves(language)
    for size in range(len(word) - allowed, len(word) + allowed + 1):
        for target, letters in shelves.get(size, ()):
            if (mask ^ letters).bit_count() > 2 * allowed:  # an edit changes two letters at most
                continue
            cost = _cost(word, target, allowed)
            if cost < least:
                best, least, tied = target, cost, False
            elif cost == least and target != best:
                tied = True
    if tied and least > 1.5:
        return "", 9
    return best, (1 if least <= 1.2 else 2) if best else 9


def _cost(word: str, target: str, allowed: int) -> float:
    """Return how far a known word is: edits, usual slips cheaper, another first letter dearer; 9 where it is too far."""
    most = 1 if len(target) < LONG - 1 else allowed
    if len(word) < LONG and most == 2 and sorted(word) != sorted(target):
        most = 1
    gap = distance(word, target, most)
    if gap > most or (len(target) == SHORTEST and len(word) <= SHORTEST and _risky(word, target)):
        return 9.0
    other = word[0] != target[0]
    if other and (gap > 1 or len(word) < 6):
        return 9.0
    return gap - (0.3 if _slip(word, target) else 0.0) + (0.2 if other else 0.0)


def _letters(word: str) -> int:
    """Return the set of a word's letters as bits."""
    made = 0
    for char in word:
        made |= 1 << (ord(char) & 31)
    return made


@functools.cache
def _shelves(language: Language) -> dict[int, list[tuple[str, int]]]:
    """Return the words worth a repair by length, each with its letters."""
    made: dict[int, list[tuple[str, int]]] = {}
    for target in lexicon(language).targets:
        made.setdefault(len(target), []).append((target, _letters(target)))
    return made


def _risky(word: str, target: str) -> bool:
    """Whether a four-letter word differs otherwise than by swapped or doubled letters: it may well be another word."""
    return sorted(word) != sorted(target)


def _slip(word: str, target: str) -> bool:
    """Whether the error is a usual one: swapped, doubled or neighbouring keys."""
    if sorted(word) == sorted(target):
        return True
    if len(word) != len(target):
        longer, shorter = sorted((word, target), key=len, reverse=True)
        return any(
            longer[:k] + longer[k + 1 :] == shorter and longer[k] in longer[max(0, k - 1) : k] + longer[k + 1 : k + 2]
            for k in range(len(longer))
        )
    wrong = [(a, b) for a, b in zip(word, target, strict=True) if a != b]
    return len(wrong) == 1 and wrong[0] in NEIGHBOURS


def distance(a: str, b: str, most: int) -> int:
    """Edit distance with swaps of neighbours; anything above `most` counts as most + 1."""
    if a == b:
        return 0
    before: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        now = [i]
        for j, y in enumerate(b, 1):
            cost = min(row[j] + 1, now[j - 1] + 1, row[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                cost = min(cost, before[j - 2] + 1)
            now.append(cost)
        if min(now) > most:
            return most + 1
        before, row = row, now
    return row[-1]
