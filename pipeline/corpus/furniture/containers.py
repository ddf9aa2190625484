"""Containers that open: bins, buckets, boxes, suitcases, safes, small chests of drawers."""

# ruff: noqa: ARG001 - all builders share one signature, whatever of it they need

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.casework import Case, Cell, Column, case
from pipeline.corpus.furniture.countertop import bail, lugs
from pipeline.corpus.furniture.finishes import DARK_GLASS, GRAPHITE, LEATHERS, PLASTIC, PLASTIC_WHITE, STEEL, Finish, Scheme, shade
from pipeline.corpus.furniture.fronts import FrontStyle, Rect, button, door, knob, lid
from pipeline.corpus.furniture.panels import frame
from pipeline.corpus.furniture.shape import UP, Axis3, Mover, Piece, Shape, pieces, staves
from pipeline.corpus.furniture.solids import Solid, box, circle, revolve, ring, rod, slab, stack, walls
from pipeline.corpus.furniture.storage import Size, pick

Interval = tuple[float, float]
CARDBOARD = Finish("cardboard", (0.40, 0.26, 0.14), 0.9, pattern="speckle", density=200)


def tray_walls(x: Interval, y: Interval, z: Interval, t: float, bevel: float = 0.0) -> list[Solid]:
    """Return a bottom and four walls of thickness `t` [m] that end at z[1]."""
    return [box(x, y, (z[0], z[0] + t), bevel), *walls(x, y, (z[0] + t, z[1]), t, bevel)]


def trash_can(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bin: round with a pedal, square, with a lid that slides, or with one that swings in a hood."""
    w, d, h = size
    finish = (STEEL, PLASTIC, Finish("enamel_bin", shade(rng, (0.6, 0.58, 0.52), 0.3), 0.35, density=900))[int(rng.integers(3))]
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
    over = [box((x[0], x[0] + t), y, (low + 0.001, h)), box((x[1] - t, x[1]), y, (low + 0.001, h))]
    over.append(box((x[0] + t, x[1] - t), y, (h - t, h), 0.002))
    over.append(box((x[0] + t, x[1] - t), (y[1] - t, y[1]), (low + 0.001, h - t)))
    span = Rect((x[0] + t + 0.003, x[1] - t - 0.003), (low + 0.004, h - t - 0.003), y[0] + 0.001)
    flap = pieces("flap", box(span.x, (span.y, span.y + t), span.z, 0.002), hood, group="flap")
    sign = box((-0.05, 0.05), (span.y - 0.001, span.y), (span.middle[1] - 0.012, span.middle[1] + 0.012))
    flap += pieces("flap_sign", sign, PLASTIC_WHITE, group="flap")
    hinge = (0.0, span.y, span.z[1])
    mover = Mover("flap", flap, "revolute", (-1, 0, 0), hinge, math.radians(75), "hinge_lid", "lid")
    return Shape(base + pieces("hood", over, hood), (mover,))


def bucket(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a round bucket with a bail, of sheet or of plastic; one kind has a lid."""
    w, _, h = size
    colour = ((0.05, 0.14, 0.32), (0.42, 0.05, 0.04), (0.10, 0.28, 0.16), (0.55, 0.55, 0.53))[int(rng.integers(4))]
    zinc = Finish("zinc", (0.42, 0.44, 0.46), 0.4, 0.7, density=3000)
    finish = zinc if form == "zinc" else Finish("bucket", shade(rng, colour, 0.1), 0.4, density=950)
    r = w / 2 - 0.026
    covered = form == "lid"
    rim = h - (0.03 if covered else 0.0)
    wall = ring((0.74 * r, r), (0.74 * r - 0.009, r - 0.009), (0.012, rim - 0.014), 24)
    base = staves("wall", wall, finish) + pieces("floor", slab(circle(0.74 * r, 24), (0.0, 0.012)), finish)
    base += staves("wall", ring((r + 0.003, r + 0.003), (r - 0.008, r - 0.008), (rim - 0.014, rim), 24), finish)
    z = rim - 0.03
    base += pieces("lugs", lugs(r, z, (0.0, 0.0)), finish)
    movers = [bail((w / 2 - 0.004, w - r - 0.004), z, (0.0, 0.0), STEEL)]
    if covered:
        dome = revolve([(r + 0.002, rim + 0.002), (r + 0.002, rim + 0.008), (0.9 * r, rim + 0.012)], 24)
        lid_parts = pieces("lid", dome, finish, group="lid")
        lid_parts += pieces(
            "lid_knob", revolve([(0.018, rim + 0.012), (0.022, h - 0.004), (0.016, h)], 12), PLASTIC, "round_fixed_handle", "knob"
        )
        movers.append(Mover("lid", lid_parts, "prismatic", (0, 0, 1), (0.0, 0.0, rim), 0.5 * h, "slider_lid", "lid", UP))
    return Shape(base, tuple(movers))


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
        notch = box((-0.4 * w, -0.34 * w), (-0.2 * d, 0.2 * d), (h - 0.004, h), 0.001)
        plate += pieces("lid_grip", notch, finish, "line_fixed_handle")
        return Shape(base, (Mover("lid", plate, "prismatic", (1, 0, 0), (0.0, 0.0, h), 0.85 * w, "slider_lid", "lid", UP),))
    front = y[0] + 0.008  # a tab stands out
    cover = min(0.05, 0.25 * h)
    low = h - cover
    base = pieces("walls", tray_walls(x, (front, y[1]), (0.0, low), t, 0.001), finish)
    lid_parts = pieces("lid", box(x, (front, y[1]), (h - t, h), 0.002), finish)
    rim = [box((x[0], x[0] + t), (front, y[1]), (low + 0.002, h - t)), box((x[1] - t, x[1]), (front, y[1]), (low + 0.002, h - t))]
    rim += [box((x[0] + t, x[1] - t), (a, a + t), (low + 0.002, h - t)) for a in (front, y[1] - t)]
    lid_parts += pieces("lid_rim", rim, finish)
    lid_parts += pieces("tab", box((-0.025, 0.025), (y[0], front), (low - 0.012, low + 0.02), 0.002), scheme.handle, "line_fixed_handle")
    corners = [box((sx * (w / 2 - 0.012) - 0.012, sx * (w / 2 - 0.012) + 0.012), (front - 0.001, front), (0.0, 0.03)) for sx in (-1, 1)]
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


def _case_shell(rng: np.random.Generator) -> Finish:
    colour = (LEATHERS["cognac"], (0.05, 0.10, 0.16), (0.30, 0.05, 0.05), (0.10, 0.10, 0.105))[int(rng.integers(4))]
    return Finish("case_shell", shade(rng, colour, 0.15), 0.5, density=500)


def briefcase(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a case that lies: it opens like a shell, latches and a folding handle in front."""
    w, d, h = size
    finish = _case_shell(rng)
    stand = 0.05
    x, y, t = (-w / 2, w / 2), (-d / 2 + stand, d / 2), 0.009
    half = 0.52 * h
    base = pieces("lower", tray_walls(x, y, (0.0, half), t, 0.002), finish)
    base += pieces("band", box((x[0] - 0.001, x[1] + 0.001), (y[0] - 0.001, y[0]), (half - 0.012, half)), STEEL, group="band")
    lid_parts = pieces("upper", box(x, y, (h - t, h), 0.004), finish)
    lid_parts += pieces("upper_rim", walls(x, y, (half + 0.003, h - t), t), finish)
    movers = [lid("lid", lid_parts, (0.0, y[1], half + 0.003), math.radians(110))]
    # the handle hangs against the front and is folded out
    z = half - 0.03
    reach, wide = min(0.036, z - 0.02), min(0.07, 0.2 * w)  # it hangs clear of what the case lies on
    hoop = [box((s * wide - 0.006, s * wide + 0.006), (y[0] - 0.016, y[0] - 0.003), (z - reach, z), 0.002) for s in (-1, 1)]
    hoop.append(box((-wide - 0.006, wide + 0.006), (y[0] - 0.018, y[0] - 0.003), (z - reach - 0.014, z - reach), 0.003))
    movers.append(
        Mover("handle", pieces("handle", hoop, PLASTIC), "revolute", (-1, 0, 0), (0.0, y[0] - 0.003, z), 1.5, "hinge_handle", "handle")
    )
    for k, s in enumerate((-1, 1)):
        at = s * 0.32 * w
        movers.append(button(f"latch_{k}", (at - 0.018, at + 0.018), (half - 0.03, half - 0.016), y[0], STEEL))
    return Shape(base, tuple(movers))


def suitcase(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build an upright case: wheels, a rear shell with a pull and a hoop to carry it by, a front shell that turns at the left."""
    w, d, h = size
    finish = _case_shell(rng)
    wheel, t, face = 0.045, 0.01, 0.03  # the faces are thick enough to be rounded
    x, y, z = (-w / 2, w / 2), (-d / 2, d / 2), (wheel + 0.006, h - 0.035)
    middle = 0.0
    outer, inner = Rect(x, z, 0.0), Rect((x[0] + t, x[1] - t), (z[0] + t, z[1] - t), 0.0)
    shell = [box(x, (y[1] - face, y[1]), z, 0.009), *frame(outer, inner, (middle, y[1] - face), 0.0)]
    base = pieces("rear", shell, finish)
    tyre = [s.turned("y", math.pi / 2) for s in revolve([(wheel / 2, -0.008), (wheel / 2, 0.008)], 12)]

    def castors(tread: float, lift: float) -> tuple[Piece, ...]:
        """Return two wheels below a shell, `lift` [m] off the floor, and what holds them."""
        xs = [s * 0.4 * w for s in (-1, 1)]
        wheels = [s.moved((x, tread, wheel / 2 + lift)) for x in xs for s in tyre]
        forks = [box((x - 0.012, x + 0.012), (tread - 0.0215, tread + 0.0215), (wheel + lift + 0.0005, z[0])) for x in xs]
        return pieces("wheels", wheels, PLASTIC) + pieces("forks", forks, PLASTIC)

    base += castors(y[1] - 0.0335, 0.0)
    base += pieces("tubes", [rod((s * 0.2 * w, y[1] - 0.02, z[1]), (s * 0.2 * w, y[1] - 0.02, h - 0.014), 0.006) for s in (-1, 1)], STEEL)
    base += pieces("pull", box((-0.22 * w, 0.22 * w), (y[1] - 0.034, y[1] - 0.006), (h - 0.014, h), 0.004), PLASTIC, "line_fixed_handle")
    front = [box(x, (y[0], y[0] + face), z, 0.009), *frame(outer, inner, (y[0] + face, middle - 0.003), 0.0)]
    front_parts = pieces("front", front, finish) + castors(y[0] + 0.0335, 5e-4)  # which turn with it
    grooves = [
        box((x[0] + (k + 0.5) * w / 7 - 0.008, x[0] + (k + 0.5) * w / 7 + 0.008), (y[0] - 0.003, y[0]), (z[0] + 0.03, z[1] - 0.03))
        for k in range(7)
    ]
    front_parts += pieces("ribs", grooves, finish, group="ribs")
    axis = (0.0, 0.0, -1.0)
    shut = Mover("shell", front_parts, "revolute", axis, (x[0], middle - 0.003, (z[0] + z[1]) / 2), math.radians(120), "hinge_door", "door")
    hoop = [
        box((x[1] + 0.001, x[1] + 0.012), (middle + 0.01, middle + 0.024), (0.45 * h + s * 0.08 - 0.006, 0.45 * h + s * 0.08 + 0.006))
        for s in (-1, 1)
    ]
    hoop.append(box((x[1] + 0.012, x[1] + 0.024), (middle + 0.008, middle + 0.026), (0.45 * h - 0.086, 0.45 * h + 0.086), 0.003))
    grip = pieces("carry", hoop, PLASTIC, group="carry")
    pivot = (x[1] + 0.001, middle + 0.009, 0.45 * h)
    return Shape(base, (shut, Mover("carry", grip, "revolute", (0, 0, -1), pivot, 0.6, "hinge_handle", "handle", (1.0, 0.0, 0.0))))


def safe(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a safe of thick walls: its door carries a dial and a lever, or a field of keys and a knob."""
    w, d, h = size
    finish = (
        GRAPHITE,
        Finish("safe_grey", (0.30, 0.31, 0.32), 0.4, density=2000),
        Finish("safe_green", (0.05, 0.10, 0.07), 0.4, density=2000),
    )[int(rng.integers(3))]
    t, stand = min(0.045, 0.14 * w), 0.05
    x, y, z = (-w / 2, w / 2), (-d / 2 + stand, d / 2), (0.02, h)
    solids = [box((x[0], x[0] + t), y, z, 0.004), box((x[1] - t, x[1]), y, z, 0.004)]
    inner = (x[0] + t, x[1] - t)
    solids += [
        box(inner, y, (z[0], z[0] + t), 0.003),
        box(inner, y, (z[1] - t, z[1]), 0.003),
        box(inner, (y[1] - t, y[1]), (z[0] + t, z[1] - t)),
    ]
    base = pieces("walls", solids, finish)
    base += pieces("feet", [box((sx * 0.36 * w - 0.02, sx * 0.36 * w + 0.02), (-0.3 * d, 0.4 * d), (0.0, 0.02)) for sx in (-1, 1)], PLASTIC)
    middle = (z[0] + z[1]) / 2
    if h > 0.35:
        base += pieces("shelf", box(inner, (y[0] + 0.08, y[1] - t), (middle - 0.006, middle + 0.006)), finish)
    side = "left" if rng.random() < 0.6 else "right"
    s = 1.0 if side == "left" else -1.0
    rect = Rect((inner[0] + 0.003, inner[1] - 0.003), (z[0] + t + 0.003, z[1] - t - 0.003), y[0])
    style = FrontStyle("slab", "none", finish, STEEL, thickness=0.035)
    leaf = door("door", rect, style, side, math.radians(110))  # type: ignore[arg-type]
    face = y[0]
    movers: list[Mover] = [leaf]
    if form == "dial":
        movers.append(knob("dial", (-s * 0.02 * w, face, middle + 0.14 * h), min(0.045, 0.11 * w), STEEL, depth=0.03))
        movers.append(_wheel((s * 0.16 * w, face, middle - 0.1 * h), min(0.09, 0.18 * w), s))
    else:
        pad = box((-0.05 - s * 0.03 * w, 0.05 - s * 0.03 * w), (face - 0.004, face), (middle - 0.02, middle + 0.11))
        movers[0] = replace(leaf, pieces=leaf.pieces + pieces("pad", pad, PLASTIC))
        shown = box((-0.035 - s * 0.03 * w, 0.035 - s * 0.03 * w), (face - 0.005, face - 0.004), (middle + 0.082, middle + 0.102))
        movers[0] = replace(movers[0], pieces=movers[0].pieces + pieces("display", shown, DARK_GLASS, group="display"))
        for k in range(12):
            bx, bz = (k % 3 - 1) * 0.028 - s * 0.03 * w, middle + 0.064 - (k // 3) * 0.024
            movers.append(button(f"key_{k}", (bx - 0.010, bx + 0.010), (bz - 0.008, bz + 0.008), face - 0.004, PLASTIC_WHITE))
        movers.append(knob("turn", (s * 0.26 * w, face, middle + 0.02), 0.026, STEEL, depth=0.034, turn=math.pi / 2))
    return Shape(base, (movers[0], *(replace(m, parent="door") for m in movers[1:])))


def _wheel(at: tuple[float, float, float], r: float, s: float) -> Mover:
    """Return the lever that draws the bolts: a hub with one arm."""
    hub = [k.turned("x", math.pi / 2).moved(at) for k in revolve([(0.016, 0.001), (0.016, 0.032), (0.012, 0.038)], 12)]
    arm = box((min(at[0], at[0] + s * r), max(at[0], at[0] + s * r)), (at[1] - 0.034, at[1] - 0.022), (at[2] - 0.009, at[2] + 0.009), 0.003)
    parts = pieces("lever", [*hub, arm], STEEL, group="lever")
    return Mover("lever", parts, "revolute", (0, s, 0), at, math.pi / 2, "hinge_handle", "handle")


def drawer_organiser(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a small chest for a desk: one column of trays, or a grid of little drawers."""
    w, _, h = size
    gay = Finish("organiser", shade(rng, (0.55, 0.52, 0.47), 0.4), 0.5, density=500)
    body = scheme.body if rng.random() < 0.6 else gay
    style = FrontStyle("slab", "knob" if form == "grid" else "edge", scheme.front if body is scheme.body else gay, scheme.handle, 0.010)
    how = Case(body, style, "none", 0.0, body, top_thickness=0.009, board=0.009, inset=True)
    rows = max(2, min(5, round(h / 0.085)))
    count = 1 if form == "trays" else max(2, min(3, round(w / 0.13)))
    rows = min(rows, 12 // count)
    return case(size, [Column(1, tuple(Cell("drawer") for _ in range(rows)))] * count, how)
