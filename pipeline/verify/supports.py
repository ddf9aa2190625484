"""What carries what: things that stand on or in an object, on which of its links, and where they go when that link slides out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset, Joint
from pipeline.entities.home import Placement
from pipeline.geometry.kinematics import moved_links
from pipeline.geometry.polygons import contains
from pipeline.geometry.prisms import Prisms, covering_prisms, join_prisms
from pipeline.verify.bodies import Bodies

LEVEL = 0.1  # a slide whose axis rises less than this per metre keeps what lies in it


@dataclass(frozen=True, slots=True)
class Support:
    """The placement (index) that a thing stands on, and the link of its asset that bears it."""

    placement: int
    link: int


def find_supports(placements: Sequence[Placement], bodies: Bodies, gap: float) -> dict[int, Support]:
    """Return what bears each placement that names a `support`, by index; what nothing there bears is missing.

    Its middle must lie over a piece of the support whose top is within `gap` [m] of its bottom.
    """
    index = {p.object_id: g for g, p in enumerate(placements)}
    p = bodies.prisms
    supports = {}
    for g, placement in enumerate(placements):
        h = index.get(placement.support) if placement.support else None
        if h is None or h == g:
            continue
        own = np.arange(bodies.start[h], bodies.start[h + 1])
        x, y, z = placement.position.tolist()
        off = np.abs(p.z[own, 1] - z)
        # The nearest top bears it: a drawer's floor, not the board of the carcass just below.
        for i in own[np.argsort(off, kind="stable")][: int((off <= gap).sum())]:
            if contains(x, y, np.ascontiguousarray(p.polygon(int(i)))):
                supports[g] = Support(h, int(p.part[i]))
                break
    return supports


def moved_by(asset: Asset, index: int, owner: int, supports: Mapping[int, Support]) -> list[int]:
    """Return the placements that ride along when joint `index` of placement `owner` moves: they lie in a drawer."""
    joint = asset.joints[index]
    if joint.type != "prismatic" or abs(float(joint.axis[2])) > LEVEL:
        return []
    moved = moved_links(asset, index)
    return [g for g, support in supports.items() if support.placement == owner and support.link in moved]


def covered(bodies: Bodies, things: Sequence[int], joint: Joint, turn: NDArray[np.float64], ends: Sequence[float]) -> Prisms:
    """Return what riding things cover between each position of a slide and the next; `part` numbers the stretches.

    `turn` (3, 3) is the owner's rotation, `ends` (S + 1,) the positions.
    """
    p = bodies.prisms
    axis = turn @ joint.axis
    moves = np.asarray(ends)[:, None, None] * axis
    groups = []
    for i in (i for g in things for i in range(int(bodies.start[g]), int(bodies.start[g + 1]))):
        corners = p.polygon(i)
        posed = np.concatenate([np.column_stack([corners, np.full(len(corners), z)]) for z in p.z[i]]) + moves
        groups.append(covering_prisms(np.concatenate([posed[:-1], posed[1:]], axis=1)))
    return join_prisms(groups)
