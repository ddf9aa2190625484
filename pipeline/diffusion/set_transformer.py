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
from pipeline.diffusion.padded import PaddedRooms
from pipeline.diffusion.poses import POSES, UNTOLD
from pipeline.diffusion.ragged import RaggedRooms
from pipeline.diffusion.relations import (
    PAIR_FEATURES,
    PAIR_MOVES,
    PAIR_NOISE,
    PAIR_TURNS,
    WALL_FEATURES,
    WALL_MOVES,
    WALL_NOISE,
    WALL_TURNS,
    boxes_of,
)
from pipeline.diffusion.schedule import Expect, alpha_sigma, alpha_sigma_of
from pipeline.diffusion.settings import MOST_SLOTS, ModelSettings
from pipeline.diffusion.surroundings import BatchLayout, Surroundings

FLOOR_FEATURES = 5 + len(KINDS)
WALL_OFFERS, PAIR_OFFERS = WALL_MOVES + WALL_TURNS, PAIR_MOVES + PAIR_TURNS
OWN_WAYS = (
    5  # directions that an object offers itself: noisy position, axis and front, estimated axis, and the way to the room's directions
)
MOST = 8.0  # of a clean channel, in standard deviations
UNBOUNDED = 1e6  # of a room's code, until training ends
RARE = 0.001  # share of the training rooms at either end of a channel of their codes that is no measure for others
FEW = 16  # products of fewer rows are summed in another order where MKL has no strict mode (of a 24th of the columns, with AVX-512)
Geometry = slice(0, 8)
SUBLAYERS = 3  # objects, floor, thought
MODULATIONS = 3 * SUBLAYERS  # shift, scale and gate of each


class FloorCode(NamedTuple):
    """What does not change between sampling steps.

    `keys`: of walls and openings, keys and values for each layer, then the pointers' keys; `room` (B, d).
    """

    keys: Sequence[Tensor]
    room: Tensor


class Block(nn.Module):
    """Look at the other objects, at the floor, then think; conditioned by adaptive layer norm."""

    def __init__(self, width: int, heads: int, pair: int, wall: int) -> None:
        super().__init__()
        self.look = nn.Linear(width, 3 * width)
        self.objects = nn.Linear(width + heads * pair, width)
        self.search = nn.Linear(width, width)
        self.floor = nn.Linear(width + heads * wall, width)
        self.think = nn.Sequential(nn.Linear(width, 3 * width), nn.SiLU(), nn.Linear(3 * width, width))

    def forward(
        self,
        x: Tensor,
        rooms: BatchLayout,
        others: Surroundings,
        floor: Surroundings,
        keys: Sequence[Tensor],
        modulation: Sequence[Tensor],
        layer: int,
    ) -> Tensor:
        """Return the new tokens (..., d). `keys` of the floor and their values; `modulation`: nine tensors that go with the tokens."""
        context = rooms.look_around(self.look(modulate(x, *modulation[:2])), others, layer)
        x = torch.addcmul(x, modulation[2], self.objects(context))
        context = rooms.look_at_floor(self.search(modulate(x, *modulation[3:5])), keys[0], keys[1], floor, layer)
        x = torch.addcmul(x, modulation[5], self.floor(context))
        return torch.addcmul(x, modulation[8], self.think(modulate(x, *modulation[6:8])))


class Pass(nn.Module):
    """One look at the room: relations of the boxes as they are guessed so far, some layers, an answer."""

    def __init__(self, settings: ModelSettings) -> None:
        super().__init__()
        width, relation, heads, layers = settings.width, settings.relation, settings.heads, settings.layers
        self.layers = layers
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

    def forward(
        self, tokens: Tensor, slots: NoisySlots, guess: Tensor, rooms: BatchLayout, keys: Sequence[Tensor], condition: Tensor
    ) -> tuple[Tensor, Tensor]:
        """Return the tokens, and the answer (..., 40) as directions and amounts; `guess` (..., 8) metric."""
        boxes, blur = boxes_of(guess), slots.blur
        pair, wall = rooms.pairs(boxes, blur), rooms.walls(boxes, blur)
        seen = torch.cat([self.pairs(pair.features), pair.near], -1)
        pairs = Surroundings(seen, rooms.pair_scores(self.pair_bias(seen)), pair.offers)
        seen = torch.cat([self.walls(wall.features), wall.near], -1)
        walls = Surroundings(seen, rooms.wall_scores(self.wall_bias(seen)), wall.offers)
        modulation = rooms.to_objects(by_room(self.modulation, condition)).chunk(MODULATIONS * self.layers + 2, -1)
        own_guess = torch.cat([invariants(boxes.centre / 3, boxes.axis), boxes.bottom[..., None], boxes.height[..., None]], -1)
        tokens = tokens + self.guess(own_guess)
        for i, block in enumerate(self.blocks):
            own = modulation[MODULATIONS * i : MODULATIONS * (i + 1)]
            tokens = block(tokens, rooms, pairs, walls, keys[2 * i : 2 * i + 2], own, i)
        features = modulate(tokens, *modulation[-2:])
        plain, ways, *amounts = self.head(features).split(self.parts, -1)
        mine = torch.stack([*slots.ways, boxes.axis, rooms.axis_deviations(boxes, blur)], -2)
        goes = ways.unflatten(-1, (2, OWN_WAYS)) @ mine  # (..., 2, 2): move, turn
        goes = goes + rooms.take_offers(self.point(features), keys[-1], walls, pairs, amounts)
        return tokens, torch.cat([goes[..., 0, :], plain[..., :4], goes[..., 1, :], plain[..., 4:]], -1)


class NoisySlots(NamedTuple):
    """What all passes share: `ways` (three of (..., 2)) of the noisy slots, `blur` (B, 2) of a position [m] and of an axis."""

    ways: tuple[Tensor, ...]
    blur: Tensor


class SetTransformer(nn.Module):
    """Expects the clean channels of objects whose classes are known."""

    def __init__(self, norm: Normalisation, layouts: int, settings: ModelSettings) -> None:
        super().__init__()
        width = settings.width
        self.norm, self.settings, self.codec = norm, settings, Codec(norm)
        self.slot = nn.Linear(CHANNELS, width)  # two vectors of two channels go in as four lengths and products
        self.kind = nn.Embedding(len(norm.classes) + 1, width)
        self.pose = nn.Embedding(len(POSES), width, padding_idx=UNTOLD)
        nn.init.zeros_(self.pose.weight)
        self.floor_in = nn.Sequential(nn.Linear(FLOOR_FEATURES, width), nn.SiLU(), nn.Linear(width, width))
        self.layout = nn.Embedding(layouts, width)
        self.room = nn.Sequential(nn.Linear(2 * width + 3, width), nn.SiLU(), nn.Linear(width, width))
        self.room_bounds: Tensor
        self.register_buffer("room_bounds", torch.empty(2, width))
        self.unbound_rooms()
        self.level = nn.Sequential(nn.Linear(33, width), nn.SiLU(), nn.Linear(width, width))
        self.floor_keys = nn.Linear(width, settings.passes * (2 * settings.layers + 1) * width)
        self.passes = nn.ModuleList(Pass(settings) for _ in range(settings.passes))

    def _apply(self, fn: object, recurse: bool = True) -> SetTransformer:
        super()._apply(fn, recurse)  # type: ignore[no-untyped-call]
        self.codec = Codec(self.norm, self.slot.weight.device)
        return self

    def floor_code(self, rooms: RoomBatch, classes: Tensor, layout: BatchLayout | None = None) -> FloorCode:
        """Encode the rooms and what they will hold, `classes` (B, N), for a `layout` of their objects, padded by default; independent of the noise level, so a sampler calls it once."""
        tokens = self._floor_tokens(rooms)
        parts = self.settings.passes * (2 * self.settings.layers + 1)
        keys = (layout or self._padded(rooms, classes)).split_keys(self.floor_keys(tokens), parts)
        return FloorCode(keys, self._room_code(rooms, classes, tokens).clamp(*self.room_bounds))

    @torch.no_grad()
    def bound_rooms(self, rooms: RoomBatch, classes: Tensor) -> None:
        """Keep the codes of rooms from now on, channel by channel, within those of these rooms, on which it was trained, but for a few at either end.

        Where a room unlike them wakes a channel that none of them does, what comes after has never been trained, and the answer runs away.
        """
        parts = torch.arange(len(rooms)).split(512)
        codes = [self._room_code(rooms.rows(rows), classes[rows], self._floor_tokens(rooms.rows(rows))) for rows in parts]
        ordered = torch.cat(codes).sort(dim=0).values
        few = int(RARE * len(ordered))
        self.room_bounds.copy_(torch.stack([ordered[few], ordered[-1 - few]]))

    def unbound_rooms(self) -> None:
        """Let the codes of rooms be what they are, as training needs it."""
        self.room_bounds[0], self.room_bounds[1] = -UNBOUNDED, UNBOUNDED

    def _floor_tokens(self, rooms: RoomBatch) -> Tensor:
        ends, middle = rooms.ends, rooms.ends.mean(2)
        length = torch.linalg.vector_norm(ends[:, :, 1] - ends[:, :, 0] + 1e-9, dim=-1)
        kind = nn.functional.one_hot(rooms.kind, len(KINDS)).float()
        swings = torch.stack([(rooms.hinge == 0).float(), (rooms.hinge == 1).float()], -1)
        along = torch.stack([rooms.normal[..., 1], -rooms.normal[..., 0]], -1)
        place = torch.stack([(middle * rooms.normal).sum(-1), (middle * along).sum(-1), length], -1) / 3
        tokens: Tensor = self.floor_in(torch.cat([place, swings, kind], -1)) * rooms.mask[..., None]
        return tokens

    def _room_code(self, rooms: RoomBatch, classes: Tensor, tokens: Tensor) -> Tensor:
        middle = torch.where(rooms.mask[..., None], rooms.ends.mean(2), 0)
        reach = torch.linalg.vector_norm(middle + 1e-9, dim=-1).amax(1, keepdim=True)
        area = polygon_area(rooms)
        pooled = tokens.sum(1) / rooms.mask.sum(1, keepdim=True).clamp_min(1)
        inventory = (self.kind(classes) * (classes < self.codec.classes)[..., None]).sum(1) / 4
        size = torch.cat([reach / 3, area.clamp_min(0.5).log()[:, None] - 2, rooms.height[:, None] - 2.7], -1)
        code: Tensor = by_room(self.room, torch.cat([pooled, inventory, size], -1)) + self.layout(rooms.layout)
        return code

    def _padded(self, rooms: RoomBatch, classes: Tensor) -> PaddedRooms:
        return PaddedRooms(rooms, classes >= self.codec.classes, self.settings.heads)

    def forward(
        self,
        x: Tensor,
        classes: Tensor,
        level: Tensor,
        rooms: RoomBatch,
        code: FloorCode | None = None,
        before: Tensor | None = None,
        poses: Tensor | None = None,
    ) -> tuple[Tensor, ...]:
        """Return what each pass answers (B, N, 40): v = alpha eps - sigma x0, of slots x at levels (B,), the last one best.

        `before` (B, N, >= 8): the clean channels that were expected before, at a level of more noise or at this one. `poses` (B, N): the pose classes
        where they are told.
        """
        return self.answers(x, classes, level, self._padded(rooms, classes), code or self.floor_code(rooms, classes), before, poses)

    def answers(
        self,
        x: Tensor,
        classes: Tensor,
        level: Tensor,
        rooms: BatchLayout,
        code: FloorCode,
        before: Tensor | None = None,
        poses: Tensor | None = None,
    ) -> tuple[Tensor, ...]:
        """Return what each pass answers (..., 40) of slots x (..., 40) of `classes` and `poses` (...), however the rooms stand in them."""
        condition = nn.functional.silu(by_room(self.level, level_features(level)) + code.room)
        by_level = alpha_sigma(level)
        alpha, sigma = (rooms.to_objects(v[:, None]) for v in by_level)
        spread = by_level[1].clamp_min(3e-3)
        front = torch.stack([x[..., 7], -x[..., 6]], -1)
        slots = NoisySlots((x[..., :2], x[..., YAW], front), torch.stack([spread * self.codec.reach, spread], -1))
        tokens = self.slot(torch.cat([invariants(x[..., :2], x[..., YAW]), x[..., 2:6], x[..., YAW.stop :]], -1)) + self.kind(classes)
        tokens = tokens if poses is None else tokens + self.pose(poses)
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
        poses: Tensor | None = None,
    ) -> Tensor:
        """Return the expected clean channels x0 (B, N, 40), within what data can be: in rooms unlike any in training a step could else run away."""
        alpha, sigma = (v[:, None, None] for v in alpha_sigma(level))
        answer: Tensor = self(x, classes, level, rooms, code, before, poses)[-1]
        return clamp_channels(self.clean(x, answer, alpha, sigma))

    def expectation(self, rooms: RoomBatch, classes: Tensor, poses: Tensor) -> Expect:
        """Return what is expected of slots x (B, N, 40), level after level of falling noise; `classes` (B, N), C for padding, and `poses` (B, N).

        On a CPU the rooms stand in one list: an answer costs what is there, and has the same bits whichever other rooms are.
        """
        if classes.device.type != "cpu":
            return self._expectation(classes, poses, self._padded(rooms, classes), self.floor_code(rooms, classes))
        copies = math.ceil(FEW / max(1, min(int((classes < self.codec.classes).sum()), rooms.mask.numel())))
        everything, held = rooms.rows(torch.arange(len(classes)).repeat(copies)), classes.repeat(copies, 1)
        stand = poses.repeat(copies, 1)
        there = held < self.codec.classes
        layout = RaggedRooms.of(everything, there.sum(1), self.settings.heads)
        padding = (0, MOST_SLOTS - held.shape[1])  # to one number of slots, for sums over them to have the same bits
        code = self.floor_code(everything, nn.functional.pad(held, padding, value=self.codec.classes), layout)
        expect = self._expectation(held[there], stand[there], layout, code)

        def expect_padded(x: Tensor, level: float) -> Tensor:
            noisy = x.repeat(copies, 1, 1)
            return torch.zeros_like(noisy).masked_scatter_(there[..., None], expect(noisy[there], level))[: len(classes)]

        return expect_padded

    def _expectation(self, classes: Tensor, poses: Tensor, layout: BatchLayout, code: FloorCode) -> Expect:
        ones = torch.ones(len(code.room), device=classes.device)
        before: Tensor | None = None

        def expect(x: Tensor, level: float) -> Tensor:
            nonlocal before
            with torch.inference_mode():
                answer = self.answers(x, classes, level * ones, layout, code, before, poses)[-1]
                before = clamp_channels(self.clean(x, answer, *alpha_sigma_of(level)))
            return before

        return expect

    def clean(self, x: Tensor, answer: Tensor, alpha: Tensor | float, sigma: Tensor | float) -> Tensor:
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


def modulate(x: Tensor, shift: Tensor, scale: Tensor) -> Tensor:
    """Layer norm, then the scale and shift that the condition sets."""
    return torch.addcmul(shift, nn.functional.layer_norm(x, x.shape[-1:]), scale)
