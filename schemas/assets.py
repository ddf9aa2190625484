"""assets and asset_joints: the library of things that can be placed."""

import pyarrow as pa

from schemas.table import NAMES, VEC3, Column, Table

ASSETS = Table(
    "assets",
    "One row per asset (a model at a scale; one PartNet object may serve several categories).",
    (
        Column("asset_id", pa.string(), "unique in the library; matches [a-z][a-z0-9_]*"),
        Column("source", pa.string(), "3d-future, partnet-mobility, gapartnet ..."),
        Column("source_id", pa.string(), "id in that source"),
        Column("category", pa.string(), "object category, see manifests/categories"),
        Column("super_category", pa.string(), "super-category"),
        Column("style", pa.string(), "style, empty when unknown"),
        Column("material", pa.string(), "main material, empty when unknown"),
        Column("split", pa.string(), "train, val or test, by model"),
        Column("size", VEC3, "full extents (w, d, h) with all joints at 0", "m", "object"),
        Column("unit_scale", pa.float64(), "factor from the source's units to metres"),
        Column("scale_from", pa.string(), "where that is from: file (its own unit), or the category to whose sizes it was fitted"),
        Column(
            "scale_rms",
            pa.float64(),
            "deviation of the size from that category's, in standard deviations; null: of a model's own unit",
            nullable=True,
        ),
        Column("articulated", pa.bool_(), "has joints"),
        Column("openable", pa.bool_(), "has a door, drawer or lid that opens"),
        Column("joints", pa.int32(), "number of joints"),
        Column("triangles", pa.int32(), "triangles of the visual meshes"),
        Column("mass", pa.float64(), "mass of all links", "kg"),
        Column("density", pa.float64(), "density of the matter from whose volume it was taken", "kg/m3"),
        Column("licence", pa.string(), "SPDX id or name of the asset's licence"),
        Column("file", pa.string(), "path of the asset file, relative to the folder of the library"),
        Column("sha256", pa.string(), "digest of that file"),
    ),
)

ASSET_JOINTS = Table(
    "asset_joints",
    "One row per joint of an asset.",
    (
        Column("asset_id", pa.string(), "row of the assets table"),
        Column("joint_id", pa.string(), "unique in the asset; matches [a-z][a-z0-9_]*"),
        Column("type", pa.string(), "revolute, prismatic or continuous"),
        Column("part_class", pa.string(), "GAPartNet part class"),
        Column("inferred", pa.bool_(), "the part class is a guess from names and shape; the source does not say"),
        Column("axis", VEC3, "unit axis; positive motion opens", "", "object"),
        Column("origin", VEC3, "a point on the axis at rest", "m", "object"),
        Column("lower", pa.float64(), "lower limit (rad or m)"),
        Column("upper", pa.float64(), "upper limit (rad or m)"),
        Column("after", NAMES, "joints of the asset that must be open before it can move: a drawer behind a door"),
        Column("sweep_min", VEC3, "lower corner of the box that the moving part sweeps", "m", "object"),
        Column("sweep_max", VEC3, "upper corner of that box", "m", "object"),
        Column("handle", VEC3, "where a hand takes hold, at rest", "m", "object"),
    ),
)

ASSET_PARTS = Table(
    "asset_parts",
    "One row per part of an asset in GAPartNet's sense: what moves, and the handles and buttons on it.",
    (
        Column("asset_id", pa.string(), "row of the assets table"),
        Column("joint_id", pa.string(), "joint with which the part moves, row of asset_joints; empty: it is fixed to the base"),
        Column("part_class", pa.string(), "GAPartNet part class"),
        Column("annotated", pa.bool_(), "the class is the source's own; otherwise it was inferred"),
        Column("centre", VEC3, "middle of the part's oriented box at rest", "m", "object"),
        Column("axis_x", VEC3, "unit x of the box: a hinge's axis in the opening sense, the long side of a handle", "", "object"),
        Column("axis_y", VEC3, "unit y of the box: z x x", "", "object"),
        Column("axis_z", VEC3, "unit z of the box: outwards", "", "object"),
        Column("size", VEC3, "full extents along x, y, z of the box", "m", "part"),
    ),
)

LATENTS = Table(
    "latents",
    "One row per asset: its shape latent, and the colour that most of it has.",
    (
        Column("asset_id", pa.string(), "row of the assets table"),
        Column("latent", pa.list_(pa.float32(), 32), "posterior mean of the point-cloud VAE"),
        Column("finish", VEC3, "colour of most of the surface, CIELAB under D65; null where there is no surface", nullable=True),
    ),
)
