"""Reads stages and assets through USD's schemas: whatever wrote them, what a simulator would see is what is exported.

The overlays for MuJoCo are read where there are any: only they tell how hard the stops are.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import numpy as np
from pxr import Pcp, Sdf, Usd, UsdGeom, UsdPhysics
from scipy.spatial.transform import Rotation

from pipeline.arrays import Floats
from pipeline.errors import ContentError
from pipeline.export.model import Body, Inertia, Joint, Model, Placed, Scene, inverse
from pipeline.export.pieces import read_pieces, world

VARIANT = "MuJoCo"
DEGREE = math.degrees(1.0)
GROUPS = {"Rooms": "room", "Walls": "wall", "Windows": "window", "Doors": "door", "Objects": "object"}
REMEDY = "run `sfgen verify` on the dataset; if it is whole, please report it"


def read_home(path: Path, scene_id: str, asset: Callable[[Path], Model]) -> Scene:
    """Read a home; `asset` reads (or remembers) the model in an asset's interface file."""
    overlay = path.with_name(f"{path.stem}.mujoco.usda")
    stage = Usd.Stage.Open(str(overlay if overlay.is_file() else path))
    cache = UsdGeom.XformCache()
    models: dict[str, Model] = {}
    placed = []
    for prim, kind in _things(stage.GetDefaultPrim()):
        source = _reference(prim)
        name = f"{kind}_{prim.GetName()}" if kind in {"room", "wall"} else prim.GetName()
        model = asset(source) if source else read_model(prim, name, shared=False)
        models[model.name] = model
        rigid, scale = _split(world(cache, prim), prim)
        if not model.still and np.abs(scale - 1).max() > 1e-6:
            raise ContentError(f"{path}: {prim.GetPath()} moves and is scaled", REMEDY)
        support = prim.GetRelationship("sfgen:support")
        on = support.GetTargets()[0].name if support and support.GetTargets() else ""
        placed.append(Placed(prim.GetName() if source else model.name, kind, model.name, rigid, scale, on, _switched_off(prim)))
    asleep = stage.GetAttributeAtPath("/PhysicsScene.mjc:option:sleep_tolerance")
    return Scene(scene_id, models, tuple(placed), float(asleep.Get()) if asleep else 0.0)


def read_asset(path: Path) -> Model:
    """Read the model that an asset's interface file describes."""
    stage = Usd.Stage.Open(str(path))
    root = stage.GetDefaultPrim()
    if root.GetVariantSets().HasVariantSet(VARIANT):
        stage.SetEditTarget(stage.GetSessionLayer())
        root.GetVariantSet(VARIANT).SetVariantSelection("Enabled")
    return read_model(root, root.GetName(), shared=True)


def read_model(root: Usd.Prim, name: str, *, shared: bool) -> Model:
    """Read all bodies and joints under `root`; what belongs to no rigid body is one body "base" that stands still."""
    cache = UsdGeom.XformCache()
    prims = [p for p in Usd.PrimRange(root, Usd.TraverseInstanceProxies()) if p.HasAPI(UsdPhysics.RigidBodyAPI)]
    paths = {p.GetPath() for p in prims}
    bodies = [_body(p, root, cache, paths) for p in prims]
    if root not in prims:
        ground = _body(root, root, cache, paths)
        bodies += [ground] if not bodies or ground.surfaces or ground.boxes or ground.hulls else []
    index = {p.GetPath(): i for i, p in enumerate(prims)}
    joints, grounded = _joints(root, index, cache)
    grounded |= {i for i, body in enumerate(bodies) if body.inertia is None}
    _require_tree(len(bodies), [(j.parent, j.child) for j in joints], root)
    filtered = [(p, UsdPhysics.FilteredPairsAPI(p).GetFilteredPairsRel()) for p in prims if p.HasAPI(UsdPhysics.FilteredPairsAPI)]
    pairs = {tuple(sorted((index[p.GetPath()], index[t]))) for p, others in filtered for t in others.GetTargets() if t in index}
    return Model(name, shared, tuple(bodies), tuple(joints), frozenset(grounded), tuple(sorted(pairs)))  # type: ignore[arg-type]


def _things(root: Usd.Prim) -> Iterator[tuple[Usd.Prim, str]]:
    """Yield what a home is made of and its kind; lights and materials are none of it."""
    for group, kind in GROUPS.items():
        scope = root.GetChild(group)
        if scope:
            yield from ((prim, kind) for prim in scope.GetFilteredChildren(Usd.PrimIsActive & Usd.PrimIsDefined))


def _reference(prim: Usd.Prim) -> Path | None:
    """Return the asset file that a prim refers to, None where it is described in the home itself."""
    for arc in Usd.PrimCompositionQuery.GetDirectReferences(prim).GetCompositionArcs():
        layer = arc.GetTargetLayer()
        if arc.GetArcType() == Pcp.ArcTypeReference and layer != prim.GetStage().GetRootLayer() and layer.defaultPrim:
            return Path(layer.realPath)
    return None


def _switched_off(root: Usd.Prim) -> frozenset[str]:
    """Return the paths below `root` of what the stage has made inactive."""
    below = Usd.PrimRange(root, Usd.PrimAllPrimsPredicate)
    return frozenset(str(p.GetPath().MakeRelativePath(root.GetPath())) for p in below if not p.IsActive())


def _body(prim: Usd.Prim, root: Usd.Prim, cache: UsdGeom.XformCache, others: set[Sdf.Path]) -> Body:
    T_world_body = world(cache, prim)
    T_model_body = inverse(world(cache, root)) @ T_world_body
    if np.abs(T_model_body[:3, :3] @ T_model_body[:3, :3].T - np.eye(3)).max() > 1e-5:
        raise ContentError(f"{prim.GetPath()} is a scaled body", REMEDY)
    surfaces, boxes, hulls, handle = read_pieces(prim, root, T_world_body, cache, others - {prim.GetPath()})
    name = prim.GetName() if prim != root else "base"
    return Body(name, T_model_body, _inertia(prim), surfaces, boxes, hulls, handle)


def _inertia(prim: Usd.Prim) -> Inertia | None:
    if not prim.HasAPI(UsdPhysics.RigidBodyAPI):
        return None
    api = UsdPhysics.MassAPI(prim)
    mass, moments, axes = api.GetMassAttr().Get(), api.GetDiagonalInertiaAttr().Get(), api.GetPrincipalAxesAttr().Get()
    if not mass or not moments or min(moments) <= 0:
        raise ContentError(f"{prim.GetPath()} has no mass or no inertia", REMEDY)
    quaternion = np.array([axes.GetReal(), *axes.GetImaginary()], np.float64)
    length = np.linalg.norm(quaternion)  # the schema's own value, "compute them", is 0
    quaternion = quaternion / length if length > 0 else np.array([1.0, 0, 0, 0])
    return Inertia(float(mass), np.array(api.GetCenterOfMassAttr().Get(), np.float64), np.array(moments, np.float64), quaternion)


def _require_tree(count: int, edges: list[tuple[int, int]], root: Usd.Prim) -> None:
    parents = {child: parent for parent, child in edges}
    if len(parents) != len(edges):
        raise ContentError(f"{root.GetPath()} has a body that two joints carry", REMEDY)
    for body in range(count):
        at, steps = body, 0
        while (at := parents.get(at, -1)) >= 0:
            steps += 1
            if steps > count:
                raise ContentError(f"{root.GetPath()} has joints in a ring", REMEDY)


def _split(matrix: Floats, prim: Usd.Prim) -> tuple[Floats, Floats]:
    """Split T_world_prim into a rigid transform and a scale (3,) along the prim's axes."""
    scale = np.linalg.norm(matrix[:3, :3], axis=0)
    rigid = matrix.copy()
    rigid[:3, :3] /= scale
    if np.abs(rigid[:3, :3] @ rigid[:3, :3].T - np.eye(3)).max() > 1e-5 or np.linalg.det(rigid[:3, :3]) < 0:
        raise ContentError(f"{prim.GetPath()} is sheared or mirrored", REMEDY)
    return rigid, np.where(np.abs(scale - 1) < 1e-9, 1.0, scale)


def _joints(root: Usd.Prim, index: Mapping[Sdf.Path, int], cache: UsdGeom.XformCache) -> tuple[list[Joint], set[int]]:
    """Return the joints under `root` between bodies of `index`: what they join, about which axis, how far; and the bodies that one holds to the ground."""
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
