from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.arrange import PostoptSettings, WalkableSettings, control_walkable, free_ratio, post_optimise
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


def crowding(placements):
    """A ratio that says how small furniture is."""
    return 1 - sum(float(p.size[0] * p.size[1]) for p in placements) / AREA


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**5), st.floats(0.3, 1.0), st.integers(1, 5))
def test_the_ratio_never_falls_and_placements_stay(seed, target, top):
    before = objects(seed)
    found, exchanges = control_walkable(before, target, crowding, smaller, ASSETS, WalkableSettings(top=top))
    assert (crowding(found) > crowding(before)) == (exchanges > 0) == (crowding(before) < target)
    for old, new in zip(before, found, strict=True):
        assert np.array_equal(old.position, new.position)
        assert (old.yaw, old.object_id, old.category) == (new.yaw, new.object_id, new.category)
        assert new.size[0] * new.size[1] <= old.size[0] * old.size[1] + 1e-9


def test_it_stops_at_once_when_the_target_is_met():
    before = objects()
    found, exchanges = control_walkable(before, 0.1, crowding, smaller, ASSETS, WalkableSettings())
    assert exchanges == 0
    assert all(new is old for old, new in zip(before, found, strict=True))


def test_each_iteration_takes_the_k_largest_that_have_something_smaller():
    crowd = [placed("bed", 2, 2, number=9), *objects()]
    found, exchanges = control_walkable(crowd, 1.0, crowding, smaller, ASSETS, WalkableSettings(top=2, iterations=1))
    changed = [old for old, new in zip(crowd, found, strict=True) if new is not old]
    areas = sorted((float(p.size[0] * p.size[1]) for p in objects()), reverse=True)
    assert exchanges == 2
    assert sorted((float(p.size[0] * p.size[1]) for p in changed), reverse=True) == pytest.approx(areas[:2])


def test_iterations_are_bounded_and_exhaustion_ends():
    assert control_walkable(objects(), 1.0, crowding, smaller, ASSETS, WalkableSettings(iterations=3))[1] == 9
    found, _ = control_walkable(objects(), 1.0, crowding, smaller, ASSETS, WalkableSettings(iterations=99))
    assert {p.asset_id for p in found} == {"size_7"}


def test_lamps_take_no_floor():
    lamp = placed("lamp", 2, 2, z=2.4)
    assert control_walkable([lamp], 2.0, crowding, lambda *_: pytest.fail("a lamp was exchanged"), ASSETS, WalkableSettings())[1] == 0


def test_the_true_ratio_is_the_judges():
    place = site(one_room(), radius=0.25)
    placements = (placed("bed", 3.0, 1.9), placed("chest", 0.6, 2.74, number=1), placed("lamp", 1, 1, z=2.4, number=2))
    judged = verify_home(home(placements), LIBRARY, SETTINGS).rooms[0].walkable_free
    assert free_ratio(place, LIBRARY)(placements) == pytest.approx(judged, abs=0.01)


def test_control_and_separation_together_reach_what_can_be_reached():
    place, options = site(one_room()), PostoptSettings()
    crowded = objects(2, 4)
    _, plain = post_optimise(place, crowded, ASSETS, LORE, options, smaller, target=0.01)
    found, ratio = post_optimise(place, crowded, ASSETS, LORE, options, smaller, target=plain + 0.05)
    assert ratio >= plain + 0.05
    assert {p.asset_id for p in found.placements} != {p.asset_id for p in crowded}
    assert verify_home(home(found.placements), ASSETS, SETTINGS).collisions == 0
    _, hopeless = post_optimise(place, crowded, ASSETS, LORE, options, smaller, target=0.999)
    assert plain <= hopeless < 0.999
