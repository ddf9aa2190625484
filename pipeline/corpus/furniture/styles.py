"""Styles as the builders use them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pipeline import style
from pipeline.style import StyleSpec

MANNERS: Mapping[str, StyleSpec] = {name: made.spec for name, made in style.load().styles.items()}
CLASSIC, ORIENTAL = (style.load().groups[name] for name in ("classic", "oriental"))


def expand_styles(styles: Sequence[str]) -> tuple[str, ...]:
    """Return the styles that a form comes in, with the words for several spelt out; all where its card names none."""
    return tuple(s for name in styles for s in style.load().groups.get(name, (name,))) or tuple(MANNERS)
