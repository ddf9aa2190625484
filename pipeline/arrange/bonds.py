"""Which relations of the training tables a draft nearly holds, and the poses at which it would hold them exactly.

A member is bound to the one anchor, larger than itself, whose learnt modes it is nearest to: so the bonds of a room are
trees, with a bed, a sofa, a table at each root. The modes are those of `pipeline.relations`, as rows of numbers. An anchor is a group
with the members that move when it does.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.item import Item, other_wall
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrays import Floats, Ints
from pipeline.geometry.compiled import compiled
from pipeline.relations.frames import REFERENCES, SIDES

REACH, TURN = 0.4, math.radians(30)  # how far from a mode a relation is nearly held [m, rad]
SURE, ADOPTED = 0.85, 4.0  # who of a relation this strong is astray belongs there all the same, from this far [m]
OVER = float(SIDES.index("over"))
MIDDLE, LOW, _HIGH, SHARE, OUTSIDE = (float(k) for k in range(len(REFERENCES)))
FLAT = [0, 1, 3]  # x, y, yaw of a pose
LEVER = 0.5  # metres that a radian counts
INSIDE = 0.5  # what is beyond a mode's span is put so far from its middle to its end; who is within stays
SQUARE = math.radians(15)  # a turn against the anchor is made a quarter turn when it is this near to one,
FREELY = math.radians(6)  # unless turns in its mode differ by more
KEPT, TURNED = 0.15, math.radians(15)  # off a mode by no more, a relation is kept [m, rad]
ADJOINS = 0.7  # a member moves with its anchor when the gap between them is no wider [m]


@dataclass(frozen=True, slots=True)
class Bond:
    """A member's tie to its anchor (its index): the exact pose (x, y, yaw) in the anchor's frame; `rigid`: it moves when the anchor does."""

    anchor: int
    local: Floats
    rigid: bool
    over: bool


def find_bond(i: int, items: Sequence[Item], wished: Floats, poses: Floats, learnt: LearntRelations) -> Bond | None:
    """Return the bond of item `i`, wished at a pose (4,), to one of those that are larger, at their `poses` (N, 4) or where they were wished."""
    item = items[i]
    larger = [j for j, other in enumerate(items) if other.mount == "floor" and (other.area, -j) > (item.area, -i)]
    alike = [j for j in larger if items[j].placement.category == item.placement.category]
    others = _best_bond(item, [j for j in larger if j not in alike], items, wished, poses, learnt)
    return others or _best_bond(item, alike, items, wished, poses, learnt)  # chairs go with their table, not with each other


def _best_bond(
    item: Item, anchors: Sequence[int], items: Sequence[Item], wished: Floats, poses: Floats, learnt: LearntRelations
) -> Bond | None:
    """Return the strongest and nearest bond of an item to one of some anchors."""
    best: tuple[float, Bond] | None = None
    for j in anchors:
        other = items[j]
        relation = learnt.modes(other.placement.category, item.placement.category)
        if relation is None:
            continue
        table, strength = relation
        if item.mount == "wall":  # walls place what hangs on them, but for what is placed over furniture
            table = table[table[:, 0] == OVER]
        frames = (poses[j], other.wished)
        near = min((nearest(table, at[FLAT], other.half, wished[FLAT], item.half) for at in frames), key=_off)
        if (near[0] > REACH or near[1] > TURN) and (strength < SURE or near[0] > ADOPTED):
            continue
        score = strength - _off(near)
        if best is None or score > best[0]:
            best = score, _bond(j, near, other, item)
    return best[1] if best else None


def _off(near: Floats) -> float:
    return round(float(near[0] + LEVER * near[1]), 6)


def _bond(anchor: int, near: Floats, other: Item, item: Item) -> Bond:
    over, local = bool(near[5] == OVER), near[2:5].copy()
    same_wall = not (item.habit.must and other_wall(local[2]))  # a TV stand opposite stays at its own wall
    return Bond(anchor, local, over or (same_wall and _gap(local, other, item) <= ADJOINS), over)


def at_anchor(pose: Floats, local: Floats) -> Floats:
    """Return the pose (x, y, yaw) of what stands at `local` (x, y, yaw) in the frame of an anchor at (x, y, z, yaw)."""
    c, s = math.cos(pose[3]), math.sin(pose[3])
    return np.array(
        [pose[0] + c * local[0] - s * local[1], pose[1] + s * local[0] + c * local[1], math.remainder(pose[3] + local[2], math.tau)]
    )


def mode_poses(anchor: Item, at: Floats, item: Item, wished: Floats, learnt: LearntRelations) -> Floats:
    """Return the poses (K, 3) x, y, yaw of an item in each mode at an anchor that stands at (x, y, z, yaw): those nearest to `wished`."""
    relation = learnt.modes(anchor.placement.category, item.placement.category)
    if relation is None:
        return np.zeros((0, 3))
    table = relation[0]
    near = np.array([nearest(table[k : k + 1], at[FLAT], anchor.half, wished[FLAT], item.half)[2:5] for k in range(len(table))])
    return np.array([at_anchor(at, local) for local in near]).reshape(-1, 3)


def _gap(local: Floats, anchor: Item, member: Item) -> float:
    """Return the gap between the boxes of a member and its anchor [m]."""
    c, s = abs(math.cos(local[2])), abs(math.sin(local[2]))
    w, d = member.half
    return float(max(abs(local[0]) - anchor.half[0] - c * w - s * d, abs(local[1]) - anchor.half[1] - s * w - c * d))


@compiled
def _place(span: Floats, at: float, anchor: float, member: float) -> tuple[float, float]:
    """Return how far [m] a member at `at` along an axis of its anchor is beyond a span, and where it is put; both are so long there."""
    zero, unit = 0.0, 1.0
    if span[0] == SHARE:
        unit = anchor
    elif span[0] == OUTSIDE:
        zero = (anchor + member) / 2
    elif span[0] != MIDDLE:
        zero = (-1.0 if span[0] == LOW else 1.0) * (anchor - member) / 2
    value = (at - zero) / unit
    low, middle, high = span[1], span[2], span[3]
    off = _beyond(value, low, high)
    if off != 0.0:
        value = middle + INSIDE * ((low if off < 0.0 else high) - middle)
    return off * unit, zero + unit * value


@compiled
def _beyond(value: float, low: float, high: float) -> float:
    return min(value - low, 0.0) + max(value - high, 0.0)


@compiled
def _extents(half: Floats, turn: float) -> tuple[float, float]:
    """Return the full extents along the anchor's axes of a box turned by `turn`."""
    c, s = abs(math.cos(turn)), abs(math.sin(turn))
    return 2 * (c * half[0] + s * half[1]), 2 * (s * half[0] + c * half[1])


@compiled
def nearest(table: Floats, anchor: Floats, half: Floats, member: Floats, own: Floats) -> Floats:
    """Return (metres, radians off, x, y, yaw in the anchor's frame, side) of the nearest mode: as `Mode.distances` says, and where it is put.

    `anchor` and `member` are (x, y, yaw), `half` and `own` their half extents (2,) in plan.
    """
    c, s = math.cos(anchor[2]), math.sin(anchor[2])
    dx, dy = member[0] - anchor[0], member[1] - anchor[1]
    place = (c * dx + s * dy, c * dy - s * dx)
    turn = (member[2] - anchor[2] + math.pi) % (2 * math.pi) - math.pi
    best = np.full(6, np.inf)
    for k in range(table.shape[0]):
        row = table[k]
        side = row[0]
        i = 0 if side in (1.0, 3.0) else 1  # the axis of the anchor that leads out of this side
        sign = -1.0 if side in (0.0, 3.0) else 1.0
        looks = math.atan2(-place[0], place[1]) if row[9] > 0.0 else 0.0
        off = (turn - looks - row[11] + math.pi) % (2 * math.pi) - math.pi
        radians = abs(_beyond(off, row[10], row[12]))
        wide = _extents(own, turn)
        out_off, _ = _place(row[1:5], sign * place[i], 2 * half[i], wide[i])
        side_off, _ = _place(row[5:9], place[1 - i], 2 * half[1 - i], wide[1 - i])
        metres = math.sqrt(out_off * out_off + side_off * side_off)
        if metres + LEVER * radians >= best[0] + LEVER * best[1]:
            continue
        yaw = looks + row[11] + (off if row[10] <= off <= row[12] else 0.0)  # chairs that were left a little askew stay so
        quarter = round(yaw / (math.pi / 2)) * (math.pi / 2)
        if row[12] - row[10] < FREELY and abs(yaw - quarter) <= SQUARE:
            yaw = quarter
        wide = _extents(own, yaw)
        _, out = _place(row[1:5], sign * place[i], 2 * half[i], wide[i])
        _, along = _place(row[5:9], place[1 - i], 2 * half[1 - i], wide[1 - i])
        best[0], best[1], best[4], best[5] = metres, radians, yaw, side
        best[2 + i], best[3 - i] = sign * out, along
    return best


def broken(
    bonds: Sequence[Bond | None],
    items: Sequence[Item],
    poses: Floats,
    there: NDArray[np.bool_],
    learnt: LearntRelations,
    most: float = KEPT,
) -> list[int]:
    """Return the objects that stand and have lost what they were bound to: the anchor is gone, or they are off every mode at it, by `most` [m]."""
    lost = []
    for i, bond in enumerate(bonds):
        if bond is None or not there[i]:
            continue
        relation = learnt.modes(items[bond.anchor].placement.category, items[i].placement.category)
        if not there[bond.anchor] or relation is None:
            lost.append(i)
            continue
        near = nearest(relation[0], poses[bond.anchor][FLAT], items[bond.anchor].half, poses[i][FLAT], items[i].half)
        if near[0] > most or near[1] > TURNED:
            lost.append(i)
    return lost


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
