"""What hangs on walls (the back at the wall, +y), and what people leave about: frames, candles, trays, bottles, jars, toys, televisions."""

from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.bent import blades, curve, lean, tube, turns
from pipeline.corpus.furniture.finishes import COLORS, FINISHES, PALETTES, Finish, Finishes, Material, Pattern, one_of, pick, tint
from pipeline.corpus.furniture.fronts import Rect, frame
from pipeline.corpus.furniture.intervals import Interval, around, corners, polar
from pipeline.corpus.furniture.shape import Pieces, Shape, pieces
from pipeline.corpus.furniture.solids import Solid, Vector, box, circle, cushion, pillow, revolve, ring, rod, slab, stand_up
from pipeline.corpus.furniture.tableware import glaze


def frame_boards(w: float, h: float, wide: float, y: Interval, bevel: float = 0.002) -> list[Solid]:
    """Return four boards around a rectangle `w` x `h` whose lower edge is at z = 0."""
    x = w / 2
    return frame(Rect((-x, x), (0.0, h), y[0]), Rect(around(x - wide), (wide, h - wide), y[0]), y, bevel)


def picture(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a framed print with a mount, a bare canvas, or a pair of prints."""
    back = d / 2
    pattern: Pattern = pick(rng, "art_blocks art_hills art_circles art_lines")  # type: ignore[assignment]
    art = replace(FINISHES[f"print_{rng.integers(6)}"], pattern=pattern)
    if form == "canvas":
        return pieces("canvas", box(around(w / 2), (-back, back), (0.0, h), 0.003), art)
    frame = finishes.timber if rng.random() < 0.5 else finishes.handle
    spans = [(-w / 2, w / 2)] if form == "framed" else [(-w / 2, -0.02 * w), (0.02 * w, w / 2)]
    parts: Pieces = ()
    for k, (x0, x1) in enumerate(spans):
        wide = x1 - x0
        rim = 0.018 + 0.02 * finishes.style.ornament
        at = np.array([(x0 + x1) / 2, 0.0, 0.0])
        mount = 0.12 * min(wide, h)
        sheet = box(around(wide / 2 - rim), (back - 0.008, back), (rim, h - rim))
        inner = box(around(wide / 2 - rim - mount), (back - 0.011, back - 0.008), (rim + mount, h - rim - mount))
        parts += pieces(f"frame_{k}", [s.translate(at) for s in frame_boards(wide, h, rim, (-back, back))], frame)
        parts += pieces(f"mount_{k}", sheet.translate(at), "paper") + pieces(f"print_{k}", inner.translate(at), art)
    return parts


def mirror(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a mirror in a rectangular or a round frame, or in a sunburst."""
    back = d / 2
    frame = finishes.handle if rng.random() < 0.55 else finishes.timber
    if form == "rectangle":
        rim = 0.02 + 0.035 * finishes.style.ornament
        glass = box(around(w / 2 - rim), (back - 0.012, back - 0.004), (rim, h - rim))
        return Shape(pieces("frame", frame_boards(w, h, rim, (-back, back), 0.004), frame) + pieces("mirror", glass, "mirror"))
    r = min(w, h) / 2
    rim = 0.6 * r if form == "sunburst" else 0.93 * r
    outer = 1.06 * rim if form == "sunburst" else r
    parts = pieces("mirror", stand_up([slab(circle(rim, 36), (0.0, 0.006))], (0, back - 0.004, h / 2)), "mirror")
    parts += pieces("frame", stand_up(ring((outer, outer), (rim, rim), (0.0, d), 36), (0, back, h / 2)), frame)
    if form != "sunburst":
        return Shape(parts)
    y, lengths = back - 0.012, (r, 0.84 * r)
    rays = [rod(_upright(outer, a, y, h / 2), _upright(lengths[k % 2], a, y, h / 2), 0.007, 0.002, 6) for k, a in enumerate(turns(24))]
    return Shape(parts + pieces("rays", rays, frame))


def clock(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a round wall clock with a dial, or one with bare marks on a ring."""
    back, r = d / 2, w / 2
    at = (0, back, h / 2)
    rim = finishes.handle if rng.random() < 0.6 else finishes.timber
    if form == "dial":
        dial = "light_dial" if rng.random() < 0.7 else "dark_dial"
        parts = pieces("dial", stand_up([slab(circle(0.9 * r, 32), (0.0, 0.5 * d))], at), dial)
        return parts + pieces("rim", stand_up(ring((r, 0.97 * r), (0.9 * r, 0.9 * r), (0.0, d), 32), at), rim)
    hub = stand_up(revolve([(0.2 * r, 0.0), (0.2 * r, 0.7 * d), (0.12 * r, d)], 20), at)
    hoop = stand_up(ring((0.86 * r, 0.86 * r), (0.8 * r, 0.8 * r), (0.0, 0.4 * d), 32), at)
    mark = box(around(0.02 * r), (back - 0.8 * d, back - 0.4 * d), (0.74 * r, r))
    marks = [mark.rotate("y", a).translate((0, 0, h / 2)) for a in turns(12)]
    bars = [(box(around(0.015 * r), (back - 0.6 * d, back - 0.45 * d), (0.2 * r, q * r)), a) for q, a in ((0.5, 1.05), (0.72, -1.05))]
    hands = [bar.rotate("y", a).translate((0, 0, h / 2)) for bar, a in bars]
    spokes = [(_upright(0.2 * r, a, back - 0.15 * d, h / 2), _upright(0.8 * r, a, back - 0.15 * d, h / 2)) for a in turns(4)]
    parts = pieces("ring", hoop, rim) + pieces("hub", hub, rim)
    parts += pieces("spokes", [rod(*ends, 0.1 * d, n=6) for ends in spokes], rim) + pieces("marks", marks, rim)
    return parts + pieces("hands", hands, Finish("marks", tint(rng, COLORS["charcoal"], 0.1), 0.5, density=900))


def _upright(radius: float, angle: float, y: float, z: float) -> Vector:
    """Return the point at an angle around (y, z), in a plane that faces the front."""
    x, up = polar(radius, angle)
    return (x, y, z + up)


def television(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a flat television on a foot in the middle, or on two feet."""
    low = 0.06 * h
    panel = box(around(w / 2), (-0.015, 0.02), (low, h), 0.003)
    glass = box(around(w / 2 - 0.008), (-0.017, -0.015), (low + 0.016, h - 0.008))
    belly = box(around(0.3 * w), (0.02, 0.05), (low + 0.04, 0.6 * h), 0.01)
    if form == "foot":
        feet = [box(around(0.2 * w), around(d / 2), (0.0, 0.012), 0.003), box(around(0.04 * w), (0.0, 0.035), (0.012, low + 0.05))]
    else:
        feet = [box(around(0.012, s * 0.36 * w), around(d / 2), (0.0, 0.012), 0.003) for s in (-1, 1)]
        feet += [box(around(0.01, s * 0.36 * w), (-0.01, 0.015), (0.012, low)) for s in (-1, 1)]
    return pieces("panel", [panel, belly], "shell") + pieces("screen", glass, "screen") + pieces("feet", feet, "shell")


def photo_frame(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a framed photograph that leans back on a strut, upright or oblong."""
    paper = FINISHES[f"print_{rng.integers(6)}"]
    art = replace(paper, name="photo", roughness=0.4, pattern=pick(rng, "art_hills art_circles art_blocks"))  # type: ignore[arg-type]
    frame = finishes.timber if rng.random() < 0.5 else finishes.handle
    rim, front = 0.1 * w, -d / 2 + 0.006
    slope = 0.5 * d / h
    boards = lean(frame_boards(w, h, rim, around(0.006, front)), 0.0, slope)
    sheet = lean([box(around(w / 2 - rim), (front - 0.001, front + 0.004), (rim, h - rim))], 0.0, slope)
    strut = lean([box(around(0.1 * w), (d / 2 - 0.008, d / 2), (0.0, 0.75 * h))], 0.0, -0.45 * d / h)
    return pieces("frame", boards, frame) + pieces("photo", sheet, art) + pieces("strut", strut, "shell")


def candle(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a pillar candle on a dish, one in a glass, or a thin one on a stick."""
    r = w / 2
    wax = Finish("wax", tint(rng, one_of(rng, PALETTES["wax"]), 0.08), 0.5, density=900)
    wick = pieces("wick", rod((0, 0, 0.93 * h), (0, 0, h), 0.0015, n=6), "shell")
    if form == "glass":
        body = slab(circle(0.86 * r, 16), (0.02 * h, 0.62 * h))
        glass = ring((r, r), (0.87 * r, 0.87 * r), (0.0, 0.9 * h), 12)
        return pieces("wax", body, wax) + pieces("glass", glass, "clear_glass") + wick
    if form == "stick":
        stand = revolve([(r, 0.0), (0.9 * r, 0.04 * h), (0.2 * r, 0.09 * h), (0.16 * r, 0.42 * h)], 16)
        stand += revolve([(0.16 * r, 0.42 * h), (0.4 * r, 0.5 * h)], 12)
        body = slab(circle(0.24 * r, 12), (0.5 * h, 0.94 * h))
    else:
        stand = revolve([(0.8 * r, 0.0), (r, 0.05 * h), (0.95 * r, 0.08 * h)], 16)
        body = slab(circle(0.74 * r, 16), (0.08 * h, 0.94 * h), 0.004)
    return pieces("stick" if form == "stick" else "dish", stand, finishes.handle) + pieces("wax", body, wax) + wick


def tray(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a tray with a rim: oblong with two grips, or round."""
    finish = finishes.timber if rng.random() < 0.6 else finishes.front
    if form == "round":
        floor = slab(circle(0.49 * w, 24), (0.0, 0.25 * h))
        return Shape(pieces("floor", floor, finish) + pieces("rim", ring((w / 2, w / 2), (0.48 * w, 0.48 * w), (0.25 * h, h), 16), finish))
    half, rim = 0.006, (0.2 * h, 0.7 * h)
    x, y = w / 2 - half, d / 2 - half
    solids = [box(around(w / 2), around(d / 2), (0.0, 0.2 * h))]
    solids += [box(around(w / 2), around(half, s * y), rim) for s in (-1, 1)]
    solids += [box(around(half, s * x), around(y - half), rim) for s in (-1, 1)]
    grips = [box(around(half, s * x), (-0.06, 0.06), (0.7 * h, h), 0.002) for s in (-1, 1)]
    return Shape(pieces("tray", solids, finish) + pieces("grips", grips, finishes.handle))


def bottle(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bottle: of soap with a pump, of shampoo, of wine, of oil."""
    r = w / 2
    color = COLORS[pick(rng, "white sage blush ivory terracotta dusty_blue anthracite")]
    if form == "pump":
        body = revolve([(0.96 * r, 0.0), (r, 0.02 * h), (r, 0.6 * h), (0.4 * r, 0.7 * h)], 14)
        head = [rod((0, 0, 0.7 * h), (0, 0, 0.9 * h), 0.12 * r, n=8), slab(circle(0.34 * r, 10), (0.9 * h, h))]
        head.append(box((-0.9 * r, 0.0), around(0.1 * r), (0.93 * h, 0.98 * h)))
        soap = Finish("soap", tint(rng, color, 0.1), 0.3, density=900)
        return pieces("body", body, soap) + pieces("pump", head, finishes.handle)
    if form == "shampoo":
        finish: Material = Finish("plastic", tint(rng, color, 0.1), 0.35, density=900)
        body = [slab(circle(r, 14, squash=0.62), z) for z in ((0.0, 0.25 * h), (0.6 * h, 0.86 * h))]
        top = pieces("cap", slab(circle(0.6 * r, 12, squash=0.8), (0.86 * h, h), 0.003), "shell")
        band = slab(circle(r, 14, squash=0.62), (0.25 * h, 0.6 * h))
    else:
        finish = "wine_glass" if form == "wine" else "oil_glass"
        body = revolve([(0.95 * r, 0.0), (r, 0.02 * h), (r, 0.18 * h)], 14)
        body += revolve([(r, 0.48 * h), (r, 0.6 * h), (0.7 * r, 0.68 * h), (0.32 * r, 0.76 * h)], 14)
        top = pieces("neck", slab(circle(0.32 * r, 12), (0.76 * h, h), 0.002), finish)
        band = slab(circle(r, 14), (0.18 * h, 0.48 * h))
    return pieces("body", body, finish) + top + pieces("label", band, "label")


def canister(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a jar for the kitchen: of glass with what it holds, or of pottery, with a lid."""
    r = w / 2
    lid = finishes.timber if rng.random() < 0.6 else finishes.handle
    top = [slab(circle(0.96 * r, 16), (0.86 * h, 0.94 * h), 0.003), slab(circle(0.25 * r, 12), (0.94 * h, h), 0.002)]
    if form == "glass":
        food = Finish("food", tint(rng, one_of(rng, PALETTES["food"]), 0.15), 0.9, pattern="speckle", density=700)
        inside = slab(circle(0.9 * r, 16), (0.02 * h, 0.86 * h * float(rng.uniform(0.45, 0.9))))
        jar = ring((r, r), (0.91 * r, 0.91 * r), (0.0, 0.86 * h), 12)
        return pieces("food", inside, food) + pieces("jar", jar, "clear_glass") + pieces("lid", top, lid)
    body = revolve([(0.9 * r, 0.0), (r, 0.04 * h), (r, 0.82 * h), (0.92 * r, 0.86 * h)], 16)
    return pieces("jar", body, glaze(rng)) + pieces("lid", top, lid)


def kettle(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a kettle with spout and handle: an electric one on its base, or one for the stove."""
    r = 0.5 * min(d, 0.75 * w)
    x = -w / 2 + r
    finish: Material = "kettle_steel"
    if rng.random() >= 0.6:
        finish = Finish("enamel", tint(rng, COLORS[pick(rng, "white sage navy barn_red mint")]), 0.3, density=900)
    tall = 0.86 * h if form == "electric" else 0.7 * h
    body = revolve([(r, 0.0), (r, 0.1 * h), (0.94 * r, 0.4 * h), (0.72 * r, tall)], 18, (x, 0.0))
    top = [slab(circle(0.66 * r, 14, (x, 0.0)), (tall, tall + 0.02), 0.004)]
    top.append(slab(circle(0.16 * r, 10, (x, 0.0)), (tall + 0.02, tall + 0.04)))
    spout = rod((x - 0.75 * r, 0, 0.55 * tall), (-w / 2 - 0.01, 0, 0.86 * tall), 0.022, 0.012, 8)
    bow, thick = [(x - 0.7 * r, tall), (x - 0.5 * r, h - 0.012), (x + 0.5 * r, h - 0.012), (x + 0.7 * r, tall)], 0.009
    if form == "electric":
        side = [(w / 2 - 0.01, 0.86 * tall), (w / 2 - 0.012, 0.3 * tall)]
        bow, thick = [(x + 0.7 * r, 0.9 * tall), *side, (x + 0.9 * r, 0.16 * tall)], 0.011
    grip = tube(curve([(px, 0, z) for px, z in bow], 2), thick, 6)
    return pieces("body", [*body, spout], finish) + pieces("lid", top, "shell") + pieces("grip", grip, "shell")


def cutting_board(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a board that lies with a knife on it, or a block of knives."""
    timber = Finish("board", tint(rng, COLORS[pick(rng, "beech oak walnut bamboo")]), 0.5, pattern="grain", density=650)
    board = box(around(w / 2), around(d / 2), (0.0, 0.6 * h), 0.004)
    y = 0.2 * d
    blade = box((-0.1 * w, 0.3 * w), (y - 0.018, y + 0.012), (0.6 * h, 0.6 * h + 0.002))
    grip = box((-0.34 * w, -0.1 * w), around(0.011, y), (0.6 * h, h), 0.003)
    parts = pieces("board", board, timber) + pieces("blade", blade, "blade") + pieces("grip", grip, "shell")
    if form == "bread":
        loaf = cushion((-0.34 * w, 0.2 * w), (-0.42 * d, -0.02 * d), (0.6 * h, 0.6 * h + 0.075), 0.032, 3)
        parts += pieces("bread", loaf, Finish("crust", tint(rng, (0.42, 0.20, 0.06)), 0.9, pattern="speckle", density=300))
    return parts


def fruit_bowl(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bowl of fruit: wide and low, or on a foot."""
    r = w / 2
    finish = Finish("turned_wood", tint(rng, COLORS["walnut"]), 0.5, pattern="grain", density=650) if rng.random() < 0.5 else glaze(rng)
    low = 0.0 if form == "low" else 0.3 * h
    body = revolve([(0.4 * r, low), (0.75 * r, low + 0.14 * h), (r, low + 0.42 * h)], 18)
    if form == "foot":
        body += revolve([(0.55 * r, 0.0), (0.5 * r, 0.04 * h), (0.14 * r, 0.1 * h), (0.14 * r, low)], 14)
    q = 0.3 * r
    fruit: Pieces = ()
    for k, a in enumerate(turns(5, float(rng.uniform(0, 1)))):
        x, y, z = polar(0.52 * r, a, low + 0.42 * h + 0.5 * q)
        fruit += _fruit(rng, (x, y, z), q, k)
    return pieces("bowl", body, finish) + fruit + _fruit(rng, (0.0, 0.0, h - q), q, 5)


def _fruit(rng: np.random.Generator, at: tuple[float, float, float], r: float, number: int) -> Pieces:
    color = one_of(rng, PALETTES["fruit"])
    rounds = [(0.3 * r, -r), (0.75 * r, -0.75 * r), (r, -0.1 * r), (0.8 * r, 0.7 * r), (0.3 * r, r)]
    solids = [s.translate(at) for s in revolve(rounds, 10)]
    return pieces(f"fruit_{number}", solids, Finish("fruit", tint(rng, color, 0.2), 0.4, density=800))


def toy(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a toy: a bear that sits, a ball, a car, or a tower of blocks."""
    bright = [Finish(f"paint_{n}", tint(rng, COLORS[n], 0.1), 0.35, density=300) for n in ("coral", "sky", "lemon", "mint")]
    if form == "ball":
        r = min(w, d, h) / 2
        profile = [(0.38 * r, -0.92 * r), (0.8 * r, -0.6 * r), (r, 0.0), (0.8 * r, 0.6 * r), (0.38 * r, 0.92 * r)]
        return pieces("ball", [s.translate((0, 0, 0.92 * r)) for s in revolve(profile, 16)], one_of(rng, bright))
    if form == "blocks":
        b = h / 3
        parts: Pieces = ()
        for k, (x, y, level) in enumerate(((-0.6 * b, 0.0, 0), (0.6 * b, 0.1 * b, 0), (0.0, 0.0, 1), (0.05 * b, 0.0, 2))):
            block = box(around(b / 2, x), around(b / 2, y), (level * b, (level + 1) * b - 0.0005), 0.003)
            parts += pieces(f"block_{k}", block, bright[k])
        return parts
    if form == "car":
        body = [cushion(around(w / 2), around(0.4 * d), (0.16 * h, 0.6 * h), 0.02, 2)]
        body.append(cushion((-0.28 * w, 0.3 * w), around(0.34 * d), (0.6 * h, h), 0.02, 2))
        wheel = slab(circle(0.18 * h, 12), around(0.06 * d))
        wheels = [s for x, y in corners(0.3 * w, 0.42 * d) for s in stand_up([wheel], (x, y, 0.18 * h))]
        return pieces("body", body, one_of(rng, bright)) + pieces("wheels", wheels, "shell")
    fur = Finish("fur", tint(rng, (0.36, 0.22, 0.10) if rng.random() < 0.6 else (0.66, 0.58, 0.48)), 0.95, pattern="boucle", density=80)
    bear = [pillow(around(0.26 * w), (-0.2 * d, 0.35 * d), (0.0, 0.58 * h), 3)]
    bear.append(pillow(around(0.24 * w), around(0.26 * d), (0.52 * h, 0.95 * h), 3))
    bear += [cushion(around(0.07 * w, s * 0.17 * w), (-0.03 * d, 0.05 * d), (0.84 * h, h), 0.012, 2) for s in (-1, 1)]  # ears
    bear += [cushion(around(0.1 * w, s * 0.32 * w), (-0.25 * d, 0.05 * d), (0.22 * h, 0.5 * h), 0.025, 2) for s in (-1, 1)]  # arms
    bear += [cushion(around(0.11 * w, s * 0.24 * w), (-0.5 * d, 0.0), (0.0, 0.2 * h), 0.02, 2) for s in (-1, 1)]  # legs
    return pieces("bear", bear, fur)


def pen_cup(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a cup with pens in it, round or square."""
    r, tall = w / 2, 0.55 * h
    cup = slab(circle(r, 14), (0.0, tall)) if form == "round" else box((-r, r), (-r, r), (0.0, tall), 0.003)
    parts = pieces("cup", cup, finishes.front if rng.random() < 0.5 else finishes.handle)
    for k, a in enumerate(turns(4, float(rng.uniform(0, 1)))):
        pen = rod(polar(0.4 * r, a, tall), polar(0.8 * r, a, h * float(rng.uniform(0.86, 1.0))), 0.0045, n=6)
        ink = tint(rng, COLORS[pick(rng, "black navy coral mustard emerald")])
        parts += pieces(f"pen_{k}", pen, Finish("pen", ink, 0.4, density=900))
    return parts


def alarm_clock(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build an alarm clock: a round one on four feet, or a box with figures."""
    if form == "box":
        case = box(around(w / 2), (-d / 2 + 0.002, d / 2), (0.0, h), 0.006)
        figures = box(around(0.42 * w), (-d / 2, -d / 2 + 0.002), (0.2 * h, 0.8 * h))
        return pieces("case", case, finishes.timber) + pieces("figures", figures, "figures")
    r = min(w, 0.86 * h) / 2
    z = h - r
    body = stand_up([slab(circle(r, 20), (0.0, 0.7 * d))], (0, 0.35 * d, z))
    body += [rod((s * 0.6 * r, t * 0.3 * d, 0.0), (s * 0.45 * r, t * 0.2 * d, z - 0.8 * r), 0.006, n=6) for s, t in corners(1, 1)]
    dial = stand_up([slab(circle(0.88 * r, 20), (0.0, 0.004))], (0, -0.35 * d, z))
    return pieces("case", body, finishes.handle) + pieces("dial", dial, "light_dial")


def tissue_box(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a box of tissues, oblong or a cube, with one drawn out."""
    x = w / 2 if form == "flat" else min(w, d) / 2
    finish = finishes.timber
    if rng.random() >= 0.4:
        finish = Finish("card", tint(rng, COLORS[pick(rng, "white sage blush dusty_blue greige")]), 0.7, density=300)
    body = box((-x, x), around(d / 2), (0.0, 0.7 * h), 0.003)
    sheet = blades(np.array([(0, 0, 0.69 * h), (0.004, 0, 0.69 * h)]), np.array([(-0.02, 0.006, h), (0.025, -0.006, 0.94 * h)]), 0.07)
    return pieces("box", body, finish) + pieces("tissue", sheet, "paper")


def coat_hooks(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a board with hooks, a coat or a bag on some of them; the back is at the wall (+y)."""
    back = d / 2
    count = max(4, round(w / 0.14))
    xs = np.linspace(-w / 2 + 0.06, w / 2 - 0.06, count).tolist()
    hooks: list[Solid] = []
    for x in xs:
        hooks.append(rod((x, back - 0.018, h - 0.05), (x, back - 0.07, h - 0.05), 0.006, n=6))
        hooks.append(rod((x, back - 0.066, h - 0.055), (x, back - 0.07, h - 0.02), 0.007, n=6))
    parts = pieces("board", box(around(w / 2), (back - 0.018, back), (h - 0.1, h), 0.003), finishes.timber)
    parts += pieces("hooks", hooks, finishes.handle)
    for k in (1, count - 2) if form != "bare" else ():
        x = xs[k]
        color = tint(rng, COLORS[pick(rng, "charcoal indigo_cloth taupe_cloth rust_cloth grey_cloth")], 0.1)
        bag = [cushion(around(0.1, x), (-d / 2, back - 0.02), (0.0, 0.55 * h), 0.03, 3)]
        bag += [box(around(0.006, x + s * 0.05), (-0.005, 0.005), (0.5 * h, h - 0.06)) for s in (-1, 1)]
        bag.append(box(around(0.056, x), (-0.005, 0.005), (h - 0.06, h - 0.045)))
        parts += pieces(f"bag_{k}", bag, Finish("coat", color, 0.9, pattern="weave", density=200))
    return parts


def potted_herb(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a small plant in a pot: a succulent's rosette, a tuft of herbs, or a trailing one."""
    tall, count, rise = {"succulent": (0.62 * h, 14, 0.6), "herb": (0.45 * h, 26, 1.0), "grass": (0.4 * h, 22, 1.0)}[form]
    r = 0.36 * w
    pot = glaze(rng) if rng.random() < 0.7 else "ceramic"
    parts = pieces("pot", revolve([(0.74 * r, 0.0), (r, tall)], 14), pot)
    parts += pieces("soil", slab(circle(0.86 * r, 12), (tall, tall + 0.002)), "shell")
    green = Finish("leaf", tint(rng, FINISHES["leaf"].color, 0.25), 0.6, pattern="leaf", density=300)
    angle = np.arange(count) * 2.4
    share = (np.arange(count) + 1) / count
    out = (1 - 0.7 * share) * 0.5 * w if form != "herb" else rng.uniform(0.1, 1.0, count) * 0.5 * w
    tips = np.column_stack([out * np.cos(angle), out * np.sin(angle), tall + (h - tall) * rise * (0.35 + 0.65 * share)])
    if form == "herb":
        roots = tips * (0.55, 0.55, 1.0) - (0.0, 0.0, 0.03)
        stems = [rod((0.2 * x, 0.2 * y, tall), (x, y, z), 0.002, n=4) for x, y, z in roots[::3].tolist()]
        return parts + pieces("stems", stems, green) + pieces("leaves", blades(roots, tips, 0.32 * w), green)
    roots = np.column_stack([0.2 * r * np.cos(angle), 0.2 * r * np.sin(angle), np.full(count, tall)])
    width, thick = (0.22 * w, 0.014) if form == "succulent" else (0.06 * w, 0.003)
    return parts + pieces("leaves", blades(roots, tips, width, thick=thick), green)
