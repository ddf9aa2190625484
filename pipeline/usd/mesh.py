"""Meshes: triangles with their extent and normals, smooth where a surface is curved, texture coordinates; boxes."""

import math

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Vt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from pipeline.entities.asset import Mesh
from pipeline.geometry.compiled import compiled
from pipeline.rendering.normals import smooth_normals
from pipeline.usd.layer import attribute, place, prim, vec3s

APART = 2e-5  # [m] between points of parts that meet


def convert_mesh(parent: Sdf.PrimSpec, name: str, mesh: Mesh, color: tuple[float, float, float] | None) -> Sdf.PrimSpec:
    """Write a mesh; `color` (linear) is for viewers that know no materials; None for what is not to be seen."""
    points, faces, uv = weld_vertices(mesh)
    smooth = smooth_normals(points.astype(np.float64), faces) if color is not None else None
    rows, faces = split_nonmanifold(points if uv is None else np.concatenate([points, uv], axis=1), faces)
    points, uv = rows[:, :3], None if uv is None else rows[:, 3:]
    spec = convert_polygons(parent, name, points, np.full(len(faces), 3, np.int32), faces.ravel(), color, smooth)
    if uv is not None:
        values, index = np.unique(uv, axis=0, return_inverse=True)
        st = attribute(spec, "primvars:st", "texCoord2f[]", Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(values, np.float32)))
        st.SetInfo("interpolation", "vertex")
        attribute(spec, "primvars:st:indices", "int[]", Vt.IntArray.FromNumpy(index.reshape(-1).astype(np.int32)))
    return spec


def weld_vertices(mesh: Mesh) -> tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.float32] | None]:
    """Return points (V, 3), faces (F, 3) and uv (V, 2) or None with corners that say the same said once, faces without an area left out."""
    points, faces = np.asarray(mesh.vertices, np.float32), np.asarray(mesh.faces, np.int32)
    rows = points if mesh.uv is None else np.concatenate([points, np.asarray(mesh.uv, np.float32)], axis=1)
    kept, index = np.unique(rows + np.float32(0), axis=0, return_inverse=True)
    if len(kept) == len(rows):
        kept = rows
    else:
        faces = index.reshape(-1).astype(np.int32)[faces]
        faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
        used, faces_flat = np.unique(faces, return_inverse=True)
        kept, faces = kept[used], faces_flat.reshape(-1, 3).astype(np.int32)
    return kept[:, :3], faces, None if mesh.uv is None else kept[:, 3:]


def split_nonmanifold(rows: NDArray[np.floating], faces: NDArray[np.int32]) -> tuple[NDArray[np.floating], NDArray[np.int32]]:
    """Return rows (V, 3 and more), points first, and faces (F, 3) so that every point has one fan of faces about it: a manifold.

    Boards of one mesh may meet in an edge or a corner. Each gets points of its own there, towards its own middle: the first by APART, every further
    one by as much again, for faces that lie on each other have one middle.
    """
    count = len(faces)
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    corner = np.arange(3 * count).reshape(count, 3)  # of each face; those that edges join between two faces are one point
    edge_corners = np.concatenate([corner[:, [0, 1]], corner[:, [1, 2]], corner[:, [2, 0]]])
    turned = ends[:, 0] > ends[:, 1]
    ends[turned], edge_corners[turned] = ends[turned][:, ::-1], edge_corners[turned][:, ::-1]
    code = ends[:, 0].astype(np.int64) * (int(faces.max(initial=0)) + 1) + ends[:, 1]
    order = np.argsort(code, kind="stable")
    _, first, times = np.unique(code[order], return_index=True, return_counts=True)
    one, other = order[first[times == 2]], order[first[times == 2] + 1]
    alike = turned[one] == turned[other]  # two boards' rims on each other: faces of one surface run along their edge both ways
    one, other = one[~alike], other[~alike]
    pairs = edge_corners[one].ravel(), edge_corners[other].ravel()
    fans, fan = connected_components(coo_array((np.ones(len(pairs[0]), np.int8), pairs), shape=(3 * count, 3 * count)), directed=False)
    if fans == len(np.unique(faces)):
        return rows, faces
    owner = np.zeros(fans, np.int64)
    owner[fan] = faces.ravel()
    split = np.bincount(owner, minlength=len(rows))[owner] > 1
    vertices = rows[owner]
    middle = np.stack([np.bincount(fan, np.repeat(rows[faces, k].mean(axis=1), 3)) for k in range(3)], axis=1) / np.bincount(fan)[:, None]
    away = middle - vertices[:, :3]
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-9)
    order = np.argsort(owner, kind="stable")
    turn = np.empty(fans)
    turn[order] = np.arange(1, fans + 1) - np.searchsorted(owner[order], owner[order])
    vertices[split, :3] += (APART * turn[split, None] * away[split]).astype(np.float32)
    return vertices, fan.reshape(count, 3).astype(np.int32)


def split_polygons(
    rows: NDArray[np.floating], counts: NDArray[np.int32], indices: NDArray[np.int32]
) -> tuple[NDArray[np.floating], NDArray[np.int32]]:
    """Return rows (V, 3 and more) and indices of convex polygons, corners per polygon, as `split_nonmanifold` does for triangles."""
    triangles = counts - 2
    first = np.repeat(np.cumsum(counts) - counts, triangles)  # corner of each polygon, from which its triangles fan out
    turn = np.arange(len(first)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    corners = np.stack([first, first + turn + 1, first + turn + 2], axis=1)
    rows, faces = split_nonmanifold(rows, indices[corners])
    split = np.empty_like(indices)
    split[corners] = faces
    return rows, split


def convert_box(parent: Sdf.PrimSpec, name: str, low: NDArray[np.floating], high: NDArray[np.floating]) -> Sdf.PrimSpec:
    """Write a box with sides along the axes as what engines know best, a scaled cube of side 1."""
    spec = prim(parent, name, "Cube")
    attribute(spec, "size", "double", 1.0)
    attribute(spec, "extent", "float3[]", vec3s(np.array([[-0.5] * 3, [0.5] * 3])))
    place(spec, ((low + high) / 2).tolist(), 0.0, (high - low).tolist())
    return spec


def convert_polygons(
    parent: Sdf.PrimSpec,
    name: str,
    points: NDArray[np.floating],
    counts: NDArray[np.int32],
    indices: NDArray[np.int32],
    color: tuple[float, float, float] | None,
    smooth: NDArray[np.floating] | None = None,
) -> Sdf.PrimSpec:
    """Write a polygon mesh: points (n, 3) [m], vertices per face, their indices; flat shaded, or with normals per corner."""
    spec = prim(parent, name, "Mesh")
    low, high = points.min(axis=0), points.max(axis=0)
    attribute(spec, "extent", "float3[]", vec3s(np.array([low, high])))
    attribute(spec, "faceVertexCounts", "int[]", Vt.IntArray.FromNumpy(np.ascontiguousarray(counts, np.int32)))
    attribute(spec, "faceVertexIndices", "int[]", Vt.IntArray.FromNumpy(np.ascontiguousarray(indices, np.int32)))
    attribute(spec, "points", "point3f[]", vec3s(points))
    attribute(spec, "subdivisionScheme", "token", "none", uniform=True)
    normals = flat_normals(points, counts, indices) if smooth is None else smooth
    attribute(spec, "normals", "normal3f[]", vec3s(normals)).SetInfo("interpolation", "uniform" if smooth is None else "faceVarying")
    if color is not None:
        attribute(spec, "primvars:displayColor", "color3f[]", vec3s(np.array([color]))).SetInfo("interpolation", "constant")
    return spec


def flat_normals(points: NDArray[np.floating], counts: NDArray[np.int32], indices: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return the unit normal (F, 3) of each polygon, by Newell's sum over its edges; upwards where it has no area."""
    return _normals(np.ascontiguousarray(points, np.float64), counts, indices)


@compiled
def _normals(points: NDArray[np.float64], counts: NDArray[np.int32], indices: NDArray[np.int32]) -> NDArray[np.float64]:
    normals = np.zeros((len(counts), 3))
    start = 0
    for f in range(len(counts)):
        first = points[indices[start]]
        x, y, z = 0.0, 0.0, 0.0
        for k in range(counts[f]):
            a, b = points[indices[start + k]], points[indices[start + (k + 1) % counts[f]]]
            ax, ay, az = a[0] - first[0], a[1] - first[1], a[2] - first[2]
            bx, by, bz = b[0] - first[0], b[1] - first[1], b[2] - first[2]
            x += ay * bz - az * by
            y += az * bx - ax * bz
            z += ax * by - ay * bx
        length = math.sqrt(x * x + y * y + z * z)
        if length > 1e-15:
            normals[f, 0], normals[f, 1], normals[f, 2] = x / length, y / length, z / length
        else:
            normals[f, 2] = 1.0
        start += counts[f]
    return normals
