"""What a drawing of a plan consists of, in metres: filled areas, lines and words, one storey beside the other."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from pipeline.entities.plan import Opening, Plan, Room
from pipeline.geometry.stairs import visible_steps
from pipeline.geometry.walls import levels

COLOURS = {
    "living_room": "#f6e8c4", "family_room": "#f6e8c4", "studio_room": "#f6e8c4", "kitchen": "#f4cfae", "dining_room": "#f3dcca",
    "bedroom": "#d0dff0", "bathroom": "#c0e2df", "wc": "#c0e2df", "hallway": "#efeeea", "entry": "#e8e7e0", "balcony": "#d6e9cc",
    "garage": "#dcdcdc", "staircase": "#e9e1d4", "office": "#dfd5ec", "library": "#dfd5ec",
}  # fmt: skip
OTHER = "#e9e2d7"
WALL, INK, FAINT, LEAF, WAY, GLASS = "#3d4045", "#26282c", "#8a8d92", "#8a5a2b", "#c0392b", "#6fa8d6"
GAP, MARGIN = 1.6, 1.15  # between storeys, and around all [m]: dimensions find place there
LETTER = 0.56  # width of a letter over its height, on the safe side
SIZES = (0.24, 0.19, 0.15, 0.12)  # heights of a room's name that are tried [m]
AWAY = 0.7  # from outer walls to their dimensions: the entrance's arrow finds place between [m]
CLEAR = 0.06  # between words and lines [m]

Points = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Area:
    """A filled polygon: its outer ring, then holes; `edge` the colour of a hair line around it."""

    rings: tuple[Points, ...]
    fill: str
    edge: str = ""


@dataclass(frozen=True, slots=True)
class Line:
    """A line of `width` [m]."""

    points: Points
    colour: str
    width: float = 0.015


@dataclass(frozen=True, slots=True)
class Words:
    """A line of text `size` [m] high, its middle at `at`; `turned` reads upwards."""

    text: str
    at: tuple[float, float]
    size: float
    colour: str = INK
    turned: bool = False


Mark = Area | Line | Words


def on_level(plan: Plan, level: int) -> list[Room]:
    """Return the rooms of a storey; a staircase stands on every storey from its own upwards."""
    return [r for r in plan.rooms if level in plan.levels_of(r)]


def bounds(plan: Plan) -> tuple[float, float, float, float]:
    """Return x0, y0, x1, y1 of the outer walls of all storeys [m]."""
    points = np.vstack([r.polygon for r in plan.rooms])
    (x0, y0), (x1, y1) = points.min(axis=0) - plan.outer_wall, points.max(axis=0) + plan.outer_wall
    return float(x0), float(y0), float(x1), float(y1)


def marks(plan: Plan) -> tuple[list[tuple[Mark, Points]], float, float]:
    """Return the marks, what lies below first, each with its shift on the sheet, and the sheet's width and height [m]; its lower left corner is the origin."""
    x0, y0, x1, y1 = bounds(plan)
    step = x1 - x0 + GAP
    shifts = [np.array([MARGIN - x0 + level * step, MARGIN - y0]) for level in levels(plan)]
    elements = [(mark, shift) for level, shift in enumerate(shifts) for mark in _storey(plan, level)]
    return elements, len(shifts) * step - GAP + 2 * MARGIN, y1 - y0 + 2 * MARGIN


def _storey(plan: Plan, level: int) -> Iterator[Mark]:
    rooms = on_level(plan, level)
    whole = shapely.union_all([shapely.Polygon(r.polygon).buffer(plan.outer_wall, join_style="mitre") for r in rooms])
    walls = whole.difference(shapely.union_all([shapely.Polygon(r.polygon) for r in rooms]))
    for piece in getattr(walls, "geoms", [walls]):
        yield Area(tuple(np.asarray(r.coords)[:-1] for r in (piece.exterior, *piece.interiors)), WALL)
    for room in rooms:
        yield Area((room.polygon,), COLOURS.get(room.type, OTHER))
    yield from _stairs(plan, level)
    openings = [o for o in plan.openings if o.level == level]
    for opening in openings:
        yield from _opening(plan, opening, rooms)
    climbed = [shapely.Point(s.polygon.mean(axis=0)) for s in visible_steps(plan, level)]
    for room in rooms:
        if room.type == "staircase" and any(shapely.Polygon(room.polygon).contains(p) for p in climbed):
            continue  # its steps say what it is
        yield from _label(room, [o for o in openings if room.room_id in o.rooms], plan)
    yield from _dimensions(whole.bounds)
    if len(levels(plan)) > 1:
        yield Words(f"level {level}", (float(whole.bounds[0]) + 0.5, float(whole.bounds[1]) - AWAY - 0.22), 0.26, FAINT)


def _stairs(plan: Plan, level: int) -> Iterator[Mark]:
    """Yield the edges of steps, and an arrow upwards on the storey where a flight begins."""
    for step in visible_steps(plan, level):
        if step.kind in {"step", "landing"}:
            yield Line(np.vstack([step.polygon, step.polygon[:1]]), FAINT)
    for room in on_level(plan, level):
        inside = shapely.Polygon(room.polygon)
        rising = [s for s in visible_steps(plan, level) if s.kind == "step" and s.top > 0.0]
        flight = [s for s in rising if inside.contains(shapely.Polygon(s.polygon).centroid)]
        if flight:
            walk = np.array([s.polygon.mean(axis=0) for s in flight])
            yield Line(walk, INK, 0.02)
            yield Area((_arrow(walk[-1], walk[-1] - walk[-2], 0.2),), INK)


def _arrow(tip: Points, along: Points, size: float) -> Points:
    ahead = along / np.linalg.norm(along)
    side = np.array([-ahead[1], ahead[0]])
    return np.array([tip + 0.6 * size * ahead, tip - 0.4 * size * ahead + 0.4 * size * side, tip - 0.4 * size * ahead - 0.4 * size * side])


def cutout(plan: Plan, opening: Opening) -> Points:
    """Return the rectangle (4, 2) that an opening cuts out of its wall."""
    p, q = opening.segment
    along = (q - p) / np.linalg.norm(q - p)
    normal = np.array([-along[1], along[0]])
    half = (plan.inner_wall if len(opening.rooms) == 2 else plan.outer_wall) / 2 + 0.005
    return np.array([p - half * normal, q - half * normal, q + half * normal, p + half * normal])


def leaf(plan: Plan, opening: Opening) -> tuple[Points, Points] | None:
    """Return the open leaf (2, 2) and the arc (k, 2) of its tip, or None for an opening without a leaf."""
    if opening.swing is None:
        return None
    pivot, tip = opening.segment[opening.swing.hinge], opening.segment[1 - opening.swing.hinge]
    along = tip - pivot
    normal = np.array([-along[1], along[0]])
    inside = shapely.Polygon(plan.room(opening.swing.room_id).polygon)
    if not inside.buffer(0.01).contains(shapely.Point((pivot + tip) / 2 + 0.35 * normal)):
        normal = -normal
    angles = np.linspace(0.0, opening.swing.angle, 16)
    arc = pivot + np.cos(angles)[:, None] * along + np.sin(angles)[:, None] * normal
    return np.array([pivot, arc[-1]]), arc


def _opening(plan: Plan, opening: Opening, rooms: Sequence[Room]) -> Iterator[Mark]:
    around = cutout(plan, opening)
    types = {r.room_id: r.type for r in rooms}
    if opening.kind == "window":
        yield Area((around,), "#ffffff", WALL)
        yield Line(opening.segment, GLASS, 0.04)
        return
    outside = len(opening.rooms) == 1
    yield Area((around,), "#ffffff" if outside else COLOURS.get(types.get(opening.rooms[0], ""), OTHER))
    if outside and opening.swing is None:
        yield Line(opening.segment, FAINT, 0.05)  # a gate
    turned = leaf(plan, opening)
    if turned:
        colour = WAY if opening.kind == "entrance" else LEAF
        yield Line(turned[1], colour)
        yield Line(turned[0], colour, 0.045)
    if opening.kind == "entrance" and opening.rooms[0] in types:
        middle = opening.segment.mean(axis=0)
        across = (around[3] - around[0]) / np.linalg.norm(around[3] - around[0])
        inside = shapely.Polygon(plan.room(opening.rooms[0]).polygon)
        inward = across if inside.distance(shapely.Point(middle + across)) < inside.distance(shapely.Point(middle - across)) else -across
        yield Area((_arrow(middle - (plan.outer_wall / 2 + 0.3) * inward, inward, 0.4),), WAY)


def _label(room: Room, openings: Sequence[Opening], plan: Plan) -> Iterator[Mark]:
    """Yield a room's name, area and, of rectangles, sides; where no leaf turns, as large as finds place."""
    x0, y0, x1, y1 = shapely.Polygon(room.polygon).bounds
    lines = [(room.name or room.room_id).replace("_", " "), f"{room.area:.1f} m²"]
    sides = [f"{x1 - x0:.2f} x {y1 - y0:.2f}"] if len(room.polygon) == 4 else []
    turned = [t for o in openings if (t := leaf(plan, o)) is not None]
    taken = shapely.union_all([shapely.Polygon(np.vstack([t[0][:1], t[1]])).buffer(CLEAR) for t in turned])
    free = shapely.Polygon(room.polygon).buffer(-CLEAR).difference(taken)
    for size in SIZES:
        for shown in (lines + sides, lines):
            at = _place(room, free, size * LETTER * max(map(len, shown)), 1.25 * size * len(shown))
            if at is not None:
                yield from _text_block(shown, at, size)
                return
    yield from _text_block(lines, label_point(room), SIZES[-1])


def _text_block(lines: Sequence[str], at: tuple[float, float], size: float) -> Iterator[Mark]:
    for k, text in enumerate(lines):
        y = at[1] + 1.25 * size * ((len(lines) - 1) / 2 - k)
        yield Words(text, (at[0], y), size if k == 0 else 0.85 * size, INK if k == 0 else "#5c5f64")


def _place(room: Room, free: shapely.Geometry, width: float, height: float) -> tuple[float, float] | None:
    """Return the middle of a free box of that size nearest to the room's middle."""
    x0, y0, x1, y1 = shapely.Polygon(room.polygon).bounds
    columns, rows = np.arange(x0 + width / 2, x1 - width / 2 + 1e-9, 0.1), np.arange(y0 + height / 2, y1 - height / 2 + 1e-9, 0.1)
    middle = label_point(room)
    xs, ys = (np.append(places, at) for places, at in zip(np.meshgrid(columns, rows), middle, strict=True))
    shapely.prepare(free)
    fits = shapely.contains(free, shapely.box(xs - width / 2, ys - height / 2, xs + width / 2, ys + height / 2))
    if not fits.any():
        return None
    away = np.where(fits, np.hypot(xs - middle[0], ys - middle[1]), np.inf)
    best = int(away.argmin())
    return float(xs[best]), float(ys[best])


def label_point(room: Room) -> tuple[float, float]:
    """Return the middle of a room, or where that lies outside a point inside."""
    inside = shapely.Polygon(room.polygon)
    point = inside.centroid if inside.contains(inside.centroid) else inside.representative_point()
    return float(point.x), float(point.y)


def _dimensions(around: Sequence[float]) -> Iterator[Mark]:
    """Yield width and depth of the storey over its outer walls, below it and on its left."""
    x0, y0, x1, y1 = around
    low, left, tick = y0 - AWAY, x0 - AWAY, 0.1
    yield Line(np.array([[x0, low], [x1, low]]), FAINT)
    yield Line(np.array([[left, y0], [left, y1]]), FAINT)
    for x, y in ((x0, low), (x1, low), (left, y0), (left, y1)):
        yield Line(np.array([[x - tick, y - tick], [x + tick, y + tick]]), FAINT)
    yield Words(f"{x1 - x0:.2f} m", ((x0 + x1) / 2, low - 0.22), 0.2, "#5c5f64")
    yield Words(f"{y1 - y0:.2f} m", (left - 0.22, (y0 + y1) / 2), 0.2, "#5c5f64", turned=True)
