"""Convex solids: polyhedra with outward faces, from which all furniture is made. Lengths in metres."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from pipeline.corpus.furniture.intervals import Interval

Face = tuple[int, ...]
Vector = Sequence[float] | NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Topology:
    """Index arrays of a list of faces: all `corners` (C,) in a row, each face's `lengths` and `starts` (F,), and `triangles` (T, 3).

    `following` (C,) is the place in `corners` of each corner's successor around its face.
    """

    corners: NDArray[np.int64]
    lengths: NDArray[np.int64]
    starts: NDArray[np.int64]
    following: NDArray[np.int64]
    triangles: NDArray[np.int32]


@functools.lru_cache(maxsize=8192)
def topology(faces: tuple[Face, ...]) -> Topology:
    """Return the index arrays of faces; most solids share theirs with others, so they are made once."""
    corners = np.array([v for face in faces for v in face], np.int64)
    lengths = np.array([len(face) for face in faces], np.int64)
    starts = np.concatenate([[0], np.cumsum(lengths)[:-1]])
    following = np.arange(1, len(corners) + 1)
    following[starts + lengths - 1] = starts
    triangles = np.array([(f[0], f[i], f[i + 1]) for f in faces for i in range(1, len(f) - 1)], np.int32)
    return Topology(corners, lengths, starts, following, triangles)


@dataclass(frozen=True, slots=True)
class Solid:
    """A convex polyhedron. `vertices` (V, 3) [m]; `faces` are polygons, counter-clockwise seen from outside."""

    vertices: NDArray[np.float64]
    faces: tuple[Face, ...]

    def triangles(self) -> NDArray[np.int32]:
        """Return the faces cut into fans of triangles (F, 3)."""
        return topology(self.faces).triangles

    def volume(self) -> float:
        """Return the volume [m3], by signed tetrahedra."""
        a, b, c = (self.vertices[self.triangles()[:, k]] for k in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)

    def bounds(self) -> NDArray[np.float64]:
        """Return the lower and upper corner (2, 3)."""
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    def translate(self, offset: Vector) -> Solid:
        """Return the solid translated by `offset` (3,)."""
        return Solid(self.vertices + np.asarray(offset, float), self.faces)

    def scale(self, factors: NDArray[np.float64]) -> Solid:
        """Return the solid scaled per axis by positive `factors` (3,) about the origin."""
        return Solid(self.vertices * factors, self.faces)

    def rotate(self, axis: str, angle: float, about: Vector = (0.0, 0.0, 0.0)) -> Solid:
        """Return the solid rotated by `angle` [rad], right-handed, about the `axis` (x, y or z) through a point."""
        c, s = math.cos(angle), math.sin(angle)
        i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
        R = np.eye(3)
        R[i, i], R[i, j], R[j, i], R[j, j] = c, -s, s, c
        pivot = np.asarray(about, float)
        return Solid((self.vertices - pivot) @ R.T + pivot, self.faces)

    def mirror(self) -> Solid:
        """Return the mirror image in x, faces turned so that they still look outwards."""
        return Solid(self.vertices * np.array([-1.0, 1.0, 1.0]), tuple(f[::-1] for f in self.faces))


def merge_solids(solids: Sequence[Solid]) -> tuple[NDArray[np.float64], Topology]:
    """Return the solids as one: their vertices (V, 3) in a row, and the index arrays of all their faces."""
    shared = [topology(solid.faces) for solid in solids]
    vertices = np.concatenate([solid.vertices for solid in solids])
    first, corner = (np.cumsum([0, *counts])[:-1] for counts in ([len(s.vertices) for s in solids], [len(t.corners) for t in shared]))
    return vertices, Topology(
        np.concatenate([t.corners + k for t, k in zip(shared, first, strict=True)]),
        np.concatenate([t.lengths for t in shared]),
        np.concatenate([t.starts + k for t, k in zip(shared, corner, strict=True)]),
        np.concatenate([t.following + k for t, k in zip(shared, corner, strict=True)]),
        np.concatenate([t.triangles + np.int32(k) for t, k in zip(shared, first, strict=True)]),
    )


def normals(vertices: NDArray[np.float64], faces: Topology) -> NDArray[np.float64]:
    """Return the unit normal of each face (F, 3), by Newell's sum over its edges."""
    p = vertices[faces.corners] - vertices[faces.corners[faces.starts]].repeat(faces.lengths, axis=0)
    q = p[faces.following]
    crossed = np.stack([p[:, i] * q[:, j] - p[:, j] * q[:, i] for i, j in ((1, 2), (2, 0), (0, 1))], axis=1)
    sums = np.add.reduceat(crossed, faces.starts, axis=0)
    return np.asarray(sums / np.maximum(np.sqrt((sums**2).sum(axis=1, keepdims=True)), 1e-30))


def stack(rings: Sequence[NDArray[np.float64]]) -> Solid:
    """Return the solid between rings (n, 3) of equal length, counter-clockwise seen from the last ring's side.

    It is convex where corresponding edges are parallel and the profile over the rings is concave.
    """
    return Solid(np.concatenate(rings), _stack_faces(len(rings[0]), len(rings)))


@functools.cache
def _stack_faces(n: int, rings: int) -> tuple[Face, ...]:
    """Return the faces of a stack: the two ends, then quads between neighbouring rings of `n` corners."""
    faces: list[Face] = [tuple(range(n - 1, -1, -1)), tuple(range((rings - 1) * n, rings * n))]
    for k in range(rings - 1):
        a, b = k * n, (k + 1) * n
        faces += [(a + i, a + (i + 1) % n, b + (i + 1) % n, b + i) for i in range(n)]
    return tuple(faces)


def stand_up(solids: Iterable[Solid], at: Vector) -> list[Solid]:
    """Return solids made lying about the origin, turned upright to face the front (-y), what was the origin now `at` (3,)."""
    return [s.rotate("x", math.pi / 2).translate(at) for s in solids]


def box(x: Interval, y: Interval, z: Interval, bevel: float = 0.0) -> Solid:
    """Return the box over three intervals; a positive `bevel` [m] cuts its twelve edges at 45 degrees."""
    bevel = min(bevel, 0.3 * min(x[1] - x[0], y[1] - y[0], z[1] - z[0]))
    if bevel <= 0:
        ring = np.array([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])])
        return stack([at_height(ring, z[0]), at_height(ring, z[1])])
    rings = []
    for height, inset in ((z[0], bevel), (z[0] + bevel, 0.0), (z[1] - bevel, 0.0), (z[1], bevel)):
        x0, x1, y0, y1 = x[0] + inset, x[1] - inset, y[0] + inset, y[1] - inset
        b = bevel * (1 - 0.5 * (inset > 0))  # so that the edges keep their directions
        octagon = [(x0 + b, y0), (x1 - b, y0), (x1, y0 + b), (x1, y1 - b), (x1 - b, y1), (x0 + b, y1), (x0, y1 - b), (x0, y0 + b)]
        rings.append(at_height(np.array(octagon), height))
    return stack(rings)


def strips(x: Interval, y: Interval, hole_x: Interval, hole_y: Interval, z: Interval, bevel: float = 0.0) -> list[Solid]:
    """Return four boxes over `z` around a hole in the rectangle `x`, `y`: those at its sides take all of `y`."""
    spans = [((x[0], hole_x[0]), y), ((hole_x[1], x[1]), y), (hole_x, (y[0], hole_y[0])), (hole_x, (hole_y[1], y[1]))]
    return [box(a, b, z, bevel) for a, b in spans]


def walls(x: Interval, y: Interval, z: Interval, t: float, bevel: float = 0.0) -> list[Solid]:
    """Return four walls of thickness `t` [m] along the inside of the rectangle `x`, `y`."""
    return strips(x, y, (x[0] + t, x[1] - t), (y[0] + t, y[1] - t), z, bevel)


def cushion(x: Interval, y: Interval, z: Interval, radius: float, steps: int = 2, crown: float = 0.0) -> Solid:
    """Return a box whose edges and corners are rounded with `radius` [m], `steps` facets to the quarter turn.

    With a `crown` [m] the top swells towards its middle by that much; the box stays within `z`.
    """
    across = min(x[1] - x[0], y[1] - y[0])
    radius = min(radius, 0.49 * min(across, z[1] - z[0] - crown))
    high = z[1] - min(crown, 0.18 * (0.5 * across - 0.8 * radius))  # a steeper crown would not be convex
    crown = z[1] - high
    turn, rise, top = _quarter(steps)
    middle_x, middle_y = (x[0] + x[1]) / 2, (y[0] + y[1]) / 2
    corner_x = np.repeat([x[1] - radius, x[0] + radius, x[0] + radius, x[1] - radius], steps + 1) - middle_x
    corner_y = np.repeat([y[1] - radius, y[1] - radius, y[0] + radius, y[0] + radius], steps + 1) - middle_y
    levels = [(-p, z[0] + radius) for p in rise[::-1]] + [(p, high - radius) for p in rise]
    rings = []
    for phi, base in levels:
        r, height = radius * math.cos(phi), base + radius * math.sin(phi) / top
        rings.append(np.stack([corner_x + r * turn[0], corner_y + r * turn[1], np.full(turn.shape[1], height)], axis=1))
    for share, scale in ((0.42, 0.82), (0.8, 0.52), (1.0, 0.2)) if crown > 0 else ():
        ring = rings[len(levels) - 1] * np.array([scale, scale, 1.0])
        ring[:, 2] = high + share * crown
        rings.append(ring)
    return stack([ring + np.array([middle_x, middle_y, 0.0]) for ring in rings])


@functools.cache
def _quarter(steps: int) -> tuple[NDArray[np.float64], list[float], float]:
    """Return directions around a rounded rectangle (2, 4 steps + 4), the angles of its rounding, and the sine of the last.

    The poles are cut flat, so that no facet degenerates.
    """
    angles = np.concatenate([q * np.pi / 2 + np.linspace(0, np.pi / 2, steps + 1) for q in range(4)])
    last = math.pi / 2 * (1 - 0.5 / (steps + 1))
    return np.stack([np.cos(angles), np.sin(angles)]), np.linspace(0, last, steps + 1).tolist(), math.sin(last)


def pillow(x: Interval, y: Interval, z: Interval, steps: int = 2) -> Solid:
    """Return a throw pillow: two domes that meet in a sharp seam around a rectangle with soft corners."""
    outline = rounded_rectangle((x[0], x[1]), (y[0], y[1]), 0.22 * min(x[1] - x[0], y[1] - y[0]), steps)
    centre, middle, half = np.array([(x[0] + x[1]) / 2, (y[0] + y[1]) / 2]), (z[0] + z[1]) / 2, (z[1] - z[0]) / 2
    rings = []
    for height, scale in ((-1, 0.34), (-0.82, 0.66), (-0.45, 0.88), (0, 1), (0.45, 0.88), (0.82, 0.66), (1, 0.34)):
        rings.append(at_height(centre + (outline - centre) * scale, middle + half * height))
    return stack(rings)


def slab(outline: NDArray[np.float64], z: Interval, bevel: float = 0.0) -> Solid:
    """Return the prism over a convex outline (n, 2), counter-clockwise; `bevel` draws its rims in by a scaling."""
    centre = outline.mean(axis=0)
    reach = float(np.abs(outline - centre).max())
    inner = centre + (outline - centre) * (1 - bevel / reach)
    if bevel <= 0:
        return stack([at_height(outline, z[0]), at_height(outline, z[1])])
    return stack([at_height(inner, z[0]), at_height(outline, z[0] + bevel), at_height(outline, z[1] - bevel), at_height(inner, z[1])])


def board(x: Interval, y: Interval, z: Interval, radius: float, steps: int, bevel: float = 0.0) -> Solid:
    """Return a level board over a rectangle whose corners are rounded with `radius`, its rims eased by `bevel` [m]."""
    return slab(rounded_rectangle(x, y, radius, steps), z, bevel)


def circle(radius: float, n: int = 20, centre: Interval = (0.0, 0.0), squash: float = 1.0) -> NDArray[np.float64]:
    """Return a regular polygon (n, 2) that touches its box on both axes (n a multiple of 4); `squash` scales y."""
    angles = np.arange(n) * (2 * np.pi / n)
    return np.stack([centre[0] + radius * np.cos(angles), centre[1] + radius * squash * np.sin(angles)], axis=1)


def rounded_rectangle(x: Interval, y: Interval, radius: float, steps: int = 4) -> NDArray[np.float64]:
    """Return a rectangle's outline with rounded corners (4 * steps + 4, 2), counter-clockwise."""
    radius = min(radius, 0.499 * min(x[1] - x[0], y[1] - y[0]))
    points = []
    for q, (cx, cy) in enumerate(((x[1], y[1]), (x[0], y[1]), (x[0], y[0]), (x[1], y[0]))):
        ox = cx - math.copysign(radius, cx - (x[0] + x[1]) / 2)
        oy = cy - math.copysign(radius, cy - (y[0] + y[1]) / 2)
        turn = np.linspace(0, math.pi / 2, steps + 1) + q * math.pi / 2
        points += [(ox + radius * math.cos(t), oy + radius * math.sin(t)) for t in turn]
    return np.array(points)


def perpendicular(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a unit vector (3,) at right angles to another."""
    u = np.cross(direction, (1.0, 0.0, 0.0) if abs(direction[0]) < 0.9 else (0.0, 1.0, 0.0))
    return np.asarray(u / np.linalg.norm(u))


def rod(start: Vector, end: Vector, radius: float, end_radius: float | None = None, n: int = 8) -> Solid:
    """Return a (tapered) round bar between two points."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    direction = (b - a) / np.linalg.norm(b - a)
    u = perpendicular(direction)
    v = np.cross(direction, u)
    angles = (np.arange(n) + 0.5) * (2 * np.pi / n)
    ring = np.cos(angles)[:, None] * u + np.sin(angles)[:, None] * v
    return stack([a + radius * ring, b + (radius if end_radius is None else end_radius) * ring])


def beam(start: Vector, end: Vector, width: float, depth: float, taper: float = 1.0) -> Solid:
    """Return a bar of horizontal rectangular section (`width` along x, `depth` along y), raked from `start` up to `end`."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    section = np.array([(-width, -depth), (width, -depth), (width, depth), (-width, depth)]) / 2
    ring = np.concatenate([section, np.zeros((4, 1))], axis=1)
    return stack([a + ring * taper, b + ring])


def revolve(profile: Sequence[Interval], n: int = 20, centre: Interval = (0.0, 0.0), squash: float = 1.0) -> list[Solid]:
    """Return solids of revolution about a vertical axis: `profile` lists (radius, height) upwards; `squash` scales y.

    Convex runs of the profile become one solid each, so that every piece is convex.
    """
    runs: list[list[Interval]] = [[profile[0], profile[1]]]
    for point in profile[2:]:
        (r0, z0), (r1, z1) = runs[-1][-2:]
        if (r1 - r0) * (point[1] - z1) >= (point[0] - r1) * (z1 - z0) - 1e-12:
            runs[-1].append(point)
        else:
            runs.append([runs[-1][-1], point])
    solids = [stack([at_height(circle(max(r, 1e-3), n, centre), z) for r, z in run]) for run in runs]
    return solids if squash == 1 else [s.scale(np.array([1.0, squash, 1.0])) for s in solids]


def shell(outer: Sequence[NDArray[np.float64]], inner: Sequence[NDArray[np.float64]]) -> list[Solid]:
    """Return the wall between two outlines, each given at its lower and its upper end (n, 3), as n convex staves."""
    n = len(outer[0])
    staves = []
    for i in range(n):
        j = (i + 1) % n
        low = np.array([outer[0][i], outer[0][j], inner[0][j], inner[0][i]])
        high = np.array([outer[1][i], outer[1][j], inner[1][j], inner[1][i]])
        staves.append(stack([low, high]))
    return staves


def ring(outer: Interval, inner: Interval, z: Interval, n: int = 16, centre: Interval = (0.0, 0.0), squash: float = 1.0) -> list[Solid]:
    """Return a round wall with radii (at the bottom, at the top) `outer` and `inner`, as n staves; `squash` scales y."""
    rims = [[at_height(circle(r[k], n, centre, squash), z[k]) for k in (0, 1)] for r in (outer, inner)]
    return shell(rims[0], rims[1])


def hull(points: NDArray[np.float64]) -> Solid:
    """Return the convex hull of `points` (n, 3)."""
    qhull = ConvexHull(points)
    keep, corners = np.unique(qhull.simplices, return_inverse=True)
    corners = corners.reshape(qhull.simplices.shape)
    kept = points[keep]
    a, b, c = (kept[corners[:, k]] for k in range(3))
    inwards = np.linalg.det(np.stack([b - a, c - a, qhull.equations[:, :3]], axis=1)) < 0
    corners[inwards] = corners[inwards][:, ::-1]
    return Solid(kept, tuple(map(tuple, corners.tolist())))


def at_height(outline: NDArray[np.float64], height: float) -> NDArray[np.float64]:
    """Return an outline (n, 2) as points (n, 3) at one height [m]."""
    return np.concatenate([outline, np.full((len(outline), 1), height)], axis=1)
