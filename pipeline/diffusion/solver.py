"""The solver: from noise to clean channels along falling noise levels."""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

from torch import Tensor

Expect = Callable[[Tensor, float], Tensor]  # x (B, N, 40), lambda -> expected x0
Shift = Callable[[Tensor, float], Tensor]  # expected x0, lambda -> x0 as it is wanted
Noise = Callable[[], Tensor]  # -> standard normal (B, N, 40), drawn anew


def denoise(expect: Expect, steer: Shift, noise: Noise, at_levels: Sequence[float], eta: float = 1.0) -> Tensor:
    """Go from noise up through rising `at_levels` (lambda); return the clean channels expected at the last of them.

    From level s to level t > s, x_t ~ q(x_t | x_s, x0) of the forward process, with `eta` times its deviation (Song et al.
    2021): eta = 1 is DDPM's ancestral step between levels of any distance, 0 is deterministic. Stochastic steps forget
    the errors of earlier ones, so few of them keep what the net has learnt; deterministic ones carry the errors along.
    """
    x = noise()
    for level, following in pairwise(at_levels):
        x0 = steer(expect(x, level), level)
        (alpha, sigma), (alpha_next, sigma_next) = alpha_sigma_of(level), alpha_sigma_of(following)
        fresh = eta * sigma_next * math.sqrt(-math.expm1(level - following))  # deviation of q, as 1 - SNR_s / SNR_t
        kept = math.sqrt(max(sigma_next**2 - fresh**2, 0.0))
        x = alpha_next * x0 + kept * (x - alpha * x0) / sigma + fresh * noise()
    return steer(expect(x, at_levels[-1]), at_levels[-1])


def alpha_sigma_of(level: float) -> tuple[float, float]:
    """Return alpha and sigma at one level."""
    share = 1 / (1 + math.exp(-level))
    return math.sqrt(share), math.sqrt(1 - share)
