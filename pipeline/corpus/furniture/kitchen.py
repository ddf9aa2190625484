"""Kitchen units and bathroom vanities: base and wall cabinets, counters with a sink bowl and tap."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.casework import Case, Cell, Column, case
from pipeline.corpus.furniture.finishes import CERAMIC, MARBLE, PLASTIC, STEEL, STONE, Finish, Scheme, one_of
from pipeline.corpus.furniture.fronts import reach
from pipeline.corpus.furniture.shape import Mover, Piece, Pieces, Shape, Size, join_shapes, pieces, staves
from pipeline.corpus.furniture.solids import Interval, Solid, Spot, around, box, circle, revolve, rod, shell, strips, walls
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


def bowl(x: Interval, y: Interval, top: float, depth: float, finish: Finish, wall: float = 0.008) -> Pieces:
    """Return an open basin under the rectangle `x`, `y`: a bottom and four walls whose rims end at `top` [m]."""
    low = top - depth
    solids = [box(x, y, (low - wall, low)), *walls(x, y, (low, top), wall)]
    middle = ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2)
    drain = revolve([(0.025, low), (0.022, low + 0.003)], 12, middle)
    return pieces("bowl", solids, finish) + pieces("drain", drain, STEEL)


def tap(x: float, y: float, z: float, height: float, reach_out: float, finish: Finish) -> Shape:
    """Return a tap at (x, y, z): a column, a spout that reaches towards the front, and a lever at its side that turns up."""
    r = 0.011
    steps = np.linspace(0, math.pi * 0.85, 6)
    radius = reach_out / 2
    points = [(y, z)] + [(y - radius + radius * math.cos(a), z + height - radius + radius * math.sin(a)) for a in steps]
    solids: list[Solid] = [rod((x, a[0], a[1]), (x, b[0], b[1]), r, n=10) for a, b in itertools.pairwise(points)]
    solids += revolve([(0.024, z), (0.022, z + 0.02)], 14, (x, y))
    root = (x + r + 0.002, y, z + 0.055)
    arm = [rod(root, (root[0] + 0.014, y, root[2]), 0.010, n=10)]
    arm.append(box((root[0] + 0.014, root[0] + 0.022), (y - 0.075, y + 0.008), around(0.006, root[2]), 0.002))
    lever_parts = pieces("lever", arm, finish, group="lever")
    lever = Mover("tap_lever", lever_parts, "revolute", (-1, 0, 0), root, 1.0, "hinge_handle", "lever", (1.0, 0.0, 0.0))
    return Shape(pieces("tap", solids, finish), (lever,))


def _topless(shape: Shape, top: Sequence[Piece]) -> Shape:
    """Return the case with `top` in place of its own."""
    return Shape(tuple(p for p in shape.base if p.name != "top") + tuple(top), shape.movers)


def sink_cabinet(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a base unit whose counter holds a bowl and a tap, over doors or a deep drawer."""
    w, d, h = size
    tall = 0.28 if rng.random() < 0.5 else 0.22
    body = h - tall  # the tap stands above the counter
    body = max(body, 0.62)
    how = unit_style(rng, scheme)
    cells: tuple[Cell, ...] = (Cell("pair", 1.0, 0),) if w > 0.56 else (Cell("left", 1.0, 0),)
    if form == "drawer":  # the bowl leaves no room for a drawer above
        cells = (Cell("blank", 0.5), Cell("drawer", 0.9))
    shape = case((w, d, body), [Column(1, cells)], how)
    face = -d / 2 + max(reach(how.style.handle), how.nose)
    half = min(0.3, 0.5 * w - 0.09)
    hole_x, hole_y = (-half, half), (face + 0.09, d / 2 - 0.13)
    z = (body - how.top_thickness, body)
    top = pieces("top", strips(around(w / 2), (face - how.nose, d / 2), hole_x, hole_y, z, 0.002), how.top or STONE)
    top += bowl((hole_x[0], hole_x[1]), hole_y, body - 0.003, 0.17, STEEL)
    return join_shapes(_topless(shape, top), tap(0.0, d / 2 - 0.065, body, h - body, 0.2, scheme.handle))


def vanity(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a washstand: doors or drawers under a counter with a vessel or an inset basin and a tap."""
    w, d, h = size
    body = h - 0.17
    legs = rng.random() < 0.4
    how = replace(unit_style(rng, scheme), overhang=0.006, nose=0.0)
    how = replace(how, feet="square", feet_height=0.16, feet_finish=scheme.accent) if legs else replace(how, feet_height=0.08)
    top = one_of(rng, (CERAMIC, MARBLE, STONE))
    how = replace(how, top=top, top_thickness=0.03)
    vessel = rng.random() < 0.45 or form == "drawers"
    if form == "drawers":
        count = max(1, round(w / 0.6))
        columns = [Column(1, (Cell("drawer"), Cell("drawer")))] * count
    else:
        columns = [Column(1, (Cell("pair", 1.0, 0 if not vessel else 1),))]
    shape = case((w, d, body), columns, how)
    face = -d / 2 + max(reach(how.style.handle), how.overhang)
    if vessel:
        r, middle = min(0.36 * (d - 0.1), 0.19), (face + d / 2 - 0.11) / 2
        basin = _vessel(min(r * 1.2, 0.4 * w), r, (0.0, middle), (body, body + 0.12))
        stand = tap(0.0, d / 2 - 0.045, body, h - body, 0.13, scheme.handle)
        basin_parts = staves("basin", basin[1:], CERAMIC) + pieces("basin_floor", basin[0], CERAMIC)
        return join_shapes(shape, Shape(basin_parts), stand)
    half = min(0.26, 0.5 * w - 0.07)
    hole_x, hole_y = (-half, half), (face + 0.06, d / 2 - 0.11)
    z = (body - how.top_thickness, body)
    new = pieces("top", strips(around(w / 2), (face - how.overhang, d / 2), hole_x, hole_y, z, 0.002), top)
    new += bowl(hole_x, hole_y, body - 0.002, 0.13, CERAMIC)
    return join_shapes(_topless(shape, new), tap(0.0, d / 2 - 0.055, body, h - body, 0.13, scheme.handle))


def _vessel(rx: float, ry: float, centre: Spot, z: Interval) -> list[Solid]:
    """Return an oval open basin that stands on a counter, its wall flaring upwards."""
    n, squash = 24, ry / rx
    rings = []
    for scale_low, scale_high in ((0.72, 1.0), (0.66, 0.94)):
        low = circle(rx * scale_low, n, centre, squash)
        high = circle(rx * scale_high, n, centre, squash)
        rings.append([np.column_stack([low, np.full(n, z[0] + 0.012)]), np.column_stack([high, np.full(n, z[1])])])
    floor = np.column_stack([circle(rx * 0.70, n, centre, squash), np.full(n, z[0])])
    floor_top = np.column_stack([circle(rx * 0.72, n, centre, squash), np.full(n, z[0] + 0.012)])
    from pipeline.corpus.furniture.solids import stack

    return [stack([floor, floor_top]), *shell(rings[0], rings[1])]
