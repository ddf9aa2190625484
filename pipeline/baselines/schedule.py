"""DDPM's levels (Ho et al. 2020): linear beta from 1e-4 to 0.02 over T = 1000, variance of the true posterior."""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor


class Levels(NamedTuple):
    """Level t in 1..T, index 0 is clean data, (T + 1,) each: x_t = alpha x_0 + sigma eps, alpha^2 + sigma^2 = 1.

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
