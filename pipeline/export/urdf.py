"""URDF: a file per thing that moves, one for all that stands still in a home, and a list of where they stand.

URDF knows one robot a file, so a home is `home.json` beside its files; things of the library lie in the library's folder,
but for those of which the home switches colliders off: they have a file of their own in the home, which takes its meshes from the library.
A link's frame lies in its joint, as the format wants it, and is turned as its body is in USD.
"""

from collections.abc import Mapping
from typing import Any
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from scipy.spatial.transform import Rotation

from pipeline.arrays import Floats
from pipeline.errors import ContentError
from pipeline.export.files import display, numbers, position, quaternion, xml_bytes
from pipeline.export.model import Body, Inertia, Joint, Model, Scene, inverse

KINDS = {"hinge": "revolute", "slide": "prismatic", "fixed": "fixed"}
STRONG = {"effort": "1000", "velocity": "100"}  # which URDF demands of every limit and USD does not bound


def model_urdf(model: Model, folder: str) -> bytes:
    """Return a model as a robot; `folder` is where its meshes lie, as seen from the file."""
    robot = Element("robot", name=model.name)
    joints = {joint.child: joint for joint in model.joints}
    roots = [i for i in range(len(model.bodies)) if i not in joints]
    loose = [i for i in roots if i not in model.grounded]
    if len(loose) > 1 or (loose and len(roots) > 1):
        raise ContentError(f"{model.name} has several bodies that no joint holds together", "URDF cannot say that; take mjcf")
    based = len(roots) != 1 or -1 in {j.parent for j in model.joints} or np.abs(model.bodies[roots[0]].T_model_body - np.eye(4)).max() > 0
    if based:
        SubElement(robot, "link", name="root")
    for i, body in enumerate(model.bodies):
        _link(robot, body, body.name, folder, _body_link(joints.get(i)), np.ones(3))
    for i in roots if based else []:
        _fix(robot, "root", model.bodies[i].name, model.bodies[i].T_model_body)
    for joint in model.joints:
        parent = model.bodies[joint.parent].name if joint.parent >= 0 else "root"
        T_parent_body = inverse(_body_link(joints.get(joint.parent))) @ joint.T_parent_joint
        _joint(robot, joint, parent, model.bodies[joint.child].name, T_parent_body @ inverse(joint.T_child_joint) @ _body_link(joint))
    return xml_bytes(robot)


def model_srdf(model: Model) -> bytes:
    """Return which links must not collide; loaders that know SRDF find it beside the URDF."""
    robot = Element("robot", name=model.name)
    for a, b in model.passes:
        SubElement(robot, "disable_collisions", link1=model.bodies[a].name, link2=model.bodies[b].name, reason="Default")
    return xml_bytes(robot)


def building_urdf(scene: Scene, folders: Mapping[str, str]) -> bytes:
    """Return all that stands still in a home as one robot: a link for each thing, scaled where it is placed scaled."""
    robot = Element("robot", name=scene.scene_id)
    SubElement(robot, "link", name="building")
    for placed in scene.placed:
        model = scene.models[placed.model].without(placed.off)
        if model.still:
            for body in model.bodies:
                name = placed.name if len(model.bodies) == 1 else f"{placed.name}_{body.name}"
                _link(robot, body, name, folders[model.name], np.eye(4), placed.scale)
                _fix(robot, "building", name, placed.T_world_model @ body.T_model_body)
    return xml_bytes(robot)


def placements(scene: Scene, files: Mapping[str, str]) -> dict[str, Any]:
    """Return home.json: what to load, where. `files` say where the URDF of each moving thing lies, as seen from the home."""
    placed = [
        {
            "name": p.name,
            "kind": p.kind,
            "urdf": files[p.name],
            "position": [round(v, 12) for v in p.T_world_model[:3, 3].tolist()],
            "orientation": [round(v, 12) for v in quaternion(p.T_world_model).tolist()],
            "fixed": bool(scene.models[p.model].grounded) or any(j.parent < 0 for j in scene.models[p.model].joints),
            "support": p.support,
        }
        for p in scene.placed
        if not scene.models[p.model].still
    ]
    return {"scene_id": scene.scene_id, "building": "building.urdf", "units": "m, orientation w x y z, Z up", "placed": placed}


def _link(robot: Element, body: Body, name: str, folder: str, T_body_link: Floats, scale: Floats) -> None:
    link = SubElement(robot, "link", name=name)
    shift: Floats = inverse(T_body_link)
    if body.inertia is not None:
        _inertial(link, body.inertia, shift)
    about = {"scale": numbers(scale)} if (scale != 1).any() else {}
    for surface in body.surfaces:
        visual = SubElement(link, "visual", name=surface.group or surface.name)
        SubElement(visual, "origin", xyz=position(shift), rpy="0 0 0")
        SubElement(SubElement(visual, "geometry"), "mesh", {"filename": f"{folder}/{surface.name}.obj", **about})
        look = SubElement(visual, "material", name=surface.material.name)
        SubElement(look, "color", rgba=numbers([*display(surface.material.color), surface.material.opacity]))
        if surface.material.texture:
            SubElement(look, "texture", filename=f"{folder}/{surface.material.texture.name}")
    for box in body.boxes:
        collision = SubElement(link, "collision")
        SubElement(collision, "origin", xyz=numbers(box.center * scale + shift[:3, 3]), rpy="0 0 0")
        SubElement(SubElement(collision, "geometry"), "box", size=numbers(2 * box.half * scale))
    for hull in body.hulls:
        collision = SubElement(link, "collision")
        SubElement(collision, "origin", xyz=position(shift), rpy="0 0 0")
        SubElement(SubElement(collision, "geometry"), "mesh", {"filename": f"{folder}/{hull.name}.obj", **about})


def _inertial(link: Element, inertia: Inertia, shift: Floats) -> None:
    element = SubElement(link, "inertial")
    SubElement(element, "origin", xyz=numbers(inertia.center + shift[:3, 3]), rpy="0 0 0")
    SubElement(element, "mass", value=numbers([inertia.mass]))
    R = Rotation.from_quat(inertia.axes, scalar_first=True).as_matrix()
    tensor = R @ np.diag(inertia.moments) @ R.T
    entries = {f"i{'xyz'[a]}{'xyz'[b]}": numbers([tensor[a, b]]) for a in range(3) for b in range(a, 3)}
    SubElement(element, "inertia", entries)


def _joint(robot: Element, joint: Joint, parent: str, child: str, T_parent_link: Floats) -> None:
    limited = bool(np.isfinite([joint.lower, joint.upper]).all())
    kind = KINDS[joint.kind] if limited or joint.kind == "fixed" else {"hinge": "continuous", "slide": "prismatic"}[joint.kind]
    element = _connect(robot, joint.name, kind, parent, child, T_parent_link)
    if kind == "fixed":
        return
    SubElement(element, "axis", xyz=numbers(joint.T_child_joint[:3, :3] @ joint.axis))
    bounds = {"lower": numbers([joint.lower]), "upper": numbers([joint.upper])} if limited else {}
    SubElement(element, "limit", {**bounds, **STRONG})
    SubElement(element, "dynamics", damping=numbers([joint.damping]), friction=numbers([joint.friction]))


def _fix(robot: Element, parent: str, child: str, T_parent_child: Floats) -> None:
    _connect(robot, f"{child}_fixed", "fixed", parent, child, T_parent_child)


def _connect(robot: Element, name: str, kind: str, parent: str, child: str, T_parent_child: Floats) -> Element:
    """Return a new joint between two links."""
    element = SubElement(robot, "joint", name=name, type=kind)
    SubElement(element, "parent", link=parent)
    SubElement(element, "child", link=child)
    angles = Rotation.from_matrix(T_parent_child[:3, :3]).as_euler("xyz")  # about fixed axes: roll, pitch, yaw
    SubElement(element, "origin", xyz=position(T_parent_child), rpy=numbers(np.where(np.abs(angles) < 1e-12, 0.0, angles)))
    return element


def _body_link(joint: Joint | None) -> Floats:
    """Return T_body_link: a link's origin lies in the joint that carries it."""
    T = np.eye(4)
    if joint is not None:
        T[:3, 3] = joint.T_child_joint[:3, 3]
    return T
