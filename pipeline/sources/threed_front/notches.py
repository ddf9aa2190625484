"""What of its box a model fills, coarsely: an L-shaped sofa leaves a notch, a lamp's arc leaves room below it."""

import functools
from collections.abc import Iterable

import numpy as np

from pipeline.arrays import Bools, Floats
from pipeline.entities.asset import Mesh
from pipeline.sources.threed_front.poses import Pose

CELLS = (24, 24, 8)  # across the box: width, depth, height
DENSITY = 1.5  # points per cell along a triangle's sides
AT_ONCE = 500_000  # points, some 40 MB
MOST = 72  # of these along one side; a side crosses 24 cells or, slantwise, 34


def occupancy_bits(meshes: Iterable[Mesh], size: Floats) -> bytes:
    """Return which cells of its box (w, d, h) [m] a model fills, as packed bits; its meshes are in the asset's frame.

    Cells that the surface goes through, and in each column what lies between the lowest and the highest of them: tables stay
    open below their tops, sofas and cabinets are full.
    """
    mask = np.zeros(CELLS, np.bool_)
    cells = np.array(CELLS)
    for mesh in meshes:
        different = np.unique(mesh.faces, axis=0)  # a large one drawn a hundred thousand times takes minutes
        triangles = (mesh.vertices.astype(np.float64) / size + [0.5, 0.5, 0.0])[different] * cells
        sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1, initial=0.0)
        steps = np.clip(np.ceil(DENSITY * sides), 1, MOST).astype(int)
        for count in np.unique(steps):
            lattice, alike = _lattice(int(count)), triangles[steps == count]
            for start in range(0, len(alike), part := max(1, AT_ONCE // len(lattice))):
                points = np.einsum("pk,tkc->tpc", lattice, alike[start : start + part]).reshape(-1, 3)
                x, y, z = np.clip(np.floor(points).astype(int), 0, cells - 1).T
                mask[x, y, z] = True
    below = np.logical_or.accumulate(mask, axis=2)
    above = np.logical_or.accumulate(mask[:, :, ::-1], axis=2)[:, :, ::-1]
    return np.packbits(below & above).tobytes()


@functools.lru_cache(MOST)
def _lattice(count: int) -> Floats:
    """Return points (P, 3) all over a triangle in barycentric coordinates, `count` steps along each side."""
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    inside = i + j <= count
    a, b = i[inside] / count, j[inside] / count
    return np.stack([a, b, 1 - a - b], axis=1)


def overlap_share(a: tuple[Pose, bytes], b: tuple[Pose, bytes]) -> float:
    """Return the share of what `a` fills that lies in what `b` fills; one of which no shape is known fills its box."""
    (pose, bits), (other, theirs) = a, b
    index = np.argwhere(_mask(bits))
    points = (((index + 0.5) / CELLS) - [0.5, 0.5, 0.0]) * pose.size * [-1.0 if pose.mirrored else 1.0, 1.0, 1.0]
    local = (points @ _turn(pose.yaw).T + pose.position - other.position) @ _turn(other.yaw)
    local = local / other.size * [-1.0 if other.mirrored else 1.0, 1.0, 1.0] + [0.5, 0.5, 0.0]
    cells = np.floor(local * CELLS).astype(int)
    inside = ((cells >= 0) & (cells < CELLS)).all(axis=1)
    x, y, z = cells[inside].T
    return float(np.count_nonzero(_mask(theirs)[x, y, z]) / len(index))


@functools.lru_cache(4096)
def fill_columns(bits: bytes) -> bytes:
    """Return a shape that is full from top to bottom wherever it is anything: what it covers of the floor."""
    columns = _mask(bits).any(axis=2, keepdims=True)
    return np.packbits(np.broadcast_to(columns, CELLS)).tobytes()


def _mask(bits: bytes) -> Bools:
    count = int(np.prod(CELLS))
    if not bits:
        return np.ones(CELLS, np.bool_)
    return np.unpackbits(np.frombuffer(bits, np.uint8), count=count).astype(np.bool_).reshape(CELLS)


def _turn(yaw: float) -> Floats:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
