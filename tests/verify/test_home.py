import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.verify import verify_home
from schemas import JOINTS
from tests.geometry.furniture import LIBRARY, home, moved_placements, moved_plan, one_room, placed, two_rooms
from tests.judging import SETTINGS


def judge(*placements, plan=None):
    return verify_home(home(placements, plan), LIBRARY, SETTINGS)


def test_a_drawer_blocked_by_a_bed_at_thirty_centimetres():
    # The chest stands at the upper wall, its drawer comes out by 0.4 m towards -y, the handle by 3 cm more.
    chest = placed("chest", 2.0, 2.74)
    front = 2.74 - 0.25
    bed = placed("bed", 2.0, front - 0.3 - 1.0)
    joint = judge(chest, bed).joints[0]
    assert (joint.clear, joint.blocker) == (False, "bed_0")
    assert joint.clear_upper == pytest.approx(0.3 - 0.03, abs=0.4 / 12)
    assert joint.clear_upper <= 0.27 + SETTINGS.touch
    free = judge(chest, placed("bed", 2.0, front - 0.44 - 1.0)).joints[0]
    assert (free.clear, free.blocker, free.clear_upper) == (True, "", pytest.approx(0.4))


def test_a_bed_under_the_drawer_does_not_block_it():
    low = judge(placed("chest", 2.0, 2.74, z=0.6), placed("bed", 2.0, 1.3)).joints[0]
    assert low.clear


def test_a_door_blocked_by_the_wall_beside_it():
    # Hinged at its left, opening to 90 degrees: at the left wall it would need no more room; turned, it hits.
    assert judge(placed("cupboard", 0.31, 2.74)).joints[0].clear
    facing_wall = judge(placed("cupboard", 2.0, 0.25 + 0.4)).joints[0]
    assert (facing_wall.clear, facing_wall.blocker) == (False, "wall")
    assert 0 < facing_wall.clear_upper < math.pi / 2


def test_a_drawer_meets_the_lever_of_a_closed_door():
    # In the living room, from which the door swings away: the drawer comes out along its wall, at the height of the lever.
    joint = judge(placed("chest", 3.59, 0.65, math.pi, z=0.6, room="living"), plan=two_rooms()).joints[0]
    assert (joint.clear, joint.blocker) == (False, "door")
    assert judge(placed("chest", 3.54, 0.65, math.pi, z=0.6, room="living"), plan=two_rooms()).joints[0].clear


def test_the_room_door_hits_a_chair():
    free = judge().joints[0]
    assert (free.object_id, free.part_class, free.clear) == ("entrance", "door_leaf", True)
    assert free.stand is not None
    struck = judge(placed("chair", 0.6, 0.5)).joints[-1]
    assert (struck.clear, struck.blocker) == (False, "chair_0")
    assert struck.clear_upper < struck.upper


def test_a_chair_under_a_table_is_no_collision_until_its_back_meets_the_top():
    table = placed("table", 2.0, 1.5)
    # At yaw 180 degrees the chair's front faces +y; its seat (0.45 m) fits under the top (0.71 m).
    tucked = judge(table, placed("chair", 2.0, 1.1 - 0.25 + 0.3, math.pi))
    assert tucked.collisions == 0
    pushed = judge(table, placed("chair", 2.0, 1.1 - 0.25 + 0.5, math.pi))
    assert {o.object_id for o in pushed.objects if o.collides} == {"table_0", "chair_0"}


def test_collisions_are_mutual_and_walls_count():
    found = judge(placed("block", 2.0, 2.0), placed("block", 2.3, 2.1, number=1), placed("bed", 3.1, 0.5, number=2))
    hits = {o.object_id: o.hits for o in found.objects}
    assert hits["block_0"] == ("block_1",)
    assert hits["block_1"] == ("block_0",)
    outside = found.objects[2]
    assert not outside.inside
    assert outside.outside == pytest.approx(0.5)
    assert found.collisions == 3


def test_touching_is_not_colliding():
    assert judge(placed("block", 1.0, 2.75), placed("block", 2.0, 2.75, number=1)).collisions == 0


def test_support():
    def supported(*placements):
        return [o.supported for o in judge(*placements).objects]

    assert supported(placed("block", 2, 2)) == [True]
    assert supported(placed("block", 2, 2, z=0.5)) == [False]
    assert supported(placed("lamp", 2, 2, z=2.4)) == [True]
    assert supported(placed("lamp", 2, 2, z=2.6)) == [False]
    assert supported(placed("block", 2, 2), placed("nightstand", 2, 2, z=1.0)) == [True, True]
    assert supported(placed("block", 2, 2), placed("nightstand", 3.2, 2, z=1.0)) == [True, False]


def test_stand_poses_are_free_and_in_reach():
    found = judge(placed("chest", 2.0, 2.74)).joints[0]
    x, y, yaw = found.stand
    handle = np.array([2.0, 2.74 - 0.265])
    robot = SETTINGS.robot
    assert robot.reach[0] - 1e-4 <= np.hypot(*(handle - [x, y])) <= robot.reach[1] + 1e-4
    assert y < 2.74 - 0.25 - 0.43 - robot.radius + 0.01  # clear of the open drawer
    assert np.allclose([math.cos(yaw), math.sin(yaw)], (handle - [x, y]) / np.hypot(*(handle - [x, y])), atol=1e-3)


def test_what_cannot_be_reached_has_no_stand():
    # A wall of beds cuts the room; the chest is behind it and its drawer is free, but nobody gets there.
    wall = [placed("bed", 1.01, 1.1, math.pi / 2, number=1), placed("bed", 3.0, 1.1, math.pi / 2, number=2)]
    found = judge(placed("chest", 2.0, 2.74), *wall, plan=one_room())
    assert found.joints[0].stand is None
    assert found.reach == 0
    assert judge(placed("chest", 2.0, 2.74)).reach == 1


def test_rooms_that_hang_together():
    free = judge(plan=two_rooms())
    assert [r.connected for r in free.rooms] == [True, True]
    assert all(r.walkable_free > 0.97 and r.walkable_paper == 1 for r in free.rooms)
    cut = judge(placed("block", 3.6, 0.9, math.pi / 2, room="living"), plan=two_rooms())
    assert [r.connected for r in cut.rooms] == [True, False]
    assert cut.rooms[1].walkable_free == 0
    assert [code for code, _ in cut.faults(replace(SETTINGS.policy, clear=0.0))] == ["room_cut_off"]


def test_walkable_paper_is_the_papers_formula():
    found = judge(placed("bed", 2.0, 1.9), placed("block", 2.0, 2.0, number=1), placed("lamp", 1, 1, z=2.4)).rooms[0]
    assert found.walkable_paper == pytest.approx((12 - 3.2 - 0.5) / 12)  # overlaps are summed, lamps take no floor
    assert found.walkable_printed == pytest.approx((12 - 3.2 - 0.5 - 0.25) / 12)
    assert found.walkable_free < found.walkable_paper + 0.1


def test_more_furniture_never_frees_floor():
    rng = np.random.default_rng(0)
    placements, last = [], 2.0
    for k in range(8):
        free = judge(*placements).rooms[0].walkable_free
        assert free <= last + 1e-9
        last = free
        placements.append(placed("nightstand", *rng.uniform(0.5, 2.5, 2), number=k))


def test_rows_fit_the_schema():
    found = judge(placed("chest", 2.0, 2.74), placed("cupboard", 3.5, 2.74))
    assert JOINTS.from_rows(found.joint_rows()).num_rows == 3
    assert found.scene_figures()["joints"] == 3
    assert set(found.room_figures()) == {"room"}
    assert found.ok(SETTINGS.policy)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6), st.floats(-3.1, 3.1), st.floats(-20, 20), st.floats(-20, 20))
def test_verdicts_do_not_hang_on_where_the_home_lies(seed, angle, dx, dy):
    rng = np.random.default_rng(seed)
    names = ("chest", "cupboard", "chair", "table", "nightstand")
    # Random shapes are far from grazing each other, almost surely.
    objects = [placed(n, *rng.uniform(0.3, 2.7, 2), rng.uniform(-3, 3), number=k) for k, n in enumerate(names)]
    shift = np.array([dx, dy])
    here = judge(*objects, plan=one_room())
    there = judge(*moved_placements(objects, angle, shift), plan=moved_plan(one_room(), angle, shift))
    assert [(j.clear, j.blocker) for j in here.joints] == [(j.clear, j.blocker) for j in there.joints]
    assert [o.hits for o in here.objects] == [o.hits for o in there.objects]
    assert [o.inside for o in here.objects] == [o.inside for o in there.objects]
    assert np.allclose([o.outside for o in here.objects], [o.outside for o in there.objects], atol=2e-6)
    assert here.rooms[0].walkable_paper == pytest.approx(there.rooms[0].walkable_paper)


@settings(max_examples=8, deadline=None)
@given(st.integers(-400, 400), st.integers(-400, 400))
def test_floors_do_not_hang_on_where_the_home_lies(dx, dy):
    objects = (placed("chest", 2.0, 2.74), placed("bed", 3.1, 1.1), placed("chair", 1.2, 1.9, 0.4))
    shift = np.array([dx, dy]) / 8
    here, there = judge(*objects), judge(*moved_placements(objects, 0.0, shift), plan=moved_plan(one_room(), 0.0, shift))
    assert here.rooms[0].walkable_free == pytest.approx(there.rooms[0].walkable_free, abs=0.01)
    assert here.rooms[0].connected == there.rooms[0].connected
