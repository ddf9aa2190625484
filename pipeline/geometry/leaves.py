"""What room doors sweep, as prisms."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pipeline.geometry.prisms import BULGE, STEPS, Prisms, Sweep, prism, stacked
from pipeline.geometry.walls import LEAF_THICKNESS, Leaf

Floats = NDArray[np.float64]

# A box around the levers: from the lock edge, out of each face, above the leaf's lower edge [m].
LEVER_EDGE, LEVER_LENGTH, LEVER_OUT, LEVER_Z = 0.03, 0.16, 0.065, (0.9, 1.15)


def leaf_sweep(leaf: Leaf, elevation: float) -> Sweep:
    """Return the sweep of a door leaf and its levers, from closed to its full angle [world frame].

    `elevation` is the z of the storey's floor [m].
    """
    step = 2 * math.acos(1.0 - BULGE / leaf.width)
    angles = np.linspace(0.0, leaf.angle, max(STEPS, math.ceil(leaf.angle / step)) + 1)
    groups: list[Prisms] = []
    pieces = [(0.0, leaf.width, 0.0, leaf.bottom, leaf.top)]
    if leaf.top - leaf.bottom > LEVER_Z[1]:
        far = leaf.width - LEVER_EDGE
        pieces.append((far - LEVER_LENGTH, far, LEVER_OUT, leaf.bottom + LEVER_Z[0], leaf.bottom + LEVER_Z[1]))
    for start, end, out, low, high in pieces:
        outlines = [_outline(leaf, float(a), start, end, out) for a in angles]
        for k in range(len(angles) - 1):
            flat = np.concatenate([outlines[k], outlines[k + 1]])
            made = prism(np.concatenate([np.column_stack([flat, np.full(8, elevation + z)]) for z in (low, high)]), k)
            if made is not None:
                groups.append(made)
    return Sweep(stacked(groups), angles[1:])


def leaf_handles(leaf: Leaf) -> Floats:
    """Return where a hand takes hold of the closed leaf (2, 2) [m, plan]: on the side it opens to, and behind."""
    at = leaf.hinge + leaf.along * (leaf.width - LEVER_EDGE - LEVER_LENGTH / 2)
    return np.stack([at + LEVER_OUT * leaf.normal, at - (LEAF_THICKNESS + LEVER_OUT) * leaf.normal])


def _outline(leaf: Leaf, angle: float, start: float, end: float, out: float) -> Floats:
    """Return the part of the leaf from `start` to `end` [m from the hinge edge], thicker by `out`, opened by `angle`."""
    a, b, _, d = leaf.outline(angle)
    along = (b - a) / max(float(np.linalg.norm(b - a)), 1e-9)
    front = (a - d) / max(float(np.linalg.norm(a - d)), 1e-9) * out
    return np.array([a + along * start + front, a + along * end + front, d + along * end - front, d + along * start - front])
