"""glTF 2.0 in one binary file, for the web and for viewers: the home as one sees it, every joint a node that can be turned.

A joint is a node in whose frame the joint moves (extras: type, axis, limits); the body that it carries hangs below, with its mass in
its extras. Meshes that several objects share are written once. glTF is Y up: the root node turns the home, all below it is Z up.
"""

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats
from pipeline.export.files import quaternion
from pipeline.export.model import Body, Inertia, Joint, Material, Model, Placed, Scene, Surface, inverse

FLOAT, UINT = 5126, 5125  # component types
VERTICES, INDICES = 34962, 34963  # targets of buffer views
UPRIGHT = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]  # (x, y, z, w): what is Z up becomes Y up


def scene_glb(scene: Scene, licence: str) -> bytes:
    """Return a home as GLB."""
    writer = _Writer()
    tops = [writer.place(scene.models[placed.model], placed) for placed in scene.placed]
    return writer.to_bytes(scene.scene_id, tops, licence)


class _Writer:
    """The lists of one file, and the binary chunk that they point into."""

    def __init__(self) -> None:
        self._nodes: list[dict[str, Any]] = []
        self._lists: dict[str, list[dict[str, Any]]] = {}
        self._binary = bytearray()
        self._meshes: dict[tuple[str, int, str], int] = {}
        self._materials: dict[Material, int] = {}
        self._images: dict[bytes, int] = {}

    def place(self, model: Model, placed: Placed) -> int:
        """Write one placed model and return its node."""
        joints = {joint.child: joint for joint in model.joints}
        nodes = {i: self._body(model, i, body) for i, body in enumerate(model.bodies)}
        tops = []
        for i, body in enumerate(model.bodies):
            joint = joints.get(i)
            if joint is None:
                _move(self._nodes[nodes[i]], body.T_model_body)
                tops.append(nodes[i])
                continue
            T_joint_child: Floats = inverse(joint.T_child_joint)
            _move(self._nodes[nodes[i]], T_joint_child)
            turned = self._node(joint.name, [nodes[i]], extras=_joint_extras(joint))
            _move(self._nodes[turned], joint.T_parent_joint)
            if joint.parent < 0:
                tops.append(turned)
            else:
                self._nodes[nodes[joint.parent]].setdefault("children", []).append(turned)
        node = self._node(placed.name, tops, extras={"kind": placed.kind, "model": model.name})
        _move(self._nodes[node], placed.T_world_model, placed.scale)
        return node

    def to_bytes(self, name: str, tops: list[int], licence: str) -> bytes:
        """Return the whole file."""
        root = self._node(name, tops)
        self._nodes[root]["rotation"] = UPRIGHT
        document = {
            "asset": {"version": "2.0", "generator": "sfgen", "copyright": licence},
            "scene": 0,
            "scenes": [{"name": name, "nodes": [root]}],
            "nodes": self._nodes,
            **self._lists,
            "buffers": [{"byteLength": len(self._binary)}],
        }
        text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
        chunks = [(text + b" " * (-len(text) % 4), b"JSON"), (bytes(self._binary), b"BIN\0")]
        body = b"".join(struct.pack("<I", len(data)) + kind + data for data, kind in chunks)
        return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body

    def _add(self, name: str, entry: dict[str, Any]) -> int:
        entries = self._lists.setdefault(name, [])
        entries.append(entry)
        return len(entries) - 1

    def _node(self, name: str, children: list[int], **about: Any) -> int:
        self._nodes.append({"name": name, **({"children": children} if children else {}), **about})
        return len(self._nodes) - 1

    def _body(self, model: Model, index: int, body: Body) -> int:
        """Write a body: its mesh, and a child for each named group of it (handles, a room's ceiling), so that they can be found and hidden."""
        groups = list(dict.fromkeys(surface.group for surface in body.surfaces))
        inner = [self._node(group, [], mesh=self._mesh(model, index, body, group)) for group in groups if group]
        about: dict[str, Any] = {"mesh": self._mesh(model, index, body, "")} if "" in groups else {}
        if body.inertia is not None:
            about["extras"] = _inertia_extras(body.inertia)
        return self._node(body.name, inner, **about)

    def _mesh(self, model: Model, index: int, body: Body, group: str) -> int:
        key = model.name, index, group
        if key not in self._meshes:
            parts = [self._primitive(surface) for surface in body.surfaces if surface.group == group]
            self._meshes[key] = self._add("meshes", {"name": "/".join(filter(None, (model.name, body.name, group))), "primitives": parts})
        return self._meshes[key]

    def _primitive(self, surface: Surface) -> dict[str, Any]:
        box = {"min": surface.points.min(axis=0).tolist(), "max": surface.points.max(axis=0).tolist()}
        attributes = {"POSITION": self._accessor(surface.points, "VEC3", **box), "NORMAL": self._accessor(_unit(surface.normals), "VEC3")}
        if surface.uv is not None:
            down = np.column_stack([surface.uv[:, 0], 1 - surface.uv[:, 1]])  # glTF counts v from the top
            attributes["TEXCOORD_0"] = self._accessor(down, "VEC2")
        indices = self._accessor(surface.faces.astype(np.uint32).ravel(), "SCALAR")
        return {"attributes": attributes, "indices": indices, "material": self._material(surface.material)}

    def _accessor(self, values: NDArray[Any], kind: str, **bounds: Any) -> int:
        wide = values.dtype == np.uint32
        data = np.ascontiguousarray(values, "<u4" if wide else "<f4").tobytes()
        view = self._view(data, target=INDICES if wide else VERTICES)
        about = {"bufferView": view, "componentType": UINT if wide else FLOAT, "count": len(values), "type": kind}
        return self._add("accessors", {**about, **bounds})

    def _view(self, data: bytes, **about: Any) -> int:
        view = self._add("bufferViews", {"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(data), **about})
        self._binary += data + b"\0" * (-len(data) % 4)
        return view

    def _material(self, material: Material) -> int:
        if material not in self._materials:
            base = (1.0, 1.0, 1.0) if material.texture else material.color
            surface: dict[str, Any] = {
                "baseColorFactor": [*(round(min(max(c, 0.0), 1.0), 6) for c in base), material.opacity],
                "roughnessFactor": material.roughness,
                "metallicFactor": material.metallic,
            }
            if material.texture:
                surface["baseColorTexture"] = {"index": self._texture(material.texture.read_bytes())}
            about = {"name": material.name, "pbrMetallicRoughness": surface, "doubleSided": True}
            self._materials[material] = self._add("materials", about | ({"alphaMode": "BLEND"} if material.opacity < 1 else {}))
        return self._materials[material]

    def _texture(self, picture: bytes) -> int:
        if picture not in self._images:
            if "samplers" not in self._lists:
                self._add("samplers", {"wrapS": 10497, "wrapT": 10497})
            kind = "image/png" if picture.startswith(b"\x89PNG") else "image/jpeg"
            image = self._add("images", {"bufferView": self._view(picture), "mimeType": kind})
            self._images[picture] = self._add("textures", {"sampler": 0, "source": image})
        return self._images[picture]


def _unit(normals: NDArray[np.float32]) -> NDArray[np.float32]:
    wide = normals.astype(np.float64)
    wide /= np.linalg.norm(wide, axis=1, keepdims=True)
    return wide.astype(np.float32)


def _move(node: dict[str, Any], T: Floats, scale: Floats | None = None) -> None:
    """Give a node its place; what changes nothing is left out."""
    if np.abs(T[:3, 3]).max() > 1e-12:
        node["translation"] = [round(v, 12) for v in T[:3, 3].tolist()]
    w, x, y, z = quaternion(T).tolist()
    if abs(w - 1) > 1e-15:
        node["rotation"] = [x, y, z, w]
    if scale is not None and (scale != 1).any():
        node["scale"] = scale.tolist()


def _joint_extras(joint: Joint) -> dict[str, Any]:
    about: dict[str, Any] = {"joint": joint.kind}
    if joint.kind != "fixed":
        about |= {"axis": joint.axis.tolist(), "damping": joint.damping, "friction": joint.friction}
        about |= {"stiffness": joint.stiffness, "rest": joint.rest} if joint.stiffness else {}
    if np.isfinite([joint.lower, joint.upper]).all() and joint.kind != "fixed":
        about |= {"lower": joint.lower, "upper": joint.upper}
    return about | ({"after": list(joint.after)} if joint.after else {})


def _inertia_extras(inertia: Inertia) -> dict[str, Any]:
    named = {"center_of_mass": inertia.center, "diagonal_inertia": inertia.moments, "principal_axes_wxyz": inertia.axes}
    return {"mass": inertia.mass, **{name: values.tolist() for name, values in named.items()}}
