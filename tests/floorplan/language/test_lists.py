"""Lists in one breath: what a comma parts, what an "and" joins, and what "via" and "one of them" refer to."""

import pytest

from pipeline.errors import RefusedError
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


def test_an_exception_to_no_bathroom_is_no_way_out():
    with pytest.raises(RefusedError, match="bathroom"):
        parse("no bathroom but an en suite to the bedroom")
