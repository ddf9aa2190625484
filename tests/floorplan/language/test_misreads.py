"""Everyday sentences that were once read wrong."""

import pytest

from pipeline.floorplan import parse
from pipeline.floorplan.program.consistency import ImpossibleError


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


def owners(prompt, kind="bathroom"):
    """Return the bedrooms that have a room of a kind of their own."""
    program = parse(prompt)
    kinds = {r.id: r.type for r in program.rooms}
    pairs = [(k.a, k.b) if kinds[k.a] == "bedroom" else (k.b, k.a) for k in program.links if k.stated]
    return [bed for bed, thing in pairs if kinds[thing] == kind and kinds[bed] == "bedroom"]


def wished(prompt, kind="bedroom"):
    """Return what each room of a type is to have."""
    return [sorted(t.category for t in r.furniture.counts) if r.furniture else [] for r in parse(prompt).rooms if r.type == kind]


def unread(prompt):
    return [prompt[s.start : s.end] for s in parse(prompt).unparsed]


@pytest.mark.parametrize(
    "prompt",
    [
        "three bedrooms, the largest with its own bathroom, the others share one",
        "Drei Schlafzimmer, das größte mit eigenem Bad, die anderen teilen sich eins",
        "tres dormitorios, el más grande con baño propio, los otros comparten uno",
        "trois chambres, la plus grande avec sa propre salle de bain, les autres en partagent une",
        "三间卧室，最大的带独立卫生间，其他的共用一个",
    ],
)
def test_the_largest_has_its_own_bath_and_the_others_share_one(prompt):
    assert [r.type for r in parse(prompt).rooms if r.stated].count("bathroom") == 2
    assert len(owners(prompt)) == 1
    assert unread(prompt) == []


def test_what_the_largest_has_is_not_the_others():
    said = "three bedrooms, the largest with its own bathroom, the others with a balcony"
    assert (len(owners(said)), len(owners(said, "balcony"))) == (1, 2)
    assert not set(owners(said)) & set(owners(said, "balcony"))
    assert wished("three bedrooms, the largest with a balcony, the others with a desk") == [[], ["desk"], ["desk"]]
    said = "a flat with 2 bedrooms of which one has a balcony and the other an ensuite"
    assert owners(said) != owners(said, "balcony")


@pytest.mark.parametrize(
    "prompt",
    [
        "a desk in one bedroom and the second with a double bed",
        "two bedrooms, the first with a desk and the second with a double bed",
        "two bedrooms, a desk in one and a double bed in the other",
        "Zwei Schlafzimmer, ein Schreibtisch in einem und das zweite mit einem Doppelbett",
        "dos dormitorios, un escritorio en uno y una cama doble en el otro",
        "deux chambres, la première avec un bureau et la deuxième avec un lit double",
        "两间卧室，一间有书桌，另一间有双人床",
    ],
)
def test_one_has_this_and_the_other_that(prompt):
    assert wished(prompt) == [["desk"], ["double_bed"]]


@pytest.mark.parametrize(
    "prompt", ["two bathrooms, the first with a bathtub, the second with a shower", "Zwei Bäder, eins mit Wanne, das andere mit Dusche"]
)
def test_the_first_of_two_baths_is_no_bedroom(prompt):
    assert wished(prompt, "bathroom") == [["bathtub"], ["shower"]]


def test_the_second_has_an_area_of_its_own():
    rooms = parse("first bedroom 12m2, second 10m2, third 8m2").rooms
    assert [r.area.target for r in rooms if r.type == "bedroom"] == pytest.approx([12.0, 10.0, 8.0])


@pytest.mark.parametrize("prompt", ["cosy one bed with a big wardrobe", "one bed flat with a wardrobe", "a studio with a wardrobe"])
def test_a_wardrobe_of_a_small_flat_is_no_room(prompt):
    assert "closet" not in {r.type for r in parse(prompt).rooms}
    assert [["wardrobe"]] in (wished(prompt), wished(prompt, "studio_room"))


@pytest.mark.parametrize(
    "prompt",
    [
        "a bath and a balcony off the living room",
        "Ein Bad und ein Balkon am Wohnzimmer",
        "une salle de bain et un balcon donnant sur le séjour",
    ],
)
def test_a_bath_beside_a_balcony_does_not_open_off_the_living_room(prompt):
    assert linked(prompt) == {("balcony", "living_room", "door")}


@pytest.mark.parametrize("prompt", ["两室一厅，厨房，带阳台", "一室一厅，一厨一卫，带阳台", "两室一厅一厨带阳台", "两室一厅一厨一卫带阳台"])
def test_the_balcony_behind_a_count_of_rooms_is_the_homes(prompt):
    assert linked(prompt) == set()


@pytest.mark.parametrize(
    "prompt", ["bedroom; bedroom; bathroom", "Schlafzimmer; Schlafzimmer; Bad", "dormitorio; dormitorio; baño", "卧室；卧室；卫生间"]
)
def test_semicolons_list_rooms(prompt):
    assert sorted(r.type for r in parse(prompt).rooms if r.stated) == ["bathroom", "bedroom", "bedroom"]


@pytest.mark.parametrize(
    "prompt",
    [
        "bedrooms on the first floor, everything else below",
        "chambres à l'étage, tout le reste en bas",
        "house with everything downstairs except the bedrooms",
        "unten alles außer den Schlafzimmern",
        "a kitchen, a living room, the bedrooms upstairs",
    ],
)
def test_the_bedrooms_are_above_the_rest(prompt):
    levels = {(r.type == "bedroom", r.level) for r in parse(prompt).rooms if r.type in {"bedroom", "kitchen", "living_room"}}
    assert levels == {(True, 1), (False, 0)}


def test_two_up_and_two_down():
    assert storeys("four bedrooms, two up and two down") == [("bedroom", 0), ("bedroom", 0), ("bedroom", 1), ("bedroom", 1)]


@pytest.mark.parametrize(
    "prompt",
    [
        "the parents have their own bathroom, the two kids share another",
        "Die Eltern haben ein eigenes Bad, die zwei Kinder teilen sich ein weiteres",
        "los padres tienen su propio baño, los dos niños comparten otro",
        "les parents ont leur propre salle de bain, les deux enfants en partagent une autre",
        "父母有独立卫生间，两个孩子共用另一个",
    ],
)
def test_the_children_share_a_bath_of_their_own(prompt):
    rooms = [(r.type, r.role) for r in parse(prompt).rooms if r.stated]
    assert rooms.count(("bedroom", "child")) == 2 == [kind for kind, _ in rooms].count("bathroom")
    assert len(owners(prompt)) == 1


def test_a_room_that_is_not_wanted_in_another_is_not_ruled_out():
    forbids = {(f.what, f.a) for f in parse("no kitchen in the living room").forbids}
    assert forbids == {("open", "kitchen")}
    assert not parse("a flat without a separate kitchen").forbids


def test_what_the_last_room_of_a_list_must_not_be_is_said_of_it_alone():
    program = parse("a big kitchen, small living room, and the bathroom must not be next to the kitchen")
    assert [f.a for f in program.forbids] == ["bath"]


def test_so_many_people_at_table_need_no_bedrooms():
    said = "una cocina y un comedor para seis personas"
    assert [r.type for r in parse(said).rooms].count("bedroom") < 3
    assert unread(said) == ["seis"]


def test_rooms_around_one_open_off_it():
    assert linked("the living room in the middle and the bedrooms around it") == {("bedroom", "living_room", "door")}


def test_two_counts_of_one_thing_are_refused():
    with pytest.raises(ImpossibleError, match="2 bedrooms, 3 bedrooms"):
        parse("a home with 2 bedrooms, 3 bedrooms")


def test_at_least_less_than_the_least_is_met_by_it():
    assert parse("a hall at least 0.7 m wide").accessibility.min_corridor == pytest.approx(0.8)
    with pytest.raises(ImpossibleError, match=r"doors of 0.65 m"):
        parse("a flat with 65 cm doors")


@pytest.mark.parametrize("prompt", ["two units", "a studio, two of them", "Wohnung, 2 davon, mit je einem Schlafzimmer", "两套两居室"])
def test_several_homes_are_refused_with_the_command_that_makes_them(prompt):
    with pytest.raises(ImpossibleError, match="2 homes are asked for") as caught:
        parse(prompt)
    assert "--count" in caught.value.remedy


BELOW_ZERO = [
    "a bedroom with -2 chairs",
    "a bedroom with −2 chairs",
    "a bedroom (-2 chairs)",
    "a bedroom with at least -2 chairs",
    "a bedroom and between -2 and 3 chairs",
    "a flat with -70% free floor",
    "a flat for -3 people",
    "ein Schlafzimmer mit -2 Stühlen",
    "une chambre avec -2 chaises",
    "un dormitorio con -2 sillas",
    "卧室里有-2把椅子",
    "一套公寓,有-2个卧室",
]


@pytest.mark.parametrize(
    ("prompt", "remedy"),
    [
        ("300% free", "100%"),
        ("a two-bedroom flat, 300 % free", "100%"),
        ("a bedroom with 500 chairs", "200 at most"),
        ("500 bedrooms", "40 at most"),
        *((prompt, "above zero") for prompt in BELOW_ZERO),
    ],
)
def test_what_no_room_can_have_is_refused_with_what_one_can(prompt, remedy):
    with pytest.raises(ImpossibleError) as caught:
        parse(prompt)
    assert remedy in caught.value.remedy


@pytest.mark.parametrize(
    "prompt", ["a bedroom with a bed -2 chairs -a desk", "a bedroom with 2 -3 chairs", "-2 chairs\n-1 bed in the bedroom"]
)
def test_a_dash_that_lists_or_spans_is_no_minus(prompt):
    assert any(c.category == "any_chair" and c.min == 2 for r in parse(prompt).rooms for c in r.furniture.counts)


def test_the_other_of_one_room_has_its_own_furniture():
    program = parse("appartement avec deux chambres, une chambre avec un lit double et l'autre avec un lit simple et un bureau")
    things = sorted(sorted(c.category for c in r.furniture.counts) for r in program.rooms if r.type == "bedroom")
    assert things == [["desk", "single_bed"], ["double_bed"]]
