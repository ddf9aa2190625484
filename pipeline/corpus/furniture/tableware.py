"""What holds something: cups, plates, bowls, vases, baskets, bins, boxes; and books."""

import itertools
import math

import numpy as np

from pipeline.corpus.furniture.bent import blades, curve, prism, tube
from pipeline.corpus.furniture.finishes import COLORS, FINISHES, PROFILES, Finish, Finishes, Material, draw_material, one_of, pick, tint
from pipeline.corpus.furniture.fronts import Rect, lid
from pipeline.corpus.furniture.intervals import Interval, Spot, around, between, edges, inset, polar
from pipeline.corpus.furniture.shape import UP, Axis3, Mover, Pieces, Shape, pieces, staves
from pipeline.corpus.furniture.solids import Solid, at_height, box, circle, revolve, ring, slab, stack, walls

GLAZES = ("white", "ivory", "sage", "dusty_blue", "terracotta", "anthracite", "mustard", "blush", "navy", "greige")
BINDINGS = ("terracotta", "navy", "sage", "ivory", "anthracite", "mustard", "dusty_blue", "barn_red", "emerald", "greige", "blush", "black")


def glaze(rng: np.random.Generator) -> Finish:
    """Draw a glazed pottery."""
    name = one_of(rng, GLAZES)
    return Finish(f"glaze_{name}", tint(rng, COLORS[name], 0.06), 0.2, density=2200)


def vessel(profile: list[Spot], wall: float, floor: float, n: int) -> list[Solid]:
    """Return an open vessel: a wall `wall` [m] thick along a profile of (radius, height), a floor `floor` [m] thick."""
    solids = [slab(circle(profile[0][0], n), (profile[0][1], profile[0][1] + floor))]
    start = [(profile[0][0], profile[0][1] + floor), *profile[1:]]
    for (r0, z0), (r1, z1) in itertools.pairwise(start):
        solids += ring((r0, r1), (r0 - wall, r1 - wall), (z0, z1), n)
    return solids


def cup(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a mug with a handle, a tumbler of glass, or a bowl-shaped tea cup."""
    finish = glaze(rng)
    if form == "tumbler":
        return pieces("cup", vessel([(0.40 * w, 0.0), (0.5 * w, h)], 0.003, 0.006, 24), "clear_glass")
    r = 0.5 * d
    x = r - w / 2  # the body stands left of the middle, the handle is right of it
    mug, bowl_shaped = [(0.92, 0.0), (1.0, 0.12), (1.0, 1.0)], [(0.5, 0.0), (0.74, 0.14), (0.92, 0.45), (1.0, 1.0)]
    profile = [(a * r, b * h) for a, b in (mug if form == "mug" else bowl_shaped)]
    body = [s.translate((x, 0, 0)) for s in vessel(profile, 0.005, 0.006, 20)]
    edge = x + r - 0.004
    bow = ((edge - 0.1 * r, 0.82), (w / 2 - 0.004, 0.72), (w / 2 - 0.006, 0.4), (edge - 0.1 * r * (form != "mug"), 0.24))
    grip = tube(curve([(px, 0, z * h) for px, z in bow], 2), 0.0045, 6)
    return pieces("cup", body, finish) + pieces("handle", grip, finish)


def plate(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a flat plate, or a deep one, with a rim."""
    r = w / 2
    finish = glaze(rng) if rng.random() < 0.6 else "ceramic"
    well = 0.64 if form == "flat" else 0.52
    low = pieces("well", slab(circle(well * r, 24), (0.0, 0.3 * h)), finish)
    return low + pieces("rim", ring((well * r, r), (well * r - 0.003, r - 0.01), (0.3 * h, h), 24), finish)


def bowl(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bowl of pottery or wood."""
    r = w / 2
    finish = Finish("turned_wood", tint(rng, COLORS["beech"]), 0.5, pattern="grain", density=650) if form == "wood" else glaze(rng)
    profile = [(0.42 * r, 0.0), (0.78 * r, 0.32 * h), (0.95 * r, 0.7 * h), (r, h)]
    return pieces("bowl", vessel(profile, 0.006, 0.08 * h, 24), finish)


def vase(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bottle, a bellied or an upright vase, some with twigs in it."""
    finish = glaze(rng)
    tall, share, n = (0.55 * h, 0.42, 16) if form == "twigs" else (h, 1.0, 24)
    r = min(w, d) / 2 * share
    profile = [(a * r, b * tall) for a, b in PROFILES["upright_vase" if form == "twigs" else f"{form}_vase"]]
    lower, upper = profile[: len(profile) - 2], profile[len(profile) - 3 :]
    base = pieces("vase", revolve(curve(lower, 3).tolist(), n), finish)
    for (r0, z0), (r1, z1) in itertools.pairwise(upper):
        base += pieces("neck", ring((r0, r1), (0.78 * r0, 0.78 * r1), (z0, z1), n), finish)
    if form != "twigs":
        return base
    stems: list[Solid] = []
    roots, tips = [], []
    count = int(rng.integers(4, 7))
    for k in range(count):
        a = 2 * math.pi * k / count + float(rng.uniform(-0.4, 0.4))
        out, top = float(rng.uniform(0.5, 1.0)), h * float(rng.uniform(0.86, 1.0))
        x, y = (0.5 * w - 0.035) * out * math.cos(a), (0.5 * d - 0.035) * out * math.sin(a)
        path = curve([(0.1 * x, 0.1 * y, 0.8 * tall), (0.3 * x, 0.3 * y, 0.5 * (tall + top)), (x, y, top)], 2)
        stems += tube(path, np.linspace(0.003, 0.0018, len(path)), 4)
        for p in path[2:]:
            roots += [p - (0, 0, 0.01)] * 2
            tips += [p + polar(0.05, a + side * 0.9, 0.02) for side in (-1, 1)]
    color = FINISHES["leaf"].color if rng.random() < 0.6 else (0.40, 0.26, 0.10)
    green = Finish("dry_leaf", tint(rng, color, 0.25), 0.7, pattern="leaf", density=300)
    return base + pieces("stems", stems, "twig") + pieces("leaves", blades(np.array(roots), np.array(tips), 0.022), green)


def binding(rng: np.random.Generator) -> Finish:
    """Draw a book's cover."""
    name = one_of(rng, BINDINGS)
    return Finish(f"binding_{name}", tint(rng, COLORS[name], 0.12), 0.6, density=700)


def flat_book(rng: np.random.Generator, x: Interval, y: Interval, z: Interval) -> Pieces:
    """Return a book that lies flat: two boards, a spine at the left, the block of paper set back between them."""
    t = min(0.003, 0.2 * (z[1] - z[0]))
    boards = [box(x, y, (z[0], z[0] + t)), box(x, y, (z[1] - t, z[1])), box((x[0], x[0] + t), y, inset(z, t))]
    parts = pieces("cover", boards, binding(rng))
    return parts + pieces("pages", box((x[0] + t, x[1] - 0.004), inset(y, 0.004), inset(z, t)), "paper")


def book(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a book that lies, stands upright, or lies open."""
    if form != "open":
        return flat_book(rng, around(w / 2), around(d / 2), (0.0, h))
    t = min(0.0035, 0.2 * h)
    parts = pieces("cover", box(around(w / 2), around(d / 2), (0.0, t)), binding(rng))
    for s in (-1, 1):
        x0, x1 = between(s * (w / 2 - 0.005), s * 0.001)
        low, high = (h, 0.6 * h)[::s]  # the pages rise towards the fold
        block = np.array([(x0, t), (x1, t), (x1, high), (x0, low)])
        parts += pieces("pages", prism(block, "y", around(d / 2 - 0.005)), "paper")
    return parts


def book_stack(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a pile of books, or a row of upright ones."""
    parts: Pieces = ()
    if form == "row":
        x = -w / 2
        while x < w / 2 - 0.012:
            t = min(float(rng.uniform(0.018, 0.05)), w / 2 - x)
            tall, deep = h * float(rng.uniform(0.78, 1.0)), d * float(rng.uniform(0.8, 1.0))
            cover, skin, y = binding(rng), 0.0025, -d / 2
            inner = inset((x, x + t), skin)
            boards = [box(span, (y, y + deep), (0, tall)) for span in edges((x, x + t), skin)]
            parts += pieces("cover", [*boards, box(inner, (y, y + skin), (0, tall))], cover)
            parts += pieces("pages", box(inner, (y + skin, y + deep - 0.004), (0.003, tall - 0.004)), "paper")
            x += t + 0.0008
        return parts
    count = max(2, round(h / 0.035))
    levels = np.cumsum(rng.uniform(0.6, 1.4, count))
    levels = np.concatenate([[0.0], levels / levels[-1] * h])
    for k, z in enumerate(itertools.pairwise(levels.tolist())):
        share = 1.0 if k == 0 else float(rng.uniform(0.75, 0.98))
        dx, dy = (float(v) for v in rng.uniform(-0.5, 0.5, 2) * (1 - share))
        parts += flat_book(rng, (w * (dx - share / 2), w * (dx + share / 2)), (d * (dy - share / 2), d * (dy + share / 2)), z)
    return parts


def basket(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a woven basket, round or square, with two handles."""
    straw = Finish("straw", tint(rng, (0.52, 0.36, 0.18)), 0.9, pattern="cane", density=300, second=(0.22, 0.14, 0.07))
    body = h - 0.03
    top = body + 0.015
    if form == "round":
        squash = np.array([1, d / w, 1])
        wall = vessel([(0.40 * w, 0.0), (0.48 * w, 0.4 * body), (0.46 * w, body)], 0.012, 0.012, 18)
        solids = [s.scale(squash) for s in wall]
        rim = ring((0.5 * w, 0.5 * w), (0.46 * w, 0.46 * w), (body, top), 18, squash=d / w)
    else:
        t, x, y = 0.012, around(w / 2 - 0.006), around(d / 2 - 0.006)
        solids = [box(x, y, (0, t)), *walls(x, y, (t, body), t)]
        rim = walls(around(w / 2), around(d / 2), (body, top), 0.024, 0.004)
    rope = Finish("rope", COLORS["taupe_cloth"], 0.95, density=400)
    grips: list[Solid] = []
    for s in (-1, 1):
        x0 = s * (0.478 * w if form == "round" else w / 2 - 0.012)
        bow = ((-0.05, top - 0.002), (-0.03, h - 0.006), (0.03, h - 0.006), (0.05, top - 0.002))
        grips += tube(curve([(x0, py, z) for py, z in bow], 2), 0.005, 6)
    return pieces("basket", solids, straw) + pieces("rim", rim, straw) + pieces("grips", grips, rope)


def tray_walls(x: Interval, y: Interval, z: Interval, t: float, bevel: float = 0.0) -> list[Solid]:
    """Return a bottom and four walls of thickness `t` [m] that end at z[1]."""
    return [box(x, y, (z[0], z[0] + t), bevel), *walls(x, y, (z[0] + t, z[1]), t, bevel)]


def trash_can(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a bin: round with a pedal, square, with a lid that slides, or with one that swings in a hood."""
    finish = draw_material(rng, "steel", "plastic", Finish("enamel_bin", tint(rng, (0.6, 0.58, 0.52), 0.3), 0.35, density=900))
    top = h - 0.035
    cover_finish = finish if pick(rng, "same dark") == "same" else "plastic"
    if form in ("round", "pedal"):
        ahead = 0.045 if form == "pedal" else 0.0
        r = w / 2 - 0.006
        body = ring((0.92 * r, r), (0.92 * r - 0.009, r - 0.009), (0.03, top), 24)
        base = staves("body", body, finish) + pieces("foot", slab(circle(0.94 * r, 24), (0.0, 0.03), 0.004), "plastic")
        lid_parts = pieces("lid", revolve([(w / 2 - 0.004, top + 0.003), (w / 2 - 0.004, top + 0.015), (0.7 * r, h)], 24), cover_finish)
        movers = [lid("lid", lid_parts, (0.0, r + 0.002, top + 0.004), math.radians(80))]
        if form == "pedal":
            plate = box((-0.045, 0.045), (-r - ahead, -0.94 * r - 0.004), (0.022, 0.030), 0.002)
            at = (0.0, -r - 0.5 * ahead, 0.03)
            movers.append(Mover("pedal", pieces("pedal", plate, "steel"), "prismatic", (0, 0, -1), at, 0.016, "slider_button", "pedal", UP))
        return Shape(base, tuple(movers))
    x, y = (-w / 2 + 0.004, w / 2 - 0.004), (-d / 2 + 0.004, d / 2 - 0.004)
    if form == "swing":
        return _swing_bin(x, y, h, finish, cover_finish)
    base = pieces("body", tray_walls(x, y, (0.0, top), 0.009, 0.002), finish)
    corners = np.array([(-w / 2, -d / 2), (w / 2, -d / 2), (w / 2, d / 2), (-w / 2, d / 2)])
    low = at_height(corners, top + 0.003)
    shrink = 0.9 if form == "box" else 0.97
    rise = np.array([0, 0, h - top - 0.003])
    cover = pieces("lid", stack([low, low + np.array([0, 0, 0.012]), low * np.array([shrink, shrink, 1]) + rise]), cover_finish)
    if form == "box":
        return Shape(base, (lid("lid", cover, (0.0, d / 2, top + 0.003), math.radians(88)),))
    grip = box((-0.04, 0.04), (-0.012, 0.012), (h - 0.0005, h + 0.012), 0.003)
    cover += pieces("lid_grip", grip, "plastic", "line_fixed_handle")
    axis = (1.0, 0.0, 0.0) if rng.random() < 0.5 else (-1.0, 0.0, 0.0)
    return Shape(base, (Mover("lid", cover, "prismatic", axis, (0.0, 0.0, h), 0.8 * w, "slider_lid", "lid", UP),))


def _swing_bin(x: Interval, y: Interval, h: float, finish: Material, hood: Material) -> Shape:
    """Return a bin whose hood has a flap at its front: it hangs from its upper edge and is pulled outwards."""
    t, low = 0.009, 0.68 * h
    base = pieces("body", tray_walls(x, y, (0.0, low), t, 0.002), finish)
    over = [box(span, y, (low + 0.001, h)) for span in edges(x, t)]
    over.append(box(inset(x, t), y, (h - t, h), 0.002))
    over.append(box(inset(x, t), (y[1] - t, y[1]), (low + 0.001, h - t)))
    span = Rect((x[0] + t + 0.003, x[1] - t - 0.003), (low + 0.004, h - t - 0.003), y[0] + 0.001)
    flap = pieces("flap", box(span.x, (span.y, span.y + t), span.z, 0.002), hood, group="flap")
    sign = box((-0.05, 0.05), (span.y - 0.001, span.y), around(0.012, span.middle[1]))
    flap += pieces("flap_sign", sign, "plastic_white", group="flap")
    hinge = (0.0, span.y, span.z[1])
    mover = Mover("flap", flap, "revolute", (-1, 0, 0), hinge, math.radians(75), "hinge_lid", "lid")
    return Shape(base + pieces("hood", over, hood), (mover,))


def storage_box(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a box: a hinged lid with a latch strip, or a lid that slides off."""
    x, y = (-w / 2, w / 2), (-d / 2, d / 2)
    finish = finishes.body if form == "slide" or rng.random() < 0.5 else Finish("box_lacquer", finishes.front.color, 0.5, density=600)
    t = 0.009
    if form == "slide":
        top = h - 0.016
        base = pieces("walls", tray_walls(x, y, (0.0, top), t, 0.001), finish)
        plate = pieces("lid", box(x, y, (top + 0.002, h - 0.004), 0.002), finish, group="lid")
        notch = box((-0.4 * w, -0.34 * w), around(0.2 * d), (h - 0.004, h), 0.001)
        plate += pieces("lid_grip", notch, finish, "line_fixed_handle")
        return Shape(base, (Mover("lid", plate, "prismatic", (1, 0, 0), (0.0, 0.0, h), 0.85 * w, "slider_lid", "lid", UP),))
    front = y[0] + 0.008  # a tab stands out
    cover = min(0.05, 0.25 * h)
    low = h - cover
    base = pieces("walls", tray_walls(x, (front, y[1]), (0.0, low), t, 0.001), finish)
    lid_parts = pieces("lid", box(x, (front, y[1]), (h - t, h), 0.002), finish)
    rim = [box(span, (front, y[1]), (low + 0.002, h - t)) for span in edges(x, t)]
    rim += [box(inset(x, t), (a, a + t), (low + 0.002, h - t)) for a in (front, y[1] - t)]
    lid_parts += pieces("lid_rim", rim, finish)
    lid_parts += pieces("tab", box((-0.025, 0.025), (y[0], front), (low - 0.012, low + 0.02), 0.002), finishes.handle, "line_fixed_handle")
    corners = [box(around(0.012, sx * (w / 2 - 0.012)), (front - 0.001, front), (0.0, 0.03)) for sx in (-1, 1)]
    base += pieces("corners", corners, finishes.handle)
    return Shape(base, (lid("lid", lid_parts, (0.0, y[1], low + 0.002), math.radians(100)),))


def carton(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a carton: two long flaps meet over two short ones, which wait for them."""
    x, y, t = (-w / 2, w / 2), (-d / 2, d / 2), 0.008
    low = h - 2 * t - 0.003
    base = pieces("walls", tray_walls(x, y, (0.0, low), t), "cardboard")
    base += pieces("tape", box((-0.03, 0.03), (y[0] - 0.0006, y[0]), (0.35 * h, low)), "tape", group="tape")
    movers = []
    for name, side in (("flap_front", -1), ("flap_back", 1)):
        board = pieces(name, box(x, between(side * d / 2, side * 0.002), (low + t + 0.002, h)), "cardboard")
        edge: Axis3 = (0.0, side * d / 2, h)
        movers.append(Mover(name, board, "revolute", (-float(side), 0.0, 0.0), edge, math.radians(110), "hinge_lid", "lid", UP))
    for name, side in (("flap_left", -1), ("flap_right", 1)):
        span = between(side * w / 2, side * (w / 2 - 0.45 * min(d, w)))
        board = pieces(name, box(span, (y[0] + t + 0.003, y[1] - t - 0.003), (low + 0.001, low + t)), "cardboard")
        edge = (side * w / 2, 0.0, low + t)
        waits = ("flap_front", "flap_back")
        movers.append(Mover(name, board, "revolute", (0.0, float(side), 0.0), edge, math.radians(110), "hinge_lid", "lid", UP, after=waits))
    return Shape(base, tuple(movers))
