"""The noise schedule of DDPM and what follows from it; linear beta as in the paper (1e-4 to 0.02 over T = 1000)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Schedule:
    """Level t in 1..T, index 0 is clean data: x_t = alpha[t] x_0 + sigma[t] eps with alpha^2 + sigma^2 = 1.

    `beta`, `alpha`, `sigma` are (T + 1,); beta[0] = 0, alpha[0] = 1, sigma[0] = 0.
    """

    beta: NDArray[np.float64]
    alpha: NDArray[np.float64]
    sigma: NDArray[np.float64]

    @property
    def timesteps(self) -> int:
        """T."""
        return len(self.beta) - 1

    @property
    def posterior_variance(self) -> NDArray[np.float64]:
        """Variance (T + 1,) of q(x_{t-1} | x_t, x_0), the paper's Sigma: (1 - abar_{t-1}) / (1 - abar_t) beta_t."""
        variance = np.zeros_like(self.beta)
        variance[1:] = self.sigma[:-1] ** 2 / self.sigma[1:] ** 2 * self.beta[1:]
        return variance


def linear(timesteps: int = 1000, first: float = 1e-4, last: float = 0.02) -> Schedule:
    """Return the linear schedule; for T other than 1000 beta is scaled so that the end is as noisy."""
    beta = np.linspace(first, last, timesteps) * 1000 / timesteps
    beta = np.concatenate([[0.0], np.minimum(beta, 0.999)])
    retained = np.cumprod(1 - beta)
    return Schedule(beta, np.sqrt(retained), np.sqrt(1 - retained))


def at(schedule: Schedule, level: float) -> tuple[float, float]:
    """Return (alpha, sigma) at a level between the integers: abar is interpolated linearly."""
    retained = float(np.interp(level, np.arange(schedule.timesteps + 1), schedule.alpha**2))
    return retained**0.5, (1 - retained) ** 0.5


def levels(timesteps: int, coarse: int, middle: int, fine: int) -> tuple[float, ...]:
    """Return the levels, falling, at which a few-step sampler evaluates the denoiser.

    The paper's guidance windows are noise levels, t < 100 and t < 10 of T = 1000: `fine` evaluations lie in t < 10,
    evenly spaced down to 1, `middle` in 10 <= t < 100, geometrically, and `coarse` evenly from T to 100. Levels need
    not be integers (only nine lie below 10). For another T the limits move in proportion.
    """
    upper, lower = timesteps / 10, max(timesteps / 100, 2.0)
    parts = (
        np.linspace(timesteps, upper, coarse),
        np.geomspace(0.95 * upper, lower, middle),
        np.linspace(0.95 * lower, 1.0, fine),
    )
    return tuple(float(t) for t in np.concatenate(parts))
