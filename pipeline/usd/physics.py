"""Bodies, masses, colliders: UsdPhysics, and what an engine has to be told in its own words."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf

from pipeline.entities.asset import Asset, Link, Mesh
from pipeline.geometry.kinematics import moved_links
from pipeline.usd.layer import apply, attribute, prim, relationship

GRAVITY = 9.81  # [m/s2]
LEAST_INERTIA = 1e-7  # engines divide by it [kg m2]
# Iterations of PhysX's solver over positions and velocities: for chains of two joints and stacks of a few things, a quarter of the 32 that
# Omniverse takes for articulations is enough (16 for bodies). With 4 and 1, things in drawers that are pulled out slid 2 cm.
ITERATIONS = (8, 1)


def convert_scene(layer: Sdf.Layer, name: str = "PhysicsScene") -> Sdf.PrimSpec:
    """Write the scene beside the default prim, so that a reference to the home brings no second one.

    Several contacts for a pair of meshes, as PhysX and MuJoCo have them anyway: on one point, Newton's default, no cup stands still.
    """
    spec = prim(layer, name, "PhysicsScene", ["MjcSceneAPI"])
    attribute(spec, "mjc:flag:multiccd", "bool", True, uniform=True)
    attribute(spec, "physics:gravityDirection", "vector3f", Gf.Vec3f(0, 0, -1))
    attribute(spec, "physics:gravityMagnitude", "float", GRAVITY)
    return spec


def convert_body(spec: Sdf.PrimSpec, link: Link) -> None:
    """Make the prim of a link a rigid body with its mass, centre of mass and principal inertia."""
    apply(spec, ["PhysicsRigidBodyAPI", "PhysicsMassAPI"])
    moments, rotation = principal(link.inertia)
    attribute(spec, "physics:mass", "float", float(link.mass))
    attribute(spec, "physics:centerOfMass", "point3f", Gf.Vec3f(*map(float, link.com)))
    attribute(spec, "physics:diagonalInertia", "float3", Gf.Vec3f(*map(float, moments)))
    attribute(spec, "physics:principalAxes", "quatf", quaternion(rotation))


def convert_iterations(spec: Sdf.PrimSpec, schema: str) -> None:
    """Say how long PhysX works on an "Articulation", at its root, or on a "RigidBody"."""
    apply(spec, [f"Physx{schema}API"])
    for kind, count in zip(("Position", "Velocity"), ITERATIONS, strict=True):
        attribute(spec, f"physx{schema}:solver{kind}IterationCount", "int", count)


def convert_collider(spec: Sdf.PrimSpec, mass: float | None = None) -> None:
    """Make a mesh a convex collider, or a box one; `mass` [kg] is its share of the body, for engines that weigh colliders."""
    mesh = spec.typeName == "Mesh"
    apply(spec, ["PhysicsCollisionAPI", *(["PhysicsMeshCollisionAPI"] if mesh else []), *(["PhysicsMassAPI"] if mass is not None else [])])
    if mesh:
        attribute(spec, "physics:approximation", "token", "convexHull", uniform=True)
    if mass is not None:
        attribute(spec, "physics:mass", "float", float(mass))


def hide(spec: Sdf.PrimSpec) -> None:
    """Mark a mesh that is there for physics only."""
    attribute(spec, "purpose", "token", "guide", uniform=True)
    attribute(spec, "visibility", "token", "invisible")


def convert_filter(spec: Sdf.PrimSpec, others: Iterable[Sdf.Path]) -> None:
    """Let a body pass through others; jointed and adjoining parts overlap by construction."""
    targets = list(others)
    if targets:
        apply(spec, ["PhysicsFilteredPairsAPI"])
        relationship(spec, "physics:filteredPairs", targets)


def gravity_load(asset: Asset, joint_index: int) -> float:
    """Return what gravity does to a joint at rest [N m or N]: positive where it pulls open, negative where it keeps shut."""
    joint = asset.joints[joint_index]
    load = 0.0
    for i in moved_links(asset, joint_index):
        link = asset.links[i]
        weight = np.array([0.0, 0.0, -GRAVITY * link.mass])
        load += float((weight if joint.type == "prismatic" else np.cross(link.com - joint.origin, weight)) @ joint.axis)
    return load


def principal(inertia: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return principal moments (3,) [kg m2] and axes (3, 3), columns of a rotation; axis-parallel bodies keep their axes."""
    diagonal = np.diag(inertia)
    if np.abs(inertia - np.diag(diagonal)).max() < 1e-6 * max(diagonal.max(), LEAST_INERTIA):
        return np.maximum(diagonal, LEAST_INERTIA), np.eye(3)
    moments, axes = np.linalg.eigh((inertia + inertia.T) / 2)
    if np.linalg.det(axes) < 0:
        axes = axes * np.array([1.0, 1.0, -1.0])
    return np.maximum(moments, LEAST_INERTIA), axes


def quaternion(R: NDArray[np.float64]) -> Gf.Quatf:
    """Convert a rotation matrix (columns are the rotated axes) to a quaternion with w >= 0."""
    gf_quat = Gf.Matrix3d(*map(float, R.T.ravel())).ExtractRotation().GetQuat()
    q = np.array([gf_quat.GetReal(), *gf_quat.GetImaginary()])
    q = q / np.linalg.norm(q) * (-1.0 if q[0] < 0 else 1.0)
    return Gf.Quatf(*map(float, q))


def volume(mesh: Mesh) -> float:
    """Return a convex piece's volume [m3]: signed tetrahedra, or a tenth of its box where the mesh is degenerate."""
    v = mesh.vertices.astype(np.float64)
    v = v - v.mean(axis=0)
    corners = v[mesh.faces]
    signed = abs(float(np.linalg.det(corners).sum())) / 6
    extent = np.maximum(v.max(axis=0) - v.min(axis=0), 1e-4)
    return max(signed, 0.1 * float(extent.prod()))
