"""Chairs with their backs, stools, benches, ottomans and poufs. The front is -y. Lengths in metres."""

import math
from dataclasses import dataclass, replace

import numpy as np

from pipeline.corpus.furniture.bent import arc, curve, lathe, lean, prism, sheet, tube, turns, wall
from pipeline.corpus.furniture.finishes import Finish, Finishes, Material, cane, one_of
from pipeline.corpus.furniture.intervals import around, between, corners, polar, split
from pipeline.corpus.furniture.legs import METAL, draw_kind, inside, leg_finish, legs
from pipeline.corpus.furniture.shape import Pieces, pieces
from pipeline.corpus.furniture.solids import Solid, at_height, beam, board, box, circle, cushion, revolve, rod, slab, stand_up
from pipeline.corpus.furniture.textiles import piping, seat_cushion, tufted_panel, upright_pad

TUBE = 0.011  # radius of bent steel
# Backs of nothing but rails: shares of the height from and to which each reaches, and how deep it is in thicknesses of the posts.
RAILS = {"ladder": [(a, a + 0.11, 0.55) for a in (0.14, 0.38, 0.62)], "panel": [(0.28, 0.8, 0.5)], "cane": [(0.2, 0.3, 0.8)]}


@dataclass(frozen=True, slots=True)
class Frame:
    """Where a back goes: half width `x`, its plane `y`, from `low` (the seat) up to `high`, leaning back by `slope` per height."""

    x: float
    y: float
    low: float
    high: float
    slope: float
    thick: float
    wood: Material

    def bar(self, a: float, b: float, inset: float, deep: float = 0.8) -> Solid:
        """Return a rail across between shares `a` and `b` of the height, `inset` from either side."""
        rise = self.high - self.low
        half = deep * self.thick / 2
        return box(around(self.x - inset), around(half, self.y), (self.low + a * rise, self.low + b * rise), 0.003)


def back(rng: np.random.Generator, kind: str, frame: Frame, finishes: Finishes) -> Pieces:
    """Return a back of one kind: slat, ladder, panel, splat, spindle, cane, cross, pad."""
    t, rise = frame.thick, frame.high - frame.low
    if kind == "pad":
        pad = upright_pad(rng, finishes, around(frame.x), (frame.y - 0.035, frame.y + 0.03), (frame.low + 0.08 * rise, frame.high))
        return pieces("back_pad", lean(pad, frame.low, frame.slope), finishes.soft)
    ends = [((x, frame.y, frame.low), (x, frame.y, frame.high)) for x in around(frame.x - t / 2)]
    turned = kind in ("spindle", "ladder") and finishes.style.ornament > 0.3
    wood = [rod(*span, 0.5 * t, 0.4 * t, 8) if turned else beam(*span, 0.86 * t, 0.86 * t, 1.15) for span in ends]
    wood.append(frame.bar(0.86, 1.0, t))
    if kind in RAILS:
        wood += [frame.bar(low, high, t, deep) for low, high, deep in RAILS[kind]]
    else:
        wood += {"slat": _slats, "splat": _splat, "spindle": _spindles, "cross": _cross}[kind](frame)
    parts = pieces("back", lean(wood, frame.low, frame.slope), frame.wood)
    if kind == "cane":
        sheet = box(around(frame.x - t), around(0.004, frame.y), (frame.low + 0.3 * rise, frame.low + 0.86 * rise))
        parts += pieces("cane", lean([sheet], frame.low, frame.slope), cane(rng))
    return parts


def _slats(frame: Frame) -> list[Solid]:
    rise, t = frame.high - frame.low, frame.thick
    count = max(3, round(2 * frame.x / 0.1))
    xs = np.linspace(-frame.x + 2.2 * t, frame.x - 2.2 * t, count)
    low, high = frame.low + 0.24 * rise, frame.low + 0.86 * rise
    return [frame.bar(0.16, 0.24, t), *(box(around(0.016, x), around(0.006, frame.y), (low, high), 0.002) for x in xs)]


def _splat(frame: Frame) -> list[Solid]:
    """Build a board down the middle, waisted: two trapezoids with a round between them."""
    rise = frame.high - frame.low
    low, high, middle = frame.low + 0.04 * rise, frame.low + 0.86 * rise, frame.low + 0.45 * rise
    wide = 0.42 * frame.x
    span = around(0.006, frame.y)
    under = np.array([(-0.75 * wide, low), (0.75 * wide, low), (0.42 * wide, middle), (-0.42 * wide, middle)])
    over = np.array([(-0.42 * wide, middle), (0.42 * wide, middle), (wide, high), (-wide, high)])
    return [prism(under, "y", span), prism(over, "y", span)]


def _spindles(frame: Frame) -> list[Solid]:
    rise, t = frame.high - frame.low, frame.thick
    count = max(5, round(2 * frame.x / 0.075))
    xs = np.linspace(-frame.x + 1.9 * t, frame.x - 1.9 * t, count)
    return [rod((x, frame.y, frame.low), (x, frame.y, frame.low + 0.86 * rise), 0.0075, 0.006, 6) for x in xs]


def _cross(frame: Frame) -> list[Solid]:
    """Two bars that cross behind each other, as on a bistro chair."""
    rise, t = frame.high - frame.low, frame.thick
    x, z = frame.x - 1.1 * t, (frame.low + 0.12 * rise, frame.low + 0.86 * rise)
    bars = [frame.bar(0.06, 0.12, t, 0.5)]
    for s, dy in ((-1, -0.009), (1, 0.009)):
        bars.append(rod((-s * x, frame.y + dy, z[0]), (s * x, frame.y + dy, z[1]), 0.009, n=8))
    return bars


def dining_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a chair of four legs and a back: of wood, upholstered, with spindles, or of a cafe."""
    seat = min(0.47, 0.56 * h)
    x, y = w / 2, d / 2
    thick = 0.034 * finishes.style.slim
    without = "plank cross hairpin block bun sled pipe" if form != "cafe" else "plank cross block bun"
    kind = "ming" if finishes.tradition == "oriental" else draw_kind(rng, finishes, without)
    wood = leg_finish(finishes, kind)
    rise = 0.12 * (h - seat)
    back_y = y - rise - 0.5 * thick
    top = 0.05 if form != "wood" else 0.026
    rail = 0.045
    under = seat - top - rail
    half = inside(kind, (x, (back_y + y) / 2 + 0.3 * thick), under, thick)
    middle = (back_y - y) / 2 + 0.3 * thick
    parts = pieces("legs", [s.translate((0, middle, 0)) for s in legs(kind, half, under, thick)], wood)
    parts += pieces("rail", board(around(x - 0.012), (-y + 0.016, back_y + 0.5 * thick), (under, under + rail), 0.02, 2, 0.004), wood)
    span_x, span_y = (-x, x), (-y, back_y - 0.55 * thick)
    if form == "wood":
        parts += pieces("seat", board(span_x, span_y, (seat - top, seat), 0.05, 3, finishes.style.edge), finishes.body)
    elif finishes.style.cane > 0.3 and rng.random() < finishes.style.cane:
        parts += pieces("seat", board(span_x, span_y, (seat - top, seat - 0.01), 0.05, 3, 0.006), cane(rng))
    else:
        parts += seat_cushion(span_x, span_y, (seat - top, seat + 0.02), 0.04, finishes.soft, piping(rng, finishes), 0.018)
    frame = Frame(x - 0.012, back_y, under + rail, h, rise / (h - seat), thick, wood)
    kinds = {"wood": "slat ladder panel cane", "upholstered": "pad", "spindle": "spindle", "cafe": "cross"}[form]
    if form == "wood" and finishes.tradition:
        kinds = "splat" if finishes.tradition == "oriental" else "splat ladder"
    choice = one_of(rng, kinds.split())
    if choice == "pad":
        foot, head = (back_y, under + rail), (back_y, seat - 0.021 + 0.08 * (h - seat + 0.02))
        short = [beam((s * 0.62 * x, *foot), (s * 0.62 * x, *head), 0.03, 0.022) for s in (-1, 1)]
        parts += pieces("posts", lean(short, under + rail, frame.slope), wood)
        frame = replace(frame, low=seat - 0.02)
    parts += back(rng, choice, frame, finishes)
    if kind in ("square", "ming", "turned") and rng.random() < 0.55:
        z, span = 0.36 * under, (middle - half[1] + 0.5 * thick, middle + half[1] - 0.5 * thick)
        parts += pieces("stretchers", [box(around(0.009, s * half[0]), span, (z, z + 0.026), 0.002) for s in (-1, 1)], wood)
    return parts


def shell_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bent shell of plywood, plastic or cloth on four legs, a wire base, or a swivel foot."""
    seat, x, y = min(0.46, 0.55 * h), w / 2, d / 2
    soft = rng.random() < 0.45
    finish = finishes.soft if soft else finishes.front
    thick = 0.035 if soft else 0.013
    front = [(-y + thick, seat - 0.02), (-0.72 * y, seat), (0.1 * y, seat - 0.025)]
    path = curve([*front, (0.52 * y, seat + 0.01), (0.74 * y, seat + 0.3 * (h - seat)), (y - 0.02, h)], 3)
    narrow = 1 - 0.13 * np.abs(np.linspace(-1, 1, len(path))) ** 3  # towards both ends
    parts = pieces("shell", sheet(path, thick, 2 * x * narrow), finish)
    if soft or rng.random() < 0.3:  # low sides that hold the sitter
        tall = (seat + 0.025, seat + 0.42 * (h - seat))
        wings = [cushion(between(s * x, s * (x - 0.03)), (-0.25 * y, 0.6 * y), tall, 0.014, 2) for s in (-1, 1)]
        parts += pieces("arms", wings, finish)
    if not soft and rng.random() < 0.4:
        parts += seat_cushion(around(0.8 * x), (-0.7 * y, 0.4 * y), (seat + 0.008, seat + 0.04), 0.015, finishes.soft, None, 0.006)
    top = seat - 0.06
    base = int(rng.integers(3))
    if base == 0:
        column = revolve([(0.42 * w, 0.0), (0.42 * w, 0.01), (0.03, 0.03), (0.022, top - 0.02), (0.12, top - 0.012), (0.12, top)], 20)
        return parts + pieces("foot", column, finishes.handle)
    kind, thick, finish = ("splayed", 0.036, finishes.timber) if base == 1 else ("dowel", 0.026, finishes.handle)
    feet = legs(kind, (0.3 * w, 0.3 * d), top - 0.012, thick)
    plate = board(around(0.34 * w), around(0.34 * d), (top - 0.012, top), 0.03, 2, 0.002)
    return parts + pieces("legs", feet, finish) + pieces("plate", plate, finishes.handle)


def wishbone_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a round crest that becomes the arms, on posts, with a forked splat and a woven seat."""
    seat, x, y, wood = min(0.45, 0.55 * h), w / 2, d / 2, finishes.timber
    r = 0.016
    bow = arc((0.0, 0.0), x - 0.018, 0.0, math.pi, 10, (y - 0.02) / (x - 0.018))
    path = np.column_stack([bow, np.interp(np.abs(bow[:, 0]), [0, x], [h - r, h - 0.1 * h])])
    crest = tube(np.concatenate([[path[0] + np.array([0, -0.35 * y, -0.02])], path, [path[-1] + np.array([0, -0.35 * y, -0.02])]]), r, 8)
    front = [rod((s * (x - 0.03), -y + 0.035, 0), (s * (x - 0.02), -y + 0.05, seat + 0.008), 0.013, 0.018, 8) for s in (-1, 1)]
    rear: list[Solid] = []
    for s in (-1, 1):
        bend = curve([(s * 0.62 * x, y - 0.03, 0), (s * 0.66 * x, 0.55 * y, seat), (s * 0.80 * x, 0.42 * y, h - 0.13)], 2)
        rear += tube(bend, [0.013, 0.016, 0.018, 0.016, 0.014], 8)
    top, cleft = h - 2 * r, seat + 0.45 * (h - 2 * r - seat)
    fork = [rod((0, 0.62 * y, seat + 0.01), (0, 0.72 * y, cleft), 0.016, 0.018, 8)]
    fork += [rod((s * 0.006, 0.72 * y, cleft), (s * 0.16 * x, 0.9 * y, top), 0.012, 0.01, 8) for s in (-1, 1)]
    rails = [rod((-x + 0.045, -y + 0.05, seat - 0.025), (x - 0.045, -y + 0.05, seat - 0.025), 0.014, n=8)]
    rails += [rod((s * (x - 0.028), -y + 0.06, seat - 0.05), (s * 0.70 * x, 0.5 * y, seat - 0.05), 0.012, n=8) for s in (-1, 1)]
    quad = np.array([(-x + 0.03, -y + 0.036), (x - 0.03, -y + 0.036), (0.66 * x, 0.5 * y), (-0.66 * x, 0.5 * y)])
    parts = pieces("frame", crest + front + rear + rails, wood) + pieces("fork", fork, wood)
    return parts + pieces("seat", slab(quad, (seat - 0.012, seat + 0.008), 0.004), "cord")


def cantilever_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Bent steel from the floor over the front up to the seat and the back, with cane, leather or cloth between."""
    seat, x, y = min(0.46, 0.56 * h), w / 2 - TUBE, d / 2
    side = [(y - 0.03, TUBE), (-y + 0.06, TUBE), (-y + TUBE, 0.06), (-y + TUBE, seat - 0.08), (-y + 0.06, seat - 0.02)]
    side += [(0.55 * y, seat - 0.035), (0.66 * y, seat + 0.02), (y - 0.012, h - 0.012)]
    frame = [s for sx in (-1, 1) for s in tube([(sx * x, a, b) for a, b in side], TUBE, 8)]
    frame += [rod((-x + TUBE, y - 0.03, TUBE), (x - TUBE, y - 0.03, TUBE), TUBE, n=8)]
    panel, thick = (finishes.soft, 0.03) if rng.random() < 0.6 else (cane(rng), 0.014)
    inner = around(x - TUBE - 0.002)
    seat_pad = cushion(inner, (-y + 0.05, 0.5 * y), (seat - 0.035, seat - 0.035 + thick), 0.012, 2)
    slope = (y - 0.012 - 0.66 * y) / (h - seat - 0.03)
    pad = cushion(inner, around(thick / 2, 0.66 * y), (seat + 0.28 * (h - seat), h), 0.012, 2)
    parts = pieces("frame", frame, finishes.handle) + pieces("seat", seat_pad, panel)
    return parts + pieces("back", lean([pad], seat + 0.02, slope), panel)


def chinese_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build an official's hat chair with a yoke, or a rose chair with a low square back."""
    seat = min(0.5, 0.55 * h)
    x, y = 0.5 * w - 0.03, 0.5 * d - 0.03
    wood = finishes.timber
    under = seat - 0.032
    posts = [rod((px, py, 0), (px, py, under), 0.018, 0.016, 10) for px, py in corners(x, y)]
    posts += [rod((-x + 0.017, sy, z), (x - 0.017, sy, z), 0.012, n=8) for sy, z in ((-y, 0.07), (y, 0.12))]
    posts += [rod((s * x, -y + 0.017, 0.1), (s * x, y - 0.017, 0.1), 0.012, n=8) for s in (-1, 1)]
    parts = pieces("posts", posts, wood) + pieces("seat", box(around(x + 0.03), around(y + 0.03), (under, seat), 0.006), wood)
    apron = [box(around(x - 0.02), around(0.006, t * y), (seat - 0.09, under), 0.002) for t in (-1, 1)]
    apron += [box(around(0.006, s * x), around(y - 0.02), (seat - 0.08, under), 0.002) for s in (-1, 1)]
    parts += pieces("apron", apron, wood)
    r, arm = 0.0145, seat + (0.5 if form != "rose" else 0.62) * (h - seat)
    top = h - 0.045 if form == "official" else h - 2 * r
    upper = [rod((s * x, y, seat), (s * x, y, top), 0.016, 0.014, 10) for s in (-1, 1)]
    upper += [rod((s * x, -y, seat), (s * x, -y, arm - r), 0.015, n=8) for s in (-1, 1)]
    upper += [rod((s * x, -y - 0.03, arm), (s * x, y - 0.016, arm + 0.015), r, n=8) for s in (-1, 1)]
    if form == "official":
        bow = ((-x - 0.03, 0.04), (-0.5 * x, 0.028), (0, 0.02), (0.5 * x, 0.028), (x + 0.03, 0.04))
        upper += tube(curve([(px, y, h - drop) for px, drop in bow], 2), 0.017, 8)
    else:
        upper.append(rod((-x, y, h - r), (x, y, h - r), r, n=8))
        upper += [rod((-x + 0.016, y, z), (x - 0.016, y, z), 0.009, n=8) for z in (seat + 0.09, seat + 0.62 * (top - seat))]
    splat = box((-0.085, 0.085), around(0.007, y), (seat, top - 0.004 if form != "rose" else seat + 0.6 * (top - seat)), 0.003)
    parts += pieces("frame", upper, wood) + pieces("splat", splat, wood)
    if rng.random() < 0.55:
        cord = finishes.second if rng.random() < 0.4 else None
        parts += seat_cushion(around(0.84 * x), (-0.86 * y, 0.8 * y), (seat + 0.0005, seat + 0.045), 0.02, finishes.soft, cord, 0.008)
    return parts


def dressing_chair(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a round upholstered stool, one with a low curved back, or a drum with a skirt."""
    seat = h if h < 0.56 else min(0.48, 0.6 * h)
    low, squash = seat - 0.11, d / w
    if form == "drum":
        parts = pieces("body", revolve([(0.44 * w, 0.0), (0.46 * w, 0.03), (0.46 * w, low)], 28, squash=squash), finishes.second)
    else:
        kind = draw_kind(rng, finishes, "plank cross sled horse block bun pipe")
        half = 0.31 * w
        parts = pieces("legs", legs(kind, (half, half * d / w), low - 0.012, 0.034), leg_finish(finishes, kind))
        parts += pieces("ring", slab(circle(0.45 * w, 24, squash=squash), (low - 0.012, low), 0.003), leg_finish(finishes, kind))
    backed = h > seat + 0.1
    profile = [(0.46 * w, low), (0.495 * w, low + 0.015), (0.5 * w, low + 0.04), (0.5 * w, seat - 0.05)]
    profile += [(0.47 * w, seat - 0.018), (0.36 * w, seat - 0.003), (0.2 * w, seat)]
    if backed:
        profile = [(0.85 * r, z) for r, z in profile]
    parts += pieces("seat", revolve(profile, 28, squash=squash), finishes.soft)
    if backed:
        bow = arc((0.0, 0.0), 0.467 * w, 0.06 * math.pi, 0.94 * math.pi, 10, squash)
        rise = 0.55 + 0.45 * np.sin(np.linspace(0.1, math.pi - 0.1, 11))
        parts += pieces("back", wall(bow, 0.06, low, seat + (h - seat) * rise / rise.max(), 0.025), finishes.soft)
    return parts


def barstool(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a high seat on four legs or on a column; a foot rest goes around it."""
    seat = h if h < 0.85 else 0.72 * h
    x, y = w / 2, d / 2
    metal, top = finishes.handle, seat - 0.075
    if form == "pedestal":
        r, z = min(w, d), 0.32 * seat
        column = [(0.46 * r, 0.0), (0.46 * r, 0.012), (0.05, 0.035), (0.028, 0.05), (0.026, top - 0.012), (0.11, top - 0.01), (0.11, top)]
        hoop = arc((0.0, 0.0), 0.3 * r, 0, 2 * math.pi, 14)[:-1]
        rest = tube(at_height(hoop, z), 0.009, 6, closed=True)
        rest += [rod(polar(0.028, a, z), polar(0.3 * r - 0.009, a, z), 0.007, n=6) for a in turns(3, math.pi / 2)]
        parts = pieces("column", revolve(column, 24), metal) + pieces("foot_rest", rest, metal)
    else:
        kind = draw_kind(rng, finishes, "plank cross sled block bun hairpin blade cabriole")
        finish = leg_finish(finishes, kind)
        half = inside(kind, (x, y), top - 0.02, 0.036)
        frame = board(around(0.46 * w), around(0.44 * d), (top - 0.02, top), 0.03, 2, 0.003)
        parts = pieces("legs", legs(kind, half, top - 0.02, 0.036), finish) + pieces("frame", frame, finish)
        z, out = 0.3 * seat, min(0.12 * top, 0.06) * 0.7 if kind == "splayed" else 0.0
        a, b = half[0] + out, half[1] + out
        rest = [rod((-a + 0.012, t * b, z), (a - 0.012, t * b, z), 0.009, n=8) for t in (-1, 1)]
        rest += [rod((s * a, -b + 0.012, z + 0.04), (s * a, b - 0.012, z + 0.04), 0.009, n=8) for s in (-1, 1)]
        parts += pieces("foot_rest", rest, metal if kind in METAL else finish)
    parts += seat_cushion((-x, x), (-y, 0.84 * y), (top, seat), 0.03, finishes.soft, piping(rng, finishes))
    if h > seat + 0.1:
        parts += pieces("back", upright_pad(rng, finishes, around(0.45 * w), (y - 0.055, y), (seat + 0.05, h)), finishes.soft)
        struts = [box(around(0.012, s * 0.3 * w), (0.85 * y, 0.85 * y + 0.012), (top, seat + 0.05), 0.002) for s in (-1, 1)]
        parts += pieces("struts", struts, metal)
    return parts


def stool(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bed-end bench, an ottoman, a stool on legs, a round pouf, or a ceramic drum."""
    x, y = w / 2, d / 2
    if form == "drum":
        glazed = Finish("glaze", finishes.soft.color, 0.2, density=900)
        return pieces("drum", lathe("drum_stool", x, h, 24, squash=d / w), glazed)
    if form == "pouf":
        wool = Finish("knit", finishes.soft.color, 0.95, pattern="knit", density=80)
        return pieces("pouf", lathe("pouf", x, h, 28, squash=d / w), wool)
    cord = piping(rng, finishes)
    if form == "ottoman":
        low = 0.66 * h
        feet = legs("bun" if finishes.style.ornament > 0.5 else "tapered", (x - 0.05, y - 0.05), 0.06, 0.05)
        body = cushion(around(x - 0.004), around(y - 0.004), (0.06, low), 0.02, 2)
        parts = pieces("feet", feet, finishes.timber) + pieces("body", body, finishes.soft)
        if rng.random() < finishes.style.tufts and w > 0.4:
            pad = tufted_panel((-x, x), (-0.34 * h, 0.0), (-y, y), max(2, round(w / 0.22)), max(2, round(d / 0.22)))
            laid = stand_up(pad, (0, 0, 0))
            drop = low - min(float(s.vertices[:, 2].min()) for s in laid)
            return parts + pieces("seat", [s.translate((0, 0, drop)) for s in laid], finishes.soft)
        return parts + seat_cushion((-x, x), (-y, y), (low, h), 0.05, finishes.soft, cord)
    kind = draw_kind(rng, finishes, "bun blade")
    half = inside(kind, (x, y), h - 0.1, 0.04)
    thick = min(0.12, 0.3 * h) if form == "bench" else 0.07
    finish, top = leg_finish(finishes, kind), h - thick
    parts = pieces("legs", legs(kind, half, top - 0.035, 0.04), finish)
    parts += pieces("frame", board(around(x - 0.008), around(y - 0.008), (top - 0.035, top), 0.02, 2, 0.004), finish)
    if form == "legs" and rng.random() < 0.35:
        return parts + pieces("seat", board((-x, x), (-y, y), (top, h), 0.03, 3, finishes.style.edge), finishes.body)
    for span in split((-x, x), max(1, round(w / 0.55)) if form == "bench" else 1, 0.001):
        parts += seat_cushion(span, (-y, y), (top, h), 0.04, finishes.soft, cord)
    return parts
