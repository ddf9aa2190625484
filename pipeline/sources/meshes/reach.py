"""What of a body can be come to from outside: on a grid, flooded from the air about it.

A cabinet whose doors do not open has an inside that nobody sees or feels; neither is the gap between a drawer's front and its
carcass felt. Where nothing comes, a collider's surface may be where it likes.
"""

from collections.abc import Callable, Sequence

import numpy as np
from scipy import ndimage

from pipeline.arrays import Bools, Floats, Ints
from pipeline.geometry.compiled import compiled

CELLS = 1_500_000  # of a grid at most
AIR = 2  # cells about the body
AROUND = np.ones((3, 3, 3), bool)


def make_reach_test(hulls: Sequence[Floats], planes: Sequence[Floats], cell: float) -> Callable[[Floats], Bools]:
    """Return who tells of points (P, 3) whether they are come to from outside a body of convex pieces: their points (N, 3), their planes (F, 4).

    A cell [m] that a piece passes is full, so that gaps narrower than one or two are shut. The body stands: nothing comes from below.
    """
    low, high = np.min([h.min(axis=0) for h in hulls], axis=0), np.max([h.max(axis=0) for h in hulls], axis=0)
    cell = max(cell, float((np.prod(high - low) / CELLS) ** (1 / 3)))
    count = np.ceil((high - low) / cell).astype(np.int64) + 2 * AIR
    count[2] -= AIR
    start = low - cell * np.array([AIR, AIR, 0])
    full = np.zeros(tuple(count), np.bool_)
    for hull, faces in zip(hulls, planes, strict=True):
        first = np.floor((hull.min(axis=0) - start) / cell).astype(np.int64)
        last = np.minimum(np.floor((hull.max(axis=0) - start) / cell).astype(np.int64) + 1, count)
        _fill(full, np.ascontiguousarray(faces), start, cell, np.maximum(first, 0), last)
    label, _ = ndimage.label(~full)
    near = ndimage.binary_dilation(label == label[0, 0, -1], AROUND)

    def tell(points: Floats) -> Bools:
        index = np.clip(np.floor((points - start) / cell).astype(np.int64), 0, count - 1)
        return np.asarray(near[index[:, 0], index[:, 1], index[:, 2]])

    return tell


@compiled
def _fill(full: Bools, planes: Floats, start: Floats, cell: float, first: Ints, last: Ints) -> None:
    """Mark the cells from `first` to `last` that a convex piece meets, by the planes (F, 4) of its faces."""
    for i in range(first[0], last[0]):
        for j in range(first[1], last[1]):
            for k in range(first[2], last[2]):
                if full[i, j, k]:
                    continue
                x, y, z = start[0] + (i + 0.5) * cell, start[1] + (j + 0.5) * cell, start[2] + (k + 0.5) * cell
                meets = True
                for f in range(len(planes)):
                    a, b, c = planes[f, 0], planes[f, 1], planes[f, 2]
                    if a * x + b * y + c * z + planes[f, 3] > (abs(a) + abs(b) + abs(c)) * cell / 2:
                        meets = False
                        break
                full[i, j, k] = meets
