"""Things on and in furniture: held by what they name, carried by drawers, in the way of what does not carry them."""

from dataclasses import replace

import numpy as np

from pipeline.homes.violations import violations
from pipeline.verify import verify_home
from tests.geometry.furniture import LIBRARY, home, placed
from tests.judging import SETTINGS

CHEST = placed("tray_chest", 2.0, 2.74)
FLOOR = 0.14  # of its drawer


def thing(name, dx, dy, z, support="tray_chest_0"):
    return replace(placed(name, 2.0 + dx, 2.74 + dy, 0.0, z, number=9), support=support)


def judge(*placements):
    return verify_home(home(placements), LIBRARY, SETTINGS)


def test_a_thing_is_held_by_what_it_names():
    def held(*placements):
        return judge(*placements).objects[-1].supported

    assert held(CHEST, thing("cup", 0, 0, 0.5))
    assert not held(CHEST, thing("cup", 0, 0, 0.55))
    assert not held(CHEST, thing("cup", 0.26, 0, 0.5))  # its middle is beyond the edge
    assert not held(CHEST, placed("nightstand", 1.0, 1.0), thing("cup", 0, 0, 0.5, "nightstand_0"))
    assert not held(CHEST, thing("cup", 0, 0, 0.5, "nobody"))


def test_what_lies_in_a_drawer_comes_out_with_it():
    book = thing("book", 0, 0, FLOOR)
    found = judge(CHEST, book)
    assert found.faults(SETTINGS.policy) == ()
    assert [j.clear for j in found.joints if j.object_id == "tray_chest_0"] == [True]


def test_what_stands_too_high_in_a_drawer_is_caught_by_the_frame():
    """The drawer is open above, the carcass has a board there: 0.3 m is free, a cup on the book beneath is not."""
    tall = replace(thing("cup", 0, 0, FLOOR), size=np.array([0.09, 0.09, 0.345]), scale=np.array([1, 1, 3.45]))
    found = judge(CHEST, tall)
    joint = next(j for j in found.joints if j.object_id == "tray_chest_0")
    assert not joint.clear or found.collisions
    assert set(violations(home((CHEST, tall)), found)) == {"cup_9"}


def test_a_drawer_with_a_thing_in_it_still_hits_what_stands_before_it():
    book = thing("book", 0, 0, FLOOR)
    found = judge(CHEST, book, placed("block", 2.0, 2.74 - 0.2 - 0.15 - 0.25))
    joint = next(j for j in found.joints if j.object_id == "tray_chest_0")
    assert (joint.clear, joint.blocker) == (False, "block_0")


def test_what_lies_under_a_drawer_stays_and_what_it_strikes_goes():
    below = thing("book", 0, 0, 0.12)
    found = judge(CHEST, below)  # 3 cm high: the drawer's floor is 1 cm above the board
    assert "book_9" in violations(home((CHEST, below)), found)


def test_a_small_thing_goes_before_furniture_does():
    lamp = placed("lamp", 2.0, 2.74, 0.0, 0.5)
    cup = replace(thing("cup", 0, 0, 0.5), scale=np.array([8.0, 8.0, 8.0]), size=8 * LIBRARY["cup"].size)
    assert set(violations(home((CHEST, lamp, cup)), judge(CHEST, lamp, cup))) >= {"cup_9"}
    assert "lamp_0" not in violations(home((CHEST, lamp, cup)), judge(CHEST, lamp, cup))


def test_a_lid_that_does_not_open_costs_the_thing_and_not_what_is_above():
    above = placed("block", 2.0, 2.74, 0.0, 0.6)
    found = judge(CHEST, thing("flip", 0, 0, 0.5), above)
    violating = violations(home((CHEST, thing("flip", 0, 0, 0.5), above)), found)
    assert violating["flip_9"].reason == "blocks_joint"
    assert found.openable == 1  # the chest; a laptop is no furniture
