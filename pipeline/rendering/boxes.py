"""Box meshes and box inertia: what doors, windows and stand-ins are made of."""

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Link, Mesh

CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], np.float32)
FACES = np.array(
    [[0, 3, 1], [0, 2, 3], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 7, 3], [2, 6, 7], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]],
    np.int32,
)


def box(name: str, low: tuple[float, float, float], high: tuple[float, float, float], material: int = 0, part: str = "") -> Mesh:
    """Make the box low..high [m]: 8 vertices, 12 outward triangles."""
    corner, extent = np.asarray(low, np.float32), np.asarray(high, np.float32) - np.asarray(low, np.float32)
    return Mesh(name, corner + CORNERS * extent, FACES, material, None, part)


def join_meshes(name: str, meshes: tuple[Mesh, ...]) -> Mesh:
    """Make one mesh of several, with the material of the first."""
    starts = np.cumsum([0, *(len(m.vertices) for m in meshes[:-1])])
    faces = np.concatenate([m.faces + start for m, start in zip(meshes, starts, strict=True)]).astype(np.int32)
    return Mesh(name, np.concatenate([m.vertices for m in meshes]), faces, meshes[0].material)


def solid_link(name: str, visuals: tuple[Mesh, ...], colliders: tuple[Mesh, ...], mass: float) -> Link:
    """Make a link whose mass [kg] is spread evenly over the boxes that its colliders span."""
    low = np.array([c.vertices.min(axis=0) for c in colliders], np.float64)
    high = np.array([c.vertices.max(axis=0) for c in colliders], np.float64)
    extent = np.maximum(high - low, 1e-4)
    share = mass * extent.prod(axis=1) / extent.prod(axis=1).sum()
    middle = (low + high) / 2
    com = share @ middle / mass
    inertia = np.zeros((3, 3))
    for m, e, c in zip(share, extent, middle - com, strict=True):
        inertia += m / 12 * (np.eye(3) * (e @ e) - np.diag(e * e)) + m * (np.eye(3) * (c @ c) - np.outer(c, c))
    return Link(name, visuals, colliders, mass, com, inertia)


def triangles(mesh: Mesh) -> NDArray[np.float64]:
    """Return the mesh's triangles (F, 3, 3) [m]."""
    return np.asarray(mesh.vertices.astype(np.float64)[mesh.faces])
