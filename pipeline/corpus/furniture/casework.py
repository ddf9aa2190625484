"""Casework: hollow carcasses of panels, cut into columns of cells that hold drawers, doors or open shelves."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from pipeline.corpus.furniture.finishes import Material
from pipeline.corpus.furniture.fronts import GAP, FrontStyle, Rect, Side, door, drawer, reach, sliding_door
from pipeline.corpus.furniture.intervals import Interval, around, inset
from pipeline.corpus.furniture.shape import Mover, Pieces, Shape, join_shapes, pieces
from pipeline.corpus.furniture.solids import Solid, beam, box, rod

Feet = Literal["plinth", "tapered", "square", "sled", "none", "hairpin"]
CellKind = Literal["drawer", "left", "right", "pair", "open", "flap", "lift", "blank", "slide"]
BACK = 0.008  # thickness of a back [m]
TRACK = 0.006  # between the two leaves of a pair of sliding doors [m]
INNER = 0.17  # height of a drawer behind doors [m]


@dataclass(frozen=True, slots=True)
class Cell:
    """A compartment of a column: `share` of its height, `shelves` inside, `inner` drawers behind its doors, what closes it.

    A flap turns about its lower edge, a lift about its upper one; sliding doors run on two tracks; a blank is fixed.
    """

    kind: CellKind
    share: float = 1.0
    shelves: int = 0
    panel: FrontStyle | None = None
    inner: int = 0


@dataclass(frozen=True, slots=True)
class Column:
    """A column of cells from the top down; `share` of the carcass's width."""

    share: float
    cells: tuple[Cell, ...]


@dataclass(frozen=True, slots=True)
class Case:
    """How a carcass is made. Lengths in metres.

    `inset` fronts lie between the panels, others cover them. `overhang` is how far the top reaches out in front and at
    the sides, `nose` how far in front alone; `top` its finish; `gap` is left between fronts: thick doors need more, their inner edge swings wide.
    """

    body: Material
    style: FrontStyle
    feet: Feet
    feet_height: float
    feet_finish: Material
    top: Material | None = None
    top_thickness: float = 0.022
    overhang: float = 0.0
    board: float = 0.018
    inset: bool = False
    gap: float = GAP
    nose: float = 0.0


def drawers(count: int) -> tuple[Cell, ...]:
    """Return so many equal drawers."""
    return (Cell("drawer"),) * count


def grid(count: int, *cells: Cell) -> list[Column]:
    """Return so many equal columns."""
    return [Column(1, cells)] * count


def case(size: Sequence[float], columns: Sequence[Column], how: Case, *, reserve: float | None = None) -> Shape:
    """Return a piece of case furniture of `size` (w, d, h) [m]; `reserve` [m] in front of the fronts is kept for handles."""
    w, d, h = size
    b = how.board
    stand = reach(how.style.handle) if reserve is None else reserve
    face = -d / 2 + max(stand, how.overhang + how.nose)  # plane of the fronts
    x = around(w / 2 - how.overhang)
    y = (face if how.inset else face + how.style.thickness + 0.002, d / 2)
    z = (how.feet_height, h - how.top_thickness)
    inner, within = inset(x, b), (z[0] + b, z[1])
    base = pieces("top", box(around(w / 2), (face - how.overhang - how.nose, d / 2), (z[1], h), 0.003), how.top or how.body)
    base += pieces("side_left", box((x[0], x[0] + b), y, z, 0.0015), how.body)
    base += pieces("side_right", box((x[1] - b, x[1]), y, z, 0.0015), how.body)
    base += pieces("bottom", box(inner, y, (z[0], z[0] + b)), how.body)
    base += pieces("back", box(inner, (y[1] - BACK, y[1]), within), how.body)
    shares = np.cumsum([0.0, *(c.share for c in columns)]) / sum(c.share for c in columns)
    cuts = inner[0] + shares * (inner[1] - inner[0])
    parts = [Shape(base)]
    for i, column in enumerate(columns):
        left = float(cuts[i]) + (b / 2 if i else 0)
        right = float(cuts[i + 1]) - (b / 2 if i < len(columns) - 1 else 0)
        if i:
            parts.append(Shape(pieces(f"divider_{i}", box((left - b, left), (y[0], y[1] - BACK), within), how.body)))
        # An overlaid front covers an outer panel wholly, an inner one by half.
        outer = (left, right) if how.inset else (left - (b / 2 if i else b), right + (b / 2 if i < len(columns) - 1 else b))
        parts.append(_column(f"c{i}", column, (left, right), outer, y, within, face, how))
    return join_shapes(*parts, Shape(feet(how.feet, x, (face + 0.01, d / 2), how.feet_height, how.feet_finish)))


def _column(name: str, column: Column, x: Interval, outer: Interval, y: Interval, z: Interval, face: float, how: Case) -> Shape:
    """Fill one column between `x`, its fronts over `outer`."""
    b = how.board
    parts: list[Shape] = []
    total = sum(c.share for c in column.cells)
    free = z[1] - z[0] - b * (len(column.cells) - 1)
    upper_edge = z[1]
    for k, cell in enumerate(column.cells):
        height = free * cell.share / total
        low, high = upper_edge - height, upper_edge
        below = column.cells[k + 1].kind if k < len(column.cells) - 1 else ""
        if below and (how.inset or (cell.kind, below) != ("drawer", "drawer")):  # overlaid drawers need no rail between them
            parts.append(Shape(pieces(f"{name}_shelf_{k}", box(x, (y[0], y[1] - BACK), (low - b, low)), how.body)))
        if how.inset:
            rect = Rect(x, (low, high), face).shrink(how.gap)
        else:
            bottom = low - (b if k == len(column.cells) - 1 else b / 2)
            rect = Rect(outer, (bottom, high + (b / 2 if k else 0)), face).shrink(how.gap / 2)
        depth = (y[0] + (how.style.thickness + 0.002 if how.inset else 0.0), y[1] - BACK)
        parts.append(_cell(f"{name}_{k}", cell, x, depth, (low, high), rect, how))
        upper_edge = low - b
    return join_shapes(*parts)


def _cell(name: str, cell: Cell, x: Interval, y: Interval, z: Interval, rect: Rect, how: Case) -> Shape:
    """Fill one compartment over `x`, `y`, `z` with its shelves and its front over `rect`."""
    if cell.kind == "slide":
        return _sliding(name, cell, x, y, z, rect, how)
    style = cell.panel or how.style
    base: Pieces = ()
    setback = 0.004 if cell.kind == "open" else 0.02
    floor = z[0] + cell.inner * (INNER + GAP) + (0.016 if cell.inner else 0.0)
    for j in range(cell.shelves):
        level = floor + (z[1] - floor) * (j + 1) / (cell.shelves + 1)
        base += pieces(f"{name}_board_{j}", box(x, (y[0] + setback, y[1]), around(0.008, level)), how.body)
    movers: tuple[Mover, ...] = ()
    square = math.radians(90)  # no farther, so that a wardrobe can stand in a corner and a nightstand beside its bed
    sides: dict[str, Side] = {"left": "left", "right": "right", "flap": "bottom", "lift": "top"}
    if cell.kind == "drawer":
        movers = (drawer(f"{name}_drawer", rect, style, (x, z, y[1]), how.body),)
    elif cell.kind == "pair":
        middle = (rect.x[0] + rect.x[1]) / 2
        left = Rect((rect.x[0], middle - how.gap / 2), rect.z, rect.y)
        right = Rect((middle + how.gap / 2, rect.x[1]), rect.z, rect.y)
        movers = (door(f"{name}_door_left", left, style, "left", square), door(f"{name}_door_right", right, style, "right", square))
    elif cell.kind in sides:
        movers = (door(f"{name}_door", rect, style, sides[cell.kind], square),)
    elif cell.kind == "blank":
        base += pieces(f"{name}_blank", box(rect.x, (rect.y, rect.y + style.thickness), rect.z, 0.002), style.finish)
    shape = Shape(base, movers)
    return join_shapes(shape, _inner(name, cell.inner, x, y, z[0], how, tuple(m.name for m in movers))) if cell.inner else shape


def _inner(name: str, count: int, x: Interval, y: Interval, bottom: float, how: Case, doors: tuple[str, ...]) -> Shape:
    """Return drawers behind doors, under a board of their own: narrower than the cell, so that they pass the open doors."""
    inside = inset(x, 0.022)
    face = y[0] + 0.03
    style = replace(how.style, panel="slab", handle="none", finish=how.body, thickness=0.016)
    drawers = []
    for j in range(count):
        low = bottom + j * (INNER + GAP)
        rect = Rect(inside, (low + GAP, low + INNER - 0.03), face)
        drawers.append(drawer(f"{name}_inner_{j}", rect, style, (inside, (low, low + INNER), y[1]), how.body, after=doors))
    top = bottom + count * (INNER + GAP)
    return Shape(pieces(f"{name}_inner_top", box(x, (face, y[1]), (top, top + 0.016)), how.body), tuple(drawers))


def _sliding(name: str, cell: Cell, x: Interval, y: Interval, z: Interval, rect: Rect, how: Case) -> Shape:
    """Return one or two pairs of leaves on two tracks before an interior of uprights, shelves and hat shelves."""
    style = cell.panel or how.style
    rear = rect.y + style.thickness + TRACK
    inside = (rear + style.thickness + 0.012, y[1])
    pairs = 2 if rect.width > 2.3 else 1
    half, lap = rect.width / pairs, 0.035
    wide = (half + lap) / 2
    base: Pieces = ()
    movers: list[Mover] = []
    cuts = [x[0]]
    for p in range(pairs):
        start = rect.x[0] + p * half + (GAP / 2 if p else 0.0)
        for i in (0, 1):
            low = start + i * (wide - lap)
            ahead = i == p  # the outer leaves run in front
            leaf = Rect((low, low + wide - (GAP / 2 if pairs > 1 else 0.0)), rect.z, rect.y if ahead else rear)
            movers.append(sliding_door(f"{name}_leaf_{2 * p + i}", leaf, style, 1.0 if i == 0 else -1.0, wide - lap))
        cuts += [start + wide - lap / 2, start + half]
    cuts[-1] = x[1]
    for i, (low, high) in enumerate(itertools.pairwise(cuts)):
        ends = (low + (0.009 if i else 0.0), high - (0.009 if i < len(cuts) - 2 else 0.0))
        if i:
            base += pieces(f"{name}_upright_{i}", box(around(0.009, low), inside, z), how.body)
        shelf = z[1] - 0.3
        base += pieces(f"{name}_{i}_board_0", box(ends, inside, (shelf, shelf + 0.018)), how.body)
        for j in range(cell.shelves if i % 2 else 0):
            level = z[0] + (shelf - z[0]) * (j + 1) / (cell.shelves + 1)
            base += pieces(f"{name}_plank_{i}_{j}", box(ends, inside, (level, level + 0.016)), how.body)
    return Shape(base, tuple(movers))


def feet(kind: Feet, x: Interval, y: Interval, height: float, finish: Material) -> Pieces:
    """Return what a piece stands on, under the rectangle `x`, `y`, from the floor to `height` [m]."""
    if height <= 0 or kind == "none":
        return ()
    margin = min(0.05, 0.12 * (x[1] - x[0]))
    corners = [(cx, cy) for cx in inset(x, margin) for cy in inset(y, margin)]
    solids: list[Solid] = []
    if kind == "plinth":
        return pieces("plinth", box(inset(x, 0.02), (y[0] + 0.03, y[1] - 0.005), (0, height)), finish)
    if kind == "tapered":
        spread = 0.022 if height > 0.1 else 0.0
        for cx, cy in corners:
            out = (math.copysign(spread, cx - (x[0] + x[1]) / 2), math.copysign(spread, cy - (y[0] + y[1]) / 2))
            solids.append(rod((cx + out[0], cy + out[1], 0), (cx, cy, height), 0.012, 0.022, 10))
    elif kind == "square":
        side = 0.018 if height > 0.08 else 0.025
        solids = [beam((cx, cy, 0), (cx, cy, height), 2 * side, 2 * side, 0.75) for cx, cy in corners]
    elif kind == "hairpin":
        parts: Pieces = ()
        for k, (cx, cy) in enumerate(corners):
            pair = [rod((cx + s * 0.003, cy, 0), (cx + s * 0.03, cy, height), 0.006, 0.006, 6) for s in (-1, 1)]
            parts += pieces("feet", pair, finish, group=f"foot_{k}")
        return parts
    else:  # sled: two closed frames of square tube
        t = 0.012
        for cx in inset(x, margin):
            span = inset(y, margin / 2)
            solids.append(box(around(t, cx), span, (0, 2 * t), 0.002))
            solids += [box(around(t, cx), around(t, cy), (2 * t, height), 0.002) for cy in inset(span, t)]
    if x[1] - x[0] > 1.6 and kind in ("tapered", "square"):  # long pieces stand on six
        solids += [rod((0, cy, 0), (0, cy, height), 0.014, 0.02, 10) for cy in inset(y, margin)]
    return pieces("feet", solids, finish)
