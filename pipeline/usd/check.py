"""What every stage of ours must satisfy, checked on the composed stage."""

from collections.abc import Iterator
from pathlib import Path

from pxr import Ar, Gf, Tf, Usd, UsdGeom, UsdPhysics, UsdUtils

from pipeline.errors import ContentError

TOLERANCE = 1e-4  # joint frames of both bodies must agree this closely at rest [m, and as a quaternion's distance]


def check_stage(path: Path) -> Usd.Stage:
    """Open and examine a stage; returns it, or raises ContentError with everything that is wrong with it."""
    if not path.is_file():
        raise ContentError(f"{path} is missing", "write the home again")
    collector = UsdUtils.CoalescingDiagnosticDelegate()
    try:
        stage = Usd.Stage.Open(str(path))
    except Tf.ErrorException as error:
        raise ContentError(f"{path} is no USD stage ({str(error).splitlines()[0]})", "write the home again") from error
    faults = [f"usd says: {message}" for message in (d.commentary for d in collector.TakeUncoalescedDiagnostics())]
    del collector
    faults += [*_dependency_faults(stage), *_stage_faults(stage)]
    if faults:
        shown = "; ".join(faults[:8]) + (f"; and {len(faults) - 8} more" if len(faults) > 8 else "")
        raise ContentError(f"{path}: {shown}", "this stage would misbehave in a simulator; write the home again")
    return stage


def _dependency_faults(stage: Usd.Stage) -> Iterator[str]:
    """Yield what is unresolved or not relative."""
    root = stage.GetRootLayer()
    _layers, _assets, unresolved = UsdUtils.ComputeAllDependencies(root.realPath)
    for name in unresolved:
        yield f"unresolved path {name}"
    resolver = Ar.GetResolver()
    for layer in stage.GetUsedLayers():
        if layer.anonymous:
            continue
        for name in layer.GetCompositionAssetDependencies():
            if name.startswith("/") or "://" in name:
                yield f"absolute path {name}"
            elif not resolver.Resolve(layer.ComputeAbsolutePath(name)):
                yield f"unresolved path {name} in {Path(layer.realPath).name}"


def _stage_faults(stage: Usd.Stage) -> Iterator[str]:
    if not stage.HasDefaultPrim():
        yield "no default prim"
        return
    if UsdGeom.GetStageUpAxis(stage) != "Z" or UsdGeom.GetStageMetersPerUnit(stage) != 1 or UsdPhysics.GetStageKilogramsPerUnit(stage) != 1:
        yield "units are not Z up, metres, kilograms"
    cache = UsdGeom.XformCache()
    for prim in stage.Traverse():
        if prim.HasAPI(UsdPhysics.ArticulationRootAPI):
            yield from _articulation_faults(prim, cache)
        if prim.IsA(UsdPhysics.Joint):
            yield from _joint_faults(UsdPhysics.Joint(prim), cache)


def _articulation_faults(prim: Usd.Prim, cache: UsdGeom.XformCache) -> Iterator[str]:
    if prim.IsInstance() or prim.IsInstanceProxy():
        yield f"{prim.GetPath()} is an instanced articulation"
    matrix = cache.GetLocalToWorldTransform(prim)
    if any(abs(matrix.GetRow3(k).GetLength() - 1) > 1e-6 for k in range(3)):
        yield f"{prim.GetPath()} is a scaled articulation"


def _joint_faults(joint: UsdPhysics.Joint, cache: UsdGeom.XformCache) -> Iterator[str]:
    """Yield bodies that do not exist, and frames that would make a simulation jump when it starts."""
    path = joint.GetPath()
    frames = []
    for body, position, rotation in (
        (joint.GetBody0Rel(), joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr()),
        (joint.GetBody1Rel(), joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr()),
    ):
        targets = body.GetTargets()
        prim = joint.GetPrim().GetStage().GetPrimAtPath(targets[0]) if targets else None
        if targets and not prim:
            yield f"{path} joins {targets[0]}, which does not exist"
            return
        local = Gf.Matrix4d(Gf.Rotation(Gf.Quatd(rotation.Get())), Gf.Vec3d(position.Get()))
        frames.append(local * cache.GetLocalToWorldTransform(prim) if prim else None)
    if frames[0] is None or frames[1] is None:
        return
    difference = frames[0] * frames[1].GetInverse()
    if max(abs(difference[i][j] - (i == j)) for i in range(4) for j in range(4)) > TOLERANCE:
        yield f"{path} has disjointed frames"
