"""Fronts: panels from a plain board to louvres, and what moves: doors, drawers, lids, dials and buttons with their handles. They look towards -Y."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from pipeline.corpus.furniture.finishes import Material
from pipeline.corpus.furniture.intervals import Interval, Spot, around, inset
from pipeline.corpus.furniture.shape import UP, Axis3, Mover, Pieces, group_pieces, pieces
from pipeline.corpus.furniture.solids import Solid, box, hull, revolve, ring, rod, slab, stack, stand_up

PanelStyle = Literal["slab", "shaker", "raised", "glass", "dark_glass", "slats", "reeded", "cane", "mirror"]
HandleStyle = Literal["bar", "long", "flat", "knob", "ring", "cup", "edge", "groove", "none"]

LIP = 0.024  # height of the strip that a hand reaches behind, of fronts without handles [m]
Side = Literal["left", "right", "bottom", "top"]
GAP = 0.003  # between a front and its neighbours [m]
RUN = 0.004  # between a drawer and what it runs in [m]
BOARD = 0.012  # walls of a drawer [m]
TURN = 1.5 * math.pi  # of a dial [rad]
REACHES: dict[HandleStyle, float] = {"bar": 0.032, "long": 0.032, "flat": 0.024, "knob": 0.026, "ring": 0.016, "cup": 0.022, "edge": 0.014}


@dataclass(frozen=True, slots=True)
class Rect:
    """A front's place: intervals in x and z, and the plane y of its face [m]."""

    x: Interval
    z: Interval
    y: float

    @property
    def width(self) -> float:
        """Extent in x."""
        return self.x[1] - self.x[0]

    @property
    def height(self) -> float:
        """Extent in z."""
        return self.z[1] - self.z[0]

    @property
    def middle(self) -> tuple[float, float]:
        """Its middle (x, z)."""
        return ((self.x[0] + self.x[1]) / 2, (self.z[0] + self.z[1]) / 2)

    def shrink(self, by: float) -> Rect:
        """Return the place with a gap all around."""
        return Rect(inset(self.x, by), inset(self.z, by), self.y)


@dataclass(frozen=True, slots=True)
class FrontStyle:
    """How the fronts of one model look. `thickness` [m]."""

    panel: PanelStyle
    handle: HandleStyle
    finish: Material
    metal: Material
    thickness: float = 0.019


def panel(rect: Rect, style: FrontStyle) -> Pieces:
    """Return the panel of a front; whatever it is made of, it collides as one board."""
    parts = _panel(rect, style)
    return parts if len(parts) == 1 else group_pieces(parts, "front")


def _panel(rect: Rect, style: FrontStyle) -> Pieces:
    y, t = rect.y, style.thickness
    rail = min(0.065, 0.22 * min(rect.width, rect.height))
    depth = (y, y + t)
    if style.handle == "groove" and style.panel == "slab" and rect.height > 2 * LIP:
        low = (rect.z[0], rect.z[1] - LIP)
        face = pieces("front", box(rect.x, depth, low, 0.0025), style.finish)
        return face + pieces("front_lip", box(rect.x, (y + 0.011, y + t), (low[1], rect.z[1])), style.finish)
    if style.panel == "slab" or rail < 0.022:
        return pieces("front", box(rect.x, depth, rect.z, 0.0025), style.finish)
    if style.panel == "reeded":
        back = pieces("front", box(rect.x, (y + 0.007, y + t), rect.z, 0.002), style.finish)
        count = min(18, max(4, round(rect.width / 0.028)))
        pitch, turns = rect.width / count, np.linspace(math.pi, 2 * math.pi, 5)
        across, depths = 0.46 * pitch * np.cos(turns), y + 0.007 + 0.007 * np.sin(turns)
        reeds = [slab(np.stack([rect.x[0] + (i + 0.5) * pitch + across, depths], axis=1), rect.z) for i in range(count)]
        return back + pieces("front_reeds", reeds, style.finish)
    if style.panel == "mirror":
        back = pieces("front", box(rect.x, (y + 0.005, y + t), rect.z, 0.002), style.finish)
        edge = 0.012
        pane = box(inset(rect.x, edge), (y, y + 0.005), inset(rect.z, edge), 0.0015)
        return back + pieces("front_mirror", pane, "mirror")
    inner = Rect(inset(rect.x, rail), inset(rect.z, rail), y)
    return pieces("front_frame", frame(rect, inner, depth), style.finish) + _filling(inner, style)


def frame(rect: Rect, inner: Rect, depth: Interval, bevel: float = 0.002) -> list[Solid]:
    """Return stiles and rails around `inner`, over the interval `depth` in y [m]."""
    stiles = [box(x, depth, rect.z, bevel) for x in ((rect.x[0], inner.x[0]), (inner.x[1], rect.x[1]))]
    return stiles + [box(inner.x, depth, z, bevel) for z in ((rect.z[0], inner.z[0]), (inner.z[1], rect.z[1]))]


def _filling(inner: Rect, style: FrontStyle) -> Pieces:
    """Return what a frame holds."""
    y, t = inner.y, style.thickness
    if style.panel == "slats":
        count = min(18, max(3, round(inner.height / 0.045)))
        pitch = inner.height / count
        middle, half = y + t / 2, 0.5 * t - 0.003
        angle = math.asin(min(0.8, max(0.0, half - 0.003) / (0.56 * pitch)))
        levels = [inner.z[0] + (i + 0.5) * pitch for i in range(count)]
        slats = [box(inner.x, around(0.003, middle), around(0.56 * pitch, z)).rotate("x", -angle, (0.0, middle, z)) for z in levels]
        return pieces("front_slats", slats, style.finish)
    if style.panel in ("glass", "dark_glass"):
        parts = pieces("front_glass", box(inner.x, (y + 0.006, y + 0.012), inner.z), "glass" if style.panel == "glass" else "dark_glass")
        if style.panel == "glass" and inner.height > 0.7:  # a glazing bar
            middle = inner.middle[1]
            parts += pieces("front_bar", box(inner.x, (y + 0.003, y + 0.006), around(0.011, middle)), style.finish)
        return parts
    if style.panel == "cane":
        return pieces("front_cane", box(inner.x, (y + 0.006, y + 0.010), inner.z), "woven_cane")
    parts = pieces("front_panel", box(inner.x, (y + 0.009, y + t - 0.002), inner.z), style.finish)
    if style.panel == "raised" and min(inner.width, inner.height) > 0.08:
        field = min(0.035, 0.25 * min(inner.width, inner.height))
        low = np.array([(inner.x[0], inner.z[0]), (inner.x[1], inner.z[0]), (inner.x[1], inner.z[1]), (inner.x[0], inner.z[1])])
        high = low + np.array([(field, field), (-field, field), (-field, -field), (field, -field)])
        rings = [np.column_stack([o[:, 0], np.full(4, at), o[:, 1]]) for o, at in ((low, y + 0.009), (high, y + 0.002))]
        parts += pieces("front_field", stack(rings), style.finish)
    return parts


def reach(handle: HandleStyle) -> float:
    """Return how far a handle of that style stands out of the front [m]."""
    return REACHES.get(handle, 0.0)


def handle(style: FrontStyle, rect: Rect, *, upright: bool, at: Spot, length: float, name: str = "handle") -> Pieces:
    """Return the handle of a front with its middle `at` (x, z); `upright` turns a bar along z.

    It collides as one solid, but for a bar on feet: fingers come behind that.
    """
    x, z = at
    y, half, group, part = rect.y, length / 2, name, "line_fixed_handle"
    solids: list[Solid]
    if style.handle in ("none", "groove"):
        return ()
    if style.handle in ("knob", "ring"):
        part = "round_fixed_handle"
        solids = revolve([(0.006, 0.0), (0.0055, 0.010), (0.013, 0.018), (0.014, 0.022), (0.010, 0.026)], 10)
        if style.handle == "ring":  # that drops from a rosette
            drop = [s.translate((0.0, -0.021, 0.0)) for s in ring((0.021, 0.021), (0.0155, 0.0155), (0.010, 0.016), 12)]
            solids = revolve([(0.015, 0.0), (0.013, 0.005), (0.006, 0.010)], 10) + drop
        solids = stand_up(solids, (x, y, z))
    elif style.handle == "cup" and not upright:
        turns = np.linspace(0, math.pi / 2, 4)
        section = [(-0.022 * math.cos(t), 0.024 * math.sin(t) - 0.008) for t in turns] + [(0.0, -0.008)]
        wide = min(half, 0.048)
        solids = [hull(np.array([(x + s * wide, y + dy, z + dz) for s in (-1, 1) for dy, dz in section]))]
    elif style.handle == "edge":
        top = rect.z[1] - 0.001
        if upright:
            edge = rect.x[0] if x < rect.middle[0] else rect.x[1] - 0.008
            solids = [box((edge, edge + 0.008), (y - 0.014, y), around(half, z), 0.001)]
        else:
            solids = [box(around(half, x), (y - 0.014, y), (top - 0.008, top), 0.001)]
    else:
        solids, group = _bar(style, (x, y, z), (0.0, half) if upright else (half, 0.0)), ""
    return pieces(name, solids, style.metal, part, group)


def _bar(style: FrontStyle, at: Axis3, along: Spot) -> list[Solid]:
    """Return a round or flat bar on two feet; `along` are its half lengths in x and z."""
    x, y, z = at
    stand = reach(style.handle if style.handle in ("bar", "long") else "flat")
    if style.handle in ("bar", "long"):
        r = 0.006
        centre = y - stand + r
        solids = [rod((x - along[0], centre, z - along[1]), (x + along[0], centre, z + along[1]), r)]
    else:
        half_x, half_z = max(along[0], 0.006), max(along[1], 0.006)
        solids = [box(around(half_x, x), (y - stand, y - stand + 0.008), around(half_z, z), 0.0015)]
    for sign in (-1, 1):
        fx, fz = x + sign * 0.75 * along[0], z + sign * 0.75 * along[1]
        solids.append(box(around(0.005, fx), (y - stand + 0.006, y), around(0.005, fz)))
    return solids


def door(name: str, rect: Rect, style: FrontStyle, hinge: Side, upper: float) -> Mover:
    """Return a door over `rect`, hinged at the front edge of one side, that opens by `upper` [rad].

    About the outer edge of its face a panel of any thickness turns without touching what is behind or beside it.
    """
    (x0, x1), (z0, z1) = rect.x, rect.z
    cx, cz = rect.middle
    inset = 0.045 if rect.width > 0.2 else 0.03
    upright = hinge in ("left", "right")
    if style.handle == "cup" and upright:
        style = replace(style, handle="knob")  # a cup is for pulling straight out
    if style.handle == "groove" and hinge == "top":
        style = replace(style, handle="edge")
    length = min(0.16 if rect.height < 0.8 else 0.32, 0.5 * rect.height)
    if style.handle == "long":
        length = min(0.9, 0.62 * rect.height)
    axes: dict[Side, Axis3] = {"left": (0, 0, -1), "right": (0, 0, 1), "bottom": (1, 0, 0), "top": (-1, 0, 0)}
    x, z = {"left": (x0, cz), "right": (x1, cz), "bottom": (cx, z0), "top": (cx, z1)}[hinge]
    height = min(max(cz, z0 + 0.1 + length / 2), 1.1)
    if z1 < 0.95 and rect.height > 0.35:  # low cabinets are gripped near the top
        height = z1 - 0.06 - length / 2
    if z0 > 1.1:  # wall units near the bottom
        height = z0 + 0.06 + length / 2
    height = min(max(height, z0 + length / 2 + 0.02), z1 - length / 2 - 0.02)
    grips = {"left": (x1 - inset, height), "right": (x0 + inset, height), "bottom": (cx, z1 - inset), "top": (cx, z0 + inset)}
    if not upright:
        length = min(0.45, 0.6 * rect.width)
    parts = panel(rect, style) + handle(style, rect, upright=upright, at=grips[hinge], length=length)
    return Mover(name, parts, "revolute", axes[hinge], (x, rect.y, z), upper, "hinge_door", "door")


def sliding_door(name: str, rect: Rect, style: FrontStyle, towards: float, travel: float) -> Mover:
    """Return a door that slides by `travel` [m] in its plane, to the right (`towards` 1) or to the left (-1).

    Its pull is a shallow plate, so that another leaf passes in front of it.
    """
    style = replace(style, handle="none")
    edge = rect.x[1] if towards < 0 else rect.x[0]
    x = edge + (0.035 if towards > 0 else -0.035)
    z = min(max(rect.middle[1], rect.z[0] + 0.12), 1.05)
    half = min(0.09, 0.3 * rect.height)
    plate = box(around(0.012, x), (rect.y - 0.003, rect.y), around(half, z))
    parts = panel(rect, style) + pieces("handle", plate, style.metal, "line_fixed_handle")
    return Mover(name, parts, "prismatic", (towards, 0.0, 0.0), (rect.middle[0], rect.y, z), travel, "slider_lid", "door")


def drawer(
    name: str, rect: Rect, style: FrontStyle, cell: tuple[Interval, Interval, float], inside: Material, *, after: tuple[str, ...] = ()
) -> Mover:
    """Return a drawer: a front over `rect`, and a bottom, two sides and a back that run in its cell.

    `cell` is the opening behind the front: interval in x, interval in z, and the y of its back [m].
    """
    (cx0, cx1), (cz0, cz1), back = cell
    if style.panel not in ("slab", "shaker", "raised", "reeded"):
        style = replace(style, panel="slab")
    x0, x1 = cx0 + RUN, cx1 - RUN
    y0, y1 = rect.y + style.thickness, back - 0.012
    z0 = cz0 + RUN
    z1 = min(z0 + max(0.04, 0.74 * (cz1 - cz0)), cz1 - 0.008)
    wall = min(BOARD, 0.1 * (x1 - x0))
    boards = tray((x0, x1), (y0, y1), (z0, z1), wall)
    middle = rect.middle[0]
    height = rect.middle[1] if rect.height < 0.3 else rect.z[1] - 0.08
    if rect.width > 0.75 and style.handle in ("knob", "ring", "cup"):  # two on a wide front
        spots = (("handle", middle - rect.width / 4), ("handle_2", middle + rect.width / 4))
        grips = tuple(p for n, x in spots for p in handle(style, rect, upright=False, at=(x, height), length=0.1, name=n))
    else:
        share, most = (0.7, 0.9) if style.handle == "long" else (0.38, 0.40)
        length = min(most, max(0.08, share * rect.width), 0.8 * rect.width)
        grips = handle(style, rect, upright=False, at=(middle, height), length=length)
    at = (middle, rect.y, rect.z[1] - LIP if style.handle == "groove" else height)
    parts = panel(rect, style) + pieces("drawer_box", boards, inside) + grips
    return Mover(name, parts, "prismatic", (0, -1, 0), at, round(0.82 * (y1 - y0), 3), "slider_drawer", "drawer", after=after)


def tray(x: Interval, y: Interval, z: Interval, wall: float) -> list[Solid]:
    """Return a drawer behind its front: a bottom of 8 mm, two sides and a back of thickness `wall` [m]."""
    low = z[0] + 0.008
    sides = [box(span, y, (low, z[1])) for span in ((x[0], x[0] + wall), (x[1] - wall, x[1]))]
    return [box(x, y, (z[0], low)), *sides, box(inset(x, wall), (y[1] - wall, y[1]), (low, z[1]))]


def lid(name: str, parts: Pieces, hinge: tuple[float, float, float], upper: float, parent: str = "base") -> Mover:
    """Return a lid that opens upwards about an axis along x through `hinge`."""
    return Mover(name, parts, "revolute", (-1, 0, 0), hinge, upper, "hinge_lid", "lid", UP, parent)


def knob(name: str, at: Axis3, radius: float, finish: Material, *, depth: float = 0.022) -> Mover:
    """Return a dial on a front plane; `at` is its middle on the plane."""
    profile = [(radius, 0.001), (radius, 0.35 * depth), (0.82 * radius, depth)]
    dial = stand_up(revolve(profile, 16), at)
    mark = box(around(0.0015, at[0]), (at[1] - depth - 0.002, at[1] - depth), (at[2], at[2] + 0.75 * radius))
    parts = pieces("knob", dial, finish, group="knob") + pieces("knob_mark", mark, "mark", group="knob")
    return Mover(name, parts, "revolute", (0, 1, 0), at, TURN, "hinge_knob", "knob")


def top_knob(name: str, at: Axis3, radius: float, finish: Material, *, depth: float) -> Mover:
    """Return a dial on a level plane, seen from above; `at` is its middle on the plane."""
    dial = revolve([(radius, at[2] + 0.001), (radius, at[2] + 0.4 * depth), (0.85 * radius, at[2] + depth)], 12, (at[0], at[1]))
    top = at[2] + depth
    mark = box(around(0.0015, at[0]), (at[1] - 0.75 * radius, at[1]), (top, top + 0.002))
    parts = pieces("knob", dial, finish, group="knob") + pieces("knob_mark", mark, "mark", group="knob")
    return Mover(name, parts, "revolute", (0, 0, -1), at, TURN, "hinge_knob", "knob", UP)


def button(name: str, x: Interval, z: Interval, y: float, finish: Material) -> Mover:
    """Return a push button that stands 8 mm out of the plane `y` and is pressed by 4 mm."""
    cap = box(x, (y - 0.008, y - 0.0045), z, 0.001)
    at = ((x[0] + x[1]) / 2, y, (z[0] + z[1]) / 2)
    return Mover(name, pieces("button", cap, finish), "prismatic", (0, 1, 0), at, 0.004, "slider_button", "button")


def top_button(name: str, x: Interval, y: Interval, z: Interval, finish: Material, press: float) -> Mover:
    """Return a button on a level plane: its cap over `x`, `y`, `z` goes down by `press` [m]."""
    cap = box(x, y, z, 0.001)
    at = ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2, z[1])
    return Mover(name, pieces("button", cap, finish), "prismatic", (0, 0, -1), at, press, "slider_button", "button", UP)
