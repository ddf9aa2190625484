"""Joints: fixed to the asset's own Xform, prismatic in metres, revolute in degrees; closed is 0."""

import math

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf

from pipeline.entities.asset import Joint
from pipeline.usd.layer import apply, attribute, label, prim, relationship
from pipeline.usd.physics import quaternion
from pipeline.usd.resistance import Resistance

# Newton's limits: its own are so soft that a push goes 18 % past them. Springs of 120 rad/s, damped so that nothing bounces back; Newton
# takes a twentieth of that (1 - dmax of MuJoCo's default impedance), hence the factor on the inertia. Hinges' are by the degree: by the
# radian they would be stiffer than a step allows, MuJoCo would stretch their time and keep their damping, and they creep beyond the stop.
STOP = (120.0**2 / 0.05, 2 * 120.0 / 0.05)  # stiffness and damping [1/s2, 1/s]
AXES = {"X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1)}


def convert_fixed(scope: Sdf.PrimSpec, root: Sdf.Path, base: Sdf.Path) -> Sdf.PrimSpec:
    """Fix the base link to the asset's own Xform, wherever that is placed."""
    spec = prim(scope, "world_fixed", "PhysicsFixedJoint")
    relationship(spec, "physics:body0", [root])
    relationship(spec, "physics:body1", [base])
    _frames(spec, np.zeros(3), Gf.Quatf(1.0))
    return spec


def convert_joint(
    scope: Sdf.PrimSpec, prim_name: str, joint: Joint, parent: Sdf.Path, child: Sdf.Path, resistance: Resistance
) -> Sdf.PrimSpec:
    """Write a joint between two links whose frames are the asset's frame; it stands at 0 when all is closed."""
    hinge = joint.type != "prismatic"
    spec = prim(scope, prim_name, "PhysicsRevoluteJoint" if hinge else "PhysicsPrismaticJoint", ["NewtonJointAPI"])
    relationship(spec, "physics:body0", [parent])
    relationship(spec, "physics:body1", [child])
    token, rotation = axis_frame(joint.axis)
    attribute(spec, "physics:axis", "token", token, uniform=True)
    _frames(spec, joint.origin, rotation)
    unit = math.degrees(1.0) if hinge else 1.0
    if math.isfinite(joint.lower) and math.isfinite(joint.upper):
        attribute(spec, "physics:lowerLimit", "float", joint.lower * unit)
        attribute(spec, "physics:upperLimit", "float", joint.upper * unit)
        for name, value in zip(("limitStiffness", "limitDamping"), STOP, strict=True):  # by Newton's names; PhysX does not know them
            attribute(spec, f"newton:{name}", "float", value * resistance.inertia / unit)
    attribute(spec, "newton:armature", "float", resistance.armature)  # this and friction: PhysX, Newton and MuJoCo
    attribute(spec, "newton:friction", "float", resistance.friction)
    drive = "angular" if hinge else "linear"
    apply(spec, [f"PhysicsDriveAPI:{drive}"])
    attribute(spec, f"drive:{drive}:physics:type", "token", "force", uniform=True)
    spring = {"stiffness": resistance.stiffness / unit, "damping": resistance.damping / unit, "targetPosition": 0.0, "targetVelocity": 0.0}
    for name, value in spring.items():
        attribute(spec, f"drive:{drive}:physics:{name}", "float", value)
    label(spec, "part", [joint.part_class])
    return spec


def axis_frame(axis: NDArray[np.float64]) -> tuple[str, Gf.Quatf]:
    """Return the axis token and the joint frame's rotation that lay the token's axis along `axis` (3,), a unit vector."""
    unit = np.asarray(axis, np.float64) / np.linalg.norm(axis)
    for token, direction in AXES.items():
        if unit @ np.array(direction) > 1 - 1e-9:
            return token, Gf.Quatf(1.0)
    token = "XYZ"[int(np.argmax(np.abs(unit)))]
    start = np.array(AXES[token], np.float64)
    other = np.array(AXES["X" if abs(unit[0]) < 0.5 else "Z"], np.float64)
    if unit @ start < -1 + 1e-9:  # half a turn about any axis square to it
        return token, Gf.Quatf(0.0, *map(float, other))
    v = np.cross(start, unit)
    K = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return token, quaternion(np.eye(3) + K + K @ K / (1 + start @ unit))


def _frames(spec: Sdf.PrimSpec, origin: NDArray[np.float64], rotation: Gf.Quatf) -> None:
    for body in "01":
        attribute(spec, f"physics:localPos{body}", "point3f", Gf.Vec3f(*map(float, origin)))
        attribute(spec, f"physics:localRot{body}", "quatf", rotation)
