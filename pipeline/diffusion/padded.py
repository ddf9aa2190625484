"""Rooms of a batch in one padded shape: objects (B, N, ...), floor tokens (B, M, ...), attention over what is there. For training, and for a GPU."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor

from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.relations import PAIR_MOVES, WALL_MOVES, Boxes, Relations, axis_deviations, pair_relations, wall_relations
from pipeline.diffusion.surroundings import Surroundings

HIDDEN = -1e9  # score of what is not there


@dataclass(frozen=True, slots=True)
class PaddedRooms:
    """The rooms, which slots are `padding` (B, N), and the heads of attention."""

    rooms: RoomBatch
    padding: Tensor
    heads: int

    def to_objects(self, by_room: Tensor) -> Tensor:
        """Hand what belongs to rooms (B, d) to their objects: (B, 1, d)."""
        return by_room[:, None]

    def split_keys(self, keys: Tensor, parts: int) -> tuple[Tensor, ...]:
        """Split keys of floor tokens (B, M, parts * d) into `parts`."""
        return split_heads(keys, parts, self.heads)

    def pairs(self, boxes: Boxes, blur: Tensor) -> Relations:
        """Relate objects to each other; `blur` (B, 2) is the noise of a position [m] and of an axis."""
        return pair_relations(boxes, blur)

    def walls(self, boxes: Boxes, blur: Tensor) -> Relations:
        """Relate objects to walls and openings."""
        return wall_relations(boxes, self.rooms, blur)

    def axis_deviations(self, boxes: Boxes, blur: Tensor) -> Tensor:
        """Return how far axes are from those of their rooms (B, N, 2), in units of the noise."""
        return axis_deviations(boxes, self.rooms, blur)

    def pair_scores(self, scores: Tensor) -> tuple[Tensor, ...]:
        """Split scores (B, N, N, L H) of pairs into (B, H, N, N) for each layer."""
        return self._by_layer(scores.masked_fill(self.padding[:, None, :, None], HIDDEN))

    def wall_scores(self, scores: Tensor) -> tuple[Tensor, ...]:
        """Split scores (B, N, M, L H) of walls and openings into (B, H, N, M) for each layer."""
        return self._by_layer(scores.masked_fill(~self.rooms.mask[:, None, :, None], HIDDEN))

    def _by_layer(self, scores: Tensor) -> tuple[Tensor, ...]:
        by_layer: tuple[Tensor, ...] = scores.unflatten(-1, (-1, self.heads)).permute(3, 0, 4, 1, 2).contiguous().unbind(0)
        return by_layer

    def look_around(self, looks: Tensor, around: Surroundings, layer: int) -> Tensor:
        """Return what objects see of each other (B, N, d + H R); `looks` (B, N, 3 d) are queries, keys and values."""
        query, key, value = split_heads(looks, 3, self.heads)
        return attend(weights(query, key, around.scores[layer]), value, around.seen)

    def look_at_floor(self, queries: Tensor, key: Tensor, value: Tensor, around: Surroundings, layer: int) -> Tensor:
        """Return what objects see of the floor (B, N, d + H R); keys and values are two of `split_keys`."""
        (query,) = split_heads(queries, 1, self.heads)
        return attend(weights(query, key, around.scores[layer]), value, around.seen)

    def take_offers(self, points: Tensor, key: Tensor, walls: Surroundings, pairs: Surroundings, amounts: Sequence[Tensor]) -> Tensor:
        """Return the sums (B, N, 2, 2) of what walls and objects offer (`BatchLayout.take_offers`)."""
        to_walls, to_objects, own = split_heads(points, 3, self.heads)
        from_walls = sum_directions(weights(to_walls, key, walls.scores[-1]), walls.offers, amounts[0], WALL_MOVES)
        return from_walls + sum_directions(weights(to_objects, own, pairs.scores[-1]), pairs.offers, amounts[1], PAIR_MOVES)


def split_heads(x: Tensor, parts: int, heads: int) -> tuple[Tensor, ...]:
    """Split (B, N, parts * d) into `parts` tensors (B, H, N, d / H)."""
    tensors: tuple[Tensor, ...] = x.unflatten(-1, (parts, heads, -1)).permute(2, 0, 3, 1, 4).contiguous().unbind(0)
    return tensors


def weights(query: Tensor, key: Tensor, score: Tensor) -> Tensor:
    """Return attention weights (B, H, N, M) of queries (B, H, N, c) and keys (B, H, M, c)."""
    products = query.flatten(0, 1), key.flatten(0, 1).transpose(1, 2)
    scores = score.flatten(0, 1).baddbmm(*products, alpha=1 / math.sqrt(query.shape[-1]))
    return scores.view_as(score).softmax(-1)


def attend(weight: Tensor, value: Tensor, seen: Tensor) -> Tensor:
    """Return what was seen (B, N, d + H R): values (B, H, M, c) and features of pairs (B, N, M, R), each under the weights of each head."""
    context = (weight @ value).transpose(1, 2).flatten(2)
    return torch.cat([context, (weight.transpose(1, 2) @ seen).flatten(2)], -1)


def sum_directions(weight: Tensor, offers: Tensor, amount: Tensor, moves: int) -> Tensor:
    """Choose pairs by attention (B, H, N, M) and sum the directions (B, N, M, 2 P) that they offer, each with its `amount` (B, N, H P).

    Returns the sums (B, N, 2, 2) of the first `moves` directions, and of the others.
    """
    heads, count = weight.shape[1], offers.shape[-1] // 2
    offered = (weight.transpose(1, 2) @ offers).unflatten(-1, (count, 2))  # (B, N, H, P, 2)
    taken = (offered * amount.unflatten(-1, (heads, count))[..., None]).sum(2)
    return torch.stack([taken[:, :, :moves].sum(2), taken[:, :, moves:].sum(2)], 2)
