"""Fronts: door and drawer panels with their handles, hinged doors and drawer boxes. Fronts look towards -Y."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

from pipeline.corpus.furniture.finishes import DARK_GLASS, GLASS, Finish
from pipeline.corpus.furniture.shape import UP, Mover, Piece, pieces
from pipeline.corpus.furniture.solids import Solid, box, revolve, rod

PanelStyle = Literal["slab", "shaker", "glass", "slats", "dark_glass"]
HandleStyle = Literal["bar", "flat", "knob", "edge", "none"]
Side = Literal["left", "right", "bottom", "top"]

GAP = 0.003  # between a front and its neighbours [m]
HANDLE_REACH = 0.032  # how far a handle stands out of its front [m]


@dataclass(frozen=True, slots=True)
class Rect:
    """A front's place: intervals in x and z, and the plane y of its face [m]."""

    x: tuple[float, float]
    z: tuple[float, float]
    y: float

    @property
    def width(self) -> float:
        """Extent in x."""
        return self.x[1] - self.x[0]

    @property
    def height(self) -> float:
        """Extent in z."""
        return self.z[1] - self.z[0]

    def shrunk(self, by: float) -> Rect:
        """Return the place with a gap all around."""
        return Rect((self.x[0] + by, self.x[1] - by), (self.z[0] + by, self.z[1] - by), self.y)


@dataclass(frozen=True, slots=True)
class FrontStyle:
    """How the fronts of one model look. `thickness` [m]."""

    panel: PanelStyle
    handle: HandleStyle
    finish: Finish
    metal: Finish
    thickness: float = 0.019


def reach(handle: HandleStyle) -> float:
    """Return how far a handle of that style stands out of the front [m]."""
    return {"bar": HANDLE_REACH, "flat": 0.024, "knob": 0.026, "edge": 0.014, "none": 0.0}[handle]


def panel(rect: Rect, style: FrontStyle) -> tuple[Piece, ...]:
    """Return the panel of a front."""
    (x0, x1), (z0, z1), y, t = rect.x, rect.z, rect.y, style.thickness
    rail = min(0.065, 0.22 * min(rect.width, rect.height))
    if style.panel == "slab" or rail < 0.022:
        return pieces("front", box(rect.x, (y, y + t), rect.z, 0.0025), style.finish)
    frame = [
        box((x0, x0 + rail), (y, y + t), rect.z, 0.002),
        box((x1 - rail, x1), (y, y + t), rect.z, 0.002),
        box((x0 + rail, x1 - rail), (y, y + t), (z0, z0 + rail), 0.002),
        box((x0 + rail, x1 - rail), (y, y + t), (z1 - rail, z1), 0.002),
    ]
    made = pieces("front_frame", frame, style.finish)
    inner_x, inner_z = (x0 + rail, x1 - rail), (z0 + rail, z1 - rail)
    if style.panel == "slats":
        count = min(16, max(3, round((inner_z[1] - inner_z[0]) / 0.05)))
        pitch = (inner_z[1] - inner_z[0]) / count
        slats = [
            box(inner_x, (y + 0.004, y + t - 0.004), (inner_z[0] + (i + 0.1) * pitch, inner_z[0] + (i + 0.9) * pitch)) for i in range(count)
        ]
        return made + pieces("front_slats", slats, style.finish)
    if style.panel in ("glass", "dark_glass"):
        pane = GLASS if style.panel == "glass" else DARK_GLASS
        return made + pieces("front_glass", box(inner_x, (y + 0.007, y + 0.012), inner_z), pane)
    return made + pieces("front_panel", box(inner_x, (y + 0.008, y + t - 0.002), inner_z), style.finish)


def handle(style: FrontStyle, rect: Rect, *, upright: bool, at: tuple[float, float], length: float) -> tuple[Piece, ...]:
    """Return the handle of a front with its middle `at` (x, z); `upright` turns a bar along z."""
    x, z = at
    half = length / 2
    along = (0.0, half) if upright else (half, 0.0)
    y = rect.y
    made: list[Solid]
    part = "line_fixed_handle"
    if style.handle == "none":
        return ()
    if style.handle == "knob":
        made = [
            s.turned("x", math.pi / 2) for s in revolve([(0.006, 0.0), (0.0055, 0.010), (0.013, 0.018), (0.014, 0.022), (0.010, 0.026)], 12)
        ]
        made = [s.moved((x, y, z)) for s in made]
        part = "round_fixed_handle"
    elif style.handle == "edge":
        top = rect.z[1] - 0.001
        if upright:
            edge = rect.x[0] if x < (rect.x[0] + rect.x[1]) / 2 else rect.x[1] - 0.006
            made = [box((edge, edge + 0.006), (y - 0.014, y), (z - half, z + half), 0.001)]
        else:
            made = [box((x - half, x + half), (y - 0.014, y), (top - 0.006, top), 0.001)]
    else:
        bar = style.handle == "bar"
        stand = reach(style.handle)
        foot = 0.75
        if bar:
            r = 0.0055
            centre = y - stand + r
            made = [rod((x - along[0], centre, z - along[1]), (x + along[0], centre, z + along[1]), r)]
        else:
            made = [box((x - max(along[0], 0.006), x + max(along[0], 0.006)), (y - stand, y - stand + 0.007), _around(z, along[1]), 0.0015)]
        for sign in (-1, 1):
            fx, fz = x + sign * foot * along[0], z + sign * foot * along[1]
            made.append(box((fx - 0.005, fx + 0.005), (y - stand + 0.0055, y), (fz - 0.005, fz + 0.005)))
    return pieces("handle", made, style.metal, part)


def _around(z: float, half: float) -> tuple[float, float]:
    return (z - max(half, 0.006), z + max(half, 0.006))


def door(name: str, rect: Rect, style: FrontStyle, hinge: Side, upper: float, *, grip: tuple[float, float] | None = None) -> Mover:
    """Return a door over `rect`, hinged at the front edge of one side, that opens by `upper` [rad].

    About the outer edge of its face a panel of any thickness turns without touching what is behind or beside it.
    `grip` overrides where the handle sits (x, z).
    """
    (x0, x1), (z0, z1) = rect.x, rect.z
    cx, cz = (x0 + x1) / 2, (z0 + z1) / 2
    inset = 0.045 if rect.width > 0.2 else 0.03
    length = min(0.16 if rect.height < 0.8 else 0.32, 0.5 * rect.height)
    axes: dict[Side, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
        "left": ((0, 0, -1), (x0, rect.y, cz)),
        "right": ((0, 0, 1), (x1, rect.y, cz)),
        "bottom": ((1, 0, 0), (cx, rect.y, z0)),
        "top": ((-1, 0, 0), (cx, rect.y, z1)),
    }
    axis, origin = axes[hinge]
    upright = hinge in ("left", "right")
    if grip is None:
        height = min(max(cz, z0 + 0.1 + length / 2), 1.1)
        if z1 < 0.95 and rect.height > 0.35:  # low cabinets are gripped near the top
            height = z1 - 0.06 - length / 2
        height = min(max(height, z0 + length / 2 + 0.02), z1 - length / 2 - 0.02)
        grips = {"left": (x1 - inset, height), "right": (x0 + inset, height), "bottom": (cx, z1 - inset), "top": (cx, z0 + inset)}
        grip = grips[hinge]
    if not upright:
        length = min(0.45, 0.6 * rect.width)
    made = panel(rect, style) + handle(style, rect, upright=upright, at=grip, length=length)
    return Mover(name, made, "revolute", axis, origin, upper, "hinge_door", "door")


def drawer(name: str, rect: Rect, style: FrontStyle, cell: tuple[tuple[float, float], tuple[float, float], float], inside: Finish) -> Mover:
    """Return a drawer: a front over `rect` and a box with a bottom and four sides that runs in its cell.

    `cell` is the opening behind the front: interval in x, interval in z, and the y of its back [m].
    """
    (cx0, cx1), (cz0, cz1), back = cell
    wall, side, play = 0.012, 0.010, 0.012
    if style.panel not in ("slab", "shaker"):
        style = replace(style, panel="slab")
    x0, x1 = cx0 + side, cx1 - side
    y0, y1 = rect.y + style.thickness, back - 0.012
    z0, z1 = cz0 + play, cz0 + play + max(0.04, 0.78 * (cz1 - cz0 - 2 * play))
    z1 = min(z1, cz1 - 0.008)
    box_pieces = pieces(
        "drawer_box",
        [
            box((x0, x1), (y0, y1), (z0, z0 + 0.008)),
            box((x0, x0 + wall), (y0, y1), (z0 + 0.008, z1)),
            box((x1 - wall, x1), (y0, y1), (z0 + 0.008, z1)),
            box((x0 + wall, x1 - wall), (y1 - wall, y1), (z0 + 0.008, z1)),
            box((x0 + wall, x1 - wall), (y0, y0 + wall), (z0 + 0.008, z1)),
        ],
        inside,
    )
    middle = (rect.x[0] + rect.x[1]) / 2
    height = (rect.z[0] + rect.z[1]) / 2 if rect.height < 0.3 else rect.z[1] - 0.08
    if rect.width > 0.75 and style.handle == "knob":
        quarter = rect.width / 4
        grips = handle(style, rect, upright=False, at=(middle - quarter, height), length=0.1)
        grips += tuple(
            Piece("handle_2", p.solid, p.finish, p.part)
            for p in handle(style, rect, upright=False, at=(middle + quarter, height), length=0.1)
        )
    else:
        grips = handle(style, rect, upright=False, at=(middle, height), length=min(0.40, max(0.08, 0.38 * rect.width)))
    travel = round(0.82 * (y1 - y0), 3)
    return Mover(
        name, panel(rect, style) + box_pieces + grips, "prismatic", (0, -1, 0), (middle, rect.y, height), travel, "slider_drawer", "drawer"
    )


def lid(name: str, made: tuple[Piece, ...], hinge: tuple[float, float, float], upper: float) -> Mover:
    """Return a lid that opens upwards about an axis along x through `hinge`."""
    return Mover(name, made, "revolute", (-1, 0, 0), hinge, upper, "hinge_lid", "lid", UP)


def knob(name: str, at: tuple[float, float, float], radius: float, finish: Finish, *, depth: float = 0.022) -> Mover:
    """Return a dial on a front plane that turns by three quarters; `at` is its middle on the plane."""
    profile = [(radius, 0.001), (radius, 0.35 * depth), (0.82 * radius, depth)]
    dial = [s.turned("x", math.pi / 2).moved(at) for s in revolve(profile, 16)]
    mark = box((at[0] - 0.0015, at[0] + 0.0015), (at[1] - depth - 0.002, at[1] - depth), (at[2], at[2] + 0.75 * radius))
    made = pieces("knob", dial, finish) + pieces("knob_mark", mark, Finish("mark", (0.75, 0.75, 0.73), 0.5, density=1000))
    return Mover(name, made, "revolute", (0, 1, 0), at, 1.5 * math.pi, "hinge_knob", "knob")


def button(name: str, x: tuple[float, float], z: tuple[float, float], y: float, finish: Finish) -> Mover:
    """Return a push button that stands 8 mm out of the plane `y` and is pressed by 4 mm."""
    cap = box(x, (y - 0.008, y - 0.0045), z, 0.001)
    at = ((x[0] + x[1]) / 2, y, (z[0] + z[1]) / 2)
    return Mover(name, pieces("button", cap, finish), "prismatic", (0, 1, 0), at, 0.004, "slider_button", "button")
