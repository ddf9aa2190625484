"""A home's stage: the building, and a reference for every placed object."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pxr import Sdf

from pipeline.entities.asset import Asset
from pipeline.entities.home import Home, Placement
from pipeline.errors import ContentError
from pipeline.geometry.walls import levels, shell
from pipeline.usd.layer import new_layer, place, prim, relationship, save
from pipeline.usd.lights import convert_dome, convert_lamp
from pipeline.usd.material import Palette
from pipeline.usd.physics import convert_scene
from pipeline.usd.shell import convert_doors, convert_room, convert_walls, convert_windows


def write_home(home: Home, assets: Mapping[str, Asset], path: Path, library: str = "../../assets") -> Path:
    """Write the stage of a home to `path` (.usdc or .usda).

    `assets` holds those that the home places, by id; `library` is the folder of the asset library as seen from the
    stage's folder, for references like `../../assets/<asset_id>/<asset_id>.usda`.
    """
    layer = new_layer("World", path.suffix, _about(home))
    world = prim(layer, "World")
    world.kind = "assembly"
    convert_scene(layer)
    materials = Palette(world)
    rooms, walls, doors, windows, objects, lights = (
        prim(world, name) for name in ("Rooms", "Walls", "Doors", "Windows", "Objects", "Lights")
    )
    for group in (rooms, walls, doors, windows, objects, lights):
        group.kind = "group"
    convert_dome(lights)
    shells = {level: shell(home.plan, level) for level in levels(home.plan)}
    for level, built in shells.items():
        elevation = level * home.plan.storey_height
        convert_walls(walls, home.plan, level, built, materials)
        convert_doors(doors, elevation, built, materials)
        convert_windows(windows, elevation, built, materials)
        for room in home.plan.rooms:
            if room.level == level:
                convert_room(rooms, home.plan, room, shells, materials)
                convert_lamp(lights, room, home.plan.levels_of(room)[-1] * home.plan.storey_height)
    for placement in home.placements:
        convert_placement(objects, placement, assets, library)
    return save(layer, path)


def convert_placement(parent: Sdf.PrimSpec, placement: Placement, assets: Mapping[str, Asset], library: str) -> Sdf.PrimSpec:
    """Write one placed object: a reference, where it stands, on what, its room; articulated ones at their own size only."""
    asset = assets.get(placement.asset_id)
    if asset is None:
        raise ContentError(
            f"object {placement.object_id} places asset {placement.asset_id!r}, which is not in the library", "run preprocess again"
        )
    if asset.articulated and any(abs(s - 1) > 1e-9 for s in placement.scale):
        raise ContentError(
            f"object {placement.object_id} scales the articulated asset {asset.asset_id}", "place it with scale 1: joints break otherwise"
        )
    spec = prim(parent, placement.object_id)
    spec.referenceList.prependedItems = [Sdf.Reference(f"{library}/{asset.asset_id}/{asset.asset_id}.usda")]
    place(spec, placement.position.tolist(), placement.yaw, placement.scale.tolist())
    if placement.support:
        relationship(spec, "sfgen:support", [parent.path.AppendChild(placement.support)])
    spec.customData = {"articulated": asset.articulated, "room_id": placement.room_id}
    return spec


def _about(home: Home) -> dict[str, object]:
    return {"scene_id": home.scene_id, "prompt": home.prompt, "generator": "sfgen"}
