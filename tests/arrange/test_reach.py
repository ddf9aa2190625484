"""What one stands before to use it is in reach, whatever stands across the way in the draft."""

import math

import numpy as np

from pipeline.arrange import separate
from pipeline.arrange.bonds import group_of
from pipeline.arrange.item import make_item
from pipeline.arrange.occupancy import Occupancy
from pipeline.arrange.settings import SeparateSettings
from tests.arrange.known import LORE, drafted, farthest
from tests.geometry.furniture import block, chair, one_room, table
from tests.judging import site

ASSETS = {
    "sink": block("sink", "sink_cabinet", (0.8, 0.6, 0.92)),
    "cooker": block("cooker", "oven", (0.6, 0.6, 0.9)),
    "table": table(size=(1.7, 0.8, 0.75)),
    "chair": chair(),
    "toilet": block("toilet", "toilet", (0.4, 0.6, 0.8)),
    "tub": block("tub", "bathtub", (1.75, 0.8, 0.6)),
    "case": block("case", "bookcase", (1.0, 0.6, 1.8)),
}


def galley(length=6.0, door=True):
    return one_room(np.array([[0.0, 0.0], [1.8, 0.0], [1.8, length], [0.0, length]]), door=door)


def dining(y, chairs):
    """A table from wall to wall across a galley, chairs at both its long sides, sink and cooker behind."""
    draft = [drafted(ASSETS["sink"], 0.45, 5.69), drafted(ASSETS["cooker"], 1.2, 5.69), drafted(ASSETS["table"], 0.9, y)]
    seats = [(0.45, -0.5, math.pi), (1.35, 0.5, 0.0), (1.35, -0.5, math.pi), (0.45, 0.5, 0.0)][:chairs]
    return [*draft, *(drafted(ASSETS["chair"], x, y + off, yaw, number=k) for k, (x, off, yaw) in enumerate(seats))]


def test_a_table_across_the_way_is_turned_with_its_chairs_about_it():
    for chairs in (0, 1, 2):
        found = separate(site(galley(), "room"), dining(3.6, chairs), ASSETS, LORE)
        assert found.unreached == frozenset()
        assert found.rejects == ()
        turned = next(p for p in found.placements if p.category == "dining_table")
        assert abs(math.sin(turned.yaw)) > 0.99


def test_a_group_that_is_in_nobodys_way_stays_across_the_room():
    wished = [p for p in dining(3.6, 2) if p.category not in {"sink_cabinet", "oven"}]
    assert farthest(separate(site(galley(), "room"), wished, ASSETS, LORE), wished) < 0.2


def stood(plan, *placements):
    items = [make_item(p, ASSETS, LORE, 0.55) for p in placements]
    poses = np.array([item.wished for item in items])
    occupancy = Occupancy(site(plan, "room"), items, SeparateSettings(), np.zeros((len(items), len(items))))
    for i in range(len(items)):
        occupancy.stand(group_of([i], poses), poses[i])
    return occupancy, poses


def test_a_fixture_without_a_handle_is_used_from_before_its_front():
    toilet, tub, case = drafted(ASSETS["toilet"], 0.9, 4.7), drafted(ASSETS["tub"], 0.9, 3.5), drafted(ASSETS["case"], 0.5, 4.7)
    occupancy, poses = stood(galley(5.0), toilet, tub)
    assert occupancy.out_of_reach() == {0}
    occupancy.leave(group_of([1], poses))
    assert occupancy.out_of_reach() == frozenset()
    assert stood(galley(5.0), case, tub)[0].out_of_reach() == frozenset()  # a bookcase that does not open is seen from afar


def test_nothing_is_out_of_reach_where_a_robot_does_not_get_into_the_empty_room():
    plan = one_room(np.array([[0.0, 0.0], [0.5, 0.0], [0.5, 3.0], [0.0, 3.0]]), door=False)
    occupancy, _ = stood(plan, drafted(ASSETS["toilet"], 0.25, 2.7))
    assert not occupancy.enters
    assert occupancy.out_of_reach() == frozenset()
