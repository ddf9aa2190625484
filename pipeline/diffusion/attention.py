"""Attention that knows the geometry of each pair, and what a layer of the denoiser does with it.

Training runs on one or two cores, where small operations cost more than arithmetic: what all layers ask of the same
input (biases of pairs, keys of the floor, modulations) is asked once for all of them, by the denoiser, and handed in.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import torch
from torch import Tensor, nn

SUBLAYERS = 3  # objects, floor, thought
MODULATIONS = 3 * SUBLAYERS  # shift, scale and gate of each


class Surroundings(NamedTuple):
    """What a layer looks at: `relation` (B, N, M, R) of each pair, `bias` (B, H, N, M) of its scores."""

    relation: Tensor
    bias: Tensor


def split_heads(x: Tensor, parts: int, heads: int) -> tuple[Tensor, ...]:
    """Split (B, N, parts * d) into `parts` tensors (B, H, N, d / H)."""
    tensors: tuple[Tensor, ...] = x.unflatten(-1, (parts, heads, -1)).permute(2, 0, 3, 1, 4).contiguous().unbind(0)
    return tensors


def weights(query: Tensor, key: Tensor, bias: Tensor) -> Tensor:
    """Return attention weights (B, H, N, M) of queries (B, H, N, c) and keys (B, H, M, c)."""
    scores = torch.baddbmm(bias.flatten(0, 1), query.flatten(0, 1), key.flatten(0, 1).transpose(1, 2), alpha=1 / math.sqrt(query.shape[-1]))
    return scores.view_as(bias).softmax(-1)


def attend(weight: Tensor, value: Tensor, relation: Tensor) -> Tensor:
    """Return what was seen (B, N, d + H R): values (B, H, M, c) and relations (B, N, M, R), each under the weights of each head."""
    context = (weight @ value).transpose(1, 2).flatten(2)
    return torch.cat([context, (weight.transpose(1, 2) @ relation).flatten(2)], -1)


def sum_directions(weight: Tensor, directions: Tensor, amount: Tensor, moves: int) -> Tensor:
    """Choose pairs by attention (B, H, N, M) and sum the directions (B, N, M, P, 2) that they offer, each with its `amount` (B, N, H P).

    Returns the sums (B, N, 2, 2) of the first `moves` directions, and of the others.
    """
    heads, offers = weight.shape[1], directions.shape[3]
    offered = (weight.transpose(1, 2) @ directions.flatten(3)).unflatten(-1, (offers, 2))  # (B, N, H, P, 2)
    taken = (offered * amount.unflatten(-1, (heads, offers))[..., None]).sum(2)
    return torch.stack([taken[:, :, :moves].sum(2), taken[:, :, moves:].sum(2)], 2)


class Block(nn.Module):
    """Look at the other objects, at the floor, then think; conditioned by adaptive layer norm."""

    def __init__(self, width: int, heads: int, pair: int, wall: int) -> None:
        super().__init__()
        self.heads = heads
        self.look = nn.Linear(width, 3 * width)
        self.objects = nn.Linear(width + heads * pair, width)
        self.search = nn.Linear(width, width)
        self.floor = nn.Linear(width + heads * wall, width)
        self.think = nn.Sequential(nn.Linear(width, 3 * width), nn.SiLU(), nn.Linear(3 * width, width))

    def forward(
        self, x: Tensor, others: Surroundings, floor: Surroundings, keys: tuple[Tensor, Tensor], modulation: Sequence[Tensor]
    ) -> Tensor:
        """Return the new tokens (B, N, d). `keys` of the floor and their values (B, H, M, c); `modulation`: nine times (B, 1, d)."""
        query, key, value = split_heads(self.look(modulate(x, *modulation[:2])), 3, self.heads)
        context = attend(weights(query, key, others.bias), value, others.relation)
        x = torch.addcmul(x, modulation[2], self.objects(context))
        (query,) = split_heads(self.search(modulate(x, *modulation[3:5])), 1, self.heads)
        context = attend(weights(query, keys[0], floor.bias), keys[1], floor.relation)
        x = torch.addcmul(x, modulation[5], self.floor(context))
        return torch.addcmul(x, modulation[8], self.think(modulate(x, *modulation[6:8])))


def modulate(x: Tensor, shift: Tensor, scale: Tensor) -> Tensor:
    """Layer norm, then the scale and shift that the condition sets."""
    return torch.addcmul(shift, nn.functional.layer_norm(x, x.shape[-1:]), scale)
