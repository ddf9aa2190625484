"""Panels: what the front of a door or drawer is made of, from a plain board to louvres. Fronts look towards -Y."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from pipeline.corpus.furniture.finishes import DARK_GLASS, GLASS, MIRROR, Finish
from pipeline.corpus.furniture.intervals import Interval, around, inset
from pipeline.corpus.furniture.shape import Pieces, group_pieces, pieces
from pipeline.corpus.furniture.solids import Solid, box, slab, stack

PanelStyle = Literal["slab", "shaker", "raised", "glass", "dark_glass", "slats", "reeded", "cane", "mirror"]
HandleStyle = Literal["bar", "long", "flat", "knob", "ring", "cup", "edge", "groove", "none"]

LIP = 0.024  # height of the strip that a hand reaches behind, of fronts without handles [m]
CANE = Finish("cane", (0.55, 0.40, 0.22), 0.85, pattern="weave", density=300)


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

    def shrunk(self, by: float) -> Rect:
        """Return the place with a gap all around."""
        return Rect(inset(self.x, by), inset(self.z, by), self.y)


@dataclass(frozen=True, slots=True)
class FrontStyle:
    """How the fronts of one model look. `thickness` [m]."""

    panel: PanelStyle
    handle: HandleStyle
    finish: Finish
    metal: Finish
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
        return back + pieces("front_reeds", _reeds(rect, 0.007), style.finish)
    if style.panel == "mirror":
        back = pieces("front", box(rect.x, (y + 0.005, y + t), rect.z, 0.002), style.finish)
        edge = 0.012
        pane = box(inset(rect.x, edge), (y, y + 0.005), inset(rect.z, edge), 0.0015)
        return back + pieces("front_mirror", pane, MIRROR)
    inner = Rect(inset(rect.x, rail), inset(rect.z, rail), y)
    return pieces("front_frame", frame(rect, inner, depth), style.finish) + _filling(inner, style)


def frame(rect: Rect, inner: Rect, depth: Interval, bevel: float = 0.002) -> list[Solid]:
    """Return stiles and rails around `inner`, over the interval `depth` in y [m]."""
    return [
        box((rect.x[0], inner.x[0]), depth, rect.z, bevel),
        box((inner.x[1], rect.x[1]), depth, rect.z, bevel),
        box(inner.x, depth, (rect.z[0], inner.z[0]), bevel),
        box(inner.x, depth, (inner.z[1], rect.z[1]), bevel),
    ]


def _filling(inner: Rect, style: FrontStyle) -> Pieces:
    """Return what a frame holds."""
    y, t = inner.y, style.thickness
    if style.panel == "slats":
        return pieces("front_slats", _louvres(inner, t), style.finish)
    if style.panel in ("glass", "dark_glass"):
        parts = pieces("front_glass", box(inner.x, (y + 0.006, y + 0.012), inner.z), GLASS if style.panel == "glass" else DARK_GLASS)
        if style.panel == "glass" and inner.height > 0.7:  # a glazing bar
            middle = inner.middle[1]
            parts += pieces("front_bar", box(inner.x, (y + 0.003, y + 0.006), around(0.011, middle)), style.finish)
        return parts
    if style.panel == "cane":
        return pieces("front_cane", box(inner.x, (y + 0.006, y + 0.010), inner.z), CANE)
    parts = pieces("front_panel", box(inner.x, (y + 0.009, y + t - 0.002), inner.z), style.finish)
    if style.panel == "raised" and min(inner.width, inner.height) > 0.08:
        field = min(0.035, 0.25 * min(inner.width, inner.height))
        low = np.array([(inner.x[0], inner.z[0]), (inner.x[1], inner.z[0]), (inner.x[1], inner.z[1]), (inner.x[0], inner.z[1])])
        high = low + np.array([(field, field), (-field, field), (-field, -field), (field, -field)])
        rings = [np.column_stack([o[:, 0], np.full(4, at), o[:, 1]]) for o, at in ((low, y + 0.009), (high, y + 0.002))]
        parts += pieces("front_field", stack(rings), style.finish)
    return parts


def _louvres(inner: Rect, thickness: float) -> list[Solid]:
    """Return tilted slats, one above the other."""
    count = min(18, max(3, round(inner.height / 0.045)))
    pitch = inner.height / count
    middle, half = inner.y + thickness / 2, 0.5 * thickness - 0.003
    slats = []
    for i in range(count):
        z = inner.z[0] + (i + 0.5) * pitch
        slat = box(inner.x, around(0.003, middle), around(0.56 * pitch, z))
        angle = math.asin(min(0.8, max(0.0, half - 0.003) / (0.56 * pitch)))
        slats.append(slat.turned("x", -angle, (0.0, middle, z)))
    return slats


def _reeds(rect: Rect, proud: float) -> list[Solid]:
    """Return upright half-round strips side by side, `proud` [m] in front of the board."""
    count = min(18, max(4, round(rect.width / 0.028)))
    pitch = rect.width / count
    turns = np.linspace(math.pi, 2 * math.pi, 5)
    strips = []
    for i in range(count):
        x = rect.x[0] + (i + 0.5) * pitch
        outline = np.stack([x + 0.46 * pitch * np.cos(turns), rect.y + proud + proud * np.sin(turns)], axis=1)
        strips.append(slab(outline, rect.z))
    return strips
