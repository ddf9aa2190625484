"""Noise levels. A level is its log signal-to-noise ratio: lambda = ln(alpha^2 / sigma^2), with alpha^2 + sigma^2 = 1.

The paper's levels t = 1..1000 are those of DDPM's linear beta (1e-4 to 0.02); its guidance windows, t < 100 and t < 10,
are noise levels, and `lambda_of` says which. Samplers choose their own levels between FIRST and LAST, even in lambda.
"""

import math

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

TIMESTEPS = 1000
FIRST, LAST = -6.0, 8.0  # lambda at which sampling starts, from pure noise, and at which the clean slots are taken as they are expected


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
