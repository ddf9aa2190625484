"""Lists in one breath: what a comma parts, what an "and" joins, and what "via" and "one of them" refer to."""

import pytest

from pipeline.floorplan.language import parse
from pipeline.floorplan.language.parser import understand


def links(program):
    return {(link.kind, *sorted((link.a, link.b))) for link in program.links}


def test_commas_part_statements():
    program = understand("4BR/3BA, office downstairs, all bedrooms upstairs, garage connected to the kitchen via a utility room")
    assert links(program) == {("door", "garage", "utility"), ("door", "kitchen", "utility")}
    rooms = {r.id: r.level for r in program.rooms}
    assert rooms["office"] == 0
    assert {level for name, level in rooms.items() if name.startswith("bed")} == {1}


def test_a_comparison_is_about_the_phrase_in_front_of_it():
    program = understand(
        "two bedrooms, wet room, wide corridor, everything on one level, living room at least 1.5 times the larger bedroom"
    )
    assert {(r.a, r.value) for r in program.relations if r.kind == "area_order"} == {("living", 1.5)}


@pytest.mark.parametrize(
    "prompt",
    [
        "a flat with two bedrooms and two bathrooms, one ensuite",
        "two bedrooms, two bathrooms (one en suite)",
        "piso con dos dormitorios y dos baños, uno en suite",
    ],
)
def test_one_of_several_is_not_one_more(prompt):
    program = understand(prompt)
    assert len(program.select("bathroom")) == 2
    assert [r.kind for r in program.relations].count("ensuite") == 1


@pytest.mark.parametrize(
    "prompt", ["piso con cocina abierta al salón y terraza", "a flat with a kitchen open to the living room and terrace"]
)
def test_a_list_goes_on_after_what_something_is_open_to(prompt):
    assert links(understand(prompt)) == {("open", "kitchen", "living")}


def test_all_of_a_list_is_the_list():
    program = understand("kitchen, living room, 2 bedrooms, bathroom - all off a central hallway")
    assert links(program) == {
        ("door", other, "hall") if other < "hall" else ("door", "hall", other) for other in ("bath", "bed", "bed_2", "kitchen", "living")
    }


def test_half_baths_are_counted_as_agents_do():
    for prompt in ("a house with two and a half baths", "a house with 2.5 baths"):
        program = understand(prompt)
        assert (len(program.select("bathroom")), len(program.select("wc"))) == (2, 1)


def test_the_largest_room_is_larger_than_all_others():
    program = understand("two bedrooms and a kitchen. The living room should be the largest room")
    assert {(r.a, r.b) for r in program.relations if r.kind == "area_order"} == {("living", b) for b in ("bed", "bed_2", "kitchen")}


@pytest.mark.parametrize("prompt", ["一室一厅,厨房要和客厅分开", "a one-bedroom flat with the kitchen separate from the living room"])
def test_a_kitchen_apart_from_where_one_lives_has_a_door(prompt):
    program = parse(prompt)
    assert not any(link.kind == "open" and "kitchen" in (link.a, link.b) for link in program.links)


def test_the_main_one_of_some_bedrooms():
    program = understand("casa con cuatro habitaciones, la principal con vestidor y baño propio")
    assert [len(program.select(kind)) for kind in ("bedroom", "closet", "bathroom")] == [4, 1, 1]


def test_a_narrow_home_stands_on_a_narrow_plot_and_a_narrow_room_does_not():
    assert understand("a narrow three-bedroom townhouse on two floors").footprint.min_aspect >= 1.4
    assert not understand("a flat with a narrow kitchen and a bedroom").footprint.stated
