"""Geometric features of pairs: every object against every wall or opening, and against every other object.

All take the boxes as the noise lets us guess them: position alpha * x_t in metres (the mean of x_0 under a unit normal
prior), so that at high noise they say "somewhere in the middle" and at low noise where the side of a box is against a
wall to the centimetre. Distances are squashed at two scales, so that both the room and the last centimetres show, and
once more in units of the noise itself: for a side that belongs at a wall, the gap divided by the noise is the noise that
is to be predicted, at every level alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from pipeline.diffusion.batch import RoomBatch

WALL_FEATURES = 14
PAIR_FEATURES = 22
WALL_NOISE = 5  # features in units of the noise
PAIR_NOISE = 10
WALL_MOVES, WALL_TURNS, PAIR_MOVES, PAIR_TURNS = 6, 4, 11, 4


@dataclass(frozen=True, slots=True)
class Boxes:
    """B x N boxes, room frame: `centre` (B, N, 2), `bottom`, `height` (B, N), `half` (B, N, 2) [m]; `axis` (B, N, 2) = (cos, sin) of yaw.

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
    """What is known of pairs (B, N, K): `far` (..., F) squashed lengths and angles, `near` (..., G) in units of the noise.

    `moves` (B, N, K, P, 2) and `turns` (B, N, K, Q, 2) are directions that a pair offers for the position and the axis of
    the first; those that would close a gap are as long as the gap in units of the noise, up to 3.
    """

    far: Tensor
    near: Tensor
    moves: Tensor
    turns: Tensor


def wall_relations(boxes: Boxes, rooms: RoomBatch, blur: Tensor) -> Relations:
    """Relate each box to each wall or opening (K = M). `blur` (B, 2) is the noise of a position [m] and of an axis."""
    start, stop = rooms.ends[:, None, :, 0], rooms.ends[:, None, :, 1]
    normal = rooms.normal[:, None]
    along = torch.stack([normal[..., 1], -normal[..., 0]], -1)
    centre = boxes.centre[:, :, None]
    distance = ((centre - start) * normal).sum(-1)
    before, after = ((centre - start) * along).sum(-1), ((stop - centre) * along).sum(-1)
    side, facing = (boxes.axis[:, :, None] * normal).sum(-1), (boxes.front[:, :, None] * normal).sum(-1)
    half = boxes.half[:, :, None]
    deep, wide = half[..., 0] * side.abs() + half[..., 1] * facing.abs(), half[..., 0] * facing.abs() + half[..., 1] * side.abs()
    gap = distance - deep
    columns = [
        distance / 3, torch.tanh(distance), torch.tanh(gap / 0.08), torch.tanh(gap / 0.4), before / 3, after / 3,
        torch.tanh((before - wide) / 0.15), torch.tanh((after - wide) / 0.15), torch.tanh(before), torch.tanh(after), facing, side,
        boxes.bottom[:, :, None].expand_as(distance) / 2, boxes.height[:, :, None].expand_as(distance) / 2,
    ]  # fmt: skip
    metres, ends = blur[:, None, None, 0], blur[:, None, None, 1]
    off = in_noise([gap / metres, (before - wide) / metres, (after - wide) / metres])
    near = torch.cat([off, in_noise([side / ends, facing / ends])], -1)
    normals, alongs = normal.expand_as(centre - start), along.expand_as(centre - start)
    middle = ((start + stop) / 2 - centre) / 3
    moves = [off[..., 0:1] * normals, off[..., 1:2] * alongs, off[..., 2:3] * alongs, normals, alongs, middle]
    turns = [near[..., 3:4] * normals, near[..., 4:5] * alongs, normals, alongs]
    return Relations(torch.stack(columns, -1), near / 3, torch.stack(moves, -2), torch.stack(turns, -2))


def pair_relations(boxes: Boxes, blur: Tensor) -> Relations:
    """Relate each box i (second dimension) to every box j (third)."""
    apart = boxes.centre[:, None] - boxes.centre[:, :, None]
    axis, front, half = boxes.axis, boxes.front, boxes.half
    axis_i, front_i, axis_j, front_j = axis[:, :, None], front[:, :, None], axis[:, None], front[:, None]
    places = [(apart * d).sum(-1) for d in (axis_i, front_i, axis_j, front_j)]
    same, turned = (axis_i * axis_j).sum(-1), (axis_i * front_j).sum(-1)
    w_i, d_i, w_j, d_j = half[:, :, None, 0], half[:, :, None, 1], half[:, None, :, 0], half[:, None, :, 1]
    gaps = [
        places[0].abs() - w_i - w_j * same.abs() - d_j * turned.abs(),
        places[1].abs() - d_i - d_j * same.abs() - w_j * turned.abs(),
        places[2].abs() - w_j - w_i * same.abs() - d_i * turned.abs(),
        places[3].abs() - d_j - d_i * same.abs() - w_i * turned.abs(),
    ]
    rise = boxes.bottom[:, None] - boxes.bottom[:, :, None]
    above = torch.maximum(rise - boxes.height[:, :, None], -rise - boxes.height[:, None])
    columns = [
        *(v / 2 for v in places), *(torch.tanh(v / 0.3) for v in places),
        *(torch.tanh(g / 0.08) for g in gaps), *(torch.tanh(g / 0.4) for g in gaps), same, turned, rise / 2, torch.tanh(above / 0.2),
        torch.linalg.vector_norm(apart + 1e-6, dim=-1) / 3, boxes.height[:, None].expand_as(rise) / 2,
    ]  # fmt: skip
    metres, ends = blur[:, None, None, 0], blur[:, None, None, 1]
    off = in_noise([*(g / metres for g in gaps), *(v / metres for v in places)])
    near = torch.cat([off, in_noise([same / ends, turned / ends])], -1)
    ways = [d.expand_as(apart) for d in (axis_i, front_i, axis_j, front_j)]
    closing = [off[..., k : k + 1] * (places[k] / 0.05).clamp(-1, 1)[..., None] * ways[k] for k in range(4)]
    centring = [off[..., 4 + k : 5 + k] * ways[k] for k in range(4)]
    moves = [*closing, *centring, ways[2], ways[3], apart / 3]
    turns = [near[..., 8:9] * ways[2], near[..., 9:10] * ways[3], ways[2], ways[3]]
    return Relations(torch.stack(columns, -1), near / 3, torch.stack(moves, -2), torch.stack(turns, -2))


def in_noise(values: list[Tensor]) -> Tensor:
    """Stack multiples of the noise, cut at 3: what is farther away is not a matter of noise."""
    return torch.stack(values, -1).clamp(-3, 3)


def axis_deviations(boxes: Boxes, rooms: RoomBatch, blur: Tensor) -> Tensor:
    """Return how far each box's axis is from the nearest of its room's directions (B, N, 2), in units of the noise, up to 3.

    The room's directions are the normals of its walls; the nearest is taken for each box.
    """
    fits = boxes.axis @ rooms.normal.transpose(1, 2)  # (B, N, M)
    fits = fits.masked_fill(~rooms.walls[:, None], -9.0)
    nearest = torch.take_along_dim(rooms.normal, fits.argmax(-1)[..., None], 1)
    off = (boxes.axis - nearest) / blur[:, None, 1:]
    length: Tensor = torch.linalg.vector_norm(off + 1e-9, dim=-1, keepdim=True)
    shortened: Tensor = off * (3 / length).clamp_max(1.0)
    return shortened
