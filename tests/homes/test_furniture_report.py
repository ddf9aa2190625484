"""What is asked for is what ships, or nothing does; and it is said beside what was asked."""

import json
from dataclasses import replace

import pytest

from pipeline.errors import RefusedError
from pipeline.floorplan import plan_json
from pipeline.floorplan.imports import program_of, read_own_json
from pipeline.floorplan.program.floor_program import FloorProgram
from pipeline.floorplan.wishes import with_wishes
from pipeline.homes.furniture_report import deliveries, report
from pipeline.homes.life import Empty
from pipeline.homes.planning import told_count
from pipeline.homes.request import Request
from pipeline.seeds import generator

FLAT = "a one-bedroom flat of 60 m2; "


def made(factory, wish, **more):
    (home,) = factory.make([Request(0, FLAT + wish, **more)], files=False)
    program = FloorProgram.model_validate_json(home.home.program)
    return home, deliveries(program, home.rows, dict.fromkeys(factory.library, "Modern"))


def test_asked_beside_delivered(factory):
    home, found = made(
        factory, "the bedroom has exactly one nightstand, no TV, a wardrobe, at least one thing that opens, 10 % free, nordic"
    )
    lines = {d.what: d for d in found}
    bed = [o["category"] for o in home.rows["objects"] if o["room_id"] == "bed"]
    assert (bed.count("nightstand"), bed.count("tv_stand")) == (1, 0)
    assert "wardrobe" in bed
    assert {d.room for d in found if d.asked != "unasked"} == {"bed"}
    assert (lines["nightstand"].asked, lines["nightstand"].delivered, lines["nightstand"].met) == ("1", "1", True)
    assert (lines["tv stand"].asked, lines["tv stand"].met) == ("none", True)
    assert (lines["wardrobe"].asked, lines["that open"].met, lines["free floor"].met) == ("at least 1", True, True)
    assert lines["style"].delivered.startswith("0 of")
    text = report(found)
    assert all(word in text for word in ("asked", "delivered", "nightstand", "10%"))
    assert report([]) == ""


@pytest.mark.parametrize(
    ("wish", "code"),
    [
        ("the bedroom has three nightstands", "category_missed"),
        ("the bedroom has no nightstands", "category_missed"),
        ("the bedroom has three things that open", "openable_missed"),
        ("the bedroom has 99 % free floor", "walkable_missed"),
    ],
)
def test_a_home_that_lacks_what_was_asked_does_not_ship(factory, wish, code):
    """The rules of this factory place one bed, one nightstand and one wardrobe, whatever is demanded of them."""
    tight = replace(factory, shard=replace(factory.shard, room_attempts=2, home_attempts=2))
    (empty,) = tight.make([Request(0, FLAT + wish)], files=False)
    assert isinstance(empty, Empty)
    assert (empty.reason, type(empty.error)) == ("attempts_spent", RefusedError)
    assert code in str(empty.error)


def test_what_the_library_lacks_is_refused_at_once(factory):
    (empty,) = factory.make([Request(0, FLAT + "the bedroom has a plant")], files=False)
    assert isinstance(empty, Empty)
    assert empty.reason == "refused"
    assert "the library has no plant" in str(empty.error)


def test_the_sampler_is_told_a_number_within_the_bounds():
    def told(**wish):
        furniture = FloorProgram.model_validate({"furniture": wish}).furniture
        return {told_count(furniture, generator(0, "told", k)) for k in range(40)}

    assert told() == {None}
    assert told(least=6, most=6) == {6}
    assert told(least=6, most=8) == {6, 7, 8}
    assert min(told(least=6)) == 6
    assert told(most=1) <= {0, 1}
    assert min(told(most=9, counts=[{"category": "nightstand", "min": 7}])) == 7


def test_a_plan_of_ones_own_is_furnished(factory):
    def box(x0, y0, x1, y1):
        return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]

    own = read_own_json({"rooms": [{"type": "living_room", "polygon": box(0, 0, 6, 4)}, {"type": "bedroom", "polygon": box(0, 4, 6, 8)}]})
    program = with_wishes(program_of(own.plan), "the bedroom with a nightstand and a wardrobe")
    request = Request(0, "", program.model_dump_json(exclude_defaults=True), json.dumps(plan_json(own.plan)))
    (home,) = factory.make([request], files=False)
    assert [r["polygon"] for r in home.rows["rooms"]] == [r.polygon.tolist() for r in own.plan.rooms]
    assert {"nightstand", "wardrobe"} <= {o["category"] for o in home.rows["objects"] if o["room_id"] == "bedroom"}


def test_what_the_plan_itself_closes_to_the_robot_is_furnished(factory):
    """A bath behind a door of 42 cm is no fault of what stands in it."""

    def box(x0, y0, x1, y1):
        return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]

    rooms = [
        {"id": "hall", "type": "hallway", "polygon": box(0, 0, 3, 3)},
        {"id": "bath", "type": "bathroom", "polygon": box(3.1, 0, 5.5, 3)},
    ]
    own = read_own_json({"rooms": rooms, "doors": [{"rooms": ["hall", "bath"], "width": 0.42}], "entrance": "hall"})
    request = Request(0, "", program_of(own.plan).model_dump_json(exclude_defaults=True), json.dumps(plan_json(own.plan)))
    (home,) = factory.make([request], files=False)
    assert {r["room_id"]: r["walkable_free"] > 0.05 for r in home.rows["rooms"]} == {"hall": True, "bath": False}
    assert "toilet" in {o["category"] for o in home.rows["objects"] if o["room_id"] == "bath"}
