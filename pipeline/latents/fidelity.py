"""How much of a shape survives, and how well latents tell shapes apart: a model, encoded from a second sample of its surface, must find itself."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray

from pipeline.latents.vae import PointVae, chamfer, kl_to_standard_normal

COMPARED = 64  # shapes that are measured, spread evenly over all


@torch.no_grad()
def fidelity(net: PointVae, first: torch.Tensor, second: torch.Tensor) -> dict[str, float]:
    """Return the mean Chamfer distance between shapes and what the decoder makes of their means, and the mean KL, over shapes spread evenly.

    Beside it stands that between two samples `first`, `second` (M, P, 3) of one shape: what no net can be better than.
    """
    rows = torch.linspace(0, len(first) - 1, min(len(first), COMPARED)).long()
    mean, logvar = net.encoder(first[rows])
    rebuilt, kl = chamfer(first[rows], net.decoder(mean)), kl_to_standard_normal(mean, logvar)
    apart = torch.cat([chamfer(first[part], second[part]) for part in rows.split(8)])
    figures = {"chamfer": rebuilt, "kl": kl, "chamfer_two_samples": apart}
    return {name: round(float(values.mean()), 6) for name, values in figures.items()}


class Ranking(NamedTuple):
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
    between: Callable[[int, int], float],
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
        better = [int(j) for j in rivals[distance <= distance[rivals == i]] if j != i]
        twins = all(between(i, j) < itself(i) for j in better)
        first += twins
        excused += bool(better) and twins
    return Ranking(len(asked), first, excused)
