"""What stands on a worktop: toaster, coffee machine, cooking pot."""

import itertools
import math

import numpy as np

from pipeline.corpus.furniture.finishes import DARK_GLASS, ENAMEL, GLASS, GRAPHITE, PLASTIC, STEEL, Finish, Scheme, one_of, shade
from pipeline.corpus.furniture.fronts import FrontStyle, Rect, button, drawer, knob, lid
from pipeline.corpus.furniture.intervals import Interval, Spot, around, between, edges, inset
from pipeline.corpus.furniture.shape import UP, Mover, Pieces, Shape, Size, pieces, staves
from pipeline.corpus.furniture.solids import box, circle, cushion, revolve, ring, rod, slab

WIRE = 0.004  # radius of a bail [m]
COFFEE = Finish("coffee", (0.03, 0.012, 0.006), 0.2, density=1000)


def _enamel(rng: np.random.Generator) -> Finish:
    """Draw the colour of a small appliance."""
    colour = one_of(rng, ((0.55, 0.05, 0.04), (0.68, 0.60, 0.42), (0.30, 0.45, 0.42), (0.05, 0.09, 0.16)))
    gay = Finish("enamel", shade(rng, colour, 0.15), 0.25, density=900)
    return one_of(rng, (STEEL, ENAMEL, GRAPHITE, gay))


def toaster(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a toaster: slots along its length, a lever that is pressed down, a dial and a crumb tray."""
    w, d, h = size
    finish = _enamel(rng)
    stand = 0.026  # of dial and lever before the front
    y = (-d / 2 + stand, d / 2)
    x, z = (-w / 2, w / 2), (0.03, h)
    slots = 2 if form == "two_slots" else 1
    depth, slot, end = y[1] - y[0], 0.03, 0.16 * w
    bars = np.linspace(0.26 * depth, depth - 0.26 * depth - slot, slots)
    cuts = [y[0]]
    for b in bars if slots == 2 else [(depth - slot) / 2]:
        cuts += [y[0] + float(b), y[0] + float(b) + slot]
    cuts.append(y[1])
    base: Pieces = ()
    for k in range(0, len(cuts), 2):
        base += pieces("wall", box(inset(x, end), (cuts[k], cuts[k + 1]), z, 0.004), finish)
    base += pieces("ends", [cushion(span, y, z, 0.02) for span in edges(x, end)], finish)
    base += pieces("skids", [box((a, a + 0.012), inset(y, 0.004), (0.0, 0.03)) for a in (x[0] + 0.012, x[1] - 0.024)], PLASTIC)
    base += pieces("skirt", box(inset(x, 0.024), (y[0] + 0.004, y[0] + 0.014), (0.004, 0.03)), PLASTIC)
    base += pieces("guide", box(around(0.003, 0.30 * w), (y[0] - 0.001, y[0]), (0.3 * h, 0.82 * h)), PLASTIC, group="guide")
    grip = box(around(0.022, 0.30 * w), (y[0] - stand, y[0] - 0.002), (0.72 * h, 0.72 * h + 0.014), 0.003)
    at = (0.30 * w, y[0] - 0.5 * stand, 0.72 * h)
    movers = [Mover("lever", pieces("lever", grip, PLASTIC), "prismatic", (0, 0, -1), at, 0.36 * h, "slider_button", "lever", UP)]
    movers.append(knob("browning", (-0.30 * w, y[0], 0.34 * h), 0.017, STEEL if finish is not STEEL else PLASTIC))
    if slots == 2:
        movers.append(button("stop", around(0.04 * w), (0.31 * h, 0.37 * h), y[0], PLASTIC))
    tray = box(inset(x, 0.03), inset(y, 0.02), (0.008, 0.018))
    lip = box((-0.06, 0.06), (y[1] - 0.0195, y[1]), (0.008, 0.02))  # drawn out at the back
    crumbs = pieces("crumb_tray", [tray], STEEL) + pieces("crumb_lip", lip, PLASTIC)
    back: tuple[float, float, float] = (0.0, 1.0, 0.0)
    movers.append(Mover("crumbs", crumbs, "prismatic", back, (0.0, y[1], 0.013), 0.6 * depth, "slider_drawer", "tray", back))
    return Shape(base, tuple(movers))


def coffee_machine(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a foot with a drip tray, a column with a tank's lid, and a head: for a jug, for a filter holder or for capsules."""
    w, d, h = size
    finish = _enamel(rng)
    trim = PLASTIC if finish is not GRAPHITE else STEEL
    x, y = around(w / 2), (-d / 2 + 0.03, d / 2)
    back, front = y[0] + 0.6 * (y[1] - y[0]), y[0] + 0.01  # the column's face, the plane of dials and buttons
    foot, head, lid_z, t = 0.17 * h, 0.70 * h, h - 0.035, 0.012
    inner, cap_x = inset(x, t), inset(x, 0.004)
    base = pieces("foot", [box(span, y, (0, foot), 0.002) for span in edges(x, t)], trim)
    base += pieces("floor", box(inner, y, (0, 0.01)), trim) + pieces("foot_back", box(inner, (back, y[1]), (0.01, foot)), trim)
    base += pieces("column", box(x, (back, y[1]), (foot, head), 0.006), finish)
    base += pieces("head", box(x, (front, y[1]), (head, lid_z - 0.003), 0.008), finish)
    style = FrontStyle("slab", "edge", trim, STEEL, thickness=0.01)
    rect = Rect(inset(inner, 0.002), (0.012, foot - 0.003), y[0])
    movers = [drawer("drip_tray", rect, style, (inner, (0.01, foot - 0.014), back), PLASTIC)]
    if form == "capsule":
        base += pieces("cap", box(cap_x, (back, y[1] - 0.002), (lid_z - 0.003, lid_z + 0.012), 0.003), trim)
        movers.append(_capsule_lever(w, (front, back - 0.03), lid_z, h))
    else:
        cover = pieces("tank_lid", box(cap_x, (back - 0.02, y[1] - 0.002), (lid_z, h - 0.004), 0.003), trim, group="lid")
        cover += pieces("tank_rim", box((-0.02, 0.02), (back - 0.012, back), (h - 0.004, h)), trim, group="lid")
        movers.append(lid("tank", cover, (0.0, y[1] - 0.002, lid_z), math.radians(80)))
    z = head + 0.45 * (lid_z - head)
    base += pieces("display", box(around(0.14 * w), (front - 0.0015, front), (z - 0.012, z + 0.014)), DARK_GLASS, group="display")
    for k, bx in enumerate((-0.34 * w, 0.16 * w)):
        movers.append(button(f"button_{k}", (bx, bx + 0.1 * w), around(0.010, z), front, PLASTIC if trim is STEEL else STEEL))
    middle = (y[0] + 0.014 + back) / 2
    if form == "jug":
        base += _jug(middle, foot - 0.005, head - 0.012, min(0.38 * w, 0.44 * (back - y[0])))
        plate = slab(circle(min(0.36 * w, middle - y[0] - 0.016), 16, (0.0, middle)), (foot - 0.014, foot - 0.0055))
        return Shape(base + pieces("hot_plate", plate, PLASTIC), tuple(movers))
    bars = np.linspace(y[0] + 0.03, back - 0.014, 7).tolist()
    grate = [box(inset(inner, 0.004), (a, a + 0.007), (foot - 0.014, foot - 0.006)) for a in bars]
    base += pieces("grate", grate, STEEL, group="grate")
    base += pieces("spout", revolve([(0.018, head - 0.035), (0.026, head)], 12, (0.0, middle)), STEEL)
    if form == "espresso":
        holder = revolve([(0.034, head - 0.062), (0.036, head - 0.036)], 14, (0.0, middle))
        stick = rod((0.0, middle - 0.03, head - 0.05), (0.0, y[0] - 0.012, head - 0.06), 0.011, n=8)
        base += pieces("filter_holder", holder, STEEL) + pieces("filter_stick", stick, PLASTIC)
        movers.append(knob("steam", (0.36 * w, front, head + 0.2 * (lid_z - head)), 0.014, STEEL, depth=0.024))
    return Shape(base, tuple(movers))


def _capsule_lever(w: float, y: Interval, z: float, h: float) -> Mover:
    """Return a hoop that lies on the head and is lifted to put a capsule in; it turns about its rear end."""
    half = 0.3 * w
    solids = [box(around(0.006, s * half), y, (z, h - 0.008), 0.002) for s in (-1, 1)]
    solids.append(box(around(half + 0.006), (y[0] - 0.014, y[0]), (z, h - 0.004), 0.003))
    return Mover("lever", pieces("lever", solids, STEEL), "revolute", (-1, 0, 0), (0.0, y[1], z), 1.3, "hinge_handle", "lever", UP)


def _jug(y: float, low: float, high: float, r: float) -> Pieces:
    """Return a glass jug half full of coffee, with a handle."""
    rim, at = high - 0.025, (0.0, y)
    wall = ring((r, 0.8 * r), (r - 0.006, 0.8 * r - 0.006), (low + 0.006, rim), 18, at)
    parts = staves("jug", wall, GLASS) + pieces("jug_floor", slab(circle(r, 18, at), (low, low + 0.006)), GLASS)
    parts += pieces("coffee", revolve([(r - 0.008, low + 0.007), (r - 0.014, low + 0.4 * (rim - low))], 18, at), COFFEE)
    parts += pieces("jug_lid", revolve([(0.8 * r, rim), (0.7 * r, high)], 18, at), PLASTIC)
    grip = [box((-0.008, 0.008), (y - r - 0.026, y - r - 0.014), (low + 0.03, rim - 0.006), 0.003)]
    grip.append(box((-0.008, 0.008), (y - r - 0.014, y - 0.8 * r), (rim - 0.018, rim - 0.006), 0.002))
    return parts + pieces("jug_handle", grip, PLASTIC, group="jug_handle")


def kitchen_pot(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a pot with a lid that lifts off: two ears, a long handle, or a bail."""
    w, d, h = size
    finish = one_of(rng, (STEEL, _enamel(rng), Finish("cast_iron", (0.03, 0.03, 0.032), 0.6, density=5000)))
    grip = STEEL if finish is not STEEL or rng.random() < 0.5 else PLASTIC
    # The hoop of a bail lies level behind the pot, so that the pot is in front of the middle of its box.
    r = w / 2 - 0.025 if form == "bail" else d / 2
    centre = (-w / 2 + d / 2 if form == "stick" else 0.0, 0.0)
    rim = h - min(0.035, 0.2 * h) - 0.02
    wall = ring((0.94 * r, r), (0.94 * r - 0.008, r - 0.008), (0.008, rim), 24, centre)
    base = staves("wall", wall, finish) + pieces("floor", slab(circle(0.94 * r, 24, centre), (0.0, 0.008)), finish)
    dome = revolve([(r + 0.001, rim + 0.002), (r + 0.001, rim + 0.007), (0.5 * r, rim + 0.016), (0.2 * r, rim + 0.02)], 24, centre)
    cover = pieces("lid", dome, GLASS if rng.random() < 0.35 else finish, group="lid")
    neck = revolve([(0.009, rim + 0.02), (0.008, rim + 0.024), (0.02, h - 0.008), (0.016, h)], 12, centre)
    cover += pieces("lid_knob", neck, grip, "round_fixed_handle", "knob")
    movers = [Mover("lid", cover, "prismatic", (0, 0, 1), (*centre, rim), 0.6 * h, "slider_lid", "lid", UP)]
    if form == "stick":
        stick = rod((centre[0] + r - 0.004, 0.0, 0.86 * rim), (w / 2, 0.0, 0.95 * rim), 0.011, 0.009)
        base += pieces("stick", stick, grip, "line_fixed_handle", "stick")
    elif form == "bail":
        z = 0.9 * rim
        movers.append(_bail((w / 2 - 0.004, d - r - 0.004), z))
        lugs = [box(between(s * (r - 0.006), s * (r + 0.008)), (-0.01, 0.01), around(0.012, z), 0.002) for s in (-1, 1)]
        base += pieces("lugs", lugs, STEEL)
    else:
        level = (0.80 * rim, 0.80 * rim + 0.012)
        for s, side in ((-1, "left"), (1, "right")):
            ear = [box(around(0.006, s * (w / 2 - 0.006)), (-0.035, 0.035), level, 0.003)]
            span = between(s * (r - 0.004), s * (w / 2 - 0.012))
            ear += [box(span, around(0.006, sy * 0.028), level, 0.002) for sy in (-1, 1)]
            base += pieces(f"ear_{side}", ear, grip, "line_fixed_handle", f"ear_{s}")
    return Shape(base, tuple(movers))


def _bail(radii: Spot, z: float) -> Mover:
    """Return a bucket's handle: half a hoop that lies level behind the wall and swings over to the front.

    `radii` [m]: half of its width, and how far it reaches back.
    """
    points = [(radii[0] * math.cos(a), radii[1] * math.sin(a), z) for a in np.linspace(0, math.pi, 8).tolist()]
    wires = [rod(a, b, WIRE, n=6) for k, (a, b) in enumerate(itertools.pairwise(points)) if k != 3]
    grip = rod((-0.05, points[3][1], z), (0.05, points[3][1], z), 2 * WIRE, n=8)
    parts = pieces("bail", wires, STEEL) + pieces("bail_grip", grip, PLASTIC)
    return Mover("bail", parts, "revolute", (1, 0, 0), (0.0, 0.0, z), math.pi, "hinge_handle", "handle", UP)
