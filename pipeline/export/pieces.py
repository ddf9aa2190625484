"""What one sees of a body and what collides, in the body's frame: meshes of one look merged, colliders as boxes and hulls."""

from collections import defaultdict
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom, UsdPhysics, UsdShade
from scipy.spatial import ConvexHull

from pipeline.arrays import Floats
from pipeline.errors import ContentError
from pipeline.export.model import Box, Hull, Material, Surface, inverse

GREY = Material("grey", (0.8, 0.8, 0.8), 0.5, 0.0, 1.0, None)
FRICTION = 1.0  # of what is bound to no physics material, as MuJoCo has it
SQUARE = 1e-6  # how far corners may stand off those of a box [m]


class Corners(NamedTuple):
    """The corners of a mesh's triangles, three by three: points, normals (3k, 3), texture coordinates (3k, 2) or None."""

    points: Floats
    normals: Floats
    uv: Floats | None


def world(cache: UsdGeom.XformCache, prim: Usd.Prim) -> Floats:
    """Return T_world_prim (4, 4), scale included."""
    return np.array(cache.GetLocalToWorldTransform(prim), np.float64).T


def read_pieces(
    body: Usd.Prim, root: Usd.Prim, T_world_body: Floats, cache: UsdGeom.XformCache, others: set[Sdf.Path]
) -> tuple[tuple[Surface, ...], tuple[Box, ...], tuple[Hull, ...], Floats | None]:
    """Return surfaces, boxes, hulls and the middle of the handles of a body below `root`, down to where `others` (other bodies) begin."""
    visuals: defaultdict[tuple[str, Material], list[Corners]] = defaultdict(list)
    boxes: list[Box] = []
    hulls: list[Hull] = []
    for prim in _gprims(body, others):
        T = inverse(T_world_body) @ world(cache, prim)
        points, counts, indices = _polygons(prim)
        points = points @ T[:3, :3].T + T[:3, 3]
        if prim.HasAPI(UsdPhysics.CollisionAPI) and UsdPhysics.CollisionAPI(prim).GetCollisionEnabledAttr().Get():
            collider = _collider(prim, points, f"{body.GetName()}_hull_{len(hulls)}", str(prim.GetPath().MakeRelativePath(root.GetPath())))
            if isinstance(collider, Box):
                boxes.append(collider)
            else:
                hulls.append(collider)
        image = UsdGeom.Imageable(prim)
        if image.ComputePurpose() != "guide" and image.ComputeVisibility() != "invisible":
            visuals[_group(prim, body), _material(prim)].append(_corners(prim, T, points, counts, indices))
    merged = [_merge(f"{body.GetName()}_{i}", group, look, parts) for i, ((group, look), parts) in enumerate(visuals.items())]
    handles = [(s.points.max(axis=0) + s.points.min(axis=0)) / 2 for s in merged if s.group == "handle"]
    return tuple(merged), tuple(boxes), tuple(hulls), np.mean(handles, axis=0).astype(np.float64) if handles else None


def _gprims(body: Usd.Prim, others: set[Sdf.Path]) -> Iterator[Usd.Prim]:
    walk = iter(Usd.PrimRange(body, Usd.TraverseInstanceProxies()))
    for prim in walk:
        if prim.GetPath() in others:
            walk.PruneChildren()
        elif prim.IsA(UsdGeom.Gprim):
            yield prim


def _polygons(prim: Usd.Prim) -> tuple[Floats, NDArray[np.int64], NDArray[np.int64]]:
    """Return points (n, 3), vertices per face and their indices, in the prim's frame."""
    if prim.IsA(UsdGeom.Mesh):
        mesh = UsdGeom.Mesh(prim)
        counts, indices = (np.array(a.Get(), np.int64) for a in (mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()))
        return np.array(mesh.GetPointsAttr().Get(), np.float64), counts, indices
    if not prim.IsA(UsdGeom.Cube):
        raise ContentError(f"{prim.GetPath()} is a {prim.GetTypeName()}", "only meshes and cubes can be exported")
    side = UsdGeom.Cube(prim).GetSizeAttr().Get() / 2
    indices = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]], np.int64).ravel()
    return np.array(list(product((-side, side), repeat=3))), np.full(6, 4, np.int64), indices


def _collider(prim: Usd.Prim, points: Floats, name: str, path: str) -> Box | Hull:
    """Return a collider: a box where its corners are those of one, otherwise the hull, by the name `name`."""
    approximation = "convexHull"
    if prim.IsA(UsdGeom.Mesh):
        approximation = UsdPhysics.MeshCollisionAPI(prim).GetApproximationAttr().Get() or "none"
    low, high = points.min(axis=0), points.max(axis=0)
    friction = _friction(prim)
    corner = np.abs(points - low).clip(max=np.abs(points - high))  # distance to the nearer face, along each axis
    octants = {tuple(row) for row in (points > (low + high) / 2).tolist()}
    if approximation == "boundingCube" or (len(octants) == 8 and corner.max() < SQUARE):
        return Box((low + high) / 2, (high - low) / 2, friction, path)
    if approximation != "convexHull":
        raise ContentError(f"{prim.GetPath()} collides as {approximation!r}", "only convex hulls and boxes mean the same in every format")
    hull = ConvexHull(points)
    used, faces = np.unique(hull.simplices, return_inverse=True)
    faces = faces.reshape(-1, 3)
    corners = points[used]
    a, b, c = (corners[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return Hull(name, corners.astype(np.float32), faces.astype(np.int32), friction, path)


def _corners(prim: Usd.Prim, T: Floats, points: Floats, counts: NDArray[np.int64], indices: NDArray[np.int64]) -> Corners:
    """Cut convex polygons into fans of triangles."""
    starts = np.cumsum(counts) - counts
    fans = [np.column_stack([starts[counts > k + 1] + j for j in (0, k, k + 1)]) for k in range(1, int(counts.max()) - 1)]
    triangles = np.concatenate(fans)
    if UsdGeom.Gprim(prim).GetOrientationAttr().Get() == "leftHanded":
        triangles = triangles[:, ::-1]
    corner = triangles.ravel()
    at = points[indices[corner]]
    uv = _primvar(UsdGeom.PrimvarsAPI(prim).GetPrimvar("st"), indices, corner)
    normals = _normals(prim, indices, corner)
    if normals is None:
        a, b, c = at[0::3], at[1::3], at[2::3]
        normals = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    else:
        normals = normals @ inverse(T[:3, :3])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, lengths, out=np.tile([0.0, 0.0, 1.0], (len(normals), 1)), where=lengths > 1e-12)
    return Corners(at, normals, uv)


def _normals(prim: Usd.Prim, indices: NDArray[np.int64], corner: NDArray[np.int64]) -> Floats | None:
    primvar = UsdGeom.PrimvarsAPI(prim).GetPrimvar("normals")
    if primvar and primvar.HasValue():
        return _primvar(primvar, indices, corner)
    if not prim.IsA(UsdGeom.Mesh) or not UsdGeom.Mesh(prim).GetNormalsAttr().Get():
        return None
    mesh = UsdGeom.Mesh(prim)
    return _spread(np.array(mesh.GetNormalsAttr().Get(), np.float64), mesh.GetNormalsInterpolation(), indices, corner)


def _primvar(primvar: UsdGeom.Primvar, indices: NDArray[np.int64], corner: NDArray[np.int64]) -> Floats | None:
    if not primvar or not primvar.HasValue():
        return None
    return _spread(np.array(primvar.ComputeFlattened(), np.float64), primvar.GetInterpolation(), indices, corner)


def _spread(values: Floats, interpolation: str, indices: NDArray[np.int64], corner: NDArray[np.int64]) -> Floats | None:
    if interpolation == "faceVarying":
        return values[corner]
    return values[indices[corner]] if interpolation in {"vertex", "varying"} else None


def _merge(name: str, group: str, material: Material, parts: list[Corners]) -> Surface:
    """Join meshes of one look, corners that are equal in all but their face written once."""
    textured = any(part.uv is not None for part in parts) and material.texture is not None
    uvs = [np.zeros((len(p.points), 2)) if p.uv is None else p.uv for p in parts]
    rows = [np.hstack([p.points, p.normals, *([uv] if textured else [])]) for p, uv in zip(parts, uvs, strict=True)]
    unique, corner = np.unique(np.concatenate(rows).astype(np.float32), axis=0, return_inverse=True)
    faces = corner.reshape(-1, 3).astype(np.int32)
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 0] != faces[:, 2])]
    return Surface(name, group, material, unique[:, :3], unique[:, 3:6], unique[:, 6:8] if textured else None, faces)


def _group(prim: Usd.Prim, body: Usd.Prim) -> str:
    labels = prim.GetAttribute("semantics:labels:class").Get() if prim.HasAttribute("semantics:labels:class") else None
    if labels:
        return str(labels[0])
    return "" if prim.GetParent() == body else prim.GetParent().GetName()


def _material(prim: Usd.Prim) -> Material:
    bound, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
    surface, _, _ = bound.ComputeSurfaceSource() if bound else (None, None, None)
    if not surface:
        return GREY
    base = surface.GetInput("diffuseColor")
    texture = None
    if base.HasConnectedSource():
        reader = UsdShade.Shader(base.GetConnectedSources()[0][0].source.GetPrim())
        asset = reader.GetInput("file").Get()
        if not asset.resolvedPath:
            raise ContentError(f"{prim.GetPath()} wears a texture that is missing ({asset.path})", "copy the dataset again")
        texture = Path(asset.resolvedPath)
    red, green, blue = map(float, base.Get() or (1.0, 1.0, 1.0))
    roughness, metallic, opacity = (
        _input(surface, name, value) for name, value in (("roughness", 0.5), ("metallic", 0.0), ("opacity", 1.0))
    )
    return Material(bound.GetPrim().GetName(), (red, green, blue), roughness, metallic, opacity, texture)


def _input(shader: UsdShade.Shader, name: str, otherwise: float) -> float:
    shader_input = shader.GetInput(name)
    value = shader_input.Get() if shader_input else None
    return otherwise if value is None else round(float(value), 6)


def _friction(prim: Usd.Prim) -> float:
    for purpose in ("physics", UsdShade.Tokens.allPurpose):
        bound, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial(purpose)
        if bound and bound.GetPrim().HasAPI(UsdPhysics.MaterialAPI):
            value = UsdPhysics.MaterialAPI(bound.GetPrim()).GetDynamicFrictionAttr().Get()
            return round(float(value), 6)
    return FRICTION
