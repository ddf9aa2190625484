"""A plan in box-drawing characters, for terminals."""

import math
from collections.abc import Sequence

import numpy as np
import shapely

from pipeline.entities.plan import Plan, Room
from pipeline.floorplan.draw.elements import bounds, label_point, on_level
from pipeline.floorplan.program.defaults import OUTSIDE
from pipeline.geometry.walls import levels

MARGIN = 0.2  # around the outer walls [m]
REACH = 0.175  # from inner wall faces to where a wall is drawn [m]


def terminal(plan: Plan, columns: int = 76) -> str:
    """Return the plan in box-drawing characters with a list of its rooms; one storey below the other."""
    x0, y0, x1, y1 = bounds(plan)
    x0, y0, x1, y1 = x0 - MARGIN, y0 - MARGIN, x1 + MARGIN, y1 + MARGIN
    across = (x1 - x0) / columns  # a character is about twice as high as wide
    down = 2 * across
    width, height = columns + 1, math.ceil((y1 - y0) / down) + 1
    text = ""
    for level in levels(plan):
        rooms = on_level(plan, level)
        owner = _room_raster(rooms, x0 + across * (np.arange(width + 1) - 0.5), y1 - down * (np.arange(height + 1) - 0.5))
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
            x, y = label_point(r)
            i, j = round((y1 - y) / down), round((x - x0) / across)
            for k, line in enumerate((r.room_id, f"{r.area:.1f} m²")):
                start = max(j - len(line) // 2, 0)
                for d, letter in enumerate(line):
                    if 0 <= i + k < height and start + d < width and canvas[i + k][start + d] == " ":
                        canvas[i + k][start + d] = letter
        title = f"level {level}\n" if len(levels(plan)) > 1 else ""
        text += title + "\n".join("".join(row).rstrip() for row in canvas).strip("\n") + "\n"
    inside = sum(r.area for r in plan.rooms if r.type not in OUTSIDE)
    more = "".join(f" and {r.room_id} {r.area:.1f} m²" for r in plan.rooms if r.type in OUTSIDE)
    doors = sum(o.kind == "door" for o in plan.openings)
    return text + f"{len(plan.rooms)} rooms, {inside:.1f} m²{more}, {doors} doors; · door  ▒ entrance  ░ window\n"


def _room_raster(rooms: Sequence[Room], xs: np.ndarray, ys: np.ndarray) -> np.ndarray:
    """Index of the nearest room within a wall's thickness at each point of a raster, -1 outside."""
    points = shapely.points(*np.meshgrid(xs, ys))
    shapes = [shapely.Polygon(r.polygon) for r in rooms]
    gaps = np.stack([shapely.distance(s, points) for s in shapes])
    near = shapely.intersects(shapely.union_all([s.buffer(REACH, join_style="mitre") for s in shapes]), points)
    return np.where(near, gaps.argmin(axis=0), -1)


BOX = " ╵╶└╷│┌├╴┘─┴┐┤┬┼"  # by bits: up 1, right 2, down 4, left 8


def _box(owner: np.ndarray, i: int, j: int) -> str:
    a, b, c, d = owner[i, j], owner[i, j + 1], owner[i + 1, j], owner[i + 1, j + 1]
    return BOX[(a != b) * 1 + (b != d) * 2 + (c != d) * 4 + (a != c) * 8]
