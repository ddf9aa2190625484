"""Hard wishes: rooms some openings apart, and rooms at a corner of the outline."""

import networkx as nx
import numpy as np
import pytest
import shapely

from pipeline.errors import RefusedError
from pipeline.floorplan import complete, solve
from pipeline.floorplan.program.floor_program import FloorProgram, Footprint, Link, Relation, RoomReq
from pipeline.floorplan.program.links import distances, nearness


def room(name, kind, **more):
    return RoomReq(id=name, type=kind, **more)


ROOMS = (
    room("living", "living_room"),
    room("kitchen", "kitchen"),
    room("bed", "bedroom"),
    room("study", "office"),
    room("bath", "bathroom"),
)


def apart(a, b, value, **more):
    return FloorProgram(rooms=ROOMS, relations=(Relation(kind="hops", a=a, b=b, value=value),), **more)


def openings_between(plan, a, b):
    graph = nx.Graph([o.rooms for o in plan.openings if len(o.rooms) == 2])
    return nx.shortest_path_length(graph, a, b)


@pytest.mark.parametrize(("a", "b", "value"), [("living", "bed", 2), ("bed", "living", 3), ("study", "bed", 3), ("kitchen", "bathroom", 3)])
def test_rooms_lie_as_many_openings_apart_as_asked(a, b, value):
    plan = solve(apart(a, b, value), 1)
    ids = {r.type: r.room_id for r in plan.rooms} | {r.room_id: r.room_id for r in plan.rooms}
    assert openings_between(plan, ids[a], ids[b]) >= value


def test_a_distance_that_holds_anyway_changes_nothing():
    plain = complete(FloorProgram(rooms=ROOMS))
    assert complete(apart("living", "bath", 1)).links == plain.links


def test_completing_twice_changes_nothing():
    once = complete(apart("bed", "living", 3))
    assert complete(once) == once
    assert nearness(distances(once), once.links) == []


@pytest.mark.parametrize(
    "more",
    [
        {"links": (Link(a="bed", b="living", stated=True),)},
        {"only": True, "links": (Link(a="bed", b="kitchen", stated=True), Link(a="kitchen", b="living", stated=True))},
    ],
)
def test_a_distance_against_the_stated_links_is_refused_by_name(more):
    with pytest.raises(RefusedError, match="hops: bed and living are to be at least 3 openings apart"):
        solve(apart("bed", "living", 3, **more), 0)


def test_more_openings_apart_than_the_home_has_rooms_is_refused():
    with pytest.raises(RefusedError, match="hops"):
        solve(apart("bed", "living", 50), 0)


def corners_of(plan, name):
    """Count the corners of a storey's outline that stick out and at which the room lies."""
    level = plan.room(name).level
    shapes = [shapely.Polygon(r.polygon) for r in plan.rooms if r.level == level]
    whole = shapely.union_all([s.buffer(plan.inner_wall, join_style="mitre") for s in shapes]).buffer(-plan.inner_wall, join_style="mitre")
    found = 0
    for point in plan.room(name).polygon:
        square = shapely.box(*(point - 0.3), *(point + 0.3))
        found += square.intersection(whole).area < 0.3 * square.area  # a quarter of it lies inside
    return found


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("shape", ["rectangle", "L"])
def test_corner_rooms_have_a_corner_of_the_outline(seed, shape):
    rooms = (
        room("living", "living_room"), room("kitchen", "kitchen"), room("bed", "bedroom", exterior="corner"),
        room("study", "office", exterior="corner"), room("guest", "bedroom"), room("bath", "bathroom", exterior="corner"),
    )  # fmt: skip
    plan = solve(FloorProgram(rooms=rooms, footprint=Footprint(shape=shape)), seed)
    assert all(corners_of(plan, name) >= 1 for name in ("bed", "study", "bath"))


def test_more_corner_rooms_than_corners_are_refused_by_name():
    rooms = (*(room(f"bed_{k}", "bedroom", exterior="corner") for k in range(5)), room("living", "living_room"), room("bath", "bathroom"))
    with pytest.raises(RefusedError, match="exterior: corner"):
        solve(FloorProgram(rooms=rooms), 0)
    assert np.isfinite(solve(FloorProgram(rooms=rooms[:2] + rooms[5:]), 0).rooms[0].area)
