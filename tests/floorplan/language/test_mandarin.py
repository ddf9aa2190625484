"""Chinese said in many ways: counts behind their rooms, sides and doors, sizes against each other. Two ways of saying the same state the same."""

from collections import Counter

import pytest

from pipeline.floorplan.language.parser import understand


def stated(prompt):
    """Return rooms by type and role, links by type, prohibitions and relations."""
    program = understand(prompt)
    kinds = {r.id: r.type for r in program.rooms}
    rooms = Counter((r.type, r.role, r.level) for r in program.rooms)
    links = Counter((*sorted((kinds[k.a], kinds[k.b])), k.kind) for k in program.links)
    forbids = Counter((f.what, *sorted((kinds.get(f.a, f.a), kinds.get(f.b or "", f.b or "")))) for f in program.forbids)
    relations = Counter((r.kind, kinds.get(r.a, r.a), kinds.get(r.b or "", r.b), round(r.value, 2)) for r in program.relations)
    return rooms, links, forbids, relations, program.storeys, program.total_area


@pytest.mark.parametrize(
    ("said", "plain"),
    [
        ("卧室x3，卫生间x2，厨房x1", "三间卧室，两个卫生间，一间厨房"),
        ("卧室数量：3，卫生间数量为2，厨房1间", "三间卧室，两个卫生间，一间厨房"),
        ("不要两个卫生间了，一个就够。两间卧室", "一个卫生间。两间卧室"),
    ],
)
def test_counts_in_other_places(said, plain):
    assert stated(said) == stated(plain)


@pytest.mark.parametrize(
    ("said", "plain"),
    [
        ("两间卧室，走廊。所有卧室都从走廊进出。", "两间卧室，走廊。两间卧室都与走廊相连。"),
        ("书房只有经过客厅才能到达。", "书房只能从客厅进入。"),
        ("客厅。餐厅，与客厅之间没有隔断。", "客厅。餐厅，与客厅打通。"),
        ("餐厅和客厅用一扇双开门隔开。", "餐厅与客厅之间有门。"),
        ("两间卧室都开向客厅，厨房和书房也是。", "两间卧室都开向客厅。厨房开向客厅。书房开向客厅。"),
        ("从厨房可以去储藏室，从储藏室可以去车库，从车库可以去花园。", "厨房通储藏室。储藏室通车库。"),
        ("玄关，通往卫生间的走廊。", "玄关，走廊。走廊通向卫生间。"),
    ],
)
def test_ways_by_sides_doors_and_going(said, plain):
    assert stated(said)[:3] == stated(plain)[:3]


@pytest.mark.parametrize(
    ("said", "larger", "smaller", "factor"),
    [
        ("厨房比客厅小", "living_room", "kitchen", 1.0),
        ("厨房没有客厅大", "living_room", "kitchen", 1.0),
        ("厨房不能比客厅大", "living_room", "kitchen", 1.0),
        ("客厅要比厨房大一倍", "living_room", "kitchen", 2.0),
        ("客厅面积大于厨房", "living_room", "kitchen", 1.0),
        ("客厅最大，其次是厨房", "living_room", "kitchen", 1.0),
    ],
)
def test_sizes_against_each_other(said, larger, smaller, factor):
    program = understand(f"{said}。还有一间卧室。")
    kinds = {r.id: r.type for r in program.rooms}
    assert (larger, smaller, factor) in [(kinds[r.a], kinds[r.b], r.value) for r in program.relations if r.kind == "area_order"]


def test_besides_adds_and_without_it_leaves_out():
    assert stated("除了客厅之外，还有一间客房") == stated("客厅，还有一间客房")


@pytest.mark.parametrize("word", ["卫间生", "客客厅", "走栏", "玄官", "卫升间", "储屋间"])
def test_slips_of_the_pen_are_healed(word):
    program = understand(f"两间卧室，一间书房，{word}。")
    assert len(program.rooms) == 4
    assert not program.unparsed
