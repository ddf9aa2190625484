"""Which joints of an asset wait for others: a drawer behind a door comes out once the door is open."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pipeline.arrays import Floats
from pipeline.entities.asset import Asset
from pipeline.geometry.contact import Groups
from pipeline.geometry.kinematics import OPENERS, joint_motion, joint_range, link_points, moved_links, sweep_box
from pipeline.geometry.prisms import Prisms, join_prisms, prism, sweep_of

TOUCH = 0.005  # parts that are in each other by no more do not block each other [m]
HELD = ("hinge_handle", "hinge_knob", "slider_button")  # what a hand takes hold of waits for nothing


def with_prerequisites(asset: Asset) -> Asset:
    """Return the asset, each joint's `after` found from its geometry.

    A joint waits for a door, drawer or lid whose parts lie in its way at rest, and do so no more once that is open. Parts
    that are in each other at rest tell nothing, nor do two that would wait for each other.
    """
    waits = find_prerequisites(asset)
    if not any(waits):
        return asset
    joints = asset.joints
    named = tuple(replace(j, after=tuple(joints[i].name for i in w)) for j, w in zip(joints, waits, strict=True))
    return replace(asset, joints=named)


def find_prerequisites(asset: Asset) -> list[tuple[int, ...]]:
    """Return for each joint of an asset the indices of the joints that it waits for."""
    joints = asset.joints
    moved = [moved_links(asset, k) for k in range(len(joints))]
    points = [np.concatenate([link_points(asset.links[i]) for i in links]) for links in moved]
    rest = [np.stack([own.min(0, initial=np.inf), own.max(0, initial=-np.inf)]) for own in points]
    prerequisites: list[set[int]] = [set() for _ in joints]
    for k, joint in enumerate(joints):
        if joint.part_class in HELD:
            continue
        way = sweep_box(asset, k)
        sweep: Prisms | None = None
        for i, other in enumerate(joints):
            related = i == k or other.child in moved[k] or joint.child in moved[i]
            if (
                related
                or other.part_class not in OPENERS
                or not (np.minimum(way[1], rest[i][1]) - np.maximum(way[0], rest[i][0]) > TOUCH).all()
            ):
                continue
            sweep = sweep if sweep is not None else sweep_of(asset, k).prisms
            at_rest, opened = (Groups.of([_links(asset, moved[i], joint_motion(other, q))]) for q in (0.0, joint_range(other)[1]))
            own = _links(asset, moved[k], np.eye(4))
            if at_rest.hit(sweep, TOUCH) and not at_rest.hit(own, TOUCH) and not opened.hit(sweep, TOUCH):
                prerequisites[k].add(i)
    return [tuple(sorted(i for i in own if k not in prerequisites[i])) for k, own in enumerate(prerequisites)]


def _links(asset: Asset, links: Sequence[int], T: Floats) -> Prisms:
    """Return the prisms of links, moved by T (4, 4) from rest."""
    meshes = [m for i in links for m in (asset.links[i].colliders or asset.links[i].visuals)]
    prisms = (prism(np.asarray(m.vertices, np.float64) @ T[:3, :3].T + T[:3, 3]) for m in meshes)
    return join_prisms([p for p in prisms if p is not None])
