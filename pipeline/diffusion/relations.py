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

WALL_FEATURES = 16
PAIR_FEATURES = 24
WALL_NOISE = 5  # features in units of the noise
PAIR_NOISE = 8


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


def wall_features(boxes: Boxes, rooms: RoomBatch, blur: Tensor) -> tuple[Tensor, Tensor]:
    """Return features (B, N, M, 16) of each box against each wall or opening, and (B, N, M, 5) in units of the noise.

    `blur` (B, 2) is the noise of a position [m] and of an axis' end.
    """
    start, stop = rooms.ends[:, None, :, 0], rooms.ends[:, None, :, 1]
    normal = rooms.normal[:, None]
    along = torch.stack([normal[..., 1], -normal[..., 0]], -1)
    centre = boxes.centre[:, :, None]
    distance = ((centre - start) * normal).sum(-1)
    before, after = ((centre - start) * along).sum(-1), ((stop - centre) * along).sum(-1)
    side = (boxes.axis[:, :, None] * normal).sum(-1)
    facing = (boxes.front[:, :, None] * normal).sum(-1)
    half = boxes.half[:, :, None]
    deep = half[..., 0] * side.abs() + half[..., 1] * facing.abs()
    wide = half[..., 0] * facing.abs() + half[..., 1] * side.abs()
    gap = distance - deep
    columns = [
        distance / 3, torch.tanh(distance), torch.tanh(gap / 0.08), torch.tanh(gap / 0.4), before / 3, after / 3,
        torch.tanh((before - wide) / 0.15), torch.tanh((after - wide) / 0.15), torch.tanh(before), torch.tanh(after),
        facing, side, normal[..., 0].expand_as(distance), normal[..., 1].expand_as(distance),
        boxes.bottom[:, :, None].expand_as(distance) / 2, boxes.height[:, :, None].expand_as(distance) / 2,
    ]  # fmt: skip
    metres, ends = 2 * blur[:, None, None, 0], 2 * blur[:, None, None, 1]
    near = [gap / metres, (before - wide) / metres, (after - wide) / metres, side / ends, facing / ends]
    return torch.stack(columns, -1), torch.tanh(torch.stack(near, -1))


def pair_features(boxes: Boxes, blur: Tensor) -> tuple[Tensor, Tensor]:
    """Return features (B, N, N, 24) of box j (second) as seen from box i (first), and (B, N, N, 8) in units of the noise."""
    apart = boxes.centre[:, None] - boxes.centre[:, :, None]
    axis, front, half = boxes.axis, boxes.front, boxes.half
    along_i, front_i = (apart * axis[:, :, None]).sum(-1), (apart * front[:, :, None]).sum(-1)
    along_j, front_j = -(apart * axis[:, None]).sum(-1), -(apart * front[:, None]).sum(-1)
    same = (axis[:, :, None] * axis[:, None]).sum(-1)
    turned = (axis[:, :, None] * front[:, None]).sum(-1)
    w_i, d_i, w_j, d_j = half[:, :, None, 0], half[:, :, None, 1], half[:, None, :, 0], half[:, None, :, 1]
    gaps = [
        along_i.abs() - w_i - w_j * same.abs() - d_j * turned.abs(),
        front_i.abs() - d_i - d_j * same.abs() - w_j * turned.abs(),
        along_j.abs() - w_j - w_i * same.abs() - d_i * turned.abs(),
        front_j.abs() - d_j - d_i * same.abs() - w_i * turned.abs(),
    ]
    rise = boxes.bottom[:, None] - boxes.bottom[:, :, None]
    above = torch.maximum(rise - boxes.height[:, :, None], -rise - boxes.height[:, None])
    columns = [
        apart[..., 0] / 3, apart[..., 1] / 3, along_i / 2, front_i / 2, along_j / 2, front_j / 2,
        *(torch.tanh(v / 0.3) for v in (along_i, front_i, along_j, front_j)),
        *(torch.tanh(g / 0.08) for g in gaps), *(torch.tanh(g / 0.4) for g in gaps),
        same, turned, rise / 2, torch.tanh(above / 0.2),
        torch.linalg.vector_norm(apart + 1e-6, dim=-1) / 3, boxes.height[:, None].expand_as(rise) / 2,
    ]  # fmt: skip
    metres, ends = 2 * blur[:, None, None, 0], 2 * blur[:, None, None, 1]
    near = [*(g / metres for g in gaps), along_i / metres, front_i / metres, same / ends, turned / ends]
    return torch.stack(columns, -1), torch.tanh(torch.stack(near, -1))
