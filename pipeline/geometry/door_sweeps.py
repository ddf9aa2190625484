"""What room doors sweep, as prisms."""

import functools
import math

import numpy as np

from pipeline.arrays import Floats
from pipeline.geometry.prisms import BULGE, MARGIN, STEPS, Prisms, Sweep, covering_prisms, join_prisms
from pipeline.geometry.walls import LEAF_THICKNESS, Leaf

ROOM = 0.01  # [m] about the leaf and its levers: what stands in a room need not stand nearer to its door, as units of a kitchen do to each other
# A box around the levers: from the lock edge, out of each face, above the leaf's lower edge [m].
LEVER_EDGE, LEVER_LENGTH, LEVER_OUT, LEVER_Z = 0.03, 0.16, 0.065, (0.9, 1.15)


@functools.lru_cache(512)
def leaf_sweep(leaf: Leaf, elevation: float) -> Sweep:
    """Return the sweep of a door leaf and its levers, from closed to its full angle [world frame], and ROOM about it.

    `elevation` is the z of the storey's floor [m].
    """
    step = 2 * math.acos(1.0 - BULGE / leaf.width)
    angles = np.linspace(0.0, leaf.angle, max(STEPS, math.ceil(leaf.angle / step)) + 1)
    posed = [_posed(leaf, elevation, angles, piece) for piece in _pieces(leaf)]
    return Sweep(join_prisms([covering_prisms(np.concatenate([p[:-1], p[1:]], axis=1), margin=ROOM) for p in posed]), angles[1:])


def shut_leaf(leaf: Leaf, elevation: float) -> Prisms:
    """Return what a closed leaf and its levers take, and MARGIN about it: on both sides of the wall a drawer comes out before them."""
    return join_prisms([covering_prisms(_posed(leaf, elevation, np.zeros(1), piece), margin=MARGIN) for piece in _pieces(leaf)])


def leaf_handles(leaf: Leaf) -> Floats:
    """Return where a hand takes hold of the closed leaf (2, 2) [m, plan]: on the side it opens to, and behind."""
    at = leaf.hinge + leaf.along * (leaf.width - LEVER_EDGE - LEVER_LENGTH / 2)
    return np.stack([at + LEVER_OUT * leaf.normal, at - (LEAF_THICKNESS + LEVER_OUT) * leaf.normal])


def _pieces(leaf: Leaf) -> list[Floats]:
    """Return the leaf and the box of its levers: start and end from the hinge edge, beyond its faces, lower and upper edge [m]."""
    pieces = [np.array([0.0, leaf.width, 0.0, leaf.bottom, leaf.top])]
    if leaf.top - leaf.bottom > LEVER_Z[1]:
        far = leaf.width - LEVER_EDGE
        pieces.append(np.array([far - LEVER_LENGTH, far, LEVER_OUT, leaf.bottom + LEVER_Z[0], leaf.bottom + LEVER_Z[1]]))
    return pieces


def _posed(leaf: Leaf, elevation: float, angles: Floats, piece: Floats) -> Floats:
    """Return the corners (A, 8, 3) [m] of a piece, the leaf opened by `angles` (A,)."""
    start, end, out, low, high = piece.tolist()
    a, b, _, d = np.moveaxis(np.array([leaf.outline(float(angle)) for angle in angles]), 1, 0)
    along = (b - a) / np.maximum(np.linalg.norm(b - a, axis=1, keepdims=True), 1e-9)
    front = (a - d) / np.maximum(np.linalg.norm(a - d, axis=1, keepdims=True), 1e-9) * out
    flat = np.stack([a + along * start + front, a + along * end + front, d + along * end - front, d + along * start - front], axis=1)
    return np.concatenate([np.dstack([flat, np.full(flat.shape[:2], elevation + z)]) for z in (low, high)], axis=1)
