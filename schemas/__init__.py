"""The tables: a YAML file each, columns with type, unit, frame and doc. Standard library, PyYAML and pyarrow only."""

from schemas.table import read_table

SCENES, ROOMS, OPENINGS, OBJECTS, JOINTS, REJECTS = map(read_table, ("scenes", "rooms", "openings", "objects", "joints", "rejects"))
ASSETS, ASSET_JOINTS, ASSET_PARTS, LATENTS = map(read_table, ("assets", "asset_joints", "asset_parts", "latents"))
