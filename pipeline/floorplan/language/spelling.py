"""Repair of typing errors against a closed vocabulary (optimal string alignment distance)."""

from __future__ import annotations

import functools
from dataclasses import replace

from pipeline.floorplan.language import lexicon
from pipeline.floorplan.language.tokens import Token

SHORTEST, LONG = 5, 7  # words shorter than SHORTEST are left alone; from LONG letters on two errors are repaired
CUE_WORDS = ("adjacent", "between", "without", "connected", "separated", "downstairs", "upstairs", "adjoining", "largest")


@functools.cache
def vocabulary() -> tuple[frozenset[str], tuple[str, ...]]:
    """Return all known words, and those worth repairing towards: words of rooms, homes, units, numbers, cues and styles."""
    phrases = [*lexicon.ROOMS, *map(lexicon.plural, lexicon.ROOMS), *lexicon.SUITES, *map(lexicon.plural, lexicon.SUITES)]
    phrases += [*lexicon.CUES, *lexicon.UNITS, *lexicon.STYLES, *lexicon.NUMBERS, *lexicon.HOMES, *lexicon.ADJECTIVES, *lexicon.OWNERS]
    phrases += [*lexicon.BIG, *lexicon.LEAST, *lexicon.MOST, *lexicon.ABOUT, *lexicon.ORDINALS]
    known = {w for p in phrases for w in p.split()} | lexicon.FILLER | {h + "s" for h in lexicon.HOMES}
    nouns = [*lexicon.ROOMS, *map(lexicon.plural, lexicon.ROOMS), *lexicon.HOMES, *lexicon.UNITS, *lexicon.NUMBERS, *CUE_WORDS]
    targets = {w for p in nouns for w in p.split() if w.isalpha() and len(w) >= SHORTEST}
    return frozenset(known), tuple(sorted(targets))


def repair(tokens: list[Token]) -> list[Token]:
    """Replace unknown words by the one known word that is near enough; leave what is ambiguous or far."""
    known, targets = vocabulary()
    return [replace(t, text=_nearest(t.text, targets)) if _doubtful(t.text, known) else t for t in tokens]


def _doubtful(word: str, known: frozenset[str]) -> bool:
    return word.isalpha() and len(word) >= SHORTEST - 1 and word not in known


@functools.lru_cache(maxsize=4096)
def _nearest(word: str, targets: tuple[str, ...]) -> str:
    allowed = 1 if len(word) < LONG else 2
    best, least = word, allowed + 1
    for target in targets:
        if abs(len(target) - len(word)) > allowed:
            continue
        gap = distance(word, target, allowed)
        if gap > 1 and target[0] != word[0]:  # two errors, and the first letter one of them: too far
            continue
        if gap < least or (gap == least and gap <= allowed and target[0] == word[0] != best[0]):
            best, least = target, gap
    return best


def distance(a: str, b: str, most: int) -> int:
    """Edit distance with swaps of neighbours; anything above `most` counts as most + 1."""
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
