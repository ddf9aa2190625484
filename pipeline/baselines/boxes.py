"""Upright rotated boxes in torch: areas, volumes and intersection over union, differentiable in all that describes a box."""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor

SLACK = 1e-5  # [m] by which sides that coincide are put apart
LEAST = 1e-6  # [m] a direction component below this is taken for none


class Boxes(NamedTuple):
    """Boxes (...): `centre` (..., 3), `half` (..., 3) [m] half extents, `axis` (..., 2) unit direction of the width.

    The front is (sin yaw, -cos yaw), with axis = (cos yaw, sin yaw).
    """

    centre: Tensor
    half: Tensor
    axis: Tensor

    def at(self, *index: Tensor) -> Boxes:
        """Take some boxes."""
        return Boxes(*(part[index] for part in self))

    @property
    def turn(self) -> Tensor:
        """Unit direction (..., 2) from front to back."""
        return torch.stack([-self.axis[..., 1], self.axis[..., 0]], -1)


def boxes_of(metric: Tensor) -> Boxes:
    """Read boxes from channels (..., 8): centre, size [m], cos, sin. Negative sizes are none."""
    axis = metric[..., 6:8]
    unit = axis / torch.linalg.vector_norm(axis, dim=-1, keepdim=True).clamp_min(1e-3)
    return Boxes(metric[..., :3], metric[..., 3:6].clamp_min(0) / 2, unit)


def extend_front(boxes: Boxes, opens: Tensor) -> Boxes:
    """Return the paper's b': boxes that open (...) have a third more depth, added at the front: h becomes h + h / 3."""
    more = torch.where(opens, boxes.half[..., 1] / 3, torch.zeros_like(boxes.half[..., 1]))
    centre = torch.cat([boxes.centre[..., :2] - boxes.turn * more[..., None], boxes.centre[..., 2:]], -1)
    return Boxes(centre, torch.stack([boxes.half[..., 0], boxes.half[..., 1] + more, boxes.half[..., 2]], -1), boxes.axis)


def shared_area(a: Boxes, b: Boxes) -> Tensor:
    """Return the area (...) [m2] that two footprints share.

    Green's theorem: the boundary of the intersection is what of a's boundary lies in b, and of b's in a. b is a hair
    larger than it is, so that sides that coincide lie apart.
    """
    b = b._replace(half=b.half + SLACK)
    return (_boundary(a, b, a.centre) + _boundary(b, a, a.centre)).clamp_min(0) / 2


def _boundary(a: Boxes, b: Boxes, origin: Tensor) -> Tensor:
    """Integrate x dy - y dx, seen from `origin`, along what of a's boundary lies in b's footprint."""
    signs = a.half.new_tensor([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    steps = signs[:, :1] * a.half[..., None, :1] * a.axis[..., None, :] + signs[:, 1:] * a.half[..., None, 1:2] * a.turn[..., None, :]
    start = a.centre[..., None, :2] + steps - origin[..., None, :2]
    along = start.roll(-1, -2) - start  # (..., 4, 2)
    frame = torch.stack([b.axis, b.turn], -1)
    place = (start - (b.centre - origin)[..., None, :2]) @ frame
    slope = along @ frame
    slope = torch.where(slope.abs() < LEAST, torch.full_like(slope, LEAST), slope)
    reach = b.half[..., None, :2]
    one, other = (-reach - place) / slope, (reach - place) / slope
    enter, leave = torch.minimum(one, other).amax(-1).clamp_min(0), torch.maximum(one, other).amin(-1).clamp_max(1)
    cross = start[..., 0] * along[..., 1] - start[..., 1] * along[..., 0]
    return ((leave - enter).clamp_min(0) * cross).sum(-1)


def iou(a: Boxes, b: Boxes) -> Tensor:
    """Return the intersection over union (...) of volumes."""
    top = torch.minimum(a.centre[..., 2] + a.half[..., 2], b.centre[..., 2] + b.half[..., 2])
    low = torch.maximum(a.centre[..., 2] - a.half[..., 2], b.centre[..., 2] - b.half[..., 2])
    shared = shared_area(a, b) * (top - low).clamp_min(0)
    ratio: Tensor = shared / (8 * (a.half.prod(-1) + b.half.prod(-1)) - shared).clamp_min(1e-9)
    return ratio


def overlaps(boxes: Boxes, others: Boxes, pairs: Tensor) -> Tensor:
    """Return the sum (B,) over chosen ordered pairs (B, N, M) of IoU3D(boxes_i (B, N), others_j (B, M)). Only pairs whose circles meet in plan are computed."""
    with torch.no_grad():
        own, theirs = (torch.linalg.vector_norm(each.half[..., :2], dim=-1) for each in (boxes, others))
        apart = torch.linalg.vector_norm(boxes.centre[:, :, None, :2] - others.centre[:, None, :, :2], dim=-1)
        room, i, j = torch.nonzero(pairs & (apart < own[:, :, None] + theirs[:, None]), as_tuple=True)
    ious = iou(boxes.at(room, i), others.at(room, j))
    return torch.zeros(len(pairs), dtype=ious.dtype, device=ious.device).index_add(0, room, ious)


def mates(occupied: Tensor) -> Tensor:
    """Return the ordered pairs (B, N, N) of different occupied slots (B, N)."""
    both = occupied[:, :, None] & occupied[:, None]
    return both & ~torch.eye(occupied.shape[1], dtype=torch.bool, device=occupied.device)
