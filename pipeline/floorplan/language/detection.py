"""Which of the languages that have a lexicon a prompt is written in; any other is refused."""

from __future__ import annotations

import functools
import re

from pipeline.errors import RefusedError
from pipeline.floorplan.language.lexicon import LANGUAGES, STRONG, Language, lexicon, unread
from pipeline.floorplan.language.spelling import resolve
from pipeline.floorplan.language.text import HAN, Token, fold, tokenize

ENOUGH = 0.5  # share of words that must be known
REPAIR = 0.8  # what a mistyped word counts of a known one
MOST = 400  # words that are looked at
SURE, REPAIRED = 0.75, 80  # share of words that settles it; words that are repaired otherwise
ROOMS_WEIGHT = 2.0


@functools.lru_cache(maxsize=16)
def detect(prompt: str) -> Language:
    """Return the language of a prompt. Raises RefusedError where too few of its words belong to any that is read."""
    tokens = tokenize(prompt)
    texts = [fold(t.text) for t in tokens if any(c.isalpha() for c in t.text)][:MOST]
    if not texts:
        raise RefusedError(_shown(prompt, "no words in the prompt"), f"say in {_read()} which rooms you want")
    han = sum("\u3400" <= t[0] <= "\u9fff" for t in texts)
    foreign = _foreign(tokens)
    if han and han >= 0.3 * len(texts) and not foreign:
        return next(language for language in LANGUAGES if _han(language))
    scores = {language: _score(language, texts, repaired=False) for language in LANGUAGES if not _han(language)}
    best = max(scores, key=lambda x: scores[x][0])
    if scores[best][1] < SURE * len(texts):  # typing errors, or another language
        texts = texts[:REPAIRED]
        scores = {language: _score(language, texts, repaired=True) for language in LANGUAGES if not _han(language)}
        best = max(scores, key=lambda x: scores[x][0])
    exact, close = scores[best][1], scores[best][2]
    others = sum(t in unread() for t in texts)
    share = (exact + REPAIR * close + min(han, 2)) / len(texts)
    if foreign > 0.3 * len(texts) or share < ENOUGH or (others > 1 and others >= 0.15 * len(texts)):
        raise RefusedError(_shown(prompt, "the prompt is in no language that is read here"), f"write it in {_read()}")
    return best


def _han(language: Language) -> bool:
    """Whether a language is written in Chinese characters."""
    return "characters" in lexicon(language).traits


def _read() -> str:
    """Return the names of the languages that are read."""
    *most, last = sorted(lexicon(language).name for language in LANGUAGES)
    return f"{', '.join(most)} or {last}"


def _shown(prompt: str, why: str) -> str:
    shown = re.sub(r"\s+", " ", prompt.strip())[:60]
    return f"{why}: {shown!r}"


def _foreign(tokens: list[Token]) -> int:
    """Count words in a script that no language that is read uses."""
    return sum(t.text[0].isalpha() and not re.match(rf"[a-zà-ÿœß{HAN}]", t.text) for t in tokens)


def _score(language: Language, texts: list[str], *, repaired: bool) -> tuple[float, int, int]:
    """Return (score, known words, words that are known once repaired)."""
    lex = lexicon(language)
    exact = close = 0
    score = 0.0
    for text in texts:
        parts: tuple[str, ...] = (text,)
        known = text in lex.vocabulary
        if not known:
            parts = resolve(text, language) if repaired else parts
            if parts == (text,):
                continue
        exact, close = exact + known, close + (not known)
        node = lex.trie.get(parts[0], {})
        named = "" in node and node[""].kind in STRONG
        score += (ROOMS_WEIGHT if named else 1.0) * (1.0 if known else 0.6)
    return score, exact, close
