"""The compiled search against the formula in numpy, an ask at a time."""

import numpy as np
import pytest

from pipeline import seeds
from pipeline.retrieval.nearest import MOST_STEPS, STEP, Asks, AssetArrays, DistanceWeights, Shelves, Tastes, nearest_assets

ASSETS, ASKS, GROUPS = 60, 200, 3
WEIGHTS = DistanceWeights(0.3, 2.0, 1.5, 0.15, 0.25)
SHORT = 5


def drawn(seed=0):
    rng = seeds.generator(seed, "nearest")
    finishes = rng.uniform(0, 90, (ASSETS, 3))
    finishes[rng.random(ASSETS) < 0.2] = np.nan
    openable = (np.arange(ASSETS) < 40) & (rng.random(ASSETS) < 0.5)  # nothing on the last shelf opens
    assets = AssetArrays(rng.uniform(0.01, 2.0, (ASSETS, 3)), rng.normal(0, 1, (ASSETS, 32)), openable, finishes)
    shelves = Shelves.of([np.arange(25), np.arange(25, 40), np.arange(40, 58), np.array([58, 59])], [0, 1, 2, 1])
    wished = rng.uniform(0, 90, (2, GROUPS, 3))
    wished[1, 0] = np.nan
    tastes = Tastes(rng.random((2, ASSETS)) < 0.5, np.array([0.3, 1.5]), wished)
    asks = Asks(rng.integers(-1, 4, ASKS), rng.integers(0, 2, ASKS), rng.uniform(0.01, 2.0, (ASKS, 3)), rng.normal(0, 1, (ASKS, 32)))
    return assets, shelves, tastes, asks


def expected(assets, shelves, tastes, asks, p):
    k, taste = asks.shelf[p], asks.taste[p]
    if k < 0:
        return -1, np.inf
    rows = shelves.rows[shelves.start[k] : shelves.start[k + 1]]
    shape = np.sqrt(((asks.latents[p] - assets.latents[rows]) ** 2).mean(-1))
    ratio = np.log(np.maximum(asks.sizes[p], 0.02) / np.maximum(assets.sizes[rows], 0.02))
    far = WEIGHTS.latent * shape + WEIGHTS.size * np.sqrt((ratio**2).mean(-1))
    if assets.openable[rows].any():
        far = np.where(assets.openable[rows], far, (far + WEIGHTS.offset) * WEIGHTS.openable)
    far = far + tastes.cost[taste] * tastes.other[taste, rows]
    best = np.argsort(far, kind="stable")[:SHORT]
    off = np.linalg.norm(assets.finishes[rows[best]] - tastes.finishes[taste, shelves.group[k]], axis=1)
    cost = far[best] + WEIGHTS.finish * np.minimum(np.nan_to_num(off) / STEP, MOST_STEPS)
    chosen = best[cost.argmin()]
    return rows[chosen], far[chosen]


@pytest.mark.parametrize("seed", [0, 1])
def test_it_is_the_formula(seed):
    drawing = drawn(seed)
    found, distances = nearest_assets(*drawing, WEIGHTS, SHORT)
    for p in range(ASKS):
        row, distance = expected(*drawing, p)
        assert found[p] == row
        assert distances[p] == pytest.approx(distance)


def test_of_two_alike_the_first_is_taken():
    assets, shelves, tastes, asks = drawn()
    alike = AssetArrays(*(np.repeat(values[:1], ASSETS, axis=0) for values in assets))
    same = Tastes(np.zeros_like(tastes.other), tastes.cost, tastes.finishes)
    found, _ = nearest_assets(alike, shelves, same, asks, WEIGHTS, SHORT)
    first = shelves.rows[shelves.start[:-1]]
    assert (found == np.where(asks.shelf < 0, -1, first[asks.shelf])).all()
