"""Rings of staves in few sectors."""

from __future__ import annotations

import numpy as np

from pipeline.sources.meshes.mesh_solids import convex_part
from pipeline.sources.meshes.near_boxes import CORNERS
from pipeline.sources.meshes.rings import is_ring, sectors


def block(low, high):
    return convex_part(np.array(low) + CORNERS * (np.array(high, float) - np.array(low)), 1.0)


def ring(count, inner, outer, heights):
    made = []
    for k in range(count):
        a = 2 * np.pi * (k + np.array([0, 1])) / count
        flat = np.concatenate([r * np.stack([np.cos(a), np.sin(a)], axis=1) for r in (inner, outer)])
        made.append(convex_part(np.concatenate([np.column_stack([flat, np.full(4, z)]) for z in heights]), 1.0))
    return made


def test_columns_of_two_storeys_of_staves_are_sectors_together():
    staves = [*ring(24, 0.03, 0.04, (0, 0.05)), *ring(20, 0.03, 0.04, (0.05, 0.1))]
    floor, handle = block((-0.02, -0.02, 0), (0.02, 0.02, 0.01)), block((0.04, -0.005, 0.02), (0.06, 0.005, 0.08))
    found = sectors([*staves, floor, handle], lambda group: len(group) <= 11)
    assert sorted(k for group in found for k in group) == list(range(44))  # neither the floor nor the handle
    assert len(found) == 4


def test_where_columns_do_not_pass_each_storey_has_its_own():
    staves = [*ring(24, 0.03, 0.04, (0, 0.05)), *ring(24, 0.03, 0.04, (0.05, 0.1))]
    found = sectors(staves, lambda group: len({k // 24 for k in group}) == 1 and len(group) <= 6)
    assert len(found) == 8
    assert all(len({k // 24 for k in group}) == 1 for group in found)


def test_boards_of_a_box_are_no_ring():
    boards = [block((x, 0, 0), (x + 0.02, 1, 1)) for x in np.linspace(0, 1, 7)]
    assert not is_ring(boards, range(7))
    assert sectors(boards, lambda group: True) == []
