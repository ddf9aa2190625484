"""The forms of a phrase of a lexicon: its plurals, by the rule that the lexicon states."""

from __future__ import annotations

import re
from collections.abc import Iterator

from pydantic import BaseModel, ConfigDict


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
        return next((re.sub(end, made, word) for end, made in self.ends.items() if re.search(end, word)), word)


def forms(rule: Plurals, phrase: str) -> Iterator[tuple[str, bool]]:
    """Return (form, whether it is a plural) of an entry "singular|plural|plural"."""
    single, *many = phrase.split("|")
    yield single, False
    for form in many or rule.of(single):
        yield form, form != single
