"""Boards that nobody can touch, drawers being where they are: backs and rails behind fronts, sides along a drawer's own.

What a robot feels of a chest is its top, its fronts and their handles; whatever lies in a drawer is held by the drawer's boards.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import ConvexHull

from pipeline.entities.asset import Link
from pipeline.sources.articulated.shape import ShapeJoint
from pipeline.sources.meshes.mesh_solids import distances_outside
from pipeline.sources.meshes.reach import make_reach_test
from pipeline.sources.meshes.touching import LEFT_ALONE, TOUCHED, UP, sample_hull

DRAWER = "slider_drawer"
BESIDE = 0.025  # [m] between the outside of a carcass and the drawers in it, at its sides
SAMPLES = 12  # intervals along a side of a board's triangles
OFF = 0.002  # [m] before a surface
HAND = 0.01  # [m] gaps into which no hand comes


def without_hidden(links: Sequence[Link], joints: Sequence[ShapeJoint]) -> list[Link]:
    """Return the links, their colliders without boards that are not felt: shut drawers are, doors are not, for what is behind them is."""
    drawers = [joint for joint in joints if joint.part_class == DRAWER and joint.parent == 0]
    if not drawers:
        return list(links)
    return [without_covered(links[0], [links[joint.child] for joint in drawers]), *links[1:]]


def without_covered(base: Link, drawers: Sequence[Link]) -> Link:
    """Return a carcass without the boards whose outsides the other boards and the drawers all but have."""
    hulls = [np.asarray(c.vertices, np.float64) for link in (base, *drawers) for c in link.colliders]
    shapes = [ConvexHull(h) for h in hulls]
    planes = [shape.equations for shape in shapes]
    comes = make_reach_test(hulls, planes, HAND)
    kept = set(range(len(hulls)))
    boards = range(len(base.colliders))
    for k in sorted(boards, key=lambda k: (round(float(np.ptp(hulls[k], axis=0).prod()), 9), k)):
        at, normals = sample_hull(shapes[k], SAMPLES)
        felt = comes(at + OFF * normals)
        at, normals = at[felt], normals[felt]
        allowed = np.where(normals[:, 2] > UP, TOUCHED, np.where(normals[:, 2] < -UP, LEFT_ALONE, BESIDE))
        if (np.min([distances_outside(at, planes[i]) for i in kept - {k}], axis=0) <= allowed).all():
            kept.discard(k)
    return replace(base, colliders=tuple(base.colliders[k] for k in boards if k in kept))
