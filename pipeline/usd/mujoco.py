"""What MuJoCo needs otherwise: the articulation root on the base link, which hangs on the world (simulators of 2026).

MuJoCo's decoder takes any prim with an articulation root for a body and drops joints to non-bodies, so a base that is
fixed to its own Xform would float there. The overlays say the same thing in its words; other engines never see them.
"""

from pathlib import Path

from pxr import Sdf, Vt

from pipeline.entities.asset import Asset
from pipeline.usd.layer import apply, attribute, new_layer, over, relationship, save

SCENE = Sdf.Path("/PhysicsScene")
ROOT_API = "PhysicsArticulationRootAPI"
# [m/s] below which a thing sleeps until something touches it: a thing that creeps 5 mm in 5 s is ten times as fast, and stays awake.
ASLEEP = 1e-4
STOP = ((0.008, 1.0), (0.99, 0.999, 1e-4, 0.5, 2.0))  # solref and solimp of the limits: hard stops even for light knobs and buttons


def asset_overlay(asset: Asset, payload: Sdf.Layer) -> Sdf.Layer:
    """Return the layer behind an articulated asset's variant MuJoCo=Enabled; `payload` is what the other engines read."""
    layer = new_layer(asset.asset_id, ".usda")
    _convert(over(layer, asset.asset_id), payload.GetPrimAtPath(f"/{asset.asset_id}"))
    return layer


def write_mujoco_overlay(scene: Path) -> Path:
    """Write `<scene>.mujoco.usda` beside a home's stage: the same home for MuJoCo. Returns its path."""
    layer = home_overlay(Sdf.Layer.OpenAsAnonymous(str(scene)), scene.name)
    return save(layer, scene.with_name(f"{scene.stem}.mujoco.usda"))


def home_overlay(source: Sdf.Layer, name: str) -> Sdf.Layer:
    """Return the overlay of a home's stage `source`, which lies beside it in the file `name`."""
    world = source.GetPrimAtPath(f"/{source.defaultPrim}")
    layer = new_layer(source.defaultPrim, ".usda")
    layer.subLayerPaths.append(f"./{name}")
    root = over(layer, source.defaultPrim)
    if source.GetPrimAtPath(SCENE):
        scene = over(layer, SCENE.name)  # what lies still sleeps, which of a home is nearly all
        attribute(scene, "mjc:flag:sleep", "bool", True, uniform=True)
        attribute(scene, "mjc:option:sleep_tolerance", "double", ASLEEP, uniform=True)
    for kind in ("Objects", "Doors"):
        group = world.nameChildren.get(kind)
        if group is None:
            continue
        scope = over(root, kind)
        for spec in group.nameChildren:
            if kind == "Doors":
                _convert(over(scope, spec.name), spec)
            elif spec.customData.get("articulated", False):
                over(scope, spec.name).variantSelections["MuJoCo"] = "Enabled"
    return layer


def _convert(root: Sdf.PrimSpec, source: Sdf.PrimSpec) -> None:
    """Move the articulation root to the base, hang the base on the world where it is fixed, say in joints what drives say elsewhere."""
    removal = Sdf.TokenListOp()
    removal.deletedItems = [ROOT_API]
    root.SetInfo("apiSchemas", removal)
    joints = source.nameChildren["joints"].nameChildren
    fixed = "world_fixed" in joints
    base = joints["world_fixed"].relationships["physics:body1"] if fixed else joints[0].relationships["physics:body0"]
    apply(over(root, base.targetPathList.explicitItems[0].name), [ROOT_API])
    scope = over(root, "joints")
    for joint in joints:
        spec = over(scope, joint.name)
        if joint.name == "world_fixed":
            relationship(spec, "physics:body0", [])
        else:
            _convert_joint(spec, joint)


def _convert_joint(spec: Sdf.PrimSpec, source: Sdf.PrimSpec) -> None:
    """Write damping, spring and stops; MuJoCo reads no DriveAPI, but these."""
    drive = "angular" if source.typeName == "PhysicsRevoluteJoint" else "linear"
    said = f"drive:{drive}:physics:"
    apply(spec, ["NewtonJointAPI", "MjcJointAPI"])
    attribute(spec, "newton:damping", "float", source.attributes[f"{said}damping"].default)
    if stiffness := source.attributes[f"{said}stiffness"].default:
        attribute(spec, "mjc:stiffness", "double", stiffness, uniform=True)
    for attribute_name, values in zip(("mjc:solreflimit", "mjc:solimplimit"), STOP, strict=True):
        attribute(spec, attribute_name, "double[]", Vt.DoubleArray(values), uniform=True)
