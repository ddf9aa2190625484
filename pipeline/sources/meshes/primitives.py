"""Boxes, cylinders and spheres of URDF as triangle meshes."""

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.sources.meshes.mesh_solids import hull
from pipeline.sources.reasons import SourceError


def primitive(kind: str, values: tuple[float, ...], where: str) -> tuple[Floats, Ints]:
    """Return vertices (V, 3) and outward faces (F, 3) of a URDF primitive centred at the origin, a cylinder along z."""
    if min(values) <= 0:
        raise SourceError("bad_number", where, f"a {kind} of size {values}")
    if kind == "box":
        points = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * values
    elif kind == "cylinder":
        turn = np.arange(24) * (2 * np.pi / 24)
        ring = np.stack([np.cos(turn), np.sin(turn)], axis=1) * values[0]
        points = np.concatenate([np.column_stack([ring, np.full(24, z)]) for z in (-values[1] / 2, values[1] / 2)])
    else:
        k = np.arange(64) + 0.5
        polar, turn = np.arccos(1 - 2 * k / 64), np.pi * (1 + 5**0.5) * k
        points = np.stack([np.cos(turn) * np.sin(polar), np.sin(turn) * np.sin(polar), np.cos(polar)], axis=1) * values[0]
    convex = hull(points)
    assert convex is not None
    return convex[:2]
