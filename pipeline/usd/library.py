"""The asset library: a folder per asset with interface, payload, MuJoCo overlay, textures and thumbnail."""

from collections.abc import Iterable
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import Any

import numpy as np
from pxr import Gf, Sdf

from pipeline.entities.asset import Asset
from pipeline.errors import ContentError
from pipeline.rendering.thumbnail import thumbnail
from pipeline.usd.articulation import convert_asset, loose
from pipeline.usd.layer import attribute, label, new_layer, prim, save, vec3s
from pipeline.usd.material import convert_materials
from pipeline.usd.mujoco import asset_overlay

VARIANT_SET = "MuJoCo"
WIKIDATA = MappingProxyType(  # by super-category, where the item is beyond doubt
    {"chair": "Q15026", "table": "Q14748", "bed": "Q42177", "sofa": "Q131514"}
)


def write_library(assets: Iterable[Asset], folder: Path) -> list[Path]:
    """Write every asset as `folder`/<asset_id>/ and return the files, in the order they were written."""
    return [path for asset in assets for path in write_asset(asset, folder / asset.asset_id)]


def write_asset(asset: Asset, folder: Path) -> list[Path]:
    """Write one asset: interface .usda, payload .usdc (file names carry the id, so that packages never confuse them).

    Nothing is flushed to disk here: the commit of the library does that for all files at once.
    """
    payload = _payload(asset)
    written = [save(payload, folder / f"{asset.asset_id}_payload.usdc"), save(_interface(asset), folder / f"{asset.asset_id}.usda")]
    if asset.articulated:
        written.append(save(asset_overlay(asset, payload), folder / overlay_path(asset)))
    for name, blob in sorted(asset.textures.items()):
        target = PurePosixPath(name)
        if target.is_absolute() or ".." in target.parts:
            raise ContentError(f"asset {asset.asset_id} has a texture outside its folder: {name!r}", "run the preprocess stage again")
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(blob)
        written.append(folder / name)
    picture = folder / ".thumbs" / "256x256" / f"{asset.asset_id}.usda.png"  # where Omniverse and SimReady look for it
    picture.parent.mkdir(parents=True, exist_ok=True)
    thumbnail(asset).save(picture)
    return [*written, picture]


def overlay_path(asset: Asset) -> str:
    """Return where an asset's MuJoCo overlay lies, relative to its folder."""
    return f"runnables/physics/{asset.asset_id}_mujoco.usda"


def _payload(asset: Asset) -> Sdf.Layer:
    layer = new_layer(asset.asset_id, ".usdc")
    root = prim(layer, asset.asset_id)
    convert_asset(root, asset, convert_materials(root, asset.materials))
    return layer


def _interface(asset: Asset) -> Sdf.Layer:
    layer = new_layer(asset.asset_id, ".usda", _about(asset))
    root = prim(layer, asset.asset_id, "Xform", ["GeomModelAPI"])
    root.kind = "component"
    root.payloadList.prependedItems = [Sdf.Payload(f"./{asset.asset_id}_payload.usdc")]
    label(root, "class", [asset.category])
    if asset.super_category in WIKIDATA:
        label(root, "wikidata_qcode", [WIKIDATA[asset.super_category]])
    low, high = bounds(asset)
    attribute(root, "extentsHint", "float3[]", vec3s(np.array([low, high])))
    if asset.articulated:
        root.variantSetNameList.prependedItems = [VARIANT_SET]
        root.variantSelections[VARIANT_SET] = "Disabled"
        variants = Sdf.VariantSetSpec(root, VARIANT_SET)
        Sdf.VariantSpec(variants, "Disabled")
        enabled = Sdf.VariantSpec(variants, "Enabled")
        enabled.primSpec.payloadList.prependedItems = [Sdf.Payload(f"./{overlay_path(asset)}")]
    return layer


def bounds(asset: Asset) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return the corners (3,), (3,) of the asset's visual box at rest [m]."""
    points = np.concatenate([m.vertices for m in asset.meshes()] or [np.zeros((1, 3), np.float32)])
    return points.min(axis=0), points.max(axis=0)


def _about(asset: Asset) -> dict[str, Any]:
    """Return the interface's metadata, after SimReady's names; no date, so that the bytes depend on the asset alone."""
    low, high = bounds(asset)
    # where the variant of a runtime is turned on, for who looks for it without composing anything
    where = {"prim": f"/{asset.asset_id}", "variantSetName": VARIANT_SET, "activateOption": "Enabled"}
    return {
        "asset_name": asset.asset_id,
        "asset_type": asset.category,
        "source_file": f"{asset.source}:{asset.source_id}",
        "SimReady_Metadata": {
            "asset_name": asset.asset_id,
            "category": asset.category,
            "super_category": asset.super_category,
            "style": asset.style,
            "asset_license": asset.licence,
            "rigid_body_count": len(asset.links) if asset.articulated or loose(asset) else 0,
            "collider_count": sum(len(link.colliders) for link in asset.links),
            "mass": float(sum(link.mass for link in asset.links)),
            "asset_extents": Gf.Vec3f(*map(float, high - low)),
            **({"Variants": {"Physics": {VARIANT_SET: where}}} if asset.articulated else {}),
        },
    }
