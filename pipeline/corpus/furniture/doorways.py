"""Room doors as pieces of furniture: a frame, a leaf, and a lever handle on either side."""

import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.finishes import LACQUERS, Finish, Scheme, pick
from pipeline.corpus.furniture.intervals import around, edges, inset
from pipeline.corpus.furniture.panels import FrontStyle, Rect, panel
from pipeline.corpus.furniture.shape import Axis3, Mover, Pieces, Shape, Size, group_pieces, pieces
from pipeline.corpus.furniture.solids import box, revolve

LEAF = 0.04  # thickness of a leaf [m]
LEVER = 0.055  # how far a lever stands out of its leaf [m]


def room_door(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a door in its frame: flush, with two panels, or glazed; it opens towards the front."""
    w, d, h = size
    white = Finish("door_white", LACQUERS["white"], 0.4, density=500)
    finish = white if rng.random() < 0.5 else scheme.body
    t, stop = 0.045, 0.012
    y = (-d / 2 + LEVER, d / 2)
    jambs = [box(span, y, (0, h), 0.003) for span in edges(around(w / 2), t)]
    base = pieces("frame", [*jambs, box(around(w / 2 - t), y, (h - t, h), 0.003)], finish)
    inner = around(w / 2 - t)
    behind = (y[0] + LEAF + 0.004, y[1])
    stops = [box(span, behind, (0, h - t)) for span in edges(inner, stop)]
    base += pieces("stops", [*stops, box(inset(inner, stop), behind, (h - t - stop, h - t))], finish)
    rect = Rect(inset(inner, 0.003), (0.006, h - t - 0.003), y[0])
    hinge_left = rng.random() < 0.5
    side = 1.0 if hinge_left else -1.0
    style = FrontStyle("slab", "none", finish, scheme.handle, LEAF)
    pivot = rect.x[0] if hinge_left else rect.x[1]
    leaf = Mover(
        "leaf", _leaf(rng, form, rect, style), "revolute", (0, 0, -side), (pivot, rect.y, 1.0), math.radians(100), "hinge_door", "door"
    )
    grip = (rect.x[1] - 0.065 if hinge_left else rect.x[0] + 0.065, 1.02)
    levers = [_lever("lever_front", (grip[0], rect.y, grip[1]), -1.0, side, scheme.handle)]
    levers.append(_lever("lever_back", (grip[0], rect.y + LEAF, grip[1]), 1.0, side, scheme.handle))
    return Shape(base, (leaf, *levers))


def _leaf(rng: np.random.Generator, form: str, rect: Rect, style: FrontStyle) -> Pieces:
    if form == "flush":
        return panel(rect, style)
    kind = "glass" if form == "glazed" else pick(rng, "shaker raised")
    looks = replace(style, panel=kind)  # type: ignore[arg-type]
    cut = rect.z[0] + 0.42 * rect.height
    parts = panel(Rect(rect.x, (rect.z[0], cut), rect.y), replace(looks, panel="shaker") if form == "glazed" else looks)
    parts += panel(Rect(rect.x, (cut, rect.z[1]), rect.y), looks)
    return group_pieces(parts, "leaf")


def _lever(name: str, at: Axis3, outwards: float, side: float, finish: Finish) -> Mover:
    """Return a lever on one face of the leaf: a rose, a neck and an arm towards the hinge, which is pressed down."""
    turn = math.pi / 2 if outwards < 0 else -math.pi / 2
    rose = [s.turned("x", turn).moved(at) for s in revolve([(0.024, 0.0005), (0.024, 0.007), (0.020, 0.009)], 16)]
    neck = [s.turned("x", turn).moved(at) for s in revolve([(0.010, 0.009), (0.010, LEVER - 0.004)], 10)]
    arm_y = sorted((at[1] + outwards * (LEVER - 0.016), at[1] + outwards * LEVER))
    arm_x = sorted((at[0] + side * 0.010, at[0] - side * 0.115))
    arm = box((arm_x[0], arm_x[1]), (arm_y[0], arm_y[1]), around(0.010, at[2]), 0.003)
    parts = pieces("rose", rose, finish) + pieces("lever", [*neck, arm], finish)
    axis = (0.0, -side, 0.0)
    return Mover(name, parts, "revolute", axis, at, math.radians(40), "hinge_handle", "handle", (0.0, outwards, 0.0), "leaf")
