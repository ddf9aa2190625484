"""Collisions of objects at rest: Col_obj, the share of objects in another, and Col_scene, the share of rooms with any.

`bbox`: rotated boxes with an IoU above 0, as peers' `rotated_bbox`. `prism`: the assets' convex pieces, where the peers
test vertices against watertight meshes; a chair under its table collides as a box and not as what it is.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset
from pipeline.geometry.boxes import iou_matrix
from pipeline.geometry.contact import group_boxes, pair_depths
from pipeline.geometry.prisms import join_prisms, solid
from pipeline.metrics.intervals import Rate, rate
from pipeline.metrics.rows import Row, boxes, by_room

EPSILON = 1e-4  # an IoU below this is two boxes that touch [-]
TOUCH = 0.005  # pieces that are in each other by no more touch [m]


def bbox_hits(objects: Sequence[Row]) -> NDArray[np.bool_]:
    """Tell of each object (N,) of a room whether its box is in another's."""
    if not objects:
        return np.zeros(0, np.bool_)
    iou = iou_matrix(*boxes(objects))
    np.fill_diagonal(iou, 0.0)
    hits: NDArray[np.bool_] = iou.max(1) > EPSILON
    return hits


def prism_hits(objects: Sequence[Row], assets: Mapping[str, Asset], touch: float = TOUCH) -> NDArray[np.bool_]:
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
    hits: NDArray[np.bool_] = depths.max(1) > 0
    return hits


def rates(objects: Iterable[Row], assets: Mapping[str, Asset] | None = None) -> dict[str, dict[str, Rate]]:
    """Return Col_obj and Col_scene of rooms with objects, by boxes, and by prisms where the assets are given."""
    rooms = list(by_room(objects).values())
    flags = {"bbox": [bbox_hits(own) for own in rooms]}
    if assets is not None:
        flags["prism"] = [prism_hits(own, assets) for own in rooms]
    return {kind: _rates(hits) for kind, hits in flags.items()}


def _rates(flags: Sequence[NDArray[np.bool_]]) -> dict[str, Rate]:
    return {
        "col_obj": rate(sum(int(f.sum()) for f in flags), sum(len(f) for f in flags)),
        "col_scene": rate(sum(bool(f.any()) for f in flags), len(flags)),
    }
