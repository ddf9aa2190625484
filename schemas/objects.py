"""objects: one row per placed object."""

import pyarrow as pa

from schemas.table import LATENT, VEC3, Column, Table

OBJECTS = Table(
    "objects",
    "One row per placed object.",
    (
        Column("scene_id", pa.string(), "the home"),
        Column("object_id", pa.string(), "unique in the home"),
        Column("room_id", pa.string(), "the room"),
        Column("category", pa.string(), "object category, see manifests/categories"),
        Column("asset_id", pa.string(), "row of the assets table"),
        Column("position", VEC3, "bottom centre of the asset's box with all joints at 0", "m", "world"),
        Column("yaw", pa.float64(), "right-handed about +Z; at 0 the front faces -Y", "rad", "world"),
        Column("size", VEC3, "full extents (w, d, h)", "m", "object"),
        Column("scale", VEC3, "factor on the asset's own size; 1 for articulated assets", "", "object"),
        Column("openable", pa.bool_(), "has a door, drawer or lid that opens"),
        Column("support", pa.string(), "object that it stands on or in; empty: the floor, a wall, the ceiling"),
        Column("latent", LATENT, "the shape latent that the layout model asked for; zeros in training tables"),
        Column("retrieval_distance", pa.float64(), "distance of the match, see pipeline/retrieval"),
        Column("source_id", pa.string(), "id of the object in its source; empty for generated homes"),
    ),
)
