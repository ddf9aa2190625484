"""Plan views: what stands where is seen, fronts are dark, a turned room is a turned picture."""

import numpy as np

from pipeline.relations.arrangement import RoomOpening, make_arrangement
from pipeline.rendering.plan_view import DOOR, FLOOR, PAPER, colours, plan_view

SQUARE = np.array([[0.0, 0], [5, 0], [5, 5], [0, 5]])
SOFA = ("multi_seat_sofa", [2.5, 2.5, 0.0], 0.0, (2.0, 1.0, 0.8))


def level(colour):
    return np.round(np.array(colour) * 255)


def test_a_thing_is_seen_where_it_stands_with_a_dark_front():
    picture = plan_view(make_arrangement("r", "living_room", SQUARE, [SOFA]), 110)  # 20 pixels to a metre
    assert np.allclose(picture[55, 55], level(colours()["multi_seat_sofa"]), atol=2)
    front = picture[55 + 8, 55]  # towards -y, which is down
    assert front.sum() < 0.5 * picture[55, 55].sum()
    assert np.allclose(picture[20, 20], level(FLOOR), atol=2)
    assert np.allclose(picture[1, 1], level(PAPER), atol=2)


def test_what_is_higher_hides_what_is_lower_and_unknown_things_are_left_out():
    lower = ("coffee_table", [2.5, 2.5, 0.0], 0.0, (1.0, 1.0, 0.4))
    both = plan_view(make_arrangement("r", "living_room", SQUARE, [SOFA, lower]))
    assert np.array_equal(both, plan_view(make_arrangement("r", "living_room", SQUARE, [SOFA])))
    cup = ("cup", [1, 1, 2.0], 0.0, (1.0, 1.0, 1.0))
    assert np.array_equal(
        plan_view(make_arrangement("r", "living_room", SQUARE, [cup])), plan_view(make_arrangement("r", "living_room", SQUARE, []))
    )


def test_a_turned_room_is_a_turned_picture():
    door = RoomOpening("door", np.array([[1.0, 0.0], [2.0, 0.0]]))
    room = make_arrangement("r", "living_room", SQUARE, [SOFA], [door])
    quarter = np.array([[0.0, 1], [-1, 0]])  # rows turned by 90 degrees
    things = [(SOFA[0], [*(np.array(SOFA[1][:2]) @ quarter), 0.0], np.pi / 2, SOFA[3])]
    turned = make_arrangement("r", "living_room", SQUARE @ quarter, things, [RoomOpening("door", door.segment @ quarter)])
    apart = np.abs(np.rot90(plan_view(room), 1).astype(int) - plan_view(turned))
    assert (apart > 40).any(-1).mean() < 0.03
    assert (np.abs(plan_view(room) - level(DOOR)) < 3).all(-1).any()
