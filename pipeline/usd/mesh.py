"""Meshes: triangles with their extent, smooth normals where a surface is curved, texture coordinates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Vt

from pipeline.entities.asset import Mesh
from pipeline.rendering.normals import smooth_normals
from pipeline.usd.layer import attribute, prim, vec3s


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
