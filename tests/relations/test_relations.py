"""Relations from rooms in which they are known: found where they are, absent where only the walls are shared, exact both ways."""

import json
from dataclasses import replace

import numpy as np
import pytest
from shapely import affinity
from shapely.geometry import box

from pipeline.errors import ContentError
from pipeline.relations import learning
from pipeline.relations.arrangement import from_rows, make_arrangement
from pipeline.relations.model import VERSION, Relations
from tests.relations.making import bedroom, bedrooms


@pytest.fixture(scope="module")
def known():
    return learning.fit(bedrooms(np.random.default_rng(0), 120))


def outline(room, name):
    k = room.categories.index(name)
    half = room.size[k, :2] / 2
    return affinity.translate(affinity.rotate(box(*-half, *half), room.yaw[k], (0, 0), use_radians=True), *room.position[k, :2])


def test_nightstands_stand_left_and_right_of_a_bed_flush_with_its_head(known):
    pair = known.pair("double_bed", "nightstand")
    assert {mode.side for mode in pair.modes} == {"left", "right"}
    assert all(mode.along.reference == "high" for mode in pair.modes)
    assert all(abs(mode.along.high - mode.along.low) < 0.01 for mode in pair.modes)
    assert all(mode.outwards.low >= 0.02 and mode.outwards.high <= 0.09 for mode in pair.modes)
    assert pair.share == 1
    assert pair.strength > 0.7


def test_what_only_shares_the_walls_has_no_relation(known):
    assert known.pair("double_bed", "plant") is None
    assert known.pair("plant", "nightstand") is None


def test_how_far_things_keep_from_each_other_is_known_where_one_walks_between_them(known):
    gaps = [outline(room, "double_bed").distance(outline(room, "tv_stand")) for room in bedrooms(np.random.default_rng(0), 120)]
    assert known.distances["double_bed", "tv_stand"] == pytest.approx(min(np.percentile(gaps, 5), learning.WALK[1]), abs=0.05)
    assert ("double_bed", "nightstand") not in known.distances
    assert all(learning.WALK[0] <= distance <= learning.WALK[1] for distance in known.distances.values())


def test_a_tv_stand_looks_at_the_bed_whatever_the_room_is_deep(known):
    mode = known.pair("double_bed", "tv_stand").modes[0]
    assert mode.side == "front"
    assert mode.along.reference == "middle"
    assert abs(mode.along.low) < 0.11
    assert mode.outwards.high - mode.outwards.low > 1
    assert np.cos(mode.turn.middle) == pytest.approx(-1)


def test_backs_are_at_the_wall(known):
    for name in ("double_bed", "nightstand", "tv_stand", "plant"):
        wall = known.walls[name][0]
        assert wall.side == "back"
        assert wall.share == pytest.approx(1, abs=0.1)
        assert abs(wall.gap.middle) < 0.04


def test_relations_do_not_depend_on_where_the_rooms_lie(known):
    rng = np.random.default_rng(0)
    rooms = [bedroom(rng, turned=rng.integers(4) * np.pi / 2 + 0.6) for _ in range(120)]
    turned = learning.fit(rooms)
    for key in (("double_bed", "nightstand"), ("double_bed", "tv_stand")):
        assert turned.pairs[key].modes[0].side == known.pairs[key].modes[0].side
        assert np.allclose(turned.pairs[key].modes[0].outwards[1:], known.pairs[key].modes[0].outwards[1:], atol=2e-3)


def test_the_same_rooms_give_the_same_relations_and_json_keeps_them(known, tmp_path):
    again = learning.fit(bedrooms(np.random.default_rng(0), 120))
    assert again == known
    known.save(tmp_path / "relations.json")
    assert Relations.load(tmp_path / "relations.json") == known


def test_files_that_hold_no_relations_are_refused(tmp_path):
    with pytest.raises(ContentError, match="missing"):
        Relations.load(tmp_path / "relations.json")
    for text in (
        "",
        "[]",
        "{}",
        json.dumps({"version": 99}),
        json.dumps({"version": VERSION, "pairs": [["a"]], "walls": [], "distances": []}),
    ):
        (tmp_path / "relations.json").write_text(text)
        with pytest.raises(ContentError):
            Relations.load(tmp_path / "relations.json")


def test_no_rooms_know_nothing():
    assert not learning.fit([]).pairs
    assert not learning.fit(bedrooms(np.random.default_rng(0), 3)).pairs


def test_small_things_on_furniture_are_left_out_and_tables_on_rugs_are_not():
    square = [[0, 0], [4, 0], [4, 4], [0, 4]]
    rooms = [{"scene_id": "s", "room_id": "r", "layout_type": "living_room", "polygon": square}]
    base = {"scene_id": "s", "room_id": "r", "position": [1, 1, 0], "yaw": 0.0, "size": [1, 1, 1]}
    kinds = (("rug", ""), ("coffee_table", "rug_0"), ("cup", "coffee_table_0"))
    found = from_rows(rooms, [base | {"category": c, "support": s} for c, s in kinds])
    assert found[0].categories == ("rug", "coffee_table")


def test_what_is_too_rare_for_itself_is_learnt_from_its_kind():
    rng = np.random.default_rng(1)
    rooms = bedrooms(rng, 120)
    rare = [
        replace(room, categories=tuple("kids_bed" if name == "double_bed" else name for name in room.categories)) for room in rooms[:12]
    ]
    alone = learning.fit([*rooms[12:], *rare], {})
    assert alone.pair("kids_bed", "nightstand") is None
    kinds = learning.fit([*rooms[12:], *rare])
    own = kinds.pair("kids_bed", "nightstand")
    assert own is not None
    assert own.strength > 0.5
    assert kinds.pair("double_bed", "nightstand") == alone.pair("double_bed", "nightstand")
    assert learning.fit([*rooms[12:], *rare], {"double_bed": "bed"}).pair("kids_bed", "nightstand") is None


def test_what_is_too_rare_for_itself_stands_to_walls_as_its_kind():
    rooms = bedrooms(np.random.default_rng(1), 120)
    rare = [
        replace(room, categories=tuple("kids_bed" if name == "double_bed" else name for name in room.categories)) for room in rooms[:12]
    ]
    known = learning.fit([*rooms[12:], *rare]).walls
    assert [wall.side for wall in known["kids_bed"]] == ["back"]
    assert known["kids_bed"][0].share == pytest.approx(known["double_bed"][0].share, abs=0.05)
    assert "kids_bed" not in learning.fit([*rooms[12:], *rare], {}).walls


def test_a_few_strays_do_not_stretch_a_mode():
    rooms = bedrooms(np.random.default_rng(2), 120)
    for k, room in enumerate(rooms[:7]):  # too few for a mode of their own, too many for a tail of one in twenty
        c, s = np.cos(room.yaw[0]), np.sin(room.yaw[0])
        room.position[2, :2] += (1.0 + 0.15 * k) * np.array([c, s])
    modes = learning.fit(rooms).pair("double_bed", "nightstand").modes
    assert {mode.side for mode in modes} == {"left", "right"}
    assert all(mode.outwards.high < 0.15 for mode in modes)


def test_of_its_kind_the_rare_takes_what_its_own_few_are_like():
    rooms = bedrooms(np.random.default_rng(1), 120)
    known = learning.fit([*rooms[12:], *(_with_one_nightstand(room) for room in rooms[:12])])
    assert {mode.side for mode in known.pair("kids_bed", "nightstand").modes} == {"left"}
    assert {mode.side for mode in known.pair("double_bed", "nightstand").modes} == {"left", "right"}


def _with_one_nightstand(room):
    """A child's room: the same with the first nightstand alone, which is the left one."""
    kept = [0, 1, *range(3, len(room.categories))]
    things = [(room.categories[k].replace("double", "kids"), room.position[k], room.yaw[k], room.size[k]) for k in kept]
    return make_arrangement(room.name, "kids_room", room.polygon, things)
