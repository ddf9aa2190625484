"""How well latents tell shapes apart: a model, encoded from a second sample of its surface, must find itself."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Distance = Callable[[int, int], float]


@dataclass(frozen=True, slots=True)
class Ranking:
    """`first` of `asked` models ranked themselves first; `excused` of these only because what beat them is a twin."""

    asked: int
    first: int
    excused: int

    @property
    def rate(self) -> float:
        """Share of models that rank themselves first."""
        return self.first / self.asked if self.asked else 1.0


def self_ranking(
    stored: NDArray[np.float32],
    queries: NDArray[np.float32],
    categories: Sequence[str],
    asked: Sequence[int],
    between: Distance,
    itself: Callable[[int], float],
) -> Ranking:
    """Rank, for each model of `asked`, all models of its category by the distance of their stored latent to its query.

    `stored` (M, 32) and `queries` (M, 32) come from two independent samples of the surfaces of M distinct shapes.
    `between(i, j)` is the Chamfer distance of shapes i and j, `itself(i)` that of the two samples of shape i: a shape
    that beats i counts against it unless it is a twin, between(i, j) < itself(i), which nobody could tell from i.
    """
    names = np.array(categories)
    first = excused = 0
    for i in asked:
        rivals = np.flatnonzero(names == names[i])
        distance = np.linalg.norm(stored[rivals].astype(float) - queries[i].astype(float), axis=1)
        own = distance[rivals == i][0]
        better = [int(j) for j, d in zip(rivals, distance, strict=True) if j != i and d <= own]
        twins = all(between(i, j) < itself(i) for j in better)
        first += twins
        excused += bool(better) and twins
    return Ranking(len(asked), first, excused)
