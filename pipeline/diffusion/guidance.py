"""Guidance: the constraint functions phi, and how what a sampling step expects is moved so that they go down.

phi are penalties: lower is better, differentiable in the slots they judge. The paper prints the guidance as mu + lambda Sigma grad phi, with phi a
loss (a cross-entropy, a sum of overlaps). Followed to the letter that CLIMBS the penalty. Everything here that is called a
`descent` is therefore -grad phi, and is added, times a step length. Sigma is 1e-4 and less in the paper's window and would
only rescale lambda: step lengths are given in the unit of what moves, and clipped. It is the expected x0 that is moved, and so the mean of
the step with it; a later step can then bring back what the guidance has torn apart.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import torch
from torch import Tensor

from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.codec import SHAPE, SIZE, YAW, Codec
from pipeline.diffusion.context import KINDS, Library
from pipeline.diffusion.relations import Boxes, boxes_of
from pipeline.diffusion.schedule import lambda_of
from pipeline.diffusion.settings import SampleSettings

CLEARANCE = 0.45  # [m] kept free at a doorway whose leaf does not turn into the room
DEEP = 0.04  # [m] from which depth on a push grows no further: squares would share an overlap out along a row that is too full
PRESSED = 0.01  # [m] of overlap that is left where a smaller asset is asked for
LEAF_HEIGHT = 2.0  # [m] a door leaf and a person need that much
EIGHT = ((-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (0, 1), (-1, 0), (1, 0))  # corners and side middles, in halves of the sides


class Prisms(NamedTuple):
    """Upright rotated boxes (..., K): `centre`, `half` (..., K, 2), `axis` (..., K, 2) unit width direction, `low`, `high` [m]."""

    centre: Tensor
    half: Tensor
    axis: Tensor
    low: Tensor
    high: Tensor


def bodies(boxes: Boxes) -> Prisms:
    """Return each slot's own box, its yaw direction made unit."""
    axis = boxes.axis / torch.linalg.vector_norm(boxes.axis, dim=-1, keepdim=True).clamp_min(1e-3)
    return Prisms(boxes.centre, boxes.half, axis, boxes.bottom, boxes.bottom + boxes.height)


def swept(body: Prisms, sweeps: Tensor) -> tuple[Prisms, Tensor]:
    """Place what joints sweep: boxes (B, N, K, 2, 3) in the object frame to prisms (B, N, K) and a mask of those that exist.

    Without gradient through the boxes themselves: a slot moves and turns with its sweep.
    """
    there = torch.isfinite(sweeps).all(-1).all(-1)
    boxes = torch.nan_to_num(sweeps)
    middle, half = boxes.mean(-2), (boxes[..., 1, :] - boxes[..., 0, :]) / 2
    axis = body.axis[:, :, None].expand(*there.shape, 2)
    depth = torch.stack([-axis[..., 1], axis[..., 0]], -1)  # object y: from front to back
    centre = body.centre[:, :, None] + middle[..., :1] * axis + middle[..., 1:2] * depth
    low = body.low[:, :, None] + middle[..., 2] - half[..., 2]
    return Prisms(centre, half[..., :2], axis, low, low + 2 * half[..., 2]), there


def heuristic_sweeps(size: Tensor, opens: Tensor) -> Tensor:
    """Return the paper's stand-in for joints (B, N, 1, 2, 3): the box grows by a third of its depth to the front.

    `size` (B, N, 3) [m]; `opens` (B, N) says which classes count as articulated. Depth h becomes h + h / 3.
    """
    w, d, h = size.unbind(-1)
    low = torch.stack([-w / 2, -d / 2 - d / 3, torch.zeros_like(h)], -1)
    high = torch.stack([w / 2, d / 2, h], -1)
    box = torch.stack([low, high], -2)[:, :, None]
    return torch.where(opens[:, :, None, None, None], box, torch.full_like(box, torch.nan))


def doorways(rooms: RoomBatch) -> tuple[Prisms, Tensor]:
    """Return what must stay free before doors (B, M) and its mask: the square around the leaf's quarter disc, or a strip."""
    start, stop = rooms.ends[:, :, 0], rooms.ends[:, :, 1]
    width = torch.linalg.vector_norm(stop - start + 1e-9, dim=-1)
    depth = torch.where(rooms.hinge >= 0, width, torch.full_like(width, CLEARANCE))
    along = torch.stack([rooms.normal[..., 1], -rooms.normal[..., 0]], -1)
    centre = (start + stop) / 2 + rooms.normal * depth[..., None] / 2
    doors = torch.zeros_like(rooms.mask)
    for name in ("door", "open", "portal", "entrance"):
        doors |= rooms.kind == KINDS.index(name)
    low = torch.zeros_like(width)
    return Prisms(centre, torch.stack([width, depth], -1) / 2, along, low, low + LEAF_HEIGHT), doors & rooms.mask


def overlap(a: Prisms, b: Prisms) -> Tensor:
    """Return how deep the prisms overlap [m], 0 where they do not; a and b broadcast.

    Separating axes: the least push along one of the four side directions that parts the footprints; counted only where
    the heights overlap, with a ramp over the first 5 cm. A true depth, unlike IoU, does not fade when one box swallows
    the other, and its gradient is the unit direction of the push; both have the same zeros.
    """
    apart = b.centre - a.centre
    turn_a, turn_b = torch.stack([-a.axis[..., 1], a.axis[..., 0]], -1), torch.stack([-b.axis[..., 1], b.axis[..., 0]], -1)
    same = (a.axis * b.axis).sum(-1).abs()
    cross = (a.axis * turn_b).sum(-1).abs()
    (wa, da), (wb, db) = a.half.unbind(-1), b.half.unbind(-1)
    depth = torch.stack(
        [
            wa + wb * same + db * cross - (apart * a.axis).sum(-1).abs(),
            da + wb * cross + db * same - (apart * turn_a).sum(-1).abs(),
            wb + wa * same + da * cross - (apart * b.axis).sum(-1).abs(),
            db + wa * cross + da * same - (apart * turn_b).sum(-1).abs(),
        ],
        -1,
    ).amin(-1)
    rise = torch.minimum(a.high, b.high) - torch.maximum(a.low, b.low)
    return depth.clamp_min(0) * (rise.detach() / 0.05).clamp(0, 1)


def outside(prisms: Prisms, rooms: RoomBatch, owner: Tensor) -> Tensor:
    """Return half the squared distances [m2] by which corners and side middles of prisms (L,) lie out of their rooms `owner` (L,), summed."""
    steps = torch.tensor(EIGHT, dtype=prisms.half.dtype, device=prisms.half.device)
    depth = torch.stack([-prisms.axis[:, 1], prisms.axis[:, 0]], -1)
    w, d = prisms.half[:, None, :1], prisms.half[:, None, 1:]
    points = prisms.centre[:, None] + steps[:, :1] * prisms.axis[:, None] * w + steps[:, 1:] * depth[:, None] * d
    start, edge, there = rooms.ends[:, :, 0], rooms.ends[:, :, 1] - rooms.ends[:, :, 0], rooms.walls
    with torch.no_grad():
        ay, ey, at = start[owner][:, None, :, 1], edge[owner][:, None, :, 1], points[:, :, None]
        crosses = (ay > at[..., 1]) != (ay + ey > at[..., 1])
        x = start[owner][:, None, :, 0] + edge[owner][:, None, :, 0] * (at[..., 1] - ay) / torch.where(ey == 0, torch.ones_like(ey), ey)
        inside = (crosses & (at[..., 0] < x) & there[owner][:, None]).sum(-1) % 2 == 1
    thing, corner = torch.nonzero(~inside, as_tuple=True)  # distances matter for points beyond the walls alone, and these are few
    room, point = owner[thing], points[thing, corner][:, None]
    a, along = start[room], edge[room]
    place = (((point - a) * along).sum(-1) / (along**2).sum(-1).clamp_min(1e-6)).clamp(0, 1)
    away = point - a - place[..., None] * along
    squared = (away**2).sum(-1).masked_fill(~there[room], 1e6).amin(-1)  # a side of a box has two corners or more beyond a wall
    return torch.zeros_like(prisms.low).index_add(0, thing, squared / 2)


def articulated_collision(boxes: Boxes, occupied: Tensor, sweeps: Tensor | None, rooms: RoomBatch, tucked: Tensor | None = None) -> Tensor:
    """Return phi_articoll (B,) of B rooms [m2]: how deep bodies and what their joints sweep reach into each other.

    Paper eq. articoll sums IoU(b'_i, b_j) over ordered pairs, b' the extended state. Here b' is the body and, per joint,
    the box that it really sweeps (`sweeps` (B, N, K, 2, 3), None for bodies alone); in place of the IoU stands half the
    square of the depth (see `overlap`), whose descent is the depth itself, DEEP at most, along the shortest way out. Doorways are
    obstacles too, and so is what lies outside the room. `occupied` (B, N) selects slots, `tucked` (B, N, N) pairs whose bodies may
    share a place: chairs stand under tables.

    Most slots are empty and most things open nothing: the pairs that are there are listed, and only these are computed.
    """
    batch, slots = occupied.shape
    body, (doors, there) = bodies(boxes), doorways(rooms)
    first_door, first_sweep = batch * slots, batch * (slots + there.shape[1])
    things, mates = [_to_rows(body), _to_rows(doors)], occupied[:, :, None] & occupied[:, None]
    own, door = _numbers(occupied, 0), _numbers(there, first_door)
    pairs = [
        _select_pairs((mates if tucked is None else mates & ~tucked).triu(1), own[:, :, None], own[:, None]),
        _select_pairs(occupied[:, :, None] & there[:, None], own[:, :, None], door[:, None]),
    ]
    if sweeps is not None:
        moving, real = swept(body, sweeps)
        real = real & occupied[:, :, None]
        things.append(_to_rows(moving))
        swept_by = _numbers(real, first_sweep)[..., None]
        others = mates & ~torch.eye(slots, dtype=torch.bool, device=occupied.device)
        pairs += [
            _select_pairs(real[..., None] & others[:, :, None], swept_by, own[:, None, None]),
            _select_pairs(real[..., None] & there[:, None, None], swept_by, door[:, None, None]),
        ]
    listed = torch.cat(things)
    left, right, owner = (torch.cat(parts) for parts in zip(*pairs, strict=True))
    a, b = _from_rows(listed.detach()[left]), _from_rows(listed.detach()[right])
    reach = (a.half**2).sum(-1).sqrt() + (b.half**2).sum(-1).sqrt()
    meet = torch.nonzero(((b.centre - a.centre) ** 2).sum(-1) < reach**2)[:, 0]
    depth = overlap(_from_rows(listed[left[meet]]), _from_rows(listed[right[meet]]))
    phi = torch.zeros_like(body.low[:, 0]).index_add(0, owner[meet], torch.where(depth < DEEP, depth**2 / 2, DEEP * (depth - DEEP / 2)))
    standing = torch.nonzero(occupied.flatten())[:, 0]
    phi = phi.index_add(0, standing // slots, outside(_from_rows(listed[standing]), rooms, standing // slots) / 2)
    if sweeps is None:
        return phi
    moved = torch.nonzero(real.flatten())[:, 0]
    room = moved // real[0].numel()
    return phi.index_add(0, room, outside(_from_rows(listed[first_sweep + moved]), rooms, room) / 4)


def _to_rows(prisms: Prisms) -> Tensor:
    """Prisms (..., ) as the rows (n, 8) of a list."""
    return torch.cat([prisms.centre, prisms.half, prisms.axis, prisms.low[..., None], prisms.high[..., None]], -1).flatten(0, -2)


def _from_rows(rows: Tensor) -> Prisms:
    """Undo `_to_rows`."""
    centre, half, axis, low, high = rows.split([2, 2, 2, 1, 1], -1)
    return Prisms(centre, half, axis, low[..., 0], high[..., 0])


def _numbers(like: Tensor, first: int) -> Tensor:
    """Return the places in the list of what `like` (B, ...) selects from, counted from `first`."""
    return torch.arange(first, first + like.numel(), device=like.device).view_as(like)


def _select_pairs(chosen: Tensor, left: Tensor, right: Tensor) -> tuple[Tensor, Tensor, Tensor]:
    """Return the places of both things of each chosen pair, and its room; `chosen` (B, ...), to whose shape the places broadcast."""
    return left.expand_as(chosen)[chosen], right.expand_as(chosen)[chosen], torch.nonzero(chosen)[:, 0]


@dataclass(frozen=True, slots=True)
class Guidance:
    """What guides a batch: the rooms, their tastes, classes (B, N), the library, the classes that open (C + 1,), pairs that may share a place (B, N, N)."""

    rooms: RoomBatch
    tastes: Sequence[Any]
    classes: Tensor
    library: Library | None
    opens: Tensor
    tucked: Tensor
    settings: SampleSettings

    def step(self, codec: Codec, x0: Tensor, level: float) -> Tensor:
        """Return the expected clean channels x0 (B, N, 40) at a level (lambda) as they are wanted."""
        s = self.settings
        snaps = self.library is not None and s.snap_below > 0 and level > lambda_of(s.snap_below)
        guides = s.articulation != "none" and level > lambda_of(s.articulation_below)
        if not (snaps or guides):
            return x0
        size, sweeps = self._looked_up(codec, x0)
        moved = x0.clone()
        if snaps:
            moved[..., : SIZE.stop] += size_shift(codec, x0, self.classes, size)
        if guides:
            if s.articulation == "heuristic":
                sweeps = heuristic_sweeps(codec.metric(moved[..., : SIZE.stop], self.classes)[..., SIZE], self.opens[self.classes])
            moved = self._descended(codec, moved, sweeps)
            if snaps and s.articulation == "joints":
                moved = self._with_smaller(codec, moved, sweeps)
        return moved

    def _descended(self, codec: Codec, x0: Tensor, sweeps: Tensor | None) -> Tensor:
        """Return x0 pushed apart."""
        moved = x0.clone()
        for _ in range(self.settings.articulation_steps):
            moved[..., : YAW.stop] += articulation_descent(codec, moved, self.classes, sweeps, self.rooms, self.settings, self.tucked)
        return moved

    def _with_smaller(self, codec: Codec, x0: Tensor, sweeps: Tensor | None) -> Tensor:
        """Return x0 with the next smaller asset of its kind for what is still pressed between others, and these rooms pushed apart again.

        Where a row is too long for its wall, pushing alone shares the overlap out. An asset is smaller by what reaches into it.
        """
        excess = 2 * articulation_gradient(codec, x0, self.classes, sweeps, self.rooms, self.tucked)[..., SIZE].clamp_min(0)
        excess[..., 2] = 0
        pressed = excess.amax(-1) > PRESSED
        rows = torch.nonzero(pressed.any(-1))[:, 0]
        if not len(rows):
            return x0
        tastes = [self.tastes[i] for i in rows.tolist()]
        few = replace(self, rooms=self.rooms.rows(rows), tastes=tastes, classes=self.classes[rows], tucked=self.tucked[rows])
        excess = torch.where(pressed[rows][..., None], excess[rows], 0.0)
        moved = x0.clone()
        moved[rows] = few.shrunk(codec, x0[rows], None if sweeps is None else sweeps[rows], excess)
        return moved

    def shrunk(self, codec: Codec, x0: Tensor, sweeps: Tensor | None, excess: Tensor) -> Tensor:
        """Return x0 with assets smaller by `excess` (B, N, 3) [m], as far as there are any, and pushed apart."""
        asked = x0.clone()
        asked[..., SIZE] -= excess / codec.scale[self.classes, SIZE]
        size, others = self._looked_up(codec, asked)
        area = codec.metric(x0[..., : SIZE.stop], self.classes)[..., 3:5].prod(-1)
        smaller = (excess > 0).any(-1) & (size[..., :2].prod(-1) < area - 1e-4)
        moved = x0.clone()
        moved[..., : SIZE.stop] += torch.where(smaller[..., None], size_shift(codec, x0, self.classes, size), 0.0)
        if sweeps is not None and others is not None:
            sweeps = torch.where(smaller[..., None, None, None], others, sweeps)
        return self._descended(codec, moved, sweeps)

    def _looked_up(self, codec: Codec, x0: Tensor) -> tuple[Tensor, Tensor | None]:
        """Ask the library for each object's asset: its size (B, N, 3) [m] and its sweeps (B, N, K, 2, 3) [m]."""
        metric = codec.metric(x0, self.classes)
        size = metric[..., SIZE].clamp_min(0.02)
        if self.library is None:
            return size, None
        names = [[codec.norm.classes[c] if c < codec.classes else None for c in row] for row in self.classes.tolist()]
        positions, sizes, latents = (part.double().cpu().numpy() for part in (metric[..., :3], size, metric[..., SHAPE]))
        placed, sweeps = self.library.lookup(self.tastes, names, positions, sizes, latents)
        return torch.from_numpy(placed).to(x0), torch.from_numpy(sweeps).to(x0)


def articulation_descent(
    codec: Codec, x0: Tensor, classes: Tensor, sweeps: Tensor | None, rooms: RoomBatch, s: SampleSettings, tucked: Tensor | None = None
) -> Tensor:
    """Return the step (B, N, 8) down phi_articoll: position x, y and yaw move, size and height stay."""
    gradient = articulation_gradient(codec, x0, classes, sweeps, rooms, tucked)
    step = torch.zeros_like(gradient)
    move = -s.articulation_scale * gradient[..., :2]
    length = torch.linalg.vector_norm(move, dim=-1, keepdim=True)
    step[..., :2] = move * (s.clip / length.clamp_min(1e-9)).clamp_max(1.0) / codec.reach
    step[..., YAW] = (-s.turn_scale * s.articulation_scale * gradient[..., YAW]).clamp(-s.clip, s.clip)
    return step


def articulation_gradient(
    codec: Codec, x0: Tensor, classes: Tensor, sweeps: Tensor | None, rooms: RoomBatch, tucked: Tensor | None = None
) -> Tensor:
    """Return the gradient (B, N, 8) of phi_articoll by position, size, cos and sin [m]."""
    metric = codec.metric(x0[..., : YAW.stop], classes).detach().requires_grad_()
    with torch.enable_grad():
        phi = articulated_collision(boxes_of(metric), classes < codec.classes, sweeps, rooms, tucked)
        (gradient,) = torch.autograd.grad(phi.sum(), metric)
    return gradient


def size_shift(codec: Codec, x0: Tensor, classes: Tensor, size: Tensor) -> Tensor:
    """Return the shift (B, N, 6) that gives objects the size [m] of their assets and leaves their backs where they are."""
    metric = codec.metric(x0[..., : YAW.stop], classes)
    grown = size - metric[..., SIZE]
    axis = metric[..., YAW] / torch.linalg.vector_norm(metric[..., YAW], dim=-1, keepdim=True).clamp_min(1e-3)
    front = torch.stack([axis[..., 1], -axis[..., 0]], -1)
    move = torch.zeros_like(metric[..., : SIZE.stop])
    move[..., :2] = front * grown[..., 1:2] / 2
    move[..., SIZE] = grown
    return move / codec.scale[classes, : SIZE.stop]
