"""Lamp shades: drums, cones, domes, bells, pleats, globes, paper balls, lanterns, cages, cane. Lengths in metres."""

import itertools
import math

import numpy as np

from pipeline.corpus.furniture.bent import band, curve, tube, turns
from pipeline.corpus.furniture.finishes import GLOW, Finish, Scheme, cane, one_of
from pipeline.corpus.furniture.finishes import shade as tinted
from pipeline.corpus.furniture.intervals import Interval, Spot, around, corners, polar
from pipeline.corpus.furniture.shape import Pieces, pieces
from pipeline.corpus.furniture.solids import Solid, box, circle, revolve, ring, rod, slab

CLOTH = Finish("shade_cloth", (0.80, 0.75, 0.65), 0.9, density=150)
WALL = 0.006


PROFILES = {  # (radius, height) upwards, in shares
    "drum": ((1.0, 0.0), (0.9, 1.0)),
    "cone": ((1.0, 0.0), (0.26, 0.92), (0.2, 1.0)),
    "cylinder": ((1.0, 0.0), (1.0, 1.0)),
    "bell": ((1.0, 0.0), (0.82, 0.2), (0.66, 0.55), (0.5, 1.0)),
    "pleated": ((1.0, 0.0), (0.62, 1.0)),
    "mushroom": ((1.0, 0.0), (0.99, 0.2), (0.85, 0.6), (0.5, 0.9), (0.16, 1.0)),
    "rattan": ((0.72, 0.0), (1.0, 0.34), (0.9, 0.66), (0.42, 1.0)),
    "crystal": ((0.7, 0.0), (1.0, 1.0)),
    "dome": tuple((math.cos(a), math.sin(a) / math.sin(1.25)) for a in np.linspace(0.0, 1.25, 5)),
}


def shade_word(rng: np.random.Generator, scheme: Scheme, without: str) -> str:
    """Draw a form of shade that the style likes."""
    words = [word for word in scheme.manner.shades.split() if word not in without.split()] or ["drum"]
    return one_of(rng, words)


def cord(z: Interval) -> list[Solid]:
    """Return a cord in the middle from z[0] up to z[1]."""
    return [rod((0, 0, z[0]), (0, 0, z[1]), 0.0035, n=6)]


def rose(h: float) -> list[Solid]:
    """Return the canopy at the ceiling, at height `h`."""
    return revolve([(0.055, h - 0.024), (0.055, h - 0.006), (0.9 * 0.055, h)], 20)


def bulb(z: float, tall: float, at: Spot) -> Pieces:
    """Return a bulb that stands on `z`."""
    profile = [(0.2 * tall, z), (0.42 * tall, z + 0.45 * tall), (0.34 * tall, z + 0.75 * tall), (0.1 * tall, z + tall)]
    return pieces("bulb", revolve(profile, 10, at), GLOW)


def shade(rng: np.random.Generator, scheme: Scheme, kind: str, radius: float, z: Interval, at: Spot = (0.0, 0.0), n: int = 24) -> Pieces:
    """Return a shade of `radius` over heights `z`: hollow with a bulb and spokes in it, or a lit globe."""
    if kind in ("globe", "paper"):
        return _ball(scheme, kind, radius, z, at, n)
    if kind in ("lantern", "cage"):
        return (_lantern if kind == "lantern" else _cage)(scheme, radius, z)
    metal, weave = scheme.handle, cane(rng)
    profile = [(r * radius, z[0] + q * (z[1] - z[0])) for r, q in PROFILES[kind]]
    dome = metal if rng.random() < 0.6 else scheme.front
    cover = {"rattan": weave, "cone": scheme.front, "dome": dome, "mushroom": scheme.front, "crystal": GLOW}.get(kind, CLOTH)
    if cover is CLOTH and rng.random() < 0.3:
        cover = Finish("shade_linen", tinted(rng, (0.62, 0.52, 0.38)), 0.9, pattern="weave", density=150)
    return pieces("shade", _walls(kind, profile, at, n), cover) + _fittings(radius, profile[-1][0], z, at, metal)


def _ball(scheme: Scheme, kind: str, radius: float, z: Interval, at: Spot, n: int) -> Pieces:
    """Build a lit globe with its cap, or a squat ball of paper on a neck."""
    low, high = z
    tall, squat = high - low, 1.0 if kind == "globe" else 0.92
    angles = np.linspace(-1.45, 1.45, 11 if n > 16 else 8)
    steps = [(radius * math.cos(a), low + tall / 2 + tall / 2 * math.sin(a) / math.sin(1.45)) for a in angles]
    parts = pieces("globe", revolve([(r, q * squat + low * (1 - squat)) if kind == "paper" else (r, q) for r, q in steps], n, at), GLOW)
    if kind == "paper":
        return parts + pieces("neck", revolve([(0.12 * radius, low + squat * tall), (0.12 * radius, high)], 10, at), scheme.timber)
    if tall > 0.08 and n > 16:
        parts += pieces("cap", revolve([(0.3 * radius, high - 0.02 * tall), (0.24 * radius, high)], 12, at), scheme.handle)
    return parts


def _walls(kind: str, profile: list[Spot], at: Spot, n: int) -> list[Solid]:
    """Build the wall of an open shade around a profile of (radius, height): rings of n sides, or pleats."""
    walls: list[Solid] = []
    for (r0, z0), (r1, z1) in itertools.pairwise(profile):
        if kind != "pleated":
            walls += ring((r0, r1), (max(r0 - WALL, 0.3 * r0), max(r1 - WALL, 0.3 * r1)), (z0, z1), n, at)
            continue
        middle = r1 + 0.5 * (r0 - r1)
        path = np.array([polar(middle * (0.965 if k % 2 else 1.0), a) for k, a in enumerate(turns(36))])
        for stave in band(path, 0.005, (z0, z1), closed=True):
            grow = np.where(np.arange(8) < 4, r0, r1) / (0.5 * (r0 + r1))
            walls.append(Solid(stave.vertices * np.column_stack([grow, grow, np.ones(8)]), stave.faces).moved((*at, 0.0)))
    return walls


def _fittings(radius: float, top: float, z: Interval, at: Spot, metal: Finish) -> Pieces:
    """Build the spokes that carry an open shade whose upper rim has radius `top`, its socket and its bulb, where there is room for them."""
    low, high = z
    tall = high - low
    parts: Pieces = ()
    if top > 0.05:
        middle = np.array([*at, high - 0.03 * tall - 0.004])
        spokes = [rod(middle - s * np.array(polar(top - 0.5 * WALL, 0.3, 0)), middle, 0.0025, n=5) for s in (-1, 1)]
        parts += pieces("spider", spokes, metal)
    if tall > 0.16 and radius > 0.06:
        parts += pieces("socket", revolve([(0.014, high - 0.45 * tall), (0.014, high - 0.02 * tall)], 8, at), metal)
        parts += bulb(high - 0.45 * tall - 0.07, 0.07, at)
    return parts


def _lantern(scheme: Scheme, radius: float, z: Interval) -> Pieces:
    """Four paper panes in a frame of thin wood with a cap and a foot."""
    low, high = z
    r = min(radius / math.sqrt(2) * 1.35, radius)
    t = 0.016
    span, inner = (low + 0.012, high - 0.03), around(r - t)
    frame = [box(around(t / 2, x), around(t / 2, y), span, 0.002) for x, y in corners(r - t / 2, r - t / 2)]
    levels = [(q, q + 0.006) for q in np.linspace(low, high, 5)[1:-1].tolist()]
    frame += [box(around(0.003, s * (r - 0.3 * t)), inner, level) for s in (-1, 1) for level in levels]
    frame += [box(inner, around(0.003, s * (r - 0.3 * t)), level) for s in (-1, 1) for level in levels]
    caps = ((radius, (high - 0.03, high - 0.015), 0.003), (0.6 * radius, (high - 0.015, high), 0.003), (r, (low, low + 0.012), 0.002))
    frame += [box(around(half), around(half), level, bevel) for half, level, bevel in caps]
    panes = [box(around(0.002, s * (r - 0.7 * t)), inner, span) for s in (-1, 1)]
    panes += [box(inner, around(0.002, s * (r - 0.7 * t)), span) for s in (-1, 1)]
    return pieces("frame", frame, scheme.timber) + pieces("panes", panes, GLOW)


def _cage(scheme: Scheme, radius: float, z: Interval) -> Pieces:
    """Bent wires around a bare bulb, hoops that hold them, a cap with the socket."""
    low, high = z
    tall, metal = high - low, scheme.handle
    shape = [(0.34, 0.0), (0.8, 0.14), (1.0, 0.42), (0.8, 0.7), (0.3, 0.9)]
    parts: Pieces = ()
    for a in turns(8):
        path = curve([polar(r * radius - 0.004, a, low + q * tall) for r, q in shape], 1)
        parts += pieces("wires", tube(path, 0.0035, 5), metal)
    hoop = tube([polar(0.34 * radius + 0.002, a, low + 0.004) for a in turns(12)], 0.004, 5, closed=True)
    cap = revolve([(0.36 * radius, high - 0.12 * tall), (0.36 * radius, high - 0.05 * tall), (0.1 * radius, high)], 14)
    foot = slab(circle(0.3 * radius, 10), (low + 0.002, low + 0.004))
    parts += pieces("hoop", hoop, metal) + pieces("cap", cap, metal) + pieces("foot", foot, metal)
    return parts + bulb(high - 0.12 * tall - 0.5 * tall, 0.5 * tall, (0.0, 0.0))
