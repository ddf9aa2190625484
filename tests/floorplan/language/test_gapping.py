"""Verbs and rooms that stand elsewhere."""

import pytest

from pipeline.floorplan.language.parser import parse


def links(program):
    kinds = {r.id: r.type for r in program.rooms}
    return {frozenset((kinds[k.a], kinds[k.b])) for k in program.links if k.stated and k.kind != "wall"}


def joined(program, *pairs):
    return {frozenset(p) for p in pairs} <= links(program)


@pytest.mark.parametrize("way", ["linda con", "comunica con", "conecta con", "se comunicará con"])
@pytest.mark.parametrize("size", ["", ", de 16 m²,"])
def test_the_second_pair_is_joined_as_the_first(way, size):
    program = parse(f"La cocina {way} el comedor, y el comedor{size} con el salón. Dos dormitorios y un baño.")
    assert joined(program, ("kitchen", "dining_room"), ("dining_room", "living_room"))


@pytest.mark.parametrize("verb", ["dan", "salen", "se abren", "deben dar", "solamente deben dar", "darán"])
def test_what_opens_onto_a_hall_may_stand_behind(verb):
    program = parse(f"Al pasillo {verb} los dos dormitorios y el baño. Cocina y salón.")
    assert joined(program, ("hallway", "bedroom"), ("hallway", "bathroom"))


@pytest.mark.parametrize("door", ["una puerta doble al", "una puerta corredera al", "una puerta de cristal al", "puertas correderas al"])
def test_a_door_of_any_kind_is_a_way(door):
    program = parse(f"El salón, con {door} comedor, mide 20 m². Dos dormitorios, baño y cocina.")
    assert joined(program, ("living_room", "dining_room"))


@pytest.mark.parametrize("verb", ["comparten", "usan", "tienen"])
def test_another_by_itself_is_one_more_of_what_was_named(verb):
    program = parse(f"Tres dormitorios. La abuela tiene su baño; los niños {verb} otro. Cocina y salón.")
    assert sum(r.type == "bathroom" and r.stated for r in program.rooms) == 2


def test_what_is_compared_with_is_no_new_room():
    program = parse("Dos dormitorios de 12 m², un baño y un salón el doble de grande que un dormitorio.")
    assert sum(r.type == "bedroom" and r.stated for r in program.rooms) == 2


def test_a_preference_names_no_room():
    program = parse("Prefiero un salón de 30 m² que dos salas pequeñas. Un dormitorio y un baño.")
    assert sum(r.type == "living_room" for r in program.rooms) == 1


def test_a_unit_may_stand_before_its_figure():
    assert parse("dormitorios 3, baños 2, cocina 1, m2 110").total_area.target == 110


@pytest.mark.parametrize("verb", ["conecte", "comunique", "conecta", "comunicará"])
def test_a_way_goes_on_behind_its_preposition(verb):
    program = parse(f"Un recibidor que {verb} con el salón y con el pasillo. Un dormitorio, un baño y una cocina.")
    assert joined(program, ("entry", "living_room"), ("entry", "hallway"))


@pytest.mark.parametrize("place", ["dentro del dormitorio", "junto al salón", "al lado del dormitorio"])
def test_another_one_elsewhere_is_a_second_room(place):
    program = parse(f"Un baño junto a la cocina y otro {place}. Cocina, salón y un dormitorio.")
    assert sum(r.type == "bathroom" for r in program.rooms) == 2


def test_the_bath_of_the_corridor_is_not_the_bedroom_s():
    program = parse("Un dormitorio con baño propio y dos más. Los niños usan el baño del pasillo. Cocina y salón.")
    assert sum(r.type == "bathroom" for r in program.rooms) == 2
    assert joined(program, ("bathroom", "hallway"))
