"""Binary glTF 2.0 files (.glb) as meshes, for URDFs whose meshes are of that kind.

Read: the default scene's nodes with their matrices, triangles of float positions, plain indices, the first set of uvs,
base colours and embedded PNG or JPEG images. Compressed geometry is refused; what is outside the file is not fetched.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline.sources.guarded import parse_json
from pipeline.sources.meshes.obj_file import MAX_COORDINATE, MAX_FACES, MAX_GROUPS, MAX_VERTICES, ObjFile, ObjGroup
from pipeline.sources.reasons import SourceError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
MAX_GLB = 64 << 20  # bytes
DEPTH = 64  # of the tree of nodes
MOST = 20_000  # nodes and accessors
_COMPONENTS = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}


@dataclass(frozen=True, slots=True)
class GltfMaterial:
    """Linear base colour (4,), roughness, and the bytes of the base colour's image or b"" without one."""

    color: tuple[float, float, float, float]
    roughness: float
    image: bytes


def parse_glb(data: bytes, where: str) -> tuple[ObjFile, dict[str, GltfMaterial]]:
    """Return the file's triangles, a group per primitive, and its materials by name.

    Raises SourceError `not_obj`, `bad_number` or `too_large`, naming `where`.
    """
    try:
        return _Reader(data, where).read()
    except (KeyError, IndexError, TypeError, ValueError, OverflowError, AttributeError, struct.error) as error:
        raise SourceError("not_obj", where, f"is no glTF file, or a broken one ({type(error).__name__}: {str(error)[:60]})") from error


class _Reader:
    def __init__(self, data: bytes, where: str) -> None:
        magic, version, length = struct.unpack_from("<4sII", data, 0)
        if magic != b"glTF" or version != 2 or length > len(data):
            raise SourceError("not_obj", where, "is no binary glTF 2.0 file, or truncated")
        size, kind = struct.unpack_from("<I4s", data, 12)
        if kind != b"JSON" or 20 + size > length:
            raise SourceError("not_obj", where, "does not begin with its JSON")
        self.where, self.binary = where, data[28 + size : length]
        self.tree = parse_json(data[20 : 20 + size].rstrip(b" \x00"), where)
        if any(len(self.tree.get(k, ())) > MOST for k in ("nodes", "accessors", "meshes", "materials")):
            raise SourceError("too_large", where, "has too many nodes, meshes or materials")
        self.vertices: list[Floats] = []
        self.uvs: list[Floats] = []
        self.groups: list[ObjGroup] = []
        self.counts = [0, 0, 0]  # vertices, uvs, faces
        self.visits = 0  # of nodes and primitives: a few nodes that name each other twice are a tree without end

    def read(self) -> tuple[ObjFile, dict[str, GltfMaterial]]:
        scenes = self.tree.get("scenes") or [{"nodes": list(range(len(self.tree["nodes"])))}]
        for node in scenes[self.tree.get("scene", 0)]["nodes"]:
            self._node(node, np.eye(4), 0)
        if not self.groups:
            raise SourceError("not_obj", self.where, "has no triangles")
        uvs = np.concatenate(self.uvs) if self.counts[1] else np.zeros((0, 2))
        file = ObjFile(np.concatenate(self.vertices), uvs, tuple(self.groups), "")
        used = {int(group.material) for group in self.groups if group.material}
        return file, {str(k): self._material(self.tree["materials"][k]) for k in sorted(used)}

    def _node(self, number: int, T: Floats, depth: int) -> None:
        if depth > DEPTH:
            raise SourceError("not_obj", self.where, "has nodes in a loop, or too deep")
        self._visit()
        node = self.tree["nodes"][number]
        T = T @ _matrix(node)
        if "mesh" in node:
            for primitive in self.tree["meshes"][node["mesh"]]["primitives"]:
                self._primitive(primitive, T)
        for child in node.get("children", ()):
            self._node(child, T, depth + 1)

    def _visit(self) -> None:
        self.visits += 1
        if self.visits > MOST:
            raise SourceError("too_large", self.where, f"draws more than {MOST} things")

    def _primitive(self, primitive: dict[str, Any], T: Floats) -> None:
        self._visit()
        if primitive.get("mode", 4) != 4:
            return
        if primitive.get("extensions", {}).keys() & {"KHR_draco_mesh_compression"}:
            raise SourceError("not_obj", self.where, "is compressed (Draco)")
        attributes = primitive["attributes"]
        points = self._accessor(attributes["POSITION"], 3)
        uvs = self._accessor(attributes["TEXCOORD_0"], 2) if "TEXCOORD_0" in attributes else np.zeros((0, 2))
        index = self._accessor(primitive["indices"], 1)[:, 0] if "indices" in primitive else np.arange(len(points))
        faces = index[: len(index) // 3 * 3].astype(np.int64).reshape(-1, 3)
        if len(faces) and (faces.max() >= len(points) or (len(uvs) and len(uvs) != len(points))):
            raise SourceError("not_obj", self.where, "indexes vertices that are not there")
        if np.linalg.det(T[:3, :3]) < 0:
            faces = faces[:, ::-1]
        points = points @ T[:3, :3].T + T[:3, 3]
        if not np.isfinite(points).all() or np.abs(points).max(initial=0) > MAX_COORDINATE or not np.isfinite(uvs).all():
            raise SourceError("bad_number", self.where, "has coordinates that are not finite, or absurd")
        start, start_uv = self.counts[0], self.counts[1]
        self.counts = [start + len(points), start_uv + len(uvs), self.counts[2] + len(faces)]
        if self.counts[0] > MAX_VERTICES or self.counts[2] > MAX_FACES or len(self.groups) >= MAX_GROUPS:
            raise SourceError("too_large", self.where, f"has {self.counts[0]} vertices and {self.counts[2]} faces")
        self.vertices.append(points)
        self.uvs.append(np.stack([uvs[:, 0], 1 - uvs[:, 1]], axis=1))  # glTF's v points down
        material = primitive.get("material")
        uv_faces = faces + start_uv if len(uvs) else np.full_like(faces, -1)
        self.groups.append(ObjGroup("", "" if material is None else str(int(material)), faces + start, uv_faces))

    def _accessor(self, number: int, width: int) -> Floats:
        """Return an accessor's values (N, width)."""
        accessor = self.tree["accessors"][number]
        if "sparse" in accessor or "bufferView" not in accessor or _WIDTHS[accessor["type"]] != width:
            raise SourceError("not_obj", self.where, "has an accessor of a kind that is not read")
        kind, count = np.dtype(_COMPONENTS[accessor["componentType"]]), int(accessor["count"])
        view = self._view(accessor["bufferView"])[int(accessor.get("byteOffset", 0)) :]
        stride = int(self.tree["bufferViews"][accessor["bufferView"]].get("byteStride") or kind.itemsize * width)
        if not 0 < count <= 3 * MAX_FACES or stride < kind.itemsize * width or (count - 1) * stride + kind.itemsize * width > len(view):
            raise SourceError("not_obj", self.where, "has an accessor beyond its buffer")
        values = np.ndarray((count, width), kind, view, 0, (stride, kind.itemsize)).astype(np.float64)
        return values / float(np.iinfo(kind).max) if accessor.get("normalized") and kind.kind == "u" else values

    def _view(self, number: int) -> bytes:
        view = self.tree["bufferViews"][number]
        if view["buffer"] != 0 or "uri" in self.tree["buffers"][0] or "EXT_meshopt_compression" in view.get("extensions", {}):
            raise SourceError("not_obj", self.where, "keeps data outside the file, or compressed")
        start, length = int(view.get("byteOffset", 0)), int(view["byteLength"])
        if start < 0 or length < 0 or start + length > len(self.binary):
            raise SourceError("not_obj", self.where, "has data beyond its end")
        return self.binary[start : start + length]

    def _material(self, entry: dict[str, Any]) -> GltfMaterial:
        surface = entry.get("pbrMetallicRoughness", {})
        values = [min(max(float(v), 0.0), 1.0) for v in surface.get("baseColorFactor", (1, 1, 1, 1))]
        r, g, b, a = values if np.isfinite(values).all() else [0.8, 0.8, 0.8, 1.0]
        opacity = a if entry.get("alphaMode") == "BLEND" else 1.0
        roughness = min(max(float(surface.get("roughnessFactor", 1.0)), 0.0), 1.0)
        image = b""
        if "baseColorTexture" in surface:
            source = self.tree["textures"][surface["baseColorTexture"]["index"]].get("source")
            if source is not None and "bufferView" in self.tree["images"][source]:
                image = self._view(self.tree["images"][source]["bufferView"])
        return GltfMaterial((r, g, b, opacity), roughness if np.isfinite(roughness) else 0.6, image)


def _matrix(node: dict[str, Any]) -> Floats:
    """Return a node's transform (4, 4): its matrix, column by column, or translation, rotation (x, y, z, w) and scale."""
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    T = np.eye(4)
    x, y, z, w = (float(v) for v in node.get("rotation", (0, 0, 0, 1)))
    T[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    T[:3, :3] *= np.array(node.get("scale", (1, 1, 1)), np.float64).reshape(3)
    T[:3, 3] = np.array(node.get("translation", (0, 0, 0)), np.float64).reshape(3)
    return T
