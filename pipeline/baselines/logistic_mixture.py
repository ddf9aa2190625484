"""Mixtures of discretised logistics, by which the autoregressive transformer says where things stand (Salimans et al. 2017)."""

import torch
from torch import Tensor

BIN = 2 / 255  # width of a bin of [-1, 1]
NARROWEST = -6.0  # least log scale


def log_likelihood(parameters: Tensor, value: Tensor) -> Tensor:
    """Return the log of the chance (...) of the bin about `value` (...) in [-1, 1]; the outermost bins reach to infinity.

    `parameters` (..., 3, K): logits of the components, their means, their log scales.
    """
    weight, mean, scale = _parts(parameters)
    off = value[..., None] - mean
    upper = torch.sigmoid((off + BIN / 2) * torch.exp(-scale))
    lower = torch.sigmoid((off - BIN / 2) * torch.exp(-scale))
    upper = torch.where(value[..., None] > 1 - BIN / 2, torch.ones_like(upper), upper)
    lower = torch.where(value[..., None] < -1 + BIN / 2, torch.zeros_like(lower), lower)
    return torch.logsumexp(weight + (upper - lower).clamp_min(1e-10).log(), -1)


def draw(parameters: Tensor, rng: torch.Generator) -> Tensor:
    """Draw values (...) in [-1, 1] from mixtures (..., 3, K)."""
    weight, mean, scale = _parts(parameters)
    chosen = torch.multinomial(weight.exp().flatten(0, -2), 1, generator=rng).view(*weight.shape[:-1], 1)
    even = torch.rand(weight.shape[:-1], generator=rng).clamp(1e-5, 1 - 1e-5)
    mean, scale = mean.gather(-1, chosen)[..., 0], scale.gather(-1, chosen)[..., 0]
    return (mean + scale.exp() * torch.logit(even)).clamp(-1, 1)


def _parts(parameters: Tensor) -> tuple[Tensor, Tensor, Tensor]:
    weight, mean, scale = parameters.unbind(-2)
    return weight.log_softmax(-1), mean, scale.clamp_min(NARROWEST)
