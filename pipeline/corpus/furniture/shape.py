"""Shapes: pieces of convex solids on a base and on movers, before they become an asset or files."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.finishes import FINISHES, Finish, Material
from pipeline.corpus.furniture.solids import Solid, Vector, box, hull

Axis3 = tuple[float, float, float]
FRONT: Axis3 = (0.0, -1.0, 0.0)
UP: Axis3 = (0.0, 0.0, 1.0)
CLEARANCE = 5e-5  # [m]
BOXY = 0.97  # share of its box that a hull fills before the box stands for it


@dataclass(frozen=True, slots=True)
class Piece:
    """One convex solid of a component: pieces of one `name` on one body belong together (a panel, a handle).

    `part` is a GAPartNet class where the component is a fixed handle, else "". Pieces of one body with the same `group`
    collide as one convex solid, their hull: a panelled door as a board, a handle as a bar; "" collides by itself.
    """

    name: str
    solid: Solid
    finish: Finish
    part: str = ""
    group: str = ""


Pieces = tuple[Piece, ...]


@dataclass(frozen=True, slots=True)
class Mover:
    """A body that moves against its parent (a mover's name, or "base").

    `axis` (unit) and `origin` [m] in the object frame at rest; motion goes from 0 to `upper` [rad or m] and
    opens. `outward` is the direction its face looks at rest (GAPartNet's z axis).
    `after` names the movers that must be open before this one can move: a rack waits for the door before it.
    """

    name: str
    pieces: Pieces
    type: Literal["revolute", "prismatic"]
    axis: Axis3
    origin: Axis3
    upper: float
    part_class: str
    semantic: str
    outward: Axis3 = FRONT
    parent: str = "base"
    after: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Shape:
    """A model's geometry: the fixed base and its movers, parents first."""

    base: Pieces
    movers: tuple[Mover, ...] = ()

    def pieces(self) -> Iterator[Piece]:
        """Iterate over all pieces."""
        yield from self.base
        for mover in self.movers:
            yield from mover.pieces

    def bounds(self) -> NDArray[np.float64]:
        """Return the box at rest (2, 3) [m]."""
        corners = np.stack([piece.solid.bounds() for piece in self.pieces()])
        return np.stack([corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)])


def pieces(name: str, solids: Solid | Iterable[Solid], material: Material, part: str = "", group: str = "") -> Pieces:
    """Return the pieces of one component."""
    finish = FINISHES[material] if isinstance(material, str) else material
    return tuple(Piece(name, solid, finish, part, group) for solid in ((solids,) if isinstance(solids, Solid) else solids))


def group_pieces(parts: Iterable[Piece], group: str) -> Pieces:
    """Return the pieces, all colliding as one convex solid."""
    return tuple(replace(piece, group=group) for piece in parts)


def staves(name: str, solids: Iterable[Solid], material: Material, group: str = "", share: int = 3) -> Pieces:
    """Return the staves of a round wall, `share` neighbours of which collide as one, with those of a `group`: finer to see than to touch."""
    return tuple(replace(piece, group=f"{group or name}_{k // share}") for k, piece in enumerate(pieces(name, solids, material)))


def colliders(parts: Iterable[Piece]) -> list[Solid]:
    """Return the convex solids that the pieces of one body collide by: each piece, or the hull of each group.

    A hull that nearly fills its box is that box: bevels need no corners of their own.
    """
    alone: list[Solid] = []
    groups: dict[str, list[Solid]] = {}
    for piece in parts:
        (groups.setdefault(piece.group, []) if piece.group else alone).append(piece.solid)
    for members in groups.values():
        solid = members[0] if len(members) == 1 else hull(np.concatenate([s.vertices for s in members]))
        low, high = solid.bounds()
        if len(members) > 1 and solid.volume() > BOXY * float(np.prod(high - low)):
            solid = box(*((float(a), float(b)) for a, b in zip(low, high, strict=True)))  # type: ignore[arg-type]
        alone.append(_smaller(solid, *solid.bounds()))
    return alone


def fit_to_size(shape: Shape, size: Vector) -> Shape:
    """Return the shape scaled to `size` (w, d, h) exactly and centred over the origin, bottom at 0.

    Builders come within a few percent of their box; this takes up the rest. Lengths of sliding joints scale along.
    Every component is drawn in by CLEARANCE first, so that no two touch; the pieces of one meet without a seam.
    """
    movers = tuple(replace(m, pieces=_draw_in(m.pieces)) for m in shape.movers)
    shape = Shape(_draw_in(shape.base), movers)
    low, high = shape.bounds()
    factors = np.asarray(size, float) / (high - low)
    offset = -np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])

    def place(parts: Pieces) -> Pieces:
        return tuple(replace(p, solid=p.solid.translate(offset).scale(factors)) for p in parts)

    placed = []
    for mover in shape.movers:
        x, y, z = ((np.asarray(mover.origin) + offset) * factors).tolist()
        stretch = float(np.abs(np.asarray(mover.axis)) @ factors) if mover.type == "prismatic" else 1.0
        placed.append(replace(mover, pieces=place(mover.pieces), origin=(x, y, z), upper=mover.upper * stretch))
    return Shape(place(shape.base), tuple(placed))


def _draw_in(parts: Pieces) -> Pieces:
    """Draw in the components of one body: pieces of a group, or else of one name."""
    components: dict[str, list[NDArray[np.float64]]] = {}
    for piece in parts:
        components.setdefault(piece.group or piece.name, []).append(piece.solid.bounds())
    bounds = {name: (np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)) for name, boxes in components.items()}
    return tuple(replace(piece, solid=_smaller(piece.solid, *bounds[piece.group or piece.name])) for piece in parts)


def _smaller(solid: Solid, low: NDArray[np.float64], high: NDArray[np.float64]) -> Solid:
    """Return the solid scaled about the centre of a box so that the box is CLEARANCE smaller on every side."""
    centre, extent = (low + high) / 2, high - low
    factors = 1 - 2 * np.minimum(CLEARANCE, 0.1 * extent) / extent
    return Solid((solid.vertices - centre) * factors + centre, solid.faces)


def freeze(shape: Shape) -> Shape:
    """Return the shape with every mover fixed where it rests."""
    return Shape(tuple(shape.pieces()))


def translate(shape: Shape, offset: Axis3, prefix: str) -> Shape:
    """Return the shape, whose movers all hang on its base, translated by `offset` [m]; `prefix` goes before their names and its pieces'."""
    dx, dy, dz = offset

    def place(parts: Pieces) -> Pieces:
        return tuple(replace(p, name=prefix + p.name, solid=p.solid.translate(offset)) for p in parts)

    origins = [(m.origin[0] + dx, m.origin[1] + dy, m.origin[2] + dz) for m in shape.movers]
    movers = zip(shape.movers, origins, strict=True)
    return Shape(place(shape.base), tuple(replace(m, name=prefix + m.name, pieces=place(m.pieces), origin=at) for m, at in movers))


def join_shapes(*shapes: Shape) -> Shape:
    """Return the shapes on one base."""
    return Shape(tuple(p for s in shapes for p in s.base), tuple(m for s in shapes for m in s.movers))
