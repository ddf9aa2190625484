"""Training of the VAE: a loop that yields, so that the caller logs and stops."""

from collections.abc import Iterator
from typing import NamedTuple

import torch
from torch import Tensor

from pipeline.latents.vae import EncodeSettings, PointVae, chamfer, kl_to_standard_normal
from pipeline.tensors import Checkpoint, advance, cosine, generator, initial

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
