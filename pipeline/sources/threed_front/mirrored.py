"""Mirror images of models: 3D-FRONT places some furniture with a negative scale, such as an L-shaped sofa of the other hand."""

import dataclasses
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from pipeline.entities.asset import Asset, Link, Mesh
from pipeline.entities.files import load_asset, save_asset
from pipeline.sources.reasons import Row
from pipeline.sources.threed_front.furniture import mirrored_id

FLIP = np.array([-1.0, 1.0, 1.0])


def mirror(asset: Asset) -> Asset:
    """Return the mirror image of a static asset across its width (x), faces turned so that they still look outwards."""
    links = tuple(_link(link) for link in asset.links)
    return dataclasses.replace(asset, asset_id=mirrored_id(asset.asset_id), links=links)


def _link(link: Link) -> Link:
    turn = np.outer(FLIP, FLIP)
    visuals, colliders = (tuple(map(_mesh, meshes)) for meshes in (link.visuals, link.colliders))
    return dataclasses.replace(link, visuals=visuals, colliders=colliders, com=link.com * FLIP + 0.0, inertia=link.inertia * turn + 0.0)


def _mesh(mesh: Mesh) -> Mesh:
    return dataclasses.replace(mesh, vertices=mesh.vertices * FLIP.astype(np.float32) + np.float32(0), faces=mesh.faces[:, ::-1].copy())


def add_mirrored(folder: Path, assets: list[Row], used: Iterable[str]) -> list[Row]:
    """Write the mirror images that are among the `used` asset ids, and return their rows of the assets table.

    `assets` are the rows of the models themselves, whose files lie in `folder`.
    """
    origin = {mirrored_id(row["asset_id"]): row for row in assets}
    rows = []
    for asset_id in sorted(set(used) & origin.keys()):
        row = origin[asset_id]
        file = f"{asset_id}.safetensors"
        digest = save_asset(folder / file, mirror(load_asset(folder / row["file"])))
        rows.append({**row, "asset_id": asset_id, "file": file, "sha256": digest})
    return rows
