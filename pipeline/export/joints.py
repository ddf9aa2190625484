"""Joints of a stage: what they join, about which axis, how far, against which resistance."""

import math
from collections.abc import Mapping

import numpy as np
from pxr import Sdf, Usd, UsdGeom, UsdPhysics
from scipy.spatial.transform import Rotation

from pipeline.errors import ContentError
from pipeline.export.model import Floats, Joint, inverse
from pipeline.export.pieces import world

DEGREE = math.degrees(1.0)


def read_joints(root: Usd.Prim, index: Mapping[Sdf.Path, int], cache: UsdGeom.XformCache) -> tuple[list[Joint], set[int]]:
    """Return the joints under `root` between bodies of `index`, and the bodies that a fixed joint holds to the ground."""
    joints, grounded = [], set()
    for prim in Usd.PrimRange(root, Usd.TraverseInstanceProxies()):
        if not prim.IsA(UsdPhysics.Joint) or not UsdPhysics.Joint(prim).GetJointEnabledAttr().Get():
            continue
        joint = UsdPhysics.Joint(prim)
        parent, T_parent = _end(joint.GetBody0Rel(), joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr(), index, root, cache)
        child, T_child = _end(joint.GetBody1Rel(), joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr(), index, root, cache)
        if prim.IsA(UsdPhysics.FixedJoint) and min(parent, child) < 0:
            grounded.add(max(parent, child))
            continue
        if child < 0:
            raise ContentError(f"{prim.GetPath()} carries nothing", "its body1 must be a rigid body")
        joints.append(_joint(prim, parent, child, T_parent, T_child))
    return joints, grounded


def _end(
    body: Usd.Relationship,
    position: Usd.Attribute,
    rotation: Usd.Attribute,
    index: Mapping[Sdf.Path, int],
    root: Usd.Prim,
    cache: UsdGeom.XformCache,
) -> tuple[int, Floats]:
    """Return the body at one end of a joint, -1 for the ground, and the joint's frame in it (in the model, for the ground)."""
    local, turned = np.eye(4), rotation.Get()
    local[:3, :3] = Rotation.from_quat([turned.GetReal(), *turned.GetImaginary()], scalar_first=True).as_matrix()
    local[:3, 3] = position.Get()
    targets = body.GetTargets()
    if targets and targets[0] in index:
        return index[targets[0]], local
    holder = root.GetStage().GetPrimAtPath(targets[0]) if targets else None
    T_world_joint = world(cache, holder) @ local if holder else local
    return -1, inverse(world(cache, root)) @ T_world_joint


def _joint(prim: Usd.Prim, parent: int, child: int, T_parent: Floats, T_child: Floats) -> Joint:
    if prim.IsA(UsdPhysics.RevoluteJoint):
        kind, typed, drive, unit = "hinge", UsdPhysics.RevoluteJoint(prim), "angular", DEGREE
    elif prim.IsA(UsdPhysics.PrismaticJoint):
        kind, typed, drive, unit = "slide", UsdPhysics.PrismaticJoint(prim), "linear", 1.0
    elif prim.IsA(UsdPhysics.FixedJoint):
        return Joint(prim.GetName(), "fixed", parent, child, T_parent, T_child, np.zeros(3), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, (), ())
    else:
        raise ContentError(f"{prim.GetPath()} is a {prim.GetTypeName()}", "only hinges, slides and welds can be exported")
    driven = UsdPhysics.DriveAPI.Get(prim, drive)
    attributes = (driven.GetDampingAttr(), driven.GetStiffnessAttr(), driven.GetTargetPositionAttr()) if driven else ()
    damping, stiffness, rest = [attribute.Get() for attribute in attributes] or (0.0, 0.0, 0.0)
    stops = [prim.GetAttribute(f"mjc:{name}").Get() for name in ("solreflimit", "solimplimit")]
    after = prim.GetRelationship("sfgen:after")
    return Joint(
        prim.GetName(),
        kind,
        parent,
        child,
        T_parent,
        T_child,
        np.eye(3)["XYZ".index(typed.GetAxisAttr().Get())],
        typed.GetLowerLimitAttr().Get() / unit,
        typed.GetUpperLimitAttr().Get() / unit,
        damping * unit,
        _number(prim, "newton:friction"),
        _number(prim, "newton:armature"),
        stiffness * unit,
        rest / unit,
        tuple(tuple(map(float, values)) for values in stops) if all(stops) else (),
        tuple(path.name for path in after.GetTargets()) if after else (),
    )


def _number(prim: Usd.Prim, name: str) -> float:
    return float(prim.GetAttribute(name).Get() or 0.0) if prim.HasAttribute(name) else 0.0
