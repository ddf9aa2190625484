"""Desks and dressing tables."""

import numpy as np

from pipeline.corpus.furniture.casework import Case, Cell, Column, case
from pipeline.corpus.furniture.dining_tables import cased_table, legged_table
from pipeline.corpus.furniture.finishes import MIRROR, Scheme
from pipeline.corpus.furniture.intervals import Interval, around, split
from pipeline.corpus.furniture.panels import Rect, frame
from pipeline.corpus.furniture.shape import Pieces, Shape, Size, join_shapes, pieces, translate
from pipeline.corpus.furniture.solids import box, revolve, ring, standing
from pipeline.corpus.furniture.storage import front_style


def desk(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a desk with a pedestal of drawers, a row of drawers, or a plain top; tall ones carry a shelf at the back."""
    w, d, h = size
    work = min(h, 0.78) if h > 0.95 else h
    if form == "pedestal":
        shape = _pedestal_desk(rng, (w, d, work), scheme)
    elif form == "drawers":
        shape = cased_table(rng, (w, d, work), scheme, drawer_height=0.11, count=2 if w < 1.5 else 3)
    else:
        table = legged_table(rng, (w, d, work), scheme, without="block bun horse")
        panel = box(around(0.44 * w), (0.3 * d, 0.3 * d + 0.015), (0.4 * work, work - 0.05))
        shape = Shape(table.base + pieces("modesty", panel, scheme.body))
    if h - work > 0.1:
        shape = join_shapes(shape, Shape(_hutch(w, d, (work, h), scheme)))
    return shape


def _hutch(w: float, d: float, z: Interval, scheme: Scheme) -> Pieces:
    """Return a shelf that stands at the back of a desk, over heights `z`."""
    depth, t = min(0.24, 0.4 * d), 0.018
    y, top, height = (d / 2 - depth, d / 2), z[1] - t, z[1] - z[0]
    spans = split((-w / 2 + 0.01, w / 2 - 0.01 - t), max(1, round(w / 0.7)))
    sides = [box((x, x + t), y, (z[0], top)) for x in (*(a for a, _ in spans), spans[-1][1])]
    parts = pieces("hutch_sides", sides, scheme.body)
    parts += pieces("hutch_top", box(around(w / 2 - 0.01), y, (top, z[1]), 0.002), scheme.body)
    middle = z[0] + 0.55 * height
    if height > 0.3:
        boards = [box((a + t, b), (y[0] + 0.01, y[1]), (middle, middle + 0.016)) for a, b in spans]
        parts += pieces("hutch_boards", boards, scheme.body)
    return parts


def _pedestal_desk(rng: np.random.Generator, size: Size, scheme: Scheme) -> Shape:
    """Build a top on a chest of drawers at one side and a panel or a frame at the other."""
    w, d, h = size
    t = 0.028
    style = front_style(rng, scheme, "slab slab shaker")
    side = -1 if rng.random() < 0.5 else 1
    wide = min(0.46, 0.32 * w)
    how = Case(scheme.body, style, "plinth", 0.04, scheme.body, top_thickness=0.016, inset=False)
    rows = int(rng.integers(2, 5))
    cells = tuple(Cell("drawer", 0.8 if k < rows - 1 else 1.3) for k in range(rows))
    chest = case((wide, d - 0.03, h - t), [Column(1, cells)], how)
    base = pieces("top", box(around(w / 2), around(d / 2), (h - t, h), 0.004), scheme.body)
    x = -side * (w / 2 - 0.03)
    if rng.random() < 0.5:
        base += pieces("panel", box(around(0.014, x), (-0.44 * d, 0.46 * d), (0, h - t), 0.002), scheme.body)
    else:
        posts = [box(around(0.02, x), around(0.02, s * 0.42 * d), (0, h - t), 0.003) for s in (-1, 1)]
        posts.append(box(around(0.015, x), around(0.42 * d - 0.02), (0.06, 0.09), 0.003))
        base += pieces("frame", posts, scheme.accent)
    inner = side * (w / 2 - 0.02 - wide)
    span = (min(inner, x), max(inner, x))
    base += pieces("modesty", box(span, (0.36 * d, 0.36 * d + 0.015), (0.45 * h, h - t)), scheme.body)
    return join_shapes(Shape(base), translate(chest, (side * (w / 2 - 0.02 - wide / 2), 0.0, 0.0), "pedestal_"))


def dressing_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a table with drawers and a mirror that stands at its back."""
    w, d, h = size
    work = h if h < 0.95 else min(0.8, 0.62 * h)
    table = cased_table(rng, (w, d, work), scheme, drawer_height=0.12, count=2 if w > 0.9 else 1)
    if h - work < 0.2:
        return table
    y = d / 2 - 0.05
    if form == "round_mirror":
        r = min(0.47 * (h - work), 0.4 * w)
        z, wood, feet = h - r, scheme.accent, "mirror_stem"
        glass = standing(revolve([(0.93 * r, 0.0), (0.93 * r, 0.006)], 28), (0, y, z))
        rim = standing(ring((r, r), (0.93 * r, 0.93 * r), (-0.008, 0.012), 28), (0, y, z))
        stand = [box((-0.02, 0.02), (y + 0.012, y + 0.03), (work, z), 0.003)]
    else:
        half, wood, feet = min(0.4 * w, 0.45), scheme.body, "mirror_feet"
        outer = Rect((-half, half), (work + 0.03, h), y)
        pane = outer.shrunk(0.035)
        glass = [box(pane.x, (y + 0.006, y + 0.014), pane.z)]
        rim = frame(outer, pane, (y, y + 0.024), 0.003)
        stand = [box(around(0.02, s * 0.7 * half), (y + 0.004, y + 0.02), (work, work + 0.03)) for s in (-1, 1)]
    mirror = pieces("mirror", glass, MIRROR, group="mirror") + pieces("mirror_frame", rim, wood, group="mirror")
    return join_shapes(table, Shape(mirror + pieces(feet, stand, wood)))
