"""Lamp shades, floor, wall and table lamps. The origin is the bottom of the box, as of all objects. Lengths in metres."""

import itertools
import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.bent import curve, tube, turns, wall
from pipeline.corpus.furniture.finishes import PROFILES, Finish, Finishes, Material, cane, one_of, tint
from pipeline.corpus.furniture.intervals import Interval, Spot, around, corners, polar
from pipeline.corpus.furniture.shape import Pieces, pieces
from pipeline.corpus.furniture.solids import Solid, box, circle, revolve, ring, rod, slab, stand_up

WALL = 0.006


DOME = tuple((math.cos(a), math.sin(a) / math.sin(1.25)) for a in np.linspace(0.0, 1.25, 5))


def shade_word(rng: np.random.Generator, finishes: Finishes, without: str) -> str:
    """Draw a form of shade that the style likes."""
    words = [word for word in finishes.style.shades.split() if word not in without.split()] or ["drum"]
    return one_of(rng, words)


def bulb(z: float, tall: float, at: Spot) -> Pieces:
    """Return a bulb that stands on `z`."""
    profile = [(0.2 * tall, z), (0.42 * tall, z + 0.45 * tall), (0.34 * tall, z + 0.75 * tall), (0.1 * tall, z + tall)]
    return pieces("bulb", revolve(profile, 10, at), "glow")


def shade(
    rng: np.random.Generator, finishes: Finishes, kind: str, radius: float, z: Interval, at: Spot = (0.0, 0.0), n: int = 24
) -> Pieces:
    """Return a shade of `radius` over heights `z`: hollow with a bulb and spokes in it, or a lit globe."""
    if kind in ("globe", "paper"):
        return _ball(finishes, kind, radius, z, at, n)
    if kind in ("lantern", "cage"):
        return (_lantern if kind == "lantern" else _cage)(finishes, radius, z)
    metal, weave = finishes.handle, cane(rng)
    shares = DOME if kind == "dome" else PROFILES[f"{kind}_shade"]
    profile = [(r * radius, z[0] + q * (z[1] - z[0])) for r, q in shares]
    dome = metal if rng.random() < 0.6 else finishes.front
    covers: dict[str, Material] = {"rattan": weave, "cone": finishes.front, "dome": dome, "mushroom": finishes.front, "crystal": "glow"}
    cover = covers.get(kind, "shade_cloth")
    if cover == "shade_cloth" and rng.random() < 0.3:
        cover = Finish("shade_linen", tint(rng, (0.62, 0.52, 0.38)), 0.9, pattern="weave", density=150)
    parts, top, high, tall = pieces("shade", _walls(kind, profile, at, n), cover), profile[-1][0], z[1], z[1] - z[0]
    if top > 0.05:  # spokes carry it
        middle = np.array([*at, high - 0.03 * tall - 0.004])
        spokes = [rod(middle - s * np.array(polar(top - 0.5 * WALL, 0.3, 0)), middle, 0.0025, n=5) for s in (-1, 1)]
        parts += pieces("spider", spokes, metal)
    if tall > 0.16 and radius > 0.06:
        parts += pieces("socket", revolve([(0.014, high - 0.45 * tall), (0.014, high - 0.02 * tall)], 8, at), metal)
        parts += bulb(high - 0.45 * tall - 0.07, 0.07, at)
    return parts


def _ball(finishes: Finishes, kind: str, radius: float, z: Interval, at: Spot, n: int) -> Pieces:
    """Build a lit globe with its cap, or a squat ball of paper on a neck."""
    low, high = z
    tall, squat = high - low, 1.0 if kind == "globe" else 0.92
    angles = np.linspace(-1.45, 1.45, 11 if n > 16 else 8)
    steps = [(radius * math.cos(a), low + tall / 2 + tall / 2 * math.sin(a) / math.sin(1.45)) for a in angles]
    parts = pieces("globe", revolve([(r, q * squat + low * (1 - squat)) if kind == "paper" else (r, q) for r, q in steps], n, at), "glow")
    if kind == "paper":
        return parts + pieces("neck", revolve([(0.12 * radius, low + squat * tall), (0.12 * radius, high)], 10, at), finishes.timber)
    if tall > 0.08 and n > 16:
        parts += pieces("cap", revolve([(0.3 * radius, high - 0.02 * tall), (0.24 * radius, high)], 12, at), finishes.handle)
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
        for stave in wall(path, 0.005, z0, z1, closed=True):
            grow = np.where(np.arange(8) < 4, r0, r1) / (0.5 * (r0 + r1))
            walls.append(Solid(stave.vertices * np.column_stack([grow, grow, np.ones(8)]), stave.faces).translate((*at, 0.0)))
    return walls


def _lantern(finishes: Finishes, radius: float, z: Interval) -> Pieces:
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
    return pieces("frame", frame, finishes.timber) + pieces("panes", panes, "glow")


def _cage(finishes: Finishes, radius: float, z: Interval) -> Pieces:
    """Bent wires around a bare bulb, hoops that hold them, a cap with the socket."""
    low, high = z
    tall, metal = high - low, finishes.handle
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


def turn_along_y(parts: Pieces) -> Pieces:
    """Return what was built along x along y."""
    return tuple(replace(p, solid=p.solid.rotate("z", math.pi / 2)) for p in parts)


def floor_lamp(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a shade on a pole or on three legs."""
    r, metal = w / 2, finishes.handle
    kind = shade_word(rng, finishes, "globe cage lantern paper crystal mushroom cylinder")
    tall = min(0.26 * h, 0.95 * w)
    parts, top = shade(rng, finishes, kind, r, (h - tall, h)), h - tall
    if form == "tripod":  # its hub carries the shade, sometimes there is a shelf between its legs
        ends = [polar(0.95 * r, a) for a in turns(3, math.pi / 2)]
        legs = [rod((x, y, 0), (0.03 * x / r, 0.03 * y / r, top - 0.035), 0.011, 0.015, 8) for x, y in ends]
        parts += pieces("legs", legs, finishes.timber)
        if rng.random() < 0.5:
            parts += pieces("shelf", slab(circle(0.42 * r, 20), (0.42 * top, 0.42 * top + 0.012)), finishes.timber)
        hub = revolve([(0.05, top - 0.035), (0.05, top - 0.02), (0.012, top - 0.012), (0.008, top + 0.3 * tall)], 14)
        return parts + pieces("hub", hub, metal)
    if finishes.style.ornament > 0.5:
        steps = [(0.6 * r, 0.0), (0.6 * r, 0.03), (0.05, 0.05), (0.02, 0.12), (0.032, 0.3), (0.016, 0.36 * h), (0.03, 0.42 * h)]
        steps += [(0.016, 0.46 * h), (0.02, 0.6 * h), (0.01, top), (0.008, h - 0.7 * tall)]
        return parts + pieces("pole", revolve(steps, 16), finishes.timber if rng.random() < 0.5 else metal)
    pole = revolve([(0.62 * r, 0.0), (0.62 * r, 0.018), (0.013, 0.028), (0.010, h - 0.7 * tall)], 20)
    return parts + pieces("pole", pole, metal)


def stem_of_globes(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build three lit globes on arms around a stem."""
    r, metal = w / 2, finishes.handle
    parts = pieces("foot", revolve([(0.62 * r, 0.0), (0.62 * r, 0.02), (0.014, 0.03), (0.011, h - 0.02)], 20), metal)
    q = 0.36 * r
    for k, z in enumerate((0.62 * h, 0.78 * h, 0.93 * h)):
        a = 2.2 * k + 0.4
        x, y = (r - q) * math.cos(a), (min(r, d / 2) - q) * math.sin(a)
        parts += shade(rng, finishes, "globe", q, (z - q, min(z + q, h)), (x, y), 14)
        u = np.array([x, y, 0]) / max(math.hypot(x, y), 1e-6)
        parts += pieces("arms", rod(0.01 * u + (0, 0, z), (x, y, z) - q * u * 0.99, 0.006, n=6), metal)
    return parts


def wall_lamp(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a small shade on an arm, a lit bar, a globe on a plate, or candles on swung arms; the back is at the wall."""
    metal = finishes.handle
    back = d / 2
    if form == "bar":
        plate = box(around(0.5 * w), (back - 0.018, back), (0.36 * h, 0.64 * h), 0.004)
        r = min(0.16 * w, 0.3 * d)
        y = -d / 2 + r
        light = rod((0, y, 0.03 * h), (0, y, 0.97 * h), 0.85 * r, n=14)
        caps = [rod((0, y, z), (0, y, z + 0.03 * h), r, n=14) for z in (0.0, 0.97 * h)]
        arm = box((-0.012, 0.012), (y + 0.85 * r, back - 0.018), (0.48 * h, 0.52 * h), 0.002)
        return pieces("plate", plate, metal) + pieces("caps", [*caps, arm], metal) + pieces("tube", light, "glow")
    if form == "globe":
        r = min(w / 2, 0.42 * d)
        y = -d / 2 + r
        disc = stand_up([slab(circle(0.5 * w, 20, squash=h / w), (0.0, 0.016), 0.003)], (0, back, 0.5 * h))
        neck = rod((0, back - 0.016, 0.5 * h), (0, y + 0.95 * r, 0.5 * h), 0.009, n=8)
        globe = shade(rng, finishes, "globe", r, around(min(r, 0.5 * h), 0.5 * h), (0.0, y), 18)
        return pieces("plate", disc, metal) + pieces("neck", neck, metal) + globe
    r = min(w / 2, 0.4 * d) if form == "shade" else min(0.24 * w, 0.4 * d)
    wide = 0.2 * w if form != "shade" or r > 0.4 * w else 0.5 * w
    parts = pieces("plate", box((-wide, wide), (back - 0.016, back), (0.0, 0.7 * h), 0.004), metal)
    for s in (0,) if form == "shade" else (-1, 1):
        x, y = s * (w / 2 - r), -d / 2 + r
        swing = curve([(0.1 * x, back - 0.016, 0.34 * h), (0.6 * x, 0.5 * (y + back), 0.22 * h), (x, y, 0.26 * h), (x, y, 0.42 * h)], 2)
        parts += pieces("arm", tube(swing, 0.0065, 6), metal)
        parts += shade(rng, finishes, "pleated" if finishes.style.ornament > 0.5 else "drum", r, (h - 0.55 * h, h), (x, y), 16)
    return parts


def table_lamp(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a shade on a foot of pottery, turned wood or metal, a globe, or a mushroom."""
    metal = finishes.handle
    r = w / 2
    if form == "mushroom":
        foot = revolve([(0.5 * r, 0.0), (0.42 * r, 0.1 * h), (0.34 * r, 0.45 * h), (0.4 * r, 0.6 * h)], 20)
        bend = curve([(0.97 * r, 0.6 * h), (r, 0.63 * h), (0.92 * r, 0.78 * h), (0.66 * r, 0.93 * h), (0.25 * r, h)], 2)
        cap = revolve(bend.tolist(), 28)
        return pieces("stem", foot, finishes.front) + pieces("cap", cap, "glow" if rng.random() < 0.5 else finishes.front)
    if form == "globe":
        foot = revolve([(0.6 * r, 0.0), (0.6 * r, 0.02), (0.3 * r, 0.03), (0.2 * r, h - 1.95 * r)], 20)
        base = pieces("foot", foot, metal if rng.random() < 0.6 else finishes.stone)
        return base + shade(rng, finishes, "globe", r, (max(0.05, h - 1.95 * r), h))
    tall = 0.42 * h
    stem = h - tall
    belly = curve([(0.45, 0.0), (0.5, 0.03), (0.62, 0.2), (0.5, 0.4), (0.16, 0.52)], 2).tolist()
    turning = [(0.5, 0.0), (0.5, 0.03), (0.14, 0.06), (0.26, 0.16), (0.34, 0.28), (0.14, 0.42), (0.2, 0.48)]
    profile = [(a * r, b * h) for a, b in (belly if rng.random() < 0.5 else turning)]
    profile += [(0.01, min(0.54 * h, stem - 0.01)), (0.006, h - 0.45 * tall - 0.072 if tall > 0.16 else h - 0.5 * tall)]
    finish = finishes.timber if rng.random() < 0.4 else replace(finishes.front, name="pottery", roughness=0.2)
    kind = shade_word(rng, finishes, "globe cage lantern paper crystal mushroom cylinder dome")
    return pieces("foot", revolve(profile, 20), finish) + shade(rng, finishes, kind, r, (stem, h))


def desk_lamp(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a round foot, an arm with an elbow and a cone at its end, along the longer side."""
    if d > w:
        return turn_along_y(desk_lamp(rng, form, d, w, h, finishes))
    q = min(0.5 * d, 0.34 * w)
    x0, tip = -w / 2 + q, w / 2 - 0.28 * d
    foot = revolve([(q, 0.0), (q, 0.014), (0.2 * q, 0.022)], 20, (x0, 0.0))
    x, z = x0 - 0.25 * q, 0.6 * h  # of the elbow
    arm = [rod((x0, 0, 0.022), (x, 0, z - 0.012), 0.007, n=8), rod((x + 0.01, 0, z + 0.003), (tip, 0.0, h - 0.02), 0.007, n=8)]
    arm.append(rod((x, -0.014, z), (x, 0.014, z), 0.012, n=10))
    head = shade(rng, finishes, "cone", 0.28 * d, (h - 0.02 - 0.42 * d, h - 0.02), (tip, 0.0), 16)
    return pieces("foot", foot, finishes.handle) + pieces("arm", arm, finishes.handle) + head
