"""A retrieved asset is rarely as large as what was asked for: what stands flush with it is moved out of it."""

import numpy as np
from numpy.typing import NDArray

from pipeline.geometry.compiled import compiled

Floats = NDArray[np.float64]

SHALLOW = 0.15  # what reaches deeper into another is meant to, or a matter for the arranger [m]
SQUARE = 0.05  # boxes turned to each other by less than this, or by so much more than quarters, are square [rad]
CLEAR = 0.002  # between what is parted [m]
ROUNDS = 4  # over all pairs: who is moved may meet the next


def part(centres: Floats, yaws: Floats, sizes: Floats) -> Floats:
    """Return the centres (n, 2) [m] of boxes, those that reach into each other by less than SHALLOW moved apart, each by half.

    `yaws` (n,), `sizes` (n, >= 2) [m]: width and depth. Only boxes that are square to each other move, and along the side by which they meet.
    """
    return _part(np.array(centres, float), np.asarray(yaws, float), np.ascontiguousarray(sizes[:, :2], float) / 2)


@compiled
def _part(centres: Floats, yaws: Floats, half: Floats) -> Floats:
    for _ in range(ROUNDS):
        moved = False
        for i in range(len(yaws)):
            u = np.array([np.cos(yaws[i]), np.sin(yaws[i])])
            v = np.array([-u[1], u[0]])
            for j in range(i):
                quarters = (yaws[j] - yaws[i]) / (np.pi / 2)
                if abs(quarters - np.rint(quarters)) * np.pi / 2 > SQUARE:
                    continue
                across = int(abs(np.rint(quarters))) % 2  # which extent of j lies along the width of i
                x, y = np.dot(centres[j] - centres[i], u), np.dot(centres[j] - centres[i], v)
                along_u, along_v = half[i, 0] + half[j, across] - abs(x), half[i, 1] + half[j, 1 - across] - abs(y)
                depth, side = min(along_u, along_v), max(along_u, along_v)
                if 1e-4 < depth < SHALLOW and side > depth + 0.02:
                    push = (u * np.sign(x) if along_u < along_v else v * np.sign(y)) * (depth + CLEAR) / 2
                    centres[i] -= push
                    centres[j] += push
                    moved = True
        if not moved:
            break
    return centres
