"""Links and joints of an asset under its root prim: an articulation, or colliders alone where nothing moves.

Small things are bodies of their own: they rest by gravity on what they stand on, and what opens of them moves along.
"""

from collections.abc import Sequence

import numpy as np
from pxr import Sdf

from pipeline import taxonomy
from pipeline.entities.asset import Asset, Link, Mesh
from pipeline.usd.corners import with_distinct_corners
from pipeline.usd.joints import convert_fixed, convert_joint
from pipeline.usd.layer import apply, identifiers, label, prim, relationship
from pipeline.usd.material import bind
from pipeline.usd.mesh import convert_box, convert_mesh
from pipeline.usd.physics import convert_body, convert_collider, convert_filter, convert_iterations, hide, volume
from pipeline.usd.resistance import resistance

RESERVED = ("joints", "materials")  # scopes beside the links
MOVERS = {
    "hinge_door": "door",
    "slider_drawer": "drawer",
    "hinge_lid": "lid",
    "slider_lid": "lid",
    "hinge_knob": "knob",
    "slider_button": "button",
}
HANDLES = {"line_fixed_handle": "handle", "round_fixed_handle": "handle", "hinge_handle": "handle"}
SAME = 1e-5  # corners of a box may be off by so much [m]
TOUCH = 0.005  # parts whose boxes come this close at rest may rub [m]


def link_names(asset: Asset) -> list[str]:
    """Return the prim names of the links, in order."""
    return identifiers((link.name for link in asset.links), RESERVED)


def joint_names(asset: Asset) -> list[str]:
    """Return the prim names of the joints, in order."""
    return identifiers((joint.name for joint in asset.joints), ("world_fixed",))


def loose(asset: Asset) -> bool:
    """Whether an asset is a small thing that lies free, fixed to nothing."""
    known = taxonomy.load().categories.get(asset.category)
    return known is not None and known.loose


def is_visual_only(asset: Asset) -> bool:
    """Whether an asset is there to be looked at alone: what hangs on a wall or at a ceiling, and rugs, over which doors and wheels pass."""
    known = taxonomy.load().categories.get(asset.category)
    return known is not None and known.felt == "seen" and not known.loose


def convert_asset(root: Sdf.PrimSpec, asset: Asset, materials: Sequence[Sdf.Path]) -> None:
    """Write all links, and where anything moves the joints, under `root`."""
    names, free = link_names(asset), loose(asset)
    links = [prim(root, name) for name in names]
    moving = {joint.child: joint for joint in asset.joints}
    for i, (spec, link) in enumerate(zip(links, asset.links, strict=True)):
        if asset.articulated or free:
            convert_body(spec, link)
            if not asset.articulated:
                convert_iterations(spec, "RigidBody")
        if i in moving:
            part = moving[i].part_class
            label(spec, "class", [MOVERS.get(part, HANDLES.get(part, "part"))])
            label(spec, "part", [part])
        _convert_pieces(spec, link, asset, materials, weigh=asset.articulated or free)
    if asset.articulated:
        apply(root, ["PhysicsArticulationRootAPI"])
        convert_iterations(root, "Articulation")
        scope = prim(root, "joints", "Scope")
        if not free:
            convert_fixed(scope, root.path, links[0].path)
        prims = dict(zip((joint.name for joint in asset.joints), joint_names(asset), strict=True))
        for index, joint in enumerate(asset.joints):
            ends = links[joint.parent].path, links[joint.child].path
            joint_prim = convert_joint(scope, prims[joint.name], joint, *ends, resistance(asset, index))
            if joint.after:  # engines know no such order; whoever plans for a robot does
                relationship(joint_prim, "sfgen:after", [scope.path.AppendChild(prims[name]) for name in joint.after])
        for i, spec in enumerate(links):
            convert_filter(spec, [links[k].path for k in _passes(asset, i)])


def _convert_pieces(spec: Sdf.PrimSpec, link: Link, asset: Asset, materials: Sequence[Sdf.Path], *, weigh: bool) -> None:
    """Write visuals and colliders; a collider that is the very mesh that one sees, and no box, is one prim with it."""
    colliders = () if is_visual_only(asset) else link.colliders
    weights = [volume(c) for c in colliders]
    shares = {_key(c): link.mass * w / sum(weights) if weigh else None for c, w in zip(colliders, weights, strict=True)}
    hidden = hidden_colliders(link) if colliders else {}
    seen = shares.keys() - {_key(mesh) for mesh in hidden.values()}
    for name, mesh in zip(_visual_names(link), link.visuals, strict=True):
        material = asset.materials[mesh.material] if asset.materials else None
        gprim = convert_mesh(spec, name, mesh, material.base_color if material else (0.8, 0.8, 0.8))
        if materials:
            bind(gprim, materials[mesh.material])
        if mesh.part:
            label(gprim, "class", [HANDLES.get(mesh.part, MOVERS.get(mesh.part, "part"))])
            label(gprim, "part", [mesh.part])
        key = _key(mesh)
        if key in seen:
            seen.remove(key)
            convert_collider(gprim, shares[key])
    for name, mesh in hidden.items():
        if _is_box(mesh):
            gprim = convert_box(spec, name, mesh.vertices.min(axis=0), mesh.vertices.max(axis=0))
        else:
            shape = with_distinct_corners(mesh) if loose(asset) else mesh
            gprim = convert_mesh(spec, name, Mesh(shape.name, shape.vertices, shape.faces), None)
        hide(gprim)
        convert_collider(gprim, shares[_key(mesh)])
        if materials:
            bind(gprim, materials[min(mesh.material, len(materials) - 1)])


def hidden_colliders(link: Link) -> dict[str, Mesh]:
    """Return by prim name the colliders of a link that are prims of their own: boxes, and what is not the very mesh that one sees."""
    seen = {_key(mesh) for mesh in link.visuals}
    hidden = {_key(c): c for c in link.colliders if _key(c) not in seen or _is_box(c)}
    return dict(zip(identifiers((f"{c.name}_collider" for c in hidden.values()), _visual_names(link)), hidden.values(), strict=True))


def _visual_names(link: Link) -> list[str]:
    return identifiers(m.name for m in link.visuals)


def _key(mesh: Mesh) -> tuple[bytes, bytes]:
    return np.ascontiguousarray(mesh.vertices, np.float32).tobytes(), np.ascontiguousarray(mesh.faces, np.int32).tobytes()


def _is_box(mesh: Mesh) -> bool:
    """Whether a convex mesh is a box with sides along the axes."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    ends = (np.abs(mesh.vertices - low) < SAME) | (np.abs(mesh.vertices - high) < SAME)
    octants = np.unique(mesh.vertices > (low + high) / 2, axis=0)
    return len(mesh.vertices) == len(octants) == 8 and bool(ends.all() and (high - low > SAME).all())


def _passes(asset: Asset, link: int) -> list[int]:
    """Return the later links that `link` must not collide with: the base's and its own movers, and movers it touches at rest.

    What moves on a mover meets the base: the lid on a toilet's seat comes to lie against the cistern.
    """
    boxes = [_box(entry) for entry in asset.links]
    joined = {(j.parent, j.child) for j in asset.joints} | {(j.child, j.parent) for j in asset.joints}
    links = []
    for other in range(link + 1, len(asset.links)):
        near = _meet(boxes[link], boxes[other])
        if near and link == 0:
            near = any(_meet(_box_of(a), _box_of(b)) for a in asset.links[0].colliders for b in asset.links[other].colliders)
        if (link, other) in joined or near:
            links.append(other)
    return links


def _meet(one: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray]) -> bool:
    (low, high), (low2, high2) = one, other
    return bool(np.all(low <= high2 + TOUCH) and np.all(low2 <= high + TOUCH))


def _box(link: Link) -> tuple[np.ndarray, np.ndarray]:
    meshes = link.colliders or link.visuals
    return _box_of(*meshes) if meshes else (np.zeros(3), np.zeros(3))


def _box_of(*meshes: Mesh) -> tuple[np.ndarray, np.ndarray]:
    points = np.concatenate([m.vertices for m in meshes])
    return points.min(axis=0), points.max(axis=0)
