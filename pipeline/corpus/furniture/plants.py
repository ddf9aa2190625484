"""House plants: leaves of several shapes on stems in pots. Lengths in metres."""

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.bent import blades, curve, tube, turns
from pipeline.corpus.furniture.finishes import FINISHES, PROFILES, Finish, Finishes, Material, draw_material, tint
from pipeline.corpus.furniture.intervals import Spot, polar
from pipeline.corpus.furniture.shape import Pieces, pieces
from pipeline.corpus.furniture.solids import Solid, circle, ring, rod, slab

GOLDEN = math.pi * (3 - math.sqrt(5))


Points = NDArray[np.float64]


def plant(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bush, a palm, a monstera, a fiddle fig, or an olive tree in a pot."""
    pot_r = min(0.3 * min(w, d), 0.2)
    pot, crown = _pot(rng, pot_r, min(0.34 * h, 0.36, 1.9 * pot_r), finishes)
    grow = {"bush": _bush, "palm": _palm, "monstera": _monstera, "fig": _fig, "olive": _olive}[form]
    green = Finish("leaf", tint(rng, FINISHES["leaf"].color, 0.28), 0.55, pattern="leaf", density=300)
    return pot + grow(rng, Growth((w / 2, d / 2), crown, h, pot_r, green))


def _pot(rng: np.random.Generator, r: float, h: float, finishes: Finishes) -> tuple[Pieces, float]:
    """Return a pot with soil, and the height of the soil: tapered, cylindrical, bellied, a box, or a planter on legs."""
    finish = draw_material(rng, "ceramic", "clay", finishes.front, "concrete_pot")
    kind = int(rng.integers(4))
    lift = 0.0
    parts: Pieces = ()
    if kind == 3 and h > 0.15:  # a cylinder in a wooden stand
        lift = 0.35 * h
        legs = [rod(polar(0.96 * r, a, 0), polar(0.96 * r, a, 0.72 * h), 0.011, n=8) for a in turns(4, 0.4)]
        bar = polar(0.95 * r - 0.012, 0.4)
        parts += pieces("stand", legs, finishes.timber)
        parts += pieces("stand_bars", rod((-bar[0], -bar[1], lift - 0.012), (*bar, lift - 0.012), 0.009, n=6), finishes.timber)
        r = r * 0.9
    profile = [(a * r, lift + b * (h - lift)) for a, b in PROFILES[f"pot_{kind}"]]
    walls = [(profile[0][0], lift + 0.014), *profile[1:]]
    for (r0, z0), (r1, z1) in itertools.pairwise(walls):
        parts += pieces("pot", ring((r0, r1), (r0 - 0.013, r1 - 0.013), (z0, z1), 22), finish)
    parts += pieces("pot_floor", slab(circle(profile[0][0], 22), (lift, lift + 0.014)), finish)
    crown = lift + 0.9 * (h - lift)
    inner = float(np.interp(crown, [z for _, z in profile], [a for a, _ in profile])) - 0.0135
    return parts + pieces("soil", slab(circle(inner, 18), (crown - 0.02, crown)), "soil"), crown


class Growth:
    """What grows from a pot: `half` (x, y) its room, from the soil at `crown` up to `h` [m], over a pot of radius `pot`."""

    def __init__(self, half: Spot, crown: float, h: float, pot: float, green: Material) -> None:
        self.half, self.small = np.array(half), min(half)
        self.crown, self.h, self.pot, self.green = crown, h, pot, green
        self.stems: list[Solid] = []
        self.roots: list[Points] = []
        self.tips: list[Points] = []

    def out(self, angle: float, share: float, z: float) -> Points:
        """Return the point at a share of the room, height `z`."""
        return np.array([*(self.half * share * polar(1.0, angle)), z])

    def root(self, angle: float, share: float) -> Points:
        """Return where a stem leaves the soil, at a share of the pot's radius."""
        return np.array(polar(share * self.pot, angle, self.crown - 0.008))

    def leaf(self, root: Points, tip: Points) -> None:
        """Add a leaf."""
        self.roots.append(root)
        self.tips.append(tip)

    def parts(self, stems: str, bark: Material, width: float, leaf: Material | None = None, *, belly: float = 0.5, n: int = 8) -> Pieces:
        """Return the stems, of `bark`, and the leaves, `width` [m] wide."""
        leaves = blades(np.array(self.roots), np.array(self.tips), width, belly=belly, n=n)
        return pieces(stems, self.stems, bark) + pieces("leaves", leaves, leaf or self.green)


def _bush(rng: np.random.Generator, g: Growth) -> Pieces:
    """Many small leaves in pairs along stems that fan out of the pot."""
    count, reach = 11, 0.16 * g.small + 0.05
    for k in range(count):
        a, out = k * GOLDEN, 0.25 + 0.75 * math.sqrt((k + 0.5) / count)
        top = g.h - 0.07 - (g.h - g.crown) * 0.5 * (out - 0.25) ** 1.5 * float(rng.uniform(0.8, 1.1))
        end, start = g.out(a, 0.82 * out, top), g.root(a, 0.4 * out)
        path = curve([start, 0.5 * (start + end) + np.array([0, 0, 0.12 * (g.h - g.crown)]), end], 2)
        g.stems += tube(path, np.linspace(0.006, 0.003, len(path)), 5)
        for j, q in enumerate(np.linspace(0.3, 1.0, 7)):
            p = np.array([np.interp(q * (len(path) - 1), np.arange(len(path)), path[:, c]) for c in range(3)])
            g.leaf(p, p + np.array(polar(reach, a + j * 2.2, 0.35 * reach * float(rng.uniform(0.2, 1.2)))))
    return g.parts("stems", "bark", 0.10 * g.small + 0.026)


def _palm(rng: np.random.Generator, g: Growth) -> Pieces:
    """Arching fronds with leaflets on both sides."""
    count, tall = 9, g.h - g.crown
    for k in range(count):
        a, steep = k * GOLDEN, k / count
        reach, top = 0.45 + 0.5 * steep, g.h - 0.02 - tall * 0.35 * steep
        bend = ((0.42 * reach, g.crown + 0.62 * (top - g.crown)), (0.8 * reach, top), (reach, top - 0.14 * tall))
        path = curve([g.root(a, 0.25), *(g.out(a, share, z) for share, z in bend)], 3)
        g.stems += tube(path, np.linspace(0.007, 0.0025, len(path)), 5)
        for j in range(3, len(path)):
            along = path[j] - path[j - 1]
            along /= np.linalg.norm(along)
            side = np.cross(along, (0.0, 0.0, 1.0))
            side /= max(float(np.linalg.norm(side)), 1e-6)
            size = 0.26 * g.small * (1.1 - 0.6 * abs(j - 5) / len(path))
            for q in (-1, 1):
                g.leaf(path[j], path[j] + size * (q * side * 0.8 + 0.55 * along - np.array([0, 0, 0.18])))
    return g.parts("stems", g.green, 0.022 + 0.02 * g.small, belly=0.35, n=4)


def _monstera(rng: np.random.Generator, g: Growth) -> Pieces:
    """Long stalks, each with one large leaf split into lobes: a fan of them about its midrib."""
    count, size = 9, 0.62 * g.small
    for k in range(count):
        a, out = k * GOLDEN, math.sqrt((k + 0.5) / count)
        z = g.h - 0.06 - (g.h - g.crown) * 0.55 * out**1.4 * float(rng.uniform(0.85, 1.1))
        end = np.array([*((g.half - 0.8 * size) * out * polar(1.0, a)), z])
        path = curve([g.root(a, 0.3), np.array([*(0.35 * end[:2]), 0.6 * z + 0.4 * g.crown]), end], 2)
        g.stems += tube(path, np.linspace(0.008, 0.004, len(path)), 6)
        u = np.array(polar(1.0, a, 0.0))
        side, fall = np.array([-u[1], u[0], 0.0]), np.array([0, 0, -(0.35 + 0.3 * out)])
        for share, spread, reach in ((0.0, 0.9, 0.55), (0.22, 0.8, 0.62), (0.44, 0.66, 0.56), (0.62, 0.45, 0.46)):
            p = end + size * share * (u + 0.4 * fall)
            for q in (-1, 1):
                g.leaf(p, p + size * reach * (q * side * spread + u * (0.45 + 0.3 * share) + fall * (0.45 + share)))
        g.leaf(end + size * 0.5 * (u + 0.4 * fall), end + size * (1.08 * u + 1.0 * fall))
    return g.parts("stems", g.green, 0.3 * size)


def _fig(rng: np.random.Generator, g: Growth) -> Pieces:
    """Build a thin trunk with large upright leaves around its upper half."""
    top, lean = g.h - 0.16, 0.06 * g.half[0]
    trunk = curve([(0, 0, g.crown - 0.008), (lean, 0.3 * lean, 0.5 * (g.crown + top)), (0, 0, top)], 3)
    g.stems += tube(trunk, np.linspace(0.016, 0.009, len(trunk)), 7)
    count = 26
    for k in range(count):
        share, a = (k + 0.5) / count, k * GOLDEN
        z = g.crown + (0.32 + 0.68 * share) * (top - g.crown)
        reach = (0.95 - 0.55 * share) if share > 0.15 else 0.75
        p = np.array([*(np.interp(z, trunk[:, 2], trunk[:, j]) for j in range(2)), z])
        g.leaf(p + polar(0.012, a, 0.0), g.out(a, reach, min(g.h, z + 0.16 + 0.12 * share * (g.h - g.crown))))
    return g.parts("trunk", "bark", 0.36 * g.small + 0.03, belly=0.62)


def _olive(rng: np.random.Generator, g: Growth) -> Pieces:
    """Build a bare stem with a round head of twigs and small grey leaves."""
    top = np.array([0, 0, g.crown + 0.45 * (g.h - g.crown)])
    trunk = curve([(0, 0, g.crown - 0.008), (0.05 * g.half[0], 0, 0.5 * (g.crown + top[2])), top], 2)
    g.stems += tube(trunk, np.linspace(0.02, 0.013, len(trunk)), 7)
    count, reach = 14, 0.07 + 0.1 * g.small
    for k in range(count):
        z = 1 - 1.7 * (k + 0.5) / count
        a, q = k * GOLDEN, math.sqrt(max(0.0, 1 - z * z))
        end = g.out(a, 0.8 * q, 0.5 * (top[2] + g.h) + 0.42 * (g.h - top[2]) * z)
        g.stems.append(rod(top - (0, 0, 0.004), end, 0.006, 0.0025, 5))
        for j, t in enumerate((0.45, 0.6, 0.75, 0.88, 1.0)):
            p = top + t * (end - top)
            for m in range(2):
                g.leaf(p, p + reach * np.array(polar(1.0, a + j * 1.9 + m * math.pi, float(rng.uniform(-0.2, 0.5)))))
    grey = Finish("olive_leaf", tint(rng, (0.16, 0.22, 0.12), 0.15), 0.6, pattern="leaf", density=300)
    return g.parts("trunk", "bark", 0.02 + 0.03 * g.small, grey, n=4)
