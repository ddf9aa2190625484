"""Furniture moved out of walls and of each other, as little as need be.

In four of ten rooms of scene files something reaches into a wall or a neighbour, mostly by centimetres. A layout model learns that with the rest,
and a filter loses what lies half outside. So a piece is moved before it is judged, as 3DFRONT-NC (CASAGPT, CVPR 2025) optimises rooms
until nothing collides; here by the least translations that separate two boxes, walls first, the worst conflict next.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry import Polygon

from pipeline.arrays import Bools, Floats
from pipeline.sources.threed_front.furniture import Placed, shared_shape, supports
from pipeline.sources.threed_front.notches import fill_columns
from pipeline.taxonomy import Taxonomy

SLACK = 0.004  # [m] what boxes may share: rounding of sources
GAP = 0.003  # [m] that is left between what was separated
FLAT = 0.05  # [m] of common height: rugs, and what stands on something
NOTCH = 0.02  # share of the smaller one's volume that two shapes may have in common: an L-shaped sofa and the table before it
ROUNDS, CAREFUL = 16, 3  # of the rounds the first, in which no piece is pushed into a third
SNUG = 0.05  # [m] behind what was moved; a piece that comes to stand so near another was probably pushed away from it
COST = 0.3  # of a metre's move, in metres of overlap
LOOSE = 0.03  # [m] of overlap that a snug place is worth


@dataclass(frozen=True, slots=True)
class Room:
    """Boxes in plan: half extents (n, 2), unit axes (n, 2, 2) as rows, which may conflict (n, n), the floor with SLACK around it, its walls.

    `walls` are (m, 2) starts, (m, 2) unit tangents, (m, 2) inward normals, (m,) lengths.
    """

    pieces: Sequence[Placed]
    half: Floats
    axes: Floats
    rivals: Bools
    grown: Polygon
    walls: tuple[Floats, Floats, Floats, Floats]

    def footprint(self, k: int, at: Floats) -> Polygon:
        """Return the box of piece k in plan, with its centre there."""
        across, ahead = self.axes[k] * self.half[k][:, None]
        return Polygon([at - across - ahead, at + across - ahead, at + across + ahead, at - across + ahead])

    def inside(self, k: int, at: Floats) -> bool:
        """Whether piece k is in the room with its centre there."""
        return bool(self.grown.covers(self.footprint(k, at)))

    def overlaps(self, k: int, at: Floats, centres: Floats) -> tuple[Floats, Floats, Floats]:
        """Return how deep piece k at that place is in each rival (n,), and along the axes of both (n, 4) depths and (n, 4, 2) axes."""
        axes = np.concatenate([np.broadcast_to(self.axes[k], self.axes.shape), self.axes], axis=1)
        reach = np.abs(axes @ (self.axes[k] * self.half[k][:, None]).T).sum(-1)
        reach += np.abs(np.einsum("nad,nbd->nab", axes, self.axes * self.half[..., None])).sum(-1)
        depths = reach - np.abs(np.einsum("nad,nd->na", axes, centres - at))
        return np.where(self.rivals[k], np.maximum(depths.min(1), 0.0), 0.0), depths, axes


def move_apart(pieces: Sequence[Placed], floor: Polygon, taxonomy: Taxonomy, farthest: float) -> list[Placed]:
    """Return the pieces of a room, those in walls or in each other moved by `farthest` [m] at most, with a note each.

    What rests on a piece moves with it; seats stay under tables, small things and lamps where they are. A piece that finds no free
    place within reach stays too.
    """
    bearers = [b if b >= 0 and pieces[b].pose.size[2] > FLAT else -1 for b in supports(pieces, taxonomy)]
    room = _room(pieces, floor, bearers, taxonomy)
    start = np.array([p.pose.position[:2] for p in pieces])
    centres = _separate(room, start, farthest)
    shifts = np.round(centres - start, 4)
    for k in range(len(pieces)):
        carrier = k
        while bearers[carrier] >= 0:
            carrier = bearers[carrier]
        shifts[k] = shifts[carrier]
    return [_moved(p, s) if s.any() else p for p, s in zip(pieces, shifts, strict=True)]


def _moved(piece: Placed, shift: Floats) -> Placed:
    position = np.round(piece.pose.position + np.append(shift, 0.0), 4) + 0.0
    note = ("moved", f"{piece.category} by {math.hypot(*shift):.2f} m")
    return replace(piece, pose=replace(piece.pose, position=position), notes=(*piece.notes, note))


def _room(pieces: Sequence[Placed], floor: Polygon, bearers: Sequence[int], taxonomy: Taxonomy) -> Room:
    yaw = np.array([p.pose.yaw for p in pieces])
    c, s = np.cos(yaw), np.sin(yaw)
    size = np.array([p.pose.size[:2] for p in pieces]).reshape(-1, 2)
    low, high = np.array([p.span for p in pieces]).reshape(-1, 2).T
    cards = [taxonomy.categories[p.category] for p in pieces]
    own = np.array([b < 0 and card.mount != "ceiling" and card.layout for b, card in zip(bearers, cards, strict=True)], bool)
    tuck = np.array([card.tuck_role for card in cards])
    level = np.minimum(high[:, None], high) - np.maximum(low[:, None], low) > FLAT
    rivals = own[:, None] & own & level & (tuck[:, None] + tuck != 3)
    np.fill_diagonal(rivals, val=False)
    points = np.asarray(shapely.geometry.polygon.orient(floor).exterior.coords)
    steps = np.diff(points, axis=0)
    length = np.linalg.norm(steps, axis=1)
    tangents = steps / length[:, None]
    walls = (points[:-1], tangents, np.stack([-tangents[:, 1], tangents[:, 0]], 1), length)
    axes = np.stack([np.stack([c, s], -1), np.stack([-s, c], -1)], 1)
    return Room(pieces, size / 2 * own[:, None], axes, rivals, floor.buffer(SLACK, join_style="mitre"), walls)


def _separate(room: Room, start: Floats, farthest: float) -> Floats:
    """Return the centres (n, 2) with the least conflict that was met."""
    centres, own = start.copy(), np.flatnonzero(room.half[:, 0] > 0).tolist()
    best, least = centres, math.inf
    for attempt in range(ROUNDS):
        for k in own:
            at = _into_room(room, k, centres[k])
            if at is not None and np.linalg.norm(at - start[k]) <= farthest:
                centres[k] = at
        depths = np.array([room.overlaps(k, centres[k], centres)[0] for k in own]) if own else np.zeros((0, 0))
        if depths.sum() < least:
            best, least = centres.copy(), float(depths.sum())
        conflicts = sorted(((depths[i, j], k, j) for i, k in enumerate(own) for j in own if j > k and depths[i, j] > SLACK), reverse=True)
        parted = [_part(room, k, j, centres, start, farthest, push=attempt >= CAREFUL) for _, k, j in conflicts]
        if not any(parted) and attempt >= CAREFUL:
            break
    return best


def _into_room(room: Room, k: int, at: Floats) -> Floats | None:
    """Return where a piece stands once it is out of the walls: the shallowest first. None if it is in none, or stays in one."""
    if room.inside(k, at):
        return None
    starts, tangents, normals, length = room.walls
    for _ in range(4):
        along = np.einsum("md,md->m", at - starts, tangents)
        off = np.einsum("md,md->m", at - starts, normals)
        box = room.axes[k] * room.half[k][:, None]
        reach_along, reach_off = np.abs(tangents @ box.T).sum(1), np.abs(normals @ box.T).sum(1)
        depth = reach_off - off
        hit = (off > -reach_off / 4) & (depth > SLACK) & (along + reach_along > SLACK) & (along - reach_along < length - SLACK)
        if not hit.any():
            return None
        wall = int(np.flatnonzero(hit)[np.argmin(depth[hit])])
        at = at + normals[wall] * (depth[wall] + GAP)
        if room.inside(k, at):
            return at
    return None


def _part(room: Room, k: int, j: int, centres: Floats, start: Floats, farthest: float, *, push: bool) -> bool:
    """Move one of two pieces out of the other, where that makes less conflict than there is, or `push`es a third; whether that did."""
    depth, depths, axes = room.overlaps(k, centres[k], centres)
    if depth[j] <= SLACK or _share_notch(room, k, j, centres):
        return False
    best: tuple[float, int, Floats] | None = None
    for mover, sign in ((k, 1.0), (j, -1.0)):
        before = room.overlaps(mover, centres[mover], centres)[0].sum()
        for way in np.argsort(depths[j])[:2]:
            axis = axes[j, way] * sign * (1.0 if (centres[k] - centres[j]) @ axes[j, way] >= 0 else -1.0)
            shift = axis * (depths[j, way] + GAP)
            at = centres[mover] + shift
            moved = float(np.linalg.norm(at - start[mover]))
            if moved > farthest or not room.inside(mover, at):
                continue
            after = room.overlaps(mover, at, centres)[0].sum()
            beyond = at + axis * SNUG
            snug = not room.inside(mover, beyond) or room.overlaps(mover, beyond, centres)[0].max() > SLACK
            cost = after + COST * moved + LOOSE * (not snug)
            if (push or after < before - depth[j] / 2) and (best is None or cost < best[0]):
                best = cost, mover, at
    if best is None:
        return False
    centres[best[1]] = best[2]
    return True


def _share_notch(room: Room, k: int, j: int, centres: Floats) -> bool:
    """Whether two boxes meet over floor that one of the things in them does not cover, as far as the models tell: the notch of a sofa."""
    if not (room.pieces[k].shape or room.pieces[j].shape):
        return False

    def column(i: int) -> Placed:  # full from top to bottom wherever it is anything
        piece = room.pieces[i]
        pose = replace(piece.pose, position=np.array([*centres[i], piece.pose.position[2]]))
        return replace(piece, pose=pose, shape=fill_columns(piece.shape))

    return shared_shape(column(k), column(j)) < NOTCH
