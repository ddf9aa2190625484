"""Kitchen units and bathroom vanities: base and wall cabinets, counters with a sink bowl and tap."""

import itertools
import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.casework import Case, Cell, Column, case
from pipeline.corpus.furniture.finishes import CERAMIC, MARBLE, PLASTIC, STEEL, STONE, Finish, Scheme, one_of
from pipeline.corpus.furniture.fronts import reach
from pipeline.corpus.furniture.intervals import Interval, Spot, around
from pipeline.corpus.furniture.shape import Mover, Pieces, Shape, Size, join_shapes, pieces, staves
from pipeline.corpus.furniture.solids import Solid, box, circle, revolve, rod, shell, stack, strips, walls
from pipeline.corpus.furniture.storage import front_style

PLINTH = 0.1  # height of a kitchen unit's recessed plinth [m]
NOSE = 0.018  # how far a worktop stands out over its fronts [m]


def unit_style(rng: np.random.Generator, scheme: Scheme, panels: str = "") -> Case:
    """Draw how a kitchen unit is made: white carcass boards, a stone or wooden counter, fronts that cover the edges."""
    style = front_style(rng, scheme, panels)
    counter = one_of(rng, (STONE, MARBLE, scheme.body))
    return Case(scheme.body, style, "plinth", PLINTH, PLASTIC, top=counter, top_thickness=0.038, nose=NOSE)


def kitchen_cabinet(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a base unit with doors, drawers, a drawer over doors, or for a corner, under a counter."""
    how = unit_style(rng, scheme)
    w = size[0]
    count = max(1, round(w / 0.6))
    door = Cell("left" if rng.random() < 0.5 else "right", 1.0, 1)
    if form == "drawers":
        columns = [Column(1, (Cell("drawer", 0.45), Cell("drawer", 0.8), Cell("drawer", 1.0)))] * max(1, round(w / 0.8))
    elif form == "corner":
        blank = Column(0.8, (Cell("blank", 1.0),))
        columns = [blank, Column(1, (Cell("right", 1.0, 1),))] if rng.random() < 0.5 else [Column(1, (Cell("left", 1.0, 1),)), blank]
    elif form == "mixed":
        columns = [Column(1, (Cell("drawer", 0.28), replace(door, kind="left" if i < count / 2 else "right"))) for i in range(count)]
    else:
        columns = [Column(1, (Cell("pair", 1.0, 1),))] * max(1, round(w / 1.0)) if w > 0.55 else [Column(1, (door,))]
    return case(size, columns, how)


def wall_cabinet(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a wall unit with doors, plain or glazed, or with fronts that lift."""
    how = replace(unit_style(rng, scheme, "glass" if form == "glass" else ""), feet="none", feet_height=0.0, nose=0.0)
    how = replace(how, top=scheme.body, top_thickness=0.018)
    w = size[0]
    count = max(1, round(w / 0.9))
    if form == "lift":
        cell = (Cell("lift", 1.0, 0), Cell("lift", 1.0, 0)) if size[2] > 0.75 else (Cell("lift", 1.0, 1),)
        return case(size, [Column(1, cell)] * count, how)
    return case(size, [Column(1, (Cell("pair" if w / count > 0.5 else "left", 1.0, 2),))] * count, how)


def tall_unit(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a unit as tall as the room's doors: a larder of two doors, one that is pulled out, or doors over drawers."""
    how = replace(unit_style(rng, scheme), top=scheme.body, top_thickness=0.018, nose=0.0)
    side = "left" if rng.random() < 0.5 else "right"
    door = Cell("pair" if size[0] > 0.75 else side, 1.0, 3)  # type: ignore[arg-type]
    cells: tuple[Cell, ...]
    if form == "larder":
        cells = (replace(door, share=1.3), replace(door, share=1.0, shelves=1, inner=int(rng.integers(0, 3))))
    elif form == "pull_out":
        cells = (replace(door, share=0.35, shelves=0), Cell("drawer", 1.2), Cell("drawer", 0.7))
    else:
        cells = (replace(door, share=1.6), Cell("drawer", 0.3), Cell("drawer", 0.45), Cell("drawer", 0.45))
    return case(size, [Column(1, cells)], how)


def bowl(x: Interval, y: Interval, top: float, depth: float, finish: Finish) -> Pieces:
    """Return an open basin under the rectangle `x`, `y`: a bottom and four walls whose rims end at `top` [m]."""
    low, wall = top - depth, 0.008
    drain = revolve([(0.025, low), (0.022, low + 0.003)], 12, ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2))
    return pieces("bowl", [box(x, y, (low - wall, low)), *walls(x, y, (low, top), wall)], finish) + pieces("drain", drain, STEEL)


def tap(y: float, z: float, height: float, reach_out: float, finish: Finish) -> Shape:
    """Return a tap at (0, y, z): a column, a spout that reaches towards the front, and a lever at its side that turns up."""
    r, radius = 0.011, reach_out / 2
    steps = np.linspace(0, math.pi * 0.85, 6)
    points = [(0.0, y, z)]
    points += [(0.0, y - radius + radius * math.cos(a), z + height - radius + radius * math.sin(a)) for a in steps]
    solids = [rod(a, b, r, n=10) for a, b in itertools.pairwise(points)] + revolve([(0.024, z), (0.022, z + 0.02)], 14, (0.0, y))
    root = (r + 0.002, y, z + 0.055)
    arm = [rod(root, (root[0] + 0.014, y, root[2]), 0.010, n=10)]
    arm.append(box((root[0] + 0.014, root[0] + 0.022), (y - 0.075, y + 0.008), around(0.006, root[2]), 0.002))
    parts = pieces("lever", arm, finish, group="lever")
    lever = Mover("tap_lever", parts, "revolute", (-1, 0, 0), root, 1.0, "hinge_handle", "lever", (1.0, 0.0, 0.0))
    return Shape(pieces("tap", solids, finish), (lever,))


def _sunk(shape: Shape, hole_x: Interval, hole_y: Interval, basin: Pieces) -> Shape:
    """Return the case with a hole for `basin` in its top."""
    old = next(p for p in shape.base if p.name == "top")
    (x0, y0, z0), (x1, y1, z1) = old.solid.bounds().tolist()
    top = pieces("top", strips((x0, x1), (y0, y1), hole_x, hole_y, (z0, z1), 0.002), old.finish)
    return Shape(tuple(p for p in shape.base if p is not old) + top + basin, shape.movers)


def sink_cabinet(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a base unit whose counter holds a bowl and a tap, over doors or a deep drawer."""
    w, d, h = size
    tall = 0.28 if rng.random() < 0.5 else 0.22
    body = max(h - tall, 0.62)  # the tap stands above the counter
    how = unit_style(rng, scheme)
    cells: tuple[Cell, ...] = (Cell("pair" if w > 0.56 else "left", 1.0, 0),)
    if form == "drawer":  # the bowl leaves no room for a drawer above
        cells = (Cell("blank", 0.5), Cell("drawer", 0.9))
    shape = case((w, d, body), [Column(1, cells)], how)
    face = -d / 2 + max(reach(how.style.handle), how.nose)
    hole = around(min(0.3, 0.5 * w - 0.09)), (face + 0.09, d / 2 - 0.13)
    shape = _sunk(shape, *hole, bowl(*hole, body - 0.003, 0.17, STEEL))
    return join_shapes(shape, tap(d / 2 - 0.065, body, h - body, 0.2, scheme.handle))


def vanity(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a washstand: doors or drawers under a counter with a vessel or an inset basin and a tap."""
    w, d, h = size
    body = h - 0.17
    legs = rng.random() < 0.4
    how = replace(unit_style(rng, scheme), overhang=0.006, nose=0.0)
    how = replace(how, feet="square", feet_height=0.16, feet_finish=scheme.accent) if legs else replace(how, feet_height=0.08)
    how = replace(how, top=one_of(rng, (CERAMIC, MARBLE, STONE)), top_thickness=0.03)
    vessel = rng.random() < 0.45 or form == "drawers"
    if form == "drawers":
        columns = [Column(1, (Cell("drawer"), Cell("drawer")))] * max(1, round(w / 0.6))
    else:
        columns = [Column(1, (Cell("pair", 1.0, 0 if not vessel else 1),))]
    shape = case((w, d, body), columns, how)
    face = -d / 2 + max(reach(how.style.handle), how.overhang)
    if vessel:
        r, middle = min(0.36 * (d - 0.1), 0.19), (face + d / 2 - 0.11) / 2
        basin = _vessel(min(r * 1.2, 0.4 * w), r, (0.0, middle), (body, body + 0.12))
        parts = staves("basin", basin[1:], CERAMIC) + pieces("basin_floor", basin[0], CERAMIC)
        return join_shapes(shape, Shape(parts), tap(d / 2 - 0.045, body, h - body, 0.13, scheme.handle))
    hole = around(min(0.26, 0.5 * w - 0.07)), (face + 0.06, d / 2 - 0.11)
    shape = _sunk(shape, *hole, bowl(*hole, body - 0.002, 0.13, CERAMIC))
    return join_shapes(shape, tap(d / 2 - 0.055, body, h - body, 0.13, scheme.handle))


def _vessel(rx: float, ry: float, centre: Spot, z: Interval) -> list[Solid]:
    """Return an oval open basin that stands on a counter, its wall flaring upwards."""

    def oval(scale: float, height: float) -> NDArray[np.float64]:
        return np.column_stack([circle(rx * scale, 24, centre, ry / rx), np.full(24, height)])

    low = z[0] + 0.012
    wall = shell([oval(0.72, low), oval(1.0, z[1])], [oval(0.66, low), oval(0.94, z[1])])
    return [stack([oval(0.70, z[0]), oval(0.72, low)]), *wall]
