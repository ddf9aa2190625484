"""Simple furniture and a flat for the tests of geometry, the judge, the arranger and the metrics."""

import math

import numpy as np

from pipeline.entities.asset import Asset, Joint, Link, Mesh
from pipeline.entities.home import Home, Placement
from pipeline.entities.plan import Opening, Plan, Room, Swing

FACES = np.array(
    [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]],
    np.int32,
)


def box(low, high, part=""):
    low, high = np.array(low, float), np.array(high, float)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    return Mesh("box", (low + corners * (high - low)).astype(np.float32), FACES, part=part)


def link(name, *boxes):
    colliders = tuple(boxes)
    return Link(name, colliders, colliders, 10.0, np.zeros(3), np.eye(3))


def asset(asset_id, category, size, links, joints=()):
    return Asset(asset_id, category, np.array(size, float), tuple(links), tuple(joints), (), "test", asset_id, "CC0-1.0")


def block(asset_id="block", category="cabinet", size=(1.0, 0.5, 1.0)):
    """A plain box."""
    w, d, h = size
    return asset(asset_id, category, size, [link("base", box((-w / 2, -d / 2, 0), (w / 2, d / 2, h)))])


def chest(asset_id="chest", category="cabinet", size=(0.8, 0.5, 0.9), travel=0.4):
    """A carcass with one drawer over its whole front; the drawer is the front 2 cm and a box behind, with a handle."""
    w, d, h = size
    face = -d / 2
    base = link("base", box((-w / 2, face + 0.02, 0), (w / 2, d / 2, h)))
    drawer = link(
        "drawer",
        box((-w / 2, face, 0.1), (w / 2, face + 0.02, h - 0.1)),
        box((-0.1, face - 0.03, h / 2), (0.1, face, h / 2 + 0.02), "line_fixed_handle"),
    )
    slide = Joint("drawer", "prismatic", 0, 1, np.array([0.0, -1.0, 0.0]), np.zeros(3), 0.0, travel, "slider_drawer")
    return asset(asset_id, category, (w, d + 0.0, h), [base, drawer], [slide])


def cupboard(asset_id="cupboard", category="wardrobe", size=(0.6, 0.5, 1.8), angle=math.pi / 2):
    """A carcass with one door, hinged at its left (-x) front edge; it opens towards -y."""
    w, d, h = size
    face = -d / 2
    base = link("base", box((-w / 2, face + 0.02, 0), (w / 2, d / 2, h)))
    door = link("door", box((-w / 2, face, 0), (w / 2, face + 0.02, h)))
    hinge = Joint("door", "revolute", 0, 1, np.array([0.0, 0.0, -1.0]), np.array([-w / 2, face, 0.0]), 0.0, angle, "hinge_door")
    return asset(asset_id, category, size, [base, door], [hinge])


def inner_drawer(asset_id="inner", angle=math.pi / 2, *, outer=False):
    """A carcass 0.6 m wide with a drawer; before it a door hinged at the left. `outer`: the drawer is beneath the door instead."""
    low = 0.1 if outer else 0.6
    door_low = 0.45 if outer else 0.0
    base = link("base", *(box((x, -0.24, 0), (x + 0.02, 0.25, 1.0)) for x in (-0.3, 0.28)), box((-0.3, 0.23, 0), (0.3, 0.25, 1.0)))
    door = link("door", box((-0.3, -0.26, door_low), (0.3, -0.24, 1.0)))
    drawer = link("drawer", box((-0.27, -0.22, low), (0.27, 0.2, low + 0.2)))
    joints = [
        Joint("door", "revolute", 0, 1, np.array([0, 0, -1.0]), np.array([-0.3, -0.26, 0.0]), 0.0, angle, "hinge_door"),
        Joint("drawer", "prismatic", 0, 2, np.array([0, -1.0, 0]), np.zeros(3), 0.0, 0.35, "slider_drawer"),
    ]
    return asset(asset_id, "cabinet", (0.6, 0.51, 1.0), [base, door, drawer], joints)


def shelves(asset_id="shelves", category="shelf", size=(0.8, 0.35, 1.2)):
    """Two sides, a back and four boards, open before."""
    w, d, h = size
    sides = [box((x, -d / 2, 0), (x + 0.02, d / 2, h)) for x in (-w / 2, w / 2 - 0.02)]
    boards = [box((-w / 2 + 0.02, -d / 2, z), (w / 2 - 0.02, d / 2 - 0.01, z + 0.02)) for z in (0.05, 0.4, 0.75, h - 0.02)]
    return asset(asset_id, category, size, [link("base", *sides, *boards, box((-w / 2, d / 2 - 0.01, 0), (w / 2, d / 2, h)))])


def tray_chest(asset_id="tray_chest", category="nightstand", size=(0.5, 0.4, 0.5), travel=0.3):
    """A carcass of boards with a hollow drawer, front flush with it."""
    w, d, h = size
    sides = [box((x, -d / 2, 0), (x + 0.02, d / 2, h)) for x in (-w / 2, w / 2 - 0.02)]
    boards = [box((-w / 2 + 0.02, -d / 2, z), (w / 2 - 0.02, d / 2, z + 0.02)) for z in (0.1, h - 0.02)]
    base = link("base", *sides, *boards, box((-w / 2 + 0.02, d / 2 - 0.01, 0.12), (w / 2 - 0.02, d / 2, h - 0.02)))
    x, y0, y1, z0, z1 = w / 2 - 0.03, -d / 2, d / 2 - 0.03, 0.13, 0.3
    walls = [box((-x, y0, z0), (x, y0 + 0.02, h - 0.03)), box((-x, y1 - 0.01, z0), (x, y1, z1))]
    walls += [box((s, y0 + 0.02, z0), (s + 0.01, y1 - 0.01, z1)) for s in (-x, x - 0.01)]
    drawer = link("drawer", *walls, box((-x + 0.01, y0 + 0.02, z0), (x - 0.01, y1 - 0.01, z0 + 0.01)))
    slide = Joint("drawer", "prismatic", 0, 1, np.array([0.0, -1.0, 0.0]), np.zeros(3), 0.0, travel, "slider_drawer")
    return asset(asset_id, category, size, [base, drawer], [slide])


def flip(asset_id="flip", category="laptop", size=(0.3, 0.22, 0.02), angle=1.9):
    """Two boards, hinged at the back; the upper one opens past the upright."""
    w, d, h = size
    base = link("base", box((-w / 2, -d / 2, 0), (w / 2, d / 2, h / 2)))
    lid = link("lid", box((-w / 2, -d / 2, h / 2), (w / 2, d / 2, h)))
    hinge = Joint("lid", "revolute", 0, 1, np.array([-1.0, 0.0, 0.0]), np.array([0.0, d / 2, h / 2]), 0.0, angle, "hinge_lid")
    return asset(asset_id, category, size, [base, lid], [hinge])


def table(asset_id="table", category="dining_table", size=(1.4, 0.8, 0.75)):
    """A top on four legs: there is room beneath."""
    w, d, h = size
    legs = [
        box(
            (sx * w / 2 - (sx > 0) * 0.05, sy * d / 2 - (sy > 0) * 0.05, 0),
            (sx * w / 2 + (sx < 0) * 0.05, sy * d / 2 + (sy < 0) * 0.05, h - 0.04),
        )
        for sx in (-1, 1)
        for sy in (-1, 1)
    ]
    return asset(asset_id, category, size, [link("base", box((-w / 2, -d / 2, h - 0.04), (w / 2, d / 2, h)), *legs)])


def chair(asset_id="chair", category="dining_chair", size=(0.45, 0.5, 0.9)):
    """A seat at 45 cm, and a back at its rear (+y)."""
    w, d, h = size
    return asset(
        asset_id,
        category,
        size,
        [link("base", box((-w / 2, -d / 2, 0), (w / 2, d / 2, 0.45)), box((-w / 2, d / 2 - 0.05, 0.45), (w / 2, d / 2, h)))],
    )


LIBRARY = {
    a.asset_id: a
    for a in (
        block(),
        block("small_block", "cabinet", (0.7, 0.4, 0.9)),
        block("bed", "double_bed", (1.6, 2.0, 0.5)),
        block("lamp", "ceiling_lamp", (0.5, 0.5, 0.3)),
        block("nightstand", "nightstand", (0.5, 0.4, 0.5)),
        chest(),
        cupboard(),
        table(),
        chair(),
        shelves(),
        tray_chest(),
        flip(),
        block("cup", "cup", (0.09, 0.09, 0.1)),
        block("book", "book", (0.16, 0.22, 0.03)),
    )
}

SQUARE = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]])


def placed(asset_id, x, y, yaw=0.0, z=0.0, room="room", number=0):
    found = LIBRARY[asset_id]
    return Placement(f"{asset_id}_{number}", room, found.category, asset_id, np.array([x, y, z]), yaw, found.size)


def one_room(polygon=SQUARE, *, door=True):
    """A room with an entrance in its lower wall that swings inwards, and a window opposite."""
    openings = []
    if door:
        swing = Swing("room", 0, 1.5)
        openings.append(Opening("entrance", "entrance", ("room",), np.array([[0.3, -0.12], [1.2, -0.12]]), 2.05, 0.0, swing))
    return Plan((Room("room", "bedroom", polygon),), tuple(openings), "room")


def two_rooms():
    """A living room with the entrance, and beside it a bedroom behind a door that swings into the bedroom."""
    living = Room("living", "living_room", np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]))
    bed = Room("bed", "bedroom", np.array([[4.12, 0.0], [7.12, 0.0], [7.12, 3.0], [4.12, 3.0]]))
    openings = (
        Opening("entrance", "entrance", ("living",), np.array([[0.3, -0.12], [1.2, -0.12]]), 2.05, 0.0, Swing("living", 0, 1.5)),
        Opening("door", "door", ("living", "bed"), np.array([[4.06, 0.5], [4.06, 1.3]]), 2.05, 0.0, Swing("bed", 0, 1.5)),
    )
    return Plan((living, bed), openings, "living")


def home(placements, plan=None):
    return Home("s0_00000000", 0, 0, "", "", plan or one_room(), tuple(placements))


def moved_plan(plan, angle, shift):
    """Turn a plan about the origin by `angle`, then shift it."""
    c, s = math.cos(angle), math.sin(angle)

    def go(points):
        return points @ np.array([[c, s], [-s, c]]) + shift

    rooms = tuple(Room(r.room_id, r.type, go(r.polygon), r.level, r.height) for r in plan.rooms)
    openings = tuple(Opening(o.opening_id, o.kind, o.rooms, go(o.segment), o.height, o.sill, o.swing, o.level) for o in plan.openings)
    return Plan(rooms, openings, plan.entrance)


def moved_placements(placements, angle, shift):
    c, s = math.cos(angle), math.sin(angle)
    return tuple(
        Placement(
            p.object_id,
            p.room_id,
            p.category,
            p.asset_id,
            np.array([*(p.position[:2] @ np.array([[c, s], [-s, c]]) + shift), p.position[2]]),
            math.remainder(p.yaw + angle, 2 * math.pi),
            p.size,
            p.scale,
        )
        for p in placements
    )
