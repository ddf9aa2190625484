"""Houses drawn as real 3D-FRONT files are: every opening that a person sees, as wide as it is clear, and none besides."""

import pytest

from pipeline.sources.settings import FrontFilters
from pipeline.sources.threed_front.house import openings_of, rooms_of
from pipeline.sources.threed_front.house_file import parse_house
from tests.sources import front_houses

CLEAR = 0.03  # [m] by which a width may differ from what is clear


@pytest.mark.parametrize("name", front_houses.HOUSES)
def test_openings_are_those_that_a_person_sees(name):
    ways = front_houses.HOUSES[name]
    tree, truth = front_houses.house(name, ways)
    rejects = []
    house = parse_house(tree, name)
    rooms = rooms_of(house, FrontFilters(), rejects)
    types = {r.room_id: {v: k for k, v in ways.types.items()}.get(r.record.type, r.record.type) for r in rooms}
    found, (inner, outer) = openings_of(house, rooms, FrontFilters(), rejects)
    seen = [(o.kind, tuple(sorted(types[r] for r in o.rooms)), round(o.width, 3)) for o in found]
    missing, left = [], list(seen)
    for kind, joined, width in truth:
        match = next((s for s in left if s[0] == kind and s[1] == joined and abs(s[2] - width) <= CLEAR), None)
        if match is None:
            missing.append((kind, joined, width))
        else:
            left.remove(match)
    assert (missing, left) == ([], []), rejects
    assert all(o.height > 0.6 for o in found)
    assert inner == pytest.approx(0.12, abs=0.03)
    assert outer == pytest.approx(0.24, abs=0.03)
