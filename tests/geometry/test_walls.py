from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely.geometry import Point, Polygon

from pipeline.entities.plan import Opening, Plan, Room, Swing
from pipeline.geometry.door_sweeps import ROOM, leaf_sweep
from pipeline.geometry.walls import LEAF_THICKNESS, SLAB, outer_panels, reveals, room_panels, shell


def segment(*ends):
    return np.array(ends, float)


ROOMS = (
    Room("a", "bedroom", np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float)),
    Room("b", "living_room", np.array([[4.12, 0], [8, 0], [8, 5], [2, 5], [2, 3.12], [4.12, 3.12]], float)),
)
OPENINGS = (
    Opening("door", "door", ("a", "b"), segment((4.06, 1.0), (4.06, 1.9)), 2.05, 0.0, Swing("b", 0, 1.5)),
    Opening("window", "window", ("b",), segment((8.12, 4.0), (8.12, 2.5)), 1.4, 0.9),
    Opening("entrance", "entrance", ("b",), segment((5.0, -0.12), (6.0, -0.12)), 2.1, 0.0, Swing("b", 1, 1.4)),
)
PLAN = Plan(ROOMS, OPENINGS, "b")


def turned(plan, angle):
    c, s = math.cos(angle), math.sin(angle)
    R = np.array([[c, s], [-s, c]])
    rooms = tuple(replace(r, polygon=r.polygon @ R) for r in plan.rooms)
    return replace(plan, rooms=rooms, openings=tuple(replace(o, segment=o.segment @ R) for o in plan.openings))


@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_walls_and_holes_fill_what_is_between_rooms_and_outline(angle):
    built = shell(turned(PLAN, angle), 0)
    rooms = sum(r.area for r in ROOMS)
    walls = sum(Polygon(p.polygon).area for p in built.prisms if p.kind == "wall")
    holes = sum(Polygon(c.quad).area for c in built.cuts)
    assert walls + holes + rooms == pytest.approx(built.outline.area, rel=5e-3)  # cuts are a millimetre deeper than the wall
    assert walls == pytest.approx(built.region.area, rel=1e-6)


@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_solids_keep_out_of_rooms(angle):
    plan = turned(PLAN, angle)
    for prism in shell(plan, 0).prisms:
        for room in plan.rooms:
            assert Polygon(prism.polygon).intersection(Polygon(room.polygon)).area < 1e-6


def test_holes_are_as_deep_as_their_walls():
    depth = {c.opening.opening_id: Polygon(c.quad).area / c.opening.width for c in shell(PLAN, 0).cuts}
    assert depth == pytest.approx({"door": 0.12, "window": 0.24, "entrance": 0.24})


def test_lintels_and_sills_close_the_hole_above_and_below():
    built = shell(PLAN, 0)
    found = {(p.kind, p.opening_id): (round(p.bottom, 9), round(p.top, 9)) for p in built.prisms if p.kind != "wall"}
    top = round(2.7 + SLAB, 9)
    assert found == {
        ("lintel", "door"): (2.05, top),
        ("lintel", "window"): (2.3, top),
        ("sill", "window"): (0.0, 0.9),
        ("lintel", "entrance"): (2.1, top),
    }


def test_leaves_swing_into_their_room_about_the_segments_end_and_clear_the_jambs():
    built = shell(PLAN, 0)
    rooms = {r.room_id: Polygon(r.polygon) for r in ROOMS}
    assert [leaf.opening_id for leaf in built.leaves] == ["door", "entrance"]
    for leaf, opening in zip(built.leaves, (OPENINGS[0], OPENINGS[2]), strict=True):
        assert np.allclose(leaf.hinge, opening.segment[opening.swing.hinge])
        closed, opened = Polygon(leaf.outline()), Polygon(leaf.outline(leaf.angle))
        assert closed.area == pytest.approx((opening.width - 0.01) * LEAF_THICKNESS)
        cut = next(c for c in built.cuts if c.opening.opening_id == leaf.opening_id)
        assert Polygon(cut.quad).contains(closed)
        tip = Point(*(leaf.outline(leaf.angle)[1]))
        assert rooms[opening.swing.room_id].contains(tip)
        for angle in np.linspace(0, leaf.angle, 8):
            assert Polygon(leaf.outline(angle)).intersection(built.region).area < 1e-9
        assert opened.distance(Point(*leaf.hinge)) < 0.01


def test_turn_is_the_sense_of_opening():
    leaf = shell(PLAN, 0).leaves[0]
    c, s = math.cos(0.1 * leaf.turn), math.sin(0.1 * leaf.turn)
    turned_along = np.array([[c, -s], [s, c]]) @ leaf.along
    assert turned_along @ leaf.normal > 0


def panel_area(panel):
    first = panel.corners[0]
    rest = panel.corners[1:] - first
    return sum(np.linalg.norm(np.cross(rest[k], rest[k + 1])) / 2 for k in range(len(rest) - 1))


def test_a_rooms_faces_are_its_walls_less_the_holes():
    built = shell(PLAN, 0)
    room = ROOMS[0]
    around = Polygon(room.polygon).length * room.height
    assert sum(map(panel_area, room_panels(room, built.cuts))) == pytest.approx(around - 0.9 * 2.05)


def test_faces_look_into_their_room_and_outwards():
    built = shell(PLAN, 0)
    for panels, inside in [(room_panels(r, built.cuts), Polygon(r.polygon)) for r in ROOMS]:
        for panel in panels:
            a, b, c = panel.corners[:3]
            normal = np.cross(b - a, c - a)
            spot = panel.corners.mean(axis=0) + 0.01 * normal / np.linalg.norm(normal)
            assert inside.contains(Point(*spot[:2]))
    for panel in outer_panels(built):
        a, b, c = panel.corners[:3]
        normal = np.cross(b - a, c - a)
        if abs(normal[2]) < 1e-9:
            spot = panel.corners.mean(axis=0) + 0.01 * normal / np.linalg.norm(normal)
            assert not built.outline.contains(Point(*spot[:2]))
        else:
            assert normal[2] > 0


def test_reveals_look_into_the_hole():
    for cut in shell(PLAN, 0).cuts:
        middle = np.array([*cut.quad.mean(axis=0), (cut.bottom + cut.top) / 2])
        for panel in reveals(cut):
            a, b, c = panel.corners[:3]
            assert np.cross(b - a, c - a) @ (middle - panel.corners.mean(axis=0)) > 0


def test_storeys_are_apart():
    upper = replace(PLAN, rooms=(ROOMS[0], replace(ROOMS[1], level=1)), openings=())
    assert shapely.area(shell(upper, 0).outline) == pytest.approx(4.48 * 3.48)


def test_a_sweep_has_room_about_its_leaf():
    leaf = shell(PLAN, 0).leaves[0]
    prisms = leaf_sweep(leaf, 0.0).prisms
    swept = shapely.union_all([Polygon(c[:n]) for c, n in zip(prisms.corners, prisms.count, strict=True)])
    for angle in np.linspace(0, leaf.angle, 8):
        near, far, behind, _ = leaf.outline(angle)
        tip = Polygon([near + 0.5 * (far - near), far, behind, behind + 0.5 * (near - far)])
        assert swept.buffer(1e-6).contains(tip.buffer(0.5 * ROOM))
