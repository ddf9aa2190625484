"""PhyScene-type guidance: three penalties on the boxes, at the last levels of the chain (Yang et al. 2024; as its code has them).

L = 2 L_coll + 3e5 L_room + 100 L_reach, on the mean in scaled coordinates, at t < 10: mean <- mean + clip(-grad L, -0.1, 0.1).
Only the places in plan and the yaws move. The variance is not applied. L_coll takes boxes that open in their opened state,
a constant. All three are means over a room's objects; the peers' further division by the size of the batch
is left out, so that a room does not know who shares its batch.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from pipeline.arrays import Floats
from pipeline.baselines import reachability
from pipeline.baselines.boxes import Boxes, boxes_of, extend_front, iou, mates, overlaps
from pipeline.baselines.rooms import BOX, Scaling

BELOW = 10  # of T = 1000
CLIP = 0.1  # largest change of a channel in one step
COLLISION, ROOM, REACH = 2 * 0.075, 3e5, 100.0  # weights
FAR = 50.0  # [m] depth and height of what lies beyond a wall
MOVES = (0, 1, 6, 7)  # channels that move: x, y, cos, sin


@dataclass(frozen=True, slots=True)
class Guidance:
    """The three terms for a batch of rooms: their `polygons` (n, 2) [m, room frame], counter-clockwise, and which classes open (C,)."""

    scaling: Scaling
    polygons: Sequence[Floats]
    opens: Tensor
    below: int = BELOW

    def __call__(self, mean: Tensor, t: int, _variance: float) -> Tensor:
        """Return the shift of the mean (B, N, D) at level t."""
        shift = torch.zeros_like(mean)
        if t >= self.below:
            return shift
        boxes = mean[..., :BOX].detach().clone().requires_grad_()
        occupied = self.scaling.occupied(mean)
        with torch.enable_grad():
            total = self.penalty(self.scaling.metric(boxes), occupied, self.opens[self.scaling.labels(mean)] & occupied)
            (slope,) = torch.autograd.grad(total.sum(), boxes)
        moves = list(MOVES)
        shift[..., moves] = -slope[..., moves].clamp(-CLIP, CLIP)
        return shift

    def penalty(self, metric: Tensor, occupied: Tensor, opens: Tensor) -> Tensor:
        """Return L (B,) of boxes (B, N, 8) [m]."""
        boxes = boxes_of(metric)
        count = occupied.sum(1).clamp_min(1)
        opened = Boxes(  # what opens is a constant, and what it meets is pushed
            *(torch.where(opens[..., None], wide.detach(), own) for wide, own in zip(extend_front(boxes, opens), boxes, strict=True))
        )
        collision = overlaps(opened, boxes, mates(occupied)) / count
        outside = self.outside(boxes, occupied) / count
        return COLLISION * collision + ROOM * outside + REACH * self.way_overlap(boxes, occupied, opens) / count

    def outside(self, boxes: Boxes, occupied: Tensor) -> Tensor:
        """Return the sum (B,) of IoU3D of objects with what lies beyond each wall."""
        walls = [beyond(polygon) for polygon in self.polygons]
        most = max(len(w) for w in walls)
        padded = torch.zeros(len(walls), most, BOX)
        for i, own in enumerate(walls):
            padded[i, : len(own)] = torch.from_numpy(own).float()
        there = padded[..., 3] > 0
        return overlaps(boxes, boxes_of(padded), occupied[:, :, None] & there[:, None])

    def way_overlap(self, boxes: Boxes, occupied: Tensor, opens: Tensor) -> Tensor:
        """Return the sum (B,) of IoU3D of low objects with robots on ways that furniture stands on."""
        totals = []
        for room, polygon in enumerate(self.polygons):
            own = boxes.at(torch.tensor(room), occupied[room])
            centre, half, axis = (part.detach().double().numpy() for part in own)
            yaw = np.arctan2(axis[:, 1], axis[:, 0])
            at = torch.from_numpy(
                reachability.robots(polygon, reachability.Boxes(centre, 2 * half, yaw, opens[room, occupied[room]].numpy()))
            ).float()
            low = own.at(own.centre[:, 2] < reachability.HEIGHT)
            height = torch.full_like(at[:, :1], reachability.HEIGHT / 2)
            wide = torch.full_like(at, reachability.WIDTH / 2)
            robot = Boxes(torch.cat([at, height], -1), torch.cat([wide, height], -1), torch.tensor([1.0, 0.0]).expand_as(at))
            pairs = iou(low.at(torch.arange(len(low.centre))[:, None]), robot.at(torch.arange(len(at))[None]))
            totals.append(pairs.sum())
        return torch.stack(totals)


def beyond(polygon: Floats) -> Floats:
    """Return what lies beyond the walls of a polygon (n, 2): boxes (n, 8), 50 m high, 50 m deep or up to the next wall.

    PhyScene's are unturned and so for rooms whose walls are; these turn with their walls.
    """
    start, stop = polygon, np.roll(polygon, -1, 0)
    length = np.linalg.norm(stop - start, axis=1)
    along = (stop - start) / np.maximum(length, 1e-9)[:, None]
    outward = np.stack([along[:, 1], -along[:, 0]], 1)
    depth = np.array([_depth(k, start, stop, along, outward) for k in range(len(polygon))])
    centre = (start + stop) / 2 + outward * depth[:, None] / 2
    upright = np.stack([np.zeros(len(polygon)), length, depth, np.full(len(polygon), FAR)], 1)
    return np.concatenate([centre, upright, along], 1)


def _depth(k: int, start: Floats, stop: Floats, along: Floats, outward: Floats) -> float:
    """Return how far it is from wall k outward to a wall of the same room that lies before it, at most FAR."""
    ends = np.stack([start, stop], 1) - start[k]
    side, ahead = ends @ along[k], ends @ outward[k]
    wide = float((stop[k] - start[k]) @ along[k])
    meets = (np.minimum(side[:, 0], side[:, 1]) < wide - 1e-6) & (np.maximum(side[:, 0], side[:, 1]) > 1e-6)
    meets &= ahead.min(1) > 1e-6
    return float(min(ahead.min(1)[meets], default=FAR))
