"""What MuJoCo needs otherwise: the articulation root on the base link, which hangs on the world (simulators of 2026).

MuJoCo's decoder takes any prim with an articulation root for a body and drops joints to non-bodies, so a base that is
fixed to its own Xform would float there. The overlays say the same thing in its words; other engines never see them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from pxr import Sdf, Vt

from pipeline.entities.asset import Asset
from pipeline.usd.articulation import joint_names, link_names, loose
from pipeline.usd.layer import apply, attribute, new_layer, over, relationship, save
from pipeline.usd.physics import gravity_load

ROOT_API = "PhysicsArticulationRootAPI"
HINGE = (0.02, 0.1)  # damping [N m s / degree], dry friction [N m]: a push opens a door, a touch does not
SLIDE = (12.0, 1.5)  # damping [N s / m], dry friction [N]
HOLD = 1.3  # dry friction, in multiples of what gravity does to a closed flap or lid, so that it stays closed
STOP = ((0.008, 1.0), (0.99, 0.999, 1e-4, 0.5, 2.0))  # solref and solimp of the limits: hard stops even for light knobs and buttons


@dataclass(frozen=True, slots=True)
class Resistance:
    """What holds a joint back; `damping` per degree for hinges, `friction` [N m or N]."""

    name: str
    damping: float
    friction: float


def asset_overlay(asset: Asset) -> Sdf.Layer:
    """Return the layer behind an articulated asset's variant MuJoCo=Enabled."""
    layer = new_layer(asset.asset_id, ".usda")
    _convert_root(over(layer, asset.asset_id), asset)
    return layer


def write_mujoco_overlay(scene: Path) -> Path:
    """Write `<scene>.mujoco.usda` beside a home's stage: the same home for MuJoCo. Returns its path."""
    source = Sdf.Layer.OpenAsAnonymous(str(scene))
    world = source.GetPrimAtPath(f"/{source.defaultPrim}")
    layer = new_layer(source.defaultPrim, ".usda")
    layer.subLayerPaths.append(f"./{scene.name}")
    root = over(layer, source.defaultPrim)
    objects = world.nameChildren.get("Objects")
    if objects is not None:
        scope = over(root, "Objects")
        for spec in objects.nameChildren:
            if spec.customData.get("articulated", False):
                over(scope, spec.name).variantSelections["MuJoCo"] = "Enabled"
    doors = world.nameChildren.get("Doors")
    if doors is not None:
        scope = over(root, "Doors")
        for spec in doors.nameChildren:
            _convert_over(over(scope, spec.name), "frame", [Resistance("hinge", *HINGE)])
    return save(layer, scene.with_name(f"{scene.stem}.mujoco.usda"))


def _convert_root(root: Sdf.PrimSpec, asset: Asset) -> None:
    resistances = [_resistance(name, asset, index) for index, name in enumerate(joint_names(asset))]
    _convert_over(root, link_names(asset)[0], resistances, fixed=not loose(asset))


def _resistance(name: str, asset: Asset, index: int) -> Resistance:
    """Choose a joint's resistance; what gravity would pull open is held closed by friction."""
    damping, friction = SLIDE if asset.joints[index].type == "prismatic" else HINGE
    return Resistance(name, damping, friction + HOLD * max(0.0, gravity_load(asset, index)))


def _convert_over(root: Sdf.PrimSpec, base: str, joints: Iterable[Resistance], *, fixed: bool = True) -> None:
    """Move the articulation root to the base, hang the base on the world where it is fixed, give the joints their resistance."""
    removal = Sdf.TokenListOp()
    removal.deletedItems = [ROOT_API]
    root.SetInfo("apiSchemas", removal)
    apply(over(root, base), [ROOT_API])
    scope = over(root, "joints")
    if fixed:
        relationship(over(scope, "world_fixed"), "physics:body0", [])
    for joint in joints:
        spec = over(scope, joint.name)
        apply(spec, ["NewtonJointAPI", "MjcJointAPI"])  # MuJoCo reads no DriveAPI, but these
        attribute(spec, "newton:damping", "float", joint.damping)
        attribute(spec, "newton:friction", "float", joint.friction)
        for attribute_name, values in zip(("mjc:solreflimit", "mjc:solimplimit"), STOP, strict=True):
            attribute(spec, attribute_name, "double[]", Vt.DoubleArray(values), uniform=True)
