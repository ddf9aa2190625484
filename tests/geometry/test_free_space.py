import numpy as np
import pytest
import shapely

from pipeline.geometry.floor_raster import Raster, dilate, standing_cells
from pipeline.geometry.free_space import Floor, bare_floor, free_space, standing_room
from pipeline.geometry.prisms import join_prisms, prism
from tests.geometry.furniture import two_rooms

SQUARE = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]])


def test_fill_counts_cell_centres():
    raster = Raster.around([SQUARE], 0.05)
    rng = np.random.default_rng(0)
    for _ in range(20):
        ring = rng.uniform(0, 2, 2) + rng.uniform(0.2, 1) * np.stack([np.cos(t := np.sort(rng.uniform(0, 6.28, 7))), np.sin(t)], 1)
        mask = raster.fill(raster.empty(), [ring])
        x, y = np.meshgrid(*(raster.origin[k] + (np.arange(raster.shape[k]) + 0.5) * 0.05 for k in (0, 1)), indexing="ij")
        assert np.array_equal(mask, shapely.contains_xy(shapely.Polygon(ring), x, y))


def test_area_of_a_room_is_that_of_its_polygon():
    raster = Raster.around([SQUARE], 0.05)
    assert raster.area(raster.fill(raster.empty(), [SQUARE])) == pytest.approx(6.0)


def test_a_disc_stands_where_it_fits_and_covers_all_but_the_corners():
    raster = Raster.around([SQUARE], 0.05)
    free = raster.fill(raster.empty(), [SQUARE])
    centres = standing_cells(free, 0.25 / 0.05)
    assert raster.area(centres) == pytest.approx(2.5 * 1.5, rel=0.02)
    swept = dilate(centres, 5)
    assert not (swept & ~free).any()
    assert raster.area(swept) == pytest.approx(6.0 - (4 - np.pi) * 0.25**2, rel=0.01)
    assert not standing_cells(free, 100).any()


def test_parts_hang_together_edge_to_edge():
    mask = np.zeros((9, 9), bool)
    mask[0:2, 0:2] = mask[4:8, 4:8] = True
    mask[2, 2] = True  # only diagonal: another part
    space = standing_room(Floor(Raster(np.zeros(2), 1.0, mask.shape), np.zeros(mask.shape, np.int16), mask), mask, 0.0)
    assert np.bincount(space.labels.ravel()).tolist() == [81 - 21, 4, 1, 16]
    assert space.largest_label(mask) == 3


def test_a_door_joins_two_rooms_until_it_is_blocked():
    plan = two_rooms()
    floor = bare_floor(plan.rooms, plan.openings, 0.17, 0.05)
    nothing = join_prisms([])
    free = free_space(floor, nothing, 0.25, (0.02, 1.4))
    label = free.largest_label(floor.room == 0)
    assert (free.labels[floor.room == 1] == label).any()
    assert np.all(free.shares(free.swept_floor(label), 2) > 0.97)
    blocked = prism(np.array([[x, y, z] for x in (3.5, 3.9) for y in (0.2, 1.6) for z in (0, 1)]))
    cut = free_space(floor, blocked, 0.25, (0.02, 1.4))
    label = cut.largest_label(floor.room == 0)
    assert cut.shares(cut.swept_floor(label), 2)[1] == 0
    high = prism(np.array([[x, y, z] for x in (3.5, 3.9) for y in (0.2, 1.6) for z in (1.5, 2)]))
    assert np.array_equal(free_space(floor, high, 0.25, (0.02, 1.4)).labels, free.labels)
