"""Sofas, corner sofas, chaises, bean bags, armchairs and lounge chairs. The front is -y. Lengths in metres."""

import math

import numpy as np

from pipeline.corpus.furniture.bent import arc, curve, lathe, lean, prism, sheet, tube, turns, wall
from pipeline.corpus.furniture.finishes import Finish, Finishes, Material, cane, one_of, tint
from pipeline.corpus.furniture.intervals import Interval, around, between, corners, edges, inset, polar, split
from pipeline.corpus.furniture.legs import draw_kind, leg, leg_finish, legs
from pipeline.corpus.furniture.shape import Piece, Pieces, pieces
from pipeline.corpus.furniture.solids import Solid, at_height, beam, box, cushion, revolve, rod, slab, stack
from pipeline.corpus.furniture.textiles import bolster, channels, piping, seat_cushion, throw_pillow, tufted_panel, upright_pad

ARMS = {"track": 0.13, "legs": 0.09, "roll": 0.2, "chesterfield": 0.2, "camelback": 0.17, "cloud": 0.22, "u_shape": 0.15}
LIFTS = {"track": 0.05, "legs": 0.15, "roll": 0.09, "chesterfield": 0.1, "camelback": 0.17, "cloud": 0.03, "u_shape": 0.06}
REST = (1.2, 1.45, 1.5, 1.4, 1.2)  # widths along a wooden arm, in those of its post


def easy_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a low chair with loose cushions in an open frame of wood."""
    seat, x, y = min(0.42, 0.48 * h), w / 2, d / 2
    arm = seat + 0.18
    t = 0.032 * finishes.style.slim
    wood = finishes.timber
    frame: list[Solid] = []
    sweep = curve([(-y + 0.005, arm - 0.012), (-0.2 * y, arm - 0.006), (0.78 * y, arm - 0.02)], 2)
    rest = sheet(sweep, 0.02, [0.046, 0.056, 0.052, 0.046, 0.04])
    for s in (-1, 1):
        px = s * (x - 0.024)
        frame += [beam((px, a, 0), (px, b, arm - 0.022), t, 1.2 * t) for a, b in ((-y + 0.03, -y + 0.05), (y - 0.03, y - 0.13))]
        frame += [q.translate((px, 0, 0)) for q in rest]
        frame.append(box(around(0.011, px), (-y + 0.07, y - 0.12), (seat - 0.18, seat - 0.125), 0.003))
    frame += [box(around(x - 0.04), around(0.011, a), (seat - 0.18, seat - 0.13), 0.003) for a in (-y + 0.09, y - 0.2)]
    slope, back = 0.28, y - 0.14 - 0.28 * (h - seat) * 0.6
    wide, top = around(x - 0.045), h - 0.012
    parts = pieces("frame", frame, wood)
    parts += seat_cushion(wide, (-y + 0.01, back - 0.055), (seat - 0.125, seat + 0.02), 0.04, finishes.soft, piping(rng, finishes), 0.025)
    pad = upright_pad(rng, finishes, wide, around(0.05, back), (seat - 0.1, top))
    parts += pieces("back_pad", lean(pad, seat - 0.1, slope), finishes.soft)
    xs = np.linspace(*inset(wide, 0.03), 5)
    laths = [box(around(0.013, px), (back + 0.052, back + 0.068), (seat - 0.17, top - 0.06), 0.002) for px in xs]
    return parts + pieces("laths", lean(laths, seat - 0.1, slope), wood)


def wing_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a chair with wings beside its high back, and rolled arms."""
    seat, x, y = min(0.44, 0.46 * h), w / 2, d / 2
    kind = draw_kind(rng, finishes, "plank cross sled hairpin pipe blade horse")
    low, cloth = 0.17, finishes.soft
    parts = pieces("legs", legs(kind, (x - 0.07, y - 0.08), low, 0.042), leg_finish(finishes, kind))
    parts += pieces("body", cushion(around(x - 0.03), around(y - 0.02), (low, seat - 0.1), 0.025, 2), cloth)
    arm, back = 0.13 * min(1.0, w / 0.75), y - 0.15
    parts += seat_cushion(around(x - arm), (-y, back - 0.002), (seat - 0.098, seat + 0.035), 0.04, cloth, piping(rng, finishes), 0.03)
    parts += pieces("back", upright_pad(rng, finishes, around(x - arm + 0.02), (back, y - 0.01), (seat - 0.098, h)), cloth)
    roll = 0.5 * arm + 0.012
    top = seat + 0.22 - roll
    brow = top + roll - 0.006  # where the wings begin
    side = np.array([(back - 0.2, brow), (back - 0.003, brow), (back - 0.003, h - 0.03), (back - 0.13, h - 0.03)])
    for s in (-1, 1):
        px, span = s * (x - 0.5 * arm), between(s * x, s * (x - arm + 0.004))
        parts += pieces("arms", cushion(span, (-y + 0.05, back - 0.004), (seat - 0.098, top - roll + 0.01), 0.03, 2), cloth)
        parts += pieces("arms", rod((px, -y + 0.035, top), (px, back - 0.006, top), roll, n=14), cloth)
        parts += pieces("wings", prism(side, "x", between(s * (x - 0.005), s * (x - 0.06)), 0.018), cloth)
    return parts


def office_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a chair that turns on a star of five castors."""
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
    parts = pieces("castors", wheels, "plastic") + pieces("star", base, finishes.handle)
    parts += pieces("plate", box((-0.09, 0.09), (-0.11, 0.11), (seat - 0.13, seat - 0.1), 0.004), "plastic")
    parts += seat_cushion(around(x - 0.03), (-y, y - 0.1), (seat - 0.1, seat), 0.035, finishes.soft, None, 0.018)
    rise = h - seat
    face: Material = "mesh_cloth" if rng.random() < 0.5 else finishes.soft
    bow = curve([(y - 0.06, seat + 0.12), (y - 0.075, seat + 0.12 + 0.3 * (rise - 0.12)), (y - 0.03, h - 0.005)], 3)
    parts += pieces("back", sheet(bow, 0.03 if face == "mesh_cloth" else 0.055, np.linspace(0.9, 0.74, len(bow)) * 2 * (x - 0.03)), face)
    spine = [(0, 0.12, seat - 0.115), (0, y - 0.015, seat - 0.1), (0, y + 0.0, seat + 0.05), (0, y - 0.028, seat + 0.42 * rise)]
    parts += pieces("spine", tube(curve(spine, 2), 0.014, 8), "plastic")
    arms: list[Solid] = []
    for s in (-1, 1):
        px = s * (w / 2 - 0.03)
        arms.append(cushion(around(0.03, px), (-0.25 * d, 0.18 * d), (seat + 0.19, seat + 0.22), 0.012, 2))
        arms += tube([(s * 0.1, 0, seat - 0.115), (px, 0, seat - 0.115), (px, 0, seat + 0.19)], 0.012, 8)
    return parts + pieces("arms", arms, "plastic")


def lounger(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Bent plywood shells with thick leather pads on a star foot."""
    seat, x, y = min(0.4, 0.46 * h), w / 2, d / 2
    wood, rise = finishes.timber, h - seat
    under = curve([(-y + 0.02, seat - 0.062), (-0.3 * y, seat - 0.075), (0.3 * y, seat - 0.078), (0.44 * y, seat - 0.07)], 2)
    behind = curve([(0.50 * y, seat - 0.02), (0.50 * y + 0.4 * (0.5 * y - 0.03), seat + 0.4 * rise), (y - 0.03, h - 0.02)], 3)
    parts = pieces("shells", sheet(under, 0.014, 2 * x - 0.12) + sheet(behind, 0.014, 2 * x - 0.14), wood)
    span = (-y + 0.005, 0.5 * y - 0.108)
    parts += seat_cushion(around(x - 0.075), span, (seat - 0.05, seat + 0.065), 0.045, finishes.soft, piping(rng, finishes), 0.02)
    halves = ((seat - 0.02, seat + 0.53 * rise), (seat + 0.55 * rise, h))
    pads = [cushion(around(x - 0.085), (0.5 * y - 0.105, 0.5 * y - 0.015), z, 0.04, 3) for z in halves]
    parts += pieces("back_pads", lean(pads, seat - 0.02, (0.5 * y - 0.03) / rise), finishes.soft)
    for s in (-1, 1):
        px = s * (x - 0.035)
        parts += pieces("arms", cushion(around(0.035, px), (-0.5 * y, 0.3 * y), (seat + 0.16, seat + 0.21), 0.022, 2), finishes.soft)
        parts += pieces("arm_struts", box(around(0.008, px), (-0.12 * y, 0.1 * y), (seat - 0.05, seat + 0.16), 0.002), wood)
    star = [rod(polar(0.03, a, 0.06), polar(0.44 * min(w, d), a, 0.014), 0.018, 0.012, 8) for a in turns(5, math.pi / 2)]
    column = revolve([(0.03, 0.03), (0.03, 0.1), (0.024, 0.11), (0.024, seat - 0.12), (0.13, seat - 0.11), (0.13, seat - 0.095)], 16)
    return parts + pieces("foot", star + column, finishes.handle)


def tub_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a round seat inside a wall that wraps it, sewn in channels or plain."""
    seat, x, y = min(0.43, 0.52 * h), w / 2, d / 2
    low = 0.13
    kind = draw_kind(rng, finishes, "plank cross sled hairpin pipe horse")
    parts = pieces("legs", legs(kind, (0.62 * x, 0.66 * y), low, 0.04), leg_finish(finishes, kind))
    thick = 0.09 * min(1.0, w / 0.75)
    rx, ry = x - thick / 2, min(0.75 * d, max(x, 0.5 * d)) - thick / 2
    cy = y - thick / 2 - ry
    bow = np.concatenate([[(rx, -y + 0.06)], arc((0.0, cy), rx, 0.0, math.pi, 12, ry / rx), [(-rx, -y + 0.06)]])
    t = np.abs(np.linspace(-1, 1, len(bow)))
    height = np.interp(t, [0, 0.45, 1], [h, h, seat + 0.16 if h > seat + 0.2 else h])
    parts += pieces("wall", wall(bow, thick, low + 0.004, height, 0.04), finishes.soft)
    gap = thick / 2 + 0.004
    inner = arc((0.0, cy), rx - gap, 0.0, math.pi, 12, (ry - gap) / (rx - gap))
    end = inner[0, 0]
    edge = np.concatenate([inner, [(-end, -y + 0.03), (-end + 0.03, -y), (end - 0.03, -y), (end, -y + 0.03)]])
    centre = edge.mean(axis=0)
    levels = ((0.98, low), (1.0, low + 0.02), (1.0, seat - 0.05), (0.975, seat - 0.02), (0.88, seat), (0.5, seat + 0.02))
    rings = [at_height(centre + (edge - centre) * f, z) for f, z in levels]
    return parts + pieces("seat", stack(rings), finishes.soft if rng.random() < 0.7 else finishes.second)


def rattan_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a chair of poles and woven cane, its back and arms one hoop."""
    """Build a round back of cane in a bent frame, a cushion on a woven seat."""
    seat, x, y = min(0.4, 0.5 * h), w / 2, d / 2
    pole = Finish("rattan_pole", tint(rng, (0.42, 0.25, 0.10)), 0.6, pattern="grain", density=450)
    weave, r = cane(rng), 0.015
    bow = arc((0.0, -0.05 * d), x - 0.03, -0.06 * math.pi, 1.06 * math.pi, 12, (0.55 * d - 0.03) / (x - 0.03))
    height = np.interp(np.abs(np.linspace(-1, 1, 13)), [0, 0.5, 1], [h - r, h - 0.25 * (h - seat), seat + 0.2])
    ring = [np.array([math.cos(a) * (x - 0.045), math.sin(a) * (y - r)]) for a in turns(16)]
    parts = pieces("hoop", tube(np.column_stack([bow, height]), r, 8), pole)
    parts += pieces("seat_ring", tube(at_height(np.array(ring), seat - 0.06), r, 8, closed=True), pole)
    parts += pieces("weave", wall(bow * 0.985, 0.012, seat - 0.04, height - r), weave)
    parts += pieces("seat_weave", slab(np.array(ring) * 0.93, (seat - 0.066, seat - 0.05)), weave)
    feet = [rod((s * 0.8 * x, t * 0.78 * y, 0), (s * 0.66 * x, t * 0.62 * y, seat - 0.066), 0.015, n=8) for s, t in corners(1, 1)]
    pad = revolve([(0.9, seat - 0.05), (1.0, seat - 0.03), (1.0, seat + 0.01), (0.92, seat + 0.035), (0.5, seat + 0.045)], 24)
    return parts + pieces("legs", feet, pole) + pieces("pad", [s.scale(np.array([0.8 * x, 0.74 * y, 1])) for s in pad], finishes.soft)


def sofa(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a sofa: square, slim or rolled arms, a buttoned Chesterfield, a camel's back, a low cloud, or curved ends."""
    seats = max(1, round((w - 0.4) / (0.72 if form != "cloud" else 0.95)))
    seat = float(rng.uniform(0.40, 0.44)) * min(1.0, h / 0.78) * (0.92 if form == "cloud" else 1.0)
    arm, lift = ARMS[form] * min(1.0, w / 0.85), LIFTS[form]
    deep = min(0.2, 0.22 * d)
    front = -d / 2 + (0.28 * d if form == "u_shape" and w > 2.2 else 0.0)
    parts = feet(rng, finishes, around(w / 2), around(d / 2), lift, form)
    base_top = seat - 0.14
    side = arm if form == "track" else 0.012
    parts += pieces("frame", cushion(around(w / 2 - side), (front + 0.03, d / 2 - 0.008), (lift, base_top), 0.018, 2), finishes.soft)
    inner = around(w / 2 - arm)
    for lo, hi in edges(inner, min(0.75, 0.28 * w)) if front > -d / 2 else ():  # seats that come forward at both ends
        end = cushion((lo + 0.005, hi - 0.002), (-d / 2 + 0.02, front + 0.028), (lift, base_top), 0.018, 2)
        parts += pieces("frame_end", end, finishes.soft)
        span = inset((lo, hi), 0.003)
        parts += seat_cushion(span, (-d / 2, front - 0.003), (base_top, seat + 0.022), 0.05, finishes.soft, None, 0.025)
    top = min(h - 0.04, seat + 0.2) if form != "chesterfield" else h - 0.08
    rolled = form in ("roll", "chesterfield", "camelback")
    face = d / 2 - 0.62 * deep
    rear = face - 0.002 if rolled else d / 2 - 0.012
    parts += _arms(form, w, (-d / 2 + 0.012, rear), (base_top if form != "track" else lift + 0.004, top), arm, lift, finishes)
    parts += _back(rng, form, around(w / 2 - 0.04) if rolled else inner, (face, d / 2), (base_top, h), finishes)
    if form in ("chesterfield", "camelback"):
        for x in split(inner, seats, 0.001):
            parts += seat_cushion(x, (front, face - 0.002), (base_top, seat + 0.03), 0.04, finishes.soft, piping(rng, finishes), 0.03)
        return parts
    parts += _cushions(rng, inner, (front, face), (base_top, seat), h, seats, deep, finishes)
    if w > 1.2:
        parts += _pillows(rng, w / 2 - arm, d / 2 - 1.75 * deep, (seat + 0.022, h), finishes)
    return parts


def feet(rng: np.random.Generator, finishes: Finishes, x: Interval, y: Interval, lift: float, form: str) -> Pieces:
    """Return feet under a frame: the style's legs where there is room for them, else blocks."""
    kind = "bun" if finishes.style.ornament > 0.5 or form == "chesterfield" else "square"
    if form in ("legs", "camelback"):
        kind = draw_kind(rng, finishes, "plank cross sled hairpin pipe")
    half = ((x[1] - x[0]) / 2 - 0.08, (y[1] - y[0]) / 2 - 0.08)
    solids = legs(kind, half, lift, 0.045)
    if x[1] - x[0] > 1.9 and form != "u_shape":
        solids += [s for sy in (-1, 1) for s in leg(kind, (0.0, sy * half[1]), (1, sy), lift, 0.045)]
    middle = (x[0] + x[1]) / 2, (y[0] + y[1]) / 2, 0
    return pieces("feet", [s.translate(middle) for s in solids], leg_finish(finishes, kind))


def _arms(form: str, w: float, y: Interval, z: Interval, arm: float, lift: float, finishes: Finishes) -> Pieces:
    """Return both arms; z from the frame's top (or the floor's lift) to the arm's top."""
    solids: list[Solid] = []
    for s, (lo, hi) in zip((-1, 1), edges(around(w / 2), arm), strict=True):
        if form in ("roll", "chesterfield", "camelback"):
            r = 0.5 * arm * (0.95 if form != "camelback" else 0.8)
            core, x, top = 0.16 * arm, (lo + hi) / 2, z[1] - r
            solids.append(cushion((lo + core * (s > 0), hi - core * (s < 0)), (y[0] + 0.02, y[1]), (z[0], z[1] - 2 * r + 0.012), 0.02, 2))
            solids.append(rod((x, y[0] + 0.004, top), (x, y[1], top), r, n=16))
            solids.append(rod((x, y[0] - 0.004, top), (x, y[0] + 0.004, top), 0.55 * r, 0.62 * r, n=14))
        elif form == "cloud":
            solids.append(cushion((lo, hi), y, z, 0.1, 4))
        else:
            low = lift + 0.004 if form == "track" else z[0]
            solids.append(cushion((lo, hi), y, (low, z[1]), min(finishes.style.soft, 0.4 * arm), 3))
    return pieces("arms", solids, finishes.soft)


def _back(rng: np.random.Generator, form: str, x: Interval, y: Interval, z: Interval, finishes: Finishes) -> Pieces:
    """Return the back behind the cushions; a Chesterfield's is buttoned and rolled, a camel's back is arched."""
    low, h = z
    if form == "chesterfield":
        r = 0.09
        pads = tufted_panel(x, (y[0], y[1] - 0.02), (low, h - 2 * r + 0.01), max(3, round((x[1] - x[0]) / 0.17)), 2)
        inset = ARMS[form] * min(1.0, (x[1] - x[0] + 0.08) / 0.85) - 0.038  # the roll runs between the arms
        roll = rod((x[0] + inset, y[1] - r, h - r), (x[1] - inset, y[1] - r, h - r), r, n=16)
        return pieces("back", pads, finishes.soft) + pieces("roll", roll, finishes.soft)
    if form == "camelback":
        t = np.linspace(-1, 1, 13)
        path = np.column_stack([x[0] + (x[1] - x[0]) * (t + 1) / 2, np.full(13, (y[0] + y[1]) / 2)])
        return pieces("back", wall(path, y[1] - y[0], low, h - 0.2 * (h - low) * (1 - np.cos(t * math.pi)) / 2, 0.05), finishes.soft)
    if form == "cloud":
        return pieces("back", cushion(x, y, (low, h - 0.06), 0.05, 3), finishes.soft)
    if form == "legs" and rng.random() < 0.25 + 0.4 * finishes.style.tufts:
        return pieces("back", channels(x, y, (low, h - 0.03), max(4, round((x[1] - x[0]) / 0.11))), finishes.soft)
    return pieces("back", cushion((x[0], x[1]), y, (low, h - 0.04), 0.04, 3), finishes.soft)


def _cushions(
    rng: np.random.Generator, x: Interval, y: Interval, z: Interval, h: float, seats: int, deep: float, finishes: Finishes
) -> Pieces:
    """Return seat and back cushions, one of each per seat (sometimes one long seat); y from the front to the back's face."""
    low, seat = z
    cord = piping(rng, finishes)
    parts: Pieces = ()
    long = seats > 1 and rng.random() < 0.25
    for span in split(x, 1 if long else seats, 0.003):
        parts += seat_cushion(span, (y[0], y[1] - 0.003), (low, seat + 0.022), finishes.style.soft, finishes.soft, cord, 0.028)
    slope, backs = 0.16, []
    at = y[1] - slope * (h - seat) - 0.004
    for span in split(x, seats, 0.005):
        tall = h - float(rng.uniform(0.0, 0.025))
        backs.append(cushion(span, (at - 0.75 * deep, at), (seat + 0.024, tall), min(0.06, 0.36 * deep), 3))
    return parts + pieces("back_cushions", lean(backs, seat + 0.024, slope), finishes.soft)


def _pillows(rng: np.random.Generator, x: float, y: float, z: Interval, finishes: Finishes) -> Pieces:
    pillows = []
    for s in one_of(rng, ([-1, 1], [-1], [1])):
        size = min(float(rng.uniform(0.38, 0.46)), z[1] - z[0])
        pillows.append(throw_pillow((s * (x - 0.27), y - 0.12, z[0]), size, 0.32, -0.25 * s))
    return pieces("pillows", pillows, finishes.second)


def frame_sofa(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Loose cushions in an open frame of wood with laths behind them."""
    x, y = w / 2, d / 2
    seat = 0.42 * min(1.0, h / 0.78)
    t = 0.045 * finishes.style.slim
    wood = finishes.timber
    arm, low = seat + 0.18, seat - 0.16
    solids: list[Solid] = []
    rest = sheet(curve([(-y + 0.004, arm - 0.014), (0.0, arm - 0.008), (y - 0.01, arm - 0.02)], 2), 0.024, np.array(REST) * t)
    for s in (-1, 1):
        px = s * (x - 0.5 * t - 0.006)
        solids += [beam((px, a, 0), (px, b, arm - 0.025), t, t) for a, b in ((-y + 0.04, -y + 0.05), (y - 0.03, y - 0.06))]
        solids += [q.translate((px - s * 0.006, 0, 0)) for q in rest]
    inner = around(x - t - 0.012)
    solids += [box(inner, (a, a + 0.026), (low - 0.06, low), 0.004) for a in (-y + 0.03, y - 0.17)]
    xs = np.linspace(*inset(inner, 0.1), max(2, round(w / 0.5)))
    solids += [box(around(0.012, px), (-y + 0.056, y - 0.17), (low - 0.05, low - 0.02), 0.002) for px in xs]
    slope = 0.2
    back = y - 0.04 - slope * (h - seat)
    span = inner[1] - inner[0]
    laths = [box(inner, (back, back + 0.022), (z, z + 0.045), 0.004) for z in (seat - 0.02, h - 0.06)]
    xs = np.linspace(*inset(inner, 0.03), max(4, round(span / 0.16)))
    laths += [box(around(0.011, px), (back + 0.005, back + 0.018), (seat + 0.025, h - 0.06), 0.002) for px in xs]
    parts = pieces("frame", solids, wood) + pieces("laths", lean(laths, seat - 0.02, slope), wood)
    seats = max(1, round(span / 0.65))
    cord = piping(rng, finishes)
    for place in split(inner, seats, 0.003):
        parts += seat_cushion(place, (-y, back - 0.105), (low, seat), finishes.style.soft, finishes.soft, cord, 0.02)
    pads = [cushion(place, (back - 0.1, back - 0.003), (seat - 0.02, h - 0.002), 0.035, 3) for place in split(inner, seats, 0.005)]
    return parts + pieces("back_cushions", lean(pads, seat - 0.02, slope), finishes.soft)


def l_shaped_sofa(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a sofa along the back and a chaise that reaches forward at one end (`form`: left or right, seen from the front)."""
    style = one_of(rng, ("track", "legs", "cloud"))
    lift, arm, deep = LIFTS[style], ARMS[style] * 1.1, 0.2
    seat = 0.43 * min(1.0, h / 0.78)
    top = seat - 0.14
    long = min(1.0, 0.36 * w)
    y0 = d / 2 - min(0.98, 0.55 * d)  # front of the main part
    x, cx = around(w / 2), (-w / 2, -w / 2 + long)
    parts = feet(rng, finishes, x, (y0, d / 2), lift, style) + feet(rng, finishes, cx, (-d / 2, y0 - 0.1), lift, style)
    parts += pieces("frame", cushion(inset(x, 0.012), (y0 + 0.03, d / 2 - 0.008), (lift, top), 0.018, 2), finishes.soft)
    chaise = cushion((cx[0] + 0.012, cx[1] - 0.01), (-d / 2 + 0.02, y0 + 0.028), (lift, top), 0.018, 2)
    parts += pieces("frame_chaise", chaise, finishes.soft)
    face = d / 2 - 0.62 * deep
    parts += _back(rng, style, inset(x, arm), (face, d / 2), (top, h), finishes)
    radius = 0.1 if style == "cloud" else min(finishes.style.soft, 0.4 * arm)
    sides = [cushion(span, (y0 + 0.012, d / 2 - 0.012), (top, seat + 0.2), radius, 3) for span in edges(x, arm)[::-1]]
    parts += pieces("arms", sides, finishes.soft)
    seats = max(1, round((w - long - arm) / 0.75))
    parts += _cushions(rng, (cx[1], w / 2 - arm), (y0, face), (top, seat), h, seats, deep, finishes)
    cord = piping(rng, finishes)
    for left, front, rear in ((cx[0] + arm + 0.003, y0, face - 0.003), (cx[0], -d / 2, y0 - 0.003)):
        parts += seat_cushion((left, cx[1] - 0.003), (front, rear), (top, seat + 0.022), finishes.style.soft, finishes.soft, cord, 0.025)
    slope = 0.16
    at = face - slope * (h - seat) - 0.004
    pad = cushion((cx[0] + arm + 0.005, cx[1] - 0.005), (at - 0.75 * deep, at), (seat + 0.024, h - 0.01), 0.06, 3)
    parts += pieces("chaise_back", lean([pad], seat + 0.024, slope), finishes.soft)
    parts += _pillows(rng, w / 2 - arm, d / 2 - 1.75 * deep, (seat + 0.022, h), finishes)
    if form == "right":
        parts = tuple(Piece(p.name, p.solid.mirror(), p.finish, p.part) for p in parts)
    return parts


def lazy_sofa(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bean bag in the shape of a drop, or a soft block seat with a rolled back."""
    x, y = w / 2, d / 2
    if form == "bean":
        return pieces("bag", lean(lathe("bean_bag", x, h, 26, squash=y / x), 0.0, 0.22), finishes.soft)
    seat = min(0.38, 0.52 * h)
    parts = pieces("body", cushion((-x, x), (-y, y), (0, seat), 0.11, 4, 0.03), finishes.soft)
    parts += pieces("back", cushion((-x, x), (y - 0.3 * d, y), (seat - 0.012, h), 0.12, 4), finishes.soft)
    return parts + pieces("bolster", bolster(around(0.8 * x), y - 0.3 * d - 0.075, seat + 0.05, 0.075), finishes.second)


def chaise_longue(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a long seat with a raised back and one arm, or a scrolled recamier."""
    x, y = w / 2, d / 2
    seat = 0.42 * min(1.0, h / 0.8)
    kind = draw_kind(rng, finishes, "plank cross sled hairpin")
    parts = pieces("legs", legs(kind, (x - 0.06, y - 0.08), 0.15, 0.045), leg_finish(finishes, kind))
    parts += pieces("frame", cushion(around(x - 0.008), around(y - 0.015), (0.15, seat - 0.13), 0.02, 2), finishes.soft)
    z, cord = (seat - 0.13, seat + 0.022), piping(rng, finishes)
    parts += seat_cushion((-x, x), (-y, y - 0.17), z, finishes.style.soft, finishes.soft, cord, 0.025)
    if form == "recamier":
        pad = tufted_panel((-x, x), (y - 0.17, y - 0.06), (seat - 0.13, h - 0.16), max(2, round(w / 0.18)), 3)
        parts += pieces("back", pad, finishes.soft) + pieces("scroll", bolster((-x, x), y - 0.085, h - 0.085, 0.085), finishes.soft)
        return parts + pieces("bolster", bolster(around(0.75 * x), y - 0.255, seat + 0.105, 0.08), finishes.second)
    parts += pieces("back", cushion((-x, x), (y - 0.165, y), (seat - 0.13, h), 0.06, 3), finishes.soft)
    s = -1 if rng.random() < 0.5 else 1
    lo, hi = (x - 0.11, x) if s > 0 else (-x, -x + 0.11)
    parts += pieces("arm", cushion((lo, hi), (0.05 * y, y - 0.168), (seat + 0.024, seat + 0.24), 0.04, 3), finishes.soft)
    at = (-0.75 * x, x - 0.125) if s > 0 else (-x + 0.125, 0.75 * x)
    return parts + pieces("bolster", bolster(at, y - 0.168 - 0.085, seat + 0.107, 0.08), finishes.second)
