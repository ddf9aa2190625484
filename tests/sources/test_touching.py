"""Colliders become fewer and plainer, and are felt for the same."""

from __future__ import annotations

import numpy as np

from pipeline.sources.meshes.mesh_solids import convex
from pipeline.sources.meshes.near_boxes import CORNERS
from pipeline.sources.meshes.touching import fewer, simpler


def block(low, high):
    return convex(np.array(low) + CORNERS * (np.array(high, float) - np.array(low)), 1.0)


def ring(count, inner, outer, height):
    """The staves of a cup without a floor."""
    made = []
    for k in range(count):
        a = 2 * np.pi * (k + np.array([0, 1])) / count
        flat = np.concatenate([r * np.stack([np.cos(a), np.sin(a)], axis=1) for r in (inner, outer)])
        made.append(convex(np.concatenate([np.column_stack([flat, np.full(4, z)]) for z in (0, height)]), 1.0))
    return made


def test_a_ring_has_fewer_staves_and_stays_hollow():
    staves = ring(40, 0.036, 0.04, 0.09)
    found = fewer(staves, 0.005)
    assert 4 < len(found) <= 12
    for piece in found:  # no point of a face is further inwards than the tolerance
        faces = piece.hull[piece.faces]
        middle = faces.mean(axis=1)
        assert np.linalg.norm(middle[:, :2], axis=1).min() > 0.036 * np.cos(np.pi / 40) - 0.005


def test_boards_of_a_box_stay_apart_and_those_in_line_become_one():
    side, floor = block((0, 0, 0), (0.02, 0.4, 0.5)), block((0.02, 0, 0), (0.5, 0.4, 0.02))
    assert len(fewer([side, floor], 0.005)) == 2
    assert len(fewer([floor, block((0.5, 0, 0), (0.9, 0.4, 0.02))], 0.005)) == 1


def test_what_is_small_is_changed_less():
    thin = [block((0, 0, 0), (0.1, 0.1, 0.004)), block((0.02, 0.02, 0.004), (0.03, 0.03, 0.007))]
    assert len(simpler(thin, 0.005)) == 2
    assert len(simpler(thin, 0.03)) == 1
