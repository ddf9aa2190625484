"""Plans of the corpus: what the agenda asks for is there, in sizes of 3D-FRONT's; walls, doors and windows are the planner's business."""

from collections import Counter

import numpy as np
import pytest
from sample_houses import houses

from pipeline.corpus.houses.planner import AREAS, CORRIDORS, HIGH, LARGEST_AISLE, LOW, agenda, make_plan, sample
from pipeline.entities.plan import hops
from pipeline.errors import ContentError, RefusedError
from pipeline.floorplan.program.completion import complete
from pipeline.seeds import generator

PLANS = [make_plan(generator(1, "test-plan", k), agenda(1, k).rooms) for k in range(40)]


def halls_alike(types):
    return Counter("Hallway" if t in CORRIDORS else t for t in types)


@pytest.mark.parametrize("k", range(40))
def test_every_room_that_is_furnished_is_there(k):
    assert not halls_alike(agenda(1, k).rooms) - halls_alike(r.type for r in PLANS[k].rooms)


@pytest.mark.parametrize("plan", PLANS)
def test_every_room_is_reached_from_the_entrance(plan):
    ways = hops([o.rooms for o in plan.openings if len(o.rooms) == 2], plan.entrance)
    assert set(ways) == {r.room_id for r in plan.rooms}
    assert sum(o.kind == "entrance" for o in plan.openings) == 1


def test_outlines_are_square():  # what furnishes rooms knows no other walls
    for room in (r for plan in PLANS for r in plan.rooms):
        steps = np.roll(room.polygon, -1, axis=0) - room.polygon
        assert np.all((np.abs(steps) < 1e-9).sum(axis=1) == 1)


def test_areas_are_near_what_the_types_have():
    found = [(r.type, r.area) for plan in PLANS for r in plan.rooms]
    for room_type, (mean, _, least, most) in AREAS.items():
        sizes = [a for t, a in found if t == room_type]
        assert all(LOW * least <= a <= HIGH * most for a in sizes), room_type
        if len(sizes) >= 30:
            assert np.mean(sizes) == pytest.approx(mean, rel=0.2), room_type
    assert all((a < LARGEST_AISLE) == (t == "Aisle") for t, a in found if t in {"Aisle", "Corridor"})


def test_most_rooms_but_not_all_are_rectangles():
    share = np.mean([r.area / np.prod(np.ptp(r.polygon, axis=0)) > 0.99 for plan in PLANS for r in plan.rooms])
    assert 0.5 < share < 0.78


def test_houses_have_bedrooms_a_kitchen_and_a_bath():
    for house in houses(12):
        kinds = {r.type for r in house.plan.rooms}
        assert {"Kitchen", "Bathroom"} <= kinds
        assert any("Bedroom" in k for k in kinds)
        assert 4 <= len(house.plan.rooms) <= 16


def test_a_program_is_whole_as_it_is_drawn():
    for k in range(40):
        program, types = sample(generator(1, "test-list", k), agenda(1, k).rooms)
        assert [r.id for r in complete(program).rooms] == list(types)


def test_programs_that_no_plan_meets_are_drawn_anew_and_at_last_an_error(monkeypatch):
    tries = []

    def refuse(program, seed):
        tries.append(seed)
        raise RefusedError("no plan", "another program")

    monkeypatch.setattr("pipeline.corpus.houses.planner.solve", refuse)
    with pytest.raises(ContentError, match="no house plan"):
        make_plan(generator(1, "test-plan", 0), agenda(1, 0).rooms)
    assert len(set(tries)) == len(tries) > 10
