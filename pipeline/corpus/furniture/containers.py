"""Containers that open: bins and boxes."""

import math

import numpy as np

from pipeline.corpus.furniture.finishes import PLASTIC, PLASTIC_WHITE, STEEL, Finish, Scheme, one_of, pick, shade
from pipeline.corpus.furniture.fronts import Rect, lid
from pipeline.corpus.furniture.intervals import Interval, around, edges, inset
from pipeline.corpus.furniture.shape import UP, Axis3, Mover, Shape, Size, pieces, staves
from pipeline.corpus.furniture.solids import Solid, box, circle, revolve, ring, slab, stack, walls

CARDBOARD = Finish("cardboard", (0.40, 0.26, 0.14), 0.9, pattern="speckle", density=200)


def tray_walls(x: Interval, y: Interval, z: Interval, t: float, bevel: float = 0.0) -> list[Solid]:
    """Return a bottom and four walls of thickness `t` [m] that end at z[1]."""
    return [box(x, y, (z[0], z[0] + t), bevel), *walls(x, y, (z[0] + t, z[1]), t, bevel)]


def trash_can(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bin: round with a pedal, square, with a lid that slides, or with one that swings in a hood."""
    w, d, h = size
    finish = one_of(rng, (STEEL, PLASTIC, Finish("enamel_bin", shade(rng, (0.6, 0.58, 0.52), 0.3), 0.35, density=900)))
    top = h - 0.035
    cover_finish = finish if pick(rng, "same dark") == "same" else PLASTIC
    if form in ("round", "pedal"):
        ahead = 0.045 if form == "pedal" else 0.0
        r = w / 2 - 0.006
        body = ring((0.92 * r, r), (0.92 * r - 0.009, r - 0.009), (0.03, top), 24)
        base = staves("body", body, finish) + pieces("foot", slab(circle(0.94 * r, 24), (0.0, 0.03), 0.004), PLASTIC)
        lid_parts = pieces("lid", revolve([(w / 2 - 0.004, top + 0.003), (w / 2 - 0.004, top + 0.015), (0.7 * r, h)], 24), cover_finish)
        movers = [lid("lid", lid_parts, (0.0, r + 0.002, top + 0.004), math.radians(80))]
        if form == "pedal":
            plate = box((-0.045, 0.045), (-r - ahead, -0.94 * r - 0.004), (0.022, 0.030), 0.002)
            at = (0.0, -r - 0.5 * ahead, 0.03)
            movers.append(Mover("pedal", pieces("pedal", plate, STEEL), "prismatic", (0, 0, -1), at, 0.016, "slider_button", "pedal", UP))
        return Shape(base, tuple(movers))
    x, y = (-w / 2 + 0.004, w / 2 - 0.004), (-d / 2 + 0.004, d / 2 - 0.004)
    if form == "swing":
        return _swing_bin(x, y, h, finish, cover_finish)
    base = pieces("body", tray_walls(x, y, (0.0, top), 0.009, 0.002), finish)
    corners = np.array([(-w / 2, -d / 2), (w / 2, -d / 2), (w / 2, d / 2), (-w / 2, d / 2)])
    low = np.column_stack([corners, np.full(4, top + 0.003)])
    shrink = 0.9 if form == "box" else 0.97
    rise = np.array([0, 0, h - top - 0.003])
    cover = pieces("lid", stack([low, low + np.array([0, 0, 0.012]), low * np.array([shrink, shrink, 1]) + rise]), cover_finish)
    if form == "box":
        return Shape(base, (lid("lid", cover, (0.0, d / 2, top + 0.003), math.radians(88)),))
    grip = box((-0.04, 0.04), (-0.012, 0.012), (h - 0.0005, h + 0.012), 0.003)
    cover += pieces("lid_grip", grip, PLASTIC, "line_fixed_handle")
    axis = (1.0, 0.0, 0.0) if rng.random() < 0.5 else (-1.0, 0.0, 0.0)
    return Shape(base, (Mover("lid", cover, "prismatic", axis, (0.0, 0.0, h), 0.8 * w, "slider_lid", "lid", UP),))


def _swing_bin(x: Interval, y: Interval, h: float, finish: Finish, hood: Finish) -> Shape:
    """Return a bin whose hood has a flap at its front: it hangs from its upper edge and is pulled outwards."""
    t, low = 0.009, 0.68 * h
    base = pieces("body", tray_walls(x, y, (0.0, low), t, 0.002), finish)
    over = [box(span, y, (low + 0.001, h)) for span in edges(x, t)]
    over.append(box(inset(x, t), y, (h - t, h), 0.002))
    over.append(box(inset(x, t), (y[1] - t, y[1]), (low + 0.001, h - t)))
    span = Rect((x[0] + t + 0.003, x[1] - t - 0.003), (low + 0.004, h - t - 0.003), y[0] + 0.001)
    flap = pieces("flap", box(span.x, (span.y, span.y + t), span.z, 0.002), hood, group="flap")
    sign = box((-0.05, 0.05), (span.y - 0.001, span.y), around(0.012, span.middle[1]))
    flap += pieces("flap_sign", sign, PLASTIC_WHITE, group="flap")
    hinge = (0.0, span.y, span.z[1])
    mover = Mover("flap", flap, "revolute", (-1, 0, 0), hinge, math.radians(75), "hinge_lid", "lid")
    return Shape(base + pieces("hood", over, hood), (mover,))


def storage_box(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a box: a hinged lid with a latch strip, four flaps of cardboard, or a lid that slides off."""
    w, d, h = size
    x, y = (-w / 2, w / 2), (-d / 2, d / 2)
    if form == "flaps":
        return _carton(size)
    finish = scheme.body if form == "slide" or rng.random() < 0.5 else Finish("box_lacquer", scheme.front.color, 0.5, density=600)
    t = 0.009
    if form == "slide":
        top = h - 0.016
        base = pieces("walls", tray_walls(x, y, (0.0, top), t, 0.001), finish)
        plate = pieces("lid", box(x, y, (top + 0.002, h - 0.004), 0.002), finish, group="lid")
        notch = box((-0.4 * w, -0.34 * w), around(0.2 * d), (h - 0.004, h), 0.001)
        plate += pieces("lid_grip", notch, finish, "line_fixed_handle")
        return Shape(base, (Mover("lid", plate, "prismatic", (1, 0, 0), (0.0, 0.0, h), 0.85 * w, "slider_lid", "lid", UP),))
    front = y[0] + 0.008  # a tab stands out
    cover = min(0.05, 0.25 * h)
    low = h - cover
    base = pieces("walls", tray_walls(x, (front, y[1]), (0.0, low), t, 0.001), finish)
    lid_parts = pieces("lid", box(x, (front, y[1]), (h - t, h), 0.002), finish)
    rim = [box(span, (front, y[1]), (low + 0.002, h - t)) for span in edges(x, t)]
    rim += [box(inset(x, t), (a, a + t), (low + 0.002, h - t)) for a in (front, y[1] - t)]
    lid_parts += pieces("lid_rim", rim, finish)
    lid_parts += pieces("tab", box((-0.025, 0.025), (y[0], front), (low - 0.012, low + 0.02), 0.002), scheme.handle, "line_fixed_handle")
    corners = [box(around(0.012, sx * (w / 2 - 0.012)), (front - 0.001, front), (0.0, 0.03)) for sx in (-1, 1)]
    base += pieces("corners", corners, scheme.handle)
    return Shape(base, (lid("lid", lid_parts, (0.0, y[1], low + 0.002), math.radians(100)),))


def _carton(size: Size) -> Shape:
    """Return a carton: two long flaps meet over two short ones, which wait for them."""
    w, d, h = size
    x, y, t = (-w / 2, w / 2), (-d / 2, d / 2), 0.008
    low = h - 2 * t - 0.003
    base = pieces("walls", tray_walls(x, y, (0.0, low), t), CARDBOARD)
    tape = Finish("tape", (0.55, 0.42, 0.25), 0.3, density=900)
    base += pieces("tape", box((-0.03, 0.03), (y[0] - 0.0006, y[0]), (0.35 * h, low)), tape, group="tape")
    movers = []
    for name, side in (("flap_front", -1), ("flap_back", 1)):
        span = sorted((side * d / 2, side * 0.002))
        board = pieces(name, box(x, (span[0], span[1]), (low + t + 0.002, h)), CARDBOARD)
        edge: Axis3 = (0.0, side * d / 2, h)
        movers.append(Mover(name, board, "revolute", (-float(side), 0.0, 0.0), edge, math.radians(110), "hinge_lid", "lid", UP))
    for name, side in (("flap_left", -1), ("flap_right", 1)):
        reach = 0.45 * min(d, w)
        span = sorted((side * w / 2, side * (w / 2 - reach)))
        board = pieces(name, box((span[0], span[1]), (y[0] + t + 0.003, y[1] - t - 0.003), (low + 0.001, low + t)), CARDBOARD)
        edge = (side * w / 2, 0.0, low + t)
        waits = ("flap_front", "flap_back")
        movers.append(Mover(name, board, "revolute", (0.0, float(side), 0.0), edge, math.radians(110), "hinge_lid", "lid", UP, after=waits))
    return Shape(base, tuple(movers))
