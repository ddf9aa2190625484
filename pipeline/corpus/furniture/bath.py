"""Bathroom fixtures: toilet, bathtub, shower."""

import math

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.bent import split_bent_quads
from pipeline.corpus.furniture.finishes import CERAMIC, GLASS, PLASTIC_WHITE, STEEL, Scheme
from pipeline.corpus.furniture.fronts import lid, top_button
from pipeline.corpus.furniture.intervals import Interval, around, between
from pipeline.corpus.furniture.shape import UP, Mover, Shape, Size, pieces, staves
from pipeline.corpus.furniture.solids import box, circle, cushion, hull, revolve, ring, rod, rounded_rectangle, shell, slab, stack, walls


def _oval(rx: float, y: Interval, z: float) -> NDArray[np.float64]:
    """Return an ellipse (24, 3) that spans +-rx and the interval `y` at height `z`."""
    ry = (y[1] - y[0]) / 2
    return np.column_stack([circle(rx, 24, (0.0, (y[0] + y[1]) / 2), ry / rx), np.full(24, z)])


def toilet(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bowl on a foot, a tank with a button or a lever, and a seat and a lid that fold up against the tank."""
    w, d, h = size
    rim = 0.52 * h
    tank_y = (d / 2 - 0.27 * d, d / 2)
    bowl_y = (-d / 2 + 0.004, tank_y[0] - 0.035)
    rx = 0.47 * w
    cy, ry = (bowl_y[0] + bowl_y[1]) / 2, (bowl_y[1] - bowl_y[0]) / 2

    def oval(across: float, along: float, z: float) -> NDArray[np.float64]:
        return _oval(across * rx, around(along * ry, cy), z)

    foot = split_bent_quads(stack([oval(0.74, 0.80, 0.0), oval(0.70, 0.76, 0.10 * h)]))
    neck = split_bent_quads(stack([oval(0.70, 0.76, 0.10 * h), oval(0.90, 0.90, 0.62 * rim)]))
    outer = [oval(k, k, z) for k, z in ((0.90, 0.62 * rim), (1.0, rim))]
    wall = shell(outer, [oval(k, k, z) for k, z in ((0.42, 0.62 * rim), (0.76, rim))])
    heel, shelf = (around(0.27 * w), (cy + 0.3 * ry, d / 2 - 0.06)), (around(0.36 * w), (bowl_y[1] - 0.05, d / 2 - 0.012))
    outlines = [(heel, 0.0), (shelf, 0.8 * rim), (shelf, rim)]
    bridge = hull(np.concatenate([np.column_stack([rounded_rectangle(*spans, 0.04), np.full(20, z)]) for spans, z in outlines]))
    half = (0.44 if form == "lever" else 0.5) * w  # a lever stands out of the tank's side
    base = pieces("bowl", [foot, neck], CERAMIC) + staves("bowl", wall, CERAMIC) + pieces("bridge", bridge, CERAMIC)
    base += pieces("tank", cushion((-half, half), tank_y, (rim, h - 0.03), 0.025), CERAMIC)
    base += pieces("tank_lid", cushion((-half, half), (tank_y[0] - 0.006, tank_y[1]), (h - 0.029, h - 0.006), 0.01), CERAMIC)
    hinge_y, middle = bowl_y[1] - 0.012, sum(tank_y) / 2
    seat_z, lid_z = (rim + 0.004, rim + 0.019), (rim + 0.022, rim + 0.036)
    sx, span = 0.98 * rx, (bowl_y[0] - 0.002, hinge_y)
    hole = [_oval(0.66 * sx, (cy - 0.74 * ry, hinge_y - 0.09), z) for z in seat_z]
    seat = staves("seat", shell([_oval(sx, span, z) for z in seat_z], hole), PLASTIC_WHITE)
    cover = pieces("lid", slab(_oval(sx, span, 0.0)[:, :2], lid_z, 0.004), PLASTIC_WHITE)
    movers = [lid("seat", seat, (0.0, hinge_y, seat_z[1]), math.radians(92))]
    movers.append(lid("lid", cover, (0.0, hinge_y, lid_z[1]), math.radians(92), parent="seat"))  # a seat that is lifted lifts its lid
    if form == "lever":
        movers.append(_lever(half, middle, h))
    elif form == "dual":  # the large flush and the small one
        for name, x in (("small", (-0.035, -0.002)), ("large", (0.002, 0.045))):
            movers.append(top_button(name, x, around(0.018, middle), (h - 0.0045, h), STEEL, 0.0015))
    else:
        cap = pieces("button", revolve([(0.022, h - 0.0045), (0.022, h - 0.001), (0.018, h)], 16, (0.0, middle)), STEEL)
        movers.append(Mover("button", cap, "prismatic", (0, 0, -1), (0.0, middle, h), 0.0015, "slider_button", "button", UP))
    return Shape(base, tuple(movers))


def _lever(half: float, y: float, h: float) -> Mover:
    """Return the flushing lever at the left side of the tank: its front end turns down by half a radian."""
    at = (-half, y + 0.03, h - 0.1)
    arm = box((at[0] - 0.020, at[0] - 0.012), (at[1] - 0.085, at[1] + 0.008), around(0.008, at[2]), 0.002)
    parts = pieces("lever", [rod(at, (at[0] - 0.012, at[1], at[2]), 0.010, n=10), arm], STEEL, group="lever")
    return Mover("lever", parts, "revolute", (1, 0, 0), at, 0.5, "hinge_handle", "lever", (-1.0, 0.0, 0.0))


def _rays(w: float, d: float) -> NDArray[np.float64]:
    """Return directions (32, 2) around the centre that include those of a rectangle's corners.

    Outlines along the same rays make staves with plane sides, so each is convex.
    """
    corner = math.atan2(d, w)
    at_corners = [corner, math.pi - corner, math.pi + corner, -corner + 2 * math.pi]
    angles = np.sort(np.concatenate([np.linspace(0, 2 * math.pi, 28, endpoint=False), at_corners]))
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _along(u: NDArray[np.float64], a: float, b: float, power: float) -> NDArray[np.float64]:
    """Return the superellipse |x/a|^p + |y/b|^p = 1 along rays `u`, (n, 2)."""
    reach = (np.abs(u[:, 0] / a) ** power + np.abs(u[:, 1] / b) ** power) ** (-1 / power)
    return np.asarray(u * reach[:, None])


def bathtub(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a tub with aprons, or one that stands free on its oval foot; a tap at its head."""
    w, d, h = size
    a, b, low = w / 2, d / 2, 0.14
    rim = h if form == "free" else h - 0.12
    u = _rays(w, d)
    outer = _along(u, a, b, 2.6) if form == "free" else u / np.maximum(np.abs(u[:, :1]) / a, np.abs(u[:, 1:]) / b)
    inner = _along(u, a - 0.07, b - 0.07, 3.0)
    foot = 0.82 * outer if form == "free" else outer

    def at(outline: NDArray[np.float64], z: float) -> NDArray[np.float64]:
        return np.column_stack([outline, np.full(len(outline), z)])

    wall = shell([at(foot, low), at(outer, rim)], [at(0.8 * inner, low), at(inner, rim)])
    floor = box((-a, a), (-b, b), (0.0, low)) if form == "apron" else slab(foot, (0.0, low))
    base = pieces("tub", [*wall, floor], CERAMIC)
    if form == "apron":
        x = a - 0.035
        spout = [rod((x, 0, rim), (x, 0, h - 0.01), 0.014, n=10), rod((x, 0, h - 0.018), (x - 0.13, 0, h - 0.03), 0.012, n=10)]
        spout += [rod((x, s * 0.09, rim), (x, s * 0.09, rim + 0.05), 0.016, 0.02, 10) for s in (-1, 1)]
        base += pieces("tap", spout, scheme.handle)
    return Shape(base)


def shower(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a tray with two glass walls, an open entrance at the front, a rail with a head and a mixer at the back wall."""
    w, d, h = size
    tray, metal = 0.06, scheme.handle
    x, y, back = around(w / 2), around(d / 2), d / 2 - 0.05
    basin = [box(x, y, (0, tray - 0.02), 0.003), *walls(x, y, (tray - 0.02, tray), 0.04)]
    side = -1 if rng.random() < 0.5 else 1
    pane = side * (w / 2 - 0.012)
    base = pieces("tray", basin, CERAMIC) + pieces("glass_side", box(around(0.004, pane), (y[0] + 0.012, y[1] - 0.002), (tray, h)), GLASS)
    end = side * (w / 2 - 0.02 - 0.42 * w)
    base += pieces("glass_front", box(between(side * (w / 2 - 0.018), end), (y[0] + 0.008, y[0] + 0.016), (tray, h)), GLASS)
    posts = [box(around(0.01, px), (y[0] + 0.002, y[0] + 0.022), (tray, h), 0.002) for px in (end, pane)]
    pole = [rod((0, back, 0.95), (0, back, h - 0.01), 0.011, n=8), rod((0, back, h - 0.02), (0, d / 2 - 0.33, h - 0.02), 0.010, n=8)]
    pole += [rod((0, d / 2, z), (0, back, z), 0.009, n=8) for z in (1.0, h - 0.12)]
    pole += revolve([(0.11, h - 0.055), (0.11, h - 0.045), (0.03, h - 0.022)], 20, (0.0, d / 2 - 0.33))
    base += pieces("posts", posts, metal) + pieces("rail", pole, metal)
    base += pieces("mixer", box((-0.13, 0.13), (back, d / 2), (1.02, 1.07), 0.008), metal)
    return Shape(base + pieces("drain", ring((0.045, 0.045), (0.03, 0.03), (tray - 0.02, tray - 0.017), 16), STEEL))
