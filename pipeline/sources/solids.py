"""Triangle meshes as solids: connected parts, hulls, convexity, mass and inertia."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

WELD = 1e-5  # share of the mesh's diagonal within which vertices are one
MAX_HULL = 64  # vertices; PhysX takes no more in one convex piece
SHEET = 0.001  # [m] half thickness given to a flat part
SHELL = 0.008  # [m] thickness of an open surface, when its mass is estimated


@dataclass(frozen=True, slots=True)
class Part:
    """One connected part: its hull (vertices (V, 3), faces (F, 3) outwards), `fill` of that hull, `volume` [m3] of matter.

    `centre` (3,) and `inertia` (3, 3) about it are those of the hull at unit density.
    """

    hull: Floats
    faces: Ints
    hull_volume: float
    fill: float
    volume: float
    centre: Floats
    inertia: Floats

    def scaled(self, shift: Floats, factor: float) -> Part:
        """Return the part moved by -`shift` (3,), then scaled by `factor`."""
        cubed = factor**3
        return Part(
            (self.hull - shift) * factor,
            self.faces,
            self.hull_volume * cubed,
            self.fill,
            self.volume * cubed,
            (self.centre - shift) * factor,
            self.inertia * cubed * factor**2,
        )


def parts(vertices: Floats, faces: Ints) -> list[Part]:
    """Split a mesh [m] into connected parts, largest hull first; parts without extent are left out."""
    made = []
    for points, triangles in components(vertices, faces):
        part = _part(points, triangles)
        if part:
            made.append(part)
    return sorted(made, key=lambda p: (-round(p.hull_volume, 12), *p.hull.min(axis=0).round(6), *p.hull.max(axis=0).round(6)))


def components(vertices: Floats, faces: Ints) -> list[tuple[Floats, Ints]]:
    """Return the connected parts as (vertices, faces), vertices at the same place welded, degenerate faces left out."""
    if not len(faces):
        return []
    used, index = np.unique(faces, return_inverse=True)
    points = vertices[used]
    span = float(np.linalg.norm(np.ptp(points, axis=0))) or 1.0
    grid = np.round((points - points.min(axis=0)) / (span * WELD)).astype(np.int64)
    _, first, label = np.unique(_hash(grid), return_index=True, return_inverse=True)
    points, faces = points[first], label[index.reshape(faces.shape)]
    proper = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    faces = faces[proper]
    if not len(faces):
        return []
    owner = _owners(faces, len(points))
    if (owner[faces[:, 0]] == owner[faces[0, 0]]).all():
        inside, compact = np.unique(faces, return_inverse=True)
        return [(points[inside], compact.reshape(faces.shape))]
    order = np.argsort(owner[faces[:, 0]], kind="stable")
    sorted_faces = faces[order]
    cuts = np.flatnonzero(np.diff(owner[sorted_faces[:, 0]])) + 1
    made = []
    for block in np.split(sorted_faces, cuts):
        inside, compact = np.unique(block, return_inverse=True)
        made.append((points[inside], compact.reshape(block.shape)))
    return made


def _owners(faces: Ints, count: int) -> Ints:
    """Return a label per vertex (count,), the same for vertices that faces connect: the least index of its part."""
    owner = np.arange(count)
    while True:
        least = owner[faces].min(axis=1)
        before = owner.copy()
        np.minimum.at(owner, faces.ravel(), np.repeat(least, 3))
        owner = owner[owner]
        if (owner == before).all():
            return owner


def _hash(grid: Ints) -> Ints:
    """Return one number per grid cell; the grid has at most 2^20 cells a side, so three fit in 63 bits."""
    low = np.minimum(grid, (1 << 20) - 1)
    return (low[:, 0] << 40) | (low[:, 1] << 20) | low[:, 2]


def _part(points: Floats, faces: Ints) -> Part | None:
    if np.ptp(points, axis=0).max() < 1e-4:
        return None
    closed = _closed(faces)
    inside = abs(signed_volume(points, faces)) if closed else 0.0
    made = _itself(points, faces, inside) if closed else None
    made = made or hull(points)
    if made is None:
        return None
    corners, hull_faces, hull_volume = made
    fill = inside / hull_volume if hull_volume > 0 else 0.0
    if closed and inside > 1e-12:
        matter = min(inside, hull_volume)
    else:  # an open sheet: what its surface weighs as a shell, but no more than its hull holds
        a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
        area = 0.5 * float(np.linalg.norm(cross(b - a, c - a), axis=1).sum())
        matter = min(hull_volume, area * SHELL)
    _, centre, inertia = _hull_moments(corners, hull_faces)
    return Part(corners, hull_faces, hull_volume, fill, matter, centre, inertia)


def _itself(points: Floats, faces: Ints, volume: float) -> tuple[Floats, Ints, float] | None:
    """Return a closed part as its own hull where no vertex lies outside any face's plane, else None."""
    if len(points) > MAX_HULL or volume < 1e-12:
        return None
    if signed_volume(points, faces) < 0:
        faces = faces[:, ::-1]
    a = points[faces[:, 0]]
    normals = cross(points[faces[:, 1]] - a, points[faces[:, 2]] - a)
    lengths = np.sqrt((normals**2).sum(axis=1))
    span = float(np.ptp(points, axis=0).max())
    if lengths.min() < 1e-9 * span * span:
        return None
    height = (normals @ points.T - (normals * a).sum(axis=1)[:, None]) / lengths[:, None]
    return (points, faces, volume) if height.max() < 1e-6 * span else None


def cross(a: Floats, b: Floats) -> Floats:
    """Return the cross products of rows (N, 3); np.cross takes several times as long on short arrays."""
    x, y, z = a.T
    u, v, w = b.T
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=1)


def hull(points: Floats) -> tuple[Floats, Ints, float] | None:
    """Return vertices, outward faces and volume of the convex hull with at most MAX_HULL vertices.

    A flat set gets a thickness of 2 SHEET across its plane. None where there is nothing to span.
    """
    try:
        found = ConvexHull(points)
    except (QhullError, ValueError):
        centre = points.mean(axis=0)
        axes = np.linalg.svd(points - centre, full_matrices=True)[2] if len(points) < 4096 else np.linalg.eigh(np.cov(points.T))[1].T[::-1]
        spans = np.ptp((points - centre) @ axes.T, axis=0)
        thick = points
        for axis, span in zip(axes, spans, strict=True):
            if span < 2 * SHEET:
                thick = np.concatenate([thick - SHEET * axis, thick + SHEET * axis])
        try:
            found = ConvexHull(thick)
        except (QhullError, ValueError):
            return None
    if len(found.vertices) > MAX_HULL:
        chosen = _extremes(found.points[found.vertices])
        try:
            found = ConvexHull(chosen)
        except QhullError:
            return None
    index = np.sort(found.vertices)
    where = np.full(len(found.points), -1)
    where[index] = np.arange(len(index))
    faces = where[found.simplices]
    corners = found.points[index]
    a, b, c = corners[faces[:, 0]], corners[faces[:, 1]], corners[faces[:, 2]]
    inward = np.einsum("ij,ij->i", cross(b - a, c - a), found.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    order = np.lexsort(np.sort(faces, axis=1).T)
    return np.asarray(corners), faces[order], float(found.volume)


def _extremes(points: Floats) -> Floats:
    """Return at most MAX_HULL of the points: those furthest along the axes and along evenly spread directions."""
    k = np.arange(MAX_HULL - 6) + 0.5
    polar, turn = np.arccos(1 - 2 * k / (MAX_HULL - 6)), np.pi * (1 + 5**0.5) * k
    directions = np.stack([np.cos(turn) * np.sin(polar), np.sin(turn) * np.sin(polar), np.cos(polar)], axis=1)
    directions = np.concatenate([np.eye(3), -np.eye(3), directions])
    return np.asarray(points[np.unique(np.argmax(points @ directions.T, axis=0))])


def _closed(faces: Ints) -> bool:
    """Return whether every edge is used once in each direction."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    size = int(faces.max()) + 1
    there, back = np.sort(edges[:, 0] * size + edges[:, 1]), np.sort(edges[:, 1] * size + edges[:, 0])
    return bool((there == back).all())


def signed_volume(points: Floats, faces: Ints) -> float:
    """Return the volume that a closed mesh encloses, positive for outward faces (divergence theorem)."""
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    return float((a * cross(b, c)).sum() / 6)


def mass_properties(solids: list[tuple[Part, float]]) -> tuple[float, Floats, Floats]:
    """Return mass [kg], centre of mass (3,) [m] and inertia (3, 3) [kg m2] about it of (part, density [kg/m3]) pairs.

    Each part's mass is its volume of matter times density, spread evenly over its hull: a simplification that keeps
    the inertia positive definite whatever the mesh is like.
    """
    masses, centres, inertias = [], [], []
    for part, density in solids:
        if part.hull_volume <= 0:
            continue
        mass = part.volume * density
        masses.append(mass)
        centres.append(part.centre)
        inertias.append(part.inertia * (mass / part.hull_volume))
    total = float(sum(masses))
    if total <= 0:
        return 0.0, np.zeros(3), np.eye(3) * 1e-6
    middle = np.einsum("i,ij->j", masses, np.array(centres)) / total
    whole = np.zeros((3, 3))
    for mass, centre, inertia in zip(masses, centres, inertias, strict=True):
        r = centre - middle
        whole += inertia + mass * (float(r @ r) * np.eye(3) - np.outer(r, r))
    return total, middle, (whole + whole.T) / 2


def _hull_moments(points: Floats, faces: Ints) -> tuple[float, Floats, Floats]:
    """Return volume, centroid and inertia at unit density about the centroid of a convex solid (sum of tetrahedra)."""
    origin = points.mean(axis=0)
    a, b, c = (points[faces[:, k]] - origin for k in range(3))
    det = (a * cross(b, c)).sum(axis=1)
    volume = float(det.sum() / 6)
    if volume <= 1e-15:
        return 0.0, origin, np.zeros((3, 3))
    s = a + b + c
    centroid = (det[:, None] * s).sum(axis=0) / (24 * volume)
    second = sum((p.T @ (p * (det / 120)[:, None]) for p in (a, b, c, s)), np.zeros((3, 3)))  # integral of x x^T (Blow and Binstock 2004)
    second -= volume * np.outer(centroid, centroid)
    inertia = np.trace(second) * np.eye(3) - second
    return volume, centroid + origin, inertia
