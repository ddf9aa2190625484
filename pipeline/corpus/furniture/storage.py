"""Storage furniture: nightstands, wardrobes, chests, sideboards, TV stands, cabinets for wine, shoes and children; bookcases and open shelves with books on them."""

import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.casework import Case, Cell, Column, Feet, case, drawers, grid
from pipeline.corpus.furniture.finishes import COLORS, Finish, Finishes, lacquer, one_of, pick
from pipeline.corpus.furniture.fronts import FrontStyle, HandleStyle, PanelStyle
from pipeline.corpus.furniture.intervals import Interval, around
from pipeline.corpus.furniture.shape import Piece, Pieces, Shape, pieces
from pipeline.corpus.furniture.solids import box, rod

BOOK_COLORS = ("terracotta", "navy", "sage", "ivory")


def front_style(rng: np.random.Generator, finishes: Finishes, panels: str = "") -> FrontStyle:
    """Draw how the fronts of a model look: as its style has it, unless `panels` are named."""
    panel: PanelStyle = pick(rng, panels or finishes.style.fronts)  # type: ignore[assignment]
    handle: HandleStyle = pick(rng, finishes.style.handles)  # type: ignore[assignment]
    return FrontStyle(panel, handle, finishes.front, finishes.handle)


def case_style(
    rng: np.random.Generator, finishes: Finishes, feet: str, height: Interval, panels: str = "", *, style: FrontStyle | None = None
) -> Case:
    """Draw how a carcass is made, and how its fronts look where no `style` says so; `height` of its feet [m]."""
    style = style or front_style(rng, finishes, panels)
    kind: Feet = pick(rng, feet)  # type: ignore[assignment]
    tall = float(rng.uniform(*height))
    metal_feet = kind in ("sled", "hairpin")
    return Case(
        body=finishes.body,
        style=style,
        feet=kind,
        feet_height={"plinth": 0.05, "none": 0.0}.get(kind, tall),
        feet_finish=finishes.handle if metal_feet else (finishes.body if kind == "plinth" else finishes.accent),
        top_thickness=float(rng.uniform(0.018, 0.03)),
        overhang=float(rng.choice([0.0, 0.0, 0.008])),
        inset=bool(rng.random() < 0.4),
    )


def nightstand(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """One column: drawers, a drawer over a shelf, or a drawer over a door."""
    how = case_style(rng, finishes, "tapered square sled plinth hairpin", (0.07, min(0.2, 0.35 * h)))
    if form == "drawers":
        cells = drawers(2 if h - how.feet_height < 0.5 else 3)
    elif form == "shelf_drawer":
        cells = (Cell("drawer", 1.0), Cell("open", float(rng.uniform(0.9, 1.6))))
    else:
        cells = (Cell("drawer", 0.6), Cell("left" if rng.random() < 0.5 else "right", 1.2, 1))
    return case((w, d, h), [Column(1, cells)], how)


def wardrobe(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build columns of doors with a rail behind, over drawers or beside shelves, or sliding doors on two tracks."""
    how = replace(case_style(rng, finishes, "plinth plinth square none", (0.08, 0.12)), board=0.02)
    if form in ("sliding", "sliding_mirror"):  # leaves that pass each other between the sides
        looks = replace(flush_front(how.style), handle="none", thickness=0.022)
        looks = replace(looks, panel="mirror") if form == "sliding_mirror" else looks
        how = replace(how, style=looks, inset=True, overhang=0.0, feet="plinth", feet_height=0.05, feet_finish=finishes.body)
        columns = grid(1, Cell("slide", 1.0, int(rng.integers(2, 5))))
    else:
        columns = _wardrobe_columns(rng, form, w, h, how)
    shape = case((w, d, h), columns, how)
    rails: Pieces = ()  # to hang clothes on, under every hat shelf
    for name, (low, high) in ((p.name, p.solid.bounds()) for p in shape.base if p.name.endswith("_board_0")):
        if high[0] - low[0] > 0.35 and high[2] > 1.4:
            y, z = (low[1] + high[1]) / 2, low[2] - 0.06
            rails += pieces(f"{name}_rail", rod((low[0] + 1e-3, y, z), (high[0] - 1e-3, y, z), 0.012), finishes.handle)
    return Shape(shape.base + rails, shape.movers)


def _wardrobe_columns(rng: np.random.Generator, form: str, w: float, h: float, how: Case) -> list[Column]:
    """Return columns of hinged doors: over drawers or before them, under boxes, with a mirror, or beside open shelves."""
    count = max(1, round(w / 0.95))
    inner = int(rng.integers(2, 4)) if form == "inner_drawers" else 0
    doors: tuple[Cell, ...] = (Cell("pair", 3.6, 1, inner=inner),)
    if form == "top_boxes" and h > 2.0:
        doors = (Cell("pair", 0.7), Cell("pair", 3.0, 1))
    if form == "doors_drawers":
        doors = (*doors, *(Cell("drawer", 0.42) for _ in range(int(rng.integers(1, 3)))))
    columns = [Column(1.0, doors) for _ in range(count)]
    if form == "mirror":
        mirror = replace(how.style, panel="mirror", handle="knob" if how.style.handle == "knob" else "edge")
        columns[count // 2] = Column(1.0, (replace(doors[0], panel=mirror), *doors[1:]))
    if form == "doors_open" and w > 1.2:
        shelves = Column(0.45, (Cell("open", 1.0, 3), Cell("drawer", 0.3), Cell("drawer", 0.3)))
        columns.insert(int(rng.integers(0, 2)) * len(columns), shelves)
    elif w / count < 0.6:
        columns = [Column(1.0, (Cell("left", 3.6, 1), *doors[1:]))]
    return columns


def cabinet(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a chest: a grid of drawers, wide or small, a tallboy, drawers over doors, or doors."""
    how = case_style(rng, finishes, "tapered square sled plinth", (0.08, 0.18))
    inner = h - how.feet_height
    count = max(1, min(3, round(w / 0.55)))
    rows = max(2, min(6, round(inner / 0.22)))
    if form == "tallboy":
        columns = grid(1, Cell("drawer", 0.75), *drawers(rows - 1))
    elif form == "apothecary":
        columns = grid(max(2, min(4, round(w / 0.36))), *drawers(max(2, min(3, round(inner / 0.28)))))
    elif form == "drawers":
        rows = min(rows, 12 // count)
        small = rows >= 4 and count >= 2  # a row of small drawers on top of wide ones
        columns = grid(count, Cell("drawer", 0.7 if small else 1.0), *drawers(rows - 1))
    elif form == "mixed":
        columns = [Column(1, (Cell("drawer", 0.5), doors_of(rng, w / count, 1.5, 1))) for _ in range(count)]
        columns[0] = Column(1, drawers(rows))
    else:
        columns = [Column(1, (doors_of(rng, w / count, 1.0, max(1, rows // 2)),)) for _ in range(count)]
    return case((w, d, h), columns, how)


def facing_doors(count: int, shelves: int) -> list[Column]:
    """Return columns of one door each, which open away from the middle."""
    return [Column(1, (Cell("left" if i < count / 2 else "right", 1, shelves),)) for i in range(count)]


def flush_front(style: FrontStyle) -> FrontStyle:
    """Return the style of leaves that pass each other: nothing stands out of them."""
    return replace(style, panel="slab") if style.panel in ("raised", "slats") else style


def doors_of(rng: np.random.Generator, width: float, share: float, shelves: int) -> Cell:
    """Return a cell with one door, or a pair where it is wide."""
    if width > 0.56:
        return Cell("pair", share, shelves)
    return Cell("left" if rng.random() < 0.5 else "right", share, shelves)


def children_cabinet(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Cubes, open and closed, or doors over drawers, in two gay colours."""
    first, second = (str(name) for name in rng.choice(["blush", "dusty_blue", "mint", "mustard", "white"], 2, replace=False))
    style = FrontStyle("slab", "knob", lacquer(rng, first, 0.4), finishes.accent)
    other = replace(style, finish=lacquer(rng, second, 0.4))
    how = case_style(rng, finishes, "plinth square", (0.06, 0.1), style=style)
    count = max(1, min(4, round(w / 0.5)))
    rows = max(2, min(5, round(h / 0.42)))
    if form == "doors_drawers":
        doors = Cell("pair" if w / count > 0.5 else "left", 1.4, 2)
        return case((w, d, h), grid(count, doors, Cell("drawer", 0.4, 0, other), Cell("drawer", 0.4)), how)
    columns = []
    for i in range(count):
        kinds = ["open"] * rows
        if form == "cubes_doors" or rng.random() < 0.7:
            kinds[int(rng.integers(0, rows))] = "left" if i < count / 2 else "right"
            kinds[-1] = "drawer"
        columns.append(Column(1, tuple(Cell(k, 1.0, 0, other if (i + j) % 2 else None) for j, k in enumerate(kinds))))  # type: ignore[arg-type]
    return case((w, d, h), columns, how)


def sideboard(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a low row of doors, hinged or sliding, doors around drawers, or a console; tall ones carry a glazed hutch."""
    count = max(2, min(4, round(w / 0.5)))
    if form == "console" and h < 1.15:
        how = case_style(rng, finishes, "square sled tapered", (0.62 * h, 0.72 * h))
        return case((w, d, h), grid(max(1, count - 1), Cell("drawer")), how)
    how = case_style(rng, finishes, "tapered square sled plinth", (0.09, 0.2))
    if h > 1.35:
        upper, lower = Cell("pair", 1.3, 2, replace(how.style, panel="glass")), Cell("pair", 0.8, 1)
        return case((w, d, h), grid(max(1, round(w / 0.8)), upper, Cell("drawer", 0.25), lower), how)
    if form == "sliding":
        looks = replace(flush_front(how.style), handle="none")
        how = replace(how, style=looks, inset=True, overhang=how.overhang if how.inset else 0.0)
        return case((w, d, h), grid(1, Cell("slide", 1, 1)), how)
    columns = facing_doors(count, 1)
    if form == "mixed":
        columns[count // 2] = Column(1.1, drawers(max(2, round((h - how.feet_height) / 0.2))))
    return case((w, d, h), columns, how)


def tv_stand(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a long low case of drawers, doors, flaps under open shelves, or drawers and doors around an open middle."""
    how = case_style(rng, finishes, "tapered sled square plinth", (0.06, min(0.18, 0.35 * h)))
    count = max(2, min(4, round(w / 0.58)))
    rows = 2 if h - how.feet_height > 0.42 else 1
    if form == "drawers":
        columns = grid(count, *drawers(rows))
    elif form == "doors":
        columns = facing_doors(count, rows - 1)
    elif form == "flaps":
        columns = grid(count, Cell("open", 0.45), Cell("flap", 1.0))
    else:
        middle = [Column(1.3, (Cell("open", 1, 1),))] * (2 if count == 4 else 1)
        columns = [Column(1, drawers(rows)), *middle, Column(1, (Cell("right", 1, 0),))]
    return case((w, d, h), columns, how)


def wine_cabinet(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Glass doors over shelves, or a rack of bottles over doors."""
    how = case_style(rng, finishes, "plinth square tapered", (0.08, 0.14), "shaker slab")
    count = max(1, round(w / 0.6))
    if form == "glass":
        door = doors_of(rng, w / count, 2.0, max(2, round(h / 0.4)))
        return case((w, d, h), grid(count, replace(door, panel=replace(how.style, panel="glass")), Cell("drawer", 0.35)), how)
    columns = [Column(1, (Cell("open", 1.3, 2), doors_of(rng, w / count, 1.0, 1))) for _ in range(count)]
    shape = case((w, d, h), columns, how)
    bottles: list[Piece] = []
    for board in [p for p in shape.base if "_board_" in p.name and p.name.split("_")[1] == "0"]:
        low, high = board.solid.bounds()
        for k in range(min(6, int((high[0] - low[0]) / 0.105))):
            x, z, name = low[0] + 0.06 + 0.105 * k, high[2] + 0.041, f"bottle_{board.name}_{k}"
            start, shoulder, end = low[1] + 0.03, low[1] + 0.03 + 0.08, min(low[1] + 0.03 + 0.28, high[1] - 0.005)
            bottle = [rod((x, start, z), (x, shoulder, z), 0.014, n=8), rod((x, shoulder, z), (x, end, z), 0.038, n=10)]
            bottles += pieces(name, bottle, "bottle", group=name)
    return Shape(shape.base + tuple(bottles), shape.movers)


def shoe_cabinet(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Louvred doors over shelves, or flaps that tip forward."""
    how = case_style(rng, finishes, "plinth square tapered", (0.06, 0.12), "slats shaker slab" if form == "doors" else "slab slab shaker")
    count = max(1, round(w / 0.8))
    if form == "doors":
        return case((w, d, h), grid(count, Cell("pair", 1, max(2, round(h / 0.25)))), how)
    flaps = (Cell("flap"),) * max(2, round((h - how.feet_height) / 0.38))
    shape = case((w, d, h), grid(count, *flaps), how)
    return Shape(shape.base, tuple(replace(m, upper=math.radians(50)) for m in shape.movers))


def bookshelf(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Open shelves, open shelves over doors, or glass doors."""
    how = replace(case_style(rng, finishes, "plinth plinth none square", (0.07, 0.1), "slab shaker"), overhang=0.0)
    if form == "ladder":
        return ladder_shelf(w, d, h, finishes, max(4, round(h / 0.38)))
    count = max(1, min(4, round(w / 0.8)))
    rows = max(3, round(h / 0.36))
    if form == "open":
        columns = grid(count, Cell("open", 1, rows - 1))
    elif form == "glass":
        door = replace(doors_of(rng, w / count, 3.0, rows - 2), panel=replace(how.style, panel="glass"))
        columns = grid(count, door, Cell("drawer", 0.55))
    else:
        columns = [Column(1, (Cell("open", 1.9, rows - 3), doors_of(rng, w / count, 0.9, 1))) for _ in range(count)]
    shape = case((w, d, h), columns, how)
    return Shape(shape.base + (books(rng, shape) if form == "open" else ()), shape.movers)


def books(rng: np.random.Generator, shape: Shape) -> Pieces:
    """Return a few rows of books on the boards of open shelves."""
    parts: list[Piece] = []
    palette = [Finish(f"book_{n}", COLORS[n], 0.8, density=600) for n in BOOK_COLORS]
    for board in [p for p in shape.base if "_board_" in p.name or p.name == "bottom"]:
        low, high = board.solid.bounds()
        if rng.random() < 0.45 or high[0] - low[0] < 0.2:
            continue
        x, y = low[0] + 0.01 + float(rng.uniform(0, 0.4)) * (high[0] - low[0]), low[1] + 0.02
        for _ in range(int(rng.integers(2, 6))):
            t, tall, deep = float(rng.uniform(0.02, 0.05)), float(rng.uniform(0.16, 0.24)), float(rng.uniform(0.12, 0.17))
            if x + t > high[0] - 0.01:
                break
            parts += pieces("books", box((x, x + t), (y, min(y + deep, high[1])), (high[2], high[2] + tall)), one_of(rng, palette))
            x += t + 0.0015
    return tuple(parts)


def ladder_shelf(w: float, d: float, h: float, finishes: Finishes, rows: int) -> Shape:
    """Boards in two side frames of square posts, open at the back."""
    t = 0.028
    posts = [box((x, x + t), (y, y + t), (0, h), 0.002) for x in (-w / 2, w / 2 - t) for y in (-d / 2, d / 2 - t)]
    rungs = [box((x + 0.004, x + t - 0.004), around(d / 2 - t), (z, z + 0.03)) for x in (-w / 2, w / 2 - t) for z in (0.08, h - 0.06)]
    base = pieces("frame", posts + rungs, finishes.accent)
    for k in range(rows):
        z = 0.12 + (h - 0.2) * k / (rows - 1)
        base += pieces(f"board_{k}", box(around(w / 2 - t), around(d / 2 - 0.002), (z, z + 0.02), 0.002), finishes.body)
    return Shape(base)


def shelf(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Shape:
    """Build a ladder shelf, a frame with uprights, or stacked cubes."""
    if form == "cubes":
        how = replace(case_style(rng, finishes, "none plinth", (0, 0)), overhang=0.0)
        cubes = (Cell("open"),) * max(1, round(h / 0.36))
        shape = case((w, d, h), grid(max(1, round(w / 0.4)), *cubes), how, reserve=0.0)
        return Shape(shape.base + books(rng, shape))
    return ladder_shelf(w, d, h, finishes, max(2, round(h / (0.3 if form == "frame" else 0.4))))
