"""Rooms that serve as several are cut into parts."""

import numpy as np
import pytest
import shapely

from pipeline.diffusion.context import RoomContext, RoomOpening
from pipeline.homes.parts import split_room

OBLONG = np.array([[0, 0], [6, 0], [6, 4], [0, 4.0]])
ANGLED = np.array([[0, 0], [7, 0], [7, 3], [4, 3], [4, 5], [0, 5.0]])
STUDIO = [("living_room", 12.0), ("bedroom", 10.0), ("kitchen", 6.5)]


def turned(polygon, yaw):
    c, s = np.cos(yaw), np.sin(yaw)
    return polygon @ np.array([[c, s], [-s, c]])


@pytest.mark.parametrize("polygon", [OBLONG, ANGLED, turned(OBLONG, 0.4)])
def test_parts_cover_the_room_by_their_shares(polygon):
    found = split_room(RoomContext("", polygon), STUDIO)
    assert [part.layout_type for part in found] == [kind for kind, _ in STUDIO]
    shapes = [shapely.Polygon(part.polygon) for part in found]
    whole = shapely.Polygon(polygon)
    assert shapely.union_all(shapes).symmetric_difference(whole).area < 1e-6
    assert sum(shape.area for shape in shapes) == pytest.approx(whole.area)
    for shape, (_, usual) in zip(shapes, STUDIO, strict=True):
        assert shape.area == pytest.approx(whole.area * usual / 28.5, rel=0.1)
        assert shape.exterior.is_ccw


def test_openings_go_to_the_part_that_they_open_and_parts_are_open_to_each_other():
    door = RoomOpening("door", np.array([[0, 1], [0, 1.9]]))
    window = RoomOpening("window", np.array([[6, 1], [6, 3.0]]), 0.9)
    living, sleeping = split_room(RoomContext("", OBLONG, (door, window)), STUDIO[:2])
    assert [o.kind for o in living.openings] == ["door", "open"]  # nobody sleeps at the door
    assert [o.kind for o in sleeping.openings] == ["window", "open"]
    assert np.array_equal(living.openings[-1].segment, sleeping.openings[-1].segment)
    assert shapely.LineString(living.openings[-1].segment).length == pytest.approx(4.0)


def test_a_room_of_one_use_is_its_only_part():
    (part,) = split_room(RoomContext("", OBLONG), STUDIO[:1])
    assert part.layout_type == "living_room"
    assert np.array_equal(part.polygon, OBLONG)


def test_a_cut_beside_a_corner_leaves_no_spike():
    """A studio whose second cut once ran along a spike of the first: planned for home 197 of seed 17."""
    outline = np.array([[0.118, 0.118], [6.882, 0.118], [6.882, 1.44], [5.689, 1.44], [5.689, 5.133], [0.118, 5.133]])
    doors = [
        RoomOpening("entrance", np.array([[0.218, -0.002], [1.118, -0.002]])),
        RoomOpening("door", np.array([[5.749, 4.233], [5.749, 5.033]])),
    ]
    windows = [RoomOpening("window", np.array([[a, y], [a + 2.4, y]]), 0.9) for a, y in ((2.3, -0.002), (1.703, 5.253))]
    found = split_room(RoomContext("", outline, (*doors, *windows)), [*STUDIO, ("dining_room", 6.0)])
    shapes = [shapely.Polygon(part.polygon) for part in found]
    assert len(shapes) == 4
    assert shapely.union_all(shapes).symmetric_difference(shapely.Polygon(outline)).area < 1e-5
    assert all(shape.is_valid and shape.buffer(-0.01).buffer(0.02).contains(shape) for shape in shapes)  # no spikes
