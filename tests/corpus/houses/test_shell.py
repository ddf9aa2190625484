"""The shell: walls have exactly their openings cut out, and everything faces where it is looked at from."""

import numpy as np
import pytest
from sample_houses import houses
from shapely.geometry import Point, Polygon

from pipeline.corpus.houses.shell import surfaces

HOUSES = houses(10)


def area(quad):
    a, b, c, d = (np.array(p) for p in quad)
    return (np.linalg.norm(np.cross(b - a, c - a)) + np.linalg.norm(np.cross(c - a, d - a))) / 2


def normal(quad):
    a, b, c = (np.array(p) for p in quad[:3])
    n = np.cross(b - a, c - a)
    return n / np.linalg.norm(n)


@pytest.mark.parametrize("home", HOUSES)
def test_inner_walls_are_the_perimeter_less_the_openings(home):
    made = surfaces(home.plan)
    for k, room in enumerate(home.plan.rooms):
        walls = sum(area(q) for s in made if s.room == k and s.type == "WallInner" for q in s.quads)
        holes = sum(o.width * o.height for o in home.plan.openings if room.room_id in o.rooms)
        assert walls == pytest.approx(Polygon(room.polygon).length * room.height - holes, abs=1e-6)


@pytest.mark.parametrize("home", HOUSES)
def test_floors_look_up_ceilings_down_and_both_cover_the_room(home):
    for surface in surfaces(home.plan):
        if surface.type in {"Floor", "Ceiling"}:
            room = home.plan.rooms[surface.room]
            up = 1 if surface.type == "Floor" else -1
            assert all(normal(q)[2] == pytest.approx(up) for q in surface.quads)
            assert sum(area(q) for q in surface.quads) == pytest.approx(room.area)
            assert {p[2] for q in surface.quads for p in q} == {0.0 if up > 0 else room.height}


@pytest.mark.parametrize("home", HOUSES)
def test_outer_walls_stand_outside_and_look_away(home):
    shapes, found = [Polygon(r.polygon) for r in home.plan.rooms], []
    for surface in surfaces(home.plan):
        for quad in surface.quads if surface.type == "WallOuter" else ():
            middle = np.mean(quad, axis=0)[:2]
            away = [shapes[surface.room].distance(Point(middle + step * normal(quad)[:2])) for step in (-0.02, 0.0, 0.02)]
            found.append(away[1])
            assert 0.1 < away[1] < 0.35  # less inside narrow shafts, more at the end of a face around a corner
            assert away[0] < away[1] < away[2] or away[1] != pytest.approx(0.24)
    assert np.median(found) == pytest.approx(0.24)


@pytest.mark.parametrize("home", HOUSES)
def test_reveals_fill_the_wall_and_look_into_the_hole(home):
    made = surfaces(home.plan)
    for k, opening in enumerate(home.plan.openings):
        (reveal,) = [s for s in made if s.opening == k and s.type in {"Door", "Window", "Hole"}]
        points = np.array([p for q in reveal.quads for p in q])
        centre = points.mean(axis=0)
        assert centre[:2] == pytest.approx(opening.segment.mean(axis=0), abs=1e-6)
        extent = sorted(np.ptp(points[:, :2], axis=0))
        assert extent == pytest.approx(sorted([0.12 if len(opening.rooms) == 2 else 0.24, opening.width]), abs=1e-6)
        assert np.ptp(points[:, 2]) == pytest.approx(opening.height)
        assert points[:, 2].min() == pytest.approx(opening.sill)
        assert all(normal(q) @ (centre - np.mean(q, axis=0)) > 0 for q in reveal.quads)
