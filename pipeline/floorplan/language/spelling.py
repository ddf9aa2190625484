"""Repair of typing errors against a closed vocabulary, and which of the languages that have a lexicon a prompt is written in."""

import functools
import heapq
import re
from collections.abc import Sequence

from pipeline.errors import RefusedError
from pipeline.floorplan.language.lexicon import FARTHER, LANGUAGES, STRONG, Language, Lexicon, Meaning, kinds, lexicon, unread
from pipeline.floorplan.language.text import Word, characters, fold, is_han, split_words

SHORTEST, LONG = 4, 8  # one error from SHORTEST letters on, two from LONG on
ONE, USUAL = 1.2, 0.9  # how far a word with one error is at most, and with a usual one
TINY = kinds("tiny")
LONGEST = 30  # no word of a home is longer
FAR, SURELY = 9.0, 1.5  # farther than any word is, and the distance from which on two words as near are no better than none


def repair(written: Sequence[Word], texts: Sequence[str], lex: Lexicon) -> tuple[list[Word], list[str]]:
    """Return the words with what they are in the vocabulary: inflected and mistyped ones replaced, run-together ones split."""
    read: list[tuple[Word, str]] = []
    for word, text in zip(written, texts, strict=True):
        known = text in lex.vocabulary or not text.replace("'", "").isalpha()
        read += [(word, part) for part in ((text,) if known else resolve(text, lex.language, every=True))]
    return [word for word, _ in read], [part for _, part in read]


@functools.lru_cache(maxsize=8192)
def resolve(word: str, language: Language, *, every: bool = False) -> tuple[str, ...]:
    """Return the known words that an unknown one stands for, or itself: names of rooms, numbers and the like, or `every` word of the vocabulary."""
    lex = lexicon(language)
    if len(word) > LONGEST or len(word) < 3 or is_han(word[0]):
        return (word,)
    stem = _stem(word, lex)
    if stem:
        return (stem,)
    bared = word.removesuffix("'").removesuffix(characters()["genitive"])
    if bared != word:
        return (bared,) if bared in lex.vocabulary else resolve(bared, language, every=every)
    near, cost = _nearest(word, language, every)
    if near and cost <= (ONE if near in lex.strong else USUAL):
        return (near,)
    if parts := _split(word, lex):
        return parts
    return (near or word,)


def uninflected_meaning(word: str, lex: Lexicon) -> Meaning | None:
    """Return what the uninflected form of a word means by itself: "kleine" is "klein"."""
    stems = (word.removesuffix(e) for e in lex.endings if word.endswith(e) and len(word) - len(e) >= SHORTEST - 1)
    meanings = (lex.trie.get(stem, {}).get("") for stem in stems)
    return next((meaning for meaning in meanings if meaning is not None), None)


def _stem(word: str, lex: Lexicon) -> str:
    for ending in lex.endings:
        cut = word[: -len(ending)]
        if word.endswith(ending) and len(cut) >= 3:
            for known in (cut, cut + "e"):
                if known in lex.vocabulary:
                    return known
    return ""


def _split(word: str, lex: Lexicon) -> tuple[str, ...]:
    """Split "twobedroom", "openkitchen", "intothe" into known words."""
    if parts := lex.compounds.split(word, lex.vocabulary, lex.strong):
        return parts
    for cut in range(len(word) - 2, 1, -1):
        a, b = word[:cut], word[cut:]
        if a not in lex.vocabulary or b not in lex.vocabulary:
            continue
        least, most = sorted((len(a), len(b)))
        speak = all(_speaks(w, lex) for w in (a, b))
        if (least >= SHORTEST - 1 and (a in lex.strong or b in lex.strong)) or (speak and most >= SHORTEST - 1):
            return (a, b)
    return ()


def _speaks(word: str, lex: Lexicon) -> bool:
    """Whether a word builds sentences or names a room; of two letters only an article, a preposition and their like."""
    if len(word) >= SHORTEST - 1:
        return word in lex.strong or lex.others.get(word, 1.0) <= FARTHER[True]
    meaning: Meaning | None = lex.trie.get(word, {}).get("")
    return meaning is not None and meaning.kind in TINY


def _nearest(word: str, language: Language, every: bool) -> tuple[str, float]:
    """Return the one known word that is near enough, and how far it is; ("", FAR) where there is none or two are as near."""
    allowed = 1 if len(word) < LONG - 1 else 2
    mask, shelves = _letters(word), _shelves(language)
    near = (
        (_cost(word, target, far), target)
        for size in range(len(word) - allowed, len(word) + allowed + 1)
        for target, letters, far in shelves.get(size, ())
        if (every or not far) and (mask ^ letters).bit_count() <= 2 * allowed  # an edit changes two letters at most
    )
    best = heapq.nsmallest(2, near, key=lambda n: n[0])
    tied = len(best) > 1 and best[0][0] == best[1][0] > SURELY
    return (best[0][1], best[0][0]) if best and best[0][0] < FAR and not tied else ("", FAR)


def _cost(word: str, target: str, far: float) -> float:
    """Return how far a known word is: edits, usual slips cheaper, another first letter dearer; FAR where it is too far.

    `far`: how much farther it is than the name of a room, 0 for those; only they may be two errors away.
    """
    short, swapped = min(len(word), len(target)), sorted(word) == sorted(target)
    two = not far and len(target) >= LONG - 1 and (len(word) >= LONG or swapped)
    gap = distance(word, target, 2 if two else 1)
    usual, other = swapped or _slip(word, target), word[0] != target[0]
    tiny = (short <= SHORTEST and not usual) or (short < SHORTEST - 1 and not swapped)
    if tiny or gap > 1 + two or (other and (gap > 1 or len(word) < LONG - 2)):
        return FAR
    return gap - (0.3 if usual else 0.0) + (0.2 if other else 0.0) + far


def _slip(word: str, target: str) -> bool:
    """Whether one usual error parts two words: a letter left out, or doubled."""
    longer, shorter = sorted((word, target), key=len, reverse=True)
    gone = [k for k in range(len(longer)) if longer[:k] + longer[k + 1 :] == shorter]
    return any((k and longer is target) or longer[k] in longer[max(0, k - 1) : k] + longer[k + 1 : k + 2] for k in gone)


def _letters(word: str) -> int:
    """Return the set of a word's letters as bits."""
    return functools.reduce(lambda bits, char: bits | 1 << (ord(char) & 31), word, 0)


@functools.cache
def _shelves(language: Language) -> dict[int, list[tuple[str, int, float]]]:
    """Return the words of the vocabulary by length, each with its letters and how much farther it is than the name of a room."""
    by_length: dict[int, list[tuple[str, int, float]]] = {}
    lex = lexicon(language)
    for target, far in (*((t, 0.0) for t in lex.targets), *sorted(lex.others.items())):
        by_length.setdefault(len(target), []).append((target, _letters(target), far))
    return by_length


def distance(a: str, b: str, most: int) -> int:
    """Edit distance with swaps of neighbours; anything above `most` counts as most + 1."""
    same = next((k for k, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))
    a, b = a[same:], b[same:]
    if not (a and b and most):
        return min(len(a) + len(b), most + 1) if most else int(a != b)
    swap = [(a[2:], b[2:])] if a[:2] == b[1::-1] and len(b) > 1 else []
    return 1 + min(distance(x, y, most - 1) for x, y in [(a[1:], b), (a, b[1:]), (a[1:], b[1:]), *swap])


ENOUGH = 0.5  # share of words that must be known
REPAIR = 0.8  # what a mistyped word counts of a known one
MOST = 400  # words that are looked at
SURE, REPAIRED = 0.75, 80  # share of words that settles it; words that are repaired otherwise
ROOMS_WEIGHT = 2.0


@functools.lru_cache(maxsize=16)
def detect(prompt: str) -> Language:
    """Return the language of a prompt. Raises RefusedError where too few of its words belong to any that is read."""
    written, quoted = split_words(prompt), repr(" ".join(prompt.split())[:60])
    *most, last = sorted(lexicon(language).name for language in LANGUAGES)
    texts = [fold(t.text) for t in written if any(c.isalpha() for c in t.text)][:MOST]
    if not texts:
        raise RefusedError(f"no words in the prompt: {quoted}", f"say in {', '.join(most)} or {last} which rooms you want")
    han, in_letters = sum(is_han(t[0]) for t in texts), [n for n in LANGUAGES if "characters" not in lexicon(n).traits]
    letters = characters()["latin"] + characters()["han"]
    foreign = sum(t.text[0].isalpha() and not re.match(rf"[{letters}]", t.text) for t in written)  # in a script that is not read
    if han and han >= 0.3 * len(texts) and not foreign:
        return next(language for language in LANGUAGES if language not in in_letters)
    scores = [(*_score(language, texts, repaired=False), language) for language in in_letters]
    if max(scores, key=lambda s: s[0])[1] < SURE * len(texts):  # typing errors, or another language
        texts = texts[:REPAIRED]
        scores = [(*_score(language, texts, repaired=True), language) for language in in_letters]
    _, exact, close, best = max(scores, key=lambda s: s[0])
    others = sum(t in unread() for t in texts)
    share = (exact + REPAIR * close + min(han, 2)) / len(texts)
    if foreign > 0.3 * len(texts) or share < ENOUGH or (others > 1 and others >= 0.15 * len(texts)):
        raise RefusedError(f"the prompt is in no language that is read here: {quoted}", f"write it in {', '.join(most)} or {last}")
    return best


def _score(language: Language, texts: list[str], *, repaired: bool) -> tuple[float, int, int]:
    """Return (score, known words, words that are known once repaired)."""
    lex = lexicon(language)
    exact, close, score = 0, 0, 0.0
    for text in texts:
        known = text in lex.vocabulary
        parts = resolve(text, language) if repaired and not known else (text,)
        if not known and parts == (text,):
            continue
        exact, close = exact + known, close + (not known)
        node = lex.trie.get(parts[0], {})
        named = "" in node and node[""].kind in STRONG
        score += (ROOMS_WEIGHT if named else 1.0) * (1.0 if known else 0.6)
    return score, exact, close
