"""Tables: dining, coffee, side and end tables, bars, desks, dressing tables. Lengths in metres."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.bent import arc, lathe, prism, turns, wall
from pipeline.corpus.furniture.casework import Case, Cell, Column, case, grid
from pipeline.corpus.furniture.finishes import Finish, Finishes, cane
from pipeline.corpus.furniture.fronts import Rect, frame
from pipeline.corpus.furniture.intervals import Interval, around, polar, split
from pipeline.corpus.furniture.legs import WIDE, draw_kind, inside, leg_finish, legs, pedestal
from pipeline.corpus.furniture.shape import Pieces, Shape, join_shapes, pieces, translate
from pipeline.corpus.furniture.solids import Solid, beam, board, box, circle, revolve, ring, rod, rounded_rectangle, slab, stand_up
from pipeline.corpus.furniture.storage import case_style, front_style


def top_finish(rng: np.random.Generator, finishes: Finishes, *, stone: float = 1.0) -> Finish:
    """Draw what a table top is made of: the style's stone or glass at its chance times `stone`, else wood or lacquer."""
    return finishes.stone if rng.random() < stone * finishes.style.stone else finishes.body


def outline(rng: np.random.Generator, finishes: Finishes, w: float, d: float) -> NDArray[np.float64]:
    """Draw a table top's outline: nearly square corners, well rounded ones, an oval, or a boat."""
    u = rng.random()
    if u < 0.12 and w > 1.2:
        t = np.linspace(-1, 1, 11)
        side = np.column_stack([w / 2 * t, (0.1 * t**2 - 0.5) * d])
        return np.concatenate([side, -side])
    radius = 0.012 + finishes.style.edge if u < 0.55 else min(0.14, 0.2 * d) if u < 0.88 else 0.499 * min(w, d)
    return rounded_rectangle(around(w / 2), around(d / 2), radius, 4 if radius < 0.2 else 8)


def top(edge: NDArray[np.float64], z: Interval, finishes: Finishes) -> list[Solid]:
    """Return a table top: a plain board with eased edges, or where there is ornament one with a moulded rim below it."""
    ease = min(finishes.style.edge, 0.4 * (z[1] - z[0]))
    if finishes.style.ornament < 0.4:
        return [slab(edge, z, ease)]
    cut = z[1] - 0.45 * (z[1] - z[0])
    return [slab(edge * 0.965, (z[0], cut), 0.003), slab(edge, (cut, z[1]), min(ease, 0.4 * (z[1] - cut)))]


def legged_table(rng: np.random.Generator, w: float, d: float, h: float, finishes: Finishes, *, without: str = "") -> Shape:
    """Build a top on legs of the style's form, joined by rails between them."""
    t = float(rng.uniform(0.022, 0.036)) * min(finishes.style.slim, 1.15)
    kind = draw_kind(rng, finishes, without + (" bun" if h > 0.3 else ""))
    material = top_finish(rng, finishes)
    parts = pieces("top", top(outline(rng, finishes, w, d), (h - t, h), finishes), material)
    finish = leg_finish(finishes, kind)
    thick = (0.062 if h > 0.6 else 0.046) * finishes.style.slim
    room = 0.16 * min(w, d) if d > 0.9 * w else 0.05
    framed = kind in ("hairpin", "sled", "cross", "plank", "blade", "pipe")
    half = inside(kind, (w / 2 - room * 0.6 - (0.06 * w if kind in WIDE else 0), d / 2 - room * 0.6), h - t, thick)
    parts += pieces("legs", legs(kind, half, h - t, thick), finish)
    if kind in WIDE:  # a beam under the top keeps side frames apart
        parts += pieces("beam", box(around(half[0] - 0.032), (-0.02, 0.02), (h - t - 0.045, h - t - 0.001), 0.002), finish)
    if not framed:
        drop = (0.075 if h > 0.6 else 0.045) + 0.02 * finishes.style.ornament
        gap = 0.5 * thick + (0.004 if kind not in ("turned", "fluted") else 0.0)
        (x, y), z = half, (h - t - drop, h - t)
        rails = [box(around(x - gap), around(0.01, s * y), z, 0.002) for s in (-1, 1)]
        rails += [box(around(0.01, s * x), around(y - gap), z, 0.002) for s in (-1, 1)]
        parts += pieces("apron", rails, finish)
    return Shape(parts)


def dining_table(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Four legs, slab sides, a crossed base, a tulip foot, a drum, or a bar."""
    t = float(rng.uniform(0.026, 0.042))
    if form == "legs":
        return legged_table(rng, w, d, h, finishes, without="block")
    material = top_finish(rng, finishes, stone=1.8)
    under = h - t
    if form in ("tulip", "drum"):
        parts = pieces("top", top(circle(w / 2, 36), (under, h), finishes), material)
        if form == "drum":  # clad in upright half-round staves
            radius, r = 0.3 * w, math.pi * (0.3 * w) / 30
            staves = [rod(polar(radius + 0.85 * r, a, 0.0), polar(radius + 0.85 * r, a, under), 0.95 * r, n=6) for a in turns(30)]
            parts += pieces("drum", revolve([(radius, 0.0), (radius, under)], 24), finishes.body)
            return Shape(parts + pieces("staves", staves, finishes.body))
        return Shape(parts + pieces("pedestal", lathe("trumpet", 0.32 * w, under, 24), finishes.front))
    parts = pieces("top", top(outline(rng, finishes, w, d), (under, h), finishes), material)
    if form == "bar":
        return Shape(parts + _bar(w, d, h, t, finishes))
    if form == "cross":
        solids = [
            beam((s * (0.30 * w + dx), y, 0), (s * (0.14 * w * 0.4 + dx), y_top, under - 0.02), 0.06, 0.05)
            for dx, y, y_top in ((0.035, -0.32 * d, 0.3 * d), (0.105, 0.3 * d, -0.32 * d))
            for s in (-1, 1)
        ]
        solids.append(box(around(0.33 * w), around(0.36 * d), (under - 0.02, under), 0.003))
        return Shape(parts + pieces("cross", solids, finishes.handle if finishes.style.tube > 0.3 else finishes.timber))
    x, half = 0.32 * w, 0.025
    solids = [box(around(half, s * x), around(0.4 * d), (0, under), 0.006) for s in (-1, 1)]
    solids.append(box(around(x - half), (-0.016, 0.016), (0.55 * h, under), 0.003))
    return Shape(parts + pieces("slabs", solids, finishes.body))


def _bar(w: float, d: float, h: float, t: float, finishes: Finishes) -> Pieces:
    """Return a counter's front of upright boards on a plinth, a shelf behind it and a foot rail before it."""
    y, half = -0.22 * d, 0.45 * w
    boards = [box(x, (y, y + 0.02), (0.06, h - t), 0.003) for x in split(around(0.46 * w), max(5, round(w / 0.14)), 0.001)]
    sides = [box(around(0.012, s * half), (y + 0.02, 0.42 * d), (0.0, h - t), 0.002) for s in (-1, 1)]
    shelves = [box(around(half - 0.012), (y + 0.02, 0.4 * d), (z, z + 0.02)) for z in (0.1, 0.48 * h)]
    parts = pieces("front", boards, finishes.front) + pieces("sides", sides, finishes.body) + pieces("shelf", shelves, finishes.body)
    parts += pieces("plinth", box((-half, half), (y + 0.004, y + 0.02), (0.0, 0.06)), finishes.handle)
    rail = [rod((-half, y - 0.1, 0.17), (half, y - 0.1, 0.17), 0.014, n=10)]
    rail += [rod((s * 0.36 * w, y, 0.17), (s * 0.36 * w, y - 0.087, 0.17), 0.009, n=8) for s in (-1, 0, 1)]
    return parts + pieces("rail", rail, finishes.handle)


def cased_table(rng: np.random.Generator, w: float, d: float, h: float, finishes: Finishes, *, drawer_height: float, count: int) -> Shape:
    """Build a shallow case with a row of drawers on legs."""
    how = case_style(rng, finishes, "tapered square sled", (0.1, 0.2), "slab slab shaker")
    return case((w, d, h), grid(count, Cell("drawer")), replace(how, feet_height=max(0.05, h - drawer_height - 0.04)))


def coffee_table(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Legs with a lower shelf, a case with drawers, or a round tray."""
    if form == "drawer":
        return cased_table(rng, w, d, h, finishes, drawer_height=min(0.13, 0.42 * h), count=2 if w > 0.9 else 1)
    if form == "legs":
        shape = legged_table(rng, w, d, h, finishes, without="block plank")
        if h <= 0.3 or rng.random() >= 0.5:
            return shape
        lower = board(around(0.36 * w), around(0.34 * d), (0.26 * h, 0.26 * h + 0.016), 0.02, 2, 0.003)
        return Shape(shape.base + pieces("shelf", lower, cane(rng) if rng.random() < finishes.style.cane else finishes.body))
    under = h - 0.05
    parts = pieces("rim", ring((w / 2, w / 2), (w / 2 - 0.012, w / 2 - 0.012), (under, h), 36), finishes.handle)
    parts += pieces("tray", slab(circle(w / 2 - 0.0125, 36), (under, h - 0.03), 0.002), top_finish(rng, finishes))
    kind = draw_kind(rng, finishes, "plank cross sled block bun horse pipe")
    half = inside(kind, (0.36 * w, 0.36 * w), under, 0.04)
    return Shape(parts + pieces("legs", legs(kind, half, under, 0.04), leg_finish(finishes, kind)))


def corner_side_table(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Legs with a shelf, a pedestal or a drawer."""
    if form == "drawer":
        return cased_table(rng, w, d, h, finishes, drawer_height=0.12, count=1)
    if form == "legs":
        shape = legged_table(rng, w, d, h, finishes, without="block plank")
        if rng.random() >= 0.55:
            return shape
        lower = board(around(0.34 * w), around(0.32 * d), (0.3 * h, 0.3 * h + 0.014), 0.02, 2, 0.003)
        return Shape(shape.base + pieces("shelf", lower, finishes.body))
    parts = pieces("top", top(circle(w / 2, 32), (h - 0.024, h), finishes), top_finish(rng, finishes, stone=1.6))
    return Shape(parts + pieces("pedestal", pedestal(rng, finishes, 0.36 * w, h - 0.024), finishes.accent))


def round_end_table(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Three splayed legs, a drum with an open side, a tulip foot, or a tray on a tripod."""
    material = top_finish(rng, finishes, stone=1.4)
    under = h - (0.035 if form == "tray" else 0.022)
    if form == "drum":
        bow = arc((0.0, 0.0), 0.45 * w, -0.2 * math.pi, 1.2 * math.pi, 14)
        parts = pieces("top", slab(circle(w / 2, 32), (under, h), 0.004), material)
        parts += pieces("wall", wall(bow, 0.014, 0.02, under), finishes.front)
        parts += pieces("boards", slab(circle(0.44 * w, 28), (0.45 * h, 0.45 * h + 0.016)), finishes.body)
        return parts + pieces("foot", slab(circle(0.46 * w, 28), (0.0, 0.02), 0.003), finishes.body)
    if form == "tray":
        parts = pieces("rim", ring((w / 2, w / 2), (w / 2 - 0.008, w / 2 - 0.008), (under, h), 32), finishes.handle)
        parts += pieces("tray", slab(circle(w / 2 - 0.0085, 32), (under, h - 0.022)), material)
    else:
        parts = pieces("top", top(circle(w / 2, 32), (under, h), finishes), material)
    if form == "tulip":
        return parts + pieces("foot", lathe("trumpet", 0.34 * w, under, 24), finishes.front)
    angles = turns(3, -math.pi / 2)
    solids = [rod(polar(0.44 * w, a, 0), polar(0.2 * w, a, under - 0.012), 0.011, 0.018, 10) for a in angles]
    solids.append(slab(circle(0.27 * w, 24), (under - 0.012, under), 0.002))
    parts += pieces("legs", solids, finishes.timber if form == "tripod" else finishes.handle)
    if rng.random() < 0.4 and form == "tripod":
        shelf = prism(np.array([polar(0.26 * w, a) for a in angles]), "z", (0.38 * h, 0.38 * h + 0.014))
        parts += pieces("shelf", shelf, "glass" if rng.random() < 0.4 else finishes.body)
    return parts


def desk(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a desk with a pedestal of drawers, a row of drawers, or a plain top; tall ones carry a shelf at the back."""
    work = min(h, 0.78) if h > 0.95 else h
    if form == "pedestal":
        shape = _pedestal_desk(rng, w, d, work, finishes)
    elif form == "drawers":
        shape = cased_table(rng, w, d, work, finishes, drawer_height=0.11, count=2 if w < 1.5 else 3)
    else:
        table = legged_table(rng, w, d, work, finishes, without="block bun horse")
        panel = box(around(0.44 * w), (0.3 * d, 0.3 * d + 0.015), (0.4 * work, work - 0.05))
        shape = Shape(table.base + pieces("modesty", panel, finishes.body))
    if h - work <= 0.1:
        return shape
    y, t = (d / 2 - min(0.24, 0.4 * d), d / 2), 0.018
    spans = split((-w / 2 + 0.01, w / 2 - 0.01 - t), max(1, round(w / 0.7)))
    sides = [box((x, x + t), y, (work, h - t)) for x in (*(a for a, _ in spans), spans[-1][1])]
    hutch = pieces("hutch_sides", sides, finishes.body)
    hutch += pieces("hutch_top", box(around(w / 2 - 0.01), y, (h - t, h), 0.002), finishes.body)
    if h - work > 0.3:
        z = work + 0.55 * (h - work)
        boards = [box((a + t, b), (y[0] + 0.01, y[1]), (z, z + 0.016)) for a, b in spans]
        hutch += pieces("hutch_boards", boards, finishes.body)
    return join_shapes(shape, Shape(hutch))


def _pedestal_desk(rng: np.random.Generator, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a top on a chest of drawers at one side and a panel or a frame at the other."""
    t = 0.028
    style = front_style(rng, finishes, "slab slab shaker")
    side = -1 if rng.random() < 0.5 else 1
    wide = min(0.46, 0.32 * w)
    how = Case(finishes.body, style, "plinth", 0.04, finishes.body, top_thickness=0.016, inset=False)
    rows = int(rng.integers(2, 5))
    cells = tuple(Cell("drawer", 0.8 if k < rows - 1 else 1.3) for k in range(rows))
    chest = case((wide, d - 0.03, h - t), [Column(1, cells)], how)
    base = pieces("top", box(around(w / 2), around(d / 2), (h - t, h), 0.004), finishes.body)
    x = -side * (w / 2 - 0.03)
    if rng.random() < 0.5:
        base += pieces("panel", box(around(0.014, x), (-0.44 * d, 0.46 * d), (0, h - t), 0.002), finishes.body)
    else:
        posts = [box(around(0.02, x), around(0.02, s * 0.42 * d), (0, h - t), 0.003) for s in (-1, 1)]
        posts.append(box(around(0.015, x), around(0.42 * d - 0.02), (0.06, 0.09), 0.003))
        base += pieces("frame", posts, finishes.accent)
    inner = side * (w / 2 - 0.02 - wide)
    span = (min(inner, x), max(inner, x))
    base += pieces("modesty", box(span, (0.36 * d, 0.36 * d + 0.015), (0.45 * h, h - t)), finishes.body)
    return join_shapes(Shape(base), translate(chest, (side * (w / 2 - 0.02 - wide / 2), 0.0, 0.0), "pedestal_"))


def dressing_table(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a table with drawers and a mirror that stands at its back."""
    work = h if h < 0.95 else min(0.8, 0.62 * h)
    table = cased_table(rng, w, d, work, finishes, drawer_height=0.12, count=2 if w > 0.9 else 1)
    if h - work < 0.2:
        return table
    y = d / 2 - 0.05
    if form == "round_mirror":
        r = min(0.47 * (h - work), 0.4 * w)
        z, wood, feet = h - r, finishes.accent, "mirror_stem"
        glass = stand_up(revolve([(0.93 * r, 0.0), (0.93 * r, 0.006)], 28), (0, y, z))
        rim = stand_up(ring((r, r), (0.93 * r, 0.93 * r), (-0.008, 0.012), 28), (0, y, z))
        stand = [box((-0.02, 0.02), (y + 0.012, y + 0.03), (work, z), 0.003)]
    else:
        half, wood, feet = min(0.4 * w, 0.45), finishes.body, "mirror_feet"
        outer = Rect((-half, half), (work + 0.03, h), y)
        pane = outer.shrink(0.035)
        glass = [box(pane.x, (y + 0.006, y + 0.014), pane.z)]
        rim = frame(outer, pane, (y, y + 0.024), 0.003)
        stand = [box(around(0.02, s * 0.7 * half), (y + 0.004, y + 0.02), (work, work + 0.03)) for s in (-1, 1)]
    mirror = pieces("mirror", glass, "mirror", group="mirror") + pieces("mirror_frame", rim, wood, group="mirror")
    return join_shapes(table, Shape(mirror + pieces(feet, stand, wood)))
