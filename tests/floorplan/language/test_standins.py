"""Words that stand for rooms, people who have them, and what negations reach: two ways of saying the same state the same."""

import pytest

from pipeline.floorplan import parse


def stated(prompt):
    """Return what a prompt states: rooms with role and storey, links and prohibitions by type and role, relations by kind."""
    program = parse(prompt)
    names = {r.id: f"{r.type}/{r.role}" for r in program.rooms}
    rooms = sorted((r.type, r.role, r.level or 0, r.functions) for r in program.rooms if r.stated)
    ways = sorted((*sorted((names[k.a], names[k.b])), k.kind) for k in program.links if k.stated)
    banned = sorted(
        (f.what, *sorted((names.get(f.a, f.a), names.get(f.b or "", f.b or "")))) for f in program.forbids if f.what != "through"
    )
    return rooms, ways, sorted(set(banned)), sorted((r.kind, r.value) for r in program.relations)


@pytest.mark.parametrize(
    ("short", "long"),
    [
        ("Zwei Schlafzimmer, dazwischen liegt das Bad.", "Zwei Schlafzimmer. Das Bad liegt zwischen den beiden Schlafzimmern."),
        ("两间卧室,中间是卫生间。", "两间卧室。卫生间在两间卧室之间。"),
        ("Two bedrooms with a bathroom in between, kitchen", "Two bedrooms, kitchen, a bathroom between the two bedrooms"),
        ("Drei Schlafzimmer, zwei grenzen an den Flur, eines nur über das Büro erreichbar.", "Drei Schlafzimmer, davon zwei neben dem Flur, davon eines nur über das Büro erreichbar."),
        ("Ein Gästezimmer, das auch als Büro dient, Küche", "Ein Gästezimmer, das zugleich als Arbeitszimmer genutzt wird, Küche"),
        ("厨房、餐厅、客厅之间没有隔墙。一间卧室", "厨房、餐厅、客厅打通。一间卧室"),
        ("Keine Wand zwischen Küche und Wohnzimmer. Ein Schlafzimmer", "Küche und Wohnzimmer offen. Ein Schlafzimmer"),
        ("一间远离卧室的书房。一间卧室。", "一间书房,书房远离卧室。一间卧室。"),
        ("Weder das Bad noch die Küche sollen neben dem Schlafzimmer liegen.", "Das Bad soll nicht neben dem Schlafzimmer liegen. Die Küche soll nicht neben dem Schlafzimmer liegen."),
        ("Das Bad darf keine gemeinsame Wand mit der Küche haben.", "Das Bad soll nicht an die Küche grenzen."),
        ("Zwei Schlafzimmer. Ein Bad pro Etage. Oben ein Büro.", "Zwei Schlafzimmer. Unten ein Bad. Oben ein Bad. Oben ein Büro."),
        ("不要没有窗户的卫生间!一间卧室。", "卫生间有窗。一间卧室。"),
        ("卧室比儿童房大。", "卧室比儿童房大一点。"),
        ("走廊左边是厨房,右边是卧室。", "走廊通向厨房和卧室。"),
        ("Drei Schlafzimmer oben, unten nur ein Büro.", "Unten ein Büro. Oben drei Schlafzimmer."),
        ("Küche und Wohnzimmer sollen durch eine Schiebetür verbunden sein.", "Küche und Wohnzimmer sind miteinander verbunden."),
        ("Zwei Schlafzimmer; das größere 16 m², das kleinere 10 m².", "Zwei Schlafzimmer (16 und 10 m²)."),
        ("Ein Flur, an dem alle Zimmer liegen: Küche, Bad, Büro.", "Ein Flur, alle Zimmer gehen vom Flur ab: Küche, Bad, Büro."),
        ("一个有窗的卫生间,一间卧室", "一间卧室,一个卫生间,卫生间有窗"),
    ],
)  # fmt: skip
def test_what_stands_for_rooms_means_them(short, long):
    assert stated(short) == stated(long)


@pytest.mark.parametrize(
    ("short", "long"),
    [
        ("Die Großeltern bekommen ein Schlafzimmer mit eigenem Bad, die beiden Kinder je ein Zimmer.", "Zwei Kinderzimmer. Ein Großelternzimmer mit eigenem Bad."),
        ("给老人一间带卫生间的卧室,两个孩子每人一间卧室。", "两间儿童房。一间带卫生间的老人房。"),
        ("我们有三个孩子。每个孩子要有自己的房间。厨房", "三间儿童房,厨房"),
        ("Vier Studenten, jeder bekommt ein eigenes Zimmer, eine Küche.", "Vier Schlafzimmer, eine Küche."),
        ("四个学生,每人一间卧室,厨房", "四间卧室,厨房"),
        ("Ein Bad am Flur, das Elternschlafzimmer hat sein eigenes.", "Ein Bad am Flur, das Elternschlafzimmer hat ein eigenes Bad."),
        ("奶奶的房间旁边是厨房。", "老人房旁边是厨房。"),
        ("Vier Schlafzimmer, alle außer dem Gästezimmer mit eigenem Bad.", "Vier Schlafzimmer, davon drei mit eigenem Bad, eines ist das Gästezimmer."),
        ("四间卧室,除了客房以外每间都带卫生间。", "四间卧室,其中三间带卫生间,另一间是客房。"),
    ],
)  # fmt: skip
def test_people_stand_for_their_rooms(short, long):
    mine, other = stated(short), stated(long)
    assert mine[0] == other[0]
    assert [(w[-1], *(x.partition("/")[0] for x in w[:2])) for w in mine[1]] == [
        (w[-1], *(x.partition("/")[0] for x in w[:2])) for w in other[1]
    ]


@pytest.mark.parametrize("prompt", ["Die Garage ist über den Abstellraum mit der Küche verbunden.", "车库通过储藏室和厨房相连。"])
def test_a_way_through_a_third_room_has_two_doors(prompt):
    assert [w[:2] for w in stated(prompt)[1]] == [("garage/", "storage/"), ("kitchen/", "storage/")]


@pytest.mark.parametrize(
    "prompt",
    ["Das Bad soll nicht neben der Küche liegen und soll eine Tür zum Flur haben.", "卫生间不能挨着厨房,走廊可以直接进卫生间。"],
)
def test_a_negation_ends_where_a_new_statement_begins(prompt):
    _, ways, banned, _ = stated(prompt)
    assert ways == [("bathroom/", "hallway/", "door")]
    assert banned == [("adjacent", "bathroom/", "kitchen/")]


@pytest.mark.parametrize("prompt", ["Zuerst wollten wir drei Bäder, jetzt doch nur zwei. Eine Küche.", "Zwei Bäder, eine Küche"])
def test_what_was_wanted_at_first_does_not_count(prompt):
    assert [r[0] for r in stated(prompt)[0]] == ["bathroom", "bathroom", "kitchen"]


def test_another_way_is_made_where_the_usual_one_is_ruled_out():
    program = parse("Das Arbeitszimmer soll erreichbar sein, ohne durch das Wohnzimmer zu gehen. Ein Schlafzimmer.")
    entry = next(r.id for r in program.rooms if r.type in {"entry", "hallway"})
    assert program.entrance.into == entry
    assert any({entry, "office"} == {k.a, k.b} for k in program.links)
