"""MuJoCo's XML. Written as it stands, since MuJoCo's own writer keeps six digits; what MuJoCo then makes of it the tests ask MuJoCo.

Bodies stand in the frames that they have in USD; joints are `<object>/<joint>`, bodies `<object>/<link>`, handles sites.
Static friction has no place in MuJoCo; its one coefficient is the dynamic one.
"""

from collections.abc import Mapping
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from pipeline.arrays import Floats
from pipeline.export.files import display, numbers, position, quaternion, xml_bytes
from pipeline.export.model import Body, Inertia, Joint, Material, Model, Placed, Scene, inverse

TIMESTEP = 0.002  # [s], MuJoCo's own default


def model_xml(model: Model) -> bytes:
    """Return a model alone, in the folder of its meshes."""
    root = _root(model.name)
    writer = _Writer(root, {model.name: model}, {model.name: "."})
    writer.place(Placed(model.name, "object", model.name, np.eye(4), np.ones(3), ""))
    return xml_bytes(_without_empty(root))


def scene_xml(scene: Scene, folders: Mapping[str, str]) -> bytes:
    """Return a home; `folders` say where each model's meshes lie, as seen from the home's file."""
    root = _root(scene.scene_id, scene.asleep)
    writer = _Writer(root, scene.models, folders)
    for placed in scene.placed:
        writer.place(placed)
    return xml_bytes(_without_empty(root))


class _Writer:
    """The sections of one file, and which meshes and materials they hold already."""

    def __init__(self, root: Element, models: Mapping[str, Model], folders: Mapping[str, str]) -> None:
        self._models, self._folders = models, folders
        self._asset, self._world, self._contact = (SubElement(root, name) for name in ("asset", "worldbody", "contact"))
        self._known: set[str] = set()
        self._scales: dict[tuple[str, tuple[float, ...]], int] = {}

    def place(self, placed: Placed) -> None:
        """Write one placed model."""
        model = self._models[placed.model].without(placed.off)
        children: dict[int, list[Joint]] = {}
        for joint in model.joints:
            children.setdefault(joint.parent, []).append(joint)
        carried = {joint.child for joint in model.joints}

        def write(parent: Element, index: int, T: Floats, joint: Joint | None) -> None:
            element = self._body(parent, placed, model, index, T)
            if joint is None and index not in model.grounded:
                SubElement(element, "freejoint", name=f"{placed.name}/{model.bodies[index].name}")
            if joint is not None:
                self._joint(element, placed, joint)
            for child_joint in children.get(index, []):
                write(element, child_joint.child, child_joint.T_parent_joint @ inverse(child_joint.T_child_joint), child_joint)

        for index, body in enumerate(model.bodies):
            if index not in carried:
                write(self._world, index, placed.T_world_model @ _scale_translation(body.T_model_body, placed.scale), None)
        for joint in children.get(-1, []):
            T = joint.T_parent_joint @ inverse(joint.T_child_joint)
            write(self._world, joint.child, placed.T_world_model @ T, joint)
        for a, b in model.passes:
            names = [f"{placed.name}/{model.bodies[i].name}" for i in (a, b)]
            SubElement(self._contact, "exclude", body1=names[0], body2=names[1])

    def _body(self, parent: Element, placed: Placed, model: Model, index: int, T: Floats) -> Element:
        body = model.bodies[index]
        element = SubElement(parent, "body", name=f"{placed.name}/{body.name}", pos=position(T), quat=numbers(quaternion(T)))
        if body.inertia is not None:
            _inertial(element, body.inertia)
        self._geoms(element, placed, model, body)
        if body.handle is not None:
            SubElement(element, "site", name=f"{placed.name}/{body.name}/handle", pos=numbers(body.handle * placed.scale))
        return element

    def _geoms(self, element: Element, placed: Placed, model: Model, body: Body) -> None:
        for surface in body.surfaces:
            mesh = self._mesh(model, placed, surface.name, visual=True)
            geom_class = "ceiling" if surface.group == "ceiling" else "visual"
            SubElement(element, "geom", {"class": geom_class}, mesh=mesh, material=self._material(model, surface.material))
        for box in body.boxes:
            pos, size = numbers(box.center * placed.scale), numbers(box.half * placed.scale)
            SubElement(element, "geom", {"class": "collider"}, type="box", pos=pos, size=size, friction=numbers([box.friction]))
        for hull in body.hulls:
            mesh = self._mesh(model, placed, hull.name, visual=False)
            SubElement(element, "geom", {"class": "collider"}, type="mesh", mesh=mesh, friction=numbers([hull.friction]))

    def _mesh(self, model: Model, placed: Placed, stem: str, *, visual: bool) -> str:
        scale = tuple(placed.scale.tolist())
        name = f"{model.name}/{stem}"
        if scale != (1.0, 1.0, 1.0):  # each scale of a model is a mesh of its own, of the same file
            name += f"/{self._scales.setdefault((model.name, scale), len(self._scales))}"
        if name not in self._known:
            self._known.add(name)
            about = {"scale": numbers(scale)} if scale != (1.0, 1.0, 1.0) else {}
            # a visual mesh may be flat: then only its shell has moments, and nobody asks for them
            about |= {"inertia": "shell"} if visual else {}
            SubElement(self._asset, "mesh", {"name": name, "file": f"{self._folders[model.name]}/{stem}.obj", **about})
        return name

    def _material(self, model: Model, material: Material) -> str:
        name = f"{model.name}/{material.name}"
        if name not in self._known:
            self._known.add(name)
            about = {"rgba": numbers([*display(material.color), material.opacity])}
            if material.texture:
                file = f"{self._folders[model.name]}/{material.texture.name}"
                SubElement(self._asset, "texture", name=name, type="2d", file=file)
                about = {"texture": name, "rgba": numbers([1, 1, 1, material.opacity])}
            shine = {"specular": numbers([0.5 * (1 - material.roughness)]), "shininess": numbers([1 - material.roughness])}
            SubElement(self._asset, "material", {"name": name, **about, **shine})
        return name

    def _joint(self, element: Element, placed: Placed, joint: Joint) -> None:
        if joint.kind == "fixed":
            return
        T = joint.T_child_joint
        about = {"pos": position(T), "axis": numbers(T[:3, :3] @ joint.axis)}
        if np.isfinite([joint.lower, joint.upper]).all():
            about["range"] = numbers([joint.lower, joint.upper])
        for name, values in zip(("solreflimit", "solimplimit"), joint.stops, strict=False):
            about[name] = numbers(values)
        dynamics = {"damping": joint.damping, "frictionloss": joint.friction, "armature": joint.armature, "stiffness": joint.stiffness}
        if joint.stiffness:
            about["springref"] = numbers([joint.rest])
        about |= {name: numbers([value]) for name, value in dynamics.items() if value}
        SubElement(element, "joint", {"name": f"{placed.name}/{joint.name}", "type": joint.kind, **about})


def _root(name: str, asleep: float = 0.0) -> Element:
    root = Element("mujoco", model=name)
    SubElement(root, "compiler", angle="radian", autolimits="true")
    option = SubElement(root, "option", timestep=numbers([TIMESTEP]), integrator="implicitfast")
    if asleep:
        option.set("sleep_tolerance", numbers([asleep]))
        SubElement(option, "flag", sleep="enable")
    visual = SubElement(root, "visual")
    SubElement(visual, "headlight", ambient="0.45 0.45 0.45", diffuse="0.5 0.5 0.5", specular="0.1 0.1 0.1")
    default = SubElement(root, "default")
    for kind, group in (("visual", "2"), ("ceiling", "1")):  # of its own, so that a viewer can look in from above
        visual_class = SubElement(default, "default", {"class": kind})
        SubElement(visual_class, "geom", type="mesh", contype="0", conaffinity="0", group=group, density="0")
    collider_class = SubElement(default, "default", {"class": "collider"})
    SubElement(collider_class, "geom", group="3", density="0")
    return root


def _inertial(element: Element, inertia: Inertia) -> None:
    pos, axes, moments = (numbers(values) for values in (inertia.center, inertia.axes, inertia.moments))
    SubElement(element, "inertial", pos=pos, quat=axes, mass=numbers([inertia.mass]), diaginertia=moments)


def _scale_translation(T: Floats, scale: Floats) -> Floats:
    """Return a body's transform in a scaled model; only its place is scaled, its geometry is by whoever writes it."""
    T_scaled = T.copy()
    T_scaled[:3, 3] *= scale
    return T_scaled


def _without_empty(root: Element) -> Element:
    for section in [section for section in root if section.tag in {"asset", "contact"} and not len(section)]:
        root.remove(section)
    return root
