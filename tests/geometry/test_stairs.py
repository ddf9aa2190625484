from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely.geometry import Polygon

from pipeline.entities.plan import Opening, Plan, Room
from pipeline.geometry.stairs import RISE, steps, visible_steps
from pipeline.geometry.walls import room_panels, shell

SHAFT = np.array([[0, 0], [2.9, 0], [2.9, 2.1], [0, 2.1]], float)
SIDES = {"south": [[0.85, -0.06], [2.05, -0.06]], "east": [[2.96, 0.45], [2.96, 1.65]], "north": [[0.85, 2.16], [2.05, 2.16]]}


def home(*sides, storeys=2, shaft=SHAFT):
    """A staircase in the corner of a home, with a room around its south, east and north on each storey, open at a given side."""
    around = np.array([[0, -2], [5, -2], [5, 4], [0, 4], [0, 2.22], [3.02, 2.22], [3.02, -0.12], [0, -0.12]], float)
    rooms = [Room("stairs", "staircase", shaft), *(Room(f"r{k}", "hallway", around, k) for k in range(storeys))]
    openings = [
        Opening(f"o{k}{side}", "open", ("stairs", f"r{k}"), np.array(SIDES[side], float), 2.4, level=k)
        for k, each in enumerate(sides)
        for side in each.split("+")
    ]
    return Plan(tuple(rooms), tuple(openings), "r0")


@pytest.mark.parametrize("level", [0, 1])
def test_the_shaft_is_walled_and_free_on_every_storey(level):
    plan = home("south", "east")
    built, shaft = shell(plan, level), Polygon(SHAFT)
    assert all(Polygon(p.polygon).intersection(shaft).area < 1e-6 for p in built.prisms)
    west = shapely.box(-plan.outer_wall + 1e-3, 0.0, -1e-3, 2.1)
    assert built.region.contains(west)  # to the outside there is wall upstairs too
    hole = Polygon(built.cuts[0].quad)
    assert hole.intersection(built.region).area < 1e-6
    assert hole.area == pytest.approx(1.2 * 0.12)


def test_walls_reach_the_floor_above():
    plan = home("south", "east")
    assert shell(plan, 0).top == plan.storey_height
    assert max(p.corners[:, 2].max() for p in room_panels(plan.rooms[0], (), plan.storey_height)) == plan.storey_height


@pytest.mark.parametrize(
    "sides", [("south", "east"), ("east", "south"), ("south", "north"), ("south", "south"), ("south", "north", "east")]
)
def test_steps_lead_from_floor_to_floor(sides):
    plan = home(*sides, storeys=len(sides))
    shaft = Polygon(SHAFT).buffer(1e-6)
    for level in range(len(sides) - 1):
        flight = [s for s in steps(plan, level) if s.kind == "step"]
        tops = [0.0, *(s.top for s in flight), plan.storey_height]
        assert np.allclose(np.diff(tops), tops[1])
        assert tops[1] <= RISE + 1e-9
        pieces = [Polygon(s.polygon) for s in flight]
        assert all(p.exterior.is_ccw and shaft.contains(p) and p.convex_hull.area == pytest.approx(p.area) for p in pieces)
        landing = next(Polygon(s.polygon) for s in steps(plan, level + 1) if s.kind == "landing")
        for one, two in itertools.pairwise([*pieces, landing]):
            assert one.intersection(two).area < 1e-6
            assert one.buffer(1e-4).intersection(two).area > 0.5e-4  # half a metre of edge in common
        mouth = shapely.LineString(plan.openings[level + 1].segment)
        assert landing.distance(mouth) < 0.07
        assert landing.intersection(mouth.buffer(0.2)).area > 0.15


@pytest.mark.parametrize("sides", [("south", "south"), ("south", "north", "east"), ("east", "east", "east")])
def test_one_stands_upright_on_every_step(sides):
    plan = home(*sides, storeys=len(sides))
    solids = [
        (Polygon(s.polygon), level * plan.storey_height + s.bottom, level * plan.storey_height + s.top)
        for level in range(len(sides))
        for s in steps(plan, level)
        if s.kind in {"step", "landing"}
    ]
    for one, _, top in solids:
        for two, bottom, _ in solids:
            if bottom > top and one.intersection(two).area > 0.01:
                assert bottom - top > 2.0


@pytest.mark.parametrize("plan", [home("south+north", "east"), home("south", "east", storeys=3), home("south", "east", shaft=np.array([[0, 0], [2.9, 0], [2.9, 1], [1.5, 1], [1.5, 2.1], [0, 2.1]], float))])  # fmt: skip
def test_a_shaft_that_a_flight_does_not_suit_stays_empty(plan):
    assert steps(plan, 0) == steps(plan, 1) == ()


def test_what_arrives_from_below_is_seen_below_the_floor():
    plan = home("south", "east")
    below = [s for s in visible_steps(plan, 1) if s.top < 0.0]
    assert len(below) == len([s for s in steps(plan, 0) if s.top < plan.storey_height])
    assert steps(replace(plan, openings=()), 0) == ()
