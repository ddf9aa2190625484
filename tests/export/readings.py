"""Stages and what was exported from them, read again by code that shares nothing with the exporter, and compared.

USD is read through pxr, MJCF with MuJoCo, URDF and GLB by their specifications. Compared are, in the world frame: joint origins, axes,
limits, and of every body its mass, its centre and its inertia tensor; and how many colliders a link has, of which GLB knows nothing.
"""

import json
import math
import struct
import time
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from defusedxml.ElementTree import parse
from numpy.typing import NDArray
from pxr import Gf, Usd, UsdGeom, UsdPhysics
from scipy.spatial.transform import Rotation

Floats = NDArray[np.float64]


class Joint(NamedTuple):
    """Origin (3,) and axis (3,) in the world, lower and upper limit [rad or m]."""

    origin: Floats
    axis: Floats
    lower: float
    upper: float


class Body(NamedTuple):
    """Mass [kg], its centre (3,) and the inertia tensor about it (3, 3) along the world's axes."""

    mass: float
    center: Floats
    inertia: Floats


class Reading(NamedTuple):
    """What a file says: joints by (object, joint), bodies by (object, link); how many colliders each link has that has any."""

    joints: dict[tuple[str, str], Joint]
    bodies: dict[tuple[str, str], Body]
    colliders: Counter[tuple[str, str]] | None = None


def _rotation_matrix(rotation: Any) -> Gf.Matrix3d:
    """Convert a quatf, whose length is 1 but for rounding; not by way of an angle, which loses half the digits."""
    return Gf.Matrix3d(Gf.Quatd(rotation).GetNormalized())


def from_usd(path: Path) -> Reading:
    """Read a home's stage."""
    stage = Usd.Stage.Open(str(path))
    joints, bodies, colliders = {}, {}, Counter()
    for prim in stage.Traverse():
        name = tuple(str(prim.GetPath()).split("/")[3:])
        matrix: Any = UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(0) if prim.IsA(UsdGeom.Xformable) else None
        if prim.HasAPI(UsdPhysics.RigidBodyAPI):
            api = UsdPhysics.MassAPI(prim)
            R = np.array((_rotation_matrix(api.GetPrincipalAxesAttr().Get()) * matrix.ExtractRotationMatrix()).GetTranspose())
            center = np.array(matrix.Transform(Gf.Vec3d(api.GetCenterOfMassAttr().Get())))
            bodies[name[0], name[-1]] = Body(api.GetMassAttr().Get(), center, R @ np.diag(api.GetDiagonalInertiaAttr().Get()) @ R.T)
        if prim.HasAPI(UsdPhysics.CollisionAPI):
            above = (p.name for p in prim.GetPath().GetPrefixes() if stage.GetPrimAtPath(p).HasAPI(UsdPhysics.RigidBodyAPI))
            thing = f"wall_{name[0]}" if "/Walls/" in str(prim.GetPath()) else name[0]
            colliders[thing, next(above, "base")] += 1
        if prim.IsA(UsdPhysics.RevoluteJoint) or prim.IsA(UsdPhysics.PrismaticJoint):
            get = {a.GetBaseName(): a.Get() for a in prim.GetAttributes()}
            child = UsdGeom.Xformable(
                stage.GetPrimAtPath(UsdPhysics.Joint(prim).GetBody1Rel().GetTargets()[0])
            ).ComputeLocalToWorldTransform(0)
            local = Gf.Vec3d(*(float(a == get["axis"]) for a in "XYZ"))
            axis = child.TransformDir(local * _rotation_matrix(get["localRot1"]))
            limits = [math.radians(v) if prim.IsA(UsdPhysics.RevoluteJoint) else v for v in (get["lowerLimit"], get["upperLimit"])]
            joints[name[0], name[-1]] = Joint(np.array(child.Transform(Gf.Vec3d(get["localPos1"]))), np.array(axis), *limits)
    return Reading(joints, bodies, colliders)


def from_mjcf(path: Path) -> Reading:
    """Read a home as MuJoCo compiles it."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    joints, bodies = {}, {}
    for i in range(model.njnt):
        if model.jnt_type[i] != mujoco.mjtJoint.mjJNT_FREE:
            lower, upper = model.jnt_range[i] if model.jnt_limited[i] else (-math.inf, math.inf)
            joints[_split(model.joint(i).name)] = Joint(data.xanchor[i].copy(), data.xaxis[i].copy(), lower, upper)
    for i in range(1, model.nbody):
        if model.body_mass[i] > 0:
            R = data.ximat[i].reshape(3, 3)
            tensor = R @ np.diag(model.body_inertia[i]) @ R.T
            bodies[_split(model.body(i).name)] = Body(float(model.body_mass[i]), data.xipos[i].copy(), tensor)
    collide = np.flatnonzero(model.geom_contype)
    return Reading(joints, bodies, Counter(_split(model.body(model.geom_bodyid[k]).name) for k in collide))


def from_urdf(path: Path) -> Reading:
    """Read home.json and the files that it names."""
    joints, bodies, colliders = {}, {}, Counter()
    for link in parse(path.parent / json.loads(path.read_text(encoding="utf-8"))["building"]).getroot().iter("link"):
        colliders[link.get("name"), "base"] += len(link.findall("collision"))
    for placed in json.loads(path.read_text(encoding="utf-8"))["placed"]:
        robot = parse(path.parent / placed["urdf"]).getroot()
        carried = {j.find("child").get("link"): j for j in robot.iter("joint")}
        T_world_robot = np.eye(4)
        T_world_robot[:3, :3] = Rotation.from_quat(placed["orientation"], scalar_first=True).as_matrix()
        T_world_robot[:3, 3] = placed["position"]

        def at(link: str, carried: dict[str, Any] = carried, T_world_robot: Floats = T_world_robot) -> Floats:
            if link not in carried:
                return T_world_robot
            return at(carried[link].find("parent").get("link"), carried, T_world_robot) @ _origin(carried[link])

        for joint in carried.values():
            if joint.get("type") != "fixed":
                T, limit = at(joint.find("child").get("link")), joint.find("limit")
                bounds = (float(limit.get(k, s)) for k, s in (("lower", "-inf"), ("upper", "inf")))
                joints[placed["name"], joint.get("name")] = Joint(T[:3, 3], T[:3, :3] @ _floats(joint.find("axis").get("xyz")), *bounds)
        for link in robot.iter("link"):
            colliders[placed["name"], link.get("name")] += len(link.findall("collision"))
            if (inertial := link.find("inertial")) is not None:
                T, i = at(link.get("name")) @ _origin(inertial), {k: float(v) for k, v in inertial.find("inertia").items()}
                tensor = np.array([[i["ixx"], i["ixy"], i["ixz"]], [i["ixy"], i["iyy"], i["iyz"]], [i["ixz"], i["iyz"], i["izz"]]])
                mass = float(inertial.find("mass").get("value"))
                bodies[placed["name"], link.get("name")] = Body(mass, T[:3, 3], T[:3, :3] @ tensor @ T[:3, :3].T)
    return Reading(joints, bodies, +colliders)


def from_glb(path: Path) -> Reading:
    """Read the nodes of a GLB; its Y up becomes Z up again."""
    data = path.read_bytes()
    document = json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])
    joints, bodies = {}, {}
    up = np.eye(4)
    up[:3, :3] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]

    def walk(index: int, T: Floats, thing: str) -> None:
        node = document["nodes"][index]
        local = np.eye(4)
        local[:3, :3] = Rotation.from_quat(node.get("rotation", [0, 0, 0, 1])).as_matrix() * node.get("scale", [1, 1, 1])
        local[:3, 3] = node.get("translation", [0, 0, 0])
        T, extras = T @ local, node.get("extras", {})
        thing = node["name"] if "kind" in extras else thing
        if extras.get("joint", "fixed") != "fixed":
            bounds = extras.get("lower", -math.inf), extras.get("upper", math.inf)
            joints[thing, node["name"]] = Joint(T[:3, 3], T[:3, :3] @ extras["axis"], *bounds)
        if "mass" in extras:
            R = T[:3, :3] @ Rotation.from_quat(extras["principal_axes_wxyz"], scalar_first=True).as_matrix()
            center = (T @ [*extras["center_of_mass"], 1])[:3]
            bodies[thing, node["name"]] = Body(extras["mass"], center, R @ np.diag(extras["diagonal_inertia"]) @ R.T)
        for child in node.get("children", []):
            walk(child, T, thing)

    for top in document["scenes"][document["scene"]]["nodes"]:
        walk(top, up, "")
    return Reading(joints, bodies)


READERS = {"mjcf": from_mjcf, "urdf": from_urdf, "glb": from_glb}


def deviations(one: Reading, other: Reading) -> dict[str, float]:
    """Return the largest difference of each kind; masses and inertias relative to the body's own. Raises ValueError where things are missing."""
    if one.joints.keys() != other.joints.keys() or one.bodies.keys() != other.bodies.keys():
        raise ValueError(
            f"not the same: {sorted((one.joints.keys() ^ other.joints.keys()) | (one.bodies.keys() ^ other.bodies.keys()))[:5]}"
        )
    largest: dict[str, float] = defaultdict(float)

    def note(key: str, difference: Any) -> None:
        largest[key] = max(largest[key], float(np.abs(difference).max()))

    for name, a in one.joints.items():
        b = other.joints[name]
        note("origins [m]", a.origin - b.origin)
        note("axes", a.axis - b.axis)
        for mine, theirs in ((a.lower, b.lower), (a.upper, b.upper)):
            note("limits [rad, m]", 0.0 if mine == theirs else mine - theirs)
    for name, c in one.bodies.items():
        d = other.bodies[name]
        note("masses", (c.mass - d.mass) / c.mass)
        note("centres of mass [m]", c.center - d.center)
        note("inertias", (c.inertia - d.inertia) / np.abs(c.inertia).max())
    if one.colliders is not None and other.colliders is not None:
        note("colliders", max((abs(one.colliders[link] - other.colliders[link]) for link in {*one.colliders, *other.colliders}), default=0))
    return dict(largest)


def _split(name: str) -> tuple[str, str]:
    thing, _, part = name.partition("/")
    return thing, part


def _floats(text: str) -> Floats:
    return np.array(text.split(), np.float64)


def _origin(element: Any) -> Floats:
    T, origin = np.eye(4), element.find("origin")
    T[:3, :3] = Rotation.from_euler("xyz", _floats(origin.get("rpy"))).as_matrix()
    T[:3, 3] = _floats(origin.get("xyz"))
    return T


def steps(path: Path, seconds: float) -> tuple[float, float, float]:
    """Step a home in MuJoCo: CPU milliseconds a step, the largest shift of a joint from rest [rad, m], of a free body [m]."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    start, joints = data.xpos.copy(), [j for j in range(model.njnt) if model.jnt_type[j] != mujoco.mjtJoint.mjJNT_FREE]
    count, before = int(seconds / model.opt.timestep), time.process_time()
    for _ in range(count):
        mujoco.mj_step(model, data)
    spent = time.process_time() - before
    assert not any(data.warning.number), f"{path}: MuJoCo warns"
    turned = np.abs(data.qpos[model.jnt_qposadr[joints]]).max() if joints else 0.0
    return 1e3 * spent / count, float(turned), float(np.linalg.norm(data.xpos - start, axis=1).max())
