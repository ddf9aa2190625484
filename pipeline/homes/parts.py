"""Rooms that serve as several: a studio is a bedroom and a living room, an eat-in kitchen a kitchen and a place to dine.

The layout model knows rooms that serve as one. A room of several is cut into parts, a straight line each; what is furnished is each part,
open to its neighbours, and what is arranged and judged is the whole.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from pipeline.arrays import Floats
from pipeline.diffusion.context import RoomContext, RoomOpening

LAST = ("living_room", "living_dining_room", "dining_room")  # what keeps the rest of the floor when the others have been cut off
QUIET, DOOR = "bedroom", 0.15  # whose part is better without doors, and what each costs it, beside 1 for a square's shape
CUT = 0.4  # cost of a cut that ends in a door or window
EXACT = 1e-9  # of the corners of parts [m]
AWAY = 0.01  # cuts are tried this near to the right area [share of the width]


@dataclass(frozen=True, slots=True)
class Cut:
    """A polygon cut in two, `part` and `rest`, along `line` (2, 2) [m]; `merit` says how good it is."""

    part: shapely.Polygon
    rest: shapely.Polygon
    line: Floats
    merit: float


def split_room(room: RoomContext, areas: Sequence[tuple[str, float]]) -> list[RoomContext]:
    """Return the parts of a room in the order of `areas`, which are layout types and their usual areas [m2]; the room itself where there is one or no good cut."""
    if len(areas) < 2:
        return [replace(room, layout_type=areas[0][0])] if areas else [room]
    rest, openings = shapely.Polygon(room.polygon), list(room.openings)
    order = sorted(range(len(areas)), key=lambda k: (areas[k][0] in LAST, -k))
    parts: dict[int, RoomContext] = {}
    for place, k in enumerate(order[:-1]):
        kind, left = areas[k][0], sum(areas[i][1] for i in order[place:])
        cut = _best_cut(rest, areas[k][1] / left, openings, kind)
        if cut is None:
            return [replace(room, layout_type=areas[order[-1]][0])]
        within = [o for o in openings if _nearer(o, cut.part, cut.rest)]
        between = RoomOpening("open", cut.line)
        parts[k] = replace(room, layout_type=kind, polygon=_ring(cut.part), openings=(*within, between))
        rest, openings = cut.rest, [*(o for o in openings if not _nearer(o, cut.part, cut.rest)), between]
    parts[order[-1]] = replace(room, layout_type=areas[order[-1]][0], polygon=_ring(rest), openings=tuple(openings))
    return [parts[k] for k in range(len(areas))]


def _best_cut(whole: shapely.Polygon, share: float, openings: Sequence[RoomOpening], kind: str) -> Cut | None:
    """Return the best straight cut, square to the longest wall, that gives one of its sides this share of the area."""
    ring = _ring(whole)
    edges = np.roll(ring, -1, axis=0) - ring
    along = edges[int(np.argmax(np.round(np.linalg.norm(edges, axis=1), 6)))]
    yaw = math.atan2(along[1], along[0])
    cuts = []
    for turn in range(4):
        way = np.array([math.cos(yaw + turn * math.pi / 2), math.sin(yaw + turn * math.pi / 2)])
        cut = _cut_off(whole, way, share, openings, kind)
        if cut is not None:
            cuts.append(cut)
    return max(cuts, key=lambda cut: round(cut.merit, 6), default=None)


def _cut_off(whole: shapely.Polygon, way: Floats, share: float, openings: Sequence[RoomOpening], kind: str) -> Cut | None:
    """Cut off the side of a polygon that lies towards `way` (2,); None where a piece would be in pieces."""
    ring = _ring(whole)
    reach = ring @ way
    low, high = float(reach.min()), float(reach.max())
    side = np.array([-way[1], way[0]])
    wide = float(np.ptp(ring @ side)) + float(np.abs(ring).max()) * 2 + 1.0

    def beyond(at: float) -> shapely.Geometry:
        corners = [a * way + b * side for a, b in ((at, -wide), (high + 1, -wide), (high + 1, wide), (at, wide))]
        return shapely.intersection(whole, shapely.Polygon(corners))

    first, last = low, high
    while last - first > AWAY * (high - low):
        middle = (first + last) / 2
        first, last = (middle, last) if beyond(middle).area > share * whole.area else (first, middle)
    part = beyond((first + last) / 2)
    part, rest = shapely.set_precision([part, shapely.difference(whole, part)], EXACT)  # a side off by a last bit leaves a spike
    if part.geom_type != "Polygon" or rest.geom_type != "Polygon":
        return None
    line = shapely.intersection(part.boundary, rest.boundary)
    line = shapely.line_merge(line) if line.geom_type == "MultiLineString" else line
    if line.geom_type != "LineString":
        return None
    ends = np.array(line.coords)[[0, -1]]
    merit = min(_squareness(part), _squareness(rest))
    passages = [o for o in openings if o.kind != "window" and _nearer(o, part, rest)]
    merit -= DOOR * len(passages) if kind == QUIET else 0.0
    merit -= CUT * sum(_crosses_opening(o, (first + last) / 2, way) for o in openings)
    return Cut(part, rest, ends, merit)


def _squareness(polygon: shapely.Polygon) -> float:
    return float(16 * polygon.area / polygon.length**2)


def _nearer(opening: RoomOpening, part: shapely.Polygon, rest: shapely.Polygon) -> bool:
    middle = shapely.Point(opening.segment.mean(0))
    return bool(part.distance(middle) < rest.distance(middle))


def _crosses_opening(opening: RoomOpening, at: float, way: Floats) -> bool:
    """Whether a line across `way` runs through an opening."""
    ends = np.sort(opening.segment @ way)
    return bool(ends[0] < at < ends[1])


def _ring(polygon: shapely.Polygon) -> Floats:
    """Return the corners (n, 2) of a polygon, counter-clockwise."""
    return np.array(shapely.geometry.polygon.orient(polygon.simplify(1e-6)).exterior.coords)[:-1]
