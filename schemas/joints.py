"""joints: one row per joint of a placed object or room door."""

import pyarrow as pa

from schemas.table import NAMES, VEC3, Column, Table

JOINTS = Table(
    "joints",
    "One row per joint of a placed object, or of a room door (object_id is then the opening_id).",
    (
        Column("scene_id", pa.string(), "the home"),
        Column("object_id", pa.string(), "the object, or the opening of a room door"),
        Column("joint_id", pa.string(), "unique in the object; the name of the USD joint prim"),
        Column("type", pa.string(), "revolute, prismatic or continuous"),
        Column("part_class", pa.string(), "GAPartNet part class of what moves, door_leaf for room doors"),
        Column("axis", VEC3, "unit axis; positive motion opens", "", "world"),
        Column("origin", VEC3, "a point on the axis at rest", "m", "world"),
        Column("lower", pa.float64(), "lower limit (rad or m)"),
        Column("upper", pa.float64(), "upper limit (rad or m)"),
        Column("after", NAMES, "joints of the object that must be open before it can move; it is judged with them open"),
        Column("clear_upper", pa.float64(), "largest position that is reached from 0 without touching (rad or m)"),
        Column("clear", pa.bool_(), "the whole range is free, and that of the joints it waits for"),
        Column("blocker", pa.string(), "what it touches first; empty when clear"),
        Column("stand", VEC3, "x, y, yaw at which a robot can stand to open it", "m, m, rad", "world", nullable=True),
    ),
)
