"""PhyScene-type guidance: three penalties on the boxes, at the last levels of the chain (Yang et al. 2024; as its code has them).

L = 2 L_coll + 3e5 L_room + 100 L_reach, on the mean in scaled coordinates, at t < 10: mean <- mean + clip(-grad L, -0.1, 0.1).
Only the places in plan and the yaws move. The variance is not applied. L_coll takes boxes that open in their opened state,
a constant. All three are means over a room's objects; the peers' further division by the size of the batch
is left out, so that a room does not know who shares its batch.

L_reach: where the ways of a robot go through furniture, a robot stands there and pushes the furniture off. A raster per room. Ways lead from
the largest part of the free floor to the next one, and to the handle of everything that opens; they are the cheapest over a
map that is hot where boxes are.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import torch
from scipy import ndimage, sparse
from scipy.sparse import csgraph
from torch import Tensor

from pipeline.arrays import Floats, Ints
from pipeline.baselines.boxes import Boxes, boxes_of, extend_front, iou, mates, overlaps
from pipeline.baselines.rooms import BOX, Scaling
from pipeline.geometry.boxes import footprints
from pipeline.geometry.floor_raster import Mask, Raster

BELOW = 10  # of T = 1000
CLIP = 0.1  # largest change of a channel in one step
COLLISION, ROOM, REACH = 2 * 0.075, 3e5, 100.0  # weights
FAR = 50.0  # [m] depth and height of what lies beyond a wall
MOVES = (0, 1, 6, 7)  # channels that move: x, y, cos, sin
CELL = 0.05  # [m]
WIDTH, HEIGHT = 0.2, 1.5  # [m] of PhyScene's robot
SECOND = 0.03  # [m2] below which a second part of the floor is none
BASE = 0.01  # cost of a cell of free floor; of a cell amid boxes it is 1 more
EVERYWHERE = np.ones((3, 3), np.int64)  # cells hang together over corners too


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
            standing = Obstacles(centre, 2 * half, np.arctan2(axis[:, 1], axis[:, 0]), opens[room, occupied[room]].numpy())
            at = torch.from_numpy(robots(polygon, standing)).float()
            low = own.at(own.centre[:, 2] < HEIGHT)
            height, wide = torch.full_like(at[:, :1], HEIGHT / 2), torch.full_like(at, WIDTH / 2)
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


class Obstacles(NamedTuple):
    """Boxes (n): `centre` (n, 3), `size` (n, 3) full extents [m], `yaw` (n,), `opens` (n,)."""

    centre: Floats
    size: Floats
    yaw: Floats
    opens: Mask

    @property
    def front(self) -> Floats:
        """Unit direction (n, 2) of the front."""
        return np.stack([np.sin(self.yaw), -np.cos(self.yaw)], 1)


def robots(polygon: Floats, boxes: Obstacles) -> Floats:
    """Return the places (k, 2) [m] at which a robot would stand in furniture on its ways, one per robot's width of way."""
    kept = boxes.centre[:, 2] < HEIGHT
    low = Obstacles(boxes.centre[kept], boxes.size[kept], boxes.yaw[kept], boxes.opens[kept])
    if not len(low.yaw):
        return np.zeros((0, 2))
    raster = Raster.around([polygon], CELL)
    floor = raster.fill(raster.empty(), [polygon])
    more = np.where(low.opens, low.size[:, 1] / 3, 0.0)  # what opens has a third more depth at the front
    size = low.size[:, :2] + np.stack([np.zeros_like(more), more], 1)
    filled = raster.fill(raster.empty(), list(footprints(low.centre[:, :2] + low.front * more[:, None] / 2, low.yaw, size)))
    side = round(WIDTH / CELL) | 1
    stand = ndimage.binary_erosion(floor, np.ones((side, side)))
    free = stand & ~ndimage.binary_dilation(filled, np.ones((side, side)))
    labels, count = ndimage.label(free, EVERYWHERE)
    if not count:
        return np.zeros((0, 2))
    area = np.bincount(labels.ravel())[1:] * CELL**2
    ranked = np.argsort(-area, kind="stable") + 1
    start = middle_of(labels == ranked[0])
    goals = [middle_of(labels == ranked[1])] if count > 1 and area[ranked[1] - 1] > SECOND else []
    goals += [tuple(cell) for cell in raster.index(handles(low)).tolist()]
    heat = ndimage.gaussian_filter(filled.astype(float), WIDTH / CELL)
    crossings = []
    for way in ways(np.where(stand, BASE + heat, BASE + 1.0), start, goals):
        through = way[filled[way[:, 0], way[:, 1]]]
        crossings.append(through[:: max(1, round(WIDTH / CELL))])
    cells = np.concatenate([*crossings, np.zeros((0, 2), np.int64)])
    return np.asarray(raster.origin + (cells + 0.5) * CELL, float)


def handles(boxes: Obstacles) -> Floats:
    """Return where a robot stands (k, 2) [m] to use each of the k boxes that open: before the opened front."""
    ahead = boxes.size[:, 1] * (1 / 2 + 1 / 3) + WIDTH / 2 + CELL
    return np.asarray((boxes.centre[:, :2] + boxes.front * ahead[:, None])[boxes.opens], float)


def middle_of(part: Mask) -> tuple[int, int]:
    """Return the cell of a part of the floor that is farthest from its edge."""
    i, j = np.unravel_index(int(ndimage.distance_transform_edt(np.pad(part, 1))[1:-1, 1:-1].argmax()), part.shape)
    return int(i), int(j)


def ways(cost: Floats, start: tuple[int, int], goals: list[tuple[int, int]]) -> list[Ints]:
    """Return the cheapest ways (length, 2) over a cost map (x, y) from the start to each goal, by Dijkstra's algorithm.

    A step to a neighbour, diagonals included, costs its length times the mean of the two cells. (PhyScene runs A* with
    a bound on its steps; the ways are the same where that suffices.)
    """
    if not goals:
        return []
    wide = cost.shape[1]
    cells = np.arange(cost.size).reshape(cost.shape)
    one, other, price = [], [], []
    for dx, dy in ((1, 0), (0, 1), (1, 1), (1, -1)):
        a = (slice(0, cost.shape[0] - dx), slice(max(0, -dy), wide - max(0, dy)))
        b = (slice(dx, None), slice(max(0, dy), wide - max(0, -dy)))
        one.append(cells[a].ravel())
        other.append(cells[b].ravel())
        price.append((np.hypot(dx, dy) * (cost[a] + cost[b]) / 2).ravel())
    graph = sparse.coo_array((np.concatenate(price), (np.concatenate(one), np.concatenate(other))), shape=(cost.size, cost.size)).tocsr()
    _, before = csgraph.dijkstra(graph, directed=False, indices=int(cells[start]), return_predecessors=True)
    paths = []
    for goal in goals:
        way = [int(cells[goal])]
        while before[way[-1]] >= 0:
            way.append(int(before[way[-1]]))
        paths.append(np.stack(np.divmod(np.array(way, np.int64), wide), 1))
    return paths
