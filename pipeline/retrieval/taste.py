"""One taste a home: a style is drawn for the home, finishes for each room, and sets are of one model."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats
from pipeline.retrieval.index import KITCHEN, AssetIndex, Match, Taste, alike_in_sets

# Groups of categories whose finishes go together in a room (`finish` of their cards), and those from which the room's is drawn, the first that the library has.
TIMBER, SOFT = "timber", "soft"
SOURCES: Mapping[str, tuple[str, ...]] = {
    TIMBER: ("sideboard", "cabinet", "tv_stand", "wardrobe", "desk", "dining_table"),
    KITCHEN: ("kitchen_cabinet", "sink_cabinet"),
    SOFT: ("multi_seat_sofa", "loveseat_sofa", "armchair"),
}


def draw_style(rng: np.random.Generator, index: AssetIndex) -> str:
    """Draw a home's style, by its share among the library's assets; "" where none has a style: then finishes alone go together."""
    styles, count = np.unique(index.styles[index.styles != ""], return_counts=True)
    return str(rng.choice(styles, p=count / count.sum())) if len(styles) else ""


def draw_finishes(rng: np.random.Generator, index: AssetIndex, style: str) -> dict[str, Floats]:
    """Draw a room's finish for each group: that of some asset of the style, of any asset where the style has none."""
    finishes: dict[str, Floats] = {}
    for group, categories in SOURCES.items():
        mark = rng.random()
        rows = np.concatenate([index.shelves.get(name, np.zeros(0, np.int64)) for name in categories])
        if style and (of_style := index.styles[rows] == style).any():
            rows = rows[of_style]
        if len(rows):
            finishes[group] = index.finishes[rows[int(mark * len(rows))]]
    return finishes


def tasteful(
    index: AssetIndex,
    taste: Taste,
    categories: Sequence[str],
    sizes: Floats,
    latents: NDArray[np.float32] | Floats,
    positions: Floats,
) -> list[Match | None]:
    """Return an asset for each of P asks, None where the library has nothing of that category: the one that suits the taste (see `AssetIndex.suited`).

    `sizes` (P, 3) [m], `latents` (P, 32), `positions` (P, 3) [m].
    """
    asked, shapes = alike_in_sets(categories, positions, sizes, np.asarray(latents, np.float64))
    rows, distances = index.suited([taste] * len(categories), categories, asked, shapes)
    return [index.fit(int(row), float(far), own) if row >= 0 else None for row, far, own in zip(rows, distances, asked, strict=True)]
