"""What Spanish leaves unsaid."""

import pytest

from pipeline.floorplan.language.parser import parse


def links(program):
    kinds = {r.id: r.type for r in program.rooms}
    return {frozenset((kinds[k.a], kinds[k.b])) for k in program.links if k.stated and k.kind != "wall"}


def count(program, kind, role=None):
    return sum(r.type == kind and r.stated and role in (None, r.role) for r in program.rooms)


@pytest.mark.parametrize("one", ["uno de matrimonio", "uno para los padres", "uno para el matrimonio"])
@pytest.mark.parametrize("other", ["otro para el niño", "otro para la niña", "otro para los niños"])
def test_one_and_another_are_of_those_that_were_counted(one, other):
    program = parse(f"Piso con dos dormitorios, {one} y {other}, un baño, cocina y salón.")
    assert (count(program, "bedroom"), count(program, "bedroom", "primary"), count(program, "bedroom", "child")) == (2, 1, 1)


def test_another_for_each_child_is_a_room_more():
    program = parse("Una habitación para los padres, otra para cada uno de los tres hijos y una más para invitados. Un baño y una cocina.")
    assert (count(program, "bedroom"), count(program, "bedroom", "child"), count(program, "bedroom", "guest")) == (5, 3, 1)


@pytest.mark.parametrize("no", ["no al salón", "pero no al salón", "y no al salón"])
def test_the_way_before_is_what_is_denied(no):
    program = parse(f"La cocina se abre al comedor, {no}. Un dormitorio y un baño.")
    kinds = {r.id: r.type for r in program.rooms}
    assert frozenset(("kitchen", "dining_room")) in links(program)
    assert frozenset(("kitchen", "living_room")) not in links(program)
    assert any({kinds.get(f.a), kinds.get(f.b or "")} == {"kitchen", "living_room"} for f in program.forbids)


@pytest.mark.parametrize("verb", ["parte", "sale", "arranca"])
def test_a_corridor_starts_from_a_room(verb):
    program = parse(f"Del salón {verb} un pasillo que lleva a los dos dormitorios y al baño.")
    assert {frozenset(("living_room", "hallway")), frozenset(("hallway", "bedroom")), frozenset(("hallway", "bathroom"))} <= links(program)


@pytest.mark.parametrize("floor", ["planta 1ª", "1ª planta", "planta 1"])
def test_storeys_by_number(floor):
    program = parse(f"Planta baja: cocina y salón; {floor}: 3 dormitorios y 2 baños.")
    assert program.storeys == 2
    assert all(r.level == 1 for r in program.rooms if r.type == "bedroom")


@pytest.mark.parametrize("verb", ["están", "hay", "se encuentran", "se sitúan", "se ubican"])
def test_what_is_in_a_corridor_opens_off_it(verb):
    program = parse(f"En el pasillo {verb} tres dormitorios y un baño. Salón y cocina.")
    assert {frozenset(("hallway", "bedroom")), frozenset(("hallway", "bathroom"))} <= links(program)
