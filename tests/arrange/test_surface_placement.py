"""Small things are laid where they can be: the judge, who shares nothing with the arranger but geometry, agrees."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.arrange import SurfacePlacement, ThingsSettings
from pipeline.arrange.surfaces import surfaces
from pipeline.entities.home import Placement
from pipeline.verify import verify_home
from tests.geometry.furniture import LIBRARY, SQUARE, asset, block, box, chest, cupboard, home, link, placed
from tests.judging import SETTINGS

EVERYWHERE = ThingsSettings(hidden=1.0, tries=12)
THINGS = ("cup", "book", "flip", "book", "cup")


def tops(made):
    found = surfaces(made)
    return sorted((round(float(z), 3), int(i), bool(h)) for z, i, h in zip(found.tops[:, 4], found.link, found.hidden, strict=True))


def test_where_things_can_stand():
    assert tops(LIBRARY["table"]) == [(0.75, 0, False)]
    assert tops(LIBRARY["shelves"]) == [(0.07, 0, False), (0.42, 0, False), (0.77, 0, False), (1.2, 0, False)]
    assert tops(LIBRARY["tray_chest"]) == [(0.12, 0, True), (0.14, 1, True), (0.5, 0, False)]  # below the drawer, in it, on top
    assert tops(chest()) == [(0.9, 0, False)]
    assert tops(cupboard()) == []  # 1.8 m high: nobody looks up there


def test_a_hull_over_what_is_open_is_no_surface():
    """Four posts as one convex piece: nothing is to be seen between them."""
    posts = [box((x, y, 0), (x + 0.05, y + 0.05, 0.5)) for x in (-0.5, 0.45) for y in (-0.5, 0.45)]
    whole = box((-0.5, -0.5, 0), (0.5, 0.5, 0.5))
    framed = asset("posts", "bed", (1, 1, 0.5), [replace(link("base", whole), visuals=tuple(posts))])
    assert tops(framed) == []
    assert tops(asset("slab", "bed", (1, 1, 0.5), [link("base", whole)])) == [(0.5, 0, False)]


def laid(furniture, seed, settings=EVERYWHERE, names=THINGS):
    rng = np.random.default_rng(seed)
    room = SurfacePlacement(SQUARE, furniture, LIBRARY, settings, 0.002)
    found = []
    for index, support in enumerate(furniture):
        for number, name in enumerate(names):
            place = room.lay(rng, LIBRARY[name], index, facing=name == "flip")
            if place:
                thing = LIBRARY[name]
                found.append(
                    Placement(f"thing_{index}_{number}", "room", thing.category, name, *place, thing.size, support=support.object_id)
                )
    return found


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6))
def test_the_judge_finds_no_fault(seed):
    """On, in and behind: nothing floats or touches, every drawer, door and lid still moves, and figures of the floor stay."""
    furniture = [
        placed("table", 2.9, 1.9, 0.4),
        placed("shelves", 1.6, 2.82),
        placed("tray_chest", 0.6, 2.6),
        placed("cupboard", 3.65, 0.3, np.pi),
    ]
    things = laid(furniture, seed)
    before, after = verify_home(home(furniture), LIBRARY, SETTINGS), verify_home(home([*furniture, *things]), LIBRARY, SETTINGS)
    assert after.faults(SETTINGS.policy) == ()
    assert len(things) >= 6
    assert (after.reach, after.openable) == (before.reach, before.openable)
    assert [(r.walkable_paper, r.walkable_free) for r in after.rooms] == [(r.walkable_paper, r.walkable_free) for r in before.rooms]
    assert {p.object_id for p in things if p.category == "laptop"} <= {j.object_id for j in after.joints}


def test_nothing_lies_on_what_hangs_too_high_to_look_at():
    hung = placed("tray_chest", 2.0, 2.6)
    hung = replace(hung, position=np.array([*hung.position[:2], 1.4]))
    places = [p for seed in range(20) for p in laid([hung], seed)]
    assert places
    assert all(p.position[2] < 1.6 for p in places)  # in the drawer and below it; its top is at 1.9 m


def test_drawers_are_used_as_often_as_they_are_told_to():
    furniture = [placed("tray_chest", 2.0, 2.6)]

    def inside(hidden):
        made = [laid(furniture, seed, ThingsSettings(hidden=hidden), ("book",)) for seed in range(40)]
        return sum(p.position[2] < 0.4 for things in made for p in things)

    assert inside(0.0) == 0
    assert inside(0.2) < inside(5.0)


@pytest.mark.parametrize(("tall", "fits"), [(0.32, True), (0.335, False)])
def test_what_rides_in_a_drawer_has_room_above_it(tall, fits):
    """The drawer's floor is .34 m under the carcass' top."""
    assert in_drawer(block("box", "storage_box", (0.25, 0.25, tall))) == fits


@pytest.mark.parametrize(("wide", "fits"), [(0.08, True), (0.06, False)])
def test_what_rides_in_a_drawer_slides_before_it_tips(wide, fits):
    """A bottle that falls over as the drawer is pulled stays behind and holds it open."""
    bottle = block("bottle", "bottle", (wide, wide, 0.1))
    assert in_drawer(replace(bottle, links=(replace(bottle.links[0], com=np.array([0.0, 0.0, 0.05])),))) == fits


def in_drawer(thing):
    """Whether a thing is ever laid in the drawer of a chest."""
    rng = np.random.default_rng(0)
    furniture = [placed("tray_chest", 2.0, 2.6)]
    room = SurfacePlacement(SQUARE, furniture, {**LIBRARY, thing.asset_id: thing}, ThingsSettings(hidden=50.0, tries=12), 0.0005)
    places = [room.lay(rng, thing, 0, facing=False) for _ in range(12)]
    return any(place is not None and abs(place[0][2] - 0.14) < 0.01 for place in places)


def test_nothing_is_laid_where_a_lid_would_meet_the_wall_or_another_joint_sweeps():
    low = [placed("nightstand", 2.0, 2.79)]  # its back is 1 cm from the wall; an open lid leans back by more than the rest of its depth
    for thing in laid(low, 3, names=("flip",) * 30):
        assert thing.position[1] < 2.79
    assert laid([placed("bed", 2.0, 1.2), placed("cupboard", 0.5, 0.4)], 1, names=()) == []


@pytest.mark.parametrize("seed", range(3))
def test_the_same_draws_give_the_same_things(seed):
    furniture = [placed("table", 2.0, 1.5), placed("shelves", 1.0, 2.8)]
    first, second = laid(furniture, seed), laid(furniture, seed)
    assert [(p.asset_id, p.position.tolist(), p.yaw) for p in first] == [(p.asset_id, p.position.tolist(), p.yaw) for p in second]
