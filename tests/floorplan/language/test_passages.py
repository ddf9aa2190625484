"""Ways said without their own words, and notes: what two ways of saying the same state is the same."""

import pytest

from pipeline.errors import RefusedError
from pipeline.floorplan import parse


def said(prompt):
    """Return the links of a prompt between types, and its forbidden ones."""
    program = parse(prompt)
    kinds = {r.id: r.type for r in program.rooms}
    ways = sorted((*sorted((kinds[k.a], kinds[k.b])), k.kind) for k in program.links if k.stated)
    rooms = sorted(r.type for r in program.rooms if r.stated)
    return rooms, ways, sorted((f.what, kinds.get(f.a, f.a), kinds.get(f.b or "", f.b)) for f in program.forbids if f.what != "through")


@pytest.mark.parametrize(
    ("short", "long"),
    [
        ("Kitchen, bath, bedroom; kitchen-bedroom: door; kitchen-bath: no door", "Kitchen, bath, bedroom. The bedroom has a door to the kitchen. No door between kitchen and bath."),
        ("The kitchen leads to the dining room and the dining room to the hall.", "The kitchen leads to the dining room. The dining room leads to the hall."),
        ("Bedroom with a dressing room through which you reach the bathroom.", "Bedroom with a dressing room. The bathroom is off the dressing room."),
        ("Das Schlafzimmer hat eine Ankleide, durch die man ins Bad kommt.", "Das Schlafzimmer hat eine Ankleide. Das Bad geht von der Ankleide ab."),
        ("Küche, ein Flur, von dem Bad und Büro abgehen.", "Küche, ein Flur. Vom Flur gehen Bad und Büro ab."),
        ("La despensa, a la que solo se entra por la cocina; salón", "La despensa se abre a la cocina; salón"),
        ("De la cocina se pasa al comedor y del comedor al salón.", "De la cocina se pasa al comedor. Del comedor se pasa al salón."),
        ("客厅,走廊尽头是卫生间", "客厅,走廊通向卫生间"),
        ("厨房和客厅之间要有门,卧室和厨房之间不要有门。", "厨房与客厅相通。卧室与厨房不相通。"),
    ],
)  # fmt: skip
def test_what_is_left_unsaid_is_understood(short, long):
    assert said(short) == said(long)


@pytest.mark.parametrize(
    "prompt",
    ["No walk-through bedrooms. Two bedrooms, hall, bath, kitchen.", "Zwei Schlafzimmer, keine Durchgangszimmer. Flur, Bad, Küche.", "Ningún dormitorio debe ser de paso. Dos dormitorios, pasillo, baño, cocina."],
)  # fmt: skip
def test_no_way_leads_through_a_bedroom(prompt):
    program = parse(prompt)
    beds = {r.id for r in program.rooms if r.type == "bedroom"}
    assert len(beds) == 2
    assert {f.avoid for f in program.forbids if f.what == "through"} == beds


@pytest.mark.parametrize(
    ("prompt", "bedrooms"),
    [("three double bedrooms and one single, bath", 4), ("tres habitaciones dobles y dos individuales, baño", 5), ("3 ZKB, Balkon", 2), ("4 ZKBB", 3)],
)  # fmt: skip
def test_rooms_without_their_noun_are_counted(prompt, bedrooms):
    assert sum(r.type == "bedroom" and r.stated for r in parse(prompt).rooms) == bedrooms


def test_a_window_that_is_ruled_out_and_asked_for_is_refused():
    with pytest.raises(RefusedError):
        parse("No windows in the bedroom, bedroom must have a window. Kitchen.")


def test_headings_are_storeys():
    levels = {r.type: r.level for r in parse("Ground: kitchen, WC. Upper: bedroom, bathroom.").rooms}
    assert (levels["kitchen"], levels["bedroom"], levels["bathroom"]) == (0, 1, 1)


@pytest.mark.parametrize(("wrong", "right"), [("客听", "客厅"), ("橱房", "厨房"), ("卫生见", "卫生间"), ("书防", "书房")])
def test_names_of_rooms_that_sound_alike_are_repaired(wrong, right):
    assert said(f"一间卧室,一个{wrong}") == said(f"一间卧室,一个{right}")


@pytest.mark.parametrize(
    "prompt", ["No room larger than 18 m2; two bedrooms, bath, kitchen.", "Kein Zimmer größer als 18 m². Küche, Bad, zwei Schlafzimmer."]
)
def test_a_limit_of_every_room_is_not_that_of_the_home(prompt):
    program = parse(prompt)
    assert not program.total_area.stated
    assert {r.area.max for r in program.rooms if r.stated} == {18.0}


@pytest.mark.parametrize(
    "prompt",
    ["Bitte kein Bad ohne Fenster. Bad, Küche.", "No bathroom without a window. Bath, kitchen.", "Ningún baño sin ventana. Baño, cocina."],
)
def test_no_room_without_a_window_is_one_with(prompt):
    assert [r.window for r in parse(prompt).rooms if r.type == "bathroom"] == ["required"]


def test_en_suites_in_brackets_are_among_those_counted():
    program = parse("5 beds, 3 baths (2 en suite), kitchen")
    assert sum(r.type == "bathroom" and r.stated for r in program.rooms) == 3
    assert sum(r.kind == "ensuite" for r in program.relations) == 2


@pytest.mark.parametrize(
    "prompt",
    [
        "You enter a vestibule, then a hall. Kitchen, bath.",
        "Se entra a un vestíbulo y de ahí a un pasillo. Cocina, baño.",
        "Vom Eingang kommt man in einen Windfang und von dort in den Flur. Küche, Bad.",
    ],
)
def test_one_enters_and_goes_on(prompt):
    program = parse(prompt)
    assert program.select(program.entrance.into)[0].type == "entry"
    assert ("entry", "hallway", "door") in said(prompt)[1]
