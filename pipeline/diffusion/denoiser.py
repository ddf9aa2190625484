"""The denoiser: a transformer over the set of slots that looks at walls and openings.

It turns with the room. Inputs are lengths and angles between directions of the room, never world coordinates; positions
and yaws are answered as sums of directions that the room and its slots offer. So a rule that is learnt at one wall holds
at all four, and the world's axes mean nothing (mirror images are left to the augmentation).

Called with x (B, N, D) at level t (B,) and a `RoomBatch`; answers the clean slots it expects. No slot embedding, so a
permutation of the slots permutes the answer.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import torch
from torch import Tensor, nn

from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.codec import CONTINUOUS, YAW, Codec, Normalisation
from pipeline.diffusion.floor import KINDS
from pipeline.diffusion.relations import (
    PAIR_FEATURES,
    PAIR_MOVES,
    PAIR_NOISE,
    PAIR_TURNS,
    WALL_FEATURES,
    WALL_MOVES,
    WALL_NOISE,
    WALL_TURNS,
    aligned,
    boxes_of,
    pair_relations,
    wall_relations,
)
from pipeline.diffusion.settings import ModelSettings

FLOOR_FEATURES = 5 + len(KINDS)
MOST = 24  # counts above are told as this


class FloorCode(NamedTuple):
    """What does not change between sampling steps: tokens (B, M, d), the room's own code (B, d)."""

    tokens: Tensor
    room: Tensor


class Attention(nn.Module):
    """Attention whose scores and values also know the geometry of each pair (B, N, M, R)."""

    def __init__(self, width: int, heads: int, relation: int) -> None:
        super().__init__()
        self.heads = heads
        self.query, self.keys = nn.Linear(width, width), nn.Linear(width, 2 * width)
        self.bias = nn.Linear(relation, heads)
        self.relation = nn.Linear(heads * relation, width, bias=False)
        self.out = nn.Linear(width, width)

    def forward(self, x: Tensor, source: Tensor, relation: Tensor, mask: Tensor | None) -> Tensor:
        """Attend from x (B, N, d) to source (B, M, d), where `mask` (B, M) holds."""
        query = self.query(x).unflatten(-1, (self.heads, -1)).transpose(1, 2)
        key, value = (part.unflatten(-1, (self.heads, -1)).transpose(1, 2) for part in self.keys(source).chunk(2, -1))
        score = query @ key.transpose(2, 3) / math.sqrt(query.shape[-1]) + self.bias(relation).permute(0, 3, 1, 2)
        if mask is not None:
            score = score.masked_fill(~mask[:, None, None], -1e9)
        weight = score.softmax(-1)
        seen = (weight @ value).transpose(1, 2).flatten(2)
        where = (weight.transpose(1, 2) @ relation).flatten(2)  # (B, N, H, M) @ (B, N, M, R)
        out: Tensor = self.out(seen) + self.relation(where)
        return out


class Pointer(nn.Module):
    """Chooses pairs by attention and sums the directions that they offer, each with a weight of its own."""

    def __init__(self, width: int, heads: int, relation: int, moves: int, turns: int) -> None:
        super().__init__()
        self.heads, self.moves = heads, moves
        self.query, self.key, self.bias = nn.Linear(width, width), nn.Linear(width, width), nn.Linear(relation, heads)
        self.amount = nn.Linear(width, heads * (moves + turns))
        nn.init.zeros_(self.amount.weight)
        nn.init.zeros_(self.amount.bias)

    def forward(self, x: Tensor, source: Tensor, relation: Tensor, directions: Tensor, mask: Tensor | None) -> Tensor:
        """Return the sums (B, N, 2, 2) for moves and for turns; `directions` (B, N, M, moves + turns, 2)."""
        query, key = (v.unflatten(-1, (self.heads, -1)).transpose(1, 2) for v in (self.query(x), self.key(source)))
        score = query @ key.transpose(2, 3) / math.sqrt(query.shape[-1]) + self.bias(relation).permute(0, 3, 1, 2)
        if mask is not None:
            score = score.masked_fill(~mask[:, None, None], -1e9)
        weight = score.softmax(-1).transpose(1, 2)  # (B, N, H, M)
        offered = (weight @ directions.flatten(3)).unflatten(-1, (-1, 2))  # (B, N, H, moves + turns, 2)
        taken = offered * self.amount(x).unflatten(-1, (self.heads, -1))[..., None]
        return torch.stack([taken[..., : self.moves, :].sum((2, 3)), taken[..., self.moves :, :].sum((2, 3))], 2)


class Block(nn.Module):
    """Look at the other objects, at the floor, then think; conditioned by adaptive layer norm."""

    def __init__(self, width: int, heads: int, relation: int) -> None:
        super().__init__()
        pairs, walls = relation + PAIR_NOISE, relation + WALL_NOISE
        self.norms = nn.ModuleList(nn.LayerNorm(width, elementwise_affine=False) for _ in range(3))
        self.objects, self.floor = Attention(width, heads, pairs), Attention(width, heads, walls)
        self.think = nn.Sequential(nn.Linear(width, 3 * width), nn.SiLU(), nn.Linear(3 * width, width))
        self.modulation = nn.Linear(width, 9 * width)
        nn.init.zeros_(self.modulation.weight)
        with torch.no_grad():
            self.modulation.bias.copy_(torch.tensor([0.0, 0.0, 1.0]).repeat(3).repeat_interleave(width))

    def forward(self, x: Tensor, floor: Tensor, mask: Tensor, pairs: Tensor, walls: Tensor, condition: Tensor) -> Tensor:
        """Return the new tokens (B, N, d)."""
        shift, scale, gate = zip(*(part.chunk(3, -1) for part in self.modulation(condition)[:, None].chunk(3, -1)), strict=True)
        inputs = [lambda v, i=i: self.norms[i](v) * (1 + scale[i]) + shift[i] for i in range(3)]
        seen = inputs[0](x)
        x = x + gate[0] * self.objects(seen, seen, pairs, None)
        x = x + gate[1] * self.floor(inputs[1](x), floor, walls, mask)
        out: Tensor = x + gate[2] * self.think(inputs[2](x))
        return out


class Denoiser(nn.Module):
    """Expects the clean slots: continuous channels in the chosen parametrisation, classes as logits."""

    def __init__(self, norm: Normalisation, layouts: int, settings: ModelSettings) -> None:
        super().__init__()
        width, relation = settings.width, settings.relation
        self.norm, self.settings, self.codec = norm, settings, Codec(norm)
        self.slot = nn.Linear(norm.channels, width)  # two vectors of two channels go in as four lengths and products
        self.floor_in = nn.Sequential(nn.Linear(FLOOR_FEATURES, width), nn.SiLU(), nn.Linear(width, width))
        self.layout, self.count = nn.Embedding(layouts, width), nn.Embedding(MOST + 2, width)
        self.room = nn.Sequential(nn.Linear(width + 3, width), nn.SiLU(), nn.Linear(width, width))
        self.level = nn.Sequential(nn.Linear(33, width), nn.SiLU(), nn.Linear(width, width))
        self.pairs = nn.Sequential(nn.Linear(PAIR_FEATURES + PAIR_NOISE, relation), nn.ReLU(), nn.Linear(relation, relation), nn.ReLU())
        self.walls = nn.Sequential(
            nn.Linear(WALL_FEATURES + WALL_NOISE + len(KINDS), relation), nn.ReLU(), nn.Linear(relation, relation), nn.ReLU()
        )
        self.blocks = nn.ModuleList(Block(width, settings.heads, relation) for _ in range(settings.layers))
        self.last = nn.LayerNorm(width, elementwise_affine=False)
        self.last_modulation = nn.Linear(width, 2 * width)
        self.head = nn.Linear(width, norm.channels - 4 + 8)
        self.by_wall = Pointer(width, settings.heads, relation + WALL_NOISE, WALL_MOVES, WALL_TURNS)
        self.by_pair = Pointer(width, settings.heads, relation + PAIR_NOISE, PAIR_MOVES, PAIR_TURNS)
        for layer in (self.head, self.last_modulation):
            nn.init.zeros_(layer.weight)
            nn.init.zeros_(layer.bias)

    def _apply(self, fn: object, recurse: bool = True) -> Denoiser:
        super()._apply(fn, recurse)  # type: ignore[no-untyped-call]
        self.codec = Codec(self.norm, self.head.weight.device)
        return self

    def floor_code(self, rooms: RoomBatch) -> FloorCode:
        """Encode the room; independent of the noise level, so a sampler calls it once."""
        ends, middle = rooms.ends, rooms.ends.mean(2)
        length = torch.linalg.vector_norm(ends[:, :, 1] - ends[:, :, 0] + 1e-9, dim=-1)
        kind = nn.functional.one_hot(rooms.kind, len(KINDS)).float()
        swings = torch.stack([(rooms.hinge == 0).float(), (rooms.hinge == 1).float()], -1)
        along = torch.stack([rooms.normal[..., 1], -rooms.normal[..., 0]], -1)
        place = torch.stack([(middle * rooms.normal).sum(-1), (middle * along).sum(-1), length], -1) / 3
        features = torch.cat([place, swings, kind], -1)
        tokens = self.floor_in(features) * rooms.mask[..., None]
        reach = torch.linalg.vector_norm(torch.where(rooms.mask[..., None], middle, 0) + 1e-9, dim=-1).amax(1, keepdim=True)
        area = polygon_area(rooms)
        told = torch.where(rooms.count < 0, MOST + 1, rooms.count.clamp(0, MOST))
        pooled = tokens.sum(1) / rooms.mask.sum(1, keepdim=True).clamp_min(1)
        size = torch.cat([reach / 3, area.clamp_min(0.5).log()[:, None] - 2, rooms.height[:, None] - 2.7], -1)
        room = self.room(torch.cat([pooled, size], -1)) + self.layout(rooms.layout) + self.count(told)
        return FloorCode(tokens, room)

    def forward(self, x: Tensor, alpha: Tensor, rooms: RoomBatch, code: FloorCode | None = None) -> tuple[Tensor, Tensor]:
        """Return the raw output for the continuous channels (B, N, 40) and the class logits (B, N, C + 1).

        `alpha` (B,) is the share of the signal in x (see `schedule`).
        """
        code = code or self.floor_code(rooms)
        condition = nn.functional.silu(self.level(level_features(alpha)) + code.room)
        boxes = boxes_of(self.codec.metric(alpha[:, None, None] * x[..., : YAW.stop]))
        sigma = (1 - alpha**2).clamp_min(1e-5).sqrt()
        blur = torch.stack([sigma * self.codec.scale[0], sigma], -1)
        pair, wall = pair_relations(boxes, blur), wall_relations(boxes, rooms, blur)
        pairs = torch.cat([self.pairs(torch.cat([pair.far, pair.near], -1)), pair.near], -1)
        kind = nn.functional.one_hot(rooms.kind, len(KINDS)).float()[:, None].expand(-1, x.shape[1], -1, -1)
        walls = torch.cat([self.walls(torch.cat([wall.far, wall.near, kind], -1)), wall.near], -1)
        tokens = self.slot(torch.cat([invariants(x), x[..., 2:6], x[..., YAW.stop :]], -1))
        for block in self.blocks:
            tokens = block(tokens, code.tokens, rooms.mask, pairs, walls, condition)
        shift, scale = self.last_modulation(condition)[:, None].chunk(2, -1)
        tokens = self.last(tokens) * (1 + scale) + shift
        plain, own, logits = self.head(tokens).split([CONTINUOUS - 4, 8, self.codec.classes + 1], -1)
        axis = x[..., YAW]
        front = torch.stack([axis[..., 1], -axis[..., 0]], -1)
        mine = torch.stack([x[..., :2], axis, front, aligned(boxes, rooms, blur)], -2)  # (B, N, 4, 2)
        goes = own.unflatten(-1, (2, 4)) @ mine  # (B, N, 2, 2): move, turn
        goes = goes + self.by_wall(tokens, code.tokens, walls, torch.cat([wall.moves, wall.turns], -2), rooms.mask)
        goes = goes + self.by_pair(tokens, tokens, pairs, torch.cat([pair.moves, pair.turns], -2), None)
        logits = logits + self.codec.evidence(x[..., CONTINUOUS:], alpha[:, None, None], sigma[:, None, None])
        prior = torch.zeros_like(logits)
        prior[..., -1] = empty_odds(rooms.count, x.shape[1])[:, None]
        logits = logits + prior
        return torch.cat([goes[:, :, 0], plain[..., :4], goes[:, :, 1], plain[..., 4:]], -1), logits

    def expected(self, x: Tensor, alpha: Tensor, sigma: Tensor, rooms: RoomBatch, code: FloorCode | None = None) -> tuple[Tensor, Tensor]:
        """Return the expected clean slots x0 (B, N, D), and the class logits.

        The net says where a slot would stand if it held something; an empty slot's channels are unit noise as data, of
        which alpha * x is the mean given x. The expectation weighs the two by the chance that the slot is empty: without
        that, sampled empty slots would look more orderly than those in training, and be taken for objects.
        """
        a, s, seen = alpha[:, None, None], sigma[:, None, None], x[..., :CONTINUOUS]
        raw, logits = self(x, alpha, rooms, code)
        chance = logits.softmax(-1)
        held = from_target(self.settings.target, raw, seen, a, s)
        continuous = a * seen + (1 - chance[..., -1:]) * (held - a * seen)
        return torch.cat([continuous, self.codec.class_block(chance)], -1), logits


def invariants(x: Tensor) -> Tensor:
    """Return what position and axis of each slot (B, N, 4) say whichever way the room is turned."""
    place, axis = x[..., :2], x[..., YAW]
    front = torch.stack([axis[..., 1], -axis[..., 0]], -1)
    length = [torch.linalg.vector_norm(v + 1e-9, dim=-1) for v in (place, axis)]
    return torch.stack([*length, (place * axis).sum(-1), (place * front).sum(-1)], -1)


def from_target(target: str, raw: Tensor, x: Tensor, alpha: Tensor, sigma: Tensor) -> Tensor:
    """Convert what the network predicts to x0: v = alpha eps - sigma x0, or eps, or x0 itself."""
    if target == "v":
        return alpha * x - sigma * raw
    if target == "eps":
        return (x - sigma * raw) / alpha
    return raw


def empty_odds(count: Tensor, slots: int) -> Tensor:
    """Return the log odds (B,) that a slot is empty, all else unknown, in a room of `count` (B,) objects; untold: of five.

    With them in place the net need not learn what a count or another number of slots does to every slot's chance.
    """
    objects = torch.where(count < 0, torch.full_like(count, 5), count).float().clamp(0.1, slots - 0.1)
    return ((slots - objects) / objects).log()


def level_features(alpha: Tensor) -> Tensor:
    """Return features (B, 33) of the noise level: log signal-to-noise ratio, sines of it."""
    snr = (2 * alpha.log() - torch.log1p(-(alpha**2).clamp_max(1 - 1e-7))).clamp(-12, 12)
    rates = torch.exp(torch.linspace(math.log(0.1), math.log(4.0), 16, device=alpha.device))
    angles = snr[:, None] * rates
    return torch.cat([snr[:, None] / 6, angles.sin(), angles.cos()], -1)


def polygon_area(rooms: RoomBatch) -> Tensor:
    """Return the areas (B,) [m2] of the rooms, from their walls (shoelace formula)."""
    a, b = rooms.ends[:, :, 0], rooms.ends[:, :, 1]
    cross = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return 0.5 * torch.where(rooms.walls, cross, torch.zeros_like(cross)).sum(1)
