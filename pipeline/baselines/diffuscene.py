"""DiffuScene-type diffusion: a plain transformer on world coordinates, DDPM over slots that may be empty (Tang et al. 2024).

As with the peers: T = 1000, linear beta, variance of the true posterior, equal weights for the boxes, classes and latents,
a penalty on overlaps of the expected boxes. In place of their convolutional net with one embedding per slot stands a
transformer in which slots are alike; one net serves all room types, told the type.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import torch
from torch import Tensor, nn

from pipeline.baselines.rooms import BOX, BaselineSettings, Furniture, Outlines, Scaling
from pipeline.baselines.transformer import Block, FloorEncoder, sines

Guide = Callable[[Tensor, int, float], Tensor]  # mean (B, N, D), level t, variance of the step -> what is added to the mean


class Levels(NamedTuple):
    """DDPM's levels (Ho et al. 2020): linear beta from 1e-4 to 0.02 over T = 1000.

    Level t in 1..T, index 0 is clean data, (T + 1,) each: x_t = alpha x_0 + sigma eps, alpha^2 + sigma^2 = 1.
    `variance` is that of q(x_{t-1} | x_t, x_0), the paper's Sigma: (1 - abar_{t-1}) / (1 - abar_t) beta_t.
    """

    alpha: Tensor
    sigma: Tensor
    variance: Tensor

    def of(self, t: Tensor) -> tuple[Tensor, Tensor]:
        """Return alpha and sigma (B, 1, 1) at levels t (B,)."""
        return self.alpha[t][:, None, None], self.sigma[t][:, None, None]

    @classmethod
    def linear(cls, timesteps: int) -> Levels:
        """Return T levels; for T other than 1000 beta is scaled so that the end is as noisy."""
        beta = torch.linspace(1e-4, 0.02, timesteps, dtype=torch.float64) * 1000 / timesteps
        beta = torch.cat([torch.zeros(1, dtype=torch.float64), beta.clamp_max(0.999)])
        kept = torch.cumprod(1 - beta, 0)
        variance = torch.zeros_like(beta)
        variance[1:] = (1 - kept[:-1]) / (1 - kept[1:]) * beta[1:]
        return cls(*(v.float() for v in (kept.sqrt(), (1 - kept).sqrt(), variance)))


class Denoiser(nn.Module):
    """Predicts v of slots (B, N, D) at levels t (B,)."""

    def __init__(self, scaling: Scaling, layouts: int, settings: BaselineSettings) -> None:
        super().__init__()
        width = settings.width
        self.scaling, self.settings, self.levels = scaling, settings, Levels.linear(settings.timesteps)
        self.floor = FloorEncoder(width, layouts, scaling.high[0])
        self.level = nn.Sequential(nn.Linear(64, width), nn.SiLU(), nn.Linear(width, width))
        self.enter = nn.Sequential(nn.Linear(scaling.channels, width), nn.GELU(), nn.Linear(width, width))
        self.blocks = nn.ModuleList(Block(width, settings.heads, conditioned=True) for _ in range(settings.layers))
        self.leave = nn.Sequential(nn.LayerNorm(width), nn.Linear(width, width), nn.GELU(), nn.Linear(width, scaling.channels))

    def forward(self, x: Tensor, t: Tensor, floor: Tensor) -> Tensor:
        """Return the prediction; `floor` (B, d) is the encoder's."""
        condition = nn.functional.silu(floor + self.level(sines(t.float(), 32, 1e-3, 1.0)))
        tokens = self.enter(x)
        for block in self.blocks:
            tokens = block(tokens, condition)
        prediction: Tensor = self.leave(tokens)
        return prediction


def clean(raw: Tensor, x: Tensor, alpha: Tensor | float, sigma: Tensor | float) -> Tensor:
    """Return x0 from what the net predicts, v = alpha eps - sigma x0."""
    return alpha * x - sigma * raw


def loss(net: Denoiser, rooms: Outlines, things: Furniture, rng: torch.Generator) -> Tensor:
    """Return DiffuScene's loss of a batch: denoising, and overlaps of what is expected."""
    x0, t, noise, x = add_noise(net, things, rng)
    raw = net(x, t, net.floor(rooms))
    total = denoising(net, raw, x0, noise, t)
    if not net.settings.iou_weight:
        return total
    alpha, sigma = net.levels.of(t)
    return total + net.settings.iou_weight * (alpha[:, 0, 0] ** 2 * upright_overlap(net.scaling, clean(raw, x, alpha, sigma))).mean()


def add_noise(net: Denoiser, things: Furniture, rng: torch.Generator) -> tuple[Tensor, Tensor, Tensor, Tensor]:
    """Draw levels t (B,), uniform in 1..T, and noise; return x0, t, eps, x_t."""
    x0 = net.scaling.encode(things)
    t = torch.randint(1, net.settings.timesteps + 1, (len(x0),), generator=rng)
    noise = torch.randn(x0.shape, generator=rng)
    alpha, sigma = net.levels.of(t)
    return x0, t, noise, alpha * x0 + sigma * noise


def denoising(net: Denoiser, raw: Tensor, x0: Tensor, noise: Tensor, t: Tensor) -> Tensor:
    """Return the mean squared error of the prediction: boxes, classes and latents weigh the same, whatever their numbers of channels.

    An error of v weighs alpha^2, as DiffuScene has it: it is then the error of eps.
    """
    alpha, sigma = net.levels.of(t)
    error = alpha * (raw - alpha * noise + sigma * x0)
    boxes, classes, latents = (error**2).split([BOX, net.scaling.empty + 1 - BOX, net.scaling.channels - net.scaling.empty - 1], -1)
    total: Tensor = boxes.mean() + classes.mean() + latents.mean()
    return total


def upright_overlap(scaling: Scaling, x0: Tensor) -> Tensor:
    """Return the mean IoU (B,) of the unturned boxes over pairs of slots that are expected to hold something, as DiffuScene takes it."""
    there = scaling.occupied(x0)
    metric = scaling.metric(x0)
    low, high = metric[..., :3] - metric[..., 3:6].clamp_min(0) / 2, metric[..., :3] + metric[..., 3:6].clamp_min(0) / 2
    side = (torch.minimum(high[:, :, None], high[:, None]) - torch.maximum(low[:, :, None], low[:, None])).clamp_min(0)
    shared, volume = side.prod(-1), (high - low).prod(-1)
    iou = shared / (volume[:, :, None] + volume[:, None] - shared).clamp_min(1e-6)
    pairs = there[:, :, None] & there[:, None]
    return (iou * pairs).sum((1, 2)) / pairs.sum((1, 2)).clamp_min(1)


def levels_of(levels: Levels, steps: int) -> list[int]:
    """Return the levels at which a sampler stops, falling to 1: all T, or about `steps`, even in log signal-to-noise."""
    last = len(levels.alpha) - 1
    if steps >= last:
        return list(range(last, 0, -1))
    ratio = (levels.alpha[1:].double() / levels.sigma[1:].double()).log()
    even = torch.linspace(float(ratio[-1]), float(ratio[0]), steps, dtype=torch.float64)
    return sorted(set((1 + (ratio[None] - even[:, None]).abs().argmin(1)).tolist()), reverse=True)


@torch.no_grad()
def sample(net: Denoiser, rooms: Outlines, rng: torch.Generator, guide: Guide | None = None) -> Tensor:
    """Return x0 (B, N, D) after DDPM's steps from level to level: x_s ~ N(mean + what the guide adds, variance), as q(x_s | x_t, x0) has them."""
    levels, floor, s = net.levels, net.floor(rooms), net.settings
    stops = levels_of(levels, s.steps)
    x = torch.randn((len(rooms), s.slots, net.scaling.channels), generator=rng)
    for t, following in zip(stops, [*stops[1:], 0], strict=True):
        alpha, sigma, after, left = (float(v) for v in (levels.alpha[t], levels.sigma[t], levels.alpha[following], levels.sigma[following]))
        x0 = clean(net(x, torch.full((len(rooms),), t), floor), x, alpha, sigma).clamp(-1, 1)
        kept = (alpha / after) ** 2  # product of 1 - beta between the two
        mean = after * (1 - kept) / sigma**2 * x0 + kept**0.5 * left**2 / sigma**2 * x
        variance = left**2 / sigma**2 * (1 - kept)
        if guide is not None:
            mean = mean + guide(mean, t, variance)
        x = mean + variance**0.5 * torch.randn(x.shape, generator=rng)
    return x
