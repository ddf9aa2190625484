"""Geometric features of pairs: every object against every wall or opening, and against every other object.

All take the boxes as the noise lets us guess them: position alpha * x_t in metres (the mean of x_0 under a unit normal
prior), so that at high noise they say "somewhere in the middle" and at low noise where the side of a box is against a
wall to the centimetre. Distances are squashed at two scales, so that both the room and the last centimetres show, and
once more in units of the noise itself: for a side that belongs at a wall, the gap divided by the noise is the noise that
is to be predicted, at every level alike.
"""

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.context import KINDS

WALL_FEATURES = 14
PAIR_FEATURES = 22
WALL_NOISE = 5  # features in units of the noise
PAIR_NOISE = 10
WALL_MOVES, WALL_TURNS, PAIR_MOVES, PAIR_TURNS = 6, 4, 11, 4
FAR = 3.0  # in units of the noise: what is farther away is not a matter of noise


@dataclass(frozen=True, slots=True)
class Boxes:
    """B x N boxes, or T of a list, room frame: `centre` (B, N, 2), `bottom`, `height` (B, N), `half` (B, N, 2) [m]; `axis` (B, N, 2) = (cos, sin) of yaw.

    `axis` is the direction of the width; the front is (sin, -cos). It is as long as the yaw is certain.
    """

    centre: Tensor
    half: Tensor
    bottom: Tensor
    height: Tensor
    axis: Tensor

    @property
    def front(self) -> Tensor:
        """Direction (B, N, 2) of the front."""
        return torch.stack([self.axis[..., 1], -self.axis[..., 0]], -1)


def boxes_of(metric: Tensor) -> Boxes:
    """Read boxes from metric channels (B, N, >= 8): position, size, cos, sin."""
    return Boxes(metric[..., :2], metric[..., 3:5].clamp_min(0.02) / 2, metric[..., 2], metric[..., 5].clamp_min(0.02), metric[..., 6:8])


@dataclass(frozen=True, slots=True)
class Relations:
    """What is known of pairs (B, N, K), or (P,) of a list of them: `far` (..., F) squashed lengths and angles, `near` (..., G) in units of the noise.

    `offers` (..., 2 (P + Q)): P directions that a pair offers for the position of the first, then Q for its axis; those that would
    close a gap are as long as the gap in units of the noise, up to FAR. Of walls and openings `kind` (..., KINDS) says what they are, as 0 and 1.
    """

    far: Tensor
    near: Tensor
    offers: Tensor
    kind: Tensor | None = None

    @property
    def features(self) -> Tensor:
        """All that is known (..., F + G), and of walls and openings (..., F + G + KINDS)."""
        return torch.cat([self.far, self.near, *(() if self.kind is None else (self.kind,))], -1)


def wall_relations(boxes: Boxes, rooms: RoomBatch, blur: Tensor) -> Relations:
    """Relate each box to each wall or opening (K = M). `blur` (B, 2) is the noise of a position [m] and of an axis."""
    start, stop = rooms.ends[:, None, :, 0], rooms.ends[:, None, :, 1]
    normal = rooms.normal[:, None]
    along = torch.stack([normal[..., 1], -normal[..., 0]], -1)
    centre = boxes.centre[:, :, None]
    distance = dot(centre - start, normal)
    before, after = dot(centre - start, along), dot(stop - centre, along)
    side, facing = dot(boxes.axis[:, :, None], normal), dot(boxes.front[:, :, None], normal)
    half = boxes.half[:, :, None]
    deep, wide = half[..., 0] * side.abs() + half[..., 1] * facing.abs(), half[..., 0] * facing.abs() + half[..., 1] * side.abs()
    gap = distance - deep
    columns = [
        distance / 3, torch.tanh(distance), torch.tanh(gap / 0.08), torch.tanh(gap / 0.4), before / 3, after / 3,
        torch.tanh((before - wide) / 0.15), torch.tanh((after - wide) / 0.15), torch.tanh(before), torch.tanh(after), facing, side,
        boxes.bottom[:, :, None].expand_as(distance) / 2, boxes.height[:, :, None].expand_as(distance) / 2,
    ]  # fmt: skip
    near = in_noise(torch.stack([gap, before - wide, after - wide], -1), torch.stack([side, facing], -1), blur)
    normals, alongs = normal.expand_as(centre - start), along.expand_as(centre - start)
    middle = ((start + stop) / 2 - centre) / 3
    moves = [near[..., :1] * normals, near[..., 1:2] * alongs, near[..., 2:3] * alongs, normals, alongs, middle]
    turns = [near[..., 3:4] * normals, near[..., 4:5] * alongs, normals, alongs]
    kind = nn.functional.one_hot(rooms.kind, len(KINDS)).float()[:, None].expand(-1, distance.shape[1], -1, -1)
    return Relations(torch.stack(columns, -1), near / FAR, torch.cat([*moves, *turns], -1), kind)


def pair_relations(boxes: Boxes, blur: Tensor) -> Relations:
    """Relate each box i (second dimension) to every box j (third)."""
    apart = boxes.centre[:, None] - boxes.centre[:, :, None]
    frames = torch.stack([boxes.axis, boxes.front], -2)
    others = frames[:, None].expand(*apart.shape[:3], 2, 2)
    ways = torch.cat([frames[:, :, None].expand_as(others), others], -2)  # axis and front of i, axis and front of j
    places = dot(apart[..., None, :], ways)
    angles = dot(boxes.axis[:, :, None, None], others)  # same, turned
    half_i, half_j = boxes.half[:, :, None].expand_as(apart), boxes.half[:, None].expand_as(apart)
    own, wide, deep = (torch.cat(pair, -1) for pair in ((half_i, half_j), (half_j, half_i), (half_j.flip(-1), half_i.flip(-1))))
    same, turned = angles.abs().split(1, -1)
    gaps = places.abs() - own - wide * same - deep * turned
    rise = boxes.bottom[:, None] - boxes.bottom[:, :, None]
    above = torch.maximum(rise - boxes.height[:, :, None], -rise - boxes.height[:, None])
    distance = torch.linalg.vector_norm(apart + 1e-6, dim=-1)
    upright = [rise / 2, torch.tanh(above / 0.2), distance / 3, boxes.height[:, None].expand_as(rise) / 2]
    columns = [
        places / 2, torch.tanh(places / 0.3), torch.tanh(gaps / 0.08), torch.tanh(gaps / 0.4), angles, torch.stack(upright, -1),
    ]  # fmt: skip
    near = in_noise(torch.cat([gaps, places], -1), angles, blur)
    closing = (near[..., :4] * (places / 0.05).clamp(-1, 1))[..., None] * ways
    moves = [closing, near[..., 4:8, None] * ways, others, apart[..., None, :] / 3]
    turns = [near[..., 8:, None] * others, others]
    return Relations(torch.cat(columns, -1), near / FAR, torch.cat([*moves, *turns], -2).flatten(3))


def dot(a: Tensor, b: Tensor) -> Tensor:
    """Return products of vectors (..., 2): for two numbers a sum is slower than an addition."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]


def in_noise(lengths: Tensor, angles: Tensor, blur: Tensor) -> Tensor:
    """Return lengths (B, N, K, P) [m] and angles (B, N, K, Q) in units of the noise (B, 2), cut at FAR."""
    return torch.cat([lengths / blur[:, None, None, :1], angles / blur[:, None, None, 1:]], -1).clamp(-FAR, FAR)


def axis_deviations(boxes: Boxes, rooms: RoomBatch, blur: Tensor) -> Tensor:
    """Return how far each box's axis is from the nearest of its room's directions (B, N, 2), in units of the noise, up to FAR.

    The room's directions are the normals of its walls; the nearest is taken for each box.
    """
    fits = boxes.axis @ rooms.normal.transpose(1, 2)  # (B, N, M)
    fits = fits.masked_fill(~rooms.walls[:, None], -9.0)
    nearest = torch.take_along_dim(rooms.normal, fits.argmax(-1)[..., None], 1)
    return shortened((boxes.axis - nearest) / blur[:, None, 1:])


def shortened(off: Tensor) -> Tensor:
    """Return vectors (..., 2), no longer than FAR."""
    length: Tensor = torch.linalg.vector_norm(off + 1e-9, dim=-1, keepdim=True)
    short: Tensor = off * (FAR / length).clamp_max(1.0)
    return short
