"""Noise levels, and the solver that goes down them. A level is its log signal-to-noise ratio: lambda = ln(alpha^2 / sigma^2), with alpha^2 + sigma^2 = 1.

The paper's levels t = 1..1000 are those of DDPM's linear beta (1e-4 to 0.02); its guidance windows, t < 100 and t < 10,
are noise levels, and `lambda_of` says which. Samplers choose their own levels between FIRST and LAST, even in lambda.
"""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

Expect = Callable[[Tensor, float], Tensor]  # x (B, N, 40), lambda -> expected x0
Guide = Callable[[Tensor, float], Tensor]  # expected x0, lambda -> x0 as it is wanted
Noise = Callable[[], Tensor]  # -> standard normal (B, N, 40), drawn anew

TIMESTEPS = 1000
FIRST, LAST = -4.7, 9.3  # lambda at which sampling starts, from pure noise, and at which the clean slots are taken as they are expected


def alpha_squared(first: float = 1e-4, last: float = 0.02) -> NDArray[np.float64]:
    """Return alpha^2 (T + 1,) at the paper's levels; index 0 is clean data."""
    return np.concatenate([[1.0], np.cumprod(1 - np.linspace(first, last, TIMESTEPS))])


def lambda_of(t: float) -> float:
    """Return lambda at the paper's level 0 < t <= 1000; alpha^2 is interpolated linearly between the integers."""
    share = float(np.interp(t, np.arange(TIMESTEPS + 1), alpha_squared()))
    return math.log(share) - math.log1p(-share)


def levels(count: int) -> tuple[float, ...]:
    """Return the `count` levels, rising in lambda, at which a few-step sampler evaluates the denoiser."""
    return tuple(np.linspace(FIRST, LAST, count).tolist())


def paper_levels() -> tuple[float, ...]:
    """Return all 1000 levels of the paper, from t = 1000 down to 1: the reference that few-step samplers are held to."""
    share = alpha_squared()[:0:-1]
    return tuple((np.log(share) - np.log1p(-share)).tolist())


def alpha_sigma(level: Tensor) -> tuple[Tensor, Tensor]:
    """Return alpha and sigma of levels."""
    return torch.sigmoid(level).sqrt(), torch.sigmoid(-level).sqrt()


def denoise(expect: Expect, guide: Guide, noise: Noise, at_levels: Sequence[float], eta: float = 1.0) -> Tensor:
    """Go from noise up through rising `at_levels` (lambda); return the clean channels expected at the last of them.

    From level s to level t > s, x_t ~ q(x_t | x_s, x0) of the forward process, with `eta` times its deviation (Song et al.
    2021), where x0 is extrapolated to the middle of the step from this level and the one before: eta = 1 is SDE-DPM-Solver++(2M), 0 is
    DPM-Solver++(2M) (Lu et al. 2022); over the paper's thousand levels both are DDPM's and DDIM's steps but for what no figure sees. Stochastic
    steps forget the errors of earlier ones, so few of them keep what the net has learnt; deterministic ones carry the errors along.
    """
    x, before, step_before = noise(), None, 1.0
    for level, following in pairwise(at_levels):
        x0, step = guide(expect(x, level), level), following - level
        ahead = x0 if before is None else x0 + step / (2 * step_before) * (x0 - before)
        (alpha, sigma), (alpha_next, sigma_next) = alpha_sigma_of(level), alpha_sigma_of(following)
        fresh = eta * sigma_next * math.sqrt(-math.expm1(-step))  # deviation of q, as 1 - SNR_s / SNR_t
        kept = math.sqrt(max(sigma_next**2 - fresh**2, 0.0))
        x = alpha_next * ahead + kept * (x - alpha * ahead) / sigma + fresh * noise()
        before, step_before = x0, step
    return guide(expect(x, at_levels[-1]), at_levels[-1])


def alpha_sigma_of(level: float) -> tuple[float, float]:
    """Return alpha and sigma at one level."""
    share = 1 / (1 + math.exp(-level))
    return math.sqrt(share), math.sqrt(1 - share)
