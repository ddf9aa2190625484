"""Furnished rooms: nothing overlaps, doors swing free, the relations of 3D-FRONT hold, a robot gets around."""

import math
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from sample_houses import house, houses, stock
from shapely.affinity import rotate
from shapely.geometry import LineString, Point, Polygon, box

from pipeline import taxonomy
from pipeline.corpus.houses import living
from pipeline.corpus.houses.house import make_house
from pipeline.corpus.houses.planner import agenda, make_plan
from pipeline.corpus.houses.room_occupancy import Space, problems
from pipeline.manifest import digest
from pipeline.seeds import generator

HOUSES = houses(24)
CHAIRS = {"dining_chair", "chinese_chair"}


def small(item):
    return not taxonomy.load().categories[item.model.category].layout


def solid(item):
    return Polygon(item.corners())


def in_rooms(category):
    """Yield (room, items of the room) of rooms that hold the category."""
    for home in HOUSES:
        for k, room in enumerate(home.plan.rooms):
            items = [i for i in home.items if i.room == k]
            if any(i.model.category == category for i in items):
                yield room, items


def local(frame, item):
    """Return an item's place in another's frame: (right, front) [m]."""
    c, s = math.cos(frame.yaw), math.sin(frame.yaw)
    dx, dy = item.position[0] - frame.position[0], item.position[1] - frame.position[1]
    return c * dx + s * dy, s * dx - c * dy


@pytest.mark.parametrize("home", HOUSES)
def test_nothing_overlaps_and_everything_is_inside_its_room(home):
    for k, room in enumerate(home.plan.rooms):
        floor = Polygon(room.polygon).buffer(1e-3)
        items = [i for i in home.items if i.room == k]
        for n, item in enumerate(items):
            assert floor.contains(solid(item)), item.model.category
            assert item.position[2] >= 0
            assert item.position[2] + item.size[2] <= room.height + 1e-6
            for other in items[n + 1 :]:
                low = max(item.position[2], other.position[2])
                high = min(item.position[2] + item.size[2], other.position[2] + other.size[2])
                if high - low <= 1e-3 or small(item) or small(other):
                    continue
                shared = solid(item).intersection(solid(other)).area
                tucked = {item.model.category, other.model.category} & CHAIRS and "dining_table" in {
                    item.model.category,
                    other.model.category,
                }
                most = 0.4 * min(solid(item).area, solid(other).area) if tucked else 2e-3  # a chair reaches under its table
                assert shared < most, (item.model.category, other.model.category)


@pytest.mark.parametrize("home", HOUSES)
def test_door_leaves_swing_free(home):
    for opening in home.plan.openings:
        if opening.swing is None:
            continue
        hinge, other = opening.segment[opening.swing.hinge], opening.segment[1 - opening.swing.hinge]
        room = Polygon(home.plan.room(opening.swing.room_id).polygon)
        leaf = other - hinge
        normal = np.array([-leaf[1], leaf[0]])
        if not room.contains(Polygon([hinge, other, hinge + normal]).centroid):
            normal = -normal
        turn = np.linspace(0, min(opening.swing.angle, math.pi / 2), 12)
        swept = Polygon([hinge, *(hinge + np.outer(np.cos(turn), leaf) + np.outer(np.sin(turn), normal))])
        for item in home.items:
            if item.position[2] < opening.height:
                assert swept.intersection(solid(item)).area < 1e-4, item.model.category


@pytest.mark.parametrize("home", HOUSES)
def test_a_robot_gets_from_door_to_door_and_near_most_things(home):
    for k, room in enumerate(home.plan.rooms):
        space = Space(k, room, [o for o in home.plan.openings if room.room_id in o.rooms])
        if min(np.ptp(room.polygon, axis=0)) < 1.2:
            continue
        space.items = [i for i in home.items if i.room == k and not small(i)]
        cut_off, far = problems(space)
        assert cut_off == 0, room.type
        assert not far, room.type


def test_beds_have_their_head_at_a_wall_and_nightstands_beside_it():
    beside = 0
    for room, items in in_rooms("double_bed"):
        bed = next(i for i in items if i.model.category == "double_bed")
        head = np.mean(bed.corners()[2:], axis=0)
        assert Polygon(room.polygon).exterior.distance(Point(head)) < 0.08
        for stand in (i for i in items if i.model.category == "nightstand"):
            right, front = local(bed, stand)
            assert abs(right) == pytest.approx((bed.size[0] + stand.size[0]) / 2, abs=0.2)
            assert front == pytest.approx(-(bed.size[1] - stand.size[1]) / 2, abs=0.02)
            assert stand.yaw == pytest.approx(bed.yaw)
            beside += 1
    assert beside > 20


def test_tv_stands_face_bed_or_sofa():
    seen = 0
    for _, items in in_rooms("tv_stand"):
        stand = next(i for i in items if i.model.category == "tv_stand")
        lookers = [i for i in items if i.model.category.endswith(("_bed", "_sofa"))]
        if not lookers:
            continue
        places = [(i, *local(i, stand)) for i in lookers]
        assert any(front > 1.2 and abs(right) < 0.5 and math.cos(i.yaw - stand.yaw) < -0.99 for i, right, front in places)
        seen += 1
    assert seen > 10


def test_coffee_tables_stand_in_front_of_sofas():
    seen = 0
    for _, items in in_rooms("coffee_table"):
        sofas = [i for i in items if i.model.category.endswith("_sofa")]
        if not sofas:
            continue  # a bedroom's
        table = next(i for i in items if i.model.category == "coffee_table")
        gaps = [(local(s, table)[1] - s.size[1] / 2 - table.size[1] / 2, abs(local(s, table)[0])) for s in sofas]
        assert any(0.2 < gap < 0.6 and aside < 0.3 for gap, aside in gaps)
        seen += 1
    assert seen > 10


def test_dining_chairs_face_their_table_and_a_pendant_hangs_above():
    chairs, square, lamps, tables = 0, 0, 0, 0
    for _, items in in_rooms("dining_table"):
        table = next(i for i in items if i.model.category == "dining_table")
        tables += 1
        lamps += any(math.dist(i.position[:2], table.position[:2]) < 0.16 for i in items if i.model.category == "pendant_lamp")
        for chair in (i for i in items if i.model.category in CHAIRS):
            if math.dist(chair.position[:2], table.position[:2]) > 2.2:
                continue  # at a desk
            chairs += 1
            front = (math.sin(chair.yaw), -math.cos(chair.yaw))
            ray = [chair.position[:2], tuple(np.add(chair.position[:2], np.multiply(front, 1.0)))]
            square += LineString(ray).intersects(solid(table))
    assert chairs > 30
    assert square / chairs > 0.93
    assert lamps / tables > 0.6


def test_four_chairs_at_a_square_table_have_a_side_each_and_room_beside_each_other():
    model = {m.category: m for models in stock().by_category.values() for m in models}
    chair = model["dining_chair"]
    for side in (0.8, 0.9, 1.1):
        seats = living.seats_at(replace(model["dining_table"], size=(side, side, 0.75)), chair, 4, -0.1)
        w, d = chair.size[:2]
        boxes = [rotate(box(x - w / 2, y - d / 2, x + w / 2, y + d / 2), turn, use_radians=True) for x, y, turn in seats]
        assert sorted(turn for *_, turn in seats) == pytest.approx([-math.pi / 2, 0.0, math.pi / 2, math.pi])
        assert all(a.distance(b) > 0.01 for k, a in enumerate(boxes) for b in boxes[:k])
        assert all(b.intersection(box(-side / 2, -side / 2, side / 2, side / 2)).area > 0 for b in boxes)


def test_kitchens_have_a_run_with_sink_oven_and_fridge():
    counts = Counter()
    for home in HOUSES:
        for k, room in enumerate(home.plan.rooms):
            if room.type == "Kitchen" and not home.empty[k]:
                present = {i.model.category for i in home.items if i.room == k}
                counts.update(present & {"sink_cabinet", "oven", "refrigerator", "kitchen_cabinet", "wall_cabinet"})
                counts["kitchens"] += 1
    assert counts["sink_cabinet"] >= 0.95 * counts["kitchens"]
    assert min(counts[c] for c in ("oven", "refrigerator")) >= 0.9 * counts["kitchens"]
    assert counts["kitchen_cabinet"] >= 0.8 * counts["kitchens"]
    assert counts["wall_cabinet"] >= 0.4 * counts["kitchens"]


def test_wall_pieces_have_their_backs_to_walls():
    gaps = []
    for home in HOUSES:
        for item in home.items:
            if item.model.category in {"wardrobe", "bookshelf", "sideboard", "cabinet", "toilet", "refrigerator"}:
                back = np.mean(item.corners()[2:], axis=0)
                gaps.append(Polygon(home.plan.rooms[item.room].polygon).exterior.distance(Point(back)))
    assert np.median(gaps) < 0.03
    assert max(gaps) < 0.08


def test_yaws_are_mostly_square_and_some_oblique():
    yaws = np.array([i.yaw for home in HOUSES for i in home.items if not small(i)])
    assert np.all((yaws > -math.pi) & (yaws <= math.pi))
    oblique = np.mean(np.abs(np.sin(2 * yaws)) > 0.035)
    assert 0.003 < oblique < 0.15


def test_same_arguments_same_house_other_seed_other_house():
    assert _same(make_house(5, 3, stock()), house(3))
    assert not _same(make_house(6, 3, stock()), house(3))
    assert len({tuple(i.position for i in h.items) for h in HOUSES}) == len(HOUSES)
    assert len({h.uid for h in HOUSES}) == len(HOUSES)


def _same(a, b):
    return (
        a.uid == b.uid and a.items == b.items and [r.polygon.tolist() for r in a.plan.rooms] == [r.polygon.tolist() for r in b.plan.rooms]
    )


def test_no_two_of_two_hundred_plans_are_alike():
    plans = [make_plan(generator(7, "house", index), agenda(7, index).rooms) for index in range(200)]
    digests = {digest([[r.type, r.polygon.tolist()] for r in plan.rooms]) for plan in plans}
    assert len(digests) == len(plans)
