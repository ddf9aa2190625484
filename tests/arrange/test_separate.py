import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.arrange import separate
from pipeline.verify import verify_home
from tests.arrange.known import LORE, farthest
from tests.geometry.furniture import LIBRARY, chest, home, one_room, placed, two_rooms
from tests.judging import SETTINGS, site


def judge(placements, plan=None):
    return verify_home(home(placements, plan), LIBRARY, SETTINGS)


def messy(seed, names=("bed", "nightstand", "chest", "cupboard", "chair", "table")):
    rng = np.random.default_rng(seed)
    return [
        placed(n, *np.round(rng.uniform(0.2, 2.8, 2), 4), round(float(rng.uniform(-3.1, 3.1)), 5), number=k) for k, n in enumerate(names)
    ]


def room(side=4.5, plan=None):
    return plan or one_room(np.array([[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]]))


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10**6))
def test_what_comes_out_passes_the_judge(seed):
    plan = room()
    found = separate(site(plan, "room"), messy(seed), LIBRARY, LORE)
    assert judge(found.placements, plan).faults(SETTINGS.policy) == ()
    assert len(found.placements) + sum(r.reason == "unplaceable" for r in found.rejects) == 6


def test_a_robot_gets_to_nearly_all_that_opens_where_no_relation_is_in_its_way():
    plan = room()
    drafts = [messy(seed, ("bed", "chest", "cupboard", "chair", "table")) for seed in range(16)]
    found = [judge(separate(site(plan, "room"), draft, LIBRARY, LORE).placements, plan) for draft in drafts]
    assert sum(certificate.faults(replace(SETTINGS.policy, reach=1.0)) == () for certificate in found) >= 14


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10**6), st.floats(2.2, 3.5))
def test_separation_never_increases_collisions(seed, side):
    plan = room(side)
    before = judge(messy(seed), plan)
    found = separate(site(plan, "room"), messy(seed), LIBRARY, LORE)
    after = judge(found.placements, plan)
    assert after.collisions == 0 <= before.collisions
    assert all(j.clear for j in after.joints)


def test_what_is_well_stays():
    plan = room()
    # Backs at walls, in the gap that is usual, axis-parallel, nothing near anything.
    well = [placed("bed", 3.0, 3.49), placed("cupboard", 0.26, 2.5, math.pi / 2, number=1)]
    found = separate(site(plan, "room"), well, LIBRARY, LORE)
    assert farthest(found, well) < 0.005
    assert [p.yaw for p in found.placements] == pytest.approx([0, math.pi / 2], abs=1e-4)


def test_the_outcome_is_the_same_twice_and_keeps_the_order():
    plan = room()
    one, two = (separate(site(plan, "room"), messy(3), LIBRARY, LORE) for _ in range(2))
    assert [p.object_id for p in one.placements] == sorted((p.object_id for p in one.placements), key=lambda i: int(i.split("_")[1]))
    assert all(np.array_equal(a.position, b.position) and a.yaw == b.yaw for a, b in zip(one.placements, two.placements, strict=True))


def test_poses_are_rounded():
    for p in separate(site(room(), "room"), messy(5), LIBRARY, LORE).placements:
        assert np.array_equal(p.position, np.round(p.position, 4))
        assert p.yaw == round(p.yaw, 5)
        assert -math.pi < p.yaw <= math.pi


def test_backs_go_to_walls():
    plan = room()
    tilted = [placed("cupboard", 2.0, 4.0, 0.15), placed("bed", 0.9, 2.0, math.pi / 2 - 0.1, number=1)]
    cupboard, bed = separate(site(plan, "room"), tilted, LIBRARY, LORE).placements
    assert cupboard.yaw == pytest.approx(0.0, abs=1e-4)
    assert cupboard.position[1] == pytest.approx(4.5 - 0.25 - 0.01, abs=0.005)
    assert bed.yaw == pytest.approx(math.pi / 2, abs=1e-4)
    assert bed.position[0] == pytest.approx(1.01, abs=0.005)


def test_a_chair_may_stay_under_its_table():
    plan = room()
    tucked = [placed("table", 2.2, 2.2), placed("chair", 2.2 - 0.35, 2.2 - 0.4 - 0.25 + 0.14, math.pi, number=1)]
    found = separate(site(plan, "room"), tucked, LIBRARY, LORE)
    assert farthest(found, tucked) < 0.1
    assert abs(found.placements[1].position[1] - found.placements[0].position[1]) < 0.4 + 0.25


def test_drawers_come_out_before_the_levers_of_closed_doors(monkeypatch):
    monkeypatch.setitem(LIBRARY, "tall", chest("tall", size=(0.8, 0.5, 1.4)))
    draft = [placed("tall", 3.59, 0.65, math.pi, room="living")]
    found = separate(site(two_rooms(), "living"), draft, LIBRARY, LORE)
    assert [j.clear for plan in (draft, found.placements) for j in judge(plan, two_rooms()).joints[:1]] == [False, True]


def test_nightstands_go_beside_beds():
    plan = room()
    wished = [placed("bed", 2.2, 3.4), placed("nightstand", 1.3, 3.6, 0.3, number=1)]
    bed, stand = separate(site(plan, "room"), wished, LIBRARY, LORE).placements
    assert bed.position[0] - 0.8 - (stand.position[0] + 0.25) == pytest.approx(0.08, abs=0.05)
    assert stand.yaw == bed.yaw
    assert stand.position[1] + 0.2 == pytest.approx(bed.position[1] + 1.0, abs=0.01)


def test_the_way_through_stays_open():
    plan = two_rooms()
    for seed in range(5):
        rng = np.random.default_rng(seed)
        wished = [placed("cupboard", *rng.uniform(3.0, 3.9, 2), rng.uniform(-3, 3), room="living", number=k) for k in range(3)]
        found = separate(site(plan, "living"), wished, LIBRARY, LORE)
        certificate = judge(found.placements, plan)
        assert [r.connected for r in certificate.rooms] == [True, True]


def test_lamps_hang_from_the_ceiling_and_the_rest_stands_on_the_floor():
    plan = room()
    found = separate(site(plan, "room"), [placed("lamp", 2, 2, z=1.0), placed("chair", 1, 2, z=0.3, number=1)], LIBRARY, LORE)
    assert [p.position[2] for p in found.placements] == pytest.approx([2.4, 0.0])


def test_what_does_not_fit_is_named():
    plan = room(2.2)
    many = [placed("bed", 1.1, 1.1, number=k) for k in range(3)]
    found = separate(site(plan, "room"), many, LIBRARY, LORE)
    assert {r.reason for r in found.rejects} == {"unplaceable"}
    assert len(found.placements) + len(found.rejects) == 3


def test_what_is_too_large_is_exchanged():
    # A niche of 95 cm by 90 cm: the block of a metre does not fit, the small one does.
    plan = one_room(np.array([[0.0, 0.0], [0.95, 0.0], [0.95, 0.9], [0.0, 0.9]]), door=False)

    def smaller(asset_id, area):
        return SimpleNamespace(asset_id="small_block", distance=0.1, scale=np.ones(3)) if asset_id == "block" and area > 0.28 else None

    found = separate(site(plan, "room", radius=0.2), [placed("block", 0.5, 0.5)], LIBRARY, LORE, smaller=smaller)
    assert [(p.asset_id, p.retrieval_distance) for p in found.placements] == [("small_block", 0.1)]
    assert np.array_equal(found.placements[0].size, LIBRARY["small_block"].size)
    assert [r.reason for r in found.rejects] == ["shrunk_to_fit"]
