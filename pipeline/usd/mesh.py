"""Meshes: triangles with their extent, smooth normals where a surface is curved, texture coordinates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Vt

from pipeline.entities.asset import Mesh
from pipeline.usd.layer import attribute, prim, vec3s

CREASE = np.cos(np.radians(40.0))  # faces that meet at less than this angle are shaded as one surface


def convert_mesh(parent: Sdf.PrimSpec, name: str, mesh: Mesh, color: tuple[float, float, float] | None) -> Sdf.PrimSpec:
    """Write a mesh; `color` (linear) is for viewers that know no materials; None for what is not to be seen."""
    faces = np.asarray(mesh.faces, np.int32)
    spec = convert_polygons(parent, name, mesh.vertices, np.full(len(faces), 3, np.int32), faces.ravel(), color)
    if color is not None:
        normals = smooth_normals(np.asarray(mesh.vertices, np.float64), faces)
        if normals is not None:
            attribute(spec, "normals", "normal3f[]", vec3s(normals)).SetInfo("interpolation", "faceVarying")
    if mesh.uv is not None:
        uv = Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(mesh.uv, np.float32))
        attribute(spec, "primvars:st", "texCoord2f[]", uv).SetInfo("interpolation", "vertex")
    return spec


def convert_polygons(
    parent: Sdf.PrimSpec,
    name: str,
    points: NDArray[np.floating],
    counts: NDArray[np.int32],
    indices: NDArray[np.int32],
    color: tuple[float, float, float] | None,
) -> Sdf.PrimSpec:
    """Write a polygon mesh: points (n, 3) [m], vertices per face, their indices; flat shaded."""
    spec = prim(parent, name, "Mesh")
    low, high = points.min(axis=0), points.max(axis=0)
    attribute(spec, "extent", "float3[]", vec3s(np.array([low, high])))
    attribute(spec, "faceVertexCounts", "int[]", Vt.IntArray.FromNumpy(np.ascontiguousarray(counts, np.int32)))
    attribute(spec, "faceVertexIndices", "int[]", Vt.IntArray.FromNumpy(np.ascontiguousarray(indices, np.int32)))
    attribute(spec, "points", "point3f[]", vec3s(points))
    attribute(spec, "subdivisionScheme", "token", "none", uniform=True)
    if color is not None:
        attribute(spec, "primvars:displayColor", "color3f[]", vec3s(np.array([color]))).SetInfo("interpolation", "constant")
    return spec


def smooth_normals(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float32] | None:
    """Return normals (3F, 3) per face corner, averaged over the faces that meet softly, or None where all are flat anyway."""
    corners = vertices[faces]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    flat = cross / np.maximum(length, 1e-15)
    _, shared = np.unique(np.round(vertices, 6), axis=0, return_inverse=True)
    group = shared.reshape(-1)[faces].ravel()
    owner = np.repeat(np.arange(len(faces)), 3)
    order = np.argsort(group, kind="stable")
    starts = np.flatnonzero(np.diff(group[order], prepend=-1))
    sizes = np.diff(np.append(starts, len(order)))
    # All pairs of face corners at one point: `first` collects from `second`.
    first = np.repeat(order, np.repeat(sizes, sizes))
    block = np.repeat(starts, sizes * sizes)
    offset = np.arange(len(block)) - np.repeat(np.cumsum(sizes * sizes) - sizes * sizes, sizes * sizes)
    second = order[block + offset % np.repeat(sizes, sizes * sizes)]
    a, b = owner[first], owner[second]
    cosine = np.einsum("ij,ij->i", flat[a], flat[b])
    soft = cosine > CREASE
    if not np.any(soft & (cosine < 0.9998)):
        return None
    total = np.zeros((len(owner), 3))
    np.add.at(total, first[soft], cross[b[soft]])
    normals = total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-15)
    return normals.astype(np.float32)
