"""Articulation: R_acoll, the share of articulated objects whose extended boxes meet others (paper eq. acoll_metric).

The extended box b' comes in two kinds. `heuristic`: a third of the depth is added ahead, as peers and presumably the
paper do, whatever the joints are. `joints`: the asset's box and, per joint, the box of what it sweeps beyond it. Beside them
stands `swept`: the share of objects with a joint that touches something on its way, as the judge found it with prisms.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.geometry.boxes import iou_matrix
from pipeline.geometry.kinematics import OPENERS, beyond_body
from pipeline.metrics.intervals import Mean, Rate, bootstrap, rate
from pipeline.metrics.rows import Boxes, Row, boxes, by_room

Extension = Literal["heuristic", "joints"]
Sweeps = Mapping[str, Floats]  # asset_id -> (J, 2, 3) [m, object frame]: boxes that the joints sweep

EPSILON = 1e-4  # an IoU below this is two boxes that touch [-]; the paper's "> 0" on rounded poses


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
            swept = beyond_body(sweeps[row["asset_id"]] * np.array(row["scale"], float), size[i])
            low, high = swept[:, 0], swept[:, 1]
            x, y = (low + high)[:, 0] / 2, (low + high)[:, 1] / 2
            parts.append((position[i] + np.stack([c * x - s * y, s * x + c * y, low[:, 2]], 1), np.full(len(swept), yaw[i]), high - low))
            owners += [i] * len(swept)
    position, yaw, size = (np.concatenate(part) for part in zip(*parts, strict=True))
    return (position, yaw, size), np.array(owners, np.int64)


def are_obstructed(objects: Sequence[Row], extension: Extension, sweeps: Sweeps | None = None) -> list[bool]:
    """Tell of each openable object of a room whether its b' meets any other's b'."""
    if not objects:
        return []
    parts, owners = extended_boxes(objects, extension, sweeps)
    meet = (iou_matrix(*parts) > EPSILON) & (owners[:, None] != owners)
    hit = np.bincount(owners, weights=meet.any(1)) > 0
    return [bool(hit[i]) for i, row in enumerate(objects) if row["openable"]]


def acoll(rng: np.random.Generator, objects: Iterable[Row], extension: Extension, sweeps: Sweeps | None = None) -> dict[str, Mean | Rate]:
    """Return R_acoll: the mean over rooms with openable objects, as printed, and the rate over all such objects."""
    rooms = [flags for own in by_room(objects).values() if (flags := are_obstructed(own, extension, sweeps))]
    hits = [hit for flags in rooms for hit in flags]
    return {"rooms": bootstrap(rng, [float(np.mean(flags)) for flags in rooms]), "objects": rate(sum(hits), len(hits))}


def swept(joints: Iterable[Row]) -> dict[str, Rate]:
    """Return the share of openable objects, of their joints, and of room doors that are blocked on their way."""
    every = list(joints)
    listed = [j for j in every if j["part_class"] in OPENERS]
    doors = [j for j in every if j["part_class"] == "door_leaf"]
    blocked: dict[tuple[str, str], bool] = {}
    for j in listed:
        key = (j["scene_id"], j["object_id"])
        blocked[key] = blocked.get(key, False) or not j["clear"]
    return {
        "objects": rate(sum(blocked.values()), len(blocked)),
        "joints": rate(sum(not j["clear"] for j in listed), len(listed)),
        "doors": rate(sum(not j["clear"] for j in doors), len(doors)),
    }
