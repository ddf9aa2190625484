"""The asset of a category that suits an ask best, over all asks of a batch at once."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Bools, Floats, Ints
from pipeline.geometry.compiled import compiled

SMALLEST = 0.02  # of an asked or own side, where sizes are compared [m]
STEP, MOST_STEPS = 30.0, 2.0  # how far off a finish has to be to count once [CIELAB]; it counts so many times at most


class AssetArrays(NamedTuple):
    """A assets: `sizes` (A, 3) [m], standardised `latents` (A, 32), `openable` (A,), `finishes` (A, 3) CIELAB, NaN where unknown."""

    sizes: Floats
    latents: Floats
    openable: Bools
    finishes: Floats


class Shelves(NamedTuple):
    """The assets that asks choose from: those of shelf k are `rows[start[k]:start[k + 1]]`; `group` (K,) is the column of their wished finish."""

    start: Ints
    rows: Ints
    group: Ints

    @classmethod
    def of(cls, shelves: Sequence[NDArray[np.int64]], group: Sequence[int]) -> "Shelves":
        """Join shelves, each the rows of its assets."""
        rows = np.concatenate([*shelves, np.zeros(0, np.int64)])
        return cls(np.cumsum([0, *map(len, shelves)]), rows, np.array(group, np.int64))


class Tastes(NamedTuple):
    """T tastes: `other` (T, A) tells which assets are of another style, `cost` (T,) how much farther those are; `finishes` (T, G, 3) are wished, by group."""

    other: Bools
    cost: Floats
    finishes: Floats


class Asks(NamedTuple):
    """P asks: `shelf` (P,), -1 where there is none; `taste` (P,); `sizes` (P, 3) [m], standardised `latents` (P, 32)."""

    shelf: Ints
    taste: Ints
    sizes: Floats
    latents: Floats


class DistanceWeights(NamedTuple):
    """What a distance is made of, as in `RetrievalSettings`."""

    latent: float
    size: float
    openable: float
    offset: float
    finish: float


def nearest_assets(
    assets: AssetArrays, shelves: Shelves, tastes: Tastes, asks: Asks, weights: DistanceWeights, shortlist: int
) -> tuple[Ints, Floats]:
    """Return the row (P,) of the asset that suits each ask best, -1 where there is none, and its distance (P,) without its finish.

    The distance is `weights.latent` times the root mean square of the standardised latent difference plus `weights.size` times that of the
    log ratio of the sizes; on a shelf with assets that open, that of the others is `(distance + offset) * openable`. Another style adds the
    taste's cost. Of the `shortlist` nearest that is taken which is nearest with `weights.finish` added for each STEP between its
    finish and the wished one. Ties go to the smaller row.
    """
    asked, own = (np.ascontiguousarray(np.log(np.maximum(of.sizes, SMALLEST))) for of in (asks, assets))
    wanted = asks._replace(sizes=asked, latents=np.ascontiguousarray(asks.latents))
    rows, distances = _nearest(assets._replace(sizes=own), shelves, tastes, wanted, weights, shortlist)
    return rows, distances


@compiled
def _nearest(
    assets: AssetArrays, shelves: Shelves, tastes: Tastes, asks: Asks, weights: DistanceWeights, shortlist: int
) -> tuple[Ints, Floats]:
    """See `nearest_assets`; sizes are logarithms."""
    rows, distances = np.full(len(asks.shelf), -1, np.int64), np.full(len(asks.shelf), np.inf)
    near, nearest = np.empty(shortlist), np.empty(shortlist, np.int64)
    for p in range(len(rows)):
        k, taste = asks.shelf[p], asks.taste[p]
        if k < 0:
            continue
        shelf = shelves.rows[shelves.start[k] : shelves.start[k + 1]]
        any_opens, count = False, 0
        for row in shelf:
            any_opens |= assets.openable[row]
        for row in shelf:
            shape = ((asks.latents[p] - assets.latents[row]) ** 2).mean()
            ratio = ((asks.sizes[p] - assets.sizes[row]) ** 2).mean()
            far = weights.latent * np.sqrt(shape) + weights.size * np.sqrt(ratio)
            if any_opens and not assets.openable[row]:
                far = (far + weights.offset) * weights.openable
            if tastes.other[taste, row]:
                far += tastes.cost[taste]
            place = count
            while place > 0 and near[place - 1] > far:
                place -= 1
            if place < shortlist:
                count = min(count + 1, shortlist)
                for j in range(count - 1, place, -1):
                    near[j], nearest[j] = near[j - 1], nearest[j - 1]
                near[place], nearest[place] = far, row
        best = np.inf
        for j in range(count):
            off = np.sqrt(((assets.finishes[nearest[j]] - tastes.finishes[taste, shelves.group[k]]) ** 2).sum())
            cost = near[j] + weights.finish * (0.0 if np.isnan(off) else min(off / STEP, MOST_STEPS))
            if cost < best:
                best, rows[p], distances[p] = cost, nearest[j], near[j]
    return rows, distances
