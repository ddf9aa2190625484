"""What the networks of the baselines are made of: an encoder of the outline, attention, sines."""

import math

import torch
from torch import Tensor, nn

from pipeline.baselines.rooms import Outlines


class FloorEncoder(nn.Module):
    """PointNet over points and normals of the walls, as MiDiffusion has it, and the room type: (R, d)."""

    def __init__(self, width: int, layouts: int, reach: float) -> None:
        super().__init__()
        self.reach = reach  # [m] that becomes 1
        self.points = nn.Sequential(
            nn.Linear(4, 64), nn.ReLU(), nn.Linear(64, 64), nn.ReLU(), nn.Linear(64, 64), nn.ReLU(), nn.Linear(64, 256), nn.ReLU()
        )
        self.out, self.layout = nn.Linear(256, width), nn.Embedding(layouts, width)

    def forward(self, rooms: Outlines) -> Tensor:
        """Encode R rooms."""
        scaled = torch.cat([rooms.points[..., :2] / self.reach, rooms.points[..., 2:]], -1)
        code: Tensor = self.out(self.points(scaled).amax(1)) + self.layout(rooms.layout)
        return code


class Attention(nn.Module):
    """Self-attention over all tokens."""

    def __init__(self, width: int, heads: int) -> None:
        super().__init__()
        self.heads, self.ask, self.out = heads, nn.Linear(width, 3 * width), nn.Linear(width, width)

    def forward(self, x: Tensor, mask: Tensor | None = None) -> Tensor:
        """Return what tokens (B, N, d) see; `mask` (B, N) says which tokens there are to be seen."""
        query, key, value = self.ask(x).unflatten(-1, (3, self.heads, -1)).permute(2, 0, 3, 1, 4).unbind(0)
        shown = None if mask is None else mask[:, None, None, :]
        context = nn.functional.scaled_dot_product_attention(query, key, value, attn_mask=shown)
        tokens: Tensor = self.out(context.transpose(1, 2).flatten(2))
        return tokens


class Block(nn.Module):
    """A transformer layer, norm first; with a condition, adaptive layer norm whose gates start at zero (Peebles and Xie 2023)."""

    def __init__(self, width: int, heads: int, *, conditioned: bool) -> None:
        super().__init__()
        self.attention = Attention(width, heads)
        self.think = nn.Sequential(nn.Linear(width, 4 * width), nn.GELU(), nn.Linear(4 * width, width))
        self.norms = nn.ModuleList(nn.LayerNorm(width, elementwise_affine=not conditioned) for _ in range(2))
        self.modulation = nn.Linear(width, 6 * width) if conditioned else None
        if self.modulation is not None:
            nn.init.zeros_(self.modulation.weight)
            nn.init.zeros_(self.modulation.bias)

    def forward(self, x: Tensor, condition: Tensor | None = None, mask: Tensor | None = None) -> Tensor:
        """Return the new tokens (B, N, d) under a condition (B, d)."""
        if self.modulation is None or condition is None:
            x = x + self.attention(self.norms[0](x), mask)
            added: Tensor = x + self.think(self.norms[1](x))
            return added
        move, grow, gate, move2, grow2, gate2 = self.modulation(condition)[:, None].chunk(6, -1)
        x = x + gate * self.attention(self.norms[0](x) * (1 + grow) + move, mask)
        changed: Tensor = x + gate2 * self.think(self.norms[1](x) * (1 + grow2) + move2)
        return changed


def sines(value: Tensor, count: int, slowest: float, fastest: float) -> Tensor:
    """Return sines and cosines (..., 2 count) of values (...), at rates from `slowest` to `fastest`, geometrically."""
    rates = torch.exp(torch.linspace(math.log(slowest), math.log(fastest), count, device=value.device))
    angles = value[..., None] * rates
    return torch.cat([angles.sin(), angles.cos()], -1)
