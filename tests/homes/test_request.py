"""Where one dines: where somebody said so, else in the room that has the floor for it; what a room of several uses, and one that is somebody's, is furnished as."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline import taxonomy
from pipeline.entities.plan import Plan, Room
from pipeline.homes.planning import plan_home
from pipeline.homes.request import Request, layout_type


def room(name, kind, area, functions=()):
    return Room(name, kind, np.array([[0, 0], [area / 4, 0], [area / 4, 4], [0, 4.0]]), functions=functions)


@pytest.mark.parametrize(
    ("rooms", "expected"),
    [
        ([room("a", "living_room", 20)], ["living_dining_room"]),
        ([room("a", "living_room", 17)], ["living_room"]),
        ([room("a", "living_room", 18), room("b", "kitchen", 9)], ["living_dining_room", "kitchen"]),
        ([room("a", "living_room", 16), room("b", "kitchen", 14)], ["living_room", "kitchen+dining_room"]),
        ([room("a", "living_room", 16), room("b", "kitchen", 12)], ["living_room", "kitchen"]),
        ([room("a", "living_room", 26), room("b", "kitchen", 18)], ["living_dining_room", "kitchen+dining_room"]),
        ([room("a", "living_room", 17, ("dining",))], ["living_dining_room"]),
        ([room("a", "living_room", 30), room("b", "dining_room", 10)], ["living_room", "dining_room"]),
        ([room("a", "living_room", 30), room("b", "kitchen", 17, ("cooking", "dining"))], ["living_room", "kitchen+dining_room"]),
        ([room("a", "living_room", 20), room("b", "family_room", 24)], ["living_room", "living_dining_room"]),
        ([room("a", "living_room", 30, ("dining",)), room("b", "dining_room", 10)], ["living_dining_room", "dining_room"]),
        ([room("a", "living_room", 20), room("b", "kitchen", 11)], ["living_dining_room", "kitchen"]),
        ([room("a", "living_room", 26), room("b", "kitchen", 11)], ["living_dining_room", "kitchen"]),
        ([room("a", "living_room", 30, ("dining", "cooking"))], ["living_dining_room+kitchen"]),
        ([room("a", "studio_room", 20), room("b", "kitchen", 5)], ["living_room+bedroom", "kitchen"]),
        ([room("a", "studio_room", 30, ("cooking",))], ["living_room+bedroom+kitchen+dining_room"]),
        ([room("a", "garage", 20), room("b", "sunroom", 20)], [None, "living_room"]),
    ],
)
def test_where_one_dines(rooms, expected):
    plan = Plan(tuple(rooms), (), "a")
    assert [layout_type(r, plan, taxonomy.load()) for r in rooms] == expected


@pytest.mark.parametrize(("role", "kind"), [("child", "kids_room"), ("primary", "bedroom"), ("guest", "bedroom"), ("", "bedroom")])
def test_a_bedroom_is_furnished_for_whom_it_is(role, kind):
    own = replace(room("a", "bedroom", 12), role=role)
    assert layout_type(own, Plan((own,), (), "a"), taxonomy.load()) == kind


def test_homes_that_nobody_described_have_rooms_for_children(factory):
    kinds = {}
    for index in (10, 17, 35):
        home = plan_home(factory, Request(index), 0)
        kinds |= {(index, job.room_id): (job.room.role, job.layout_type) for job in home.jobs if job.room.type == "bedroom"}
        assert home.program == plan_home(factory, Request(index), 0).program
    assert {kind for role, kind in kinds.values() if role == "child"} == {"kids_room"}
    assert {kind for role, kind in kinds.values() if role != "child"} == {"bedroom"}
