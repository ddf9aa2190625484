"""Groups: an anchor with the members that move when it does."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.bonds import Bond
from pipeline.arrange.item import Item

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Group:
    """`members` (K,), the anchor first, and their `offsets` (K, 4) x, y, z, yaw from it in its frame."""

    members: Ints
    offsets: Floats

    @property
    def first(self) -> int:
        """The anchor."""
        return int(self.members[0])


def groups(items: Sequence[Item], poses: Floats, bonds: Sequence[Bond | None], runs: Sequence[Sequence[int]] = ()) -> list[Group]:
    """Return the groups of a room at their exact poses; `runs` are kitchen units that stand as one. Each object is in one group."""
    root = list(range(len(items)))
    for run in runs:
        for i in run:
            root[i] = run[0]
    for i in sorted(range(len(items)), key=lambda i: (-items[i].area, i)):
        bond = bonds[i]
        if bond is not None and bond.rigid:
            root[i] = root[bond.anchor]
    by_root: dict[int, list[int]] = {}
    for i, r in enumerate(root):
        by_root.setdefault(r, []).append(i)
    return [group_of([r, *(i for i in own if i != r)], poses) for r, own in by_root.items()]


def group_of(members: Sequence[int], poses: Floats) -> Group:
    """Return objects as a group, the first as its anchor, as they stand at `poses` (N, 4)."""
    own = np.array(members, np.int64)
    anchor = poses[own[0]]
    c, s = math.cos(anchor[3]), math.sin(anchor[3])
    apart = poses[own] - anchor
    offsets = np.column_stack([c * apart[:, 0] + s * apart[:, 1], c * apart[:, 1] - s * apart[:, 0], apart[:, 2], apart[:, 3]])
    return Group(own, offsets)
