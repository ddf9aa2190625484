"""Upholstery, and what is made of cloth: rugs, curtains, pillows, towels, throws, bath mats, blinds; the paper roll beside them. Lengths in metres."""

import itertools
import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.bent import wall
from pipeline.corpus.furniture.finishes import CLOTH_GROUNDS, COLORS, Finish, Finishes, Material, Pattern, cover, one_of, pick, tint
from pipeline.corpus.furniture.intervals import Interval, around, inset, split
from pipeline.corpus.furniture.shape import Pieces, pieces
from pipeline.corpus.furniture.solids import Solid, board, box, circle, cushion, pillow, ring, rod, rounded_rectangle, slab, stand_up

SEAM = 0.007  # height of a piping
TERRY = ("snow_cloth", "cream_cloth", "grey_cloth", "linen", "blue_cloth", "mint_cloth", "taupe_cloth", "rust_cloth", "charcoal")


def piping(rng: np.random.Generator, finishes: Finishes) -> Material | None:
    """Draw what a cushion's seams are piped with, if they are."""
    return finishes.second if rng.random() < finishes.style.piping else None


def seat_cushion(
    x: Interval, y: Interval, z: Interval, radius: float, cloth: Material, piping: Material | None = None, crown: float = 0.02
) -> Pieces:
    """Return a seat cushion with a swelling top; with `piping` a cord of that finish runs around its upper edge."""
    crown = min(crown, 0.3 * (z[1] - z[0]))
    if piping is None:
        return pieces("cushion", cushion(x, y, z, radius, 3, crown), cloth)
    cut = z[0] + 0.62 * (z[1] - crown - z[0])
    r = min(radius, 0.4 * (z[1] - crown - cut))
    inner_x, inner_y = inset(x, 0.004), inset(y, 0.004)
    cord = slab(rounded_rectangle(x, y, radius, 3), (cut, cut + SEAM), 0.002)
    lower = slab(rounded_rectangle(inner_x, inner_y, radius, 3), (z[0], cut), 0.006)
    upper = cushion(inner_x, inner_y, (cut + SEAM, z[1]), min(r, 0.03), 2, crown)
    return pieces("cushion", [lower, upper], cloth) + pieces("piping", cord, piping)


def tufted_panel(x: Interval, y: Interval, z: Interval, across: int, rows: int) -> list[Solid]:
    """Return an upright buttoned panel facing -y: a board behind a grid of small pads."""
    deep = y[1] - y[0]
    solids: list[Solid] = [cushion(x, (y[0] + 0.5 * deep, y[1]), z, 0.2 * deep, 1)]
    xs, zs = np.linspace(x[0] + 0.01, x[1] - 0.01, across + 1), np.linspace(z[0] + 0.01, z[1] - 0.01, rows + 1)
    for a, b in itertools.pairwise(xs):
        for c, e in itertools.pairwise(zs):
            solids.append(cushion((a + 0.001, b - 0.001), (y[0], y[0] + 0.5 * deep), (c + 0.001, e - 0.001), 0.45 * 0.5 * deep, 1))
    return solids


def upright_pad(rng: np.random.Generator, finishes: Finishes, x: Interval, y: Interval, z: Interval) -> list[Solid]:
    """Return an upright pad facing -y: plain, in channels, or buttoned, as the style likes."""
    wide, tall = x[1] - x[0], z[1] - z[0]
    u = rng.random()
    if u < 0.6 * finishes.style.tufts and wide > 0.3:
        return tufted_panel(x, y, z, max(2, round(wide / 0.17)), max(2, round(tall / 0.17)))
    if u < 0.9 * finishes.style.tufts + 0.08 and wide > 0.3:
        return channels(x, y, z, max(3, round(wide / 0.09)))
    radius = min(0.45 * (y[1] - y[0]), finishes.style.soft)
    return [cushion(x, y, z, radius, 3)]


def channels(x: Interval, y: Interval, z: Interval, count: int) -> list[Solid]:
    """Return an upright pad sewn in upright channels."""
    xs = np.linspace(x[0], x[1], count + 1)
    deep = y[1] - y[0]
    return [cushion((a + 0.0005, b - 0.0005), y, z, 0.42 * min(deep, float(b - a)), 2) for a, b in itertools.pairwise(xs)]


def bolster(x: Interval, y: float, z: float, radius: float) -> Solid:
    """Return a roll along x."""
    return rod((x[0], y, z), (x[1], y, z), radius, n=14)


def throw_pillow(at: tuple[float, float, float], size: float, tilt: float, yaw: float) -> Solid:
    """Return a pillow that stands on `at` and leans back by `tilt` [rad]; its lowest edge is at that height."""
    solid = pillow(around(size / 2), around(size / 2), around(0.15 * size), 2)
    solid = solid.rotate("x", np.pi / 2 - tilt).rotate("z", yaw)
    return solid.translate((at[0], at[1], at[2] - float(solid.vertices[:, 2].min())))


def duvet(x: Interval, y: Interval, z: float, thick: float, drop: float, cloth: Material) -> Pieces:
    """Return a cover that lies on a mattress at `z` and hangs over its sides by `drop`; x, y are the mattress's."""
    side = 0.55 * thick
    solids = [cushion(inset(x, -side), y, (z, z + thick), 0.45 * thick, 3, 0.25 * thick)]
    hems = ((x[0] - side, x[0]), (x[1], x[1] + side))
    solids += [cushion(hem, (y[0], y[1] - 0.01), (z - drop, z), 0.45 * side, 1) for hem in hems]
    return pieces("duvet", solids, cloth)


def rug(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a woven rug: bordered, with diamonds, striped, plain with a deep pile, or round; some with fringes."""
    classic = finishes.tradition != ""
    pattern: Pattern = pick(rng, "rug_border" if classic else "rug_diamonds rug_stripes rug_border boucle")  # type: ignore[assignment]
    if form == "round":
        pattern = "rug_border" if classic else "boucle"
    if form == "shaggy":
        pattern = "boucle"
    ground = finishes.soft if max(finishes.soft.color) > 0.1 or pattern != "boucle" else finishes.second
    light = CLOTH_GROUNDS if max(ground.color) < 0.45 else tint(rng, COLORS["taupe_cloth"], 0.3)
    weave = Finish("rug", tint(rng, ground.color, 0.08), 0.95, pattern=pattern, density=250, second=None if pattern == "boucle" else light)
    if form == "round":
        return pieces("rug", slab(circle(w / 2, 40), (0.0, h), min(0.004, 0.3 * h)), weave)
    fringe = 0.06 if form == "fringed" else 0.0
    edge = rounded_rectangle(around(w / 2), around(d / 2 - fringe), 0.012 if form != "shaggy" else 0.05, 2)
    parts = pieces("rug", slab(edge, (0.0, h), min(0.004, 0.3 * h)), weave)
    if fringe:
        count = max(12, round(w / 0.07))
        xs = np.linspace(-w / 2 + 0.01, w / 2 - 0.03, count)
        yarn = replace(weave, name="yarn", color=CLOTH_GROUNDS, pattern="plain", second=None)
        ends = [(-d / 2, -d / 2 + fringe), (d / 2 - fringe, d / 2)]
        parts += pieces("fringe", [box((float(x), float(x) + 0.018), end, (0.0, 0.5 * h)) for x in xs for end in ends], yarn)
    return parts


def curtain(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build curtains on a rod with knobs and rings: two panels drawn aside, or one sheet over the whole width."""
    cloth = finishes.soft if "leather" not in finishes.soft.pattern else cover(rng, "linen")
    rod_z = h - 0.03
    bar = [rod((-w / 2 + 0.03, 0, rod_z), (w / 2 - 0.03, 0, rod_z), 0.012, n=8)]
    for s in (-1, 1):
        bar.append(rod((s * (w / 2 - 0.03), 0, rod_z), (s * w / 2, 0, rod_z), 0.02, 0.012, 8))
        bar.append(box(around(0.008, s * (w / 2 - 0.06)), (0.012, d / 2), around(0.01, rod_z)))
    parts = pieces("rod", bar, finishes.handle)
    share = float(rng.uniform(0.16, 0.24)) if form == "drawn" else 0.5
    for s in (-1, 1):
        outer, inner = s * (w / 2 - 0.07), s * (w / 2 - 0.07 - share * (w - 0.14) + (0.002 if form != "drawn" else 0.0))
        folds = max(3, round(abs(inner - outer) / 0.11))  # the deeper, the more the panel is drawn aside
        t = np.linspace(0, 1, 4 * folds + 1)
        path = np.column_stack([outer + (inner - outer) * t, (0.5 * d - 0.004) * np.sin(2 * math.pi * folds * t)])
        parts += pieces("cloth", wall(path, 0.006, 0.0, rod_z - 0.03), cloth)
    if form == "drawn":
        return parts
    sheer = replace(cloth, name="sheer", color=(0.80, 0.79, 0.76), pattern="weave", second=None)
    return tuple(replace(p, finish=sheer) if p.finish is cloth else p for p in parts)


def cushion_pillow(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a throw pillow: square or oblong, or a round one."""
    cloth = finishes.second if rng.random() < 0.5 else finishes.soft
    if form == "round":
        rims: list[Solid] = ring((0.44 * w, 0.5 * w), (0.2 * w, 0.2 * w), (0.0, 0.5 * h), 20)
        rims += ring((0.5 * w, 0.44 * w), (0.2 * w, 0.2 * w), (0.5 * h, h), 20)
        middle = slab(circle(0.2 * w, 20), (0.06 * h, 0.94 * h), 0.01)
        return pieces("pillow", rims, cloth) + pieces("button", middle, cloth)
    return pieces("pillow", pillow(around(w / 2), around(d / 2), (0.0, h), 3), cloth)


def terry(rng: np.random.Generator, finishes: Finishes) -> Finish:
    """Draw the cloth of a towel: one in three in the colour of the style's covers."""
    name = one_of(rng, TERRY)
    color = finishes.soft.color if rng.random() < 0.33 else COLORS[name]
    return Finish("terry", tint(rng, color, 0.08), 0.95, pattern="boucle", density=150)


def towel(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a towel over a rail, two of them side by side, or one through a ring; the back is at the wall (+y)."""
    cloth, metal = terry(rng, finishes), finishes.handle
    if form == "ring":
        plate = box((-0.025, 0.025), (d / 2 - 0.012, d / 2), (h - 0.06, h - 0.01), 0.003)
        arm = rod((0.0, d / 2 - 0.012, h - 0.035), (0.0, 0.0, h - 0.035), 0.008)
        hoop = [box(around(0.24 * w), (-0.006, 0.006), (z, z + 0.012), 0.003) for z in (h - 0.16, h - 0.042)]
        sides = [box(around(0.005, s * 0.24 * w), (-0.006, 0.006), (h - 0.148, h - 0.042), 0.002) for s in (-1, 1)]
        parts = pieces("ring", [plate, arm, *hoop, *sides], metal)
        return parts + _towel_over_bar(around(0.22 * w), d, h - 0.152, h - 0.16, cloth, rng)
    z = h - 0.03
    bar = [rod((-w / 2, 0, z), (w / 2, 0, z), 0.009, n=8)]
    for s in (-1, 1):
        x = s * (w / 2 - 0.02)
        bar += [rod((x, d / 2, z), (x, 0.0, z), 0.009, n=8), rod((x, d / 2, z), (x, d / 2 - 0.01, z), 0.024, n=12)]
    parts = pieces("rail", bar, metal)
    if form == "single":
        return parts + _towel_over_bar(around(0.4 * w), d, z, z, cloth, rng)
    other = terry(rng, finishes)
    left = _towel_over_bar((-0.46 * w, -0.02 * w), d, z, z, cloth, rng)
    return parts + left + _towel_over_bar((0.02 * w, 0.46 * w), d, z, 0.8 * z, other, rng)


def _towel_over_bar(x: Interval, d: float, top: float, drop: float, cloth: Finish, rng: np.random.Generator) -> Pieces:
    """Return a towel over a bar at height `top`: the front fall `drop` long, the back one a little shorter, a border near the hem."""
    t, half = 0.012, 0.016
    front, back = top - drop, top - drop * float(rng.uniform(0.75, 0.9))
    falls = [cushion(x, y, (low, top + 0.006), 0.005) for y, low in (((-half - t, -half), front), ((half, half + t), back))]
    falls.append(cushion(x, around(half + t), (top + 0.004, top + 0.018), 0.006))
    hem = replace(cloth, name="hem", color=tuple(0.75 * c for c in cloth.color), pattern="weave")  # type: ignore[arg-type]
    band = box(inset(x, 0.001), (-half - t - 0.0015, -half - t + 0.001), (front + 0.05, front + 0.085))
    return pieces("towel", falls, cloth) + pieces("hem", band, hem)


def folded_towels(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a pile of folded towels, or three rolled ones."""
    parts: Pieces = ()
    if form == "rolled":
        r = min(w / 4, h / 3.6)
        spots = [(-r, r), (r, r), (0.0, r + 1.7 * r)]
        for x, z in spots:
            roll = slab(circle(r, 16), around(d / 2), 0.25 * r).rotate("x", math.pi / 2).translate((x, 0, z))
            parts += pieces("towel", roll, terry(rng, finishes))
        return parts
    count = max(2, round(h / 0.05))
    for k in range(count):
        cloth = terry(rng, finishes)
        dx, dy = (float(v) for v in rng.uniform(-0.012, 0.012, 2))
        across, along = (-w / 2 + 0.012 + dx, w / 2 - 0.012 + dx), (-d / 2 + 0.012 + dy, d / 2 - 0.012 + dy)
        parts += pieces("towel", cushion(across, along, (k * h / count, (k + 1) * h / count - 0.001), 0.02, 3), cloth)
    return parts


def throw(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a folded blanket with fringes at one side."""
    pattern = pick(rng, "knit check stripe boucle")
    cloth = Finish("throw", tint(rng, finishes.second.color, 0.1), 0.95, pattern=pattern, density=120)  # type: ignore[arg-type]
    layers = [cushion(around(w / 2), (-d / 2 + 0.04, d / 2), z, 0.4 * h / 3, 2) for z in split((0.0, h), 3)]
    yarn = replace(cloth, name="yarn", pattern="plain")
    xs = np.linspace(-w / 2 + 0.02, w / 2 - 0.032, 12).tolist()
    ends = [box((x, x + 0.012), (-d / 2, -d / 2 + 0.045), (0.35 * h, 0.42 * h)) for x in xs]
    return pieces("throw", layers, cloth) + pieces("yarn", ends, yarn)


def bath_mat(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bath mat: of terry with a border, or of wooden slats."""
    if form == "slats":
        count = max(5, round(w / 0.09))
        step = w / count
        slats = [box((-w / 2 + k * step, -w / 2 + (k + 0.8) * step), around(d / 2), (0.3 * h, h), 0.002) for k in range(count)]
        slats += [box(around(w / 2), around(0.015, s * 0.35 * d), (0.0, 0.3 * h)) for s in (-1, 1)]
        return pieces("mat", slats, finishes.timber)
    cloth = terry(rng, finishes)
    pile = replace(cloth, name="pile", color=tuple(0.85 * c for c in cloth.color))  # type: ignore[arg-type]
    mat = board(around(w / 2), around(d / 2), (0.0, 0.75 * h), 0.03, 2)
    field = board(around(w / 2 - 0.05), around(d / 2 - 0.05), (0.75 * h, h), 0.02, 2)
    return pieces("mat", mat, cloth) + pieces("pile", field, pile)


def blind(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a blind: a roller with its cloth, a pleated Roman one, or slats; the back is at the wall (+y)."""
    color = COLORS[pick(rng, "cream_cloth linen grey_cloth snow_cloth taupe_cloth")]
    cloth = Finish("blind", tint(rng, color, 0.06), 0.9, pattern="weave", density=300)
    top = h - 0.05
    rail = box(around(w / 2), around(d / 2), (top, h), 0.004)
    if form == "roller":
        sheet = box(around(w / 2 - 0.01), (-0.0015, 0.0015), (0.02, top))
        hem = rod((-w / 2 + 0.01, 0, 0.012), (w / 2 - 0.01, 0, 0.012), 0.012, n=8)
        return pieces("rail", rail, finishes.handle) + pieces("cloth", [sheet, hem], cloth)
    x = around(w / 2 - 0.005)
    if form == "roman":
        folds = max(3, round(h / 0.22))
        laps = [cushion(x, around(0.42 * d), (low, high - 0.004), 0.3 * d, 2) for low, high in split((0.0, top), folds)]
        return pieces("rail", rail, cloth) + pieces("cloth", laps, cloth)
    timber = finishes.timber if rng.random() < 0.6 else "slat"
    slat = box(x, around(0.4 * d), (-0.0015, 0.0015)).rotate("x", 0.6)
    levels = split((0.0, top), max(8, round(top / 0.05)))
    slats = [slat.translate((0, 0, (low + high) / 2)) for low, high in levels]
    cords = [box(around(0.003, s * 0.35 * w), (-0.003, 0.003), (0.0, top)) for s in (-1, 1)]
    return pieces("rail", rail, timber) + pieces("slats", slats, timber) + pieces("cords", cords, cloth)


def paper_holder(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a roll of paper on an arm, or on one under a lid; the back is at the wall (+y)."""
    r = 0.42 * h
    side, z, front = (-w / 2, -w / 2 + 0.014), (0.54 * h, 0.62 * h), d / 2 - r - 0.03
    arm = [box(side, (d / 2 - 0.012, d / 2), (0.3 * h, 0.9 * h), 0.002), box(side, (front, d / 2 - 0.012), z, 0.002)]
    arm.append(box((side[1], w / 2), (front, d / 2 - r - 0.018), z, 0.002))
    if form == "lid":
        arm.append(box((-w / 2 + 0.01, w / 2), around(d / 2), (h - 0.004, h)))
    roll = stand_up([slab(circle(r, 20), around(0.38 * w), 0.002)], (0, 0, 0))[0].rotate("z", math.pi / 2)
    sheet = box(around(0.36 * w), (d / 2 - 2 * r - 0.024, d / 2 - 2 * r - 0.022), (0.0, 0.45 * h))
    placed = roll.translate((0.005, d / 2 - r - 0.024, 0.5 * h))
    return pieces("arm", arm, finishes.handle) + pieces("roll", [placed, sheet], "paper")
