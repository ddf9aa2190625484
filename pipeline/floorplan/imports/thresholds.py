"""Floors that reach into the walls under doors, as those of scanned and modelled houses do: cut back, and walls where a door asks for one."""

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely

from pipeline.arrays import Floats
from pipeline.floorplan.imports.rings import LEAST_AREA, corners_of, without_collinear
from pipeline.floorplan.imports.sketch import Sketch, SketchRoom
from pipeline.floorplan.imports.wall_stretches import TOUCH, Stretch, edges, stretches

DEEPEST = 0.45  # [m] of a wall that a floor reaches into
WIDER = 0.3  # [m] by which a threshold is wider than what is clear of its door, on each side
HALFWAY = 0.03  # [m] before the middle of its wall: a floor that ends before has a niche, not a threshold
STEP = 0.02  # [m] a lower step in a floor's edge is none
NEXT = 0.6  # [m] beside a threshold, where the wall goes on
PARALLEL = 0.05  # sine
OPEN = frozenset({"open", "portal"})


@dataclass(frozen=True, slots=True)
class Edge:
    """An edge of a room beside an opening: `low` to `high` along it and `off` across it [m], towards the outside of the room."""

    low: float
    high: float
    off: float


def cut_back(sketch: Sketch, inner: float, outer: float) -> None:
    """Take what lies under the openings off the floors, stating it by room; `inner` and `outer` [m] are usual thicknesses of walls."""
    rooms = {room.room_id: room for room in sketch.rooms}
    counts: Counter[str] = Counter()
    for opening in sketch.openings:
        if opening.kind == "window" or opening.segment is None:
            continue
        for name in opening.rooms:
            ring = _without_threshold(rooms[name].ring, opening.segment, outer if len(opening.rooms) == 1 else inner)
            if ring is not None:
                rooms[name].ring = ring
                counts[name] += 1
    for name, count in counts.items():
        under = f"{count} opening{'s' * (count > 1)}"
        sketch.repair("threshold", name, f"its floor reaches into the wall under {under}: it is cut back to the wall")


def _without_threshold(ring: Floats, segment: Floats, wall: float) -> Floats | None:
    """Return a room's ring without the strip under an opening in a wall of that thickness [m], None where there is no such strip."""
    a, b = segment
    width, middle = float(np.linalg.norm(b - a)), (a + b) / 2
    along = (b - a) / width
    across = np.array([-along[1], along[0]])
    for side in (1.0, -1.0):
        around = list(_beside(ring, middle, along, side * across))
        for end in around:
            if end.low < -width / 2 - WIDER or end.high > width / 2 + WIDER or end.off < -HALFWAY or end.low > 0.0 or end.high < 0.0:
                continue
            next_to = [e for e in around if end.low - NEXT < e.high <= end.low + STEP or end.high - STEP <= e.low < end.high + NEXT]
            mains = [e for e in next_to if STEP < end.off - e.off <= DEEPEST]
            if not mains and end.off < STEP:
                continue
            # a door as wide as its room has no wall beside it that shows where the floor should end
            face = max(mains, key=lambda e: e.high - e.low).off if mains else -wall / 2
            corners = [(end.low - 1e-3, face), (end.high + 1e-3, face), (end.high + 1e-3, end.off + 1e-3), (end.low - 1e-3, end.off + 1e-3)]
            strip = shapely.Polygon([middle + u * along + v * side * across for u, v in corners])
            return _rest(ring, strip)
    return None


def _beside(ring: Floats, middle: Floats, along: Floats, out: Floats) -> Iterator[Edge]:
    """Yield the edges of a counter-clockwise ring near an opening that run along it and have the outside towards `out`."""
    for p, q, way in edges(ring):
        if abs(float(way @ out)) > PARALLEL or float(np.array([way[1], -way[0]]) @ out) < 0.0:
            continue
        off = float(((p + q) / 2 - middle) @ out)
        low, high = sorted((float((p - middle) @ along), float((q - middle) @ along)))
        if abs(off) <= DEEPEST:
            yield Edge(low, high, off)


def _rest(ring: Floats, strip: shapely.Polygon) -> Floats | None:
    """Return the ring of a room less a strip, None where no room would be left."""
    left = shapely.Polygon(ring).difference(strip)
    parts = [p for p in shapely.get_parts(left) if isinstance(p, shapely.Polygon)]
    largest = max(parts, key=lambda p: p.area, default=None)
    if largest is None or largest.area < LEAST_AREA or largest.area < 0.8 * shapely.Polygon(ring).area:
        return None
    return np.round(without_collinear(np.round(corners_of(largest), 4)), 4) + 0.0


def put_walls(sketch: Sketch, thickness: float) -> None:
    """Where rooms touch and are not open to each other on all that length, move their edges apart until there is a wall, stating it."""
    done: set[tuple[tuple[str, ...], float]] = set()
    while near := next((s for s in _touching(sketch) if _mark(s) not in done), None):
        done.add(_mark(near))
        pair = [room for room in sketch.rooms if room.room_id in near.rooms]
        middle = near.start + near.length / 2 * near.along
        rings = [ring for room in pair if (ring := _moved_in(room, middle, near, thickness / 2)) is not None]
        if len(rings) < len(pair):
            continue
        for room, ring in zip(pair, rings, strict=True):
            room.ring = ring
        names = " and ".join(near.rooms)
        sketch.repair("wall", "plan", f"{names} touch with a wall between them: {100 * thickness:.0f} cm of their floors become that wall")


def _mark(stretch: Stretch) -> tuple[tuple[str, ...], float]:
    """Return what tells a stretch from the others between its rooms: they may touch on several sides."""
    return stretch.rooms, round(math.atan2(stretch.along[1], stretch.along[0]), 1) * 1000 + round(float(stretch.start @ stretch.left))


def _touching(sketch: Sketch) -> Iterator[Stretch]:
    """Yield where rooms touch on more than the open fronts and portals between them."""
    known = [r.room() for r in sketch.rooms]
    fronts = [(set(o.rooms), o.segment) for o in sketch.openings if o.kind in OPEN and o.segment is not None]
    for stretch in stretches(known, 0, DEEPEST):
        if len(stretch.rooms) == 2 and stretch.thickness < TOUCH:
            line = shapely.LineString(stretch.at(0.0, stretch.length))
            here = [s for rooms, s in fronts if rooms == set(stretch.rooms) and line.distance(shapely.Point(s.mean(axis=0))) <= DEEPEST]
            if sum(float(np.linalg.norm(s[1] - s[0])) for s in here) < stretch.length - WIDER:
                yield stretch


def _moved_in(room: SketchRoom, middle: Floats, near: Stretch, by: float) -> Floats | None:
    """Return a room's ring with the edge on a stretch moved `by` [m] into the room."""
    for p, q, way in edges(room.ring):
        off, place = abs(float((p - middle) @ near.left)), float((middle - p) @ way)
        if (
            abs(float(way @ near.left)) < PARALLEL
            and off <= TOUCH + near.thickness
            and -STEP <= place <= float(np.linalg.norm(q - p)) + STEP
        ):
            inward = np.array([-way[1], way[0]])
            return _rest(room.ring, shapely.Polygon([p - 1e-3 * inward, q - 1e-3 * inward, q + by * inward, p + by * inward]))
    return None
