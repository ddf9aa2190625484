"""Shading normals: smooth across soft edges, flat across creases."""

import numpy as np
from numpy.typing import NDArray

CREASE = np.cos(np.radians(40.0))  # faces that meet at less than this angle are shaded as one surface


def smooth_normals(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float32] | None:
    """Return normals (3F, 3) per face corner, averaged over the faces that meet softly, or None where all are flat anyway."""
    if len(vertices) <= 8:  # boxes, and what is no rounder
        return None
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
    return np.asarray(normals, np.float32)


def corner_normals(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a shading normal (T, 3, 3) for every corner of loose triangles (T, 3, 3)."""
    points = triangles.reshape(-1, 3)
    faces = np.arange(len(points), dtype=np.int32).reshape(-1, 3)
    smooth = smooth_normals(points, faces)
    if smooth is not None:
        return smooth.reshape(-1, 3, 3).astype(np.float64)
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    flat = cross / np.maximum(np.linalg.norm(cross, axis=1, keepdims=True), 1e-15)
    return np.repeat(flat[:, None], 3, axis=1)
