"""Words of a prompt with their places in it."""

from __future__ import annotations

import re
from dataclasses import dataclass

PATTERN = re.compile(
    r"\d+(?:[.,]\d{3})+(?!\d)|\d+(?:[.,]\d+)?|m²|m2\b|ft²|[^\W\d_]+(?:['’](?:s|t|ve|d|ll|re|m)\b)?|%|[.,;:!?()/&~–—+-]",
    re.IGNORECASE,
)
STOPS = frozenset(".;!?")
MARKS = frozenset(".,;:!?()/&~–—+-")


@dataclass(frozen=True, slots=True)
class Token:
    """A word `text` (lower case, repaired) = prompt[start:end] as written."""

    text: str
    start: int
    end: int
    number: float | None = None


def tokenize(prompt: str) -> list[Token]:
    """Split a prompt into words, numbers and marks."""
    tokens = []
    for match in PATTERN.finditer(prompt):
        raw = match.group().lower().replace("’", "'")
        tokens.append(Token(raw, match.start(), match.end(), _number(raw)))
    return tokens


def _number(raw: str) -> float | None:
    if not raw[0].isdigit():
        return None
    if re.fullmatch(r"\d+([.,]\d{3})+", raw):  # 1,900 and 1.900 are thousands
        return float(re.sub(r"[.,]", "", raw))
    return float(raw.replace(",", "."))
