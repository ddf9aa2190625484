"""A home's stage: the building, and a reference for every placed object."""

import functools
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from pxr import Sdf

from pipeline.entities.asset import Asset
from pipeline.entities.home import Home, Placement
from pipeline.errors import ContentError
from pipeline.geometry.masonry import masonry
from pipeline.geometry.walls import Prism, levels, shell
from pipeline.usd.layer import read_layer, save
from pipeline.usd.lights import lamp, sky
from pipeline.usd.material import Palette
from pipeline.usd.physics import convert_scene
from pipeline.usd.prim_templates import group, instantiate, quote, template_of, transform_ops
from pipeline.usd.shared_boards import OVER, boards_felt_elsewhere
from pipeline.usd.shell import MATERIALS, door_texts, room_text, walls_text, window_texts


def write_home(home: Home, assets: Mapping[str, Asset], path: Path, library: str = "../../assets") -> Path:
    """Write the stage of a home to `path` (.usdc or .usda); see `home_layer`."""
    return save(home_layer(home, assets, library, path.suffix), path)


def home_layer(home: Home, assets: Mapping[str, Asset], library: str = "../../assets", suffix: str = ".usdc") -> Sdf.Layer:
    """Return the stage of a home, not written yet.

    `assets` holds those that the home places, by id; `library` is the folder of the asset library as seen from the
    stage's folder, for references like `../../assets/<asset_id>/<asset_id>.usda`.
    """
    plan, materials = home.plan, Palette(MATERIALS)
    groups: dict[str, list[str]] = {name: [] for name in ("Rooms", "Walls", "Doors", "Windows", "Objects", "Lights")}
    groups["Lights"].append(instantiate(sky(), "/World/Lights/Sky"))
    shells = {level: shell(plan, level) for level in levels(plan)}
    building: list[Prism] = []
    for level, built in shells.items():
        elevation = level * plan.storey_height
        solids = [solid for solid in masonry(plan, level, built) if solid.bottom < OVER]  # nothing of a robot comes to lintels and ceilings
        building += [replace(solid, bottom=solid.bottom + elevation, top=solid.top + elevation) for solid in solids]
        groups["Walls"].append(walls_text("/World/Walls", plan, level, built, solids, materials))
        groups["Doors"] += door_texts("/World/Doors", elevation, built, materials)
        groups["Windows"] += window_texts("/World/Windows", elevation, built, materials)
        for room in plan.rooms:
            if room.level == level:
                groups["Rooms"].append(room_text("/World/Rooms", plan, room, shells, materials))
                groups["Lights"].append(lamp(f"/World/Lights/{room.room_id}", room, plan.levels_of(room)[-1] * plan.storey_height))
    spared = boards_felt_elsewhere(plan, [p for p in home.placements if p.asset_id in assets], assets, building)
    groups["Objects"] += [placement_text("/World/Objects", p, assets, library, spared.get(p.object_id, ())) for p in home.placements]
    parts = [instantiate(group("group"), f"/World/{name}", "".join(texts)) for name, texts in groups.items()]
    world = instantiate(group("assembly"), "/World", "".join([materials.text(), *parts]))
    about = {"scene_id": home.scene_id, "prompt": home.prompt, "generator": "sfgen"}
    return read_layer(world + instantiate(_scene(), "/PhysicsScene"), "World", suffix, about)


@functools.cache
def _scene() -> str:
    return template_of(lambda layer: convert_scene(layer, "Template"))


def placement_text(parent: str, placement: Placement, assets: Mapping[str, Asset], library: str, spared: Sequence[str] = ()) -> str:
    """Return one placed object: a reference, where it stands, on what, its room; articulated ones at their own size only.

    Of its colliders those at the paths `spared` below it are left out.
    """
    asset = assets.get(placement.asset_id)
    if asset is None:
        message = f"object {placement.object_id} places asset {placement.asset_id!r}, which is not in the library"
        raise ContentError(message, "run preprocess again")
    if asset.articulated and any(abs(s - 1) > 1e-9 for s in placement.scale):
        message = f"object {placement.object_id} scales the articulated asset {asset.asset_id}"
        raise ContentError(message, "place it with scale 1: joints break otherwise")
    about = f"bool articulated = {int(asset.articulated)}\nstring room_id = {quote(placement.room_id)}\n"
    support = f"rel sfgen:support = <{parent}/{placement.support}>\n" if placement.support else ""
    return (
        f'def Xform "{placement.object_id}" (\n'
        f"customData = {{\n{about}}}\n"
        f"prepend references = @{library}/{asset.asset_id}/{asset.asset_id}.usda@\n)\n"
        f"{{\n{transform_ops(placement.position.tolist(), placement.yaw, placement.scale.tolist())}{support}{_without(spared)}}}\n"
    )


def _without(paths: Sequence[str]) -> str:
    """Return what switches prims `<link>/<collider>` off."""
    by_link: dict[str, list[str]] = {}
    for link, name in (path.split("/") for path in paths):
        by_link.setdefault(link, []).append(f'over "{name}" (\nactive = false\n)\n{{\n}}\n')
    return "".join(f'over "{link}"\n{{\n{"".join(overs)}}}\n' for link, overs in by_link.items())
