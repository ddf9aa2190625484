"""Meshes: triangles with their extent and normals, smooth where a surface is curved, texture coordinates; boxes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Vt

from pipeline.entities.asset import Mesh
from pipeline.geometry.compiled import compiled
from pipeline.rendering.normals import smooth_normals
from pipeline.usd.layer import attribute, place, prim, vec3s


def convert_mesh(parent: Sdf.PrimSpec, name: str, mesh: Mesh, color: tuple[float, float, float] | None) -> Sdf.PrimSpec:
    """Write a mesh; `color` (linear) is for viewers that know no materials; None for what is not to be seen."""
    points, faces, uv = welded(mesh)
    smooth = smooth_normals(points.astype(np.float64), faces) if color is not None else None
    spec = convert_polygons(parent, name, points, np.full(len(faces), 3, np.int32), faces.ravel(), color, smooth)
    if uv is not None:
        values, index = np.unique(uv, axis=0, return_inverse=True)
        st = attribute(spec, "primvars:st", "texCoord2f[]", Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(values, np.float32)))
        st.SetInfo("interpolation", "vertex")
        attribute(spec, "primvars:st:indices", "int[]", Vt.IntArray.FromNumpy(index.reshape(-1).astype(np.int32)))
    return spec


def welded(mesh: Mesh) -> tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.float32] | None]:
    """Return points (V, 3), faces (F, 3) and uv (V, 2) or None with corners that say the same said once, faces without an area left out."""
    points, faces = np.asarray(mesh.vertices, np.float32), np.asarray(mesh.faces, np.int32)
    rows = points if mesh.uv is None else np.concatenate([points, np.asarray(mesh.uv, np.float32)], axis=1)
    kept, index = np.unique(rows + np.float32(0), axis=0, return_inverse=True)
    if len(kept) == len(rows):
        return points, faces, None if mesh.uv is None else rows[:, 3:]
    faces = index.reshape(-1).astype(np.int32)[faces]
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
    used, faces_flat = np.unique(faces, return_inverse=True)
    kept = kept[used]
    return kept[:, :3], faces_flat.reshape(-1, 3).astype(np.int32), None if mesh.uv is None else kept[:, 3:]


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
    found = np.zeros((len(counts), 3))
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
            found[f, 0], found[f, 1], found[f, 2] = x / length, y / length, z / length
        else:
            found[f, 2] = 1.0
        start += counts[f]
    return found
