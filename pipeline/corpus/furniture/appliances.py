"""Appliances: refrigerator, oven, dishwasher, microwave, washing machine."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.casework import Case, Cell, CellKind, Column, case
from pipeline.corpus.furniture.finishes import FINISHES, Finishes, Material, one_of, pick
from pipeline.corpus.furniture.fronts import FrontStyle, Rect, button, knob, lid, reach, tray
from pipeline.corpus.furniture.intervals import Interval, around, corners, edges, inset
from pipeline.corpus.furniture.shape import Mover, Pieces, Shape, pieces, staves
from pipeline.corpus.furniture.solids import at_height, box, circle, revolve, ring, shell, slab, stand_up, strips

FRONTS = ("enamel", "steel", "graphite")


def _glides(x: Interval, y: Interval, high: float) -> Pieces:
    """Return four short round feet under the corners of a rectangle."""
    feet = [revolve([(0.02, 0.0), (0.02, high)], 10, (px, py))[0] for px in x for py in y]
    return pieces("feet", feet, "plastic")


def _display(x: Interval, face: float, z: Interval) -> Pieces:
    """Return a dark window on a front plane."""
    return pieces("display", box(x, (face - 0.002, face), z), "dark_glass", group="display")


def _trim(outside: Material) -> Material:
    """Return what handles are made of: steel, but not on steel."""
    return "steel" if outside != "steel" else "graphite"


def _bounds(shape: Shape, name: str) -> NDArray[np.float64]:
    """Return the bounds of the first piece of the base whose name contains that word."""
    return next(p.solid.bounds() for p in shape.base if name in p.name)


def refrigerator(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build thick walls and doors: one, a freezer over or under, side by side, French doors or one door over drawers."""
    outside = one_of(rng, FRONTS)
    handle = "steel" if outside != "steel" else "handle_steel"
    style = FrontStyle("slab", pick(rng, "long bar groove"), outside, handle, thickness=0.055)  # type: ignore[arg-type]
    how = Case("enamel" if outside != "graphite" else "graphite", style, "plinth", 0.06, "plastic", outside, 0.03, board=0.04, gap=0.008)
    side: CellKind = "left" if rng.random() < 0.5 else "right"
    paired = form == "side_by_side" and w > 0.62
    cells: tuple[Cell, ...]
    if form == "french" and w > 0.62:
        cells = (Cell("pair", 1.9, 3), Cell("drawer", 0.9))
    elif form == "single" or paired:
        cells = (Cell(side, 1.0, 4),)
    elif form == "freezer_drawers":
        cells = (Cell(side, 1.9, 3), Cell("drawer", 0.6), Cell("drawer", 0.6))
    elif rng.random() < 0.5:
        cells = (Cell(side, 0.42, 1), Cell(side, 1.0, 3))
    else:
        cells = (Cell(side, 1.0, 3), Cell(side, 0.6, 1))
    columns = [Column(0.85, (Cell("left", 1, 4),)), Column(1, (Cell("right", 1, 4),))] if paired else [Column(1, cells)]
    shape = case((w, d, h), columns, how)
    base = tuple(replace(p, finish=FINISHES["glass"]) if "_board_" in p.name else p for p in shape.base)
    if not paired:
        return Shape(base, shape.movers)
    first = shape.movers[0]  # water and ice from the door
    low, high = next(p.solid.bounds() for p in first.pieces if p.name == "front")
    right = 0.35 * low[0] + 0.65 * high[0]
    niche = box((right - 0.10, right), (low[1] - 0.003, low[1]), (0.60 * h, 0.60 * h + 0.24), 0.001)
    door = replace(first, pieces=first.pieces + pieces("dispenser", niche, "dark_glass", group="dispenser"))
    return Shape(base, (door, *shape.movers[1:]))


def oven(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a range with a hob, dials, a glazed door and a drawer, or a tower of two ovens."""
    outside = one_of(rng, FRONTS)
    style = FrontStyle("dark_glass", "bar", outside, _trim(outside), thickness=0.03)
    tower = form == "built_in"
    hob = h - (0.03 if form == "gas" else 0.008)
    flat = replace(style, panel="slab")
    how = Case(outside, style, "plinth", 0.05, "plastic", outside if tower else "dark_glass", 0.03, board=0.03)
    cells = (Cell("blank", 0.11, 0, flat), Cell("flap", 0.5, 2), Cell("drawer", 0.17, 0, flat))
    if tower:
        cells = (Cell("blank", 0.09, 0, flat), Cell("flap", 0.3, 1), Cell("flap", 0.4, 2))
    shape = case((w, d, hob), [Column(1, cells)], how)
    plate = _bounds(shape, "_blank")
    z, face = (plate[0, 2] + plate[1, 2]) / 2, -d / 2 + reach("bar")
    count = 2 if tower else 4
    xs = np.linspace(-0.38 * w, 0.38 * w, count + 1).tolist()
    movers = [knob(f"knob_{k}", (x, face, z), 0.019, "steel") for k, x in enumerate(xs) if k != count // 2]
    movers.append(button("button_0", (0.062, 0.08), around(0.008, z), face, "plastic"))
    base = shape.base + _display((-0.05, 0.05), face, around(0.014, z))
    if form == "range":
        spots = [(s * 0.23 * w, 0.03 + y * d, r) for s in (-1, 1) for y, r in ((-0.2, 0.075), (0.2, 0.09))]
        base += pieces("hob_zones", [revolve([(r, hob), (r, h)], 20, (x, y))[0] for x, y, r in spots], "hob_zone")
    elif form == "gas":
        base += _burners(w, d, hob)
    racks = tuple(replace(p, finish=FINISHES["steel"]) if "_board_" in p.name else p for p in base)
    return Shape(racks, shape.movers + tuple(movers))


def _burners(w: float, d: float, z: float) -> Pieces:
    """Return four burners under grates of bars, on a hob at height `z` [m]."""
    parts: Pieces = ()
    half, level = 0.17 * d, (z + 0.018, z + 0.030)
    for k, (sx, sy, r) in enumerate(((-1, -1, 0.035), (1, -1, 0.045), (-1, 1, 0.045), (1, 1, 0.028))):
        x, y = sx * 0.22 * w, 0.03 + sy * 0.19 * d
        cap = revolve([(1.2 * r, z), (1.2 * r, z + 0.006), (r, z + 0.008), (r, z + 0.014)], 14, (x, y))
        bars = [box(around(half, x), around(0.005, y), level)]
        bars += [box(around(0.005, x), span, level) for span in ((y - half, y - 0.005), (y + 0.005, y + half))]
        bars += [box(around(0.004, x + s * half), around(0.005, y), (z, z + 0.018)) for s in (-0.97, 0.97)]
        parts += pieces("burners", cap, "iron", group=f"burner_{k}") + pieces("grates", bars, "iron", group=f"grate_{k}")
    return parts


def dishwasher(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a door that folds down under a strip with buttons, and racks inside."""
    outside = one_of(rng, FRONTS)
    style = FrontStyle("slab", pick(rng, "bar flat"), outside, _trim(outside), thickness=0.03)  # type: ignore[arg-type]
    how = Case(outside, style, "plinth", 0.08, "plastic", outside, 0.025, board=0.03)
    hidden = form == "hidden"  # its buttons sit in the door's upper edge, behind one front
    cells = (Cell("flap", 1.0),) if hidden else (Cell("blank", 0.12), Cell("flap", 1.0))
    shape = case((w, d, h), [Column(1, cells)], how)
    leaf = next(m for m in shape.movers if m.part_class == "hinge_door")
    (x0, y0, _), (x1, y1, z) = _bounds(shape, "bottom").tolist()
    top = float(min(p.solid.bounds()[0, 2] for p in shape.base if p.name == "top" or "_shelf_" in p.name))
    levels = (z + 0.03, 0.5 * (z + top) + 0.02)
    movers = [_rack(f"rack_{k}", inset((x0, x1), 0.012), (y0 + 0.035, y1 - 0.03), low, leaf.name) for k, low in enumerate(levels)]
    base = shape.base
    if not hidden:
        face, z = -d / 2 + reach(style.handle), float(_bounds(shape, "_blank")[:, 2].mean())
        xs = enumerate((0.12, 0.155, 0.19))
        movers += [button(f"button_{k}", around(0.011, x), around(0.009, z), face, "plastic") for k, x in xs]
        base += _display((-0.05, 0.05), face, around(0.012, z))
    return Shape(base, (*shape.movers, *movers))


def _rack(name: str, x: Interval, y: Interval, z: float, door: str) -> Mover:
    """Return a basket of wire that is drawn out through the open door."""
    high = z + 0.13
    wires = [box(x, (a, a + 0.008), (z, z + 0.008)) for a in np.linspace(y[0], y[1] - 0.008, 8).tolist()]
    wires += [box((a, a + 0.008), inset(y, 0.009), (z + 0.008, z + 0.014)) for a in (x[0], (x[0] + x[1]) / 2, x[1] - 0.008)]
    parts = pieces("rack", wires, "steel", group="floor")
    (left, right), (front, back) = edges(x, 0.008), edges(y, 0.008)
    across = inset(x, 0.009)
    for side, span, depth in (("left", left, y), ("right", right, y), ("front", across, front), ("back", across, back)):
        rails = [box(span, depth, (at, at + 0.007)) for at in (z + 0.05, high - 0.007)]
        parts += pieces(f"rim_{side}", rails, "steel", group=f"rim_{side}")
    at = ((x[0] + x[1]) / 2, y[0], high)
    return Mover(name, parts, "prismatic", (0, -1, 0), at, 0.85 * (y[1] - y[0]), "slider_drawer", "rack", after=(door,))


def microwave(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a glazed door hinged at the left, a panel with buttons and a dial at the right, a turntable inside."""
    outside = one_of(rng, ("enamel", "graphite", "steel"))
    style = FrontStyle("dark_glass", "flat", outside, _trim(outside), thickness=0.024)
    how = Case(outside, style, "none", 0.012, "plastic", outside, 0.014, board=0.014)
    shape = case((w, d, h), [Column(0.74, (Cell("left"),)), Column(0.26, (Cell("blank", 1, 0, replace(style, panel="slab")),))], how)
    plate = _bounds(shape, "_blank")
    x, face = float(plate[:, 0].mean()), -d / 2 + reach("flat")
    z0, z1 = plate[0, 2], plate[1, 2]
    dials = (0.26, 0.62) if form == "knobs" else (0.26,)
    movers = [knob(f"knob_{k}", (x, face, z0 + share * (z1 - z0)), 0.021, "steel") for k, share in enumerate(dials)]
    cap = "plastic_white" if outside == "graphite" else "plastic"
    for k in range(0 if form == "knobs" else 4):
        bx, bz = x + (-1 + 2 * (k % 2)) * 0.019, z0 + (0.52 + 0.12 * (k // 2)) * (z1 - z0)
        movers.append(button(f"button_{k}", around(0.012, bx), around(0.009, bz), face, cap))
    feet = [revolve([(0.012, 0.0), (0.015, 0.012)], 10, at)[0] for at in corners(0.42 * w, 0.3 * d)]
    (left, y0, _), (_, y1, z) = _bounds(shape, "bottom").tolist()
    right = float(_bounds(shape, "divider")[0, 0])
    wide = 0.46 * min(right - left, y1 - y0 - 0.02)
    plate_profile = [(0.02, z + 0.001), (0.02, z + 0.008), (0.9 * wide, z + 0.008), (wide, z + 0.015)]
    table = revolve(plate_profile, 20, ((left + right) / 2, (y0 + y1) / 2))
    base = shape.base + pieces("feet", feet, "plastic") + _display(around(0.035, x), face, (z1 - 0.05, z1 - 0.02))
    return Shape(base + pieces("turntable", table, "glass", group="turntable"), shape.movers + tuple(movers))


def washing_machine(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a round door in front of a drum, a detergent drawer, a dial and buttons."""
    outside = "enamel" if rng.random() < 0.65 else "graphite"
    t, face = 0.02, -d / 2 + 0.045  # plane of the front panel
    x, panel = around(w / 2), h - 0.135
    r, zc = 0.34 * w, 0.5 * (panel + 0.1)
    base = pieces("top", box(x, (face, d / 2), (h - 0.03, h), 0.004), outside)
    base += pieces("sides", [box(span, (face + t, d / 2), (0.012, h - 0.03)) for span in edges(x, t)], outside)
    base += pieces("bottom", box(inset(x, t), (face + 0.03, d / 2), (0.012, 0.03)), outside)
    base += pieces("back", box(inset(x, t), (d / 2 - 0.01, d / 2), (0.03, h - 0.03)), outside)
    base += _glides(inset(x, 0.06), inset((face, d / 2), 0.06), 0.012)
    square = np.array([_on_square(a, x, (0.1, panel), zc) for a in np.arange(24) * 2 * math.pi / 24])
    hole = circle(r - 0.03, 24, (0.0, zc))
    rims = [[at_height(o, k * t) for k in (0, 1)] for o in (square, hole)]
    base += staves("front", stand_up(shell(rims[0], rims[1]), (0, face + t, 0)), outside, "tub", 6)  # a hand meets four walls within
    base += pieces("kick", box(x, (face + 0.01, face + 0.03), (0.012, 0.1)), outside)
    drum = ring((r - 0.025, r - 0.025), (r - 0.035, r - 0.035), (-d / 2 + 0.1, -face - t - 0.002), 24)
    end = revolve([(r - 0.03, -d / 2 + 0.085), (r - 0.03, -d / 2 + 0.1)], 24)
    base += staves("drum", stand_up(drum, (0, 0, zc)), "steel", "tub", 6) + pieces("drum_end", stand_up(end, (0, 0, zc)), "steel")
    drawer_x = (-w / 2 + 0.03, -w / 2 + 0.2)
    base += pieces("panel", box((drawer_x[1] + 0.003, w / 2 - t), (face, face + t), (panel, h - 0.03), 0.002), outside)
    base += pieces("panel_left", box((x[0] + t, drawer_x[0] - 0.003), (face, face + t), (panel, h - 0.03)), outside)
    base += pieces("display", box((0.05, 0.17), (face - 0.002, face), (h - 0.1, h - 0.06)), "dark_glass")
    movers = [_porthole(r, zc, face, outside), _detergent(drawer_x, (panel + 0.004, h - 0.034), face, t, outside)]
    movers.append(knob("knob_0", (-0.03, face, h - 0.08), 0.026, "steel", depth=0.026))
    xs = [(k, bx) for k, bx in enumerate((0.20, 0.232)) if bx + 0.012 < w / 2 - t]
    movers += [button(f"button_{k}", around(0.011, bx), (h - 0.09, h - 0.07), face, "plastic") for k, bx in xs]
    return Shape(base, tuple(movers))


def top_loader(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a washing machine filled from above: a lid over an upright drum, dials on a panel at the back."""
    outside = "enamel" if rng.random() < 0.65 else "graphite"
    x, y, t = around(w / 2), around(d / 2), 0.018
    deck, back = h - 0.16, y[1] - 0.12
    inner = inset(x, t)
    walls = [box(span, y, (0.015, deck), 0.004) for span in edges(x, t)]
    walls += [box(inner, span, (0.03, deck), 0.002) for span in edges(y, t)]
    base = pieces("walls", walls, outside) + pieces("bottom", box(inner, (y[0] + 0.02, y[1]), (0.015, 0.03)), outside)
    base += _glides(around(0.4 * w), around(0.4 * d), 0.015)
    base += pieces("console", box(x, (back + 0.004, y[1]), (deck, h), 0.008), outside)
    hole_x, hole_y = inset(x, 0.07), (y[0] + 0.07, back - 0.09)
    base += pieces("deck", strips(x, (y[0], back), hole_x, hole_y, (deck, deck + 0.02), 0.003), outside)
    r = 0.5 * min(hole_x[1] - hole_x[0], hole_y[1] - hole_y[0])
    middle = (0.0, (hole_y[0] + hole_y[1]) / 2)
    base += staves("drum", ring((r, r), (r - 0.01, r - 0.01), (0.2, deck - 0.002), 24, middle), "steel")
    base += pieces("drum_end", slab(circle(r, 24, middle), (0.185, 0.2)), "steel")
    z, cover_y = deck + 0.022, (y[0] + 0.02, back - 0.042)
    cover = pieces("lid", box(inset(x, 0.02), cover_y, (z, z + 0.018), 0.004), outside, group="lid")
    cover += pieces("lid_glass", box(hole_x, hole_y, (z + 0.018, z + 0.0205), 0.001), "dark_glass", group="lid")
    cover += pieces("lid_grip", box((-0.06, 0.06), (y[0], cover_y[0]), (z + 0.004, z + 0.014), 0.002), "plastic", "line_fixed_handle")
    movers = [lid("lid", cover, (0.0, cover_y[1], z), math.radians(85))]
    face, at = back + 0.004, 0.5 * (z + 0.03 + h)
    movers += [knob(f"knob_{k}", (share * w, face, at), 0.022, "steel", depth=0.02) for k, share in enumerate((-0.36, -0.24))]
    starts = [0.26 * w + 0.03 * k for k in range(3)]
    movers += [button(f"button_{k}", (bx, bx + 0.02), around(0.008, at), face, "plastic") for k, bx in enumerate(starts)]
    return Shape(base + _display((-0.08, 0.08), face, around(0.014, at)), tuple(movers))


def _on_square(angle: float, x: Interval, z: Interval, zc: float) -> tuple[float, float]:
    """Return where a ray from (0, zc) leaves the rectangle, snapped to its corners at the diagonals of 45 degrees."""
    c, s = math.cos(angle), math.sin(angle)
    if abs(abs(c) - abs(s)) < 1e-9:
        return (x[1] if c > 0 else x[0], z[1] if s > 0 else z[0])
    scale = 1 / max(abs(c), abs(s))
    half_x, half_z = (x[1] - x[0]) / 2, (z[1] - zc if s > 0 else zc - z[0])
    return (c * scale * half_x, zc + s * scale * half_z)


def _porthole(r: float, zc: float, face: float, finish: Material) -> Mover:
    """Return the round door: a rim and a bulging glass, hinged at the left."""
    rim = stand_up(ring((r, r - 0.012), (r - 0.055, r - 0.055), (0.003, 0.035), 24), (0, face, zc))
    glass = stand_up(revolve([(r - 0.055, 0.006), (r - 0.055, 0.02), (0.6 * r, 0.032)], 24), (0, face, zc))
    grip = box((r - 0.045, r - 0.012), (face - 0.043, face - 0.03), around(0.05, zc), 0.003)
    parts = pieces("door_rim", rim, "door_rim", group="door")
    parts += pieces("door_glass", glass, "door_glass", group="door")
    parts += pieces("handle", grip, finish if finish != "enamel" else "plastic_white", "line_fixed_handle")
    return Mover("door", parts, "revolute", (0, 0, -1), (-r, face - 0.035, zc), math.radians(100), "hinge_door", "door")


def _detergent(x: Interval, z: Interval, face: float, t: float, finish: Material) -> Mover:
    """Return the detergent drawer: a small box behind its front, with a grip."""
    middle = Rect(x, z, face).middle
    solids = tray(inset(x, 0.006), (face + t, face + 0.2), inset(z, 0.012), 0.008)
    grip = box(around(0.045, middle[0]), (face - 0.012, face), (z[1] - 0.012, z[1] - 0.004), 0.001)
    parts = pieces("front", box(x, (face, face + t), z, 0.003), finish) + pieces("drawer_box", solids, "plastic_white")
    parts += pieces("handle", grip, "plastic", "line_fixed_handle")
    return Mover("detergent", parts, "prismatic", (0, -1, 0), (middle[0], face, middle[1]), 0.15, "slider_drawer", "drawer")
