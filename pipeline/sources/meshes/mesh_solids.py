"""Triangle meshes as solids: connected parts, hulls, convexity, mass and inertia."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, QhullError

from pipeline.arrays import Bools, Floats, Ints

WELD = 1e-5  # share of the mesh's diagonal within which vertices are one
MAX_HULL = 64  # vertices; PhysX takes no more in one convex piece
LEFT_OUT = 1e-6  # [m] outside of a hull that is no further than its surface
SHEET = 0.001  # [m] half thickness given to a flat part
CLOSED = 4  # faces of a closed surface at least; two that are one drawn from both sides are none
SHELL = 0.008  # [m] thickness of an open surface, when its mass is estimated
COVER = 0.98  # share of a hull's surface that faces which do not close must cover to pass for it
MAX_COVER = 20_000  # faces for which that is looked at


@dataclass(frozen=True, slots=True)
class Part:
    """One connected part: its hull (vertices (V, 3), faces (F, 3) outwards), `fill` of that hull, `volume` [m3] of matter.

    `area` [m2] is that of its surface; `centre` (3,) and `inertia` (3, 3) about it are those of the hull at unit density.
    """

    hull: Floats
    faces: Ints
    hull_volume: float
    fill: float
    volume: float
    area: float
    centre: Floats
    inertia: Floats

    def scaled(self, shift: Floats, factor: float) -> Part:
        """Return the part moved by -`shift` (3,), then scaled by `factor`."""
        cubed = factor**3
        hull, centre = (self.hull - shift) * factor, (self.centre - shift) * factor
        measures = self.hull_volume * cubed, self.fill, self.volume * cubed, self.area * factor**2
        return Part(hull, self.faces, *measures, centre, self.inertia * cubed * factor**2)


def parts(vertices: Floats, faces: Ints) -> list[Part]:
    """Split a mesh [m] into connected parts, largest hull first; parts without extent are left out."""
    return [part for part, _, _ in parts_with_meshes(vertices, faces)]


def parts_with_meshes(vertices: Floats, faces: Ints) -> list[tuple[Part, Floats, Ints]]:
    """Return the parts as `parts` does, each with its own mesh (vertices (V, 3), faces (F, 3))."""
    dissection = [(part, points, triangles) for points, triangles in components(vertices, faces) if (part := _part(points, triangles))]
    return sorted(
        dissection, key=lambda m: (-round(m[0].hull_volume, 12), *m[0].hull.min(axis=0).round(6), *m[0].hull.max(axis=0).round(6))
    )


def combine_parts(pieces: Sequence[Part]) -> Part:
    """Return the hull of several parts as one; it holds their matter. Raises ValueError where they span no volume."""
    convex_hull = hull(np.concatenate([p.hull for p in pieces]))
    if convex_hull is None:
        msg = "the parts span no volume"
        raise ValueError(msg)
    return _filled(convex_hull, sum(p.volume for p in pieces), sum(p.area for p in pieces))


def convex_part(points: Floats, matter: float) -> Part | None:
    """Return the hull of points (N, 3) as a part that holds `matter` [m3] at most; None where they span nothing."""
    convex_hull = hull(points)
    if convex_hull is None or convex_hull[2] <= 0:
        return None
    return _filled(convex_hull, matter, surface(*convex_hull[:2]))


def _filled(convex_hull: tuple[Floats, Ints, float], matter: float, area: float) -> Part:
    """Return a hull as a part that holds `matter` [m3] at most."""
    corners, faces, volume = convex_hull
    inside = min(matter, volume)
    return Part(corners, faces, volume, inside / volume, inside, area, *_hull_moments(corners, faces))


def components(vertices: Floats, faces: Ints) -> list[tuple[Floats, Ints]]:
    """Return the connected parts as (vertices, faces), degenerate faces left out, vertices at the same place welded.

    What is closed by its own indices is a part, and so is what is closed by edges that just two faces share: boards that
    meet in a corner stay two. Only what is left hangs together by vertices.
    """
    if not len(faces):
        return []
    used, index = np.unique(faces, return_inverse=True)
    points, faces = vertices[used], index.reshape(faces.shape)
    pieces = []
    label = _owners(faces, len(points))[faces[:, 0]]
    whole = _whole(faces, label)
    if whole.any():
        pieces += [(points, block) for block in _split(faces[whole], label[whole])]
        faces = faces[~whole]
    if len(faces):
        points, faces = _weld_vertices(points, faces)
        label = _over_edges(faces)
        whole = _whole(faces, label)
        pieces += [(points, block) for block in _split(faces[whole], label[whole])]
        loose = _once(faces[~whole])
        pieces += [(points, block) for block in _split(loose, _owners(loose, len(points))[loose[:, 0]])]
    return [_compact(*part) for part in pieces]


def _weld_vertices(points: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """Return the mesh with vertices at the same place made one, without the faces that this makes degenerate."""
    span = float(np.linalg.norm(np.ptp(points, axis=0))) or 1.0
    # at most 2^20 cells a side: three fit in 63 bits
    x, y, z = np.minimum(np.round((points - points.min(axis=0)) / (span * WELD)).astype(np.int64), (1 << 20) - 1).T
    _, first, label = np.unique((x << 40) | (y << 20) | z, return_index=True, return_inverse=True)
    faces = label[faces]
    proper = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return points[first], faces[proper]


def _split(faces: Ints, label: Ints) -> list[Ints]:
    """Return the faces of each label (F,), labels in order."""
    if not len(faces):
        return []
    order = np.argsort(label, kind="stable")
    return np.split(faces[order], np.flatnonzero(np.diff(label[order])) + 1)


def _compact(points: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """Return the mesh without vertices that no face uses."""
    inside, index = np.unique(faces, return_inverse=True)
    return points[inside], index.reshape(faces.shape)


def _whole(faces: Ints, label: Ints) -> Bools:
    """Return (F,) whether the face's label is a closed surface: every edge of its faces used once in each direction."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    size = int(faces.max(initial=0)) + 1
    _, kind = np.unique(label, return_inverse=True)
    owner = np.concatenate([kind] * 3)
    there, back = edges[:, 0] * size + edges[:, 1], edges[:, 1] * size + edges[:, 0]
    order, turned = np.lexsort((there, owner)), np.lexsort((back, owner))
    there, back, owner = there[order], back[turned], owner[order]  # sorted within each label: a closed one matches row by row
    repeated = (there[1:] == there[:-1]) & (owner[1:] == owner[:-1])  # an edge that two faces use in the same direction
    open_labels = np.zeros(int(kind.max(initial=-1)) + 1, bool)
    open_labels[owner[there != back]] = True
    open_labels[owner[1:][repeated]] = True
    open_labels[np.bincount(kind) < CLOSED] = True
    return ~open_labels[kind]


def _over_edges(faces: Ints) -> Ints:
    """Return a label per face (F,), the same for faces that share an edge with nobody else."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(faces)), 3)
    code = edges[:, 0] * (int(faces.max(initial=0)) + 1) + edges[:, 1]
    order = np.argsort(code, kind="stable")
    _, first, count = np.unique(code[order], return_index=True, return_counts=True)
    pairs = first[count == 2]
    a, b = owner[order[pairs]], owner[order[pairs + 1]]
    return _labels(a, b, len(faces))


def _once(faces: Ints) -> Ints:
    """Return the faces without repetition: what is drawn from both sides would enclose nothing."""
    if len(faces) < 2:
        return faces
    a, b, c = np.sort(faces, axis=1).T
    count = int(c.max()) + 1
    if count >= 1 << 21:
        return faces
    _, first = np.unique((a * count + b) * count + c, return_index=True)
    return faces if len(first) == len(faces) else faces[np.sort(first)]


def _owners(faces: Ints, count: int) -> Ints:
    """Return a label per vertex (count,), the same for vertices that faces connect, in the order of their least index."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
    return _labels(edges[:, 0], edges[:, 1], count)


def _labels(a: Ints, b: Ints, count: int) -> Ints:
    """Return a label for each of `count` things, of which a (N,) and b (N,) are connected."""
    graph = coo_array((np.ones(len(a), bool), (a, b)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1])


def _part(points: Floats, faces: Ints) -> Part | None:
    if np.ptp(points, axis=0).max() < 1e-4:
        return None
    closed = _is_watertight(faces)
    inside = abs(signed_volume(points, faces)) if closed else 0.0
    convex_hull = _itself(points, faces, inside) if closed else None
    convex_hull = convex_hull or hull(points)
    if convex_hull is None:
        return None
    corners, hull_faces, hull_volume = convex_hull
    area = surface(points, faces)
    if not (closed and inside > 1e-12) and _covers(points, faces, corners, hull_faces, area):
        inside = hull_volume
    fill = inside / hull_volume if hull_volume > 0 else 0.0
    # An open sheet weighs what its surface does as a shell; nothing weighs more than its hull holds.
    matter = min(inside if inside > 1e-12 else area * SHELL, hull_volume)
    return Part(corners, hull_faces, hull_volume, fill, matter, area, *_hull_moments(corners, hull_faces))


def _covers(points: Floats, faces: Ints, corners: Floats, hull_faces: Ints, area: float) -> bool:
    """Whether the faces are the hull's surface, whichever way round they are: a solid but for cracks, or one flat sheet."""
    if len(faces) > MAX_COVER or area < COVER * surface(corners, hull_faces):
        return _flat(points)
    height, _ = _heights(points, faces, corners)
    span = float(np.ptp(points, axis=0).max())
    outside = np.minimum(height.max(axis=1), -height.min(axis=1))  # of each face: how far the hull reaches past it
    return float(outside.max()) < 1e-3 * span


def _flat(points: Floats) -> bool:
    """Whether all points lie in one plane."""
    away = points - points.mean(axis=0)
    spread = np.sqrt(np.maximum(np.linalg.eigvalsh(away.T @ away / len(away)), 0.0))
    return bool(spread[0] < 1e-4 * spread[2])


def _itself(points: Floats, faces: Ints, volume: float) -> tuple[Floats, Ints, float] | None:
    """Return a closed part as its own hull where no vertex lies outside any face's plane, else None."""
    if len(points) > MAX_HULL or volume < 1e-12:
        return None
    if signed_volume(points, faces) < 0:
        faces = faces[:, ::-1]
    height, areas = _heights(points, faces, points)
    span = float(np.ptp(points, axis=0).max())
    return (points, faces, volume) if areas.min() >= 1e-9 * span * span and height.max() < 1e-6 * span else None


def _heights(points: Floats, faces: Ints, corners: Floats) -> tuple[Floats, Floats]:
    """Return how far corners (V, 3) are above the planes of faces (F, 3), (F, V), and the faces' areas, doubled (F,)."""
    ways = normals(points, faces)
    lengths = np.sqrt((ways**2).sum(axis=1))
    height = ways @ corners.T - (ways * points[faces[:, 0]]).sum(axis=1)[:, None]
    return height / np.maximum(lengths, 1e-15)[:, None], lengths


def normals(points: Floats, faces: Ints) -> Floats:
    """Return the normals (F, 3) of triangles, each twice as long as its area."""
    a = points[faces[:, 0]]
    return cross(points[faces[:, 1]] - a, points[faces[:, 2]] - a)


def cross(a: Floats, b: Floats) -> Floats:
    """Return the cross products of rows (N, 3); np.cross takes several times as long on short arrays."""
    x, y, z = a.T
    u, v, w = b.T
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=1)


def hull(points: Floats) -> tuple[Floats, Ints, float] | None:
    """Return vertices, outward faces and volume of the convex hull with at most MAX_HULL vertices.

    A flat set gets a thickness of 2 SHEET across its plane. None where there is nothing to span.
    """
    qhull = qhull_of(points)
    if qhull is None:
        centre = points.mean(axis=0)
        axes = np.linalg.svd(points - centre, full_matrices=True)[2] if len(points) < 4096 else np.linalg.eigh(np.cov(points.T))[1].T[::-1]
        spans = np.ptp((points - centre) @ axes.T, axis=0)
        thick = points
        for axis, span in zip(axes, spans, strict=True):
            if span < 2 * SHEET:
                thick = np.concatenate([thick - SHEET * axis, thick + SHEET * axis])
        qhull = qhull_of(thick)
    if qhull is not None and len(qhull.vertices) > MAX_HULL:
        qhull = qhull_of(extremes(qhull.points[qhull.vertices]))
    if qhull is None:
        return None
    index = np.sort(qhull.vertices)
    where = np.full(len(qhull.points), -1)
    where[index] = np.arange(len(index))
    faces = where[qhull.simplices]
    corners = qhull.points[index]
    inward = np.einsum("ij,ij->i", normals(corners, faces), qhull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    order = np.lexsort(np.sort(faces, axis=1).T)
    return np.asarray(corners), faces[order], float(qhull.volume)


def qhull_of(points: Floats) -> ConvexHull | None:
    """Return the hull of points (N, 2 or 3), None where they span nothing."""
    try:
        return ConvexHull(points)
    except (QhullError, ValueError):
        return None


def distances_outside(points: Floats, planes: Floats) -> Floats:
    """Return how far points (P, 3) are outside of a convex piece, by the planes (F, 4) of its faces; negative within."""
    return np.asarray((points @ planes[:, :3].T + planes[:, 3]).max(axis=1))


def even_directions(count: int) -> Floats:
    """Return unit vectors (count, 3), evenly spread along a spiral."""
    k = np.arange(count) + 0.5
    polar, turn = np.arccos(1 - 2 * k / count), np.pi * (1 + 5**0.5) * k
    return np.stack([np.cos(turn) * np.sin(polar), np.sin(turn) * np.sin(polar), np.cos(polar)], axis=1)


def extremes(points: Floats, most: int = MAX_HULL) -> Floats:
    """Return at most so many of the points: those furthest along the axes and along evenly spread directions, then what their hull leaves out furthest."""
    directions = np.concatenate([np.eye(3), -np.eye(3), even_directions(most - 6)])
    chosen = np.unique(np.argmax(points @ directions.T, axis=0))
    while len(chosen) < most:
        further = _left_out(points, chosen)[: most - len(chosen)]
        if not len(further):
            break
        chosen = np.union1d(chosen, further)
    return np.asarray(points[chosen])


def _left_out(points: Floats, chosen: Ints) -> Ints:
    """Return of each face of the hull of chosen points the one that is furthest outside of it, the furthest of all first."""
    chosen_hull = qhull_of(points[chosen])
    if chosen_hull is None:
        return np.zeros(0, np.int64)
    away = points @ chosen_hull.equations[:, :3].T + chosen_hull.equations[:, 3]
    furthest = np.unique(np.argmax(away, axis=0))
    outside = away[furthest].max(axis=1)
    furthest, outside = furthest[outside > LEFT_OUT], outside[outside > LEFT_OUT]
    return np.asarray(furthest[np.lexsort((furthest, -outside.round(9)))])


def _is_watertight(faces: Ints) -> bool:
    """Return whether every edge is used once in each direction."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    size = int(faces.max()) + 1
    there, back = np.sort(edges[:, 0] * size + edges[:, 1]), np.sort(edges[:, 1] * size + edges[:, 0])
    return bool((there == back).all())


def surface(points: Floats, faces: Ints) -> float:
    """Return the area [m2] of a mesh."""
    return 0.5 * float(np.sqrt((normals(points, faces) ** 2).sum(axis=1)).sum())


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


def _hull_moments(points: Floats, faces: Ints) -> tuple[Floats, Floats]:
    """Return centroid and inertia at unit density about the centroid of a convex solid (sum of tetrahedra)."""
    origin = points.mean(axis=0)
    a, b, c = (points[faces[:, k]] - origin for k in range(3))
    det = (a * cross(b, c)).sum(axis=1)
    volume = float(det.sum() / 6)
    if volume <= 1e-15:
        return origin, np.zeros((3, 3))
    s = a + b + c
    centroid = (det[:, None] * s).sum(axis=0) / (24 * volume)
    second = sum((p.T @ (p * (det / 120)[:, None]) for p in (a, b, c, s)), np.zeros((3, 3)))  # integral of x x^T (Blow and Binstock 2004)
    second -= volume * np.outer(centroid, centroid)
    inertia = np.trace(second) * np.eye(3) - second
    return centroid + origin, inertia
