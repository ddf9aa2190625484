"""Wishes for furniture in four languages: what is read, what is left for the rooms, and whose wish it is."""

import contextlib
import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline import taxonomy
from pipeline.errors import RefusedError
from pipeline.floorplan import complete, parse
from pipeline.floorplan.language.builder import Mention
from pipeline.floorplan.language.lexicon import LANGUAGES
from pipeline.floorplan.language.parser import attach, read_furniture
from pipeline.floorplan.program.floor_program import FloorProgram, Furniture, RoomReq, Things
from pipeline.floorplan.program.furniture import lexicon, matching_categories, members, natural


def said(prompt):
    """Return the claims as a set of short tuples."""
    found = set()
    for c in read_furniture(prompt)[1]:
        if c.kind in {"count", "pieces"}:
            found.add((c.name or "pieces", c.least, c.most))
        elif c.kind == "openable":
            found.add(("opens", c.least))
        else:
            found.add((c.kind, c.name or round(c.value, 3)))
    return found


NORDIC = {("pieces", 8, 8), ("nightstand", 2, 2), ("walkable", 0.7), ("style", "Nordic")}


@pytest.mark.parametrize(
    ("prompt", "wanted"),
    [
        ("a bedroom with eight pieces, two nightstands, 70 % free, nordic", NORDIC),
        ("ein Schlafzimmer mit acht Möbelstücken, zwei Nachttischen, 70 % frei, im nordischen Stil", NORDIC),
        ("un dormitorio con ocho muebles, dos mesitas de noche, 70 % libre, estilo nórdico", NORDIC),
        ("卧室要八件家具,两个床头柜,70%空地,北欧风格", NORDIC),
        ("ein Schlafzimmer mit zwei Nachttischen und ohne Fernseher", {("nightstand", 2, 2), ("tv_stand", 0, 0)}),
        ("客厅至少放三件可以打开的家具,不要电视", {("opens", 3), ("tv_stand", 0, 0)}),
        ("卧室留出百分之六十空地", {("walkable", 0.6)}),
        ("no TVs or armchairs, and at most two sofas", {("tv_stand", 0, 0), ("armchair", 0, 0), ("any_sofa", 0, 2)}),
        ("kein Sofa und keine Sessel", {("any_sofa", 0, 0), ("armchair", 0, 0)}),
        ("sin televisor ni sillones", {("tv_stand", 0, 0), ("armchair", 0, 0)}),
        ("between six and eight pieces of furniture", {("pieces", 6, 8)}),
        ("6-8 pieces", {("pieces", 6, 8)}),
        ("entre seis y ocho muebles", {("pieces", 6, 8)}),
        ("mindestens sechs Möbel", {("pieces", 6, None)}),
        ("four chairs or more", {("any_chair", 4, None)}),
        ("exactly twenty one items of furniture", {("pieces", 21, 21)}),
        ("a bedroom with a desk", {("desk", 1, None)}),
        ("a bedroom with bookshelves", {("bookshelf", 1, None)}),
        ("a living room with armchairs", {("armchair", 2, None)}),
        ("a bedroom with two king-size beds", {("double_bed", 2, 2)}),
        ("three nordic armchairs", {("armchair", 3, 3), ("style", "Nordic")}),
        ("a bedroom with two nighstands and a bokshelf", {("nightstand", 2, 2), ("bookshelf", 1, None)}),
        ("at least 70 percent of the floor free", {("walkable", 0.7)}),
        ("three pieces that open", {("opens", 3)}),
        ("tres muebles que se abren", {("opens", 3)}),
        ("mindestens drei Möbel zum Öffnen", {("opens", 3)}),
        ("a bedroom with two beds", {("any_bed", 2, 2)}),
        ("a bathroom with a toilet and a shower", {("toilet", 1, None), ("shower", 1, None)}),
    ],
)
def test_what_is_read(prompt, wanted):
    assert said(prompt) == wanted


@pytest.mark.parametrize(
    "prompt",
    [
        "3 bed, 2 bath, open kitchen",
        "a two-bedroom flat with a separate toilet and a shower room",
        "a master suite with a walk-in wardrobe and a walk-in closet",
        "a bedroom, a bathroom and a wardrobe",
        "a tv room next to the dining area",
        "a bedroom of 12 m2, 10 % larger than the study",
        "eine Wohnung mit zwei Schlafzimmern und Balkon, 75 m²",
        "un piso de dos dormitorios con cocina abierta",
        "三室两厅一厨两卫,120平米",
        "a wide range of rooms",
        "una casa de dos plantas con dos baños, para una silla de ruedas",
        "zwei Bäder, ein Büro und zwei Balkone",
        "a buffer zone and a store cupboard in the hall",
        "a bedroom, table lamp and 台灯",
    ],
)
def test_rooms_are_no_furniture(prompt):
    assert read_furniture(prompt) == (prompt, [])


def test_what_is_left_speaks_of_rooms_in_the_same_places():
    prompt = "a bedroom with a double bed, two nightstands and its own bathroom, and a kitchen with an oven"
    plain, _ = read_furniture(prompt)
    assert len(plain) == len(prompt)
    assert plain.split() == ["a", "bedroom", "with", "its", "own", "bathroom,", "and", "a", "kitchen"]
    for word in ("bedroom", "bathroom", "kitchen"):
        assert plain.index(word) == prompt.index(word)
    assert read_furniture("卧室要八件家具,两个床头柜,北欧风格")[0].strip() == "卧室"


def wishes(prompt):
    return {r.id: r.furniture for r in parse(prompt).rooms if r.furniture != Furniture()}


def test_whose_wish_it_is():
    found = wishes("a flat with two bedrooms, each with two nightstands; the living room is industrial and has three pieces that open")
    pair = Furniture(counts=(Things(category="nightstand", min=2, max=2),))
    assert found == {"bed": pair, "bed_2": pair, "living": Furniture(style="Industrial", openable=3)}
    found = wishes("a one-bedroom flat with two nightstands, and two chairs in the kitchen")
    assert found["bed"] == pair
    assert found["kitchen"].counts[0].category == "any_chair"
    found = wishes("a living room with a sofa and a kitchen with an oven and a fridge, a bedroom and a bathroom")
    assert {k: {c.category for c in v.counts} for k, v in found.items()} == {"living": {"any_sofa"}, "kitchen": {"oven", "refrigerator"}}


@pytest.mark.parametrize(
    ("prompt", "rooms"),
    [
        ("a 2-bedroom flat with a sofa and a big tv", {"living": {"any_sofa", "tv_stand"}}),
        ("a three-bedroom house with a dining table for six", {"living": {"dining_table", "any_chair"}}),
        ("a two-bedroom apartment with a desk", {"bed": {"desk"}}),
        ("a two-bedroom apartment with bunk beds", {"bed": {"kids_bed"}, "bed_2": {"kids_bed"}}),
        ("two bedrooms, a kitchen and a sofa", {"living": {"any_sofa"}}),
        ("a two-bedroom flat with a desk in each bedroom", {"bed": {"desk"}, "bed_2": {"desk"}}),
        ("a flat with a dining table for eight in the kitchen", {"kitchen": {"dining_table", "any_chair"}}),
        ("une cuisine avec une table pour quatre et un salon", {"kitchen": {"any_table", "any_chair"}}),
        ("a kitchen with a table for four and a living room", {"kitchen": {"any_table", "any_chair"}}),
        ("三室两厅,带餐桌", {"dining": {"dining_table"}}),
        ("a family house with three bedrooms and a dining table", {"living": {"dining_table"}}),
        ("un piso de dos dormitorios con un sofá", {"living": {"any_sofa"}}),
        ("eine Dreizimmerwohnung mit einem Esstisch", {"living": {"dining_table"}}),
        ("a flat with a bedroom with a sofa", {"bed": {"any_sofa"}}),
        ("two bedrooms. The first has a double bed, the second has a desk", {"bed": {"double_bed"}, "bed_2": {"desk"}}),
        ("zwei Schlafzimmer, das erste mit Doppelbett, das zweite mit Schreibtisch", {"bed": {"double_bed"}, "bed_2": {"desk"}}),
        ("two bedrooms: one bedroom with a double bed, the other with a desk", {"bed": {"double_bed"}, "bed_2": {"desk"}}),
        ("a bedroom with a double bed and another one with a desk", {"bed": {"double_bed"}, "bed_2": {"desk"}}),
        ("bedroom with double bed, bedroom with desk, bathroom", {"bed": {"double_bed"}, "bed_2": {"desk"}}),
        ("two bedrooms. The largest has a double bed, the other a desk", {"bed": {"double_bed"}, "bed_2": {"desk"}}),
    ],
)
def test_what_a_home_is_to_have_goes_where_it_usually_stands_and_not_into_the_bedrooms_that_name_it(prompt, rooms):
    assert {r.id: {c.category for c in r.furniture.counts} for r in complete(parse(prompt)).rooms if r.furniture.counts} == rooms


def test_wishes_for_the_whole_home_reach_every_furnished_room():
    program = parse("Everything nordic, no TVs, 60 % free everywhere. A two-bedroom flat with a garage.")
    assert program.furniture == Furniture(style="Nordic", walkable=0.6, counts=(Things(category="tv_stand", max=0),))
    for room in program.rooms:
        assert room.furniture == (Furniture() if room.type == "garage" else program.furniture)
    own = parse("Everything nordic. A flat with an industrial living room, a bedroom, a kitchen and a bathroom.")
    assert {r.id: r.furniture.style for r in own.rooms} == {"living": "Industrial", "bed": "Nordic", "kitchen": "Nordic", "bath": "Nordic"}
    assert complete(program) == program


def test_a_number_for_the_whole_home_is_shared_by_area():
    program = parse("a two-bedroom flat with 30 pieces of furniture")
    assert sum(r.furniture.least for r in program.rooms) == 30
    assert all(r.furniture.least == r.furniture.most for r in program.rooms)
    assert complete(program) == program
    every = parse("3 dorm, 2 baños, salón con 8 muebles, todo minimalista")
    assert {r.id: r.furniture.least for r in every.rooms if r.furniture.least} == {"living": 8}
    assert {r.furniture.style for r in every.rooms} == {"Minimalist"}
    loose = parse("a two-bedroom flat with at least 20 pieces of furniture and at least five things that open")
    assert sum(r.furniture.least or 0 for r in loose.rooms) == 20
    assert {r.furniture.most for r in loose.rooms} == {None}
    assert sum(r.furniture.openable or 0 for r in loose.rooms) == 5


def test_every_wish_points_at_its_words():
    prompt = "a flat with a bedroom with eight pieces, two nightstands, 70 % free, nordic, and a kitchen, a living room and a bathroom"
    cited = {e.field: e.text for e in parse(prompt).evidence if ".furniture" in e.field}
    where = "rooms.bed.furniture"
    assert cited == {
        f"{where}.pieces": "eight pieces", f"{where}.nightstand": "two nightstands", f"{where}.walkable": "70 % free", f"{where}.style": "nordic",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("prompt", "clashing"),
    [
        ("a bedroom of 6 m2 with 40 pieces", {"40 pieces", "6 m2"}),
        ("a bedroom with two nightstands but only one piece of furniture", {"two nightstands", "only one piece of furniture"}),
        ("a bedroom with two nightstands and no nightstands", {"two nightstands", "no nightstands"}),
        ("a flat with a garage with a sofa", {"a sofa"}),
        ("a flat with a bedroom and a WC with a wardrobe", {"a wardrobe"}),
        ("a flat with a kitchen with a bathtub", {"a bathtub"}),
        ("a bedroom with 9999999999999999999999 chairs", {"9999999999999999999999 chairs"}),
        ("a bedroom with ten pieces of which twelve open: twelve openable things", {"ten pieces"}),
        ("a bedroom of 9 m2 with ten pieces and 80 % free", {"ten pieces", "80 % free", "9 m2"}),
        ("a nordic bedroom with a desk, industrial, and a kitchen", {"nordic", "industrial"}),
    ],
)
def test_what_no_room_can_meet_is_refused_naming_the_words(prompt, clashing):
    with pytest.raises(RefusedError) as caught:
        parse(prompt)
    texts = {c.text for c in caught.value.clashes}
    assert clashing <= texts, texts


def test_wishes_without_rooms_are_the_homes():
    program = FloorProgram(rooms=(RoomReq(id="bed", type="bedroom"), RoomReq(id="living", type="living_room")))
    prompt = "dos mesitas de noche, estilo nórdico"
    made = attach(program, read_furniture(prompt)[1], prompt, [])
    assert made.furniture.style == "Nordic"
    assert complete(made).rooms[0].furniture.counts == (Things(category="nightstand", min=2, max=2),)
    prompt = "在卧室放两张书桌"
    made = attach(program, read_furniture(prompt)[1], prompt, [Mention(1, 3, ("bed",))])
    assert made.rooms[0].furniture.counts[0].category == "desk"


def test_the_lexicon_names_every_category_in_every_language():
    data = lexicon()
    known, rooms = taxonomy.load().names, set(taxonomy.load().types)
    for name in known:
        assert {k for k, forms in data["names"][name].items() if forms} == set(LANGUAGES), name
        assert natural(name)
    assert all(rooms.issuperset((*card.usual, *card.never)) for card in taxonomy.load().categories.values())
    assert all(group and set(group) <= set(known) for group in data["groups"].values())
    assert {group for card in taxonomy.load().categories.values() for group in card.groups} <= set(data["groups"])
    assert members("any_bed") == ("double_bed", "single_bed", "kids_bed")
    assert members("unicorn") == ()
    assert all(isinstance(form, str) for listed in data["words"].values() for form in listed)


def test_a_word_for_a_group_means_what_belongs_into_the_room():
    table = Things(category="any_table", min=1)
    assert matching_categories(table, "dining_room") == ("dining_table",)
    assert matching_categories(table, "office") == ("desk",)
    assert "coffee_table" in matching_categories(table, "living_room")
    assert matching_categories(table, "balcony") == members("any_table")
    assert matching_categories(Things(category="any_table", max=0), "dining_room") == members("any_table")  # no table at all
    assert "lazy_sofa" not in matching_categories(Things(category="any_sofa", min=1), "living_room")
    assert matching_categories(Things(category="dining_table", min=1), "living_room") == ("dining_table",)
    for group, rooms in lexicon()["meant"].items():
        wider = {"kitchen_cabinet", "wall_cabinet", "tall_unit"} if group in {"any_cabinet", "cabinet"} else set()
        assert all(set(names) <= {*members(group), *wider} for names in rooms.values())


PIECES = ["a bedroom with ", "two ", "no ", "nightstands", "sofa", ", ", "70 % free", "nordic", " and ", "at least ", "8-", "pieces", "卧室", "两个", "床头柜", "sin ", "muebles", ". ", "百分之", "in the kitchen", "\u202e", "—"]  # fmt: skip


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.lists(st.one_of(st.sampled_from(PIECES), st.text(max_size=4)), max_size=30))
def test_no_text_crashes(parts):
    prompt = "".join(parts)
    plain, claims = read_furniture(prompt)
    assert len(plain) == len(prompt)
    assert all(0 <= c.start < c.end <= len(prompt) for c in claims)
    program = FloorProgram(rooms=(RoomReq(id="bed", type="bedroom"),))
    with contextlib.suppress(RefusedError):
        attach(program, claims, prompt, [Mention(0, 1, ("bed",))])


def test_long_prompts_are_read_quickly():
    prompt = "a bedroom with two nightstands, a desk and no TV, 70 % free, nordic " * 290
    start = time.process_time()
    plain, claims = read_furniture(prompt)
    program = FloorProgram(rooms=(RoomReq(id="bed", type="bedroom"),))
    attach(program, claims, prompt, [Mention(2, 9, ("bed",))])
    assert time.process_time() - start < 10.0
    assert len(plain) == len(prompt)


def things(prompt):
    """Return the wishes of each type of room, and what nothing was made of."""
    program = parse(prompt)
    return {(r.type, c.category, c.min, c.max) for r in program.rooms for c in r.furniture.counts}, program.unparsed


@pytest.mark.parametrize(
    "prompt",
    [
        "The washing machine must not be in the kitchen. A bathroom and two bedrooms.",
        "Die Waschmaschine soll nicht in der Küche stehen. Ein Bad und zwei Schlafzimmer.",
        "La lavadora no debe estar en la cocina. Un baño y dos dormitorios.",
        "Le lave-linge ne doit pas être dans la cuisine. Une salle de bain et deux chambres.",
    ],
)
def test_what_must_not_be_in_a_room_is_not_asked_for_there(prompt):
    assert things(prompt) == ({("kitchen", "washing_machine", 0, 0)}, ())


@pytest.mark.parametrize(
    "prompt",
    [
        "The washing machine should be in the bathroom not in the kitchen. Two bedrooms.",
        "Die Waschmaschine soll ins Bad, nicht in die Küche. Zwei Schlafzimmer.",
        "La lavadora debe estar en el baño y no en la cocina. Dos dormitorios.",
    ],
)
def test_a_thing_stands_in_one_room_and_not_in_the_other(prompt):
    assert things(prompt) == ({("bathroom", "washing_machine", 1, None), ("kitchen", "washing_machine", 0, 0)}, ())


def test_a_table_stands_where_its_chairs_do():
    wishes, _ = things("A kitchen with an oven, and a dining table with 4 chairs in the living room.")
    assert wishes == {("kitchen", "oven", 1, None), ("living_room", "dining_table", 1, None), ("living_room", "any_chair", 4, 4)}


@pytest.mark.parametrize(
    "prompt",
    [
        "A terrace, a bath, put the desk in the bedroom.",
        "A terrace off the living room, 1 bath, a desk should be in the bedroom.",
    ],
)
def test_where_a_thing_stands_joins_no_rooms(prompt):
    program = parse(prompt)
    kinds = {r.id: r.type for r in program.rooms}
    assert all("bedroom" not in (kinds[k.a], kinds[k.b]) for k in program.links if k.stated)
    assert ("bedroom", "desk", 1, None) in things(prompt)[0]


def test_a_tub_stands_in_the_bathroom_of_the_bedroom():
    program = parse("A bath with a tub in the master bedroom.")
    assert things("A bath with a tub in the master bedroom.")[0] == {("bathroom", "bathtub", 1, None)}
    assert [{k.a, k.b} for k in program.links if k.stated] == [{"bath", "bed"}]


def test_how_many_live_there_is_no_empty_word():
    """Words that say nothing once held "somos cuatro" and "mother in law"."""
    assert sum(r.type == "bedroom" for r in parse("Somos cuatro, una casa con cocina.").rooms) == 3
    assert [r.role for r in parse("A room for my mother in law, a kitchen.").rooms if r.stated and r.type == "bedroom"] == ["elder"]
