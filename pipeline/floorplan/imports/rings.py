"""Rings of corners as room polygons: one unit, counter-clockwise, nothing twice, nothing crossing, no two rooms in one place."""

import itertools
import math

import numpy as np
import shapely
from shapely.validation import explain_validity

from pipeline.arrays import Floats
from pipeline.floorplan.imports.sketch import MAX_CORNERS, Sketch, SketchRoom, refuse

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "in": 0.0254}
SAME = 1e-3  # [m] corners nearer than this are one
LEAST_AREA = 1.0  # [m2]
HIGHEST, LOWEST = 8.0, 1.8  # of a room [m]
FAR = 1000.0  # [m] a plan farther than this from the origin is moved to it
WIDEST = 300.0  # [m] a home is not wider
OVERLAP, SLIVER = 1e-4, 0.02  # [m2] that two rooms may share by rounding; [m] depth of an overlap that is trimmed
LEVELS = 3
LARGEST = 5000.0  # [m2] of a home


def to_metres(sketch: Sketch) -> None:
    """Scale everything to metres. Where the file states no unit, rooms' sizes tell m, cm and mm apart, and a repair says so."""
    sides = [math.sqrt(abs(_signed_area(r.ring))) for r in sketch.rooms if len(r.ring) >= 3]
    middle = float(np.median(sides)) if sides else 0.0
    if sketch.units and sketch.units not in UNITS:
        raise refuse(f"the unit {sketch.units[:20]!r} is unknown", f"units are {', '.join(UNITS)}")
    unit = sketch.units or _likely(middle)
    if unit == "m":
        return
    if not sketch.units:
        sketch.repair("units", "plan", f"no unit is stated and rooms are {middle:.0f} wide: lengths are taken as {unit}")
    scale = UNITS[unit]
    sketch.move(lambda points: points * scale)
    # a short form may state heights and thicknesses in metres beside millimetres of corners
    lengths = (("width", 0.0), ("height", HIGHEST), ("sill", HIGHEST), ("inner_wall", 0.7), ("outer_wall", 0.7), ("storey_height", HIGHEST))
    for item in (sketch, *sketch.rooms, *sketch.openings):
        for name, most in lengths:
            value = getattr(item, name, None)
            if value is not None and value > most:
                setattr(item, name, value * scale)


def _likely(side: float) -> str:
    """Return the unit in which rooms of that middle side are rooms: 30 m, 80 cm and 1.1 m are where they part."""
    if 80.0 <= side < 1100.0:
        return "cm"
    if 1100.0 <= side < 50_000.0:
        return "mm"
    if side >= 30.0:
        raise refuse(f"its rooms are {side:.0f} units wide, which is neither metres nor centimetres nor millimetres", "state `units`")
    return "m"


def clean_rings(sketch: Sketch) -> None:
    """Make every ring a room polygon, stating repairs. Raises RefusedError for what cannot be one."""
    corners = np.vstack([r.ring for r in sketch.rooms if len(r.ring)] or [np.zeros((1, 2))])
    span = np.ptp(corners, axis=0)
    if span.max() > WIDEST:
        raise refuse(f"it is {span.max():.0f} m wide; a home is at most {WIDEST:g} m")
    if np.abs(corners).max() > FAR:
        origin = np.floor(corners.min(axis=0))
        sketch.repair("origin", "plan", f"it lies {np.linalg.norm(origin) / 1000:.1f} km from the origin and is moved there")
        sketch.move(lambda points: points - origin)
    for room in sketch.rooms:
        if len(room.ring) > MAX_CORNERS:
            raise refuse(f"{room.room_id} has {len(room.ring)} corners; at most {MAX_CORNERS} are read")
        if not 0 <= room.level < LEVELS:
            raise refuse(f"{room.room_id} is on level {room.level}; levels are 0 to {LEVELS - 1}")
        if not LOWEST <= room.height <= HIGHEST:
            raise refuse(f"{room.room_id} is {room.height:g} m high; {LOWEST:g} to {HIGHEST:g} m can be built")
        room.ring = _ring(sketch, room)
    whole = sum(shapely.Polygon(r.ring).area for r in sketch.rooms)
    if whole > LARGEST:
        raise refuse(f"it has {whole:.0f} m2; a home has {LARGEST:g} m2 at most")


def _ring(sketch: Sketch, room: SketchRoom) -> Floats:
    ring, name = room.ring, room.room_id
    if len(ring) > 1 and np.linalg.norm(ring[0] - ring[-1]) < SAME:
        ring = ring[:-1]
        sketch.repair("closing_corner", name, "the last corner repeats the first and is dropped")
    apart = np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1) >= SAME
    if not apart.all() and len(ring) > 1:
        sketch.repair("duplicate", name, f"{int((~apart).sum())} corners repeat the one before and are dropped")
        ring = ring[apart]
    if len(ring) < 3:
        raise refuse(f"{name} has {len(ring)} different corners; a room has at least 3")
    straight = without_collinear(ring)
    if len(straight) < len(ring):
        sketch.repair("collinear", name, f"{len(ring) - len(straight)} corners on straight walls are dropped")
    if len(straight) < 3:
        raise refuse(f"{name} has no area: its corners lie on a line")
    shape = shapely.Polygon(straight)
    if not shape.is_valid:
        message = f"the outline of {name} crosses or touches itself ({explain_validity(shape)})"
        raise refuse(message, "give its corners in order, once around")
    if _signed_area(straight) < 0:
        straight = straight[::-1]
        sketch.repair("clockwise", name, "its corners run clockwise and are turned round")
    if shape.area < LEAST_AREA:
        raise refuse(f"{name} has {shape.area:.3f} m2; the least is {LEAST_AREA:g} m2", "make it larger, leave it out, or state `units`")
    return np.round(straight, 3) + 0.0


def without_collinear(ring: Floats) -> Floats:
    """Drop corners within a millimetre of the line between their neighbours, spikes included, until none is left."""
    kept = ring
    while len(kept) >= 3:
        before, after = np.roll(kept, 1, axis=0), np.roll(kept, -1, axis=0)
        span = after - before
        length = np.hypot(span[:, 0], span[:, 1])
        cross = np.abs(span[:, 0] * (kept[:, 1] - before[:, 1]) - span[:, 1] * (kept[:, 0] - before[:, 0]))
        flat = np.where(length < SAME, True, cross / np.maximum(length, SAME) < SAME)
        if not flat.any():
            break
        kept = np.delete(kept, int(np.argmax(flat)), axis=0)
    return kept


def trim_overlaps(sketch: Sketch) -> None:
    """Trim rooms that overlap by less than SLIVER, stating it. Raises RefusedError for rooms that overlap by more.

    In a house of a dataset the later room gives way, however much it is, as long as one room is left of it.
    """
    for a, b in itertools.combinations(sketch.rooms, 2):
        if not share_level(a, b):
            continue
        one, two = shapely.Polygon(a.ring), shapely.Polygon(b.ring)
        common = one.intersection(two)
        if common.area <= OVERLAP:
            continue
        depth = 2 * common.area / max(common.length, 1e-9)
        rest = two.difference(one.buffer(SAME, join_style="mitre"))
        if sketch.foreign:
            rest = max(shapely.get_parts(rest), key=lambda p: p.area, default=rest)
        room = isinstance(rest, shapely.Polygon) and not rest.interiors and rest.area >= LEAST_AREA
        if not room or (depth > SLIVER and not sketch.foreign):
            raise refuse(f"{a.room_id} and {b.room_id} overlap by {common.area:.3g} m2", "rooms of one storey must not overlap")
        b.ring = np.round(without_collinear(corners_of(rest)), 3)
        sketch.repair("overlap", b.room_id, f"{100 * depth:.1f} cm of it lay in {a.room_id} and are cut off")


def share_level(a: SketchRoom, b: SketchRoom) -> bool:
    """Whether two rooms meet on a storey; a staircase goes through all of them."""
    return a.level == b.level or "staircase" in {a.type, b.type}


def shrink_rooms(sketch: Sketch, by: float) -> None:
    """Move all walls `by` [m] into their rooms: from centre lines to inner faces."""
    for room in sketch.rooms:
        inner = shapely.Polygon(room.ring).buffer(-by, join_style="mitre", mitre_limit=10.0)
        if not isinstance(inner, shapely.Polygon) or inner.is_empty or inner.area < LEAST_AREA:
            raise refuse(f"{room.room_id} is too small or too narrow for walls {200 * by:.0f} cm thick on its centre lines")
        room.ring = np.round(without_collinear(corners_of(inner)), 3) + 0.0


def corners_of(shape: shapely.Polygon) -> Floats:
    """Return the corners of a polygon's outline, counter-clockwise."""
    return np.asarray(shapely.geometry.polygon.orient(shape, 1.0).exterior.coords)[:-1]


def _signed_area(ring: Floats) -> float:
    x, y = ring.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
