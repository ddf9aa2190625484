"""scenes: one row per home (or per source house, in the training tables)."""

import pyarrow as pa

from schemas.table import Column, Table

SCENES = Table(
    "scenes",
    "One row per home.",
    (
        Column("scene_id", pa.string(), "s<seed>_<index:08d>; in training tables the source house"),
        Column("index", pa.int64(), "position in the dataset"),
        Column("seed", pa.int64(), "seed of the dataset"),
        Column("split", pa.string(), "train, val or test; split by house"),
        Column("prompt", pa.string(), "the request in words, empty where there was none"),
        Column("program", pa.string(), "the typed request as JSON (FloorProgram), empty in training tables"),
        Column("storeys", pa.int32(), "number of storeys"),
        Column("storey_height", pa.float64(), "floor to floor", "m"),
        Column("inner_wall", pa.float64(), "thickness of walls between rooms", "m"),
        Column("outer_wall", pa.float64(), "thickness of outside walls", "m"),
        Column("entrance", pa.string(), "room that one enters from outside; empty when unknown"),
        Column("area", pa.float64(), "sum of the rooms' areas", "m2"),
        Column("rooms", pa.int32(), "number of rooms"),
        Column(
            "objects",
            pa.int32(),
            "pieces of furniture; small things (categories that the layout model does not learn) are not counted, but in training tables",
        ),
        Column("openable", pa.int32(), "pieces of furniture with a door, drawer or lid that opens"),
        Column("joints", pa.int32(), "number of joints, room doors included"),
        Column("joints_clear", pa.int32(), "joints that move through their whole range without touching anything"),
        Column("collisions", pa.int32(), "objects that intersect another object or a wall"),
        Column("reach", pa.float64(), "share of openable furniture that the robot can stand at and open"),
        Column("walkable_paper", pa.float64(), "(A_room - sum A_i) / A_room over the home, paper eq. walkable_ratio"),
        Column("walkable_free", pa.float64(), "largest connected free floor that a robot can stand on / floor area"),
        Column("attempts", pa.int32(), "attempts that the home took"),
        Column("licence", pa.string(), "SPDX id or name of the licence that binds the home"),
        Column("usd", pa.string(), "path of the stage, relative to the dataset; empty where there is none"),
        Column("usd_sha256", pa.string(), "digest of that file"),
    ),
)
