"""3D-FRONT houses with what real ones are full of, made by code, and the openings that a person would see in them.

One flat, drawn in as many ways as real files were seen to be: a door is a reveal (mesh Door), a frame around it that is 13 cm wider (Pocket), a
threshold of height 0 typed Door or Hole, and a leaf (furniture record), closed or ajar; floors end at the walls, reach under the doors, or touch.
Coordinates are the file's: y up, plan (x, z).
"""

from dataclasses import dataclass, field

import numpy as np

from tests.sources import making
from tests.sources.making import child, slab

T = 0.12  # inner walls [m]
OUT = 0.24  # outer walls [m]
FRAME = 0.064  # of a casing beside what is clear [m]


@dataclass
class Spec:
    """An opening in the wall between `low` and `high` (x0, z0, x1, z1): from `a` to `b` along it; `rooms` by type, one where it leads outside."""

    rooms: tuple
    wall: tuple
    a: float
    b: float
    kind: str = "door"
    top: float = 2.1
    sill: float = 0.0

    @property
    def along_x(self):
        return abs(self.wall[2] - self.wall[0]) > abs(self.wall[3] - self.wall[1])

    def box(self, a, b, grow=0.0):
        """Return (x0, z0, x1, z1) from a to b along the wall, through all of it."""
        x0, z0, x1, z1 = self.wall
        return (a, z0 - grow, b, z1 + grow) if self.along_x else (x0 - grow, a, x1 + grow, b)


@dataclass
class Ways:
    """How a house is drawn."""

    dialect: str = "0.11"
    casing: bool = True
    inner: bool = True  # the Pocket has faces towards the opening
    threshold: tuple = ("Door", "Hole")
    ajar: float = 0.0  # m from the reveal's middle to that of the leaf
    sized: bool = False  # leaves have a size: the frame's
    reveal: str = "whole"  # or "jambs": a mesh for each; "twice": from both rooms; "hole": only Hole meshes, no Door
    floors: str = "walls"  # or "half", "full": strips under doors; "touch": no walls between floors
    walls: bool = True  # inner walls are drawn
    bay: str = ""  # "floor": the floor has it; "out": it has not
    balcony: bool = False  # behind a sliding door as wide as itself
    wide: bool = False  # openings from corner to corner
    panes: bool = False  # two windows that adjoin
    swung: float = 0.0  # leaves are meshes of type Door, open by so many rad
    closet: float = 0.67  # m that the bathroom's door is wide
    litter: bool = False
    turn: int = 0
    types: dict = field(default_factory=dict)


ROOMS = {
    "LivingDiningRoom": (0, 0, 6, 4),
    "Kitchen": (6.12, 0, 9, 4),
    "Hallway": (0, 4.12, 9, 5.32),
    "MasterBedroom": (0, 5.44, 4, 9),
    "Bathroom": (4.12, 5.44, 6, 9),
    "KidsRoom": (6.12, 5.44, 9, 9),
}


def specs(ways):
    """Return what a person sees."""
    south, north = (0, 4, 9, 4.12), (0, 5.32, 9, 5.44)
    made = [
        Spec(("Hallway", "LivingDiningRoom"), south, 1.0, 3.0 if not ways.wide else 2.2, "portal" if ways.wide else "open", 2.3),
        Spec(("Hallway", "MasterBedroom"), north, 2.6, 3.37),
        Spec(("Bathroom", "Hallway"), north, 4.8, 4.8 + ways.closet),
        Spec(("Hallway", "KidsRoom"), north, 6.3, 7.07),
        Spec(("Hallway",), (-OUT, 4.12, 0, 5.32), 4.12 if ways.wide else 4.3, 5.32 if ways.wide else 5.17, "entrance", 2.05),
        Spec(("MasterBedroom",), (0, 9, 4, 9 + OUT), 1.0, 2.8, "window", 2.3, 0.6),
        Spec(("KidsRoom",), (6.12, 9, 9, 9 + OUT), 6.12 if ways.wide else 6.8, 9.0 if ways.wide else 8.0, "window", 2.3, 0.9),
        Spec(("Bathroom",), (4.12, 9, 6, 9 + OUT), 4.6, 5.3, "window", 2.2, 1.4),
    ]
    kitchen = Spec(("Kitchen", "LivingDiningRoom"), (6, 0, 6.12, 4), 0.03 if ways.wide else 1.2, 4.0 if ways.wide else 2.6)
    made.append(Spec(kitchen.rooms, kitchen.wall, kitchen.a, kitchen.b, "door", 2.2))
    if ways.panes:
        made += [Spec(("LivingDiningRoom",), (0, -OUT, 6, 0), a, b, "window", 2.3, 0.6) for a, b in ((1.0, 2.4), (2.4, 3.8))]
    if ways.balcony:
        made.append(Spec(("Balcony", "LivingDiningRoom"), (1.0, -T, 4.0, 0), 1.0, 4.0, "door", 2.3))
    if ways.bay:
        made += bay(ways)
    return made


def bay(ways):
    """Three panes around a bay of the kitchen: cheeks of 28 cm that adjoin the front pane."""
    low, high, deep = 6.9, 8.3, 0.28 if ways.bay == "floor" else 0.62
    front = Spec(("Kitchen",), (low, -deep - 0.06, high, -deep), low, high, "window", 2.3, 0.5)
    cheeks = [Spec(("Kitchen",), (x, -deep, x + 0.06, 0), -deep, 0.0, "window", 2.3, 0.5) for x in (low, high)]
    return [front, *cheeks]


def house(name, ways):
    """Return the house's tree and the openings in it as (kind, sorted room types, clear width)."""
    meshes, furniture, rooms = [], [], []
    children = {kind: [] for kind in ROOMS}
    if ways.balcony:
        children["Balcony"] = []
    openings = specs(ways)
    rects = {**ROOMS, **({"Balcony": (1.0, -T - 1.4, 4.0, -T)} if ways.balcony else {})}
    for kind, rect in rects.items():
        add(meshes, children[kind], "Floor", floors(kind, rect, openings, ways))
        add(meshes, children[kind], "Ceiling", [quad(*rect, 2.8)])
        if ways.walls:
            add(meshes, children[kind], "WallInner", walls(kind, rect, openings))
    for number, spec in enumerate(openings):
        draw(spec, number, ways, meshes, furniture, children)
    for number, (kind, found) in enumerate(children.items()):
        rooms.append((ways.types.get(kind, kind), 100 + number, found))
    if ways.litter:
        litter(meshes, furniture, rooms)
    doors = [{"type": "entryDoor", "roomId": "Hallway-102", "dir": "innerLeft", "ref": []}]
    tree = making.house(name, ways.dialect, rooms, furniture, meshes, doors)
    turn(tree, ways.turn)
    return tree, truth(openings, ways)


def truth(openings, ways):
    bays = {"floor": 3, "out": 1, "": 0}[ways.bay]
    plain = [s for s in openings if s not in bay(ways)] if ways.bay else openings
    seen = [(s.kind, tuple(sorted(s.rooms)), round(s.b - s.a, 3)) for s in plain]
    return seen + [("window", ("Kitchen",), w) for w in (1.4, 0.28, 0.28)[:bays]]


def quad(x0, z0, x1, z1, y):
    return [(x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1)]


def upright(x0, z0, x1, z1, low, high):
    """Return the upright quad over a line in plan."""
    return [(x0, low, z0), (x1, low, z1), (x1, high, z1), (x0, high, z0)]


def add(meshes, children, kind, quads, faces=True):
    """Add a mesh of unshared quads to a room."""
    number = len(meshes)
    xyz = [round(float(v), 5) for q in quads for corner in q for v in corner]
    index = [4 * k + i for k in range(len(quads)) for i in (0, 1, 2, 0, 2, 3)]
    meshes.append({"aid": [], "jid": "", "uid": f"{5271533262579975 + 13 * number}/0", "xyz": xyz, "normal": [-3.932, 1, -2.043], "uv": [],
                   "faces": index if faces else [], "material": "", "type": kind})  # fmt: skip
    children.append(child(meshes[-1]["uid"], f"mesh/{number}"))


def floors(kind, rect, openings, ways):
    """Return the quads of a floor: its rectangle, and what of it reaches under doors."""
    x0, z0, x1, z1 = rect
    if ways.floors == "touch":
        grown = [v + (T / 2 if k > 1 else -T / 2) * inside(k, rect) for k, v in enumerate(rect)]
        x0, z0, x1, z1 = grown
    made = [quad(x0, z0, x1, z1, 0)]
    for spec in openings:
        if spec.kind == "window" or kind not in spec.rooms or ways.floors not in {"half", "full"}:
            continue
        bx0, bz0, bx1, bz1 = spec.box(spec.a - FRAME, spec.b + FRAME)
        if ways.floors == "full" and kind == max(spec.rooms):
            made.append(quad(bx0, bz0, bx1, bz1, 0))
        elif ways.floors == "half":
            if spec.along_x:
                middle = (bz0 + bz1) / 2
                bz0, bz1 = (bz0, middle) if bz0 >= z1 - 1e-6 else (middle, bz1)
            else:
                middle = (bx0 + bx1) / 2
                bx0, bx1 = (bx0, middle) if bx0 >= x1 - 1e-6 else (middle, bx1)
            made.append(quad(bx0, bz0, bx1, bz1, 0))
    if kind == "Kitchen" and ways.bay == "floor":
        made.append(quad(6.9, -0.28, 8.3, 0, 0))
    return made


def walls(kind, rect, openings):
    """Return the inner wall faces of a room around its openings, which go up to the ceiling here."""
    x0, z0, x1, z1 = rect
    made = []
    for along_x, at in ((True, z0), (True, z1), (False, x0), (False, x1)):
        low, high = (x0, x1) if along_x else (z0, z1)
        mine = [s for s in openings if kind in s.rooms and s.along_x == along_x and abs(s.wall[1 if along_x else 0] - at) < 0.3]
        for spec in sorted(mine, key=lambda s: s.a):
            made.append((along_x, at, low, max(spec.a, low)))
            low = spec.b
        made.append((along_x, at, low, high))
    return [upright(*((a, at, b, at) if along_x else (at, a, at, b)), 0, 2.8) for along_x, at, a, b in made if b - a > 1e-3]


def inside(side, rect):
    """Return whether a side of a room (x0, z0, x1, z1) is within the flat."""
    return rect[side] not in {0, 9}


def draw(spec, number, ways, meshes, furniture, children):
    mine = children[spec.rooms[-1]]
    a, b, z0, z1 = spec.a, spec.b, spec.sill, spec.top
    pane = spec.wall[2] - spec.wall[0] < 0.1 or spec.wall[3] - spec.wall[1] < 0.1
    kind = {"window": "BayWindow" if pane else "Window", "open": "Hole", "portal": "Hole"}.get(spec.kind, "Door")
    kind = "Hole" if ways.reveal == "hole" and kind == "Door" else kind
    x0, w0, x1, w1 = spec.box(a, b)
    if spec.along_x:
        jambs = [upright(a, w0, a, w1, z0, z1), upright(b, w0, b, w1, z0, z1)]
        parts = [(a, w0, b, (w0 + w1) / 2), (a, (w0 + w1) / 2, b, w1)]
    else:
        jambs = [upright(x0, a, x1, a, z0, z1), upright(x0, b, x1, b, z0, z1)]
        parts = [(x0, a, (x0 + x1) / 2, b), ((x0 + x1) / 2, a, x1, b)]
    head = quad(x0, w0, x1, w1, z1)
    if pane:  # a pane of glass
        line = (x0, w0, x1, w0) if spec.along_x else (x0, w0, x0, w1)
        add(meshes, mine, kind, [upright(*line, z0, z1)])
    elif ways.reveal == "jambs" and spec.kind not in {"window", "open"} and b - a < 2.4:
        for one in jambs:
            add(meshes, mine, kind, [one])
        add(meshes, mine, kind, [head])
    elif ways.reveal == "twice" and len(spec.rooms) == 2:
        for room, (p0, q0, p1, q1) in zip(sorted(spec.rooms), parts, strict=True):
            sides = [upright(p0, q0, p0, q1, z0, z1), upright(p1, q0, p1, q1, z0, z1)]
            sides = sides if spec.along_x else [upright(p0, q0, p1, q0, z0, z1), upright(p0, q1, p1, q1, z0, z1)]
            add(meshes, children[room], kind, [*sides, quad(p0, q0, p1, q1, z1)])
    else:
        add(meshes, mine, kind, [*jambs, head])
    if ways.threshold and not pane:
        add(meshes, mine, kind if spec.kind == "window" else ways.threshold[number % len(ways.threshold)], [quad(*spec.box(a, b), z0)])
    if ways.casing and spec.kind in {"door", "entrance"}:
        casing(spec, ways, meshes, mine)
    if ways.swung and spec.kind in {"door", "entrance"} and b - a < 1.0:
        slab_leaf(spec, ways, meshes, mine)
    elif spec.kind not in {"open", "portal"}:
        leaf(spec, number, ways, furniture, mine)


def casing(spec, ways, meshes, mine):
    """Add the frame: posts on both sides that stand 1 cm out of the wall, and a lintel, as boxes."""
    made = []
    for low, high, bottom, top in (
        (spec.a - FRAME, spec.a, 0.0, spec.top + FRAME),
        (spec.b, spec.b + FRAME, 0.0, spec.top + FRAME),
        (spec.a - FRAME, spec.b + FRAME, spec.top, spec.top + FRAME),
    ):
        x0, z0, x1, z1 = spec.box(low, high, 0.01)
        made += [upright(x0, z0, x1, z0, bottom, top), upright(x0, z1, x1, z1, bottom, top)]
        made += [upright(x0, z0, x0, z1, bottom, top), upright(x1, z0, x1, z1, bottom, top), quad(x0, z0, x1, z1, top)]
    if not ways.inner:  # the outlines alone
        x0, z0, x1, z1 = spec.box(spec.a - FRAME, spec.b + FRAME, 0.01)
        faces = [(x0, z0, x1, z0), (x0, z1, x1, z1)] if spec.along_x else [(x0, z0, x0, z1), (x1, z0, x1, z1)]
        made = [upright(*face, 0, spec.top + FRAME) for face in faces]
    add(meshes, mine, "Pocket", made)


def slab_leaf(spec, ways, meshes, mine):
    """Add a leaf as a mesh, turned about its jamb into the room beyond the wall, or inwards at the entrance."""
    x0, z0, x1, z1 = spec.box(spec.a, spec.b)
    c, s = np.cos(ways.swung), np.sin(ways.swung)
    hinge, way, out = ((x0, z1), (c, s), (-s, c)) if spec.along_x else ((x1, z0), (s, c), (c, -s))
    far = [h + (spec.b - spec.a) * w for h, w in zip(hinge, way, strict=True)]
    back = [0.04 * o for o in out]
    made = [upright(*hinge, *far, 0, spec.top), upright(*np.subtract(hinge, back), *np.subtract(far, back), 0, spec.top)]
    add(meshes, mine, "Door", made)


def leaf(spec, number, ways, furniture, mine):
    record = {"uid": f"{number}/model", "jid": "built-in", "aid": []}
    if ways.dialect == "0.11":
        record |= {"title": "window/window" if spec.kind == "window" else "door/single swing door", "type": "standard"}
    if ways.sized and spec.kind != "window":
        w = spec.b - spec.a + 2 * FRAME
        record |= {"size": [w, T, spec.top + FRAME], "bbox": [w, T, spec.top + FRAME], "valid": False}
    furniture.append(record)
    x0, z0, x1, z1 = spec.box(spec.a, spec.b)
    x, z = (x0 + x1) / 2, (z0 + z1) / 2
    if spec.kind == "door" and spec.b - spec.a < 1.0:  # it is open, into the room beyond or the hall
        aside = min(ways.ajar, (spec.b - spec.a) / 2)
        if spec.along_x:
            x, z = x + aside * 0.6, z + ways.ajar
        else:
            x, z = x + ways.ajar, z + aside * 0.6
    yaw = (0.0 if spec.along_x else np.pi / 2) + (1.1 if ways.ajar and number % 2 else 0.0)
    mine.append(child(record["uid"], f"furniture/{900 + number}", (x, spec.sill, z), yaw))


def litter(meshes, furniture, rooms):
    """Add rooms that are none, refs to nothing, and furniture beyond the world."""
    shaft = []
    add(meshes, shaft, "Floor", [quad(12, 0, 12.3, 0.33, 0)])
    furniture.append(making.chair_record("far/model", making.CHAIR))
    rooms.append(("OtherRoom", 900, shaft))
    rooms.append(("OtherRoom", "", [child("far/model", "furniture/700", (1e31, 0, 0)), child("nowhere/model", "furniture/701", (1, 0, 1))]))
    low = slab("duct", "Door", (6.5, 0, 3.2), (6.9, 0.6, 3.3))  # a hatch within the kitchen
    meshes.append(low)
    rooms[1][2].append(child("duct", "mesh/999"))


def turn(tree, quarters):
    """Turn a house about the vertical, by quarters of a circle."""
    c, s = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarters % 4]
    for mesh in tree["mesh"]:
        points = np.array(mesh["xyz"], float).reshape(-1, 3)
        mesh["xyz"] = np.round(points @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]), 5).ravel().tolist()
    for room in tree["scene"]["room"]:
        for entry in room["children"]:
            x, y, z = entry["pos"]
            yaw = 2 * np.arctan2(entry["rot"][1], entry["rot"][3]) + quarters * np.pi / 2
            entry["pos"] = [c * x + s * z, y, c * z - s * x]
            entry["rot"] = [0, round(float(np.sin(yaw / 2)), 5), 0, round(float(np.cos(yaw / 2)), 5)]


HOUSES = {
    "plain": Ways(),
    "older": Ways(dialect="0.4", threshold=("Hole",), casing=False, turn=1),
    "showroom": Ways(walls=False, reveal="twice"),
    "closed_frames": Ways(inner=False, threshold=("Door",), sized=True),
    "ajar": Ways(ajar=0.42, turn=2),
    "wide_ajar": Ways(ajar=0.6, sized=True, casing=False, reveal="twice"),
    "jambs": Ways(reveal="jambs", casing=False, turn=3),
    "framed_jambs": Ways(dialect="0.4", reveal="jambs", floors="half", turn=1),
    "holes": Ways(reveal="hole", threshold=("Hole", "Door"), ajar=0.4),
    "under_doors": Ways(floors="half", threshold=("Hole",), turn=1),
    "thresholds": Ways(floors="full", ajar=0.4),
    "no_walls": Ways(floors="touch", reveal="twice"),
    "corner_to_corner": Ways(wide=True, turn=2),
    "bay_window": Ways(bay="floor", panes=True),
    "bay_outside": Ways(bay="out", litter=True, turn=3),
    "balcony": Ways(balcony=True, floors="half", litter=True, types={"KidsRoom": "SecondBedroom"}),
    "open_leaves": Ways(reveal="hole", swung=1.4),
    "half_open": Ways(reveal="hole", swung=0.7, casing=False, threshold=("Hole",), turn=3),
    "all_of_it": Ways(wide=True, bay="floor", balcony=True, floors="full", ajar=0.45, litter=True, reveal="twice", turn=1),
}
