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

from pipeline.diffusion.attention import MODULATIONS, SUBLAYERS, Block, Surroundings, modulated, pointed, split_heads, weights
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
from pipeline.diffusion.repeats import Bounds
from pipeline.diffusion.settings import ModelSettings

FLOOR_FEATURES = 5 + len(KINDS)
WALL_OFFERS, PAIR_OFFERS = WALL_MOVES + WALL_TURNS, PAIR_MOVES + PAIR_TURNS
MOST = 24  # counts above are told as this


class FloorCode(NamedTuple):
    """What does not change between sampling steps.

    `keys`: of walls and openings (B, H, M, c), keys and values for each layer, then the pointer's keys; `room` (B, d).
    """

    keys: tuple[Tensor, ...]
    room: Tensor


class Denoiser(nn.Module):
    """Expects the clean slots: continuous channels in the chosen parametrisation, classes as logits."""

    def __init__(self, norm: Normalisation, layouts: int, settings: ModelSettings) -> None:
        super().__init__()
        width, relation, layers, heads = settings.width, settings.relation, settings.layers, settings.heads
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
        pair, wall = relation + PAIR_NOISE, relation + WALL_NOISE
        self.pair_bias, self.wall_bias = nn.Linear(pair, (layers + 1) * heads), nn.Linear(wall, (layers + 1) * heads)
        self.floor_keys = nn.Linear(width, (2 * layers + 1) * width)
        self.modulation = nn.Linear(width, (MODULATIONS * layers + 2) * width)
        self.blocks = nn.ModuleList(Block(width, heads, pair, wall) for _ in range(layers))
        self.point = nn.Linear(width, 3 * width)  # queries to walls and to slots, keys of slots
        self.parts = [CONTINUOUS - 4, 8, len(norm.classes) + 1, heads * WALL_OFFERS, heads * PAIR_OFFERS]
        self.head = nn.Linear(width, sum(self.parts))
        nn.init.zeros_(self.head.weight)
        nn.init.zeros_(self.head.bias)
        nn.init.zeros_(self.modulation.weight)
        with torch.no_grad():  # shift 0, scale 1, gate 1
            ones = torch.tensor([0.0, 1.0, 1.0]).repeat(SUBLAYERS * layers + 1)[: MODULATIONS * layers + 2]
            self.modulation.bias.copy_(ones.repeat_interleave(width))

    def _apply(self, fn: object, recurse: bool = True) -> Denoiser:
        super()._apply(fn, recurse)  # type: ignore[no-untyped-call]
        self.codec = Codec(self.norm, self.head.weight.device)
        return self

    def by_layer(self, bias: Tensor) -> tuple[Tensor, ...]:
        """Split biases (B, N, M, (layers + 1) H) into (B, H, N, M) for each layer, and for the pointer."""
        found: tuple[Tensor, ...] = bias.unflatten(-1, (-1, self.settings.heads)).permute(3, 0, 4, 1, 2).contiguous().unbind(0)
        return found

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
        return FloorCode(split_heads(self.floor_keys(tokens), 2 * self.settings.layers + 1, self.settings.heads), room)

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
        pair_bias = self.by_layer(self.pair_bias(pairs))
        wall_bias = self.by_layer(self.wall_bias(walls).masked_fill(~rooms.mask[:, None, :, None], -1e9))
        modulation = self.modulation(condition)[:, None].chunk(MODULATIONS * self.settings.layers + 2, -1)
        tokens = self.slot(torch.cat([invariants(x), x[..., 2:6], x[..., YAW.stop :]], -1))
        for i, block in enumerate(self.blocks):
            own, keys = modulation[MODULATIONS * i : MODULATIONS * (i + 1)], (code.keys[2 * i], code.keys[2 * i + 1])
            tokens = block(tokens, Surroundings(pairs, pair_bias[i]), Surroundings(walls, wall_bias[i]), keys, own)
        tokens = modulated(tokens, *modulation[-2:])
        plain, own, logits, by_wall, by_pair = self.head(tokens).split(self.parts, -1)
        to_walls, to_slots, slot_keys = split_heads(self.point(tokens), 3, self.settings.heads)
        axis = x[..., YAW]
        front = torch.stack([axis[..., 1], -axis[..., 0]], -1)
        mine = torch.stack([x[..., :2], axis, front, aligned(boxes, rooms, blur)], -2)  # (B, N, 4, 2)
        goes = own.unflatten(-1, (2, 4)) @ mine  # (B, N, 2, 2): move, turn
        for query, key, bias, relation, amount, moves in (
            (to_walls, code.keys[-1], wall_bias[-1], wall, by_wall, WALL_MOVES),
            (to_slots, slot_keys, pair_bias[-1], pair, by_pair, PAIR_MOVES),
        ):
            goes = goes + pointed(weights(query, key, bias), torch.cat([relation.moves, relation.turns], -2), amount, moves)
        logits = logits + self.codec.evidence(x[..., CONTINUOUS:], alpha[:, None, None], sigma[:, None, None])
        prior = torch.zeros_like(logits)
        prior[..., -1] = empty_odds(rooms.count, x.shape[1])[:, None]
        logits = logits + prior
        return torch.cat([goes[:, :, 0], plain[..., :4], goes[:, :, 1], plain[..., 4:]], -1), logits

    def expected(
        self, x: Tensor, alpha: Tensor, sigma: Tensor, rooms: RoomBatch, code: FloorCode | None = None, bounds: Bounds | None = None
    ) -> tuple[Tensor, Tensor]:
        """Return the expected clean slots x0 (B, N, D), and the class logits. `bounds` says how often a room may take what.

        The net says where a slot would stand if it held something; an empty slot's channels are unit noise as data, of
        which alpha * x is the mean given x. The expectation weighs the two by the chance that the slot is empty: without
        that, sampled empty slots would look more orderly than those in training, and be taken for objects.
        """
        a, s, seen = alpha[:, None, None], sigma[:, None, None], x[..., :CONTINUOUS]
        raw, logits = self(x, alpha, rooms, code)
        chance = logits.softmax(-1) if bounds is None else bounds.applied(logits)
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
