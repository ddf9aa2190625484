"""openings: one row per door, open front, portal, window or entrance."""

import pyarrow as pa

from schemas.table import POLYGON, Column, Table

OPENINGS = Table(
    "openings",
    "One row per opening in a wall.",
    (
        Column("scene_id", pa.string(), "the home"),
        Column("opening_id", pa.string(), "unique in the home"),
        Column("kind", pa.string(), "door, open, portal, window or entrance"),
        Column("rooms", pa.list_(pa.string()), "the two rooms it joins, or one where the other side is outside"),
        Column("segment", POLYGON, "two end points of the clear width on the wall's centre line", "m", "world"),
        Column("width", pa.float64(), "clear width", "m"),
        Column("height", pa.float64(), "height of the hole", "m"),
        Column("sill", pa.float64(), "lower edge above the floor", "m"),
        Column("swing_room", pa.string(), "room into which the leaf swings; empty without a leaf"),
        Column("swing_hinge", pa.int32(), "end of the segment (0 or 1) at which the hinge sits", nullable=True),
        Column("swing_angle", pa.float64(), "largest opening angle", "rad", nullable=True),
        Column("level", pa.int32(), "storey, from 0"),
    ),
)
