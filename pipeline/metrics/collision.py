"""Collisions at rest and of what opens: Col_obj and Col_scene, R_acoll (paper eq. acoll_metric), and what joints can really do.

At rest: `bbox`, rotated boxes with an IoU above 0, as peers' `rotated_bbox`; `prism`, the assets' convex pieces, where the peers
test vertices against watertight meshes: a chair under its table collides as a box and not as what it is.

R_acoll is the share of articulated objects whose extended boxes b' meet others. b' comes in two kinds. `heuristic`: a third of
the depth is added ahead, as peers and presumably the paper do, whatever the joints are. `joints`: the asset's box and, per
joint, the box of what it sweeps beyond it. Beside them stands `swept`: the share of objects with a joint that touches something
on its way, as the judge found it with prisms.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal

import numpy as np

from pipeline.arrays import Bools, Floats, Ints
from pipeline.entities.asset import Asset
from pipeline.geometry.boxes import iou_matrix
from pipeline.geometry.contact import group_boxes, pair_depths
from pipeline.geometry.kinematics import OPENERS, beyond_body
from pipeline.geometry.prisms import join_prisms, solid
from pipeline.metrics.intervals import Mean, Rate, bootstrap, rate
from pipeline.metrics.rows import Boxes, Row, boxes, by_room

Extension = Literal["heuristic", "joints"]
Sweeps = Mapping[str, Floats]  # asset_id -> (J, 2, 3) [m, object frame]: boxes that the joints sweep

EPSILON = 1e-4  # an IoU below this is two boxes that touch [-]; the paper's "> 0" on rounded poses
TOUCH = 0.005  # pieces that are in each other by no more touch [m]


def bbox_hits(objects: Sequence[Row]) -> Bools:
    """Tell of each object (N,) of a room whether its box is in another's."""
    return _meet_others(boxes(objects), np.arange(len(objects)))


def prism_hits(objects: Sequence[Row], assets: Mapping[str, Asset], touch: float = TOUCH) -> Bools:
    """Tell of each object (N,) of a room whether one of its pieces is in one of another's by more than `touch` [m]."""
    if not objects:
        return np.zeros(0, np.bool_)
    position, yaw, _ = boxes(objects)
    placed = [
        solid(assets[o["asset_id"]]).rest.placed(position[i], float(yaw[i]), np.array(o["scale"], float)) for i, o in enumerate(objects)
    ]
    start = np.concatenate([[0], np.cumsum([len(p) for p in placed])]).astype(np.int64)
    prisms = join_prisms(placed)
    depths = pair_depths(prisms.corners, prisms.count, prisms.z, prisms.boxes(), start, group_boxes(prisms, start), touch)
    return np.asarray(depths.max(1) > 0)


def rates(objects: Iterable[Row], assets: Mapping[str, Asset] | None = None) -> dict[str, dict[str, Rate]]:
    """Return Col_obj and Col_scene of rooms with objects, by boxes, and by prisms where the assets are given."""
    rooms = list(by_room(objects).values())
    hits = {"bbox": [bbox_hits(own) for own in rooms]}
    if assets is not None:
        hits["prism"] = [prism_hits(own, assets) for own in rooms]
    return {
        kind: {
            "col_obj": rate(sum(int(own.sum()) for own in flags), sum(map(len, flags))),
            "col_scene": rate(sum(bool(own.any()) for own in flags), len(flags)),
        }
        for kind, flags in hits.items()
    }


def sweeps_of(asset_joints: Iterable[Row]) -> dict[str, Floats]:
    """Return the swept boxes of doors, drawers and lids by asset, from rows of the asset_joints table."""
    by_asset: dict[str, list[Any]] = {}
    for row in asset_joints:
        if row["part_class"] in OPENERS:
            by_asset.setdefault(row["asset_id"], []).append([row["sweep_min"], row["sweep_max"]])
    return {asset: np.array(pairs, float).reshape(-1, 2, 3) for asset, pairs in by_asset.items()}


def extended_boxes(objects: Sequence[Row], extension: Extension, sweeps: Sweeps | None = None) -> tuple[Boxes, Ints]:
    """Return the boxes that b' of objects is made of, and the object (its place in `objects`) of each; the objects' own boxes come first."""
    position, yaw, size = boxes(objects)
    parts, owners = [(position, yaw, size)], [*range(len(objects))]
    for i, row in enumerate(objects):
        if not row["openable"]:
            continue
        c, s = np.cos(yaw[i]), np.sin(yaw[i])
        if extension == "heuristic":
            ahead = size[i, 1] / 3
            position[i, :2] += np.array([s, -c]) * ahead / 2
            size[i, 1] += ahead
        elif sweeps is not None and row["asset_id"] in sweeps:
            beyond = beyond_body(sweeps[row["asset_id"]] * np.array(row["scale"], float), size[i])
            low, high = beyond[:, 0], beyond[:, 1]
            x, y = (low + high)[:, 0] / 2, (low + high)[:, 1] / 2
            parts.append((position[i] + np.stack([c * x - s * y, s * x + c * y, low[:, 2]], 1), np.full(len(beyond), yaw[i]), high - low))
            owners += [i] * len(beyond)
    position, yaw, size = (np.concatenate(part) for part in zip(*parts, strict=True))
    return (position, yaw, size), np.array(owners, np.int64)


def are_obstructed(objects: Sequence[Row], extension: Extension, sweeps: Sweeps | None = None) -> list[bool]:
    """Tell of each openable object of a room whether its b' meets any other's b'."""
    parts, owners = extended_boxes(objects, extension, sweeps)
    hit = np.bincount(owners, weights=_meet_others(parts, owners)) > 0
    return [bool(hit[i]) for i, row in enumerate(objects) if row["openable"]]


def _meet_others(parts: Boxes, owners: Ints) -> Bools:
    """Tell of each box (N,) whether it meets one of another owner."""
    return np.asarray(((iou_matrix(*parts) > EPSILON) & (owners[:, None] != owners)).any(1))


def acoll(rng: np.random.Generator, objects: Iterable[Row], extension: Extension, sweeps: Sweeps | None = None) -> dict[str, Mean | Rate]:
    """Return R_acoll: the mean over rooms with openable objects, as printed, and the rate over all such objects."""
    rooms = [flags for own in by_room(objects).values() if (flags := are_obstructed(own, extension, sweeps))]
    hits = [hit for flags in rooms for hit in flags]
    return {"rooms": bootstrap(rng, [float(np.mean(flags)) for flags in rooms]), "objects": rate(sum(hits), len(hits))}


def swept(joints: Iterable[Row]) -> dict[str, Rate]:
    """Return the share of openable objects, of their joints, and of room doors that are blocked on their way."""
    joints = list(joints)
    doors = [not j["clear"] for j in joints if j["part_class"] == "door_leaf"]
    return {**_joint_rates(joints, lambda joint: not joint["clear"]), "doors": rate(sum(doors), len(doors))}


def openable_reach(joints: Iterable[Row]) -> dict[str, Rate]:
    """Return the share of openable objects with a part that opens wholly with a robot at its handle, and of such joints."""
    return _joint_rates(joints, lambda joint: bool(joint["clear"]) and joint["stand"] is not None)


def _joint_rates(joints: Iterable[Row], holds: Callable[[Row], bool]) -> dict[str, Rate]:
    """Return of how many openable objects some joint holds, and of how many joints."""
    verdicts: dict[tuple[str, str], list[bool]] = {}
    for joint in joints:
        if joint["part_class"] in OPENERS:
            verdicts.setdefault((joint["scene_id"], joint["object_id"]), []).append(holds(joint))
    every = [verdict for own in verdicts.values() for verdict in own]
    return {"objects": rate(sum(map(any, verdicts.values())), len(verdicts)), "joints": rate(sum(every), len(every))}
