"""Rows of tables for the tests of metrics."""

import math

import numpy as np

from tests.geometry.furniture import LIBRARY


def object_row(asset_id, x, y, yaw=0.0, z=0.0, room="room", scene="s0", number=0):
    asset = LIBRARY[asset_id]
    return {
        "scene_id": scene,
        "object_id": f"{asset_id}_{number}",
        "room_id": room,
        "category": asset.category,
        "asset_id": asset_id,
        "position": [x, y, z],
        "yaw": yaw,
        "size": asset.size.tolist(),
        "scale": [1.0, 1.0, 1.0],
        "openable": asset.openable,
    }


def room_row(objects, scene="s0", room="room", polygon=((0, 0), (4, 0), (4, 3), (0, 3)), **more):
    row = {
        "scene_id": scene,
        "room_id": room,
        "layout_type": "bedroom",
        "level": 0,
        "polygon": [list(map(float, p)) for p in polygon],
        "objects": objects,
        "asked_objects": None,
        "openable": 0,
        "openable_sampled": None,
        "walkable_paper": 1.0,
        "walkable_free": 1.0,
        "walkable_target": None,
    }
    assert not more.keys() - row.keys()
    return row | more


def joint_row(object_id, *, clear=True, stand=(0.0, 0.0, 0.0), part="slider_drawer", scene="s0"):
    return {"scene_id": scene, "object_id": object_id, "joint_id": "j", "part_class": part, "clear": clear, "stand": stand}


def moved_rows(rows, angle, shift):
    c, s = math.cos(angle), math.sin(angle)
    made = []
    for row in rows:
        x, y, z = row["position"]
        made.append(row | {"position": [c * x - s * y + shift[0], s * x + c * y + shift[1], z], "yaw": row["yaw"] + angle})
    return made


def random_rows(seed, names=("chest", "cupboard", "bed", "table", "chair", "nightstand")):
    rng = np.random.default_rng(seed)
    return [object_row(n, *rng.uniform(0.5, 2.8, 2), rng.uniform(-3, 3), number=k) for k, n in enumerate(names)]
