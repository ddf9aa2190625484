"""Bent things out of convex pieces: tubes along a path, bands in plan, curved boards, leaves. Lengths in metres.

Each bend is a chain of straight pieces whose ends are mitred, so that neighbours touch in a plane and none enters another.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.finishes import PROFILES
from pipeline.corpus.furniture.intervals import Interval, Spot
from pipeline.corpus.furniture.solids import Face, Solid, Vector, at_height, perpendicular, revolve, slab, stack

Points = NDArray[np.float64]


def arc(centre: Spot, radius: float, start: float, end: float, steps: int, squash: float = 1.0) -> Points:
    """Return points (steps + 1, 2) on a circle from angle `start` to `end` [rad]; `squash` scales the second axis."""
    angles = np.linspace(start, end, steps + 1)
    return np.stack([centre[0] + radius * np.cos(angles), centre[1] + radius * squash * np.sin(angles)], axis=1)


def curve(points: Sequence[Vector], steps: int = 4) -> Points:
    """Return a smooth path (m, d) through `points` (Catmull-Rom, `steps` pieces between neighbours)."""
    p = np.asarray(points, float)
    p = np.concatenate([2 * p[:1] - p[1:2], p, 2 * p[-1:] - p[-2:-1]])
    t = (np.arange(steps) / steps)[:, None]
    segments = []
    for a, b, c, d in zip(p[:-3], p[1:-2], p[2:-1], p[3:], strict=True):
        segments.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3))
    return np.concatenate([*segments, p[-2:-1]])


def _mitres(path: Points, closed: bool) -> tuple[Points, Points]:
    """Return the directions (m, d) of a path's segments and, per point, the normal of the plane in which they meet."""
    if closed:
        along = np.roll(path, -1, axis=0) - path
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        normals = along + np.roll(along, 1, axis=0)
    else:
        along = np.diff(path, axis=0)
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        normals = np.concatenate([along[:1], along[:-1] + along[1:], along[-1:]])
    return along, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def tube(path: Sequence[Vector] | Points, radius: float | Sequence[float] | Points, n: int = 8, *, closed: bool = False) -> list[Solid]:
    """Return a round bar of `n` facets along a path (m, 3) [m], one piece per segment; `radius` may differ from point to point."""
    p = np.asarray(path, float)
    radii = np.broadcast_to(np.asarray(radius, float), (len(p),))
    along, normals = _mitres(p, closed)
    angles = (np.arange(n) + 0.5) * (2 * np.pi / n)
    segments = []
    u = perpendicular(along[0])
    v = np.cross(along[0], u)
    for k, direction in enumerate(along):
        turned, slid = np.cross(v, direction), u - direction * float(u @ direction)  # carried along, so that the facets do not twist
        u = turned if np.linalg.norm(turned) > np.linalg.norm(slid) else slid
        u /= np.linalg.norm(u)
        v = np.cross(direction, u)
        spokes = np.cos(angles)[:, None] * u + np.sin(angles)[:, None] * v
        ends = []
        length = float(np.linalg.norm(p[(k + 1) % len(p)] - p[k]))
        for j in (k, (k + 1) % len(p)):
            ring = radii[j] * spokes
            slide = -(ring @ normals[j]) / float(direction @ normals[j])
            if np.abs(slide).max() > 0.45 * length:  # too sharp a bend for so short a piece: cut square
                slide = np.zeros(n)
            ends.append(p[j] + ring + slide[:, None] * direction)
        segments.append(split_bent_quads(stack(ends)))
    return segments


def wall(
    path: Points, thick: float, low: float, tops: float | Sequence[float] | Points, ease: float = 0.0, *, closed: bool = False
) -> list[Solid]:
    """Return an upright wall over a path in plan (m, 2), `thick` wide, half to each side: one piece per segment.

    Its top may rise and fall: `tops` [m], (m,) or one for all; `ease` rounds the upper edge.
    """
    left, right = _sides(path, thick, closed)
    tops = np.broadcast_to(np.asarray(tops, float), (len(path),))
    segments = []
    for i in range(len(path) if closed else len(path) - 1):
        j = (i + 1) % len(path)
        ring = np.array([right[i], right[j], left[j], left[i]])
        z = np.array([tops[i], tops[j], tops[j], tops[i]])
        rings = [at_height(ring, low), np.column_stack([ring, z - ease])]
        if ease > 0:
            centre = np.array([path[i], path[j], path[j], path[i]])
            rings.append(np.column_stack([centre + (ring - centre) * 0.72, z - 0.3 * ease]))
            rings.append(np.column_stack([centre + (ring - centre) * 0.3, z]))
        segments.append(split_bent_quads(stack(rings)))
    return segments


def _sides(path: Points, thick: float, closed: bool) -> tuple[Points, Points]:
    """Return the two edges of a strip `thick` wide over a path (m, 2), mitred."""
    along, normals = _mitres(path, closed)
    before = along if closed else np.concatenate([along, along[-1:]])
    side = np.stack([-normals[:, 1], normals[:, 0]], axis=1)
    stretch = 1 / np.maximum(np.einsum("ij,ij->i", before, normals), 0.3)
    offset = side * (stretch * thick / 2)[:, None]
    return path + offset, path - offset


def sheet(profile: Points, thick: float, width: float | Sequence[float] | Points) -> list[Solid]:
    """Return a bent board: a profile in (y, z) (m, 2), `thick`, across x; `width` may differ from point to point."""
    half = np.broadcast_to(np.asarray(width, float), (len(profile),)) / 2
    left, right = _sides(profile, thick, closed=False)
    corners = []
    for w, (y0, z0), (y1, z1) in zip(half, right, left, strict=True):
        corners.append(np.array([(-w, y1, z1), (w, y1, z1), (w, y0, z0), (-w, y0, z0)]))
    return [split_bent_quads(stack(ends)) for ends in itertools.pairwise(corners)]


def prism(outline: Points, axis: str, span: Interval, bevel: float = 0.0) -> Solid:
    """Return the board over a convex outline (n, 2), counter-clockwise, along an axis: x over (y, z), y over (x, z), z over (x, y)."""
    board = slab(outline, span[::-1] if axis == "y" else span, bevel)
    return Solid(board.vertices[:, {"x": [2, 0, 1], "y": [0, 2, 1], "z": [0, 1, 2]}[axis]], board.faces)


def split_bent_quads(solid: Solid) -> Solid:
    """Return the solid with quads that are not plane cut along the diagonal that keeps it convex."""
    v = solid.vertices
    faces: list[Face] = []
    for face in solid.faces:
        if len(face) == 4:
            a, b, c, d = v[list(face)]
            off = float(np.dot(np.cross(b - a, c - a), d - a))
            if abs(off) > 1e-12:
                i, j, k, m = face
                faces += [(i, j, k), (i, k, m)] if off < 0 else [(j, k, m), (j, m, i)]
                continue
        faces.append(face)
    return Solid(v, tuple(faces))


def lean(solids: Sequence[Solid], at: float, slope: float) -> list[Solid]:
    """Return the solids leaned back (to +y) by `slope` per height above `at` [m]; what is upright at that height stays where it is."""
    foot, shear = np.array([0.0, 0.0, at]), np.array([(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, slope, 1.0)])
    return [Solid((s.vertices - foot) @ shear + foot, s.faces) for s in solids]


def blades(roots: Points, tips: Points, width: Points | float, *, belly: float = 0.5, thick: float = 0.004, n: int = 8) -> list[Solid]:
    """Return leaves from `roots` (m, 3) to `tips` (m, 3): plane outlines, widest at the share `belly` of their length, faces upwards.

    `width` [m], (m,) or one for all. Each is a low double pyramid over its outline, so it is solid and convex. With `n` = 4 the
    outline is a kite.
    """
    axis = tips - roots
    length = np.linalg.norm(axis, axis=1, keepdims=True)
    forward = axis / length
    side = np.cross(forward, (0.0, 0.0, 1.0))
    flat = np.linalg.norm(side, axis=1, keepdims=True)
    side = np.where(flat > 1e-6, side / np.maximum(flat, 1e-9), np.array([1.0, 0.0, 0.0]))
    up = np.cross(side, forward)
    half = (np.broadcast_to(np.asarray(width, float), (len(roots),)) / 2)[:, None]
    if n == 4:
        stations = [(0.0, 0.0), (belly, 1.0), (1.0, 0.0), (belly, -1.0)]
    else:
        a, b = 0.45 * belly, belly + 0.62 * (1 - belly)
        stations = [(0.0, 0.0), (a, 0.74), (belly, 1.0), (b, 0.62), (1.0, 0.0), (b, -0.62), (belly, -1.0), (a, -0.74)]
    faces: tuple[Face, ...] = (*((i, (i + 1) % n, n) for i in range(n)), *(((i + 1) % n, i, n + 1) for i in range(n)))
    ring = [roots + axis * s + side * half * t for s, t in stations]
    middle = roots + axis * belly
    points = np.stack([*ring, middle + up * thick / 2, middle - up * thick / 2], axis=1)
    return [Solid(p, faces) for p in points]


def lathe(profile: str, radius: float, height: float, n: int = 20, centre: Spot = (0.0, 0.0), squash: float = 1.0) -> list[Solid]:
    """Return what is turned by a profile of manifests/furniture.yaml, whose numbers are shares of `radius` and `height` [m]."""
    return revolve([(r * radius, z * height) for r, z in PROFILES[profile]], n, centre, squash)


def turns(count: int, start: float = 0.0) -> list[float]:
    """Return `count` angles around a circle [rad]."""
    return [start + 2 * math.pi * k / count for k in range(count)]
