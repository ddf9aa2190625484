"""Which words of a prompt name rooms and homes: a reader of something else leaves them alone."""

from __future__ import annotations

from pipeline.errors import RefusedError
from pipeline.floorplan.language.detection import detect
from pipeline.floorplan.language.lexicon import STRONG, Language
from pipeline.floorplan.language.marks import listen, segment


def named(prompt: str) -> tuple[Language | None, frozenset[int], frozenset[int]]:
    """Return the language of a prompt (None where it is none that is read), where words for rooms and homes begin, and which are not their first."""
    try:
        language = detect(prompt)
    except RefusedError:
        return None, frozenset(), frozenset()
    heard = listen(prompt, language)
    rooms = [m for m in segment(heard) if m.kind in STRONG]
    starts, inner = ([heard.tokens[k].start for m in rooms for k in range(m.first + skip, m.last)] for skip in (0, 1))
    return language, frozenset(starts), frozenset(inner)
