"""House plants: leaves of several shapes on stems in pots. Lengths in metres."""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.bent import blades, curve, tube, turns
from pipeline.corpus.furniture.finishes import CERAMIC, LEAF, SOIL, Finish, Scheme, one_of, shade
from pipeline.corpus.furniture.shape import Pieces, Shape, Size, pieces
from pipeline.corpus.furniture.solids import Solid, Spot, circle, polar, ring, rod, slab

GOLDEN = math.pi * (3 - math.sqrt(5))
BARK = Finish("bark", (0.16, 0.10, 0.055), 0.9, pattern="speckle", density=500)
Points = NDArray[np.float64]


def plant(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bush, a palm, a monstera, a fiddle fig, or an olive tree in a pot."""
    w, d, h = size
    pot_r = min(0.3 * min(w, d), 0.2)
    pot_h = min(0.34 * h, 0.36, 1.9 * pot_r)
    pot, crown = _pot(rng, pot_r, pot_h, scheme)
    grow = {"bush": _bush, "palm": _palm, "monstera": _monstera, "fig": _fig, "olive": _olive}[form]
    green = Finish("leaf", shade(rng, LEAF.color, 0.28), 0.55, pattern="leaf", density=300)
    return Shape(pot + grow(rng, (w / 2, d / 2), crown, h, pot_r, green))


def _pot(rng: np.random.Generator, r: float, h: float, scheme: Scheme) -> tuple[Pieces, float]:
    """Return a pot with soil, and the height of the soil: tapered, cylindrical, bellied, a box, or a planter on legs."""
    clay = Finish("clay", (0.42, 0.17, 0.09), 0.8, density=1800)
    concrete = Finish("concrete_pot", (0.34, 0.34, 0.33), 0.8, pattern="concrete", density=2000)
    finish = one_of(rng, (CERAMIC, clay, scheme.front, concrete))
    kind = int(rng.integers(4))
    lift = 0.0
    parts: Pieces = ()
    if kind == 3 and h > 0.15:  # a cylinder in a wooden stand
        lift = 0.35 * h
        parts += pieces(
            "stand", [rod(polar(0.96 * r, a, 0), polar(0.96 * r, a, 0.72 * h), 0.011, n=8) for a in turns(4, 0.4)], scheme.timber
        )
        bar = 0.95 * r - 0.012
        parts += pieces("stand_bars", [rod(polar(-bar, 0.4, lift - 0.012), polar(bar, 0.4, lift - 0.012), 0.009, n=6)], scheme.timber)
        r = r * 0.9
    steps = {
        0: ((0.72, 0.0), (1.0, 1.0)),
        1: ((1.0, 0.0), (1.0, 1.0)),
        2: ((0.6, 0.0), (0.94, 0.35), (1.0, 0.6), (0.86, 1.0)),
        3: ((0.94, 0.0), (0.94, 1.0)),
    }[kind]
    profile = [(a * r, lift + b * (h - lift)) for a, b in steps]
    for (r0, z0), (r1, z1) in itertools.pairwise(profile):
        z0_ = z0 + (0.014 if z0 == lift else 0.0)
        parts += pieces("pot", ring((r0, r1), (r0 - 0.013, r1 - 0.013), (z0_, z1), 22), finish)
    parts += pieces("pot_floor", slab(circle(profile[0][0], 22), (lift, lift + 0.014)), finish)
    crown = lift + 0.9 * (h - lift)
    inner = float(np.interp(crown, [z for _, z in profile], [a for a, _ in profile])) - 0.0135
    return parts + pieces("soil", slab(circle(inner, 18), (crown - 0.02, crown)), SOIL), crown


def _leaves(roots: list[Points], tips: list[Points], width: float | Points, finish: Finish, *, belly: float = 0.5, n: int = 8) -> Pieces:
    return pieces("leaves", blades(np.array(roots), np.array(tips), width, belly=belly, n=n), finish)


def _bush(rng: np.random.Generator, half: Spot, crown: float, h: float, pot: float, green: Finish) -> Pieces:
    """Many small leaves in pairs along stems that fan out of the pot."""
    stems: list[Solid] = []
    roots: list[Points] = []
    tips: list[Points] = []
    count = 11
    for k in range(count):
        a, out = k * GOLDEN, 0.25 + 0.75 * math.sqrt((k + 0.5) / count)
        top = h - 0.07 - (h - crown) * 0.5 * (out - 0.25) ** 1.5 * float(rng.uniform(0.8, 1.1))
        end = np.array([half[0] * 0.82 * out * math.cos(a), half[1] * 0.82 * out * math.sin(a), top])
        start = np.array([0.4 * pot * out * math.cos(a), 0.4 * pot * out * math.sin(a), crown - 0.008])
        path = curve([start, 0.5 * (start + end) + np.array([0, 0, 0.12 * (h - crown)]), end], 2)
        stems += tube(path, np.linspace(0.006, 0.003, len(path)), 5)
        for j, q in enumerate(np.linspace(0.3, 1.0, 7)):
            p = np.array([np.interp(q * (len(path) - 1), np.arange(len(path)), path[:, c]) for c in range(3)])
            turn = a + j * 2.2
            reach = 0.16 * min(half) + 0.05
            roots.append(p)
            tips.append(p + np.array([reach * math.cos(turn), reach * math.sin(turn), 0.35 * reach * float(rng.uniform(0.2, 1.2))]))
    return pieces("stems", stems, BARK) + _leaves(roots, tips, 0.10 * min(half) + 0.026, green)


def _palm(rng: np.random.Generator, half: Spot, crown: float, h: float, pot: float, green: Finish) -> Pieces:
    """Arching fronds with leaflets on both sides."""
    stems: list[Solid] = []
    roots: list[Points] = []
    tips: list[Points] = []
    count = 9
    for k in range(count):
        a, steep = k * GOLDEN, k / count
        c, s = math.cos(a), math.sin(a)
        reach = np.array([half[0] * c, half[1] * s]) * (0.45 + 0.5 * steep)
        top = h - 0.02 - (h - crown) * 0.35 * steep
        path = curve(
            [
                np.array([0.25 * pot * c, 0.25 * pot * s, crown - 0.008]),
                np.array([*(0.42 * reach), crown + 0.62 * (top - crown)]),
                np.array([*(0.8 * reach), top]),
                np.array([*reach, top - 0.14 * (h - crown)]),
            ],
            3,
        )
        stems += tube(path, np.linspace(0.007, 0.0025, len(path)), 5)
        for j in range(3, len(path)):
            along = path[j] - path[j - 1]
            along /= np.linalg.norm(along)
            side = np.cross(along, (0.0, 0.0, 1.0))
            side /= max(float(np.linalg.norm(side)), 1e-6)
            size = 0.26 * min(half) * (1.1 - 0.6 * abs(j - 5) / len(path))
            for q in (-1, 1):
                roots.append(path[j])
                tips.append(path[j] + size * (q * side * 0.8 + 0.55 * along - np.array([0, 0, 0.18])))
    return pieces("stems", stems, green) + _leaves(roots, tips, 0.022 + 0.02 * min(half), green, belly=0.35, n=4)


def _big_leaf(base: Points, direction: float, droop: float, size: float) -> tuple[list[Points], list[Points]]:
    """Return the roots and tips of one large split leaf: a fan of lobes about its midrib."""
    u = np.array([math.cos(direction), math.sin(direction), 0.0])
    side = np.array([-u[1], u[0], 0.0])
    fall = np.array([0, 0, -droop])
    roots, tips = [], []
    for share, spread, reach in ((0.0, 0.9, 0.55), (0.22, 0.8, 0.62), (0.44, 0.66, 0.56), (0.62, 0.45, 0.46)):
        p = base + size * share * (u + 0.4 * fall)
        for q in (-1, 1):
            roots.append(p)
            tips.append(p + size * reach * (q * side * spread + u * (0.45 + 0.3 * share) + fall * (0.45 + share)))
    roots.append(base + size * 0.5 * (u + 0.4 * fall))
    tips.append(base + size * (1.08 * u + 1.0 * fall))
    return roots, tips


def _monstera(rng: np.random.Generator, half: Spot, crown: float, h: float, pot: float, green: Finish) -> Pieces:
    """Long stalks, each with one large leaf split into lobes."""
    stems: list[Solid] = []
    roots: list[Points] = []
    tips: list[Points] = []
    count = 9
    size = 0.62 * min(half)
    for k in range(count):
        a, out = k * GOLDEN, math.sqrt((k + 0.5) / count)
        c, s = math.cos(a), math.sin(a)
        z = h - 0.06 - (h - crown) * 0.55 * out**1.4 * float(rng.uniform(0.85, 1.1))
        end = np.array([(half[0] - 0.8 * size) * out * c, (half[1] - 0.8 * size) * out * s, z])
        start = np.array([0.3 * pot * c, 0.3 * pot * s, crown - 0.008])
        path = curve([start, np.array([0.35 * end[0], 0.35 * end[1], 0.6 * z + 0.4 * crown]), end], 2)
        stems += tube(path, np.linspace(0.008, 0.004, len(path)), 6)
        more_roots, more_tips = _big_leaf(end, a, 0.35 + 0.3 * out, size)
        roots += more_roots
        tips += more_tips
    return pieces("stems", stems, green) + _leaves(roots, tips, 0.3 * size, green)


def _fig(rng: np.random.Generator, half: Spot, crown: float, h: float, pot: float, green: Finish) -> Pieces:
    """Build a thin trunk with large upright leaves around its upper half."""
    top = h - 0.16
    lean = 0.06 * half[0]
    trunk = curve([(0, 0, crown - 0.008), (lean, 0.3 * lean, 0.5 * (crown + top)), (0, 0, top)], 3)
    roots: list[Points] = []
    tips: list[Points] = []
    count = 26
    for k in range(count):
        share = (k + 0.5) / count
        z = crown + (0.32 + 0.68 * share) * (top - crown)
        a = k * GOLDEN
        c, s = math.cos(a), math.sin(a)
        reach = (0.95 - 0.55 * share) if share > 0.15 else 0.75
        p = np.array([np.interp(z, trunk[:, 2], trunk[:, j]) for j in range(2)])
        roots.append(np.array([p[0] + 0.012 * c, p[1] + 0.012 * s, z]))
        tips.append(np.array([half[0] * reach * c, half[1] * reach * s, min(h, z + 0.16 + 0.12 * share * (h - crown))]))
    return pieces("trunk", tube(trunk, np.linspace(0.016, 0.009, len(trunk)), 7), BARK) + _leaves(
        roots, tips, 0.36 * min(half) + 0.03, green, belly=0.62
    )


def _olive(rng: np.random.Generator, half: Spot, crown: float, h: float, pot: float, green: Finish) -> Pieces:
    """Build a bare stem with a round head of twigs and small grey leaves."""
    trunk_top = crown + 0.45 * (h - crown)
    trunk = curve([(0, 0, crown - 0.008), (0.05 * half[0], 0, 0.5 * (crown + trunk_top)), (0, 0, trunk_top)], 2)
    solids = tube(trunk, np.linspace(0.02, 0.013, len(trunk)), 7)
    roots: list[Points] = []
    tips: list[Points] = []
    count = 14
    middle = np.array([0, 0, 0.5 * (trunk_top + h)])
    for k in range(count):
        z = 1 - 1.7 * (k + 0.5) / count
        a, q = k * GOLDEN, math.sqrt(max(0.0, 1 - z * z))
        end = middle + np.array([half[0] * 0.8 * q * math.cos(a), half[1] * 0.8 * q * math.sin(a), 0.42 * (h - trunk_top) * z])
        solids.append(rod((0, 0, trunk_top - 0.004), tuple(end), 0.006, 0.0025, 5))
        for j, t in enumerate((0.45, 0.6, 0.75, 0.88, 1.0)):
            p = np.array([0, 0, trunk_top]) + t * (end - np.array([0, 0, trunk_top]))
            for m in range(2):
                turn = a + j * 1.9 + m * math.pi
                roots.append(p)
                reach = 0.07 + 0.1 * min(half)
                tips.append(p + reach * np.array([math.cos(turn), math.sin(turn), float(rng.uniform(-0.2, 0.5))]))
    grey = Finish("olive_leaf", shade(rng, (0.16, 0.22, 0.12), 0.15), 0.6, pattern="leaf", density=300)
    return pieces("trunk", solids, BARK) + _leaves(roots, tips, 0.02 + 0.03 * min(half), grey, n=4)
