"""Kitchens come out as runs, whatever their units were drafted like."""

import math
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.arrange import separate
from pipeline.arrange.item import make_item
from pipeline.arrange.runs import bare_units, stray_units
from pipeline.entities.plan import Opening, Plan
from pipeline.verify import verify_home
from tests.arrange.known import LORE, drafted
from tests.geometry.furniture import block, cupboard, home, one_room
from tests.judging import SETTINGS, site

ASSETS = {
    "base": block("base", "kitchen_cabinet", (0.8, 0.58, 0.9)),
    "sink": block("sink", "sink_cabinet", (0.9, 0.6, 0.92)),
    "cooker": block("cooker", "oven", (0.6, 0.62, 0.9)),
    "fridge": block("fridge", "refrigerator", (0.7, 0.7, 1.8)),
    "hung": block("hung", "wall_cabinet", (0.8, 0.35, 0.7)),
    "slim": block("slim", "kitchen_cabinet", (0.4, 0.58, 0.9)),
    "opening": cupboard("opening", "refrigerator", (0.7, 0.7, 1.8), math.radians(100.0)),  # its door goes 12 cm beyond its side
}
UNITS = ("sink", "cooker", "base", "fridge")


def room():
    return one_room(np.array([[0.0, 0.0], [4.5, 0.0], [4.5, 3.0], [0.0, 3.0]]))


def arranged(placements):
    found = separate(site(room(), "room"), placements, ASSETS, LORE)
    assert verify_home(home(found.placements, room()), ASSETS, SETTINGS).faults(SETTINGS.policy) == ()
    assert found.rejects == ()
    return {p.asset_id: p for p in found.placements}


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 10**6), st.permutations(UNITS))
def test_a_rough_draft_becomes_one_run(seed, names):
    rng = np.random.default_rng(seed)
    wished = [
        drafted(ASSETS[name], 0.8 + 0.8 * k + rng.normal(0, 0.1), 2.6 + rng.normal(0, 0.1), rng.normal(0, 0.15), number=k)
        for k, name in enumerate(names)
    ]
    found = arranged(wished)
    units = sorted(found.values(), key=lambda p: p.position[0])
    order = [p.asset_id for p in units]
    assert order[0] == "fridge" or order[-1] == "fridge"
    assert abs(order.index("sink") - order.index("cooker")) == 2
    for left, right in pairwise(units):
        assert right.position[0] - left.position[0] - (left.size[0] + right.size[0]) / 2 == pytest.approx(0.002, abs=0.0005)
    fronts = [p.position[1] - p.size[1] / 2 for p in units if p.asset_id != "fridge"]
    assert max(fronts) - min(fronts) < 0.001
    assert {p.yaw for p in units} == {0.0}


def test_wall_units_hang_flush_over_the_base_and_not_over_the_refrigerator():
    wished = [drafted(ASSETS[name], 0.9 + 0.8 * k, 2.65, number=k) for k, name in enumerate(("fridge", "sink", "base", "cooker"))]
    wished += [drafted(ASSETS["hung"], 1.2, 2.8, 0.1, z=1.5, number=4), drafted(ASSETS["hung"], 2.3, 2.75, -0.1, z=1.38, number=5)]
    found = separate(site(room(), "room"), wished, ASSETS, LORE).placements
    assert verify_home(home(found, room()), ASSETS, SETTINGS).faults(SETTINGS.policy) == ()
    left, right = sorted((p for p in found if p.asset_id == "hung"), key=lambda p: p.position[0])
    assert right.position[0] - left.position[0] == pytest.approx(0.802, abs=0.001)
    assert left.position[2] == right.position[2] == pytest.approx(1.44, abs=0.02)
    fridge = next(p for p in found if p.asset_id == "fridge")
    assert left.position[0] - 0.4 >= fridge.position[0] + 0.35


def test_a_run_keeps_clear_of_the_door():
    door = next(o for o in room().openings if o.kind == "entrance")
    x, y = door.segment.mean(0)
    wished = [drafted(ASSETS[name], x + 0.5 * k, y + 0.3, math.pi, number=k) for k, name in enumerate(UNITS)]
    assert len(arranged(wished)) == len(UNITS)


def test_a_unit_that_is_drafted_alone_at_another_wall_joins_the_run_where_it_has_room():
    wished = [drafted(ASSETS[name], 0.9 + 0.8 * k, 2.65, number=k) for k, name in enumerate(("sink", "base", "cooker"))]
    found = arranged([*wished, drafted(ASSETS["fridge"], 4.1, 1.0, -math.pi / 2, number=3)])
    units = sorted(found.values(), key=lambda p: p.position[0])
    assert {p.yaw for p in units} == {0.0}
    for left, right in pairwise(units):
        assert right.position[0] - left.position[0] - (left.size[0] + right.size[0]) / 2 == pytest.approx(0.002, abs=0.0005)


def test_two_units_each_alone_at_a_wall_come_to_stand_side_by_side():
    found = arranged([drafted(ASSETS["sink"], 2.0, 2.65), drafted(ASSETS["cooker"], 0.4, 1.0, math.pi / 2, number=1)])
    assert in_one_run(found.values())


def test_a_unit_that_the_run_has_no_room_for_stays_at_its_wall():
    wished = [drafted(ASSETS[name], 0.5 + 0.8 * k, 2.65, number=k) for k, name in enumerate(("sink", "base", "cooker", "base", "base"))]
    found = separate(site(room(), "room"), [*wished, drafted(ASSETS["fridge"], 4.1, 1.0, -math.pi / 2, number=5)], ASSETS, LORE)
    (fridge,) = (p for p in found.placements if p.asset_id == "fridge")
    assert fridge.yaw == pytest.approx(-math.pi / 2, abs=1e-4)


def narrow():
    return one_room(np.array([[0.0, 0.0], [3.1, 0.0], [3.1, 3.0], [0.0, 3.0]]))


def in_one_run(placements):
    units = sorted(placements, key=lambda p: p.position[0])
    gaps = [right.position[0] - left.position[0] - (left.size[0] + right.size[0]) / 2 for left, right in pairwise(units)]
    return {p.yaw for p in units} == {0.0} and np.allclose(gaps, 0.002, atol=0.0005)


def test_what_opens_beyond_its_side_keeps_off_the_corner_and_the_run_together():
    wished = [drafted(ASSETS[name], 0.4 + 0.8 * k, 2.6, number=k) for k, name in enumerate(("opening", "sink", "base", "cooker"))]
    found = arranged(wished)
    assert in_one_run(found.values())
    assert 0.12 < found["opening"].position[0] - 0.35 < 0.2


@pytest.mark.parametrize("exchanged", [True, False])
def test_cabinets_get_narrower_where_a_run_is_too_long_for_its_wall(exchanged):
    names = ("fridge", "sink", "base", "cooker", "base")
    wished = [drafted(ASSETS[name], 0.35 + 0.6 * k, 2.6, number=k) for k, name in enumerate(names)]
    smaller = lambda name, _: SimpleNamespace(asset_id="slim", distance=0.1, scale=np.ones(3)) if name == "base" and exchanged else None  # noqa: E731
    found = separate(site(narrow(), "room"), wished, ASSETS, LORE, smaller=smaller).placements
    assert verify_home(home(found, narrow()), ASSETS, SETTINGS).faults(SETTINGS.policy) == ()
    assert in_one_run(found) == exchanged
    assert sum(p.asset_id == "slim" for p in found) == 2 * exchanged


def test_a_wall_unit_that_is_in_the_way_does_not_tear_a_run():
    wished = [drafted(ASSETS[name], 0.4 + 0.8 * k, 2.6, number=k) for k, name in enumerate(("fridge", "sink", "base", "cooker"))]
    wished.append(drafted(ASSETS["hung"], 0.2, 2.5, math.pi / 2, z=1.45, number=4))  # at the next wall, where the refrigerator stands
    found = separate(site(narrow(), "room"), wished, ASSETS, LORE).placements
    units = sorted((p for p in found if p.asset_id != "hung"), key=lambda p: p.position[0])
    assert len(units) == 4
    for left, right in pairwise(units):
        assert right.position[0] - left.position[0] - (left.size[0] + right.size[0]) / 2 == pytest.approx(0.002, abs=0.0005)


@pytest.mark.parametrize(("apart", "yaw", "lone"), [(0.002, 0.0, 0), (0.3, 0.0, 2), (0.002, math.pi / 2, 2)])
def test_units_without_a_neighbour_are_torn_from_their_run(apart, yaw, lone):
    items = [make_item(drafted(ASSETS["base"], 0.0, 0.0, number=k), ASSETS, LORE, 0.5) for k in range(2)]
    poses = np.array([[1.0, 2.7, 0.0, 0.0], [1.8 + apart, 2.7, 0.0, yaw]])
    assert len(stray_units([[0, 1]], items, poses, np.ones(2, bool))) == lone
    assert stray_units([[0], [1]], items, poses, np.ones(2, bool)) == []


@pytest.mark.parametrize(("name", "ahead", "lone"), [("fridge", 0.2, 0), ("base", 0.2, 2), ("base", 0.1, 0)])
def test_a_refrigerator_whose_front_stands_out_belongs_to_its_run(name, ahead, lone):
    items = [make_item(drafted(ASSETS[n], 0.0, 0.0, number=k), ASSETS, LORE, 0.5) for k, n in enumerate((name, "base"))]
    width, deeper = (ASSETS[name].size[0] + 0.8) / 2, (ASSETS[name].size[1] - 0.58) / 2
    poses = np.array([[1.0, 2.7 + deeper - ahead, 0.0, 0.0], [1.002 + width, 2.7, 0.0, 0.0]])
    assert len(stray_units([[0, 1]], items, poses, np.ones(2, bool))) == lone


def test_a_gap_at_the_nearer_end_of_the_wall_is_closed():
    wide = one_room(np.array([[0.0, 0.0], [3.5, 0.0], [3.5, 3.0], [0.0, 3.0]]))
    for shift in (0.1, 0.4):
        wished = [drafted(ASSETS[name], 0.4 + shift + 0.8 * k, 2.65, number=k) for k, name in enumerate(("base", "sink", "base", "cooker"))]
        found = separate(site(wide, "room"), wished, ASSETS, LORE).placements
        low, high = min(p.position[0] - p.size[0] / 2 for p in found), max(p.position[0] + p.size[0] / 2 for p in found)
        assert (low if shift < 0.2 else 3.5 - high) == pytest.approx(0.004, abs=0.002)


def test_wall_units_hang_over_the_units_that_they_were_drafted_over():
    wished = [drafted(ASSETS[name], 0.5 + 0.8 * k, 2.65, number=k) for k, name in enumerate(("base", "sink", "base", "cooker"))]
    found = arranged([*wished, drafted(ASSETS["hung"], 2.2, 2.8, z=1.45, number=4)])
    assert found["hung"].position[0] == pytest.approx(2.2, abs=0.01)


def test_a_wall_unit_that_finds_no_place_over_the_base_is_left_out():
    wished = [drafted(ASSETS[name], 0.45 + 0.8 * k, 2.65, number=k) for k, name in enumerate(("sink", "fridge"))]
    wished += [drafted(ASSETS["hung"], 0.45 + 0.3 * k, 2.8, z=1.45, number=2 + k) for k in range(2)]
    found = separate(site(narrow(), "room"), wished, ASSETS, LORE)
    assert [p.asset_id for p in found.placements].count("hung") == 1
    assert [r.reason for r in found.rejects] == ["unplaceable"]
    kept = separate(site(narrow(), "room"), wished, ASSETS, LORE, keep_count=True)
    assert [p.asset_id for p in kept.placements].count("hung") == 2


def test_a_wall_unit_is_bare_where_no_base_unit_is_under_it():
    items = [make_item(drafted(ASSETS["hung"], x, 2.8, z=1.45, number=k), ASSETS, LORE, 0.5) for k, x in enumerate((1.0, 3.0))]
    items.append(make_item(drafted(ASSETS["base"], 1.1, 2.7, number=2), ASSETS, LORE, 0.5))
    assert bare_units(items, np.array([i.wished for i in items]), np.ones(3, bool), site(narrow(), "room")) == [1]


def test_no_wall_unit_hangs_before_a_window():
    bare = narrow()
    glass = Opening("pane", "window", ("room",), np.array([[0.4, 3.12], [1.6, 3.12]]), 1.3, 0.9)
    seen = site(Plan(bare.rooms, (*bare.openings, glass), "room"), "room")
    wished = [drafted(ASSETS[name], 0.45 + 0.8 * k, 2.65, number=k) for k, name in enumerate(("sink", "base"))]
    wished += [drafted(ASSETS["hung"], x, 2.8, z=1.45, number=2 + k) for k, x in enumerate((0.6, 2.0))]
    items = [make_item(p, ASSETS, LORE, 0.5) for p in wished]
    assert 2 in bare_units(items, np.array([i.wished for i in items]), np.ones(4, bool), seen)
    hung = [p for p in separate(seen, wished, ASSETS, LORE).placements if p.asset_id == "hung"]
    assert all(p.yaw != 0.0 or p.position[0] - p.size[0] / 2 > 1.55 for p in hung), "at another wall, beside the window, or left out"
