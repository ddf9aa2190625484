"""rooms: one row per room."""

import pyarrow as pa

from schemas.table import POLYGON, Column, Table

ROOMS = Table(
    "rooms",
    "One row per room.",
    (
        Column("scene_id", pa.string(), "the home"),
        Column("room_id", pa.string(), "unique in the home"),
        Column("type", pa.string(), "room type, see manifests/rooms.yaml"),
        Column("layout_type", pa.string(), "room type of the layout model; with a + between them those of a room that serves as several"),
        Column("role", pa.string(), "primary, guest, child ...; empty where there is none"),
        Column("level", pa.int32(), "storey, from 0"),
        Column("height", pa.float64(), "ceiling height", "m"),
        Column("area", pa.float64(), "area of the polygon", "m2"),
        Column("polygon", POLYGON, "inner wall faces, counter-clockwise, not closed", "m", "world"),
        Column("objects", pa.int32(), "pieces of furniture in the room; in training tables small things as well"),
        Column("asked_objects", pa.int32(), "number of objects that was asked for", nullable=True),
        Column("openable", pa.int32(), "those that open"),
        Column("openable_sampled", pa.int32(), "openable objects that the layout model had placed", nullable=True),
        Column("walkable_paper", pa.float64(), "(A_room - sum A_i) / A_room, paper eq. walkable_ratio"),
        Column("walkable_free", pa.float64(), "largest connected free floor for the robot / A_room"),
        Column("walkable_target", pa.float64(), "the tau that was asked for", nullable=True),
        Column("source_id", pa.string(), "id of the room in its source; empty for generated homes"),
    ),
)
