"""Training of the VAE, a loop that yields, so that the caller logs and stops; how much of a shape survives, and how well latents tell shapes apart.

A model, encoded from a second sample of its surface, must find itself.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from pipeline.latents.vae import EncodeSettings, PointVae, chamfer, kl_to_standard_normal
from pipeline.tensors import Checkpoint, advance, cosine, generator, initial

COMPARED = 64  # shapes that are measured, spread evenly over all
EVERY = 50  # steps between checkpoints: some five seconds of work


class Step(NamedTuple):
    """What one step of training reports."""

    step: int
    chamfer: float
    kl: float


def init_vae(seed: int, settings: EncodeSettings) -> PointVae:
    """Build the untrained net from the seed alone."""
    return initial(lambda: PointVae.of(settings), seed, "vae-init")


def train(
    seed: int, net: PointVae, clouds: Tensor, settings: EncodeSettings, device: torch.device, checkpoint: Checkpoint | None = None
) -> Iterator[Step]:
    """Train `net` in place on clouds (M, P, 3): Chamfer + 0.001 KL; the learning rate falls as a cosine to zero.

    Every step draws from a generator of its own, keyed by (seed, step). With a `checkpoint` it goes on from there, and yields no step that was taken before.
    """
    net.to(device).train()
    clouds = clouds.to(device)
    optimiser = torch.optim.Adam(net.parameters(), lr=settings.learning_rate)
    done = checkpoint.resume(net, optimiser) if checkpoint else 0
    for step in range(done, settings.steps):
        rng = generator(seed, "vae-step", step)
        rows = torch.randint(len(clouds), (settings.batch,), generator=rng).to(device)
        subset = torch.randperm(clouds.shape[1], generator=rng)[: settings.train_points].to(device)
        batch = clouds[rows][:, subset]
        mean, logvar = net.encoder(batch)
        noise = torch.randn(mean.shape, generator=rng).to(device)
        reconstruction = net.decoder(mean + (0.5 * logvar).exp() * noise)
        distance, kl = chamfer(batch, reconstruction).mean(), kl_to_standard_normal(mean, logvar).mean()
        (distance + settings.kl_weight * kl).backward()
        advance(optimiser, settings.learning_rate * min(1.0, (step + 1) / 20) * cosine(step / settings.steps), 1.0)
        if checkpoint and (step + 1) % EVERY == 0:
            checkpoint.keep(step + 1, net, optimiser)
        yield Step(step, float(distance.detach()), float(kl.detach()))
    net.eval()


@torch.no_grad()
def encode(net: PointVae, clouds: Tensor, device: torch.device, batch: int = 16) -> Tensor:
    """Return the posterior means (M, 32) of clouds (M, P, 3)."""
    net.to(device).eval()
    return torch.cat([net.encoder(part.to(device))[0].cpu() for part in clouds.split(batch)] or [torch.zeros(0, 32)])


@torch.no_grad()
def fidelity(net: PointVae, first: Tensor, second: Tensor) -> dict[str, float]:
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
