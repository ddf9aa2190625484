"""Legs: twenty forms that stand under a corner, at a side, or in the middle of a seat, a case or a table top. Lengths in metres."""

import math

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.bent import curve, lathe, tube, turns
from pipeline.corpus.furniture.finishes import PROFILES, Finish, Finishes, one_of
from pipeline.corpus.furniture.intervals import Spot, around, between, inset, polar, split
from pipeline.corpus.furniture.solids import Solid, beam, box, revolve, rod, stack

METAL = frozenset({"hairpin", "pipe", "blade", "sled", "cross"})
WIDE = frozenset({"sled", "cross", "plank"})  # forms that join the two legs of a side


# Round legs that splay: by which share of their height, by how much at most [m], and their radii at foot and top in thicknesses.
RAKES = {"splayed": (0.12, 0.06, 0.3, 0.52), "dowel": (0.03, 0.02, 0.42, 0.42), "ming": (0.03, 0.02, 0.42, 0.42)}


def leg_finish(finishes: Finishes, kind: str) -> Finish:
    """Return what legs of a form are made of: metal forms of metal, others of wood, or lacquered like the fronts."""
    if kind in METAL:
        return finishes.handle
    return finishes.accent if finishes.accent is not finishes.handle else finishes.timber


def draw_kind(rng: np.random.Generator, finishes: Finishes, without: str = "") -> str:
    """Draw a leg form that the style likes; `without` names forms that do not fit here."""
    kinds = [k for k in finishes.style.legs.split() if k not in without.split()] or ["tapered"]
    return one_of(rng, kinds)


def legs(kind: str, half: Spot, height: float, thick: float) -> list[Solid]:
    """Return legs under the corners at (+-half), `height` high, about `thick` wide."""
    if kind in WIDE:
        return [s for side in (-1, 1) for s in _frame(kind, side * half[0], half[1], height, thick)]
    return [s for sx in (-1, 1) for sy in (-1, 1) for s in leg(kind, (sx * half[0], sy * half[1]), (sx, sy), height, thick)]


def inside(kind: str, outer: Spot, height: float, thick: float) -> Spot:
    """Return where the tops of legs stand so that all of them stays within (+-outer), however far they splay."""
    if kind in RAKES:
        share, most, radius = RAKES[kind][:3]
        reach = min(share * height, most) + radius * thick
    elif kind == "hairpin":
        reach = 0.05 * height + 0.01
    elif kind == "cabriole":
        reach = 0.55 * min(thick, 0.35 * height) + 0.42 * thick
    else:
        reach = {"block": 0.7, "pipe": 0.65, "turned": 0.56, "bun": 0.85}.get(kind, 0.52) * thick
    return max(outer[0] - reach, 0.3 * outer[0]), max(outer[1] - reach, 0.3 * outer[1])


def leg(kind: str, at: Spot, out: Spot, height: float, thick: float) -> list[Solid]:
    """Return one leg whose top is centred at `at`; `out` (signs of x and y) points away from the middle of the piece."""
    x, y = at
    sx, sy = out
    t, h = thick, height
    if kind in ("square", "block"):
        r = t / 2 if kind == "square" else 0.7 * t
        return [box(around(r, x), around(r, y), (0, h), 0.003)]
    if kind in ("tapered", "blade"):
        wide, deep, taper = (t, t, 0.5) if kind == "tapered" else (0.016, max(0.7 * t, 0.022), 0.8)
        return [beam((x, y, 0), (x, y, h), wide, deep, taper)]
    if kind in RAKES:
        share, most, foot, top = RAKES[kind]
        reach = min(share * h, most)
        return [rod((x + sx * reach, y + sy * reach, 0), (x, y, h), foot * t, top * t, 10)]
    if kind in ("turned", "bun") and h < 0.16:
        return lathe("bun_leg", max(0.6 * t, 0.028), h, 14, at)
    if kind in ("turned", "bun"):
        return [*lathe("turned_leg", t, h, 12, at), box(around(0.52 * t, x), around(0.52 * t, y), (0.84 * h, h), 0.002)]
    return _ORNATE[kind](x, y, sx, sy, h, t)


def _fluted_leg(x: float, y: float, sx: float, sy: float, h: float, t: float) -> list[Solid]:
    if h < 0.12:
        return [beam((x, y, 0), (x, y, h), t, t, 0.55)]
    column = revolve([(0.26 * t, 0.06 * h), (0.44 * t, 0.82 * h)], 8, (x, y))
    foot = revolve([(0.2 * t, 0.0), (0.34 * t, 0.03 * h), (0.3 * t, 0.06 * h)], 12, (x, y))
    return [*foot, *column, box(around(0.54 * t, x), around(0.54 * t, y), (0.82 * h, h), 0.003)]


def _cabriole(x: float, y: float, sx: float, sy: float, h: float, t: float) -> list[Solid]:
    reach = min(t, 0.35 * h) * 1.25 / math.sqrt(2)
    points = [(x + sx * out * reach, y + sy * out * reach, share * h) for share, out, _ in PROFILES["cabriole_leg"]]
    return tube(points, [r * t for _, _, r in PROFILES["cabriole_leg"]], 8)


def _hairpin(x: float, y: float, sx: float, sy: float, h: float, t: float) -> list[Solid]:
    r, spread, reach = 0.0055, 0.055 + 0.06 * h, 0.05 * h
    x0, y0 = x + sx * reach, y + sy * reach
    a = rod((x - sx * spread, y, h - 0.003), (x0 - sx * 0.0065, y0 + sy * 0.004, 0.006), r, n=6)
    b = rod((x, y - sy * spread, h - 0.003), (x0 + sx * 0.004, y0 - sy * 0.0065, 0.006), r, n=6)
    plate = box(inset(between(x, x - sx * spread), -r), inset(between(y, y - sy * spread), -r), (h - 0.003, h))
    return [a, b, plate, revolve([(0.013, 0.0), (0.013, 0.006)], 10, (x0, y0))[0]]


def _horse(x: float, y: float, sx: float, sy: float, h: float, t: float) -> list[Solid]:
    """Build a square leg whose foot turns inwards, like a hoof."""
    r, low = 0.46 * t, min(0.16 * h, 0.07)

    def ring(grow: float, shift: float, z: float) -> NDArray[np.float64]:
        cx, cy, q = x - sx * shift, y - sy * shift, r + grow
        return np.array([(cx - q, cy - q, z), (cx + q, cy - q, z), (cx + q, cy + q, z), (cx - q, cy + q, z)])

    return [stack([ring(0.12 * t, 0.3 * t, 0.0), ring(0.0, 0.0, low)]), box(around(r, x), around(r, y), (low, h), 0.002)]


def _bamboo(x: float, y: float, sx: float, sy: float, h: float, t: float) -> list[Solid]:
    solids, node, r = [], 0.008, 0.38 * t
    for k, (low, high) in enumerate(split((0, h), max(1, round(h / 0.16)))):
        solids.append(rod((x, y, low + (node if k else 0.0)), (x, y, high), r, n=10))
        if k:
            rings = [(r, low), (1.22 * r, low + 0.35 * node), (1.22 * r, low + 0.65 * node), (r, low + node)]
            solids += revolve(rings, 10, (x, y))
    return solids


def _pipe(x: float, y: float, sx: float, sy: float, h: float, t: float) -> list[Solid]:
    r = max(0.3 * t, 0.011)
    flange = [revolve([(2.1 * r, z), (2.1 * r, z + 0.005)], 12, (x, y))[0] for z in (0.0, h - 0.005)]
    return [*flange, rod((x, y, 0.005), (x, y, h - 0.005), r, n=10)]


_ORNATE = {"fluted": _fluted_leg, "cabriole": _cabriole, "hairpin": _hairpin, "horse": _horse, "bamboo": _bamboo, "pipe": _pipe}


def _frame(kind: str, x: float, y: float, h: float, t: float) -> list[Solid]:
    """Return what stands at one side: a sled, a cross, or a plank, in the plane of that x."""
    if kind == "plank":
        return [box(around(0.4 * t, x), around(y + 0.3 * t), (0, h), 0.003)]
    s = min(0.5 * t, 0.012 + 0.01 * h)
    if kind == "cross":
        return [beam((x + q * s, q * y, 0), (x + q * s, -q * y, h), 2 * s, 2.2 * s) for q in (-1, 1)]
    posts = [box(around(s, x), around(s, q * y), (1.6 * s, h), 0.002) for q in (-1, 1)]
    return [box(around(s, x), around(y + s), (0, 1.6 * s), 0.002), *posts]


def pedestal(rng: np.random.Generator, finishes: Finishes, radius: float, height: float) -> list[Solid]:
    """Return a foot and a column for a round top: a trumpet, a disc with a tube, a drum, a turned column on three feet."""
    kind = int(rng.integers(2, 4) if finishes.style.ornament > 0.5 else rng.integers(3))
    r, h = radius, height
    if kind == 0:
        return lathe("trumpet_foot", r, h, 24)
    if kind == 1:
        stem, plate = 0.05 + 0.05 * r, 0.6 * r
        return revolve([(r, 0.0), (r, 0.012), (0.94 * r, 0.02), (stem, 0.022), (stem, h - 0.012), (plate, h - 0.01), (plate, h)], 24)
    if kind == 2:
        return revolve([(0.62 * r, 0.0), (0.62 * r, 0.03), (0.5 * r, 0.05), (0.42 * r, 0.5 * h), (0.5 * r, 0.94 * h), (0.62 * r, h)], 20)
    solids = lathe("turned_column", r, h, 16)
    foot = ((0.23 * r, 0.27 * h), (0.5 * r, 0.24 * h), (0.8 * r, 0.06 * h), (r, 0.025))
    for a in turns(3, math.pi / 2):
        path = curve([polar(out, a, z) for out, z in foot], 2)
        solids += tube(path, np.linspace(0.055, 0.026, len(path)), 8)
    return solids
