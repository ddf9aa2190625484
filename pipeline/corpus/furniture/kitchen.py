"""Kitchen units and bathroom vanities: base and wall cabinets, counters with a sink bowl and tap."""

# ruff: noqa: ARG001 - all builders share one signature, whatever of it they need

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.casework import Case, Cell, Column, case
from pipeline.corpus.furniture.finishes import CERAMIC, MARBLE, PLASTIC, STEEL, STONE, Finish, Scheme
from pipeline.corpus.furniture.fronts import reach
from pipeline.corpus.furniture.shape import Piece, Shape, joined, pieces
from pipeline.corpus.furniture.solids import Solid, box, circle, revolve, rod, shell
from pipeline.corpus.furniture.storage import Size, front_style

PLINTH = 0.1  # height of a kitchen unit's recessed plinth [m]


def unit_style(rng: np.random.Generator, scheme: Scheme, panels: str = "slab shaker slab") -> Case:
    """Draw how a kitchen unit is made: white carcass boards, a stone or wooden counter, fronts that cover the edges."""
    style = front_style(rng, scheme, panels, "bar flat edge bar knob")
    counter = (STONE, MARBLE, scheme.body)[int(rng.integers(3))]
    return Case(scheme.body, style, "plinth", PLINTH, PLASTIC, top=counter, top_thickness=0.038, overhang=0.0)


def kitchen_cabinet(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a base unit with doors, drawers, or a drawer over doors, under a counter."""
    how = unit_style(rng, scheme)
    w = size[0]
    count = max(1, round(w / 0.6))
    door = Cell("left" if rng.random() < 0.5 else "right", 1.0, 1)
    if form == "drawers":
        columns = [Column(1, (Cell("drawer", 0.45), Cell("drawer", 0.8), Cell("drawer", 1.0)))] * max(1, round(w / 0.8))
    elif form == "mixed":
        columns = [Column(1, (Cell("drawer", 0.28), replace(door, kind="left" if i < count / 2 else "right"))) for i in range(count)]
    else:
        columns = [Column(1, (Cell("pair", 1.0, 1),))] * max(1, round(w / 1.0)) if w > 0.55 else [Column(1, (door,))]
    return case(size, columns, how)


def wall_cabinet(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a wall unit with doors, plain or glazed."""
    how = replace(unit_style(rng, scheme, "glass" if form == "glass" else "slab shaker"), feet="none", feet_height=0.0)
    how = replace(how, top=scheme.body, top_thickness=0.018)
    w = size[0]
    cells = Column(1, (Cell("pair" if w / max(1, round(w / 0.9)) > 0.5 else "left", 1.0, 2),))
    return case(size, [cells] * max(1, round(w / 0.9)), how)


def bowl(
    x: tuple[float, float], y: tuple[float, float], top: float, depth: float, finish: Finish, wall: float = 0.006
) -> tuple[Piece, ...]:
    """Return an open basin under the rectangle `x`, `y`: a bottom and four walls whose rims end at `top` [m]."""
    low = top - depth
    solids = [
        box((x[0], x[1]), (y[0], y[1]), (low - wall, low)),
        box((x[0], x[0] + wall), y, (low, top)),
        box((x[1] - wall, x[1]), y, (low, top)),
        box((x[0] + wall, x[1] - wall), (y[0], y[0] + wall), (low, top)),
        box((x[0] + wall, x[1] - wall), (y[1] - wall, y[1]), (low, top)),
    ]
    middle = ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2)
    drain = revolve([(0.025, low), (0.022, low + 0.003)], 12, middle)
    return pieces("bowl", solids, finish) + pieces("drain", drain, STEEL)


def counter(
    x: tuple[float, float],
    y: tuple[float, float],
    hole_x: tuple[float, float],
    hole_y: tuple[float, float],
    z: tuple[float, float],
    finish: Finish,
) -> tuple[Piece, ...]:
    """Return a worktop with a rectangular hole, as four convex strips."""
    strips = [
        box((x[0], hole_x[0]), y, z, 0.002),
        box((hole_x[1], x[1]), y, z, 0.002),
        box(hole_x, (y[0], hole_y[0]), z, 0.002),
        box(hole_x, (hole_y[1], y[1]), z, 0.002),
    ]
    return pieces("top", strips, finish)


def tap(x: float, y: float, z: float, height: float, reach_out: float, finish: Finish) -> tuple[Piece, ...]:
    """Return a tap at (x, y, z): a column, a spout that reaches towards the front, and a lever."""
    r = 0.011
    steps = np.linspace(0, math.pi * 0.85, 6)
    radius = reach_out / 2
    points = [(y, z)] + [(y - radius + radius * math.cos(a), z + height - radius + radius * math.sin(a)) for a in steps]
    solids: list[Solid] = [rod((x, a[0], a[1]), (x, b[0], b[1]), r, n=10) for a, b in itertools.pairwise(points)]
    solids += revolve([(0.024, z), (0.022, z + 0.02)], 14, (x, y))
    solids.append(rod((x, y, z + 0.06), (x + 0.06, y, z + 0.085), 0.006, n=8))
    return pieces("tap", solids, finish)


def _topless(shape: Shape, top: Sequence[Piece]) -> Shape:
    """Return the case with `top` in place of its own."""
    return Shape(tuple(p for p in shape.base if p.name != "top") + tuple(top), shape.movers)


def sink_cabinet(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a base unit whose counter holds a bowl and a tap, over doors."""
    w, d, h = size
    tall = 0.28 if rng.random() < 0.5 else 0.22
    body = h - tall  # the tap stands above the counter
    body = max(body, 0.62)
    how = unit_style(rng, scheme)
    cells = (Cell("pair", 1.0, 0),) if w > 0.56 else (Cell("left", 1.0, 0),)
    shape = case((w, d, body), [Column(1, cells)], how)
    face = -d / 2 + reach(how.style.handle)
    half = min(0.3, 0.5 * w - 0.09)
    hole_x, hole_y = (-half, half), (face + 0.09, d / 2 - 0.13)
    z = (body - how.top_thickness, body)
    top = counter((-w / 2, w / 2), (face, d / 2), hole_x, hole_y, z, how.top or STONE)
    top += bowl((hole_x[0], hole_x[1]), hole_y, body - 0.003, 0.17, STEEL)
    top += tap(0.0, d / 2 - 0.065, body, h - body, 0.2, scheme.handle)
    return _topless(shape, top)


def vanity(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a washstand: doors or drawers under a counter with a vessel or an inset basin and a tap."""
    w, d, h = size
    body = h - 0.17
    legs = rng.random() < 0.4
    how = replace(unit_style(rng, scheme), overhang=0.006)
    how = replace(how, feet="square", feet_height=0.16, feet_finish=scheme.accent) if legs else replace(how, feet_height=0.08)
    top = (CERAMIC, MARBLE, STONE)[int(rng.integers(3))]
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
        return joined(shape, Shape(pieces("basin", basin, CERAMIC) + stand))
    half = min(0.26, 0.5 * w - 0.07)
    hole_x, hole_y = (-half, half), (face + 0.06, d / 2 - 0.11)
    z = (body - how.top_thickness, body)
    new = counter((-w / 2, w / 2), (face - how.overhang, d / 2), hole_x, hole_y, z, top)
    new += bowl(hole_x, hole_y, body - 0.002, 0.13, CERAMIC) + tap(0.0, d / 2 - 0.055, body, h - body, 0.13, scheme.handle)
    return _topless(shape, new)


def _vessel(rx: float, ry: float, centre: tuple[float, float], z: tuple[float, float]) -> list[Solid]:
    """Return an oval open basin that stands on a counter, its wall flaring upwards."""
    n, squash = 20, ry / rx
    rings = []
    for scale_low, scale_high in ((0.72, 1.0), (0.66, 0.94)):
        low = circle(rx * scale_low, n, centre, squash)
        high = circle(rx * scale_high, n, centre, squash)
        rings.append([np.column_stack([low, np.full(n, z[0] + 0.012)]), np.column_stack([high, np.full(n, z[1])])])
    floor = np.column_stack([circle(rx * 0.70, n, centre, squash), np.full(n, z[0])])
    floor_top = np.column_stack([circle(rx * 0.72, n, centre, squash), np.full(n, z[0] + 0.012)])
    from pipeline.corpus.furniture.solids import stack

    return [stack([floor, floor_top]), *shell(rings[0], rings[1])]
