"""Which of the four languages a prompt is written in; any other is refused."""

from __future__ import annotations

import re

from pipeline.errors import RefusedError
from pipeline.floorplan.language.lexicon import LANGUAGES, STRONG, Language, lexicon
from pipeline.floorplan.language.spelling import resolve
from pipeline.floorplan.language.text import HAN, Token, fold, tokenize

READ = "English, German, Spanish and Chinese"
ENOUGH = 0.5  # share of words that must be known
MOST = 400  # words that are looked at
SURE, REPAIRED = 0.75, 80  # share of words that settles it; words that are repaired otherwise
ROOMS_WEIGHT = 2.0


def detect(prompt: str) -> Language:
    """Return the language of a prompt. Raises RefusedError where too few of its words belong to any of the four."""
    tokens = tokenize(prompt)
    texts = [fold(t.text) for t in tokens if any(c.isalpha() for c in t.text)][:MOST]
    if not texts:
        raise RefusedError(_shown(prompt, "no words in the prompt"), f"say in {READ} which rooms you want")
    han = sum("\u3400" <= t[0] <= "\u9fff" for t in texts)
    foreign = _foreign(tokens)
    if han and han >= 0.3 * len(texts) and not foreign:
        return "zh"
    scores = {language: _score(language, texts, repaired=False) for language in LANGUAGES if language != "zh"}
    best = max(scores, key=lambda x: scores[x][0])
    if scores[best][1] < SURE * len(texts):  # typing errors, or another language
        texts = texts[:REPAIRED]
        scores = {language: _score(language, texts, repaired=True) for language in LANGUAGES if language != "zh"}
        best = max(scores, key=lambda x: scores[x][0])
    known, strong = scores[best][1], scores[best][2]
    share = (known + min(han, 2)) / len(texts)
    if foreign > 0.3 * len(texts) or share < ENOUGH * (0.6 if strong >= 2 and len(texts) < 8 else 1.0):
        raise RefusedError(_shown(prompt, "the prompt is in no language that is read here"), f"write it in {READ}")
    return best


def _shown(prompt: str, why: str) -> str:
    shown = re.sub(r"\s+", " ", prompt.strip())[:60]
    return f"{why}: {shown!r}"


def _foreign(tokens: list[Token]) -> int:
    """Count words in a script that none of the four languages uses."""
    return sum(t.text[0].isalpha() and not re.match(rf"[a-zà-ÿœß{HAN}]", t.text) for t in tokens)


def _score(language: Language, texts: list[str], *, repaired: bool) -> tuple[float, int, int]:
    """Return (score, known words, words of rooms and homes)."""
    lex = lexicon(language)
    known = strong = 0
    score = 0.0
    for text in texts:
        if text in lex.vocabulary:
            parts: tuple[str, ...] = (text,)
        else:
            parts = resolve(text, language) if repaired else (text,)
            if parts == (text,):
                continue
        known += 1
        node = lex.trie.get(parts[0], {})
        named = "" in node and node[""].kind in STRONG
        strong += named
        score += (ROOMS_WEIGHT if named else 1.0) * (1.0 if parts == (text,) else 0.6)
    return score, known, strong
