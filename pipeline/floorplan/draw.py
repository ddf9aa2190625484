"""Drawings of a plan: SVG text, a PIL image, and a picture in characters for terminals. One storey beside the other."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence

import numpy as np
import shapely
from PIL import Image, ImageDraw, ImageFont

from pipeline.entities.plan import Opening, Plan, Room

COLOURS = {
    "living_room": "#f6e3b4",
    "family_room": "#f6e3b4",
    "studio_room": "#f6e3b4",
    "kitchen": "#f4c7a1",
    "dining_room": "#f3d6c0",
    "bedroom": "#c9d9ee",
    "bathroom": "#b9e0dc",
    "wc": "#b9e0dc",
    "hallway": "#eeeeea",
    "entry": "#e4e4dc",
    "balcony": "#cfe6c3",
    "garage": "#d5d5d5",
    "staircase": "#dcd2e6",
    "office": "#d9cdea",
    "library": "#d9cdea",
}
OTHER = "#e6dfd3"
WALL, GAP = "#4a4a4a", 1.5  # GAP: metres between storeys


def _levels(plan: Plan) -> list[int]:
    return list(range(max(r.level for r in plan.rooms) + 1))


def _bounds(plan: Plan) -> tuple[float, float, float, float]:
    points = np.vstack([r.polygon for r in plan.rooms])
    (x0, y0), (x1, y1) = points.min(axis=0) - 2 * plan.outer_wall, points.max(axis=0) + 2 * plan.outer_wall
    return float(x0), float(y0), float(x1), float(y1)


def _on(plan: Plan, level: int) -> list[Room]:
    """Rooms of a storey; a staircase stands on every storey from its own upwards."""
    return [r for r in plan.rooms if r.level == level or (r.type == "staircase" and r.level <= level)]


def _walls(plan: Plan, rooms: Sequence[Room]) -> shapely.Geometry:
    """Floor of all walls: the rooms grown by the outer wall and closed, less the rooms."""
    whole = shapely.union_all([shapely.Polygon(r.polygon).buffer(plan.outer_wall, join_style="mitre") for r in rooms])
    return whole.difference(shapely.union_all([shapely.Polygon(r.polygon) for r in rooms]))


def hole(plan: Plan, opening: Opening) -> np.ndarray:
    """Return the rectangle (4, 2) that an opening cuts out of its wall."""
    p, q = opening.segment
    along = (q - p) / np.linalg.norm(q - p)
    normal = np.array([-along[1], along[0]])
    half = (plan.inner_wall if len(opening.rooms) == 2 else plan.outer_wall) / 2 + 0.005
    return np.array([p - half * normal, q - half * normal, q + half * normal, p + half * normal])


def leaf(plan: Plan, opening: Opening) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the open leaf (2, 2) and the arc (k, 2) of its tip, or None for an opening without a leaf."""
    if opening.swing is None:
        return None
    pivot, tip = opening.segment[opening.swing.hinge], opening.segment[1 - opening.swing.hinge]
    along = tip - pivot
    normal = np.array([-along[1], along[0]])
    middle = plan.room(opening.swing.room_id).polygon
    inside = shapely.Polygon(middle)
    if not inside.buffer(0.01).contains(shapely.Point((pivot + tip) / 2 + 0.35 * normal)):
        normal = -normal
    angles = np.linspace(0.0, opening.swing.angle, 10)
    arc = pivot + np.cos(angles)[:, None] * along + np.sin(angles)[:, None] * normal
    return np.array([pivot, arc[-1]]), arc


def svg(plan: Plan, scale: float = 60.0) -> str:
    """Return the plan as SVG; `scale` in pixels a metre."""
    x0, y0, x1, y1 = _bounds(plan)
    width, height = x1 - x0, y1 - y0
    levels = _levels(plan)
    full = len(levels) * width + (len(levels) - 1) * GAP

    def text(points: np.ndarray, level: int) -> str:
        shifted = (points - (x0, y0)) * scale
        return " ".join(f"{x + level * (width + GAP) * scale:.1f},{height * scale - y:.1f}" for x, y in shifted)

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {full * scale:.0f} {height * scale:.0f}">',
        f'<g font-family="sans-serif" font-size="{scale * 0.2:.0f}" text-anchor="middle">',
    ]
    for level in levels:
        rooms = _on(plan, level)
        for piece in getattr(_walls(plan, rooms), "geoms", None) or [_walls(plan, rooms)]:
            rings = [piece.exterior, *piece.interiors]
            path = " ".join(f"M {text(np.array(r.coords)[:-1], level)} Z" for r in rings)
            lines.append(f'<path d="{path}" fill="{WALL}" fill-rule="evenodd"/>')
        lines += [f'<polygon points="{text(r.polygon, level)}" fill="{COLOURS.get(r.type, OTHER)}"/>' for r in rooms]
        for o in (o for o in plan.openings if o.level == level):
            fill = "#9cc4e4" if o.kind == "window" else "#ffffff"
            lines.append(f'<polygon points="{text(hole(plan, o), level)}" fill="{fill}"/>')
            turned = leaf(plan, o)
            if turned:
                colour = "#c0392b" if o.kind == "entrance" else "#8a5a2b"
                for part in turned:
                    lines.append(f'<polyline points="{text(part, level)}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        for r in rooms:
            x, y = text(np.array([_label_point(r)]), level).split(",")
            lines.append(f'<text x="{x}" y="{y}">{r.room_id}</text>')
            lines.append(f'<text x="{x}" y="{float(y) + scale * 0.24:.1f}" fill="#555">{r.area:.1f} m²</text>')
    return "\n".join([*lines, "</g></svg>"]) + "\n"


def _label_point(room: Room) -> tuple[float, float]:
    point = shapely.Polygon(room.polygon).centroid
    inside = shapely.Polygon(room.polygon)
    point = point if inside.contains(point) else inside.representative_point()
    return float(point.x), float(point.y)


def image(plan: Plan, scale: float = 60.0) -> Image.Image:
    """Return the plan as an image; `scale` in pixels a metre."""
    x0, y0, x1, y1 = _bounds(plan)
    width, height = x1 - x0, y1 - y0
    levels = _levels(plan)
    full = len(levels) * width + (len(levels) - 1) * GAP
    factor = 2  # drawn large and reduced: smooth lines
    picture = Image.new("RGB", (math.ceil(full * scale) * factor, math.ceil(height * scale) * factor), "white")
    pen = ImageDraw.Draw(picture)
    font = ImageFont.load_default(size=scale * 0.2 * factor)

    def at(points: np.ndarray, level: int) -> list[tuple[float, float]]:
        shifted = (np.asarray(points) - (x0, y0)) * scale * factor
        return [(float(x + level * (width + GAP) * scale * factor), float(height * scale * factor - y)) for x, y in shifted]

    for level in levels:
        rooms = _on(plan, level)
        walls = _walls(plan, rooms)
        for piece in getattr(walls, "geoms", None) or [walls]:
            pen.polygon(at(np.array(piece.exterior.coords), level), fill=WALL)
            for ring in piece.interiors:
                pen.polygon(at(np.array(ring.coords), level), fill="white")
        for r in rooms:
            pen.polygon(at(r.polygon, level), fill=COLOURS.get(r.type, OTHER))
        for o in (o for o in plan.openings if o.level == level):
            pen.polygon(at(hole(plan, o), level), fill="#9cc4e4" if o.kind == "window" else "white")
            turned = leaf(plan, o)
            if turned:
                colour = "#c0392b" if o.kind == "entrance" else "#8a5a2b"
                pen.line(at(turned[0], level), fill=colour, width=3 * factor)
                pen.line(at(turned[1], level), fill=colour, width=factor)
        for r in rooms:
            (x, y) = at(np.array([_label_point(r)]), level)[0]
            pen.text((x, y), f"{r.room_id}\n{r.area:.1f} m2", fill="#333333", font=font, anchor="mm", align="center")
    return picture.resize((picture.width // factor, picture.height // factor), Image.Resampling.LANCZOS)


def png(plan: Plan, scale: float = 60.0) -> bytes:
    """Return the plan as PNG bytes."""
    buffer = io.BytesIO()
    image(plan, scale).save(buffer, format="PNG")
    return buffer.getvalue()


def terminal(plan: Plan, columns: int = 76) -> str:
    """Return the plan in box-drawing characters with a list of its rooms; one storey below the other."""
    x0, y0, x1, y1 = _bounds(plan)
    across = (x1 - x0) / columns  # a character is about twice as high as wide
    down = 2 * across
    width, height = columns + 1, math.ceil((y1 - y0) / down) + 1
    text = ""
    for level in _levels(plan):
        rooms = _on(plan, level)
        owner = _sampled(rooms, x0 + across * (np.arange(width + 1) - 0.5), y1 - down * (np.arange(height + 1) - 0.5))
        canvas = [[_box(owner, i, j) for j in range(width)] for i in range(height)]
        for o in (o for o in plan.openings if o.level == level):
            mark = {"window": "░", "entrance": "▒", "door": "·", "open": " ", "portal": " "}[o.kind]
            for share in np.linspace(0.0, 1.0, 40):
                x, y = o.segment[0] + share * (o.segment[1] - o.segment[0])
                i, j = round((y1 - y) / down), round((x - x0) / across)
                for di, dj in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)):
                    if 0 <= i + di < height and 0 <= j + dj < width and canvas[i + di][j + dj] in "─│":
                        canvas[i + di][j + dj] = mark
                        break
        for r in rooms:
            x, y = _label_point(r)
            i, j = round((y1 - y) / down), round((x - x0) / across)
            for k, line in enumerate((r.room_id, f"{r.area:.1f} m²")):
                start = max(j - len(line) // 2, 0)
                for d, letter in enumerate(line):
                    if 0 <= i + k < height and start + d < width and canvas[i + k][start + d] == " ":
                        canvas[i + k][start + d] = letter
        title = f"level {level}\n" if len(_levels(plan)) > 1 else ""
        text += title + "\n".join("".join(row).rstrip() for row in canvas).strip("\n") + "\n"
    total = sum(r.area for r in plan.rooms)
    doors = sum(o.kind == "door" for o in plan.openings)
    return text + f"{len(plan.rooms)} rooms, {total:.1f} m², {doors} doors; · door  ▒ entrance  ░ window\n"


def _sampled(rooms: Sequence[Room], xs: np.ndarray, ys: np.ndarray) -> np.ndarray:
    """Index of the nearest room within a wall's thickness at each point of a raster, -1 outside."""
    points = shapely.points(*np.meshgrid(xs, ys))
    gaps = np.stack([shapely.distance(shapely.Polygon(r.polygon), points) for r in rooms])
    nearest = gaps.argmin(axis=0)
    return np.where(gaps.min(axis=0) <= 0.175, nearest, -1)


BOX = " ╵╶└╷│┌├╴┘─┴┐┤┬┼"  # by bits: up 1, right 2, down 4, left 8


def _box(owner: np.ndarray, i: int, j: int) -> str:
    a, b, c, d = owner[i, j], owner[i, j + 1], owner[i + 1, j], owner[i + 1, j + 1]
    return BOX[(a != b) * 1 + (b != d) * 2 + (c != d) * 4 + (a != c) * 8]
