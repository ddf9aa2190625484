"""A retrieved asset is rarely as large as what was asked for: what stands flush with it is moved out of it."""

import numpy as np
from numpy.typing import NDArray

from pipeline.geometry.compiled import compiled
from pipeline.retrieval.wall_alignment import CLEAR, OVERLAP, gap_to_wall

Floats = NDArray[np.float64]

SHALLOW = 0.15  # what reaches deeper into another is meant to, or a matter for the arranger [m]
SQUARE = 0.05  # boxes turned to each other by less than this, or by so much more than quarters, are square [rad]
ROUNDS = 8  # over all pairs: who is moved may meet the next


def part(centres: Floats, yaws: Floats, sizes: Floats, polygon: Floats) -> Floats:
    """Return the centres (n, 3) [m] of boxes, those that reach into each other by less than SHALLOW moved apart, each by half or as far as its wall allows.

    `centres` are of the boxes' undersides, `yaws` (n,), `sizes` (n, 3) [m], `polygon` (k, 2) the room in the same frame. Only boxes that
    are square to each other and at one height move, and along the side by which they meet.
    """
    return _part(
        np.array(centres, float), np.asarray(yaws, float), np.ascontiguousarray(sizes, float), np.ascontiguousarray(polygon, float)
    )


@compiled
def _part(centres: Floats, yaws: Floats, sizes: Floats, polygon: Floats) -> Floats:
    half = sizes[:, :2] / 2
    for _ in range(ROUNDS):
        moved = False
        for i in range(len(yaws)):
            u = np.array([np.cos(yaws[i]), np.sin(yaws[i])])
            v = np.array([-u[1], u[0]])
            for j in range(i):
                quarters = (yaws[j] - yaws[i]) / (np.pi / 2)
                if abs(quarters - np.rint(quarters)) * np.pi / 2 > SQUARE:
                    continue
                if centres[i, 2] >= centres[j, 2] + sizes[j, 2] or centres[j, 2] >= centres[i, 2] + sizes[i, 2]:
                    continue
                turned = int(abs(np.rint(quarters))) % 2  # which extent of j lies along the width of i
                between = centres[j, :2] - centres[i, :2]
                x, y = np.dot(between, u), np.dot(between, v)
                along_u, along_v = half[i, 0] + half[j, turned] - abs(x), half[i, 1] + half[j, 1 - turned] - abs(y)
                if not (1e-4 < min(along_u, along_v) < SHALLOW and max(along_u, along_v) > min(along_u, along_v) + 0.02):
                    continue
                axis = 0 if along_u < along_v else 1
                push = u * np.sign(x) if axis == 0 else v * np.sign(y)
                wanted = min(along_u, along_v) + CLEAR
                room_i = _room(centres[i, :2], -push, half[i, axis], half[i, 1 - axis], polygon)
                room_j = _room(centres[j, :2], push, half[j, abs(axis - turned)], half[j, 1 - abs(axis - turned)], polygon)
                share_j = min(max(wanted / 2, wanted - room_i), room_j)
                share_i = min(wanted - share_j, room_i)
                if share_i + share_j > 1e-4:
                    centres[i, :2] -= push * share_i
                    centres[j, :2] += push * share_j
                    moved = True
        if not moved:
            break
    return centres


@compiled
def _room(centre: Floats, outward: Floats, reach: float, across: float, polygon: Floats) -> float:
    """Return how far [m] a box can be moved `outward` until it stands before a wall."""
    return max(0.0, gap_to_wall(centre + outward * reach, outward, polygon, across - OVERLAP) - CLEAR)
