"""Product lines: for each category how many models it has, and in which forms they come, from its card."""

import functools
from collections.abc import Mapping
from dataclasses import dataclass

from pipeline import style
from pipeline.card import Corpus, cards
from pipeline.corpus.furniture.finishes import MANNERS

# 3D-FUTURE's super-category for each of our own (`super` of the cards); it has none for kitchens and baths.
SUPER_CATEGORIES: Mapping[str, str] = {
    "bed": "Bed",
    "cabinet": "Cabinet/Shelf/Desk",
    "table": "Table",
    "chair": "Chair",
    "stool": "Pier/Stool",
    "sofa": "Sofa",
    "lighting": "Lighting",
}
OTHER_SUPER_CATEGORY = "Others"


@dataclass(frozen=True, slots=True)
class Form:
    """One form of a category: what its card says of it, with its `name`, the category name `future` to write, and the `styles` it comes in."""

    name: str
    future: str
    round: bool
    upright: bool
    still: bool
    least_height: float
    styles: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Line:
    """A category's models at size 1: `static` ones as 3D-FUTURE folders, `moving` ones as PartNet-Mobility folders."""

    forms: tuple[Form, ...]
    static: int
    moving: int = 0


@functools.cache
def lines() -> Mapping[str, Line]:
    """Return the lines by category, in the corpus's order."""
    listed = sorted(
        (c for c in cards().values() if c.corpus.forms), key=lambda c: (c.order if c.corpus.order is None else c.corpus.order, c.name)
    )
    return {c.name: _line(c.corpus) for c in listed}


def _line(corpus: Corpus) -> Line:
    forms = []
    for name, f in corpus.forms.items():
        styles = tuple(s for word in f.styles for s in style.load().groups.get(word, (word,)))  # words for several are spelt out
        forms.append(Form(name, f.name or corpus.name, f.round, f.upright, f.still, f.least_height, styles or tuple(MANNERS)))
    return Line(tuple(forms), corpus.static, corpus.moving)
