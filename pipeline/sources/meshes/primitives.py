"""Boxes, cylinders and spheres of URDF, and STL files, as triangle meshes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from pipeline.sources.meshes.obj_file import MAX_COORDINATE
from pipeline.sources.reasons import SourceError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MAX_STL = 64 << 20  # bytes
MAX_FACES = 500_000
_STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


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
    hull = ConvexHull(points)
    faces = hull.simplices.astype(np.int64)
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return points, faces


def parse_stl(data: bytes, where: str) -> tuple[Floats, Ints]:
    """Return vertices and faces of an STL file, binary or text. Raises SourceError `not_obj`, `bad_number` or `too_large`."""
    if data[:6].lstrip()[:5] == b"solid" and b"facet" in data[:1000]:
        corners = _text_corners(data, where)
    else:
        count = int.from_bytes(data[80:84], "little") if len(data) >= 84 else 0
        if count == 0 or len(data) < 84 + count * _STL.itemsize:
            raise SourceError("not_obj", where, "is no STL file, or truncated")
        if count > MAX_FACES:
            raise SourceError("too_large", where, f"has {count} faces")
        corners = np.frombuffer(data, _STL, count, 84)["corners"].astype(np.float64).reshape(-1, 3)
    if not np.isfinite(corners).all() or np.abs(corners).max() > MAX_COORDINATE:
        raise SourceError("bad_number", where, "has a number that is not finite, or absurd")
    return corners, np.arange(len(corners)).reshape(-1, 3)


def _text_corners(data: bytes, where: str) -> Floats:
    if not data.rstrip().splitlines()[-1].lstrip().startswith(b"endsolid"):
        raise SourceError("not_obj", where, "is a truncated STL file")
    words = [line.split() for line in data.splitlines() if line.lstrip().startswith(b"vertex")]
    if len(words) > 3 * MAX_FACES:
        raise SourceError("too_large", where, f"has {len(words)} vertices")
    try:
        corners = np.array([[float(v) for v in w[1:]] for w in words], np.float64)
    except ValueError as error:
        raise SourceError("not_obj", where, "has a vertex that is no three numbers") from error
    if not words or len(words) % 3 or corners.shape[1:] != (3,):
        raise SourceError("not_obj", where, "has no facets, or half of one")
    return corners
