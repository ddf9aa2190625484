"""Electronics on desks and tables: laptop, remote control, telephone, camera, keyboard, printer."""

import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.finishes import DARK_GLASS, GRAPHITE, PLASTIC, PLASTIC_WHITE, STEEL, Finish, Scheme, one_of, shade
from pipeline.corpus.furniture.fronts import FrontStyle, Rect, button, drawer, lid, top_button, top_knob
from pipeline.corpus.furniture.intervals import around, edges, inset, split
from pipeline.corpus.furniture.shape import Mover, Pieces, Shape, Size, pieces
from pipeline.corpus.furniture.solids import Solid, box, circle, cushion, revolve, slab, standing

SILVER = Finish("aluminium", (0.60, 0.61, 0.62), 0.3, 0.8, density=1400)
DARK = Finish("shell_dark", (0.035, 0.036, 0.04), 0.4, density=1200)
PALE = Finish("shell_pale", (0.70, 0.70, 0.68), 0.4, density=1200)
KEY = Finish("keys", (0.02, 0.02, 0.022), 0.55, density=1000)
KEY_PALE = Finish("keys_pale", (0.58, 0.58, 0.57), 0.55, density=1000)
SIGNAL = Finish("signal", (0.55, 0.05, 0.04), 0.4, density=1000)
RUBBER = Finish("rubber", (0.015, 0.015, 0.016), 0.8, density=1100)


def laptop(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a closed laptop: a deck of keys and a touch pad under a screen that opens past the upright."""
    w, d, h = size
    finish = one_of(rng, (SILVER, DARK))
    deck = 0.56 * h
    x, y = around(w / 2), around(d / 2)
    feet = [box(around(0.02, s * 0.4 * w), around(0.4 * d), (0, 0.0015)) for s in (-1, 1)]
    keys: list[Solid] = []
    rows, pitch = 5, 0.42 * d / 5
    for r in range(rows):
        span = (0.38 * d - (r + 1) * pitch + 0.0015, 0.38 * d - r * pitch)
        keys += [box(place, span, (deck, deck + 0.001)) for place in split(around(0.44 * w), 12 if r < rows - 1 else 5, 0.001)]
    pad = box(around(0.16 * w), (-0.42 * d, -0.12 * d), (deck, deck + 0.0005))
    base = pieces("deck", box(x, y, (0.0015, deck), 0.002), finish, group="deck") + pieces("feet", feet, RUBBER, group="deck")
    base += pieces("keys", keys, KEY if finish is SILVER else RUBBER, group="deck")
    base += pieces("touch_pad", pad, Finish("touch_pad", (0.42, 0.42, 0.43), 0.35, density=1200), group="deck")
    low = deck + 0.0035
    pane = box(inset(x, 0.009), (y[0] + 0.014, y[1] - 0.018), (low - 0.0016, low - 0.0008))
    cover = pieces("screen_back", box(x, y, (low, h), 0.002), finish, group="screen")
    cover += pieces("bezel", box(inset(x, 0.003), (y[0] + 0.003, y[1] - 0.006), (low - 0.0008, low)), PLASTIC, group="screen")
    cover += pieces("display", pane, Finish("display", (0.03, 0.06, 0.11), 0.12, density=2500), group="screen")
    return Shape(base, (lid("screen", cover, (0.0, d / 2, low), math.radians(125)),))


def remote(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a remote control: a slim body with a round pad and rows of buttons; a simple one has few."""
    w, d, h = size
    top = h - 0.003
    finish = one_of(rng, (DARK, DARK, PALE))
    cap = PLASTIC_WHITE if finish is DARK else PLASTIC
    base = pieces("body", cushion(around(w / 2), around(d / 2), (0, top), 0.006), finish)
    base += pieces("window", box(around(0.3 * w), (d / 2 - 0.012, d / 2 - 0.004), (top - 0.0005, top + 0.0004)), DARK_GLASS)
    r = 0.3 * w
    base += pieces("pad", slab(circle(r, 20, (0.0, 0.16 * d)), (top, top + 0.001)), Finish("pad", (0.10, 0.10, 0.105), 0.4, density=1000))
    rows, columns = (3, 3) if form == "grid" else (2, 2)
    movers = [_key("power", 0.0, 0.40 * d, 0.14 * w, 0.14 * w, top, SIGNAL)]
    movers.append(_key("select", 0.0, 0.16 * d, 0.2 * r, 0.2 * r, top + 0.001, cap, rise=0.002))
    pitch_x, pitch_y = 0.84 * w / columns, 0.44 * d / rows
    for k in range(rows * columns):
        x = (k % columns - (columns - 1) / 2) * pitch_x
        y = -0.03 * d - (k // columns + 0.5) * pitch_y + (0.02 * d if form == "grid" else 0.0)
        movers.append(_key(f"key_{k}", x, y, 0.34 * pitch_x, 0.3 * pitch_y, top, cap))
    return Shape(base, tuple(movers))


def _key(name: str, x: float, y: float, half_x: float, half_y: float, top: float, finish: Finish, rise: float = 0.003) -> Mover:
    """Return a key on a level top that goes down by 1 mm."""
    return top_button(name, around(half_x, x), around(half_y, y), (top + 0.0012, top + max(rise, 0.002)), finish, 0.001)


def phone(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a telephone that lies on its back: all screen with keys at its side, a keypad, or one that flips open."""
    w, d, h = size
    finish = one_of(rng, (DARK, SILVER, Finish("shell_blue", shade(rng, (0.04, 0.09, 0.2), 0.3), 0.3, density=1500)))
    x, y = (-w / 2, w / 2), (-d / 2, d / 2)
    if form == "smart":
        side = w / 2 - 0.0014
        base = pieces("body", cushion((-side, side), y, (0.0012, h - 0.0006), 0.004), finish, group="body")
        base += pieces("glass", box(around(side - 0.0025), inset(y, 0.0025), (h - 0.0008, h)), DARK_GLASS, group="body")
        base += pieces("camera", revolve([(0.008, 0.0), (0.008, 0.0012)], 12, (-side + 0.02, y[1] - 0.02)), DARK_GLASS, group="body")
        spots = (("power", 1.0, 0.16, 0.06), ("louder", -1.0, 0.22, 0.05), ("softer", -1.0, 0.08, 0.05))
        movers = []
        for name, s, at, half in spots:
            edge = sorted((s * (side + 0.0006), s * (side + 0.0014)))
            cap = box((edge[0], edge[1]), ((at - half) * d, (at + half) * d), (0.4 * h, 0.7 * h))
            middle = (s * (side + 0.001), at * d, 0.55 * h)
            movers.append(
                Mover(name, pieces("button", cap, finish), "prismatic", (-s, 0, 0), middle, 0.0005, "slider_button", "button", (s, 0, 0))
            )
        return Shape(base, tuple(movers))
    flips = form == "flip"
    top = 0.5 * h - 0.0028 if flips else h - 0.003
    base = pieces("body", box(x, y, (0, top), 0.002), finish, group="body")
    if not flips:
        base += pieces("display", box(around(0.4 * w), (0.1 * d, 0.44 * d), (top, top + 0.0006)), DARK_GLASS, group="body")
    reach = (-0.45 * d, 0.04 * d if not flips else 0.4 * d)
    pitch_x, pitch_y = 0.84 * w / 3, (reach[1] - reach[0]) / 4
    keys = PLASTIC_WHITE if finish is not SILVER else PLASTIC
    movers = [
        _key(f"key_{k}", (k % 3 - 1) * pitch_x, reach[1] - (k // 3 + 0.5) * pitch_y, 0.4 * pitch_x, 0.34 * pitch_y, top, keys, 0.0024)
        for k in range(12)
    ]
    if not flips:
        return Shape(base, tuple(movers))
    low = top + 0.0036
    cover = pieces("cover", box(x, y, (low, h), 0.002), finish, group="cover")
    cover += pieces("display", box(around(0.4 * w), (-0.4 * d, 0.3 * d), (low - 0.0006, low)), DARK_GLASS, group="cover")
    return Shape(base, (lid("cover", cover, (0.0, d / 2, low), math.radians(140)), *(replace(m, after=("cover",)) for m in movers)))


def camera(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a camera: a body with a lens, a release, dials, and a flash that folds up on the larger one."""
    w, d, h = size
    reflex = form == "reflex"
    face, back = -0.06 * d, 0.5 * d
    finish = DARK if reflex or rng.random() < 0.4 else SILVER
    top = 0.78 * h if reflex else h - 0.012
    r, out = min(0.40 * top, 0.26 * w), face + d / 2  # how far the lens stands out
    lens = ((0.05 if reflex else 0.12) * w, face, 0.48 * top)
    barrel = [(r, 0.0), (r, 0.35 * out), (0.88 * r, 0.36 * out), (0.88 * r, 0.55 * out)]
    base = pieces("body", cushion(around(w / 2), (face, back), (0, top), 0.008), finish)
    base += pieces("leather", box(around(0.48 * w), (face - 0.0006, face + 0.002), (0.14 * top, 0.78 * top)), RUBBER, group="leather")
    base += pieces("lens", standing(revolve(barrel, 16), lens), PLASTIC, group="lens")
    zoom = pieces("zoom_ring", standing(revolve([(0.93 * r, 0.57 * out), (0.93 * r, 0.96 * out)], 16), lens), RUBBER, group="zoom")
    zoom += pieces("lens_glass", standing(revolve([(0.55 * r, 0.96 * out), (0.5 * r, out)], 16), lens), DARK_GLASS, group="zoom")
    at = (lens[0], face - 0.57 * out, lens[2])
    y = (face + back) / 2
    movers = [Mover("zoom", zoom, "revolute", (0, 1, 0), at, 0.5 * math.pi, "hinge_knob", "knob")]
    movers.append(top_knob("mode", (0.36 * w, y, top), 0.11 * w if reflex else 0.085 * w, PLASTIC, depth=0.009))
    cap = STEEL if finish is DARK else PLASTIC
    movers.append(top_button("release", (-0.42 * w, -0.32 * w), around(0.006, y), (top + 0.002, top + 0.005), cap, 0.0015))
    if not reflex:
        movers.append(top_knob("exposure", (0.12 * w, y, top), 0.07 * w, PLASTIC, depth=0.007))
        window = box((-0.4 * w, -0.26 * w), (face - 0.001, face + 0.002), (0.8 * top, 0.93 * top))
        base += pieces("shoe", box((-0.10 * w, 0.02 * w), around(0.008, y), (top, h)), STEEL)
        return Shape(base + pieces("finder", window, DARK_GLASS, group="finder"), tuple(movers))
    prism, low = (-0.13 * w, 0.23 * w), h - 0.0115
    base += pieces("prism", box(prism, (y, back), (top, h - 0.012), 0.006), finish)
    flash = pieces("flash", box(prism, (face + 0.004, back), (low, h), 0.003), finish)
    return Shape(base, (*movers, lid("flash", flash, (0.05 * w, back, low), math.radians(60))))


def keyboard(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a keyboard: rows of keys with a space bar, or a block of figures."""
    w, d, h = size
    top = h - 0.006
    finish = one_of(rng, (DARK, SILVER, PALE))
    cap = one_of(rng, (KEY_PALE, PLASTIC_WHITE)) if finish is not SILVER else KEY
    feet = [box(around(0.45 * w), around(0.006, s * 0.4 * d), (0, 0.002)) for s in (-1, 1)]
    base = pieces("board", box(around(w / 2), around(d / 2), (0.002, top), 0.003), finish, group="board")
    base += pieces("feet", feet, RUBBER, group="board")
    rows = [9, 9, 8, 8] if form == "rows" else [4, 4, 4, 3]
    pitch = 0.94 * d / (len(rows) + (1 if form == "rows" else 0))
    z = (top + 0.0028, h)
    movers = []
    for r, count in enumerate(rows):
        y = 0.47 * d - (r + 1) * pitch
        for k, x in enumerate(split(around(0.485 * w), count, 0.002)):
            movers.append(top_button(f"key_{r}_{k}", x, (y + 0.002, y + pitch - 0.002), z, cap, 0.0025))
    if form == "rows":
        y = -0.47 * d
        for name, a, b in (("left", -0.485, -0.3), ("space", -0.29, 0.25), ("right", 0.26, 0.485)):
            movers.append(top_button(f"key_{name}", (a * w, b * w), (y, y + pitch - 0.004), z, cap, 0.0025))
    return Shape(base, tuple(movers))


def printer(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a printer: a paper drawer below, a gap where sheets come out, a panel of buttons, a scanner's lid on top."""
    w, d, h = size
    finish = one_of(rng, (PALE, DARK, GRAPHITE))
    trim = PLASTIC if finish is PALE else Finish("trim", (0.16, 0.16, 0.17), 0.4, density=1000)
    x, y, t = (-w / 2, w / 2), (-d / 2 + 0.012, d / 2), 0.012
    tray = 0.30 * h
    cover = 0.16 * h if form == "scanner" else 0.05 * h
    top = h - cover - 0.003
    style = FrontStyle("slab", "edge", trim, PLASTIC, thickness=0.012)
    base = pieces("sides", [box(span, y, (0.006, top), 0.003) for span in edges(x, t)], finish)
    inner = inset(x, t)
    base += pieces("bottom", box(inner, y, (0.006, 0.018)), finish) + pieces("back", box(inner, (y[1] - t, y[1]), (0.018, top)), finish)
    base += pieces("deck", box(inner, (y[0] + 0.004, y[1] - t), (tray, tray + 0.012)), trim)
    base += pieces("head", box(inner, (y[0] + 0.002, y[1] - t), (0.58 * h, top), 0.003), finish)
    base += pieces(
        "paper", box(around(0.36 * w), (y[0] + 0.03, y[1] - 0.08), (tray + 0.012, tray + 0.018)), Finish("paper", (0.85, 0.85, 0.83), 0.9)
    )
    base += pieces("feet", [box(around(0.02, s * 0.4 * w), (-0.35 * d, 0.4 * d), (0.0, 0.006)) for s in (-1, 1)], RUBBER)
    plane = y[0] + 0.002
    panel_z = (0.58 * h + 0.25 * (top - 0.58 * h), 0.58 * h + 0.75 * (top - 0.58 * h))
    base += pieces("display", box((-0.1 * w, 0.08 * w), (plane - 0.002, plane), panel_z), DARK_GLASS, group="display")
    rect = Rect(inset(inner, 0.002), (0.021, tray - 0.003), y[0])
    movers = [drawer("paper_drawer", rect, style, (inner, (0.018, tray), y[1] - t), PLASTIC)]
    for k in range(4 if form == "scanner" else 2):
        bx = 0.15 * w + 0.07 * w * k
        movers.append(button(f"button_{k}", (bx, bx + 0.045 * w), panel_z, plane, PLASTIC_WHITE if finish is not PALE else PLASTIC))
    solids: Pieces = pieces(
        "cover", box(x, (y[0], y[1] - 0.002), (top + 0.003, h - 0.5 * cover if form == "scanner" else h), 0.003), finish, group="cover"
    )
    if form == "scanner":
        feeder = box(around(0.42 * w), (y[0] + 0.1 * d, y[1] - 0.02), (h - 0.5 * cover, h), 0.006)
        solids += pieces("feeder", feeder, trim, group="cover")
    movers.append(lid("cover", solids, (0.0, y[1] - 0.002, top + 0.003), math.radians(70)))
    return Shape(base, tuple(movers))
