"""The optimiser: Muon (Jordan et al. 2024) for the layers' matrices, AdamW for everything else.

Muon moves a matrix by its momentum with all singular values made 1, so that every direction of a layer learns at the same
pace; docs/model.md has figures of both. `optimiser: adamw` is AdamW throughout.
"""

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from pipeline.diffusion.settings import TrainSettings

MOMENTUM = 0.95
BETAS = (0.9, 0.98)
AS_LARGE = 0.2  # root mean square of AdamW's usual update, which Muon's is given, so that both share one learning rate
# Quintic polynomials x -> a x + b x^3 + c x^5 that, one after the other, bring singular values in [1e-3, 1] to 1 (Amsel et al. 2025).
QUINTICS = (
    (4.0848, -6.8946, 2.9270),
    (3.9505, -6.3029, 2.6377),
    (3.7418, -5.5913, 2.3037),
    (2.8769, -3.1427, 1.2046),
    (2.8366, -3.0525, 1.2012),
)


class Optimiser(torch.optim.Optimizer):
    """Owns the moments of a net's parameters: AdamW's, and the momenta of the matrices."""

    def __init__(self, net: nn.Module, settings: TrainSettings) -> None:
        named, self.width = dict(net.named_parameters()), settings.model.width
        super().__init__(named.values(), {"lr": 0.0, "fused": True})
        self.matrices = {name: p for name, p in named.items() if settings.optimiser == "muon" and is_hidden(name, p, self.width)}
        others = [p for name, p in named.items() if name not in self.matrices]
        self.adam = torch.optim.AdamW(others, weight_decay=0.0, betas=BETAS, fused=True)

    @torch.no_grad()
    def step(self, closure: None = None) -> None:  # type: ignore[override]  # noqa: ARG002
        """Move the parameters along their gradients, at the learning rate of the group."""
        rate = self.param_groups[0]["lr"]
        self.adam.state, self.adam.param_groups[0]["lr"] = self.state, rate
        self.adam.step()
        alike: dict[torch.Size, list[tuple[Tensor, Tensor]]] = {}
        for p in self.matrices.values():
            if p.grad is None:
                continue
            if not self.state[p]:
                self.state[p]["momentum"] = torch.zeros_like(p)
            momentum = self.state[p]["momentum"]
            momentum.lerp_(p.grad, 1 - MOMENTUM)
            ahead = p.grad.lerp(momentum, MOMENTUM)  # Nesterov's: where the momentum will be
            for part, move in zip(squares(p, self.width), squares(ahead, self.width), strict=True):
                alike.setdefault(part.shape, []).append((part, move))
        for shape, pairs in alike.items():
            moves = orthogonalise(torch.stack([move for _, move in pairs])) * (rate * AS_LARGE * max(shape) ** 0.5)
            for (part, _), move in zip(pairs, moves, strict=True):
                part.sub_(move)


def is_hidden(name: str, parameter: Tensor, width: int) -> bool:
    """Whether a parameter maps hidden channels to hidden channels: what Muon is for. Inputs, heads, biases and modulations are not."""
    layer = bool({"blocks", "floor_keys", "point"}.intersection(name.split(".")))
    return layer and parameter.ndim == 2 and parameter.shape[0] % width == 0


def squares(matrix: Tensor, width: int) -> Sequence[Tensor]:
    """Cut a matrix into those that were written as one: rows in portions of `width`."""
    parts: Sequence[Tensor] = matrix.split(width, 0)  # type: ignore[no-untyped-call]
    return parts


def orthogonalise(matrices: Tensor) -> Tensor:
    """Return the nearest matrices (K, m, n) with singular values near 1, by Newton-Schulz steps; m <= n."""
    x: Tensor = matrices / (1.01 * torch.linalg.matrix_norm(matrices, keepdim=True)).clamp_min(1e-12)
    for a, b, c in QUINTICS:
        square = x @ x.transpose(1, 2)
        x = torch.baddbmm(x, torch.baddbmm(square, square, square, beta=b, alpha=c), x, beta=a)
    return x
