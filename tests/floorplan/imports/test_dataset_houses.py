"""Houses of 3D-FRONT and ProcTHOR as they come: all of them are plans, what was changed for it is stated, and nothing is there that was not in the file."""

import pytest

from pipeline import taxonomy
from pipeline.floorplan import plan_json
from pipeline.floorplan.document import PlanDocument
from pipeline.floorplan.imports import describe_repairs, program_of, read_own_json
from pipeline.homes.empty_plan import UnsoundError, check_sound, closed_rooms
from pipeline.homes.request import layout_type
from tests.floorplan.imports import procthor_houses
from tests.judging import SETTINGS
from tests.sources import front_houses

OURS = {"Kitchen": "kitchen", "Hallway": "hallway", "MasterBedroom": "bedroom", "KidsRoom": "bedroom", "Bathroom": "bathroom",
        "Balcony": "balcony", "LivingDiningRoom": "living_room"}  # fmt: skip
JAMBS = 0.05  # [m] that an opening from corner to corner loses


@pytest.mark.parametrize("name", front_houses.HOUSES)
def test_a_3d_front_house_is_a_plan(name):
    tree, truth = front_houses.house(name, front_houses.HOUSES[name])
    own = read_own_json(tree, name)
    assert check_sound(own.plan, SETTINGS) == ()
    PlanDocument.model_validate(plan_json(own.plan, program_of(own.plan), own.repairs_json()))
    types = {r.room_id: r.type for r in own.plan.rooms}
    left = [(o.kind, sorted(types[r] for r in o.rooms), o.width) for o in own.plan.openings]
    for kind, rooms, width in truth:
        match = [s for s in left if s[0] == kind and s[1] == sorted(OURS[r] for r in rooms) and -JAMBS < s[2] - width < 0.03]
        assert match, (kind, rooms, width, left)
        left.remove(match[0])
    assert left == []
    said = {r.where for r in own.repairs if r.code == "narrowed"}
    narrower = {o.opening_id for o in own.plan.openings if all(abs(o.width - width) > 0.011 for _, _, width in truth)}
    assert narrower <= said
    assert {r.room_id.split("_")[1] for r in own.plan.rooms} == {k.lower() for k in tree_types(tree)}


def tree_types(tree):
    return {r["type"] for r in tree["scene"]["room"]} - {"OtherRoom"}


def test_floors_end_at_the_walls_again():
    """Whatever reaches under doors, the rooms of the plan are those of the house that was drawn without it."""
    plain, *others = (read_own_json(front_houses.house(n, front_houses.Ways(floors=f))[0], n).plan for n, f in
                      (("a", "walls"), ("b", "half"), ("c", "full")))  # fmt: skip
    for other in others:
        assert [r.area for r in other.rooms] == pytest.approx([r.area for r in plain.rooms], abs=0.02)
        assert [len(r.polygon) for r in other.rooms] == [len(r.polygon) for r in plain.rooms]


def test_a_living_dining_room_is_one_whatever_else_is_there():
    tree, _ = front_houses.house("x", front_houses.Ways(types={"KidsRoom": "DiningRoom"}))
    own = read_own_json(tree, "x")
    room = next(r for r in own.plan.rooms if "livingdining" in r.room_id)
    assert (room.type, room.functions) == ("living_room", ("living", "dining"))
    assert layout_type(room, own.plan, taxonomy.load()) == "living_dining_room"
    again = read_own_json(plan_json(own.plan, program_of(own.plan), own.repairs_json()))
    assert [r.functions for r in again.plan.rooms] == [r.functions for r in own.plan.rooms]
    assert next(r for r in program_of(own.plan).rooms if r.id == room.room_id).functions == ("living", "dining")


@pytest.mark.parametrize("seed", range(50))
def test_a_procthor_house_is_a_plan(seed):
    document = procthor_houses.house(seed)
    own = read_own_json(document, str(seed))
    assert check_sound(own.plan, SETTINGS) == ()
    doors = sum(o.kind != "window" for o in own.plan.openings)
    walls = sum(bool(w.get("empty")) for w in document["walls"]) // 2
    assert (len(own.plan.rooms), doors) == (len(document["rooms"]), len(document["doors"]) + walls)
    wide = sum(d["assetId"] == "Doorframe_1" for d in document["doors"])
    assert wide == 0 or any(r.code == "narrowed" for r in own.repairs) or wide == sum(o.kind == "portal" for o in own.plan.openings)


@pytest.mark.parametrize("ways", [front_houses.Ways(closet=0.45), front_houses.Ways(closet=0.35, reveal="jambs", casing=False)])
def test_a_closet_behind_a_narrow_door_is_closed_to_the_robot_and_the_house_is_a_plan(ways):
    tree, _ = front_houses.house("x", ways)
    own = read_own_json(tree, "x")
    (found,) = check_sound(own.plan, SETTINGS)
    assert (found.code, found.where) == ("closed", "r_bathroom_104")
    assert f"is {ways.closet:.2f} m wide" in found.text
    assert (
        describe_repairs(own.and_found([found]).repairs_json()).count("found: r_bathroom_104: a robot 0.50 m wide does not get into it")
        == 1
    )
    assert closed_rooms(own.plan, SETTINGS) == {"r_bathroom_104"}


def test_a_home_that_is_closed_for_the_larger_part_is_refused():
    def box(x0, y0, x1, y1):
        return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]

    rooms = [
        {"id": "hall", "type": "hallway", "polygon": box(0, 0, 2, 4)},
        {"id": "room", "type": "living_room", "polygon": box(2.1, 0, 8, 4)},
    ]
    own = read_own_json({"rooms": rooms, "doors": [{"rooms": ["hall", "room"], "width": 0.4}], "entrance": "hall"})
    with pytest.raises(UnsoundError, match=r"room: a robot 0.50 m wide does not get into it: \w+ is 0.40 m wide; that is more than half"):
        check_sound(own.plan, SETTINGS)


def test_a_house_of_which_rooms_are_missing_is_entered_where_most_of_it_is():
    """Bedroom and balcony stand apart: the balcony has doors, and yet the bedroom is the home."""
    tree, _ = front_houses.house("x", front_houses.Ways(balcony=True))
    tree["scene"]["room"] = [r for r in tree["scene"]["room"] if r["type"] in {"MasterBedroom", "KidsRoom", "Balcony"}]
    own = read_own_json(tree, "x")
    assert [r.role for r in own.plan.rooms] == ["primary"]
    assert sorted(r.where for r in own.repairs if r.code == "left_out") == ["r_balcony_106", "r_kidsroom_105"]


def test_a_room_of_a_type_that_nobody_knows_is_a_store_and_said():
    tree, _ = front_houses.house("x", front_houses.Ways(types={"KidsRoom": "PrayerNook", "Bathroom": ""}))
    own = read_own_json(tree, "x")
    assert [r.type for r in own.plan.rooms].count("storage") == 2
    assert "the type 'PrayerNook' is taken as storage" in [r.text for r in own.repairs]


def test_a_room_that_nothing_leads_to_is_left_out_and_said():
    tree, _ = front_houses.house("x", front_houses.Ways())
    making_far = [[12 + x, y, z] for x, y, z in ((0, 0, 0), (3, 0, 0), (3, 0, 3), (0, 0, 3))]
    mesh = {**tree["mesh"][0], "uid": "far/0", "xyz": [v for p in making_far for v in p], "faces": [0, 1, 2, 0, 2, 3]}
    tree["mesh"].append(mesh)
    child = {**tree["scene"]["room"][0]["children"][0], "ref": "far/0"}
    tree["scene"]["room"].append({"type": "StorageRoom", "instanceid": "StorageRoom-9", "children": [child]})
    own = read_own_json(tree, "x")
    assert len(own.plan.rooms) == 6
    assert [r.where for r in own.repairs if r.code == "left_out"] == ["r_storageroom_9"]
