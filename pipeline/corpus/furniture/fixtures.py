"""What is built in: kitchen units, vanities, bathroom fixtures, room doors."""

import itertools
import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture import solids
from pipeline.corpus.furniture.bent import split_bent_quads
from pipeline.corpus.furniture.casework import Case, Cell, Column, case
from pipeline.corpus.furniture.catalogue import series_rng
from pipeline.corpus.furniture.finishes import COLORS, Finish, Finishes, Material, draw_material, one_of, pick
from pipeline.corpus.furniture.fronts import FrontStyle, Rect, lid, panel, reach, top_button
from pipeline.corpus.furniture.intervals import Interval, Spot, around, between, edges, inset
from pipeline.corpus.furniture.shape import UP, Axis3, Mover, Pieces, Shape, group_pieces, join_shapes, pieces, staves
from pipeline.corpus.furniture.solids import at_height, box, circle, cushion, revolve, ring, rod, rounded_rectangle, shell, slab, stack
from pipeline.corpus.furniture.storage import front_style

WORKTOP = 0.9  # height at which one works in a kitchen [m]
PLINTH = 0.1  # height of a kitchen unit's recessed plinth [m]
NOSE = 0.018  # how far a worktop stands out over its fronts [m]
LEAF = 0.04  # thickness of a leaf [m]
LEVER = 0.055  # how far a lever stands out of its leaf [m]


def unit_style(rng: np.random.Generator, finishes: Finishes, panels: str = "") -> Case:
    """Draw how a unit is made: boards of the body's finish, a stone or wooden counter, fronts that cover the edges."""
    style = front_style(rng, finishes, panels)
    counter = draw_material(rng, "stone", "marble", finishes.body)
    return Case(finishes.body, style, "plinth", PLINTH, "plastic", top=counter, top_thickness=0.038, nose=NOSE)


def kitchen_cabinet(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a base unit with doors, drawers, a drawer over doors, or for a corner, under a counter."""
    how = unit_style(series_rng(finishes.style_name), finishes)
    count = max(1, round(w / 0.6))
    door = Cell("left" if rng.random() < 0.5 else "right", 1.0, 1)
    if form == "drawers":
        columns = [Column(1, (Cell("drawer", 0.45), Cell("drawer", 0.8), Cell("drawer", 1.0)))] * max(1, round(w / 0.8))
    elif form == "corner":
        blank = Column(0.8, (Cell("blank", 1.0),))
        columns = [blank, Column(1, (Cell("right", 1.0, 1),))] if rng.random() < 0.5 else [Column(1, (Cell("left", 1.0, 1),)), blank]
    elif form == "mixed":
        columns = [Column(1, (Cell("drawer", 0.28), replace(door, kind="left" if i < count / 2 else "right"))) for i in range(count)]
    else:
        columns = [Column(1, (Cell("pair", 1.0, 1),))] * max(1, round(w / 1.0)) if w > 0.55 else [Column(1, (door,))]
    return case((w, d, h), columns, how)


def wall_cabinet(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a wall unit with doors, plain or glazed, or with fronts that lift."""
    how = unit_style(series_rng(finishes.style_name), finishes, "glass" if form == "glass" else "")
    how = replace(how, feet="none", feet_height=0.0, nose=0.0, top=finishes.body, top_thickness=0.018)
    count = max(1, round(w / 0.9))
    if form == "lift":
        cell = (Cell("lift", 1.0, 0), Cell("lift", 1.0, 0)) if h > 0.75 else (Cell("lift", 1.0, 1),)
        return case((w, d, h), [Column(1, cell)] * count, how)
    return case((w, d, h), [Column(1, (Cell("pair" if w / count > 0.5 else "left", 1.0, 2),))] * count, how)


def tall_unit(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a unit as tall as the room's doors: a larder of two doors, one that is pulled out, or doors over drawers."""
    how = replace(unit_style(series_rng(finishes.style_name), finishes), top=finishes.body, top_thickness=0.018, nose=0.0)
    side = "left" if rng.random() < 0.5 else "right"
    door = Cell("pair" if w > 0.75 else side, 1.0, 3)  # type: ignore[arg-type]
    cells: tuple[Cell, ...]
    if form == "larder":
        cells = (replace(door, share=1.3), replace(door, share=1.0, shelves=1, inner=int(rng.integers(0, 3))))
    elif form == "pull_out":
        cells = (replace(door, share=0.35, shelves=0), Cell("drawer", 1.2), Cell("drawer", 0.7))
    else:
        cells = (replace(door, share=1.6), Cell("drawer", 0.3), Cell("drawer", 0.45), Cell("drawer", 0.45))
    return case((w, d, h), [Column(1, cells)], how)


def tap(y: float, z: float, height: float, reach_out: float, finish: Material) -> Shape:
    """Return a tap at (0, y, z): a column, a spout that reaches towards the front, and a lever at its side that turns up."""
    r, radius = 0.011, reach_out / 2
    steps = np.linspace(0, math.pi * 0.85, 6)
    points = [(0.0, y, z)]
    points += [(0.0, y - radius + radius * math.cos(a), z + height - radius + radius * math.sin(a)) for a in steps]
    column = [rod(a, b, r, n=10) for a, b in itertools.pairwise(points)] + revolve([(0.024, z), (0.022, z + 0.02)], 14, (0.0, y))
    root = (r + 0.002, y, z + 0.055)
    arm = [rod(root, (root[0] + 0.014, y, root[2]), 0.010, n=10)]
    arm.append(box((root[0] + 0.014, root[0] + 0.022), (y - 0.075, y + 0.008), around(0.006, root[2]), 0.002))
    parts = pieces("lever", arm, finish, group="lever")
    lever = Mover("tap_lever", parts, "revolute", (-1, 0, 0), root, 1.0, "hinge_handle", "lever", (1.0, 0.0, 0.0))
    return Shape(pieces("tap", column, finish), (lever,))


def _sink_into_top(shape: Shape, x: Interval, y: Interval, rim: float, depth: float, finish: Material) -> Shape:
    """Return the case with a hole in its top over `x`, `y`, and under it an open basin: a bottom and four walls that end at `rim` [m]."""
    old = next(p for p in shape.base if p.name == "top")
    (x0, y0, z0), (x1, y1, z1) = old.solid.bounds().tolist()
    top = pieces("top", solids.strips((x0, x1), (y0, y1), x, y, (z0, z1), 0.002), old.finish)
    low, wall = rim - depth, 0.008
    basin = pieces("bowl", [box(x, y, (low - wall, low)), *solids.walls(x, y, (low, rim), wall)], finish)
    drain = revolve([(0.025, low), (0.022, low + 0.003)], 12, ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2))
    return Shape(tuple(p for p in shape.base if p is not old) + top + basin + pieces("drain", drain, "steel"), shape.movers)


def sink_cabinet(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a base unit whose counter holds a bowl and a tap, over doors or a deep drawer."""
    body = min(WORKTOP, h - 0.1)  # the tap stands above the counter
    how = unit_style(series_rng(finishes.style_name), finishes)
    cells: tuple[Cell, ...] = (Cell("pair" if w > 0.56 else "left", 1.0, 0),)
    if form == "drawer":  # the bowl leaves no room for a drawer above
        cells = (Cell("blank", 0.5), Cell("drawer", 0.9))
    shape = case((w, d, body), [Column(1, cells)], how)
    face = -d / 2 + max(reach(how.style.handle), how.nose)
    hole = around(min(0.3, 0.5 * w - 0.09)), (face + 0.09, d / 2 - 0.13)
    shape = _sink_into_top(shape, *hole, body - 0.003, 0.17, "steel")
    return join_shapes(shape, tap(d / 2 - 0.065, body, h - body, 0.2, finishes.handle))


def vanity(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a washstand: doors or drawers under a counter with a vessel or an inset basin and a tap."""
    body = h - 0.17
    legs = rng.random() < 0.4
    how = replace(unit_style(rng, finishes), overhang=0.006, nose=0.0)
    how = replace(how, feet="square", feet_height=0.16, feet_finish=finishes.accent) if legs else replace(how, feet_height=0.08)
    how = replace(how, top=one_of(rng, ("ceramic", "marble", "stone")), top_thickness=0.03)
    vessel = rng.random() < 0.45 or form == "drawers"
    if form == "drawers":
        columns = [Column(1, (Cell("drawer"), Cell("drawer")))] * max(1, round(w / 0.6))
    else:
        columns = [Column(1, (Cell("pair", 1.0, 0 if not vessel else 1),))]
    shape = case((w, d, body), columns, how)
    face = -d / 2 + max(reach(how.style.handle), how.overhang)
    if vessel:
        r, middle = min(0.36 * (d - 0.1), 0.19), (face + d / 2 - 0.11) / 2
        basin = _vessel(min(r * 1.2, 0.4 * w), r, (0.0, middle), (body, body + 0.12))
        return join_shapes(shape, Shape(basin), tap(d / 2 - 0.045, body, h - body, 0.13, finishes.handle))
    hole = around(min(0.26, 0.5 * w - 0.07)), (face + 0.06, d / 2 - 0.11)
    shape = _sink_into_top(shape, *hole, body - 0.002, 0.13, "ceramic")
    return join_shapes(shape, tap(d / 2 - 0.055, body, h - body, 0.13, finishes.handle))


def _vessel(rx: float, ry: float, centre: Spot, z: Interval) -> Pieces:
    """Return an oval open basin that stands on a counter, its wall flaring upwards."""

    def oval(scale: float, height: float) -> NDArray[np.float64]:
        return at_height(circle(rx * scale, 24, centre, ry / rx), height)

    low = z[0] + 0.012
    wall = shell([oval(0.72, low), oval(1.0, z[1])], [oval(0.66, low), oval(0.94, z[1])])
    return staves("basin", wall, "ceramic") + pieces("basin_floor", stack([oval(0.70, z[0]), oval(0.72, low)]), "ceramic")


def _oval(rx: float, y: Interval, z: float) -> NDArray[np.float64]:
    """Return an ellipse (24, 3) that spans +-rx and the interval `y` at height `z`."""
    ry = (y[1] - y[0]) / 2
    return at_height(circle(rx, 24, (0.0, (y[0] + y[1]) / 2), ry / rx), z)


def toilet(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a bowl on a foot, a tank with a button or a lever, and a seat and a lid that fold up against the tank."""
    rim = 0.52 * h
    tank_y = (d / 2 - 0.27 * d, d / 2)
    bowl_y = (-d / 2 + 0.004, tank_y[0] - 0.035)
    rx = 0.47 * w
    cy, ry = (bowl_y[0] + bowl_y[1]) / 2, (bowl_y[1] - bowl_y[0]) / 2

    def oval(across: float, along: float, z: float) -> NDArray[np.float64]:
        return _oval(across * rx, around(along * ry, cy), z)

    foot = split_bent_quads(stack([oval(0.74, 0.80, 0.0), oval(0.70, 0.76, 0.10 * h)]))
    neck = split_bent_quads(stack([oval(0.70, 0.76, 0.10 * h), oval(0.90, 0.90, 0.62 * rim)]))
    outer = [oval(k, k, z) for k, z in ((0.90, 0.62 * rim), (1.0, rim))]
    wall = shell(outer, [oval(k, k, z) for k, z in ((0.42, 0.62 * rim), (0.76, rim))])
    heel, shelf = (around(0.27 * w), (cy + 0.3 * ry, d / 2 - 0.06)), (around(0.36 * w), (bowl_y[1] - 0.05, d / 2 - 0.012))
    outlines = [(heel, 0.0), (shelf, 0.8 * rim), (shelf, rim)]
    bridge = solids.hull(np.concatenate([at_height(rounded_rectangle(*spans, 0.04), z) for spans, z in outlines]))
    half = (0.44 if form == "lever" else 0.5) * w  # a lever stands out of the tank's side
    base = pieces("bowl", [foot, neck], "ceramic") + staves("bowl", wall, "ceramic") + pieces("bridge", bridge, "ceramic")
    base += pieces("tank", cushion((-half, half), tank_y, (rim, h - 0.03), 0.025), "ceramic")
    base += pieces("tank_lid", cushion((-half, half), (tank_y[0] - 0.006, tank_y[1]), (h - 0.029, h - 0.006), 0.01), "ceramic")
    hinge_y, middle = bowl_y[1] - 0.012, sum(tank_y) / 2
    seat_z, lid_z = (rim + 0.004, rim + 0.019), (rim + 0.022, rim + 0.036)
    sx, span = 0.98 * rx, (bowl_y[0] - 0.002, hinge_y)
    hole = [_oval(0.66 * sx, (cy - 0.74 * ry, hinge_y - 0.09), z) for z in seat_z]
    seat = staves("seat", shell([_oval(sx, span, z) for z in seat_z], hole), "plastic_white")
    cover = pieces("lid", slab(_oval(sx, span, 0.0)[:, :2], lid_z, 0.004), "plastic_white")
    movers = [lid("seat", seat, (0.0, hinge_y, seat_z[1]), math.radians(92))]
    movers.append(lid("lid", cover, (0.0, hinge_y, lid_z[1]), math.radians(92), parent="seat"))  # a seat that is lifted lifts its lid
    if form == "lever":
        movers.append(_lever(half, middle, h))
    elif form == "dual":  # the large flush and the small one
        for name, x in (("small", (-0.035, -0.002)), ("large", (0.002, 0.045))):
            movers.append(top_button(name, x, around(0.018, middle), (h - 0.0045, h), "steel", 0.0015))
    else:
        cap = pieces("button", revolve([(0.022, h - 0.0045), (0.022, h - 0.001), (0.018, h)], 16, (0.0, middle)), "steel")
        movers.append(Mover("button", cap, "prismatic", (0, 0, -1), (0.0, middle, h), 0.0015, "slider_button", "button", UP))
    return Shape(base, tuple(movers))


def _lever(half: float, y: float, h: float) -> Mover:
    """Return the flushing lever at the left side of the tank: its front end turns down by half a radian."""
    at = (-half, y + 0.03, h - 0.1)
    arm = box((at[0] - 0.020, at[0] - 0.012), (at[1] - 0.085, at[1] + 0.008), around(0.008, at[2]), 0.002)
    parts = pieces("lever", [rod(at, (at[0] - 0.012, at[1], at[2]), 0.010, n=10), arm], "steel", group="lever")
    return Mover("lever", parts, "revolute", (1, 0, 0), at, 0.5, "hinge_handle", "lever", (-1.0, 0.0, 0.0))


def _along(u: NDArray[np.float64], a: float, b: float, power: float) -> NDArray[np.float64]:
    """Return the superellipse |x/a|^p + |y/b|^p = 1 along rays `u`, (n, 2)."""
    reach = (np.abs(u[:, 0] / a) ** power + np.abs(u[:, 1] / b) ** power) ** (-1 / power)
    return np.asarray(u * reach[:, None])


def bathtub(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a tub with aprons, or one that stands free on its oval foot; a tap at its head."""
    a, b, low = w / 2, d / 2, 0.14
    rim = h if form == "free" else h - 0.12
    corner = math.atan2(d, w)  # rays through the corners too make staves with plane sides, so each is convex
    at_corners = [corner, math.pi - corner, math.pi + corner, -corner + 2 * math.pi]
    angles = np.sort(np.concatenate([np.linspace(0, 2 * math.pi, 28, endpoint=False), at_corners]))
    u = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    outer = _along(u, a, b, 2.6) if form == "free" else u / np.maximum(np.abs(u[:, :1]) / a, np.abs(u[:, 1:]) / b)
    inner = _along(u, a - 0.07, b - 0.07, 3.0)
    foot = 0.82 * outer if form == "free" else outer
    wall = shell([at_height(foot, low), at_height(outer, rim)], [at_height(0.8 * inner, low), at_height(inner, rim)])
    floor = box((-a, a), (-b, b), (0.0, low)) if form == "apron" else slab(foot, (0.0, low))
    base = pieces("tub", [*wall, floor], "ceramic")
    if form == "apron":
        x = a - 0.035
        spout = [rod((x, 0, rim), (x, 0, h - 0.01), 0.014, n=10), rod((x, 0, h - 0.018), (x - 0.13, 0, h - 0.03), 0.012, n=10)]
        spout += [rod((x, s * 0.09, rim), (x, s * 0.09, rim + 0.05), 0.016, 0.02, 10) for s in (-1, 1)]
        base += pieces("tap", spout, finishes.handle)
    return base


def shower(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a tray with two glass walls, an open entrance at the front, a rail with a head and a mixer at the back wall."""
    tray, metal = 0.06, finishes.handle
    x, y, back = around(w / 2), around(d / 2), d / 2 - 0.05
    basin = [box(x, y, (0, tray - 0.02), 0.003), *solids.walls(x, y, (tray - 0.02, tray), 0.04)]
    side = -1 if rng.random() < 0.5 else 1
    pane = side * (w / 2 - 0.012)
    base = pieces("tray", basin, "ceramic")
    base += pieces("glass_side", box(around(0.004, pane), (y[0] + 0.012, y[1] - 0.002), (tray, h)), "glass")
    end = side * (w / 2 - 0.02 - 0.42 * w)
    base += pieces("glass_front", box(between(side * (w / 2 - 0.018), end), (y[0] + 0.008, y[0] + 0.016), (tray, h)), "glass")
    posts = [box(around(0.01, px), (y[0] + 0.002, y[0] + 0.022), (tray, h), 0.002) for px in (end, pane)]
    pole = [rod((0, back, 0.95), (0, back, h - 0.01), 0.011, n=8), rod((0, back, h - 0.02), (0, d / 2 - 0.33, h - 0.02), 0.010, n=8)]
    pole += [rod((0, d / 2, z), (0, back, z), 0.009, n=8) for z in (1.0, h - 0.12)]
    pole += revolve([(0.11, h - 0.055), (0.11, h - 0.045), (0.03, h - 0.022)], 20, (0.0, d / 2 - 0.33))
    base += pieces("posts", posts, metal) + pieces("rail", pole, metal)
    base += pieces("mixer", box((-0.13, 0.13), (back, d / 2), (1.02, 1.07), 0.008), metal)
    return base + pieces("drain", ring((0.045, 0.045), (0.03, 0.03), (tray - 0.02, tray - 0.017), 16), "steel")


def room_door(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a door in its frame: flush, with two panels, or glazed; it opens towards the front."""
    white = Finish("door_white", COLORS["white"], 0.4, density=500)
    finish = white if rng.random() < 0.5 else finishes.body
    t, stop = 0.045, 0.012
    y = (-d / 2 + LEVER, d / 2)
    jambs = [box(span, y, (0, h), 0.003) for span in edges(around(w / 2), t)]
    base = pieces("frame", [*jambs, box(around(w / 2 - t), y, (h - t, h), 0.003)], finish)
    inner = around(w / 2 - t)
    behind = (y[0] + LEAF + 0.004, y[1])
    stops = [box(span, behind, (0, h - t)) for span in edges(inner, stop)]
    base += pieces("stops", [*stops, box(inset(inner, stop), behind, (h - t - stop, h - t))], finish)
    rect = Rect(inset(inner, 0.003), (0.006, h - t - 0.003), y[0])
    side = 1.0 if rng.random() < 0.5 else -1.0  # of the hinge: 1 at the left
    pivot, grip = (rect.x[0], rect.x[1] - 0.065) if side > 0 else (rect.x[1], rect.x[0] + 0.065)
    style, at = FrontStyle("slab", "none", finish, finishes.handle, LEAF), (pivot, rect.y, 1.0)
    if form == "flush":
        parts = panel(rect, style)
    else:  # two panels, of which the upper one may be glazed
        looks = replace(style, panel="glass" if form == "glazed" else pick(rng, "shaker raised"))  # type: ignore[arg-type]
        cut, low = rect.z[0] + 0.42 * rect.height, replace(looks, panel="shaker") if form == "glazed" else looks
        halves = panel(replace(rect, z=(rect.z[0], cut)), low) + panel(replace(rect, z=(cut, rect.z[1])), looks)
        parts = group_pieces(halves, "leaf")
    leaf = Mover("leaf", parts, "revolute", (0, 0, -side), at, math.radians(100), "hinge_door", "door")
    levers = [_door_lever("lever_front", (grip, rect.y, 1.02), -1.0, side, finishes.handle)]
    levers.append(_door_lever("lever_back", (grip, rect.y + LEAF, 1.02), 1.0, side, finishes.handle))
    return Shape(base, (leaf, *levers))


def _door_lever(name: str, at: Axis3, outwards: float, side: float, finish: Material) -> Mover:
    """Return a lever on one face of the leaf: a rose, a neck and an arm towards the hinge, which is pressed down."""
    turn = math.pi / 2 if outwards < 0 else -math.pi / 2
    rose = [s.rotate("x", turn).translate(at) for s in revolve([(0.024, 0.0005), (0.024, 0.007), (0.020, 0.009)], 16)]
    neck = [s.rotate("x", turn).translate(at) for s in revolve([(0.010, 0.009), (0.010, LEVER - 0.004)], 10)]
    arm_y = between(at[1] + outwards * (LEVER - 0.016), at[1] + outwards * LEVER)
    arm = box(between(at[0] + side * 0.010, at[0] - side * 0.115), arm_y, around(0.010, at[2]), 0.003)
    parts = pieces("rose", rose, finish) + pieces("lever", [*neck, arm], finish)
    axis = (0.0, -side, 0.0)
    return Mover(name, parts, "revolute", axis, at, math.radians(40), "hinge_handle", "handle", (0.0, outwards, 0.0), "leaf")
