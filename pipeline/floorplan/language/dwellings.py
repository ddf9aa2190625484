"""Which words of a prompt name rooms and homes: a reader of something else leaves them alone."""

from __future__ import annotations

from pipeline.errors import RefusedError
from pipeline.floorplan.language.detection import detect
from pipeline.floorplan.language.lexicon import STRONG, Language
from pipeline.floorplan.language.marks import listen, segment


def named(prompt: str) -> tuple[Language | None, frozenset[int]]:
    """Return the language of a prompt (None where it is none that is read), and the places where words for rooms and homes begin."""
    try:
        language = detect(prompt)
    except RefusedError:
        return None, frozenset()
    heard = listen(prompt, language)
    rooms = (m for m in segment(heard) if m.kind in STRONG)
    return language, frozenset(heard.tokens[k].start for m in rooms for k in range(m.first, m.last))
