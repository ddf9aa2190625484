"""One taste a home: a style is drawn for the home, finishes for each room, and sets are of one model."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats
from pipeline.card import cards
from pipeline.retrieval.index import AssetIndex, Match

STEP, MOST_STEPS = 30.0, 2.0  # how far off a finish has to be to count once [CIELAB]; it counts so many times at most

# Groups of categories whose finishes go together in a room (`finish` of their cards), and those from which the room's is drawn, the first that the library has.
TIMBER, KITCHEN, SOFT = "timber", "kitchen", "soft"
SOURCES: Mapping[str, tuple[str, ...]] = {
    TIMBER: ("sideboard", "cabinet", "tv_stand", "wardrobe", "desk", "dining_table"),
    KITCHEN: ("kitchen_cabinet", "sink_cabinet"),
    SOFT: ("multi_seat_sofa", "loveseat_sofa", "armchair"),
}


@dataclass(frozen=True, slots=True)
class Taste:
    """What steers retrieval in a room: the home's `style` ("" for none), `wished` where somebody asked for it, and finishes by group."""

    style: str = ""
    wished: bool = False
    finishes: Mapping[str, Floats] = field(default_factory=dict)


def draw_style(rng: np.random.Generator, index: AssetIndex) -> str:
    """Draw a home's style, by its share among the library's assets; "" where none has a style: then finishes alone go together."""
    styles, count = np.unique(index.styles[index.styles != ""], return_counts=True)
    return str(rng.choice(styles, p=count / count.sum())) if len(styles) else ""


def draw_finishes(rng: np.random.Generator, index: AssetIndex, style: str) -> dict[str, Floats]:
    """Draw a room's finish for each group: that of some asset of the style, of any asset where the style has none."""
    finishes: dict[str, Floats] = {}
    for group, categories in SOURCES.items():
        mark = rng.random()
        rows = [int(k) for name in categories for k in index.shelves.get(name, ())]
        rows = [k for k in rows if style and index.styles[k] == style] or rows
        if rows:
            finishes[group] = index.finishes[rows[int(mark * len(rows))]]
    return finishes


def sets(categories: Sequence[str], positions: Floats) -> list[list[int]]:
    """Return the groups (indices, two or more each) of proposals at `positions` (P, 3) [m] that are to be one model."""
    groups: dict[tuple[str, int], list[int]] = {}
    for k, category in enumerate(categories):
        of = cards()[category].set if category in cards() else None
        if of is None:
            continue
        near = [(float(np.linalg.norm(positions[j, :2] - positions[k, :2])), j) for j, other in enumerate(categories) if other in of.at]
        if near and min(near)[0] <= of.within:
            groups.setdefault((category, min(near)[1]), []).append(k)
    return [group for group in groups.values() if len(group) > 1]


def tasteful(
    index: AssetIndex,
    taste: Taste,
    categories: Sequence[str],
    sizes: Floats,
    latents: NDArray[np.float32] | Floats,
    positions: Floats,
) -> list[Match | None]:
    """Return an asset for each of P asks, None where the library has nothing of that category: the nearest that suits the taste.

    `sizes` (P, 3) [m], `latents` (P, 32), `positions` (P, 3) [m]. Sets ask for one thing, the mean of theirs. Of the `shortlist`
    nearest assets, those of another style being farther, that is taken which is nearest with its finish counted in.
    """
    asked, shapes = np.array(sizes, float), np.array(latents, float)
    for group in sets(categories, positions):
        asked[group], shapes[group] = asked[group].mean(0), shapes[group].mean(0)
    s, favoured = index.settings, index.favouring(taste.style, wished=taste.wished)
    matches: list[Match | None] = []
    for k, category in enumerate(categories):
        shelf = index.shelves.get(category)
        if shelf is None:
            matches.append(None)
            continue
        far = favoured.distance(shelf, asked[k : k + 1], shapes[k : k + 1])[0]
        best = np.argsort(far, kind="stable")[: s.shortlist]
        finish = taste.finishes.get(cards()[category].finish if category in cards() else "")
        off = np.zeros(len(best))
        if finish is not None:
            off = np.linalg.norm(index.finishes[shelf[best]] - finish, axis=1)
        cost = far[best] + s.prefer_finish * np.minimum(np.nan_to_num(off) / STEP, MOST_STEPS)
        j = int(best[cost.argmin()])
        matches.append(index.fit(int(shelf[j]), float(far[j]), asked[k]))
    return matches
