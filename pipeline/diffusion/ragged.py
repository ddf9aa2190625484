"""Rooms of any number of objects and walls in one list: objects (T, ...), their pairs (P, ...), attention and geometry compiled. For a CPU, without gradients.

In a padded batch most of an evaluation is what is not there, and a thousand calls of small operations. Here loops over rooms do what
`relations` and `padded` do, and the layers multiply the whole list. A room's answer has the same bits whichever others stand beside it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from pipeline.arrays import Bools, Ints
from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.context import KINDS
from pipeline.diffusion.relations import (
    FAR,
    PAIR_FEATURES,
    PAIR_MOVES,
    PAIR_NOISE,
    PAIR_TURNS,
    WALL_FEATURES,
    WALL_MOVES,
    WALL_NOISE,
    WALL_TURNS,
    Boxes,
    Relations,
    shortened,
)
from pipeline.diffusion.surroundings import Surroundings
from pipeline.geometry.compiled import reordering

Singles = NDArray[np.float32]
X, Y, BOTTOM, HALF_W, HALF_D, HEIGHT, COS, SIN = range(8)  # columns of a box [m]
NIL = np.float32(0)


@dataclass(frozen=True, slots=True)
class RaggedRooms:
    """B rooms, their T objects in one list, their M walls and openings in another: those of room b from `first[b]` and `bound[b]` on, (B + 1,).

    `room` (T,) of each object. `pairs_from` and `sides_from` (B + 1,): where the pairs of a room's objects begin, and of its objects with its walls and openings.
    Of these `ends` (M, 2, 2) [m], `normal` (M, 2), which are a `wall` (M,); `there` (B, tokens) tells them from padding. `kind` (Q, KINDS): what the
    second of each such pair is, as 0 and 1.
    """

    first: Ints
    bound: Ints
    pairs_from: Ints
    sides_from: Ints
    ends: Singles
    normal: Tensor
    kind: Tensor
    wall: Bools
    room: Tensor
    there: Tensor
    heads: int

    @classmethod
    def of(cls, rooms: RoomBatch, objects: Tensor, heads: int) -> RaggedRooms:
        """Return the rooms, of so many `objects` (B,) each."""
        counts, sides = objects.numpy(), rooms.mask.sum(1).numpy()
        first, bound, pairs, sides_from = (np.concatenate([[0], np.cumsum(n)]) for n in (counts, sides, counts**2, counts * sides))
        kind = nn.functional.one_hot(rooms.kind, len(KINDS)).float()
        ends, normal, kind, wall = (v[rooms.mask] for v in (rooms.ends, rooms.normal, kind, rooms.walls))
        second = np.concatenate([np.tile(np.arange(a, b), n) for a, b, n in zip(bound, bound[1:], counts, strict=False)])
        room = torch.from_numpy(np.repeat(np.arange(len(counts)), counts))
        return cls(
            first, bound, pairs, sides_from, ends.numpy(), normal, kind[torch.from_numpy(second)], wall.numpy(), room, rooms.mask, heads
        )

    def to_objects(self, by_room: Tensor) -> Tensor:
        """Hand what belongs to rooms (B, d) to their objects (T, d)."""
        return by_room[self.room]

    def split_keys(self, keys: Tensor, parts: int) -> tuple[Tensor, ...]:
        """Split keys of floor tokens (B, tokens, parts * d) into `parts` (M, d)."""
        return tuple(part.contiguous() for part in keys[self.there].chunk(parts, -1))

    def pairs(self, boxes: Boxes, blur: Tensor) -> Relations:
        """Relate objects to each other (`relations.pair_relations`)."""
        features = np.empty((self.pairs_from[-1], PAIR_FEATURES + PAIR_NOISE), np.float32)
        offers = np.empty((len(features), 2 * (PAIR_MOVES + PAIR_TURNS)), np.float32)
        _relate_objects(_columns(boxes), self.first, (float(blur[0, 0]), float(blur[0, 1])), features, offers)
        far, near = torch.from_numpy(features).split([PAIR_FEATURES, PAIR_NOISE], -1)
        far[:, 4:16].tanh_()
        far[:, 19].tanh_()
        return Relations(far, near, torch.from_numpy(offers))

    def walls(self, boxes: Boxes, blur: Tensor) -> Relations:
        """Relate objects to walls and openings (`relations.wall_relations`)."""
        features = np.empty((self.sides_from[-1], WALL_FEATURES + WALL_NOISE), np.float32)
        offers = np.empty((len(features), 2 * (WALL_MOVES + WALL_TURNS)), np.float32)
        _relate_walls(
            _columns(boxes),
            self.first,
            self.bound,
            self.ends,
            self.normal.numpy(),
            (float(blur[0, 0]), float(blur[0, 1])),
            features,
            offers,
        )
        far, near = torch.from_numpy(features).split([WALL_FEATURES, WALL_NOISE], -1)
        far[:, 1:4].tanh_()
        far[:, 6:10].tanh_()
        return Relations(far, near, torch.from_numpy(offers), self.kind)

    def axis_deviations(self, boxes: Boxes, blur: Tensor) -> Tensor:
        """Return how far axes are from those of their rooms (T, 2), in units of the noise."""
        nearest = np.empty(len(self.room), np.int64)
        _find_nearest_walls(_columns(boxes), self.normal.numpy(), self.wall, self.first, self.bound, nearest)
        return shortened((boxes.axis - self.normal[torch.from_numpy(nearest)]) / blur[0, 1])

    def pair_scores(self, scores: Tensor) -> tuple[Tensor, ...]:
        """Split scores (P, L H) of pairs into (P, H) for each layer."""
        return tuple(layer.contiguous() for layer in scores.split(self.heads, -1))

    wall_scores = pair_scores

    def look_around(self, looks: Tensor, around: Surroundings, layer: int) -> Tensor:
        """Return what objects see of each other (T, d + H R); `looks` (T, 3 d) are queries, keys and values."""
        query, key, value = (part.contiguous() for part in looks.chunk(3, -1))
        return self._attend(query, key, value, around, layer, self.first, self.pairs_from)

    def look_at_floor(self, queries: Tensor, key: Tensor, value: Tensor, around: Surroundings, layer: int) -> Tensor:
        """Return what objects see of the floor (T, d + H R); keys and values are two of `split_keys`."""
        return self._attend(queries, key, value, around, layer, self.bound, self.sides_from)

    def _attend(self, query: Tensor, key: Tensor, value: Tensor, around: Surroundings, layer: int, keys: Ints, pairs: Ints) -> Tensor:
        """Return values, and features of pairs, each under the weights of each head; keys and values of room b from `keys[b]` on."""
        seen, out = around.seen.numpy(), np.zeros((len(query), query.shape[1] + self.heads * around.seen.shape[1]), np.float32)
        own = (query.numpy(), key.numpy(), value.numpy(), seen, around.scores[layer].numpy())
        _look_around(*own, self.first, keys, pairs, np.empty(_longest(keys), np.float32), out)
        return torch.from_numpy(out)

    def take_offers(self, points: Tensor, key: Tensor, walls: Surroundings, pairs: Surroundings, amounts: Sequence[Tensor]) -> Tensor:
        """Return the sums (T, 2, 2) of what walls and objects offer (`padded.PaddedRooms.take_offers`)."""
        to_walls, to_objects, own = (part.contiguous().numpy() for part in points.chunk(3, -1))
        goes = np.zeros((len(points), 4), np.float32)
        for query, keys, around, amount, count, start, begin in (
            (to_walls, key.numpy(), walls, amounts[0], WALL_MOVES, self.bound, self.sides_from),
            (to_objects, own, pairs, amounts[1], PAIR_MOVES, self.first, self.pairs_from),
        ):
            offered = np.empty((1, around.offers.shape[1]), np.float32)
            weights, by = np.empty(_longest(start), np.float32), amount.contiguous().numpy()
            scores = around.scores[-1].numpy()
            _take_offers(query, keys, scores, around.offers.numpy(), count, self.first, start, begin, by, weights, offered, goes)
        sums: Tensor = torch.from_numpy(goes).unflatten(-1, (2, 2))
        return sums


def _columns(boxes: Boxes) -> Singles:
    columns: Singles = torch.cat([boxes.centre, boxes.bottom[:, None], boxes.half, boxes.height[:, None], boxes.axis], -1).numpy()
    return columns


def _longest(keys: Ints) -> int:
    return int(np.diff(keys).max())


@reordering
def _in_noise(length: float, blur: float) -> float:
    return min(max(length / blur, -FAR), FAR)


@reordering
def _offer(offers: Singles, p: int, k: int, x: float, y: float) -> None:
    offers[p, 2 * k], offers[p, 2 * k + 1] = x, y


@reordering
def _relate_objects(boxes: Singles, first: Ints, blur: tuple[float, float], features: Singles, offers: Singles) -> None:
    """Fill in the features of each object of a room with each, none yet squashed, and the directions that they offer."""
    p, near = 0, PAIR_FEATURES
    for b in range(len(first) - 1):
        for i in range(first[b], first[b + 1]):
            for j in range(first[b], first[b + 1]):
                ax, ay = boxes[j, X] - boxes[i, X], boxes[j, Y] - boxes[i, Y]
                same = boxes[i, COS] * boxes[j, COS] + boxes[i, SIN] * boxes[j, SIN]
                turned = boxes[i, COS] * boxes[j, SIN] - boxes[i, SIN] * boxes[j, COS]
                for k in range(4):  # axis and front of i, axis and front of j
                    mine, other = (i, j) if k < 2 else (j, i)
                    cos, sin, half = boxes[mine, COS], boxes[mine, SIN], boxes[mine, HALF_W]
                    wide, deep = boxes[other, HALF_W], boxes[other, HALF_D]
                    if k % 2:
                        cos, sin, half, wide, deep = sin, -cos, boxes[mine, HALF_D], deep, wide
                    place = ax * cos + ay * sin
                    gap = abs(place) - half - wide * abs(same) - deep * abs(turned)
                    features[p, k], features[p, 4 + k] = place / 2, place / 0.3
                    features[p, 8 + k], features[p, 12 + k] = gap / 0.08, gap / 0.4
                    apart, along = _in_noise(gap, blur[0]), _in_noise(place, blur[0])
                    features[p, near + k], features[p, near + 4 + k] = apart / FAR, along / FAR
                    close = apart * min(max(place / 0.05, -1.0), 1.0)
                    _offer(offers, p, k, close * cos, close * sin)
                    _offer(offers, p, 4 + k, along * cos, along * sin)
                    if k > 1:
                        angle = same if k == 2 else turned
                        blurred = _in_noise(angle, blur[1])
                        features[p, 14 + k], features[p, near + 6 + k] = angle, blurred / FAR
                        _offer(offers, p, 6 + k, cos, sin)
                        _offer(offers, p, 9 + k, blurred * cos, blurred * sin)
                        _offer(offers, p, 11 + k, cos, sin)
                rise = boxes[j, BOTTOM] - boxes[i, BOTTOM]
                features[p, 18], features[p, 19] = rise / 2, max(rise - boxes[i, HEIGHT], -rise - boxes[j, HEIGHT]) / 0.2
                features[p, 20], features[p, 21] = math.sqrt((ax + 1e-6) ** 2 + (ay + 1e-6) ** 2) / 3, boxes[j, HEIGHT] / 2
                _offer(offers, p, 10, ax / 3, ay / 3)
                p += 1


@reordering
def _relate_walls(
    boxes: Singles, first: Ints, bound: Ints, ends: Singles, normal: Singles, blur: tuple[float, float], features: Singles,
    offers: Singles,
) -> None:  # fmt: skip
    """Fill in the features of each object with each wall and opening of its room, none yet squashed, and the directions that they offer."""
    p, near = 0, WALL_FEATURES
    for b in range(len(first) - 1):
        for n in range(first[b], first[b + 1]):
            x, y, half_w, half_d, cos, sin = boxes[n, X], boxes[n, Y], boxes[n, HALF_W], boxes[n, HALF_D], boxes[n, COS], boxes[n, SIN]
            for m in range(bound[b], bound[b + 1]):
                nx, ny, ax, ay = normal[m, 0], normal[m, 1], x - ends[m, 0, 0], y - ends[m, 0, 1]
                distance, before = ax * nx + ay * ny, ax * ny - ay * nx
                after = (ends[m, 1, 0] - x) * ny - (ends[m, 1, 1] - y) * nx
                side, facing = cos * nx + sin * ny, sin * nx - cos * ny
                gap = distance - half_w * abs(side) - half_d * abs(facing)
                wide = half_w * abs(facing) + half_d * abs(side)
                features[p, 0], features[p, 1], features[p, 2], features[p, 3] = distance / 3, distance, gap / 0.08, gap / 0.4
                features[p, 4], features[p, 5] = before / 3, after / 3
                features[p, 6], features[p, 7] = (before - wide) / 0.15, (after - wide) / 0.15
                features[p, 8], features[p, 9], features[p, 10], features[p, 11] = before, after, facing, side
                features[p, 12], features[p, 13] = boxes[n, BOTTOM] / 2, boxes[n, HEIGHT] / 2
                close, left = _in_noise(gap, blur[0]), _in_noise(before - wide, blur[0])
                right, across, ahead = _in_noise(after - wide, blur[0]), _in_noise(side, blur[1]), _in_noise(facing, blur[1])
                features[p, near], features[p, near + 1], features[p, near + 2] = close / FAR, left / FAR, right / FAR
                features[p, near + 3], features[p, near + 4] = across / FAR, ahead / FAR
                _offer(offers, p, 0, close * nx, close * ny)
                _offer(offers, p, 1, left * ny, -left * nx)
                _offer(offers, p, 2, right * ny, -right * nx)
                _offer(offers, p, 5, ((ends[m, 0, 0] + ends[m, 1, 0]) / 2 - x) / 3, ((ends[m, 0, 1] + ends[m, 1, 1]) / 2 - y) / 3)
                _offer(offers, p, 6, across * nx, across * ny)
                _offer(offers, p, 7, ahead * ny, -ahead * nx)
                for k in (3, 8):
                    _offer(offers, p, k, nx, ny)
                    _offer(offers, p, k + 1, ny, -nx)
                p += 1


@reordering
def _find_nearest_walls(boxes: Singles, normal: Singles, wall: Bools, first: Ints, bound: Ints, nearest: Ints) -> None:
    """Fill in the wall (T,) whose normal is nearest to each object's axis."""
    for b in range(len(first) - 1):
        for n in range(first[b], first[b + 1]):
            most = -9.0
            nearest[n] = bound[b]
            for m in range(bound[b], bound[b + 1]):
                fit = boxes[n, COS] * normal[m, 0] + boxes[n, SIN] * normal[m, 1]
                if wall[m] and fit > most:
                    nearest[n], most = m, fit


@reordering
def _look_around(
    query: Singles,
    key: Singles,
    value: Singles,
    seen: Singles,
    score: Singles,
    first: Ints,
    keys: Ints,
    begin: Ints,
    weights: Singles,
    out: Singles,
) -> None:
    heads, width, small = score.shape[1], query.shape[1], seen.shape[1]
    part = width // heads
    for b in range(len(first) - 1):
        p, start, count = begin[b], keys[b], keys[b + 1] - keys[b]
        for n in range(first[b], first[b + 1]):
            for h in range(heads):
                _weigh(query, n, key, start, count, h, part, score, p, weights)
                _blend(weights, count, value, start, h * part, out, n, h * part, part)
                _blend(weights, count, seen, p, 0, out, n, width + h * small, small)
            p += count


@reordering
def _take_offers(
    query: Singles, key: Singles, score: Singles, offers: Singles, moves: int, first: Ints, keys: Ints, begin: Ints, amounts: Singles,
    weights: Singles, offered: Singles, goes: Singles,
) -> None:  # fmt: skip
    """Add to `goes` (T, 4), a move and a turn, the directions that pairs offer: under the weights of each head, by `amounts` (T, H K)."""
    heads, size = score.shape[1], offers.shape[1]
    for b in range(len(first) - 1):
        p, start, count = begin[b], keys[b], keys[b + 1] - keys[b]
        for n in range(first[b], first[b + 1]):
            for h in range(heads):
                _weigh(query, n, key, start, count, h, query.shape[1] // heads, score, p, weights)
                for k in range(size):
                    offered[0, k] = NIL
                _blend(weights, count, offers, p, 0, offered, 0, 0, size)
                for k in range(size // 2):
                    amount, turn = amounts[n, h * (size // 2) + k], 0 if k < moves else 2
                    goes[n, turn] += amount * offered[0, 2 * k]
                    goes[n, turn + 1] += amount * offered[0, 2 * k + 1]
            p += count


@reordering
def _weigh(
    query: Singles, n: int, key: Singles, start: int, count: int, head: int, part: int, score: Singles, p: int, weights: Singles
) -> None:
    """Fill in the attention `weights` of `count` keys for query n: the softmax of their products, over the root of `part`, and their scores."""
    scale, top, total = np.float32(1 / math.sqrt(part)), np.float32(-1e30), NIL
    for m in range(count):
        product = NIL
        for c in range(head * part, (head + 1) * part):
            product += query[n, c] * key[start + m, c]
        weights[m] = product * scale + score[p + m, head]
        top = max(top, weights[m])
    for m in range(count):
        weights[m] = np.exp(weights[m] - top)
        total += weights[m]
    for m in range(count):
        weights[m] /= total


@reordering
def _blend(weights: Singles, count: int, rows: Singles, start: int, at: int, out: Singles, n: int, to: int, size: int) -> None:
    """Add to `size` columns of out[n], from `to` on, those of `count` rows, from `at` on, by their weights; four rows at a time, since each pass goes through memory."""
    m = 0
    while m + 4 <= count:
        r, a, b, c, d = start + m, weights[m], weights[m + 1], weights[m + 2], weights[m + 3]
        for k in range(size):
            out[n, to + k] += a * rows[r, at + k] + b * rows[r + 1, at + k] + c * rows[r + 2, at + k] + d * rows[r + 3, at + k]
        m += 4
    while m < count:
        for k in range(size):
            out[n, to + k] += weights[m] * rows[start + m, at + k]
        m += 1
