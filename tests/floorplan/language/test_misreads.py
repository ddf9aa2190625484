"""Everyday sentences that were once read wrong."""

import pytest

from pipeline.floorplan import parse


def linked(prompt):
    program = parse(prompt)
    kinds = {room.id: room.type for room in program.rooms}
    return {(*sorted((kinds[k.a], kinds[k.b])), k.kind) for k in program.links if k.stated}


def test_a_second_bedroom_has_an_area_of_its_own():
    areas = [r.area.target for r in parse("T3 avec une grande chambre de 15 m2 et une petite de 10 m2").rooms if r.type == "bedroom"]
    assert areas == pytest.approx([15.0, 10.0])


def test_an_open_plan_kitchen_is_open_whatever_comes_after_it():
    links = linked("I need a 2 bed flat with an open plan kitchen and a balcony off the living room.")
    assert ("balcony", "living_room", "door") in links
    assert ("kitchen", "living_room", "door") not in links


def test_what_a_counted_home_has_is_not_its_kitchens():
    assert ("closet", "kitchen", "door") not in linked("3LDK with a walk-in closet next to the master bedroom.")


def test_no_walls_between_rooms_leaves_them_open():
    links = linked("Loft with no walls between kitchen, dining and living.")
    assert {("dining_room", "living_room", "open"), ("dining_room", "kitchen", "open")} <= links


def test_the_middle_of_a_home_is_told_to_be_unbuilt():
    said = "Piso de 80 m2 con dos dormitorios y el salón en el centro."
    assert any(said[s.start : s.end] == "en el centro" for s in parse(said).unbuilt)


def storeys(prompt):
    return sorted((room.type, room.level) for room in parse(prompt).rooms if room.stated)


@pytest.mark.parametrize(
    "prompt",
    [
        "apartamento de dos dormitorios con terraza",
        "piso de dos habitaciones con un balcón",
        "appartement de deux chambres avec balcon",
        "an apartment of two bedrooms with a balcony",
    ],
)
def test_what_a_home_of_so_many_bedrooms_has_is_not_each_bedrooms(prompt):
    assert [r.type for r in parse(prompt).rooms].count("balcony") == 1


def test_what_each_bedroom_has_is_each_bedrooms():
    assert [r.type for r in parse("apartamento de dos dormitorios, cada uno con balcón").rooms].count("balcony") == 2


def test_a_storey_in_front_of_one_room_is_that_rooms():
    upstairs = [("bedroom", 1), ("bedroom", 1)]
    assert storeys("a house with a downstairs toilet and two bedrooms upstairs") == [*upstairs, ("wc", 0)]
    assert storeys("house with a downstairs loo and two bedrooms upstairs") == [*upstairs, ("wc", 0)]
    assert storeys("a downstairs bedroom and two bedrooms upstairs") == [("bedroom", 0), *upstairs]
    assert {("bathroom", 1), ("wc", 0)} <= set(storeys("a house with three bedrooms, a downstairs toilet and an upstairs bathroom"))


@pytest.mark.parametrize("prompt", ["a 4 bedroom house with a big kitchen", "Haus mit fünf Schlafzimmern und einer großen Küche"])
def test_a_home_of_many_bedrooms_has_a_living_room(prompt):
    assert [r.type for r in parse(prompt).rooms].count("living_room") == 1


@pytest.mark.parametrize(
    "prompt",
    [
        "three bedroom flat where the master has its own bathroom and a walk in closet",
        "a bungalow with three bedrooms, master with en-suite",
        "Wohnung mit drei Schlafzimmern, das Elternschlafzimmer mit eigenem Bad",
    ],
)
def test_nobody_gets_to_the_only_bathroom_through_the_bedroom_of_others(prompt):
    program = parse(prompt)
    types = {r.id: r.type for r in program.rooms}
    baths = {r.id for r in program.rooms if r.type == "bathroom"}
    assert len(baths) == 2
    doors = {types[other] for k in program.links for bath in baths if k.opens and (other := k.beyond(bath))}
    assert doors == {"bedroom", "hallway"}
