"""Easy chairs: framed, winged, swivelling, tubs, cane ones. The front is -y. Lengths in metres."""

import math

import numpy as np

from pipeline.corpus.furniture.bent import arc, curve, lean, sheet, tube, turns, upright, wall
from pipeline.corpus.furniture.finishes import PLASTIC, Finish, Scheme, cane, shade
from pipeline.corpus.furniture.intervals import around, between, corners, inset, polar
from pipeline.corpus.furniture.legs import draw_kind, leg_finish, legs
from pipeline.corpus.furniture.shape import Pieces, Shape, Size, pieces
from pipeline.corpus.furniture.solids import Solid, beam, box, cushion, revolve, rod, slab, stack
from pipeline.corpus.furniture.upholstery import piping, seat_cushion, upright_pad


def lounge_chair(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build an easy chair in a wooden frame, an office chair, a wing chair, a recliner's shell, a tub or a cane chair."""
    build = {"easy": _easy, "office": _office, "wing": _wing, "lounger": _lounger, "tub": _tub, "rattan": _rattan}[form]
    return Shape(build(rng, size, scheme))


def _easy(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    w, d, h = size
    seat, x, y = min(0.42, 0.48 * h), w / 2, d / 2
    arm = seat + 0.18
    t = 0.032 * scheme.manner.slim
    wood = scheme.timber
    frame: list[Solid] = []
    rest = sheet(
        curve([(-y + 0.005, arm - 0.012), (-0.2 * y, arm - 0.006), (0.78 * y, arm - 0.02)], 2), 0.02, [0.046, 0.056, 0.052, 0.046, 0.04]
    )
    for s in (-1, 1):
        px = s * (x - 0.024)
        frame += [beam((px, a, 0), (px, b, arm - 0.022), t, 1.2 * t) for a, b in ((-y + 0.03, -y + 0.05), (y - 0.03, y - 0.13))]
        frame += [q.moved((px, 0, 0)) for q in rest]
        frame.append(box(around(0.011, px), (-y + 0.07, y - 0.12), (seat - 0.18, seat - 0.125), 0.003))
    frame += [box(around(x - 0.04), around(0.011, a), (seat - 0.18, seat - 0.13), 0.003) for a in (-y + 0.09, y - 0.2)]
    slope, back = 0.28, y - 0.14 - 0.28 * (h - seat) * 0.6
    wide, top = around(x - 0.045), h - 0.012
    parts = pieces("frame", frame, wood)
    parts += seat_cushion(wide, (-y + 0.01, back - 0.055), (seat - 0.125, seat + 0.02), 0.04, scheme.soft, piping(rng, scheme), 0.025)
    pad = upright_pad(rng, scheme, wide, around(0.05, back), (seat - 0.1, top))
    parts += pieces("back_pad", lean(pad, seat - 0.1, slope), scheme.soft)
    xs = np.linspace(*inset(wide, 0.03), 5)
    laths = [box(around(0.013, px), (back + 0.052, back + 0.068), (seat - 0.17, top - 0.06), 0.002) for px in xs]
    return parts + pieces("laths", lean(laths, seat - 0.1, slope), wood)


def _wing(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    w, d, h = size
    seat, x, y = min(0.44, 0.46 * h), w / 2, d / 2
    kind = draw_kind(rng, scheme, "plank cross sled hairpin pipe blade horse")
    low, cloth = 0.17, scheme.soft
    parts = pieces("legs", legs(kind, (x - 0.07, y - 0.08), low, 0.042), leg_finish(scheme, kind))
    parts += pieces("body", cushion(around(x - 0.03), around(y - 0.02), (low, seat - 0.1), 0.025, 2), cloth)
    arm, back = 0.13 * min(1.0, w / 0.75), y - 0.15
    parts += seat_cushion(around(x - arm), (-y, back - 0.002), (seat - 0.098, seat + 0.035), 0.04, cloth, piping(rng, scheme), 0.03)
    parts += pieces("back", upright_pad(rng, scheme, around(x - arm + 0.02), (back, y - 0.01), (seat - 0.098, h)), cloth)
    roll = 0.5 * arm + 0.012
    top = seat + 0.22 - roll
    brow = top + roll - 0.006  # where the wings begin
    side = np.array([(back - 0.2, brow), (back - 0.003, brow), (back - 0.003, h - 0.03), (back - 0.13, h - 0.03)])
    for s in (-1, 1):
        px, span = s * (x - 0.5 * arm), between(s * x, s * (x - arm + 0.004))
        parts += pieces("arms", cushion(span, (-y + 0.05, back - 0.004), (seat - 0.098, top - roll + 0.01), 0.03, 2), cloth)
        parts += pieces("arms", rod((px, -y + 0.035, top), (px, back - 0.006, top), roll, n=14), cloth)
        parts += pieces("wings", upright(side, between(s * (x - 0.005), s * (x - 0.06)), 0.018), cloth)
    return parts


def _office(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    w, d, h = size
    seat, r = min(0.5, 0.52 * h), 0.46 * min(w, d)
    base: list[Solid] = []
    wheels: list[Solid] = []
    for a in turns(5, math.pi / 2):
        out, across = np.array(polar(1.0, a, 0.0)), np.array([-math.sin(a), math.cos(a), 0.0])
        base.append(rod(0.034 * out + (0, 0, 0.10), r * out + (0, 0, 0.068), 0.022, 0.014, 8))
        for side in (-1, 1):
            hub = r * out + side * 0.013 * across + (0, 0, 0.026)
            wheels.append(rod(hub + 0.009 * across, hub - 0.009 * across, 0.026, n=12))
    base += revolve([(0.034, 0.06), (0.034, 0.13), (0.02, 0.14), (0.02, seat - 0.13)], 12)
    x, y = 0.46 * w, 0.44 * d
    parts = pieces("castors", wheels, PLASTIC) + pieces("star", base, scheme.handle)
    parts += pieces("plate", box((-0.09, 0.09), (-0.11, 0.11), (seat - 0.13, seat - 0.1), 0.004), PLASTIC)
    parts += seat_cushion(around(x - 0.03), (-y, y - 0.1), (seat - 0.1, seat), 0.035, scheme.soft, None, 0.018)
    rise = h - seat
    net = Finish("mesh_cloth", (0.05, 0.05, 0.055), 0.9, pattern="cane", density=300, second=(0.12, 0.12, 0.125))
    face = net if rng.random() < 0.5 else scheme.soft
    bow = curve([(y - 0.06, seat + 0.12), (y - 0.075, seat + 0.12 + 0.3 * (rise - 0.12)), (y - 0.03, h - 0.005)], 3)
    parts += pieces("back", sheet(bow, 0.03 if face is net else 0.055, np.linspace(0.9, 0.74, len(bow)) * 2 * (x - 0.03)), face)
    spine = [(0, 0.12, seat - 0.115), (0, y - 0.015, seat - 0.1), (0, y + 0.0, seat + 0.05), (0, y - 0.028, seat + 0.42 * rise)]
    parts += pieces("spine", tube(curve(spine, 2), 0.014, 8), PLASTIC)
    arms: list[Solid] = []
    for s in (-1, 1):
        px = s * (w / 2 - 0.03)
        arms.append(cushion(around(0.03, px), (-0.25 * d, 0.18 * d), (seat + 0.19, seat + 0.22), 0.012, 2))
        arms += tube([(s * 0.1, 0, seat - 0.115), (px, 0, seat - 0.115), (px, 0, seat + 0.19)], 0.012, 8)
    return parts + pieces("arms", arms, PLASTIC)


def _lounger(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    """Bent plywood shells with thick leather pads on a star foot."""
    w, d, h = size
    seat, x, y = min(0.4, 0.46 * h), w / 2, d / 2
    wood, rise = scheme.timber, h - seat
    under = curve([(-y + 0.02, seat - 0.062), (-0.3 * y, seat - 0.075), (0.3 * y, seat - 0.078), (0.44 * y, seat - 0.07)], 2)
    behind = curve([(0.50 * y, seat - 0.02), (0.50 * y + 0.4 * (0.5 * y - 0.03), seat + 0.4 * rise), (y - 0.03, h - 0.02)], 3)
    parts = pieces("shells", sheet(under, 0.014, 2 * x - 0.12) + sheet(behind, 0.014, 2 * x - 0.14), wood)
    span = (-y + 0.005, 0.5 * y - 0.108)
    parts += seat_cushion(around(x - 0.075), span, (seat - 0.05, seat + 0.065), 0.045, scheme.soft, piping(rng, scheme), 0.02)
    halves = ((seat - 0.02, seat + 0.53 * rise), (seat + 0.55 * rise, h))
    pads = [cushion(around(x - 0.085), (0.5 * y - 0.105, 0.5 * y - 0.015), z, 0.04, 3) for z in halves]
    parts += pieces("back_pads", lean(pads, seat - 0.02, (0.5 * y - 0.03) / rise), scheme.soft)
    for s in (-1, 1):
        px = s * (x - 0.035)
        parts += pieces("arms", cushion(around(0.035, px), (-0.5 * y, 0.3 * y), (seat + 0.16, seat + 0.21), 0.022, 2), scheme.soft)
        parts += pieces("arm_struts", box(around(0.008, px), (-0.12 * y, 0.1 * y), (seat - 0.05, seat + 0.16), 0.002), wood)
    star = [rod(polar(0.03, a, 0.06), polar(0.44 * min(w, d), a, 0.014), 0.018, 0.012, 8) for a in turns(5, math.pi / 2)]
    column = revolve([(0.03, 0.03), (0.03, 0.1), (0.024, 0.11), (0.024, seat - 0.12), (0.13, seat - 0.11), (0.13, seat - 0.095)], 16)
    return parts + pieces("foot", star + column, scheme.handle)


def _tub(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    """Build a round seat inside a wall that wraps it, sewn in channels or plain."""
    w, d, h = size
    seat, x, y = min(0.43, 0.52 * h), w / 2, d / 2
    low = 0.13
    kind = draw_kind(rng, scheme, "plank cross sled hairpin pipe horse")
    parts = pieces("legs", legs(kind, (0.62 * x, 0.66 * y), low, 0.04), leg_finish(scheme, kind))
    thick = 0.09 * min(1.0, w / 0.75)
    rx, ry = x - thick / 2, min(0.75 * d, max(x, 0.5 * d)) - thick / 2
    cy = y - thick / 2 - ry
    bow = np.concatenate([[(rx, -y + 0.06)], arc((0.0, cy), rx, 0.0, math.pi, 12, ry / rx), [(-rx, -y + 0.06)]])
    t = np.abs(np.linspace(-1, 1, len(bow)))
    height = np.interp(t, [0, 0.45, 1], [h, h, seat + 0.16 if h > seat + 0.2 else h])
    parts += pieces("wall", wall(bow, thick, low + 0.004, height, 0.04), scheme.soft)
    gap = thick / 2 + 0.004
    inner = arc((0.0, cy), rx - gap, 0.0, math.pi, 12, (ry - gap) / (rx - gap))
    end = inner[0, 0]
    edge = np.concatenate([inner, [(-end, -y + 0.03), (-end + 0.03, -y), (end - 0.03, -y), (end, -y + 0.03)]])
    centre = edge.mean(axis=0)
    levels = ((0.98, low), (1.0, low + 0.02), (1.0, seat - 0.05), (0.975, seat - 0.02), (0.88, seat), (0.5, seat + 0.02))
    rings = [np.column_stack([centre + (edge - centre) * f, np.full(len(edge), z)]) for f, z in levels]
    return parts + pieces("seat", stack(rings), scheme.soft if rng.random() < 0.7 else scheme.second)


def _rattan(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    """Build a round back of cane in a bent frame, a cushion on a woven seat."""
    w, d, h = size
    seat, x, y = min(0.4, 0.5 * h), w / 2, d / 2
    pole = Finish("rattan_pole", shade(rng, (0.42, 0.25, 0.10)), 0.6, pattern="grain", density=450)
    weave, r = cane(rng), 0.015
    bow = arc((0.0, -0.05 * d), x - 0.03, -0.06 * math.pi, 1.06 * math.pi, 12, (0.55 * d - 0.03) / (x - 0.03))
    height = np.interp(np.abs(np.linspace(-1, 1, 13)), [0, 0.5, 1], [h - r, h - 0.25 * (h - seat), seat + 0.2])
    ring = [np.array([math.cos(a) * (x - 0.045), math.sin(a) * (y - r)]) for a in turns(16)]
    parts = pieces("hoop", tube(np.column_stack([bow, height]), r, 8), pole)
    parts += pieces("seat_ring", tube(np.column_stack([ring, np.full(16, seat - 0.06)]), r, 8, closed=True), pole)
    parts += pieces("weave", wall(bow * 0.985, 0.012, seat - 0.04, height - r), weave)
    parts += pieces("seat_weave", slab(np.array(ring) * 0.93, (seat - 0.066, seat - 0.05)), weave)
    feet = [rod((s * 0.8 * x, t * 0.78 * y, 0), (s * 0.66 * x, t * 0.62 * y, seat - 0.066), 0.015, n=8) for s, t in corners(1, 1)]
    pad = revolve([(0.9, seat - 0.05), (1.0, seat - 0.03), (1.0, seat + 0.01), (0.92, seat + 0.035), (0.5, seat + 0.045)], 24)
    return parts + pieces("legs", feet, pole) + pieces("pad", [s.scaled(np.array([0.8 * x, 0.74 * y, 1])) for s in pad], scheme.soft)
