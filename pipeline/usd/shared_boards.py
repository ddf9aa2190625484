"""Boards of fixed furniture that what stands beside them is felt for: the back of a cupboard before a wall, one of two sides that meet in a run.

A library's asset has all of its boards. In a home, whoever reaches into a cupboard to its back feels the wall where that is no more than
BESIDE behind it, as a chest's sides are its drawers' own. Above OVER nobody feels anything; what lies there keeps what it lies on.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from pipeline.arrays import Floats, Ints
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.entities.plan import Plan
from pipeline.geometry.compiled import borrowing
from pipeline.geometry.memo import cached_on_asset
from pipeline.geometry.walls import Prism
from pipeline.usd.articulation import hidden_colliders, is_visual_only, link_names, loose

Flags = NDArray[np.bool_]

# How far tops and undersides may be off as colliders are made, and from where on up nothing is felt (pipeline/sources/meshes/touching.py): said again, or
# every change of how furniture is read would make all homes anew. Sides may be off by a thick board and the seam behind it.
BESIDE = 0.04  # [m] sides and backs; no thicker is a board, and on no narrower top does anything lie
TOP, BELOW = 0.005, 0.15  # [m] what looks up by UP, what looks down
UP = 0.7
OVER = 2.0  # [m] above the floor of the storey
SAMPLES = (1, 12)  # intervals along a side of a board's triangles, coarse first
CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])  # of a box (2, 3)
NO_POINTS = np.zeros((0, 3)), np.zeros(0)


class Pieces(NamedTuple):
    """P convex pieces of what is fixed: the planes of piece i are rows faces[i] to faces[i + 1] of `planes` (F, 4), its box `boxes` (P, 2, 3) [m].

    Of a board that may go, rows spread[i] to spread[i + 1] of `points` (N, 3) lie on its surface, which looks up by `ups` (N,) there, coarse ones first,
    and `paths` (P,) names its collider; `tops` (P,) is how far its top may be off [m].
    """

    planes: Floats
    faces: Ints
    boxes: Floats
    points: Floats
    ups: Floats
    spread: Ints
    tops: Floats
    paths: tuple[str, ...]


def boards_felt_elsewhere(
    plan: Plan, placements: Sequence[Placement], assets: Mapping[str, Asset], solids: Iterable[Prism]
) -> dict[str, list[str]]:
    """Return by object the colliders, as paths below it, that the others and the building's `solids` [m, world] are felt for.

    The smallest goes first, and what has gone stands in for nothing.
    """
    reach = {room.room_id: room.level * plan.storey_height + OVER for room in plan.rooms}
    high = {placed.support for placed in placements if placed.position[2] > reach[placed.room_id]}  # what bears something up there stays
    fixed = [p for p in placements if np.allclose(p.scale, 1.0)]  # the distances of what is scaled are not those of its asset
    groups = [_join([_wall(solid) for solid in solids]), *(_placed(p, _fixed_pieces(assets[p.asset_id])) for p in fixed)]
    pieces = _join(groups)
    names = ["", *(p.object_id for p in fixed)]
    heights = [0.0, *(np.inf if p.object_id in high else reach[p.room_id] for p in fixed)]
    owners = np.repeat(np.arange(len(groups)), [len(group.paths) for group in groups])
    there, near = np.ones(len(pieces.paths), np.bool_), np.zeros(len(pieces.paths), np.bool_)
    size = np.ptp(pieces.boxes, axis=1).prod(axis=1).round(9)
    gone: dict[str, list[str]] = {}
    for k in np.lexsort((np.arange(len(size)), size)).tolist():
        if pieces.paths[k] and _felt_elsewhere(pieces[:-1], k, heights[owners[k]], there, near):
            there[k] = False
            gone.setdefault(names[owners[k]], []).append(pieces.paths[k])
    return gone


@borrowing
def _felt_elsewhere(pieces: tuple[Any, ...], k: int, over: float, there: Flags, near: Flags) -> bool:
    """Whether all points of piece `k` are higher than `over` [m] or as near to a piece that is `there` (P,) as a surface may be off; `near` (P,) is scratch."""
    planes, faces, boxes, points, ups, spread, tops = pieces
    for j in range(len(faces) - 1):
        near[j] = there[j] and j != k
        for axis in range(3):
            near[j] &= boxes[j, 0, axis] <= boxes[k, 1, axis] + BELOW and boxes[j, 1, axis] >= boxes[k, 0, axis] - BELOW
    for p in range(spread[k], spread[k + 1]):
        x, y, z, up = points[p, 0], points[p, 1], points[p, 2], ups[p]
        allowed = tops[k] if up > UP else BELOW if up < -UP else BESIDE
        felt = z > over
        for j in range(len(faces) - 1):
            if felt:
                break
            felt = near[j]
            for f in range(faces[j], faces[j + 1]):
                if not felt:
                    break
                felt = planes[f, 0] * x + planes[f, 1] * y + planes[f, 2] * z + planes[f, 3] <= allowed
        if not felt:
            return False
    return True


def _join(groups: Sequence[Pieces]) -> Pieces:
    """Return the pieces of all groups as one."""
    if not groups:
        return _pieces([])
    columns = list(zip(*groups, strict=True))
    planes, boxes, points, ups, tops = (np.concatenate(columns[i]) for i in (0, 2, 3, 4, 6))
    faces, spread = (np.concatenate([[0], *(np.diff(ends) for ends in columns[i])]).cumsum() for i in (1, 5))
    return Pieces(planes, faces, boxes, points, ups, spread, tops, tuple(chain.from_iterable(columns[7])))


def _pieces(pieces: Sequence[tuple[Floats, Floats, tuple[Floats, Floats], float, str]]) -> Pieces:
    """Return pieces given each as planes, box, points with how far each looks up, top and path."""
    faces, spread = (np.cumsum([0, *sizes]) for sizes in ([len(p[0]) for p in pieces], [len(p[2][0]) for p in pieces]))
    return Pieces(
        np.concatenate([np.zeros((0, 4)), *(p[0] for p in pieces)]),
        faces,
        np.array([p[1] for p in pieces]).reshape(-1, 2, 3),
        np.concatenate([NO_POINTS[0], *(p[2][0] for p in pieces)]),
        np.concatenate([NO_POINTS[1], *(p[2][1] for p in pieces)]),
        spread,
        np.array([p[3] for p in pieces], np.float64),
        tuple(p[4] for p in pieces),
    )


def _wall(solid: Prism) -> Pieces:
    """Return a solid of the building."""
    corners = solid.polygon
    along = np.roll(corners, -1, axis=0) - corners
    ways = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    sides = np.column_stack([ways, np.zeros(len(ways)), -(ways * corners).sum(axis=1)])
    ends = np.array([[0.0, 0.0, 1.0, -solid.top], [0.0, 0.0, -1.0, solid.bottom]])
    box = np.array([[*corners.min(axis=0), solid.bottom], [*corners.max(axis=0), solid.top]])
    return _pieces([(np.concatenate([sides, ends]), box, NO_POINTS, TOP, "")])


def _placed(placed: Placement, own: Pieces) -> Pieces:
    """Return the pieces of an object in the world, from those in its frame."""
    c, s = np.cos(placed.yaw), np.sin(placed.yaw)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])  # of rows
    ways = own.planes[:, :3] @ turn
    corners = own.boxes[:, CORNERS, range(3)] @ turn + placed.position
    return own._replace(
        planes=np.column_stack([ways, own.planes[:, 3] - ways @ placed.position]),
        boxes=np.stack([corners.min(axis=1), corners.max(axis=1)], axis=1),
        points=own.points @ turn + placed.position,
    )


@cached_on_asset
def _fixed_pieces(asset: Asset) -> Pieces:
    """Return what of an asset stands still, in its frame: nothing of small things, all of furniture that does not open, the base of what does."""
    if loose(asset) or is_visual_only(asset):
        return _pieces([])
    pieces = []
    for name, link in list(zip(link_names(asset), asset.links, strict=True))[: 1 if asset.articulated else None]:
        hidden = {id(mesh): f"{name}/{collider}" for collider, mesh in hidden_colliders(link).items()}
        for mesh in link.colliders:
            points = mesh.vertices.astype(np.float64)
            hull = ConvexHull(points)
            box = np.array([points.min(axis=0), points.max(axis=0)])
            path = hidden.get(id(mesh), "") if np.ptp(box, axis=0).min() <= BESIDE else ""
            top = BESIDE if np.ptp(box[:, :2], axis=0).min() <= BESIDE else TOP
            pieces.append((np.unique(hull.equations.round(9), axis=0), box, _samples(hull) if path else NO_POINTS, top, path))
    return _pieces(pieces)


def _samples(hull: ConvexHull) -> tuple[Floats, Floats]:
    """Return points spread over a hull and the upward part of the normals there, coarse ones before fine ones."""
    corners = hull.points[hull.simplices]
    points, ups = [], []
    for count in SAMPLES:
        weights = np.array([(i, j, count - i - j) for i in range(count + 1) for j in range(count + 1 - i)]) / count
        points.append((weights @ corners).reshape(-1, 3))
        ups.append(np.repeat(hull.equations[:, 2], len(weights)))
    return np.concatenate(points), np.concatenate(ups)
