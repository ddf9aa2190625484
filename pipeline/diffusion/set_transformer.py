"""The denoiser: a transformer over the set of a room's objects that looks at walls and openings.

It turns with the room. Inputs are lengths and angles between directions of the room, never world coordinates; positions
and yaws are answered as sums of directions that the room and its objects offer. So a rule that is learnt at one wall holds
at all four, and the world's axes mean nothing (mirror images are left to the augmentation).

It looks twice. The first pass sees the boxes where the step before expected them (self-conditioning, Chen et al. 2023), or at the first step
where the noise lets one guess them (alpha x_t, "somewhere in the middle"), and answers where they belong; the second sees the room as the
first has arranged it, chairs beside tables and backs at walls, and corrects that. Both answers are trained. No slot embedding, so a permutation of the objects permutes
the answer.

Training runs on one or two cores, where small operations cost more than arithmetic: what all layers ask of the same input (biases of pairs, keys
of the floor, modulations) is asked once for all of them, by the denoiser, and handed in.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import torch
from torch import Tensor, nn

from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.codec import CHANNELS, YAW, Codec, Normalisation
from pipeline.diffusion.context import KINDS
from pipeline.diffusion.relations import (
    PAIR_FEATURES,
    PAIR_MOVES,
    PAIR_NOISE,
    PAIR_TURNS,
    WALL_FEATURES,
    WALL_MOVES,
    WALL_NOISE,
    WALL_TURNS,
    axis_deviations,
    boxes_of,
    pair_relations,
    wall_relations,
)
from pipeline.diffusion.schedule import alpha_sigma
from pipeline.diffusion.settings import ModelSettings

FLOOR_FEATURES = 5 + len(KINDS)
WALL_OFFERS, PAIR_OFFERS = WALL_MOVES + WALL_TURNS, PAIR_MOVES + PAIR_TURNS
OWN_WAYS = (
    5  # directions that an object offers itself: noisy position, axis and front, estimated axis, and the way to the room's directions
)
MOST = 8.0  # of a clean channel, in standard deviations
HIDDEN = -1e9  # score of what is not there
FEW = 4  # products of fewer rows are summed in another order
Geometry = slice(0, 8)
SUBLAYERS = 3  # objects, floor, thought
MODULATIONS = 3 * SUBLAYERS  # shift, scale and gate of each


class Surroundings(NamedTuple):
    """What a layer looks at: `relation` (B, N, M, R) of each pair, `bias` (B, H, N, M) of its scores."""

    relation: Tensor
    bias: Tensor


class FloorCode(NamedTuple):
    """What does not change between sampling steps.

    `keys`: of walls and openings (B, H, M, c), keys and values for each layer, then the pointers' keys; `room` (B, d).
    """

    keys: tuple[Tensor, ...]
    room: Tensor


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


class Pass(nn.Module):
    """One look at the room: relations of the boxes as they are guessed so far, some layers, an answer."""

    def __init__(self, settings: ModelSettings) -> None:
        super().__init__()
        width, relation, heads, layers = settings.width, settings.relation, settings.heads, settings.layers
        self.heads, self.layers = heads, layers
        self.guess = nn.Linear(6, width)
        self.pairs = nn.Sequential(nn.Linear(PAIR_FEATURES + PAIR_NOISE, relation), nn.ReLU(), nn.Linear(relation, relation), nn.ReLU())
        self.walls = nn.Sequential(
            nn.Linear(WALL_FEATURES + WALL_NOISE + len(KINDS), relation), nn.ReLU(), nn.Linear(relation, relation), nn.ReLU()
        )
        pair, wall = relation + PAIR_NOISE, relation + WALL_NOISE
        self.pair_bias, self.wall_bias = nn.Linear(pair, (layers + 1) * heads), nn.Linear(wall, (layers + 1) * heads)
        self.modulation = nn.Linear(width, (MODULATIONS * layers + 2) * width)
        self.blocks = nn.ModuleList(Block(width, heads, pair, wall) for _ in range(layers))
        self.point = nn.Linear(width, 3 * width)  # queries to walls and to objects, keys of objects
        self.parts = [CHANNELS - 4, 2 * OWN_WAYS, heads * WALL_OFFERS, heads * PAIR_OFFERS]
        self.head = nn.Linear(width, sum(self.parts))
        nn.init.zeros_(self.head.weight)
        nn.init.zeros_(self.head.bias)
        nn.init.zeros_(self.modulation.weight)
        with torch.no_grad():  # shift 0, scale 1, gate 1
            ones = torch.tensor([0.0, 1.0, 1.0]).repeat(SUBLAYERS * layers + 1)[: MODULATIONS * layers + 2]
            self.modulation.bias.copy_(ones.repeat_interleave(width))

    def by_layer(self, bias: Tensor) -> tuple[Tensor, ...]:
        """Split biases (B, N, M, (layers + 1) H) into (B, H, N, M) for each layer, and for the pointer."""
        biases: tuple[Tensor, ...] = bias.unflatten(-1, (-1, self.heads)).permute(3, 0, 4, 1, 2).contiguous().unbind(0)
        return biases

    def forward(
        self, tokens: Tensor, slots: NoisySlots, guess: Tensor, rooms: RoomBatch, keys: tuple[Tensor, ...], condition: Tensor
    ) -> tuple[Tensor, Tensor]:
        """Return the tokens, and the answer (B, N, 40) as directions and amounts; `guess` (B, N, 8) metric."""
        boxes, blur = boxes_of(guess), slots.blur
        pair, wall = pair_relations(boxes, blur), wall_relations(boxes, rooms, blur)
        pairs = torch.cat([self.pairs(torch.cat([pair.far, pair.near], -1)), pair.near], -1)
        kind = nn.functional.one_hot(rooms.kind, len(KINDS)).float()[:, None].expand(-1, guess.shape[1], -1, -1)
        walls = torch.cat([self.walls(torch.cat([wall.far, wall.near, kind], -1)), wall.near], -1)
        pair_bias = self.by_layer(self.pair_bias(pairs).masked_fill(slots.padding[:, None, :, None], HIDDEN))
        wall_bias = self.by_layer(self.wall_bias(walls).masked_fill(~rooms.mask[:, None, :, None], HIDDEN))
        modulation = by_room(self.modulation, condition)[:, None].chunk(MODULATIONS * self.layers + 2, -1)
        axis = boxes.axis
        own_guess = torch.cat([invariants(boxes.centre / 3, axis), boxes.bottom[..., None], boxes.height[..., None]], -1)
        tokens = tokens + self.guess(own_guess)
        for i, block in enumerate(self.blocks):
            own = modulation[MODULATIONS * i : MODULATIONS * (i + 1)]
            tokens = block(
                tokens, Surroundings(pairs, pair_bias[i]), Surroundings(walls, wall_bias[i]), (keys[2 * i], keys[2 * i + 1]), own
            )
        features = modulate(tokens, *modulation[-2:])
        plain, ways, by_wall, by_pair = self.head(features).split(self.parts, -1)
        to_walls, to_slots, slot_keys = split_heads(self.point(features), 3, self.heads)
        mine = torch.stack([*slots.ways, axis, axis_deviations(boxes, rooms, blur)], -2)
        goes = ways.unflatten(-1, (2, OWN_WAYS)) @ mine  # (B, N, 2, 2): move, turn
        for query, key, bias, relation, amount, moves in (
            (to_walls, keys[-1], wall_bias[-1], wall, by_wall, WALL_MOVES),
            (to_slots, slot_keys, pair_bias[-1], pair, by_pair, PAIR_MOVES),
        ):
            goes = goes + sum_directions(weights(query, key, bias), torch.cat([relation.moves, relation.turns], -2), amount, moves)
        return tokens, torch.cat([goes[:, :, 0], plain[..., :4], goes[:, :, 1], plain[..., 4:]], -1)


class NoisySlots(NamedTuple):
    """What all passes share: `ways` (three of (B, N, 2)) of the noisy slots, `blur` (B, 2) of a position [m] and of an axis, `padding` (B, N)."""

    ways: tuple[Tensor, ...]
    blur: Tensor
    padding: Tensor


class SetTransformer(nn.Module):
    """Expects the clean channels of objects whose classes are known."""

    def __init__(self, norm: Normalisation, layouts: int, settings: ModelSettings) -> None:
        super().__init__()
        width = settings.width
        self.norm, self.settings, self.codec = norm, settings, Codec(norm)
        self.slot = nn.Linear(CHANNELS, width)  # two vectors of two channels go in as four lengths and products
        self.kind = nn.Embedding(len(norm.classes) + 1, width)
        self.floor_in = nn.Sequential(nn.Linear(FLOOR_FEATURES, width), nn.SiLU(), nn.Linear(width, width))
        self.layout = nn.Embedding(layouts, width)
        self.room = nn.Sequential(nn.Linear(2 * width + 3, width), nn.SiLU(), nn.Linear(width, width))
        self.level = nn.Sequential(nn.Linear(33, width), nn.SiLU(), nn.Linear(width, width))
        self.floor_keys = nn.Linear(width, settings.passes * (2 * settings.layers + 1) * width)
        self.passes = nn.ModuleList(Pass(settings) for _ in range(settings.passes))

    def _apply(self, fn: object, recurse: bool = True) -> SetTransformer:
        super()._apply(fn, recurse)  # type: ignore[no-untyped-call]
        self.codec = Codec(self.norm, self.slot.weight.device)
        return self

    def floor_code(self, rooms: RoomBatch, classes: Tensor) -> FloorCode:
        """Encode the room and what it will hold, `classes` (B, N); independent of the noise level, so a sampler calls it once."""
        ends, middle = rooms.ends, rooms.ends.mean(2)
        length = torch.linalg.vector_norm(ends[:, :, 1] - ends[:, :, 0] + 1e-9, dim=-1)
        kind = nn.functional.one_hot(rooms.kind, len(KINDS)).float()
        swings = torch.stack([(rooms.hinge == 0).float(), (rooms.hinge == 1).float()], -1)
        along = torch.stack([rooms.normal[..., 1], -rooms.normal[..., 0]], -1)
        place = torch.stack([(middle * rooms.normal).sum(-1), (middle * along).sum(-1), length], -1) / 3
        tokens = self.floor_in(torch.cat([place, swings, kind], -1)) * rooms.mask[..., None]
        reach = torch.linalg.vector_norm(torch.where(rooms.mask[..., None], middle, 0) + 1e-9, dim=-1).amax(1, keepdim=True)
        area = polygon_area(rooms)
        pooled = tokens.sum(1) / rooms.mask.sum(1, keepdim=True).clamp_min(1)
        inventory = (self.kind(classes) * (classes < self.codec.classes)[..., None]).sum(1) / 4
        size = torch.cat([reach / 3, area.clamp_min(0.5).log()[:, None] - 2, rooms.height[:, None] - 2.7], -1)
        room = by_room(self.room, torch.cat([pooled, inventory, size], -1)) + self.layout(rooms.layout)
        parts = self.settings.passes * (2 * self.settings.layers + 1)
        return FloorCode(split_heads(self.floor_keys(tokens), parts, self.settings.heads), room)

    def forward(
        self,
        x: Tensor,
        classes: Tensor,
        level: Tensor,
        rooms: RoomBatch,
        code: FloorCode | None = None,
        before: Tensor | None = None,
    ) -> tuple[Tensor, ...]:
        """Return what each pass answers (B, N, 40): v = alpha eps - sigma x0, of slots x at levels (B,), the last one best.

        `before` (B, N, >= 8): the clean channels that were expected before, at a level of more noise or at this one.
        """
        code = code or self.floor_code(rooms, classes)
        condition = nn.functional.silu(by_room(self.level, level_features(level)) + code.room)
        alpha, sigma = (v[:, None, None] for v in alpha_sigma(level))
        spread = sigma[:, 0, 0].clamp_min(3e-3)
        front = torch.stack([x[..., 7], -x[..., 6]], -1)
        slots = NoisySlots(
            (x[..., :2], x[..., YAW], front), torch.stack([spread * self.codec.reach, spread], -1), classes >= self.codec.classes
        )
        tokens = self.slot(torch.cat([invariants(x[..., :2], x[..., YAW]), x[..., 2:6], x[..., YAW.stop :]], -1)) + self.kind(classes)
        guess, answer, answers = (alpha * x if before is None else before)[..., Geometry], None, []
        per_pass = 2 * self.settings.layers + 1
        for number, look in enumerate(self.passes):
            keys = code.keys[number * per_pass : (number + 1) * per_pass]
            tokens, more = look(tokens, slots, self.codec.metric(guess, classes), rooms, keys, condition)
            answer = more if answer is None else answer.detach() + more
            answers.append(answer)
            guess = clamp_channels(self.clean(x[..., Geometry], answer[..., Geometry], alpha, sigma).detach())
        return tuple(answers)

    def expected(
        self,
        x: Tensor,
        classes: Tensor,
        level: Tensor,
        rooms: RoomBatch,
        code: FloorCode | None = None,
        before: Tensor | None = None,
    ) -> Tensor:
        """Return the expected clean channels x0 (B, N, 40), within what data can be: in rooms unlike any in training a step could else run away."""
        alpha, sigma = (v[:, None, None] for v in alpha_sigma(level))
        answer: Tensor = self(x, classes, level, rooms, code, before)[-1]
        return clamp_channels(self.clean(x, answer, alpha, sigma))

    def clean(self, x: Tensor, answer: Tensor, alpha: Tensor, sigma: Tensor) -> Tensor:
        """Return the clean channels that an answer v stands for."""
        return alpha * x - sigma * answer


def by_room(layer: nn.Module, x: Tensor) -> Tensor:
    """Apply a layer to a row (B, d) for each room, so that a room's answer has the same bits whichever others share its batch."""
    answers: Tensor = layer(torch.cat([x, x[:1].expand(FEW - len(x), -1)]) if len(x) < FEW else x)
    return answers[: len(x)]


def clamp_channels(x0: Tensor) -> Tensor:
    """Cut clean channels (B, N, >= 8) at MOST; position and axis as vectors, so that the answer still turns with the room."""
    place, axis = (v * (MOST / torch.linalg.vector_norm(v, dim=-1, keepdim=True).clamp_min(MOST)) for v in (x0[..., :2], x0[..., YAW]))
    return torch.cat([place, x0[..., 2 : YAW.start].clamp(-MOST, MOST), axis, x0[..., YAW.stop :].clamp(-MOST, MOST)], -1)


def invariants(place: Tensor, axis: Tensor) -> Tensor:
    """Return what position and axis (B, N, 2) say whichever way the room is turned (B, N, 4)."""
    front = torch.stack([axis[..., 1], -axis[..., 0]], -1)
    length = [torch.linalg.vector_norm(v + 1e-9, dim=-1) for v in (place, axis)]
    return torch.stack([*length, (place * axis).sum(-1), (place * front).sum(-1)], -1)


def level_features(level: Tensor) -> Tensor:
    """Return features (B, 33) of levels (B,): lambda, sines of it."""
    rates = torch.exp(torch.linspace(math.log(0.1), math.log(4.0), 16, device=level.device))
    angles = level[:, None] * rates
    return torch.cat([level[:, None] / 6, angles.sin(), angles.cos()], -1)


def polygon_area(rooms: RoomBatch) -> Tensor:
    """Return the areas (B,) [m2] of the rooms, from their walls (shoelace formula)."""
    a, b = rooms.ends[:, :, 0], rooms.ends[:, :, 1]
    cross = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return 0.5 * torch.where(rooms.walls, cross, torch.zeros_like(cross)).sum(1)


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


def modulate(x: Tensor, shift: Tensor, scale: Tensor) -> Tensor:
    """Layer norm, then the scale and shift that the condition sets."""
    return torch.addcmul(shift, nn.functional.layer_norm(x, x.shape[-1:]), scale)
