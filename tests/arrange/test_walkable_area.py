from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.arrange import PostoptSettings, WalkableSettings, control_walkable, free_ratio, paper_ratio, post_optimise
from pipeline.verify import verify_home
from tests.arrange.known import LORE
from tests.geometry.furniture import LIBRARY, block, home, one_room, placed
from tests.judging import SETTINGS, site

SIZES = {f"size_{k}": block(f"size_{k}", "cabinet", (1.5 - 0.15 * k, 0.8 - 0.05 * k, 1.0)) for k in range(8)}
ASSETS = {**LIBRARY, **SIZES}
AREA = 12.0


def smaller(asset_id, area):
    if not asset_id.startswith("size_"):
        return None
    fits = [a for a in SIZES.values() if a.size[0] * a.size[1] < area - 1e-9]
    best = max(fits, key=lambda a: a.size[0] * a.size[1], default=None)
    return best and SimpleNamespace(asset_id=best.asset_id, distance=0.5, scale=np.ones(3))


def objects(seed=0, n=5):
    rng = np.random.default_rng(seed)
    made = []
    for k in range(n):
        asset = SIZES[f"size_{rng.integers(0, 4)}"]
        base = placed("block", *rng.uniform(0.8, 2.2, 2), number=k)
        made.append(type(base)(f"o{k}", "room", "cabinet", asset.asset_id, base.position, 0.0, asset.size))
    return made


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**5), st.floats(0.3, 1.0), st.integers(1, 5))
def test_the_paper_ratio_never_falls_and_placements_stay(seed, target, top):
    before = objects(seed)
    found = control_walkable(before, target, paper_ratio(AREA, 0.0), smaller, ASSETS, WalkableSettings(ratio="paper", top=top))
    assert found.after >= found.before
    assert found.reached == (found.after >= target)
    for old, new in zip(before, found.placements, strict=True):
        assert np.array_equal(old.position, new.position)
        assert (old.yaw, old.object_id, old.category) == (new.yaw, new.object_id, new.category)
        assert new.size[0] * new.size[1] <= old.size[0] * old.size[1] + 1e-9
    assert all(e.area_now < e.area_was for e in found.exchanges)


def test_it_stops_at_once_when_the_target_is_met():
    found = control_walkable(objects(), 0.1, paper_ratio(AREA, 0.0), smaller, ASSETS)
    assert (found.iterations, found.exchanges, found.reached) == (0, (), True)


def test_each_iteration_takes_the_k_largest():
    found = control_walkable(objects(), 1.0, paper_ratio(AREA, 0.0), smaller, ASSETS, WalkableSettings(top=2, iterations=1))
    areas = sorted((float(p.size[0] * p.size[1]) for p in objects()), reverse=True)
    assert [e.area_was for e in found.exchanges] == pytest.approx(areas[:2])
    assert found.iterations == 1


def test_iterations_are_bounded_and_exhaustion_ends():
    assert control_walkable(objects(), 1.0, paper_ratio(AREA, 0.0), smaller, ASSETS, WalkableSettings(iterations=3)).iterations == 3
    found = control_walkable(objects(), 1.0, paper_ratio(AREA, 0.0), smaller, ASSETS, WalkableSettings(iterations=99))
    assert {p.asset_id for p in found.placements} == {"size_7"}
    assert not found.reached


def test_as_printed_it_gives_up_when_the_largest_have_nothing_smaller():
    stuck = [placed("bed", 2, 2), *objects(1, 2)]
    printed = control_walkable(stuck, 1.0, paper_ratio(AREA, 0.0), smaller, ASSETS, WalkableSettings(top=1, skip_exhausted=False))
    assert printed.exchanges == ()
    assert control_walkable(stuck, 1.0, paper_ratio(AREA, 0.0), smaller, ASSETS, WalkableSettings(top=1)).exchanges


def test_lamps_take_no_floor():
    lamp = placed("lamp", 2, 2, z=2.4)
    assert paper_ratio(AREA, 0.0)([lamp]) == 1.0
    assert paper_ratio(AREA, 0.0)([placed("bed", 2, 2)]) == pytest.approx(1 - 3.2 / AREA)


def test_the_true_ratio_is_the_judges():
    place = site(one_room(), radius=0.25)
    placements = (placed("bed", 3.0, 1.9), placed("chest", 0.6, 2.74, number=1), placed("lamp", 1, 1, z=2.4, number=2))
    judged = verify_home(home(placements), LIBRARY, SETTINGS).rooms[0].walkable_free
    assert free_ratio(place, LIBRARY)(placements) == pytest.approx(judged, abs=0.01)


@pytest.mark.parametrize("kind", ["free", "paper"])
def test_control_and_separation_together_reach_what_can_be_reached(kind):
    place = site(one_room())
    options = PostoptSettings(walkable=WalkableSettings(ratio=kind))
    crowded = objects(2, 4)
    plain = post_optimise(place, crowded, ASSETS, LORE, options, smaller, target=0.01).ratio
    found = post_optimise(place, crowded, ASSETS, LORE, options, smaller, target=plain + 0.05)
    assert found.failed == ""
    assert found.ratio >= plain + 0.05
    assert found.exchanges > 0
    assert verify_home(home(found.placements), ASSETS, SETTINGS).collisions == 0
    hopeless = post_optimise(place, crowded, ASSETS, LORE, options, smaller, target=0.999)
    assert hopeless.failed == "walkable_missed"
    assert hopeless.ratio >= plain
