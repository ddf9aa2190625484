"""Words about the furniture of a plan that is given."""

import pytest

from pipeline.errors import RefusedError
from pipeline.floorplan.imports import program_of, read_own_json
from pipeline.floorplan.program.floor_program import Furniture, Things
from pipeline.floorplan.wishes import with_wishes


def box(x0, y0, x1, y1):
    return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]


@pytest.fixture(scope="module")
def program():
    kinds = [("living_room", box(0, 0, 5, 4)), ("kitchen", box(5, 0, 9, 4)), ("bedroom", box(0, 4, 5, 8)), ("bathroom", box(5, 4, 9, 8))]
    return program_of(read_own_json({"rooms": [{"type": kind, "polygon": p} for kind, p in kinds]}).plan)


def wishes(program):
    return {r.id: r.furniture for r in program.rooms if r.furniture != Furniture()}


def test_rooms_of_the_plan_are_found_by_their_names(program):
    made = with_wishes(program, "a bedroom with six pieces, two nightstands, 50 % free, nordic")
    assert wishes(made) == {
        "bedroom": Furniture(least=6, most=6, counts=(Things(category="nightstand", min=2, max=2),), style="Nordic", walkable=0.5)
    }
    assert [r.area for r in made.rooms] == [r.area for r in program.rooms]
    assert {e.text for e in made.evidence} == {"six pieces", "two nightstands", "50 % free", "nordic"}


def test_wishes_without_a_room_go_where_such_things_stand(program):
    made = with_wishes(program, "two nightstands, a fridge, everything nordic")
    assert {k: v.style for k, v in wishes(made).items()} == dict.fromkeys(["living_room", "kitchen", "bedroom", "bathroom"], "Nordic")
    assert wishes(made)["bedroom"].counts[0].category == "nightstand"
    assert wishes(made)["kitchen"].counts[0].category == "refrigerator"


@pytest.mark.parametrize(
    ("prompt", "word"),
    [
        ("an office with two desks", "the plan has no office"),
        ("three bedrooms and a balcony", "wish for furniture"),
        ("a bathroom with a dining table", "cannot stand"),
        ("a bedroom with 90 pieces", "do not fit"),
    ],
)
def test_what_the_plan_cannot_hold_is_refused(program, prompt, word):
    with pytest.raises(RefusedError, match=word):
        with_wishes(program, prompt)
