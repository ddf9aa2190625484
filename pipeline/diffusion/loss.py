"""The training loss: paper eq. 1 on the continuous channels, cross-entropy on the classes."""

from __future__ import annotations

import math
from typing import NamedTuple

import torch
from torch import Tensor

from pipeline.diffusion.batch import Objects, RoomBatch
from pipeline.diffusion.codec import CONTINUOUS, YAW, Codec
from pipeline.diffusion.constraints import articulated_collision
from pipeline.diffusion.denoiser import Denoiser, from_target
from pipeline.diffusion.relations import boxes_of
from pipeline.diffusion.schedule import Schedule
from pipeline.diffusion.settings import TrainSettings

MOST_SHIFT = 0.1  # largest change of a clean channel that the constraint term may ask for


class Levels(NamedTuple):
    """The schedule as tensors (T + 1,) on a device."""

    alpha: Tensor
    sigma: Tensor
    variance: Tensor

    @classmethod
    def of(cls, schedule: Schedule, device: torch.device) -> Levels:
        """Convert."""
        return cls(
            *(torch.tensor(v, dtype=torch.float32, device=device) for v in (schedule.alpha, schedule.sigma, schedule.posterior_variance))
        )


class Draw(NamedTuple):
    """What one step draws: levels t (B,), noise (B, N, D), fill (B, N, 40) for empty slots, told (B,)."""

    t: Tensor
    noise: Tensor
    fill: Tensor
    told: Tensor


class Loss(NamedTuple):
    """Terms per room (B,): eq. 1 on geometry and on shape latents, and the class cross-entropy."""

    geometry: Tensor
    shape: Tensor
    classes: Tensor


def draw(rng: torch.Generator, batch: int, slots: int, channels: int, timesteps: int, low_noise: float, count_known: float) -> Draw:
    """Draw the randomness of one step.

    A share `low_noise` of the levels is log-uniform, the rest uniform: the guidance windows are 10 % and 1 % of the
    levels but half of a few-step sampler's evaluations, and where furniture meets walls is learnt there.
    """
    uniform = torch.rand(batch, generator=rng)
    log = torch.rand(batch, generator=rng) < low_noise
    t = torch.where(log, torch.exp(uniform * math.log(timesteps)), 1 + uniform * (timesteps - 1)).round().long().clamp(1, timesteps)
    noise = torch.randn(batch, slots, channels, generator=rng)
    fill = torch.randn(batch, slots, CONTINUOUS, generator=rng)
    return Draw(t, noise, fill, torch.rand(batch, generator=rng) < count_known)


def constraint_descent(x0: Tensor, codec: Codec, rooms: RoomBatch, occupied: Tensor, sweeps: Tensor) -> Tensor:
    """Return g = -grad phi_articoll (B, N, 40) at clean slots x0; only position x, y and yaw have any."""
    leaf = x0[..., : YAW.stop].detach().requires_grad_()
    with torch.enable_grad():
        phi = articulated_collision(boxes_of(codec.metric(leaf)), occupied, sweeps, rooms).sum()
        (gradient,) = torch.autograd.grad(phi, leaf)
    g = torch.zeros_like(x0[..., :CONTINUOUS])
    g[..., :2], g[..., YAW] = -gradient[..., :2], -gradient[..., YAW]
    return g


def denoising_loss(net: Denoiser, levels: Levels, rooms: RoomBatch, objects: Objects, drawn: Draw, settings: TrainSettings) -> Loss:
    """Return the loss terms of a batch.

    Eq. 1: || (eps - lambda Sigma g) - eps_theta ||^2, with g the DESCENT -grad phi at the model's own x0 (the printed
    +grad would teach it to seek collisions), for t < `constraint_below`, as when sampling. Sigma is the posterior
    variance. Changing eps by delta changes x0 by -sigma / alpha delta at the same x_t, so the term is carried over to
    whatever the network predicts; with v the squared error is that of eps divided by alpha^2.

    Empty slots have no position, size or shape: these channels carry noise as data and no loss, so that the expectation
    for a slot is always "where it would stand if it held something", which is what the quantity guidance turns to.
    """
    codec = net.codec
    alpha, sigma, variance = levels.alpha[drawn.t], levels.sigma[drawn.t], levels.variance[drawn.t]
    a, s = alpha[:, None, None], sigma[:, None, None]
    occupied = objects.classes < codec.classes
    continuous = torch.where(occupied[..., None], objects.continuous, drawn.fill)
    x0 = torch.cat([continuous, codec.one_hot(objects.classes)], -1)
    xt = a * x0 + s * drawn.noise
    told = rooms.told(torch.where(drawn.told, rooms.count, torch.full_like(rooms.count, -1)))
    raw, logits = net(xt, alpha, told)
    noise, seen = drawn.noise[..., :CONTINUOUS], xt[..., :CONTINUOUS]
    near = torch.nonzero(drawn.t < settings.constraint_below)[:, 0]
    if settings.constraint and len(near):
        guess = from_target(net.settings.target, raw.detach()[near], seen[near], a[near], s[near])
        g = constraint_descent(guess, codec, rooms.rows(near), occupied[near], objects.sweeps[near])
        shift = settings.constraint_scale * variance[near, None, None] * g
        most = MOST_SHIFT * (a / s)[near]
        noise = noise.clone()
        noise[near] -= shift.clamp(-most, most)
    clean = (seen - s * noise) / a
    target = {"v": a * noise - s * clean, "x0": clean, "eps": noise}[net.settings.target]
    # With x0 as the target, errors are weighted by the signal-to-noise ratio, clipped at 5 (min-SNR, Hang et al. 2023).
    weight = ((a / s) ** 2).clamp_max(5.0) if net.settings.target == "x0" else torch.ones_like(a)
    error = weight * (target - raw) ** 2 * occupied[..., None]
    held = occupied.sum(1).clamp_min(1)
    entropy = torch.nn.functional.cross_entropy(logits.flatten(0, 1), objects.classes.flatten(), reduction="none").view_as(objects.classes)
    return Loss(error[..., :8].mean(-1).sum(1) / held, error[..., 8:].mean(-1).sum(1) / held, entropy.mean(1))
