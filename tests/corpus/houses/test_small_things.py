"""Small things lie on what they name, inside it, in nothing else; rugs under tables; curtains at windows."""

import math
from collections import Counter

import numpy as np
import pytest
from sample_houses import house, houses, stock
from shapely.geometry import Polygon

from pipeline import taxonomy
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.houses.house import make_house
from pipeline.corpus.houses.stock import LEAST, Stock, surfaces_of
from pipeline.geometry.convex import rectangle_in

SMALL = taxonomy.load().small
HOUSES = houses(24)


@pytest.fixture(scope="module")
def real():
    """Houses of real models, whose surfaces are their geometry's."""
    models = catalogue(2, 0.3).future
    return [make_house(2, index, Stock(models, surfaces_of)) for index in range(4)]


def carried(home):
    return [(item, home.items[item.support]) for item in home.items if item.support >= 0 and item.model.category in SMALL]


@pytest.mark.parametrize("index", range(24))
def test_a_thing_is_inside_the_footprint_of_its_support_and_at_one_of_its_tops(index):
    home = house(index)
    for item, on in carried(home):
        assert item.room == on.room
        assert Polygon(on.corners()).buffer(1e-6).contains(Polygon(item.corners())), (item.model.category, on.model.category)
        tops = stock().surfaces(on.model).tops[:, 4] + on.position[2]
        assert np.abs(tops - item.position[2]).min() < 1e-6


def test_things_on_one_support_do_not_meet(real):
    for home in (*HOUSES, *real):
        by = {}
        for item, on in carried(home):
            by.setdefault(id(on), []).append(item)
        for items in by.values():
            for n, a in enumerate(items):
                for b in items[n + 1 :]:
                    apart = a.position[2] + a.size[2] <= b.position[2] or b.position[2] + b.size[2] <= a.position[2]
                    assert apart or Polygon(a.corners()).intersection(Polygon(b.corners())).area < 1e-9


def test_things_meet_no_solid_of_their_support(real):
    count = 0
    for home in real:
        for item, on in carried(home):
            boxes = surfaces_of(on.model).boxes
            c, s = math.cos(on.yaw), math.sin(on.yaw)
            corners = np.array(item.corners()) - on.position[:2]
            local = Polygon(np.column_stack([c * corners[:, 0] + s * corners[:, 1], -s * corners[:, 0] + c * corners[:, 1]]))
            z = item.position[2] - on.position[2]
            for low, high in boxes:
                if low[2] < z + item.size[2] - 1e-3 and high[2] > z + 2e-3:
                    solid = Polygon([(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])])
                    assert local.intersection(solid).area < 1e-6, (item.model.category, on.model.category)
            count += 1
    assert count > 20


def test_everyday_things_are_where_they_are_used():
    found = Counter((on.model.category, item.model.category) for home in HOUSES for item, on in carried(home))
    for pair in (
        ("coffee_table", "remote"),
        ("desk", "laptop"),
        ("bookshelf", "book"),
        ("nightstand", "table_lamp"),
        ("dining_table", "plate"),
    ):
        assert found[pair], pair
    assert not any(thing in {"laptop", "plate"} and on in {"toilet", "shower", "washing_machine"} for on, thing in found)


def test_what_stands_on_a_rug_is_raised_by_it_and_nothing_else_is_on_one():
    rugs = 0
    for home in HOUSES:
        for k, rug in enumerate(home.items):
            if rug.model.category != "rug":
                continue
            rugs += 1
            for other in home.items:
                if other is rug or other.room != rug.room or other.position[2] > 0.05:
                    continue
                shared = Polygon(rug.corners()).intersection(Polygon(other.corners())).area
                assert shared < 1e-6 or (other.support == k and other.position[2] == pytest.approx(rug.size[2]))
    assert rugs > 3


def test_curtains_hang_at_windows_and_pictures_nowhere_in_a_doorway():
    curtains = 0
    for home in HOUSES:
        for item in home.items:
            if item.model.category not in {"curtain", "picture", "mirror", "wall_lamp"}:
                continue
            room = home.plan.rooms[item.room].room_id
            for opening in home.plan.openings:
                near = Polygon(item.corners()).buffer(0.3).intersects(Polygon([*opening.segment, opening.segment[0] + 1e-6]))
                if room in opening.rooms and near:
                    curtains += item.model.category == "curtain" and opening.kind == "window"
                    if opening.kind != "window" and item.position[2] < opening.height:
                        low, high = sorted(opening.segment.tolist())
                        along = np.array(high) - np.array(low)
                        spans = [(np.array(c) - low) @ along / (along @ along) for c in item.corners()]
                        across = abs(along[0] * (item.position[1] - low[1]) - along[1] * (item.position[0] - low[0])) / np.hypot(*along)
                        assert across > 0.2 or max(spans) < 1e-6 or min(spans) > 1 - 1e-6, item.model.category
    assert curtains > 5


def test_levels_are_rectangles_inside_their_faces():
    board = np.array([[0, 0], [1, 0], [1, 0.5], [0, 0.5]])
    assert rectangle_in(board, LEAST) == (0.0, 0.0, 1.0, 0.5)
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    disc = np.column_stack([np.cos(angle), np.sin(angle)])
    x0, y0, x1, y1 = rectangle_in(disc, LEAST)
    assert max(abs(x0), x1, abs(y0), y1) <= 1 / math.sqrt(2) + 1e-6
    assert x1 - x0 > 1.1
    assert rectangle_in(board * [1, 0.1], LEAST) is None
