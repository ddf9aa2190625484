"""Boards of fixed furniture that what stands beside them is felt for: the back of a cupboard before a wall, one of two sides that meet in a run.

A library's asset has all of its boards. In a home, whoever reaches into a cupboard to its back feels the wall where that is no more than
BESIDE behind it, as a chest's sides are its drawers' own. Above OVER nobody feels anything; what lies there keeps what it lies on.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.entities.plan import Plan
from pipeline.geometry.memo import cached_on_asset
from pipeline.geometry.walls import Prism
from pipeline.usd.articulation import hidden_colliders, is_visual_only, link_names, loose

Floats = NDArray[np.float64]

# How far tops and undersides may be off as colliders are made, and from where on up nothing is felt (pipeline/sources/meshes/touching.py): said again, or
# every change of how furniture is read would make all homes anew. Sides may be off by a thick board and the seam behind it.
BESIDE = 0.04  # [m] sides and backs; no thicker is a board, and on no narrower top does anything lie
TOP, BELOW = 0.005, 0.15  # [m] what looks up by UP, what looks down
UP = 0.7
OVER = 2.0  # [m] above the floor of the storey
SAMPLES = (1, 12)  # intervals along a side of a board's triangles, coarse first


class Piece(NamedTuple):
    """A convex piece of what is fixed: its planes (F, 4) and its box (2, 3) [m]; of a board that may go, points (P, 3) coarse and fine with normals."""

    planes: Floats
    box: Floats
    board: tuple[tuple[Floats, Floats], ...] = ()
    path: str = ""
    top: float = TOP


def boards_felt_elsewhere(
    plan: Plan, placements: Sequence[Placement], assets: Mapping[str, Asset], solids: Iterable[Prism]
) -> dict[str, list[str]]:
    """Return by object the colliders, as paths below it, that the others and the building's `solids` [m, world] are felt for.

    The smallest goes first, and what has gone stands in for nothing.
    """
    pieces = [_wall(solid) for solid in solids]
    owners = [("", 0.0)] * len(pieces)
    reach = {room.room_id: room.level * plan.storey_height + OVER for room in plan.rooms}
    high = {placed.support for placed in placements if placed.position[2] > reach[placed.room_id]}  # what bears something up there stays
    for placed in placements:
        own = list(_placed(placed, assets[placed.asset_id]))
        pieces += own
        owners += [(placed.object_id, np.inf if placed.object_id in high else reach[placed.room_id])] * len(own)
    boxes = np.array([piece.box for piece in pieces]).reshape(-1, 2, 3)
    there = np.ones(len(pieces), np.bool_)
    gone: dict[str, list[str]] = {}
    size = np.ptp(boxes, axis=1).prod(axis=1).round(9)
    for k in sorted((k for k, piece in enumerate(pieces) if piece.board), key=lambda k: (size[k], k)):
        near = there & (boxes[:, 0] <= boxes[k, 1] + BELOW).all(axis=1) & (boxes[:, 1] >= boxes[k, 0] - BELOW).all(axis=1)
        near[k] = False
        name, over = owners[k]
        beside = [pieces[i].planes for i in np.flatnonzero(near)]
        if all(_felt_elsewhere(*points, pieces[k].top, over, beside) for points in pieces[k].board):
            there[k] = False
            gone.setdefault(name, []).append(pieces[k].path)
    return gone


def _felt_elsewhere(at: Floats, normals: Floats, top: float, over: float, planes: list[Floats]) -> bool:
    """Whether points (P, 3) with normals are as near to other pieces, by their planes, as a surface may be off, `top` [m] on top, or higher than `over`."""
    allowed = np.where(normals[:, 2] > UP, top, np.where(normals[:, 2] < -UP, BELOW, BESIDE))
    near = at[:, 2] > over
    for faces in planes:
        near |= (at @ faces[:, :3].T + faces[:, 3]).max(axis=1) <= allowed
    return bool(near.all())


def _wall(solid: Prism) -> Piece:
    """Return a solid of the building."""
    corners = solid.polygon
    along = np.roll(corners, -1, axis=0) - corners
    ways = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    sides = np.column_stack([ways, np.zeros(len(ways)), -(ways * corners).sum(axis=1)])
    ends = np.array([[0.0, 0.0, 1.0, -solid.top], [0.0, 0.0, -1.0, solid.bottom]])
    box = np.array([[*corners.min(axis=0), solid.bottom], [*corners.max(axis=0), solid.top]])
    return Piece(np.concatenate([sides, ends]), box)


def _placed(placed: Placement, asset: Asset) -> Iterator[Piece]:
    """Yield the fixed pieces of an object in the world; of what is scaled none, whose distances are not those of its asset."""
    if not np.allclose(placed.scale, 1.0):
        return
    c, s = np.cos(placed.yaw), np.sin(placed.yaw)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])  # of rows
    for piece in _fixed_pieces(asset):
        ways = piece.planes[:, :3] @ turn
        corners = _corners(piece.box) @ turn + placed.position
        board = tuple((at @ turn + placed.position, normals @ turn) for at, normals in piece.board)
        yield Piece(
            np.column_stack([ways, piece.planes[:, 3] - ways @ placed.position]),
            np.array([corners.min(axis=0), corners.max(axis=0)]),
            board,
            piece.path,
            piece.top,
        )


def _corners(box: Floats) -> Floats:
    return np.array([[box[i, 0], box[j, 1], box[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])


@cached_on_asset
def _fixed_pieces(asset: Asset) -> list[Piece]:
    """Return what of an asset stands still, in its frame: nothing of small things, all of furniture that does not open, the base of what does."""
    if loose(asset) or is_visual_only(asset):
        return []
    pieces = []
    for name, link in list(zip(link_names(asset), asset.links, strict=True))[: 1 if asset.articulated else None]:
        hidden = {id(mesh): f"{name}/{collider}" for collider, mesh in hidden_colliders(link).items()}
        for mesh in link.colliders:
            points = mesh.vertices.astype(np.float64)
            hull = ConvexHull(points)
            box = np.array([points.min(axis=0), points.max(axis=0)])
            path = hidden.get(id(mesh), "")
            board = _samples(hull) if path and np.ptp(box, axis=0).min() <= BESIDE else ()
            top = BESIDE if np.ptp(box[:, :2], axis=0).min() <= BESIDE else TOP
            pieces.append(Piece(np.unique(hull.equations.round(9), axis=0), box, board, path, top))
    return pieces


def _samples(hull: ConvexHull) -> tuple[tuple[Floats, Floats], ...]:
    """Return points spread over a hull and the normals there, coarse and fine."""
    corners, normals = hull.points[hull.simplices], hull.equations[:, :3]
    spreads = []
    for count in SAMPLES:
        weights = np.array([(i, j, count - i - j) for i in range(count + 1) for j in range(count + 1 - i)]) / count
        spreads.append(((weights @ corners).reshape(-1, 3), np.repeat(normals, len(weights), axis=0)))
    return tuple(spreads)
