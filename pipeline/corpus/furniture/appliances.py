"""Appliances: refrigerator, oven, dishwasher, microwave, washing machine."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.casework import Case, Cell, Column, case
from pipeline.corpus.furniture.finishes import (
    DARK_GLASS,
    ENAMEL,
    GLASS,
    GRAPHITE,
    PLASTIC,
    PLASTIC_WHITE,
    STEEL,
    Finish,
    Scheme,
    one_of,
    pick,
)
from pipeline.corpus.furniture.fronts import FrontStyle, Rect, button, knob, lid, reach, tray
from pipeline.corpus.furniture.shape import Mover, Pieces, Shape, Size, pieces, staves
from pipeline.corpus.furniture.solids import (
    Interval,
    around,
    box,
    circle,
    edges,
    inset,
    revolve,
    ring,
    shell,
    slab,
    standing,
    strips,
)

FRONTS = (ENAMEL, STEEL, GRAPHITE)


def _finish(rng: np.random.Generator) -> Finish:
    return one_of(rng, FRONTS)


def refrigerator(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build thick walls and doors: one, a freezer over or under, side by side, French doors or one door over drawers."""
    outside = _finish(rng)
    handle = STEEL if outside is not STEEL else replace(STEEL, name="handle_steel", color=(0.3, 0.3, 0.31))
    style = FrontStyle("slab", pick(rng, "long bar groove"), outside, handle, thickness=0.055)  # type: ignore[arg-type]
    how = Case(ENAMEL if outside is not GRAPHITE else GRAPHITE, style, "plinth", 0.06, PLASTIC, outside, 0.03, board=0.04, gap=0.008)
    side = "left" if rng.random() < 0.5 else "right"
    w = size[0]
    if form == "side_by_side" and w > 0.62:
        columns = [Column(0.85, (Cell("left", 1, 4),)), Column(1, (Cell("right", 1, 4),))]
    elif form == "french" and w > 0.62:
        columns = [Column(1, (Cell("pair", 1.9, 3), Cell("drawer", 0.9)))]
    elif form == "single":
        columns = [Column(1, (Cell(side, 1.0, 4),))]  # type: ignore[arg-type]
    elif form == "freezer_drawers":
        columns = [Column(1, (Cell(side, 1.9, 3), Cell("drawer", 0.6), Cell("drawer", 0.6)))]  # type: ignore[arg-type]
    elif rng.random() < 0.5:
        columns = [Column(1, (Cell(side, 0.42, 1), Cell(side, 1.0, 3)))]  # type: ignore[arg-type]
    else:
        columns = [Column(1, (Cell(side, 1.0, 3), Cell(side, 0.6, 1)))]  # type: ignore[arg-type]
    shape = case(size, columns, how)
    base = tuple(replace(p, finish=GLASS) if "_board_" in p.name else p for p in shape.base)
    movers = shape.movers
    if form == "side_by_side" and w > 0.62:  # water and ice from the door
        first = movers[0]
        low, high = next(p.solid.bounds() for p in first.pieces if p.name == "front")
        x, z = (0.35 * low[0] + 0.65 * high[0] - 0.10, 0.35 * low[0] + 0.65 * high[0]), (0.60 * size[2], 0.60 * size[2] + 0.24)
        niche = pieces("dispenser", box((x[0], x[1]), (low[1] - 0.003, low[1]), z, 0.001), DARK_GLASS, group="dispenser")
        movers = (replace(first, pieces=first.pieces + niche), *movers[1:])
    return Shape(base, movers)


def _plane(size: Size, stand: float) -> float:
    """Return the y of the fronts' faces [m]."""
    return -size[1] / 2 + stand


def oven(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a range with a hob, dials, a glazed door and a drawer, or a tower of two ovens."""
    w, d, h = size
    outside = _finish(rng)
    style = FrontStyle("dark_glass", "bar", outside, STEEL if outside is not STEEL else GRAPHITE, thickness=0.03)
    stand = reach("bar")
    hob = 0.03 if form == "gas" else 0.008
    flat = replace(style, panel="slab")
    how = Case(outside, style, "plinth", 0.05, PLASTIC, outside if form == "built_in" else DARK_GLASS, 0.03, board=0.03)
    if form != "built_in":
        cells = (Cell("blank", 0.11, 0, flat), Cell("flap", 0.5, 2), Cell("drawer", 0.17, 0, flat))
    else:
        cells = (Cell("blank", 0.09, 0, flat), Cell("flap", 0.3, 1), Cell("flap", 0.4, 2))
    shape = case((w, d, h - hob), [Column(1, cells)], how)
    plate = next(p.solid.bounds() for p in shape.base if p.name.endswith("_blank"))
    z, face = (plate[0, 2] + plate[1, 2]) / 2, _plane(size, stand)
    count = 2 if form == "built_in" else 4
    xs = np.linspace(-0.38 * w, 0.38 * w, count + 1)
    movers = [knob(f"knob_{k}", (float(x), face, z), 0.019, STEEL) for k, x in enumerate(xs) if k != count // 2 or count % 2]
    base = shape.base + pieces("display", box((-0.05, 0.05), (face - 0.002, face), around(0.014, z)), DARK_GLASS, group="display")
    movers.append(button("button_0", (0.062, 0.08), around(0.008, z), face, PLASTIC))
    if form == "range":
        zone = Finish("hob_zone", (0.10, 0.10, 0.105), 0.3, density=2500)
        rings = [
            revolve([(r, h - hob), (r, h)], 20, (sx * 0.23 * w, 0.03 + sy * 0.2 * d))[0]
            for sx in (-1, 1)
            for sy, r in ((-1, 0.075), (1, 0.09))
        ]
        base += pieces("hob_zones", rings, zone)
    elif form == "gas":
        base += _burners(w, d, h - hob)
    racks = tuple(replace(p, finish=STEEL) if "_board_" in p.name else p for p in base)
    return Shape(racks, shape.movers + tuple(movers))


def _burners(w: float, d: float, z: float) -> Pieces:
    """Return four burners under grates of bars, on a hob at height `z` [m]."""
    iron = Finish("cast_iron", (0.025, 0.025, 0.027), 0.6, density=3000)
    parts: Pieces = ()
    for k, (sx, sy, r) in enumerate(((-1, -1, 0.035), (1, -1, 0.045), (-1, 1, 0.045), (1, 1, 0.028))):
        x, y = sx * 0.22 * w, 0.03 + sy * 0.19 * d
        cap = revolve([(1.2 * r, z), (1.2 * r, z + 0.006), (r, z + 0.008), (r, z + 0.014)], 14, (x, y))
        half = 0.17 * d
        bars = [
            box(around(half, x), around(0.005, y), (z + 0.018, z + 0.030)),
            box(around(0.005, x), (y - half, y - 0.005), (z + 0.018, z + 0.030)),
        ]
        bars.append(box(around(0.005, x), (y + 0.005, y + half), (z + 0.018, z + 0.030)))
        feet = [box(around(0.004, x + s * half), around(0.005, y), (z, z + 0.018)) for s in (-0.97, 0.97)]
        parts += pieces("burners", cap, iron, group=f"burner_{k}") + pieces("grates", bars + feet, iron, group=f"grate_{k}")
    return parts


def dishwasher(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a door that folds down under a strip with buttons, and racks inside."""
    _w, _d, _h = size
    outside = _finish(rng)
    style = FrontStyle("slab", pick(rng, "bar flat"), outside, STEEL if outside is not STEEL else GRAPHITE, thickness=0.03)  # type: ignore[arg-type]
    how = Case(outside, style, "plinth", 0.08, PLASTIC, outside, 0.025, board=0.03)
    hidden = form == "hidden"  # its buttons sit in the door's upper edge, behind one front
    cells = (Cell("flap", 1.0),) if hidden else (Cell("blank", 0.12), Cell("flap", 1.0))
    shape = case(size, [Column(1, cells)], how)
    face = _plane(size, reach(style.handle))
    leaf = next(m for m in shape.movers if m.part_class == "hinge_door")
    movers = list(shape.movers)
    base = shape.base
    low = next(p.solid.bounds() for p in base if p.name == "bottom")
    top = min(p.solid.bounds()[0, 2] for p in base if p.name == "top" or "_shelf_" in p.name)
    inside = (low[0, 0] + 0.012, low[1, 0] - 0.012), (float(low[0, 1]) + 0.035, float(low[1, 1]) - 0.03)
    for k, z in enumerate((float(low[1, 2]) + 0.03, 0.5 * (float(low[1, 2]) + top) + 0.02)):
        movers.append(_rack(f"rack_{k}", (float(inside[0][0]), float(inside[0][1])), inside[1], z, 0.13, leaf.name))
    if not hidden:
        plate = next(p.solid.bounds() for p in base if p.name.endswith("_blank"))
        z = float(plate[:, 2].mean())
        for k, x in enumerate((0.12, 0.155, 0.19)):
            movers.append(button(f"button_{k}", around(0.011, x), around(0.009, z), face, PLASTIC))
        base += pieces("display", box((-0.05, 0.05), (face - 0.002, face), around(0.012, z)), DARK_GLASS, group="display")
    return Shape(base, tuple(movers))


def _rack(name: str, x: Interval, y: Interval, z: float, high: float, door: str) -> Mover:
    """Return a basket of wire that is drawn out through the open door."""
    wires = [box((x[0], x[1]), (a, a + 0.008), (z, z + 0.008)) for a in np.linspace(y[0], y[1] - 0.008, 8).tolist()]
    wires += [box((a, a + 0.008), inset(y, 0.009), (z + 0.008, z + 0.014)) for a in (x[0], (x[0] + x[1]) / 2, x[1] - 0.008)]
    parts = pieces("rack", wires, STEEL, group="floor")
    rims = (
        ("left", (x[0], x[0] + 0.008), y),
        ("right", (x[1] - 0.008, x[1]), y),
        ("front", inset(x, 0.009), (y[0], y[0] + 0.008)),
        ("back", inset(x, 0.009), (y[1] - 0.008, y[1])),
    )
    for side, span, depth in rims:
        rails = [box(span, depth, (at, at + 0.007)) for at in (z + 0.05, z + high - 0.007)]
        parts += pieces(f"rim_{side}", rails, STEEL, group=f"rim_{side}")
    at = ((x[0] + x[1]) / 2, y[0], z + high)
    return Mover(name, parts, "prismatic", (0, -1, 0), at, 0.85 * (y[1] - y[0]), "slider_drawer", "rack", after=(door,))


def microwave(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a glazed door hinged at the left, a panel with buttons and a dial at the right, a turntable inside."""
    w, d, _h = size
    outside = one_of(rng, (ENAMEL, GRAPHITE, STEEL))
    style = FrontStyle("dark_glass", "flat", outside, STEEL if outside is not STEEL else GRAPHITE, thickness=0.024)
    plain = replace(style, panel="slab")
    how = Case(outside, style, "none", 0.012, PLASTIC, outside, 0.014, board=0.014)
    columns = [Column(0.74, (Cell("left"),)), Column(0.26, (Cell("blank", 1, 0, plain),))]
    shape = case(size, columns, how)
    plate = next(p.solid.bounds() for p in shape.base if p.name.endswith("_blank"))
    x, face = float(plate[:, 0].mean()), _plane(size, reach("flat"))
    z0, z1 = plate[0, 2], plate[1, 2]
    movers = [knob("knob_0", (x, face, z0 + 0.26 * (z1 - z0)), 0.021, STEEL)]
    if form == "knobs":
        movers.append(knob("knob_1", (x, face, z0 + 0.62 * (z1 - z0)), 0.021, STEEL))
    for k in range(0 if form == "knobs" else 4):
        bx, bz = x + (-1 + 2 * (k % 2)) * 0.019, z0 + (0.52 + 0.12 * (k // 2)) * (z1 - z0)
        movers.append(button(f"button_{k}", around(0.012, bx), around(0.009, bz), face, PLASTIC_WHITE if outside is GRAPHITE else PLASTIC))
    feet = [revolve([(0.012, 0.0), (0.015, 0.012)], 10, (sx * 0.42 * w, sy * 0.3 * d))[0] for sx in (-1, 1) for sy in (-1, 1)]
    low = next(p.solid.bounds() for p in shape.base if p.name == "bottom")
    divider = next(p.solid.bounds() for p in shape.base if p.name.startswith("divider"))
    left, right, z = float(low[0, 0]), float(divider[0, 0]), float(low[1, 2])
    wide = 0.46 * min(right - left, float(low[1, 1] - low[0, 1]) - 0.02)
    table = revolve(
        [(0.02, z + 0.001), (0.02, z + 0.008), (0.9 * wide, z + 0.008), (wide, z + 0.015)],
        20,
        ((left + right) / 2, float(low[:, 1].mean())),
    )
    base = (
        shape.base
        + pieces("feet", feet, PLASTIC)
        + pieces("display", box(around(0.035, x), (face - 0.002, face), (z1 - 0.05, z1 - 0.02)), DARK_GLASS, group="display")
    )
    base += pieces("turntable", table, GLASS, group="turntable")
    return Shape(base, shape.movers + tuple(movers))


def washing_machine(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a round door in front of a drum, a detergent drawer, a dial and buttons; or a lid over a drum that stands."""
    w, d, h = size
    outside = ENAMEL if rng.random() < 0.65 else GRAPHITE
    if form == "top":
        return _top_loader(size, outside)
    t, proud = 0.02, 0.045
    face = -d / 2 + proud  # plane of the front panel
    x, panel = (-w / 2, w / 2), h - 0.135
    r, zc = 0.34 * w, 0.5 * (panel + 0.1)
    base = _cabinet(x, (face, d / 2), h, t, outside)
    square = np.array([_on_square(a, x, (0.1, panel), zc) for a in np.arange(24) * 2 * math.pi / 24])
    hole = circle(r - 0.03, 24, (0.0, zc))
    rims = [[np.column_stack([o[:, 0], o[:, 1], np.full(24, k * t)]) for k in (0, 1)] for o in (square, hole)]
    front = standing(shell(rims[0], rims[1]), (0, face + t, 0))
    base += staves("front", front, outside) + pieces("kick", box(x, (face + 0.01, face + 0.03), (0.012, 0.1)), outside)
    drum = standing(ring((r - 0.025, r - 0.025), (r - 0.035, r - 0.035), (-d / 2 + 0.1, -face - t - 0.002), 24), (0, 0, zc))
    end = revolve([(r - 0.03, -d / 2 + 0.085), (r - 0.03, -d / 2 + 0.1)], 24)[0].turned("x", math.pi / 2).moved((0, 0, zc))
    base += staves("drum", drum, STEEL) + pieces("drum_end", end, STEEL)
    drawer_x = (-w / 2 + 0.03, -w / 2 + 0.2)
    strip = (drawer_x[1] + 0.003, w / 2 - t)
    base += pieces("panel", box(strip, (face, face + t), (panel, h - 0.03), 0.002), outside)
    base += pieces("panel_left", box((x[0] + t, drawer_x[0] - 0.003), (face, face + t), (panel, h - 0.03)), outside)
    base += pieces("display", box((0.05, 0.17), (face - 0.002, face), (h - 0.1, h - 0.06)), DARK_GLASS)
    movers = [_porthole(r, zc, face, outside)]
    movers.append(_detergent(drawer_x, (panel + 0.004, h - 0.034), face, t, outside))
    movers.append(knob("knob_0", (-0.03, face, h - 0.08), 0.026, STEEL, depth=0.026))
    for k in range(2):
        bx = 0.20 + 0.032 * k
        if bx + 0.012 < w / 2 - t:
            movers.append(button(f"button_{k}", around(0.011, bx), (h - 0.09, h - 0.07), face, PLASTIC))
    return Shape(base, tuple(movers))


def _top_loader(size: Size, outside: Finish) -> Shape:
    """Return a machine filled from above: a lid over an upright drum, dials on a panel at the back."""
    w, d, h = size
    x, y, t = (-w / 2, w / 2), (-d / 2, d / 2), 0.018
    panel, deck = 0.12, h - 0.16
    walls = [box(span, y, (0.015, deck), 0.004) for span in edges(x, t)]
    walls += [box(inset(x, t), (a, a + t), (0.03, deck), 0.002) for a in (y[0], y[1] - t)]
    base = pieces("walls", walls, outside) + pieces("bottom", box(inset(x, t), (y[0] + 0.02, y[1]), (0.015, 0.03)), outside)
    base += pieces(
        "feet", [revolve([(0.02, 0.0), (0.02, 0.015)], 10, (sx * 0.4 * w, sy * 0.4 * d))[0] for sx in (-1, 1) for sy in (-1, 1)], PLASTIC
    )
    back = y[1] - panel
    base += pieces("console", box(x, (back + 0.004, y[1]), (deck, h), 0.008), outside)
    hole_x, hole_y = inset(x, 0.07), (y[0] + 0.07, back - 0.09)
    base += pieces("deck", strips(x, (y[0], back), hole_x, hole_y, (deck, deck + 0.02), 0.003), outside)
    r = 0.5 * min(hole_x[1] - hole_x[0], hole_y[1] - hole_y[0])
    middle = (0.0, (hole_y[0] + hole_y[1]) / 2)
    base += staves("drum", ring((r, r), (r - 0.01, r - 0.01), (0.2, deck - 0.002), 24, middle), STEEL)
    base += pieces("drum_end", slab(circle(r, 24, middle), (0.185, 0.2)), STEEL)
    z = deck + 0.022
    cover_y = (y[0] + 0.02, back - 0.042)
    lid_parts = pieces("lid", box(inset(x, 0.02), cover_y, (z, z + 0.018), 0.004), outside, group="lid")
    pane = box((hole_x[0], hole_x[1]), (hole_y[0], hole_y[1]), (z + 0.018, z + 0.0205), 0.001)
    lid_parts += pieces("lid_glass", pane, DARK_GLASS, group="lid")
    lid_parts += pieces("lid_grip", box((-0.06, 0.06), (y[0], cover_y[0]), (z + 0.004, z + 0.014), 0.002), PLASTIC, "line_fixed_handle")
    movers = [lid("lid", lid_parts, (0.0, cover_y[1], z), math.radians(85))]
    face, at = back + 0.004, 0.5 * (z + 0.03 + h)
    movers += [knob(f"knob_{k}", (float(f) * w, face, at), 0.022, STEEL, depth=0.02) for k, f in enumerate((-0.36, -0.24))]
    movers += [button(f"button_{k}", (0.26 * w + 0.03 * k, 0.26 * w + 0.03 * k + 0.02), around(0.008, at), face, PLASTIC) for k in range(3)]
    base += pieces("display", box((-0.08, 0.08), (face - 0.002, face), around(0.014, at)), DARK_GLASS, group="display")
    return Shape(base, tuple(movers))


def _cabinet(x: Interval, y: Interval, h: float, t: float, finish: Finish) -> Pieces:
    """Return the housing without its front: sides, top, bottom, back and four feet."""
    parts = pieces("top", box(x, y, (h - 0.03, h), 0.004), finish)
    parts += pieces(
        "sides",
        [box(span, (y[0] + t, y[1]), (0.012, h - 0.03)) for span in edges(x, t)],
        finish,
    )
    parts += pieces("bottom", box(inset(x, t), (y[0] + 0.03, y[1]), (0.012, 0.03)), finish)
    parts += pieces("back", box(inset(x, t), (y[1] - 0.01, y[1]), (0.03, h - 0.03)), finish)
    feet = [revolve([(0.02, 0.0), (0.02, 0.012)], 10, (px, py))[0] for px in inset(x, 0.06) for py in inset(y, 0.06)]
    return parts + pieces("feet", feet, PLASTIC)


def _on_square(angle: float, x: Interval, z: Interval, zc: float) -> tuple[float, float]:
    """Return where a ray from (0, zc) leaves the rectangle, snapped to its corners at the diagonals of 45 degrees."""
    c, s = math.cos(angle), math.sin(angle)
    if abs(abs(c) - abs(s)) < 1e-9:
        return (x[1] if c > 0 else x[0], z[1] if s > 0 else z[0])
    scale = 1 / max(abs(c), abs(s))
    half_x, half_z = (x[1] - x[0]) / 2, (z[1] - zc if s > 0 else zc - z[0])
    return (c * scale * half_x, zc + s * scale * half_z)


def _porthole(r: float, zc: float, face: float, finish: Finish) -> Mover:
    """Return the round door: a rim and a bulging glass, hinged at the left."""
    rim = standing(ring((r, r - 0.012), (r - 0.055, r - 0.055), (0.003, 0.035), 24), (0, face, zc))
    glass = standing(revolve([(r - 0.055, 0.006), (r - 0.055, 0.02), (0.6 * r, 0.032)], 24), (0, face, zc))
    grip = box((r - 0.045, r - 0.012), (face - 0.043, face - 0.03), around(0.05, zc), 0.003)
    rim_finish = Finish("door_rim", (0.3, 0.3, 0.31), 0.3, 0.5, density=1500)
    parts: Pieces = pieces("door_rim", rim, rim_finish, group="door") + pieces(
        "door_glass", glass, replace(DARK_GLASS, opacity=0.45, name="door_glass"), group="door"
    )
    parts += pieces("handle", grip, finish if finish is not ENAMEL else PLASTIC_WHITE, "line_fixed_handle")
    return Mover("door", parts, "revolute", (0, 0, -1), (-r, face - 0.035, zc), math.radians(100), "hinge_door", "door")


def _detergent(x: Interval, z: Interval, face: float, t: float, finish: Finish) -> Mover:
    """Return the detergent drawer: a small box behind its front, with a grip."""
    rect = Rect(x, z, face)
    solids = tray(inset(x, 0.006), (face + t, face + 0.2), inset(z, 0.012), 0.008)
    parts = pieces("front", box(x, (face, face + t), z, 0.003), finish) + pieces("drawer_box", solids, PLASTIC_WHITE)
    middle = (x[0] + x[1]) / 2
    parts += pieces(
        "handle", box(around(0.045, middle), (face - 0.012, face), (z[1] - 0.012, z[1] - 0.004), 0.001), PLASTIC, "line_fixed_handle"
    )
    return Mover("detergent", parts, "prismatic", (0, -1, 0), (middle, rect.y, (z[0] + z[1]) / 2), 0.15, "slider_drawer", "drawer")
