"""The shell of a plan: wall solids between the rooms' inner faces, holes for the openings, and the door leaves in them.

Everything is in world plan coordinates (x, y) [m]; z is measured from the floor of the storey.
"""

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon

from pipeline.arrays import Floats
from pipeline.entities.plan import Opening, Plan, Room
from pipeline.geometry.stairs import Step, steps
from pipeline.geometry.tiling import convex_pieces, polygons

LEAF_THICKNESS = 0.04  # [m]
LEAF_GAP = 0.005  # between leaf and jamb, lintel, floor [m]: the leaf is 1 cm narrower and lower than its opening
SEAM = 2e-5  # [m]
SLAB = 0.10  # thickness of floors and ceilings; walls rise this far above the ceiling, which makes rooms light-tight [m]


@dataclass(frozen=True, slots=True)
class Cut:
    """The hole of an opening. `quad` (4, 2): from the segment's start, on its right, counter-clockwise around the hole."""

    opening: Opening
    quad: Floats
    bottom: float
    top: float


@dataclass(frozen=True, slots=True)
class Prism:
    """A convex upright solid: `polygon` (n, 2) counter-clockwise, from z = `bottom` to `top`."""

    kind: Literal["wall", "lintel", "sill", "floor", "ceiling"]
    polygon: Floats
    bottom: float
    top: float
    opening_id: str = ""


@dataclass(frozen=True, slots=True)
class Panel:
    """A flat visible face: `corners` (n, 3) counter-clockwise from its visible side; `owner` a room, "" outside, or an opening."""

    owner: str
    corners: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Leaf:
    """A hinged door leaf, closed. It opens about the vertical axis through `hinge`, from `along` towards `normal`.

    The hinge stands at the segment's end, on the wall's centre line; the closed leaf lies behind that line, on the side
    away from the room it swings into, so that the open leaf clears the jamb. `turn` is +1 where opening is
    counter-clockwise seen from above. `front` and `back` are the wall's depth on both sides of its centre line [m].
    """

    opening_id: str
    hinge: Floats
    along: Floats
    normal: Floats
    turn: int
    angle: float
    width: float
    bottom: float
    top: float
    front: float
    back: float
    clear: float

    def outline(self, angle: float = 0.0) -> Floats:
        """Return the leaf's rectangle (4, 2) in plan, opened by `angle` [rad]."""
        c, s = np.cos(angle), np.sin(angle)
        along, normal = c * self.along + s * self.normal, c * self.normal - s * self.along
        near = self.hinge + LEAF_GAP * self.along
        far, back = near + self.width * along, -LEAF_THICKNESS * normal
        return np.array([near, far, far + back, near + back])


@dataclass(frozen=True, slots=True, eq=False)
class Shell:
    """The walls of one storey, up to the floor of the next. `height` is the ceiling of its highest room, `top` where its walls end.

    `outline` is the outer edge, `region` the cut walls; `stairs` the landings on this storey and the flights that lead up from it.
    """

    height: float
    top: float
    outline: shapely.Geometry
    region: shapely.Geometry
    cuts: tuple[Cut, ...]
    prisms: tuple[Prism, ...]
    leaves: tuple[Leaf, ...]
    stairs: tuple[Step, ...]


def levels(plan: Plan) -> list[int]:
    """Return the storeys of a plan, lowest first."""
    return sorted({room.level for room in plan.rooms})


@functools.lru_cache(256)
def floor_pieces(room: Room) -> list[Floats]:
    """Tile a room's floor with convex polygons (n, 2)."""
    return convex_pieces(Polygon(room.polygon))


@functools.lru_cache(64)
def shell(plan: Plan, level: int) -> Shell:
    """Build the wall solids of one storey: what lies between the rooms (staircases from below too) and the outer edge, less the openings."""
    rooms = [room for room in plan.rooms if level in plan.levels_of(room)]
    inner = {room.room_id: Polygon(room.polygon) for room in rooms}
    height = max(room.height for room in rooms)
    top = height + SLAB if level == max(levels(plan)) else max(height + SLAB, plan.storey_height)
    outline = shapely.union_all([p.buffer(plan.outer_wall, join_style="mitre") for p in inner.values()])
    solid = shapely.set_precision(outline.difference(shapely.union_all(list(inner.values()))), 1e-6)
    cuts = tuple(_cut(o, inner, plan) for o in plan.openings if o.level == level)
    region = solid
    if cuts:
        region = shapely.set_precision(solid.difference(shapely.union_all([_hole_polygon(c) for c in cuts])), 1e-6)
    prisms = [Prism("wall", piece, 0.0, top) for piece in convex_pieces(region)]
    for cut in cuts:
        if top - cut.top > 1e-3:
            prisms.append(Prism("lintel", cut.quad, cut.top, top, cut.opening.opening_id))
        if cut.bottom > 1e-3:
            prisms.append(Prism("sill", cut.quad, 0.0, cut.bottom, cut.opening.opening_id))
    leaves = tuple(leaf for cut in cuts if (leaf := _leaf(cut, inner)))
    return Shell(height, top, outline, region, cuts, tuple(prisms), leaves, steps(plan, level))


@functools.lru_cache(64)
def leaves(plan: Plan) -> tuple[Leaf, ...]:
    """Return the door leaves of all storeys, in the order of the openings, without building walls."""
    swung = [(o, {r.room_id: Polygon(r.polygon) for r in plan.rooms if r.room_id in o.rooms}) for o in plan.openings if o.swing]
    return tuple(leaf for o, inner in swung if (leaf := _leaf(_cut(o, inner, plan), inner)))


def room_panels(room: Room, cuts: tuple[Cut, ...], height: float = 0.0) -> list[Panel]:
    """Return the visible wall faces of a room up to `height` (0: its ceiling), with holes where openings are."""
    return _ring_panels(room.room_id, room.polygon, cuts, height or room.height)


def outer_panels(built: Shell) -> list[Panel]:
    """Return the visible faces outside, and the tops of the walls."""
    top = built.top
    panels: list[Panel] = []
    for part in polygons(built.outline):
        # Reversed, so that, as in rooms, what is visible lies on the left of each edge.
        turned = shapely.geometry.polygon.orient(part, -1.0)
        for ring in (turned.exterior, *turned.interiors):
            panels.extend(_ring_panels("", np.asarray(ring.coords)[:-1], built.cuts, top))
    panels.extend(Panel("", _lift(_drawn_in(p.polygon), p.top)) for p in built.prisms if p.kind != "sill")
    return panels


def reveals(cut: Cut) -> list[Panel]:
    """Return the faces inside an opening: two jambs, the lintel's underside, the sill's top."""
    a, b, c, d = cut.quad
    owner = cut.opening.opening_id
    panels = [Panel(owner, _wall(d, a, cut.bottom, cut.top)), Panel(owner, _wall(b, c, cut.bottom, cut.top))]
    panels.append(Panel(owner, _lift(cut.quad[::-1], cut.top)))
    if cut.bottom > 1e-3:
        panels.append(Panel(owner, _lift(cut.quad, cut.bottom)))
    return panels


def _side(segment: Floats, polygon: Polygon) -> tuple[int, float]:
    """Return on which side of the segment (+1 left, -1 right) a room lies, and how far its face is from the centre line."""
    middle = segment.mean(axis=0)
    normal = _left_normal(segment)
    for reach in (0.5, 2.0):
        for side in (1, -1):
            ray = LineString([middle, middle + side * reach * normal])
            hit = ray.intersection(polygon)
            if not hit.is_empty and hit.length > 1e-3:
                return side, float(hit.distance(shapely.Point(middle)))
    centre = np.asarray(polygon.representative_point().coords)[0]
    return (1 if (centre - middle) @ normal > 0 else -1), float(polygon.distance(shapely.Point(middle)))


def _left_normal(segment: Floats) -> Floats:
    along = segment[1] - segment[0]
    return np.asarray(np.array([-along[1], along[0]]) / np.linalg.norm(along))


def _cut(opening: Opening, inner: dict[str, Polygon], plan: Plan) -> Cut:
    depth: dict[int, float] = {}
    for room_id in opening.rooms:
        if room_id in inner:
            side, distance = _side(opening.segment, inner[room_id])
            depth[side] = distance
    wall = plan.inner_wall if len(opening.rooms) > 1 else plan.outer_wall
    left = depth.get(1, wall - depth.get(-1, wall / 2))
    right = depth.get(-1, wall - depth.get(1, wall / 2))
    n, (a, b) = _left_normal(opening.segment), opening.segment
    quad = np.array([a - right * n, b - right * n, b + left * n, a + left * n])
    return Cut(opening, quad, opening.sill, opening.sill + opening.height)


def _hole_polygon(cut: Cut) -> Polygon:
    """Return the hole, a millimetre deeper than the wall, so that no film of wall remains."""
    a, b, c, d = cut.quad
    n = 1e-3 * _left_normal(cut.opening.segment)
    return Polygon([a - n, b - n, c + n, d + n])


def _leaf(cut: Cut, inner: dict[str, Polygon]) -> Leaf | None:
    opening, swing = cut.opening, cut.opening.swing
    if swing is None or opening.kind not in {"door", "entrance"}:
        return None
    hinge, other = opening.segment[swing.hinge], opening.segment[1 - swing.hinge]
    along = (other - hinge) / opening.width
    side = _side(opening.segment, inner[swing.room_id])[0] if swing.room_id in inner else 1
    normal = side * _left_normal(opening.segment)
    turn = 1 if along[0] * normal[1] - along[1] * normal[0] > 0 else -1
    right, left = (float(np.linalg.norm(cut.quad[k] - opening.segment[0])) for k in (0, 3))
    front, back = (left, right) if side > 0 else (right, left)
    width, bottom, top = opening.width - 2 * LEAF_GAP, cut.bottom + LEAF_GAP, cut.top - LEAF_GAP
    return Leaf(opening.opening_id, hinge, along, normal, turn, swing.angle, width, bottom, top, front, back, opening.width)


def _ring_panels(owner: str, ring: Floats, cuts: tuple[Cut, ...], height: float) -> list[Panel]:
    """Return the upright faces along a ring whose visible side is on its left, around the holes that touch it."""
    panels: list[Panel] = []
    sides = np.array([(cut.quad[:2], cut.quad[2:]) for cut in cuts]).reshape(-1, 2, 2)  # both mouths of every hole
    spans = [(cut.bottom, cut.top) for cut in cuts for _ in range(2)]
    for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        length = float(np.linalg.norm(b - a))
        if length < 1e-6:
            continue
        along = (b - a) / length
        start, before = 0.0, (0.0, 0.0)  # heights at which what stands beside a panel ends: its edge has corners there too
        for t0, t1, k in _touching(a, along, length, sides):
            if t0 > start + 1e-6:
                panels.append(Panel(owner, _wall(a + start * along, a + t0 * along, 0.0, height, before, spans[k])))
            bottom, top = spans[k]
            for z0, z1 in ((0.0, bottom), (top, height)):
                if z1 - z0 > 1e-3:
                    panels.append(Panel(owner, _wall(a + t0 * along, a + t1 * along, z0, z1)))
            if t1 > start:
                start, before = t1, spans[k]
        if length > start + 1e-6:
            panels.append(Panel(owner, _wall(a + start * along, b, 0.0, height, before)))
    return panels


def _touching(a: Floats, along: Floats, length: float, sides: Floats) -> list[tuple[float, float, int]]:
    """Return (start, end, side) of the holes whose `sides` (2C, 2, 2) lie in the edge from `a`, in the order along it."""
    away = sides - a
    offset = np.abs(away @ np.array([-along[1], along[0]])).max(axis=1)
    t = np.clip(away @ along, 0.0, length)
    low, high = t.min(axis=1), t.max(axis=1)
    return sorted((float(low[k]), float(high[k]), int(k)) for k in np.flatnonzero((offset < 2e-3) & (high - low > 1e-3)))


def _wall(a: Floats, b: Floats, z0: float, z1: float, at_a: Sequence[float] = (), at_b: Sequence[float] = ()) -> Floats:
    """Return the upright rectangle over a → b, counter-clockwise for one who stands on the left of a → b, with corners at more heights on either edge."""
    up, down = ([z for z in heights if z0 + 1e-3 < z < z1 - 1e-3] for heights in (at_a, at_b))
    return np.array([[*b, z0], [*a, z0], *([*a, z] for z in up), [*a, z1], [*b, z1], *([*b, z] for z in reversed(down))])


def _drawn_in(polygon: Floats) -> Floats:
    """Return a polygon (n, 2) with its corners SEAM towards its middle: tops of walls that meet in a corner have points of their own there."""
    inward = polygon.mean(axis=0) - polygon
    return np.asarray(polygon + SEAM * inward / np.linalg.norm(inward, axis=1, keepdims=True))


def _lift(polygon: Floats, z: float) -> Floats:
    return np.column_stack([polygon, np.full(len(polygon), z)])
