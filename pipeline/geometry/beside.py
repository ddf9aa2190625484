"""Things that stand beside a larger one keep their distance when they get another size: a nightstand at its bed."""

import numpy as np

from pipeline.arrays import Floats
from pipeline.geometry.compiled import compiled

NEAR = 0.25  # a gap up to which one stands beside the other [m]
INTO = 0.1  # by so much they may reach into each other as they were [m]
SQUARE = 0.1  # boxes turned to each other by less than this, or by so much more than quarters, are square [rad]


@compiled
def sideways(centres: Floats, yaws: Floats, before: Floats, after: Floats) -> Floats:
    """Return by what (n, 2) [m] boxes move that change size, so that they keep the gap to the larger one that they flank.

    `centres` (n, 3) are of the undersides, `yaws` (n,), `before` and `after` (n, 3): sizes [m]; those without extent neither move nor count.
    They move along their width, as far as there is room on their other side; the larger is so by its floor.
    """
    moves = np.zeros((len(yaws), 2))
    for i in range(len(yaws)):
        if before[i, 0] <= 0:
            continue
        u = np.array([np.cos(yaws[i]), np.sin(yaws[i])])
        nearest, side, grown, gaps = np.inf, 0, 0.0, np.array([np.inf, np.inf])  # to the left and to the right
        for j in range(len(yaws)):
            quarters = (yaws[j] - yaws[i]) / (np.pi / 2)
            if i == j or before[j, 0] <= 0 or abs(quarters - np.rint(quarters)) * np.pi / 2 > SQUARE:
                continue
            if centres[i, 2] >= centres[j, 2] + before[j, 2] or centres[j, 2] >= centres[i, 2] + before[i, 2]:
                continue
            turned = int(abs(np.rint(quarters))) % 2  # which extent of j lies along the width of i
            x = np.dot(centres[j, :2] - centres[i, :2], u)
            y = u[0] * (centres[j, 1] - centres[i, 1]) - u[1] * (centres[j, 0] - centres[i, 0])
            gap = abs(x) - (before[i, 0] + before[j, turned]) / 2
            overlap = (before[i, 1] + before[j, 1 - turned]) / 2 - abs(y)
            if not -INTO < gap < NEAR or overlap < before[i, 1] / 2:
                continue
            gaps[int(x > 0)] = min(gaps[int(x > 0)], gap)
            if before[i, 0] * before[i, 1] < before[j, 0] * before[j, 1] and gap < nearest:
                nearest, side = gap, int(x > 0)
                grown = (after[i, 0] - before[i, 0] + after[j, turned] - before[j, turned]) / 2
        if nearest < np.inf:
            room = max(gaps[1 - side] - (after[i, 0] - before[i, 0]) / 2, 0.0)
            moves[i] = min(grown, room) * (1.0 - 2.0 * side) * u
    return moves
