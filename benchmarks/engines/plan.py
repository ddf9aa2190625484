"""What is to be done to a stage: its joints with the push that each gets, which go together, and the bodies that lie about."""

import math
from pathlib import Path
from typing import Any

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdPhysics

from pipeline.arrays import Floats

GRAVITY = 9.81  # [m/s2]
HINGE, SLIDE = 1.2, 1.5  # pushes, in weights of what moves (a hinge's at the arm of its centre of mass)
LEAST = 1.0  # [N m] on a hinge of what is fixed: a hand's, on a cupboard door that weighs nothing about its own axis
PACE = 1.0  # [s] within which the push overcomes the damping over the whole range
ROUND = 2 * math.pi  # of a joint without limits
CLEAR = 0.03  # [m] between the sweeps of joints that are pushed at the same time
STEPS = 7  # positions of a joint at which its sweep is looked at


def read(stage_file: Path) -> dict[str, Any]:
    """Return joints, groups of joints that do not meet, loose bodies and counts of a stage."""
    stage = Usd.Stage.Open(str(stage_file))
    cache = UsdGeom.XformCache()
    prims = list(stage.Traverse())
    bodies = {str(p.GetPath()): p for p in prims if p.HasAPI(UsdPhysics.RigidBodyAPI)}
    roots = [str(p.GetPath()) for p in prims if p.HasAPI(UsdPhysics.ArticulationRootAPI)]
    joints = [p for p in prims if p.IsA(UsdPhysics.RevoluteJoint) or p.IsA(UsdPhysics.PrismaticJoint)]
    fixed = {str(t) for p in prims if p.IsA(UsdPhysics.FixedJoint) for t in UsdPhysics.Joint(p).GetBody1Rel().GetTargets()}
    children = {str(j.GetPath()): _end(j, 1) for j in joints}
    below: dict[str, list[str]] = {}
    for joint in joints:
        below.setdefault(_end(joint, 0), []).append(_end(joint, 1))
    loose = [path for path in bodies if path not in fixed and path not in children.values()]
    entries, sweeps = [], []
    for joint in joints:
        moved = _subtree(_end(joint, 1), below)
        root = next(r for r in roots if str(joint.GetPath()).startswith(f"{r}/"))
        entry, sweep = _joint(joint, [bodies[path] for path in moved], cache, root, light=_end(joint, 0) in loose)
        entries.append(entry)
        sweeps.append(sweep)
    index = {entry["path"]: k for k, entry in enumerate(entries)}
    before = [_before(k, entries, index) for k in range(len(entries))]
    return {
        "joints": entries,
        "groups": _groups(sweeps, before),
        "bodies": [{"path": path, "root": path.rsplit("/", 1)[0]} for path in loose],
        "colliders": sum(p.HasAPI(UsdPhysics.CollisionAPI) for p in prims),
        "collider_points": sum(
            len(UsdGeom.Mesh(p).GetPointsAttr().Get()) for p in prims if p.HasAPI(UsdPhysics.CollisionAPI) and p.IsA(UsdGeom.Mesh)
        ),
    }


def _end(joint: Usd.Prim, which: int) -> str:
    api = UsdPhysics.Joint(joint)
    targets = (api.GetBody1Rel() if which else api.GetBody0Rel()).GetTargets()
    return str(targets[0]) if targets else ""


def _subtree(link: str, below: dict[str, list[str]]) -> list[str]:
    return [link, *(deeper for child in below.get(link, ()) for deeper in _subtree(child, below))]


def _joint(prim: Usd.Prim, moved: list[Usd.Prim], cache: UsdGeom.XformCache, root: str, *, light: bool) -> tuple[dict[str, Any], Floats]:
    """Return a joint's entry and the box (2, 3) [m, world] of what it sweeps."""
    hinge = prim.IsA(UsdPhysics.RevoluteJoint)
    frame = cache.GetLocalToWorldTransform(prim.GetStage().GetPrimAtPath(_end(prim, 1)))
    api = UsdPhysics.Joint(prim)
    origin = np.array(frame.Transform(Gf.Vec3d(api.GetLocalPos1Attr().Get())))
    axis = Gf.Vec3d(*((1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0))["XYZ".index(prim.GetAttribute("physics:axis").Get())])
    axis = np.array(frame.TransformDir(Gf.Rotation(Gf.Quatd(api.GetLocalRot1Attr().Get())).TransformDir(axis)))
    upper = prim.GetAttribute("physics:upperLimit").Get()
    limited = upper is not None and math.isfinite(upper)
    range_ = (math.radians(upper) if hinge else float(upper)) if limited else ROUND
    masses = [UsdPhysics.MassAPI(body) for body in moved]
    mass = np.array([api.GetMassAttr().Get() for api in masses])
    at = np.array(
        [
            np.array(cache.GetLocalToWorldTransform(b).Transform(Gf.Vec3d(m.GetCenterOfMassAttr().Get())))
            for b, m in zip(moved, masses, strict=True)
        ]
    )
    weight = GRAVITY * float(mass.sum())
    drive = UsdPhysics.DriveAPI(prim, "angular" if hinge else "linear")
    unit = math.degrees(1.0) if hinge else 1.0
    damping, stiffness, target, most = (
        float(a.Get() or 0.0)
        for a in (drive.GetDampingAttr(), drive.GetStiffnessAttr(), drive.GetTargetPositionAttr(), drive.GetMaxForceAttr())
    )
    if hinge:
        away = (mass[:, None] * at).sum(axis=0) / max(mass.sum(), 1e-9) - origin
        push = max(0.0 if light else LEAST, HINGE * weight * float(np.linalg.norm(away - (away @ axis) * axis)))
    else:
        push = SLIDE * weight
    push += min(stiffness * (range_ * unit - target), most) + damping * unit * range_ / PACE
    friction = prim.GetAttribute("newton:friction")
    push += float(friction.Get() or 0.0) if friction else 0.0
    labels = prim.GetAttribute("semantics:labels:part").Get()
    entry = {
        "path": str(prim.GetPath()),
        "root": root,
        "part": labels[0] if labels else "",
        "hinge": hinge,
        "limited": limited,
        "upper": range_,
        "push": push,
        "mass": float(mass.sum()),
        "after": [str(t) for t in prim.GetRelationship("sfgen:after").GetTargets()] if prim.HasRelationship("sfgen:after") else [],
    }
    return entry, _sweep(_points(moved, cache), origin, axis, range_, hinge=hinge)


def _points(moved: list[Usd.Prim], cache: UsdGeom.XformCache) -> Floats:
    points = [np.zeros((0, 3))]
    for body in moved:
        for prim in Usd.PrimRange(body):
            if prim.HasAPI(UsdPhysics.CollisionAPI) and prim.IsA(UsdGeom.Boundable):
                low, high = (np.array(v) for v in UsdGeom.Boundable(prim).GetExtentAttr().Get())
                corners = np.array(
                    [[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
                )
                matrix = np.array(cache.GetLocalToWorldTransform(prim))
                points.append(corners @ matrix[:3, :3] + matrix[3, :3])
    return np.concatenate(points)


def _sweep(points: Floats, origin: Floats, axis: Floats, upper: float, *, hinge: bool) -> Floats:
    if not len(points):
        return np.array([origin, origin])
    moved = []
    for q in np.linspace(0, upper, STEPS):
        turn = Gf.Matrix4d().SetRotate(Gf.Rotation(Gf.Vec3d(*map(float, axis)), math.degrees(q)))
        moved.append((points - origin) @ np.array(turn)[:3, :3] + origin if hinge else points + axis * q)
    every = np.concatenate(moved)
    return np.array([every.min(axis=0), every.max(axis=0)])


def _before(k: int, joints: list[dict[str, Any]], index: dict[str, int]) -> list[int]:
    prerequisites: list[int] = []
    for path in joints[k]["after"]:
        prerequisites += [*_before(index[path], joints, index), index[path]]
    return prerequisites


def _groups(sweeps: list[Floats], before: list[list[int]]) -> list[dict[str, list[int]]]:
    """Deal joints to groups in which nobody's sweep meets another's: each is then alone, though many move at once."""
    groups: list[dict[str, Any]] = []
    for k, first in enumerate(before):
        boxes = [sweeps[i] for i in (k, *first)]
        for group in groups:
            if all((a[0] > b[1] + CLEAR).any() or (b[0] > a[1] + CLEAR).any() for a in boxes for b in group["boxes"]):
                break
        else:
            group = {"joints": [], "before": [], "boxes": []}
            groups.append(group)
        group["joints"].append(k)
        group["before"] += first
        group["boxes"] += boxes
    return [{"joints": g["joints"], "before": sorted(set(g["before"]))} for g in groups]
