"""Electronics on desks and tables, and small appliances on worktops."""

import itertools
import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.finishes import Finish, Finishes, Material, draw_material, one_of, tint
from pipeline.corpus.furniture.fronts import FrontStyle, Rect, button, drawer, knob, lid, top_button, top_knob
from pipeline.corpus.furniture.intervals import Interval, Spot, around, between, edges, inset, split
from pipeline.corpus.furniture.shape import UP, Mover, Pieces, Shape, pieces, staves
from pipeline.corpus.furniture.solids import Solid, box, circle, cushion, revolve, ring, rod, slab, stand_up

WIRE = 0.004  # radius of a bail [m]


def laptop(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a closed laptop: a deck of keys and a touch pad under a screen that opens past the upright."""
    finish = one_of(rng, ("silver", "dark"))
    deck = 0.56 * h
    x, y = around(w / 2), around(d / 2)
    feet = [box(around(0.02, s * 0.4 * w), around(0.4 * d), (0, 0.0015)) for s in (-1, 1)]
    keys: list[Solid] = []
    rows, pitch = 5, 0.42 * d / 5
    for r in range(rows):
        span = (0.38 * d - (r + 1) * pitch + 0.0015, 0.38 * d - r * pitch)
        keys += [box(place, span, (deck, deck + 0.001)) for place in split(around(0.44 * w), 12 if r < rows - 1 else 5, 0.001)]
    pad = box(around(0.16 * w), (-0.42 * d, -0.12 * d), (deck, deck + 0.0005))
    base = pieces("deck", box(x, y, (0.0015, deck), 0.002), finish, group="deck") + pieces("feet", feet, "rubber", group="deck")
    base += pieces("keys", keys, "keys" if finish == "silver" else "rubber", group="deck")
    base += pieces("touch_pad", pad, "touch_pad", group="deck")
    low = deck + 0.0035
    pane = box(inset(x, 0.009), (y[0] + 0.014, y[1] - 0.018), (low - 0.0016, low - 0.0008))
    cover = pieces("screen_back", box(x, y, (low, h), 0.002), finish, group="screen")
    cover += pieces("bezel", box(inset(x, 0.003), (y[0] + 0.003, y[1] - 0.006), (low - 0.0008, low)), "plastic", group="screen")
    cover += pieces("display", pane, "laptop_display", group="screen")
    return Shape(base, (lid("screen", cover, (0.0, d / 2, low), math.radians(125)),))


def remote(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a remote control: a slim body with a round pad and rows of buttons; a simple one has few."""
    top = h - 0.003
    finish = one_of(rng, ("dark", "dark", "pale"))
    cap = "plastic_white" if finish == "dark" else "plastic"
    base = pieces("body", cushion(around(w / 2), around(d / 2), (0, top), 0.006), finish)
    base += pieces("window", box(around(0.3 * w), (d / 2 - 0.012, d / 2 - 0.004), (top - 0.0005, top + 0.0004)), "dark_glass")
    r = 0.3 * w
    base += pieces("pad", slab(circle(r, 20, (0.0, 0.16 * d)), (top, top + 0.001)), "remote_pad")
    rows, columns = (3, 3) if form == "grid" else (2, 2)
    movers = [_key("power", 0.0, 0.40 * d, 0.14 * w, 0.14 * w, top, "signal")]
    movers.append(_key("select", 0.0, 0.16 * d, 0.2 * r, 0.2 * r, top + 0.001, cap, rise=0.002))
    pitch_x, pitch_y = 0.84 * w / columns, 0.44 * d / rows
    for k in range(rows * columns):
        x = (k % columns - (columns - 1) / 2) * pitch_x
        y = -0.03 * d - (k // columns + 0.5) * pitch_y + (0.02 * d if form == "grid" else 0.0)
        movers.append(_key(f"key_{k}", x, y, 0.34 * pitch_x, 0.3 * pitch_y, top, cap))
    return Shape(base, tuple(movers))


def _key(name: str, x: float, y: float, half_x: float, half_y: float, top: float, finish: Material, rise: float = 0.003) -> Mover:
    """Return a key on a level top that goes down by 1 mm."""
    return top_button(name, around(half_x, x), around(half_y, y), (top + 0.0012, top + max(rise, 0.002)), finish, 0.001)


def phone(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a telephone that lies on its back: all screen with keys at its side, a keypad, or one that flips open."""
    finish = draw_material(rng, "dark", "silver", Finish("shell_blue", tint(rng, (0.04, 0.09, 0.2), 0.3), 0.3, density=1500))
    x, y = (-w / 2, w / 2), (-d / 2, d / 2)
    if form == "smart":
        side = w / 2 - 0.0014
        base = pieces("body", cushion((-side, side), y, (0.0012, h - 0.0006), 0.004), finish, group="body")
        base += pieces("glass", box(around(side - 0.0025), inset(y, 0.0025), (h - 0.0008, h)), "dark_glass", group="body")
        base += pieces("camera", revolve([(0.008, 0.0), (0.008, 0.0012)], 12, (-side + 0.02, y[1] - 0.02)), "dark_glass", group="body")
        spots = (("power", 1.0, 0.16, 0.06), ("louder", -1.0, 0.22, 0.05), ("softer", -1.0, 0.08, 0.05))
        movers = []
        for name, s, at, half in spots:
            x = between(s * (side + 0.0006), s * (side + 0.0014))
            cap = pieces("button", box(x, ((at - half) * d, (at + half) * d), (0.4 * h, 0.7 * h)), finish)
            middle = (s * (side + 0.001), at * d, 0.55 * h)
            movers.append(Mover(name, cap, "prismatic", (-s, 0, 0), middle, 0.0005, "slider_button", "button", (s, 0, 0)))
        return Shape(base, tuple(movers))
    flips = form == "flip"
    top = 0.5 * h - 0.0028 if flips else h - 0.003
    base = pieces("body", box(x, y, (0, top), 0.002), finish, group="body")
    if not flips:
        base += pieces("display", box(around(0.4 * w), (0.1 * d, 0.44 * d), (top, top + 0.0006)), "dark_glass", group="body")
    reach = (-0.45 * d, 0.04 * d if not flips else 0.4 * d)
    pitch_x, pitch_y = 0.84 * w / 3, (reach[1] - reach[0]) / 4
    keys, key_half = "plastic_white" if finish != "silver" else "plastic", (0.4 * pitch_x, 0.34 * pitch_y)
    places = [((k % 3 - 1) * pitch_x, reach[1] - (k // 3 + 0.5) * pitch_y) for k in range(12)]
    movers = [_key(f"key_{k}", *place, *key_half, top, keys, 0.0024) for k, place in enumerate(places)]
    if not flips:
        return Shape(base, tuple(movers))
    low = top + 0.0036
    cover = pieces("cover", box(x, y, (low, h), 0.002), finish, group="cover")
    cover += pieces("display", box(around(0.4 * w), (-0.4 * d, 0.3 * d), (low - 0.0006, low)), "dark_glass", group="cover")
    return Shape(base, (lid("cover", cover, (0.0, d / 2, low), math.radians(140)), *(replace(m, after=("cover",)) for m in movers)))


def camera(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a camera: a body with a lens, a release, dials, and a flash that folds up on the larger one."""
    reflex = form == "reflex"
    face, back = -0.06 * d, 0.5 * d
    finish = "dark" if reflex or rng.random() < 0.4 else "silver"
    top = 0.78 * h if reflex else h - 0.012
    r, out = min(0.40 * top, 0.26 * w), face + d / 2  # how far the lens stands out
    lens = ((0.05 if reflex else 0.12) * w, face, 0.48 * top)
    barrel = [(r, 0.0), (r, 0.35 * out), (0.88 * r, 0.36 * out), (0.88 * r, 0.55 * out)]
    base = pieces("body", cushion(around(w / 2), (face, back), (0, top), 0.008), finish)
    base += pieces("leather", box(around(0.48 * w), (face - 0.0006, face + 0.002), (0.14 * top, 0.78 * top)), "rubber", group="leather")
    base += pieces("lens", stand_up(revolve(barrel, 16), lens), "plastic", group="lens")
    zoom = pieces("zoom_ring", stand_up(revolve([(0.93 * r, 0.57 * out), (0.93 * r, 0.96 * out)], 16), lens), "rubber", group="zoom")
    zoom += pieces("lens_glass", stand_up(revolve([(0.55 * r, 0.96 * out), (0.5 * r, out)], 16), lens), "dark_glass", group="zoom")
    at = (lens[0], face - 0.57 * out, lens[2])
    y = (face + back) / 2
    movers = [Mover("zoom", zoom, "revolute", (0, 1, 0), at, 0.5 * math.pi, "hinge_knob", "knob")]
    movers.append(top_knob("mode", (0.36 * w, y, top), 0.11 * w if reflex else 0.085 * w, "plastic", depth=0.009))
    cap = "steel" if finish == "dark" else "plastic"
    movers.append(top_button("release", (-0.42 * w, -0.32 * w), around(0.006, y), (top + 0.002, top + 0.005), cap, 0.0015))
    if not reflex:
        movers.append(top_knob("exposure", (0.12 * w, y, top), 0.07 * w, "plastic", depth=0.007))
        window = box((-0.4 * w, -0.26 * w), (face - 0.001, face + 0.002), (0.8 * top, 0.93 * top))
        base += pieces("shoe", box((-0.10 * w, 0.02 * w), around(0.008, y), (top, h)), "steel")
        return Shape(base + pieces("finder", window, "dark_glass", group="finder"), tuple(movers))
    prism, low = (-0.13 * w, 0.23 * w), h - 0.0115
    base += pieces("prism", box(prism, (y, back), (top, h - 0.012), 0.006), finish)
    flash = pieces("flash", box(prism, (face + 0.004, back), (low, h), 0.003), finish)
    return Shape(base, (*movers, lid("flash", flash, (0.05 * w, back, low), math.radians(60))))


def keyboard(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a keyboard: rows of keys with a space bar, or a block of figures."""
    top = h - 0.006
    finish = one_of(rng, ("dark", "silver", "pale"))
    cap = one_of(rng, ("keys_pale", "plastic_white")) if finish != "silver" else "keys"
    feet = [box(around(0.45 * w), around(0.006, s * 0.4 * d), (0, 0.002)) for s in (-1, 1)]
    base = pieces("board", box(around(w / 2), around(d / 2), (0.002, top), 0.003), finish, group="board")
    base += pieces("feet", feet, "rubber", group="board")
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


def printer(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a printer: a paper drawer below, a gap where sheets come out, a panel of buttons, a scanner's lid on top."""
    finish = one_of(rng, ("pale", "dark", "graphite"))
    trim = "plastic" if finish == "pale" else "trim"
    x, y, t = (-w / 2, w / 2), (-d / 2 + 0.012, d / 2), 0.012
    tray = 0.30 * h
    cover = 0.16 * h if form == "scanner" else 0.05 * h
    top = h - cover - 0.003
    style = FrontStyle("slab", "edge", trim, "plastic", thickness=0.012)
    base = pieces("sides", [box(span, y, (0.006, top), 0.003) for span in edges(x, t)], finish)
    inner = inset(x, t)
    base += pieces("bottom", box(inner, y, (0.006, 0.018)), finish) + pieces("back", box(inner, (y[1] - t, y[1]), (0.018, top)), finish)
    base += pieces("deck", box(inner, (y[0] + 0.004, y[1] - t), (tray, tray + 0.012)), trim)
    base += pieces("head", box(inner, (y[0] + 0.002, y[1] - t), (0.58 * h, top), 0.003), finish)
    base += pieces("paper", box(around(0.36 * w), (y[0] + 0.03, y[1] - 0.08), (tray + 0.012, tray + 0.018)), "printer_paper")
    base += pieces("feet", [box(around(0.02, s * 0.4 * w), (-0.35 * d, 0.4 * d), (0.0, 0.006)) for s in (-1, 1)], "rubber")
    plane = y[0] + 0.002
    panel_z = (0.58 * h + 0.25 * (top - 0.58 * h), 0.58 * h + 0.75 * (top - 0.58 * h))
    base += pieces("display", box((-0.1 * w, 0.08 * w), (plane - 0.002, plane), panel_z), "dark_glass", group="display")
    rect = Rect(inset(inner, 0.002), (0.021, tray - 0.003), y[0])
    movers = [drawer("paper_drawer", rect, style, (inner, (0.018, tray), y[1] - t), "plastic")]
    for k in range(4 if form == "scanner" else 2):
        bx = 0.15 * w + 0.07 * w * k
        movers.append(button(f"button_{k}", (bx, bx + 0.045 * w), panel_z, plane, "plastic_white" if finish != "pale" else "plastic"))
    z = (top + 0.003, h - 0.5 * cover if form == "scanner" else h)
    solids = pieces("cover", box(x, (y[0], y[1] - 0.002), z, 0.003), finish, group="cover")
    if form == "scanner":
        feeder = box(around(0.42 * w), (y[0] + 0.1 * d, y[1] - 0.02), (h - 0.5 * cover, h), 0.006)
        solids += pieces("feeder", feeder, trim, group="cover")
    movers.append(lid("cover", solids, (0.0, y[1] - 0.002, z[0]), math.radians(70)))
    return Shape(base, tuple(movers))


def _enamel(rng: np.random.Generator) -> Material:
    """Draw the colour of a small appliance."""
    colour = one_of(rng, ((0.55, 0.05, 0.04), (0.68, 0.60, 0.42), (0.30, 0.45, 0.42), (0.05, 0.09, 0.16)))
    gay = Finish("enamel", tint(rng, colour, 0.15), 0.25, density=900)
    return draw_material(rng, "steel", "enamel", "graphite", gay)


def toaster(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a toaster: slots along its length, a lever that is pressed down, a dial and a crumb tray."""
    finish = _enamel(rng)
    stand = 0.026  # of dial and lever before the front
    y = (-d / 2 + stand, d / 2)
    x, z = (-w / 2, w / 2), (0.03, h)
    slots = 2 if form == "two_slots" else 1
    depth, slot, end = y[1] - y[0], 0.03, 0.16 * w
    bars = np.linspace(0.26 * depth, depth - 0.26 * depth - slot, slots)
    cuts = [y[0]]
    for b in bars if slots == 2 else [(depth - slot) / 2]:
        cuts += [y[0] + float(b), y[0] + float(b) + slot]
    cuts.append(y[1])
    base: Pieces = ()
    for k in range(0, len(cuts), 2):
        base += pieces("wall", box(inset(x, end), (cuts[k], cuts[k + 1]), z, 0.004), finish)
    base += pieces("ends", [cushion(span, y, z, 0.02) for span in edges(x, end)], finish)
    base += pieces("skids", [box((a, a + 0.012), inset(y, 0.004), (0.0, 0.03)) for a in (x[0] + 0.012, x[1] - 0.024)], "plastic")
    base += pieces("skirt", box(inset(x, 0.024), (y[0] + 0.004, y[0] + 0.014), (0.004, 0.03)), "plastic")
    base += pieces("guide", box(around(0.003, 0.30 * w), (y[0] - 0.001, y[0]), (0.3 * h, 0.82 * h)), "plastic", group="guide")
    grip = box(around(0.022, 0.30 * w), (y[0] - stand, y[0] - 0.002), (0.72 * h, 0.72 * h + 0.014), 0.003)
    at = (0.30 * w, y[0] - 0.5 * stand, 0.72 * h)
    movers = [Mover("lever", pieces("lever", grip, "plastic"), "prismatic", (0, 0, -1), at, 0.36 * h, "slider_button", "lever", UP)]
    movers.append(knob("browning", (-0.30 * w, y[0], 0.34 * h), 0.017, "steel" if finish != "steel" else "plastic"))
    if slots == 2:
        movers.append(button("stop", around(0.04 * w), (0.31 * h, 0.37 * h), y[0], "plastic"))
    tray = box(inset(x, 0.03), inset(y, 0.02), (0.008, 0.018))
    lip = box((-0.06, 0.06), (y[1] - 0.0195, y[1]), (0.008, 0.02))  # drawn out at the back
    crumbs = pieces("crumb_tray", [tray], "steel") + pieces("crumb_lip", lip, "plastic")
    back: tuple[float, float, float] = (0.0, 1.0, 0.0)
    movers.append(Mover("crumbs", crumbs, "prismatic", back, (0.0, y[1], 0.013), 0.6 * depth, "slider_drawer", "tray", back))
    return Shape(base, tuple(movers))


def coffee_machine(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a foot with a drip tray, a column with a tank's lid, and a head: for a jug, for a filter holder or for capsules."""
    finish = _enamel(rng)
    trim = "plastic" if finish != "graphite" else "steel"
    x, y = around(w / 2), (-d / 2 + 0.03, d / 2)
    back, front = y[0] + 0.6 * (y[1] - y[0]), y[0] + 0.01  # the column's face, the plane of dials and buttons
    foot, head, lid_z, t = 0.17 * h, 0.70 * h, h - 0.035, 0.012
    inner, cap_x = inset(x, t), inset(x, 0.004)
    base = pieces("foot", [box(span, y, (0, foot), 0.002) for span in edges(x, t)], trim)
    base += pieces("floor", box(inner, y, (0, 0.01)), trim) + pieces("foot_back", box(inner, (back, y[1]), (0.01, foot)), trim)
    base += pieces("column", box(x, (back, y[1]), (foot, head), 0.006), finish)
    base += pieces("head", box(x, (front, y[1]), (head, lid_z - 0.003), 0.008), finish)
    style = FrontStyle("slab", "edge", trim, "steel", thickness=0.01)
    rect = Rect(inset(inner, 0.002), (0.012, foot - 0.003), y[0])
    movers = [drawer("drip_tray", rect, style, (inner, (0.01, foot - 0.014), back), "plastic")]
    if form == "capsule":
        base += pieces("cap", box(cap_x, (back, y[1] - 0.002), (lid_z - 0.003, lid_z + 0.012), 0.003), trim)
        movers.append(_capsule_lever(w, (front, back - 0.03), lid_z, h))
    else:
        cover = pieces("tank_lid", box(cap_x, (back - 0.02, y[1] - 0.002), (lid_z, h - 0.004), 0.003), trim, group="lid")
        cover += pieces("tank_rim", box((-0.02, 0.02), (back - 0.012, back), (h - 0.004, h)), trim, group="lid")
        movers.append(lid("tank", cover, (0.0, y[1] - 0.002, lid_z), math.radians(80)))
    z = head + 0.45 * (lid_z - head)
    base += pieces("display", box(around(0.14 * w), (front - 0.0015, front), (z - 0.012, z + 0.014)), "dark_glass", group="display")
    for k, bx in enumerate((-0.34 * w, 0.16 * w)):
        movers.append(button(f"button_{k}", (bx, bx + 0.1 * w), around(0.010, z), front, "plastic" if trim == "steel" else "steel"))
    middle = (y[0] + 0.014 + back) / 2
    if form == "jug":
        base += _jug(middle, foot - 0.005, head - 0.012, min(0.38 * w, 0.44 * (back - y[0])))
        plate = slab(circle(min(0.36 * w, middle - y[0] - 0.016), 16, (0.0, middle)), (foot - 0.014, foot - 0.0055))
        return Shape(base + pieces("hot_plate", plate, "plastic"), tuple(movers))
    bars = np.linspace(y[0] + 0.03, back - 0.014, 7).tolist()
    grate = [box(inset(inner, 0.004), (a, a + 0.007), (foot - 0.014, foot - 0.006)) for a in bars]
    base += pieces("grate", grate, "steel", group="grate")
    base += pieces("spout", revolve([(0.018, head - 0.035), (0.026, head)], 12, (0.0, middle)), "steel")
    if form == "espresso":
        holder = revolve([(0.034, head - 0.062), (0.036, head - 0.036)], 14, (0.0, middle))
        stick = rod((0.0, middle - 0.03, head - 0.05), (0.0, y[0] - 0.012, head - 0.06), 0.011, n=8)
        base += pieces("filter_holder", holder, "steel") + pieces("filter_stick", stick, "plastic")
        movers.append(knob("steam", (0.36 * w, front, head + 0.2 * (lid_z - head)), 0.014, "steel", depth=0.024))
    return Shape(base, tuple(movers))


def _capsule_lever(w: float, y: Interval, z: float, h: float) -> Mover:
    """Return a hoop that lies on the head and is lifted to put a capsule in; it turns about its rear end."""
    half = 0.3 * w
    solids = [box(around(0.006, s * half), y, (z, h - 0.008), 0.002) for s in (-1, 1)]
    solids.append(box(around(half + 0.006), (y[0] - 0.014, y[0]), (z, h - 0.004), 0.003))
    return Mover("lever", pieces("lever", solids, "steel"), "revolute", (-1, 0, 0), (0.0, y[1], z), 1.3, "hinge_handle", "lever", UP)


def _jug(y: float, low: float, high: float, r: float) -> Pieces:
    """Return a glass jug half full of coffee, with a handle."""
    rim, at = high - 0.025, (0.0, y)
    wall = ring((r, 0.8 * r), (r - 0.006, 0.8 * r - 0.006), (low + 0.006, rim), 18, at)
    parts = staves("jug", wall, "glass") + pieces("jug_floor", slab(circle(r, 18, at), (low, low + 0.006)), "glass")
    parts += pieces("coffee", revolve([(r - 0.008, low + 0.007), (r - 0.014, low + 0.4 * (rim - low))], 18, at), "coffee")
    parts += pieces("jug_lid", revolve([(0.8 * r, rim), (0.7 * r, high)], 18, at), "plastic")
    grip = [box((-0.008, 0.008), (y - r - 0.026, y - r - 0.014), (low + 0.03, rim - 0.006), 0.003)]
    grip.append(box((-0.008, 0.008), (y - r - 0.014, y - 0.8 * r), (rim - 0.018, rim - 0.006), 0.002))
    return parts + pieces("jug_handle", grip, "plastic", group="jug_handle")


def kitchen_pot(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a pot with a lid that lifts off: two ears, a long handle, or a bail."""
    finish = draw_material(rng, "steel", _enamel(rng), "cast_iron")
    grip = "steel" if finish != "steel" or rng.random() < 0.5 else "plastic"
    # The hoop of a bail lies level behind the pot, so that the pot is in front of the middle of its box.
    r = w / 2 - 0.025 if form == "bail" else d / 2
    centre = (-w / 2 + d / 2 if form == "stick" else 0.0, 0.0)
    rim = h - min(0.035, 0.2 * h) - 0.02
    wall = ring((0.94 * r, r), (0.94 * r - 0.008, r - 0.008), (0.008, rim), 24, centre)
    base = staves("wall", wall, finish) + pieces("floor", slab(circle(0.94 * r, 24, centre), (0.0, 0.008)), finish)
    dome = revolve([(r + 0.001, rim + 0.002), (r + 0.001, rim + 0.007), (0.5 * r, rim + 0.016), (0.2 * r, rim + 0.02)], 24, centre)
    cover = pieces("lid", dome, "glass" if rng.random() < 0.35 else finish, group="lid")
    neck = revolve([(0.009, rim + 0.02), (0.008, rim + 0.024), (0.02, h - 0.008), (0.016, h)], 12, centre)
    cover += pieces("lid_knob", neck, grip, "round_fixed_handle", "knob")
    movers = [Mover("lid", cover, "prismatic", (0, 0, 1), (*centre, rim), 0.6 * h, "slider_lid", "lid", UP)]
    if form == "stick":
        stick = rod((centre[0] + r - 0.004, 0.0, 0.86 * rim), (w / 2, 0.0, 0.95 * rim), 0.011, 0.009)
        base += pieces("stick", stick, grip, "line_fixed_handle", "stick")
    elif form == "bail":
        z = 0.9 * rim
        movers.append(_bail((w / 2 - 0.004, d - r - 0.004), z))
        lugs = [box(between(s * (r - 0.006), s * (r + 0.008)), (-0.01, 0.01), around(0.012, z), 0.002) for s in (-1, 1)]
        base += pieces("lugs", lugs, "steel")
    else:
        level = (0.80 * rim, 0.80 * rim + 0.012)
        for s, side in ((-1, "left"), (1, "right")):
            ear = [box(around(0.006, s * (w / 2 - 0.006)), (-0.035, 0.035), level, 0.003)]
            span = between(s * (r - 0.004), s * (w / 2 - 0.012))
            ear += [box(span, around(0.006, sy * 0.028), level, 0.002) for sy in (-1, 1)]
            base += pieces(f"ear_{side}", ear, grip, "line_fixed_handle", f"ear_{s}")
    return Shape(base, tuple(movers))


def _bail(radii: Spot, z: float) -> Mover:
    """Return a bucket's handle: half a hoop that lies level behind the wall and swings over to the front.

    `radii` [m]: half of its width, and how far it reaches back.
    """
    points = [(radii[0] * math.cos(a), radii[1] * math.sin(a), z) for a in np.linspace(0, math.pi, 8).tolist()]
    wires = [rod(a, b, WIRE, n=6) for k, (a, b) in enumerate(itertools.pairwise(points)) if k != 3]
    grip = rod((-0.05, points[3][1], z), (0.05, points[3][1], z), 2 * WIRE, n=8)
    parts = pieces("bail", wires, "steel") + pieces("bail_grip", grip, "plastic")
    return Mover("bail", parts, "revolute", (1, 0, 0), (0.0, 0.0, z), math.pi, "hinge_handle", "handle", UP)
