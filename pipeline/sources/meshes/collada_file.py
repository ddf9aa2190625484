"""COLLADA 1.4 and 1.5 files (.dae) as meshes, for URDFs whose meshes are of that kind.

Read: the scene's nodes with their transforms, triangles, polylists, polygons, strips and fans, the first set of uvs, the
unit and the axis that is up (turned to z, as a URDF's frames have it), colours and textures. Left
out: lines, holes of polygons, skins, cameras, lights. A DTD, an entity or an external reference is refused.
"""

import math
import warnings
from collections.abc import Iterator, Mapping
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats, Ints
from pipeline.sources.guarded import xml_root
from pipeline.sources.meshes.gathering import MeshGatherer
from pipeline.sources.meshes.obj_file import MeshMaterial, ObjFile, ObjGroup, fans, linear, roughness_of
from pipeline.sources.reasons import SourceError

Elements = Mapping[str, Any]  # of a file, by id
SHADERS = ("phong", "lambert", "blinn", "constant")
MAX_DAE = 16 << 20  # bytes; numbers of one digit take eight times their text
MAX_ELEMENTS = 200_000
DEPTH = 64  # of the tree of nodes
MOST_INPUTS = 64  # indices of a corner
MOST = 20_000  # nodes and primitives drawn
# Turns to z up; COLLADA 1.4 chapter 5, up_axis: right, up and inwards are -y, +x, +z of X_UP and +x, +y, +z of Y_UP.
UPRIGHT = {
    "X_UP": np.array([[0.0, -1, 0], [0, 0, -1], [1, 0, 0]]),
    "Y_UP": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "Z_UP": np.eye(3),
}
KINDS = frozenset({"triangles", "polylist", "polygons", "tristrips", "trifans"})


def parse_dae(data: bytes, where: str) -> tuple[ObjFile, dict[str, MeshMaterial]]:
    """Return the file's triangles [m, z up], a group per primitive, and its materials by name.

    Raises SourceError `not_obj`, `bad_number` or `too_large`, naming `where`.
    """
    try:
        return _Reader(_tree(data, where), where).read()
    except (KeyError, IndexError, TypeError, ValueError, OverflowError, AttributeError) as error:
        raise SourceError("not_obj", where, f"is no COLLADA file, or a broken one ({type(error).__name__}: {str(error)[:60]})") from error


def _tree(data: bytes, where: str) -> Any:
    root = xml_root(data, "not_obj", where, MAX_ELEMENTS)
    for element in root.iter():  # one namespace per version says nothing that the names do not
        if isinstance(element.tag, str):
            element.tag = element.tag.rpartition("}")[2]
    if root.tag != "COLLADA":
        raise SourceError("not_obj", where, f"its root is <{str(root.tag)[:40]}>, not <COLLADA>")
    return root


class _Reader:
    def __init__(self, root: Any, where: str) -> None:
        self.root, self.where = root, where
        self.elements: Elements = {e.get("id"): e for e in root.iter() if e.get("id")}
        self.gathered = MeshGatherer(where)
        self.sources: dict[tuple[str, int], Floats] = {}
        self.visits = 0  # of nodes and primitives: a few nodes that name each other twice are a tree without end

    def read(self) -> tuple[ObjFile, dict[str, MeshMaterial]]:
        T = np.eye(4)
        unit = self.root.find("asset/unit")
        T[:3, :3] = UPRIGHT[(self.root.findtext("asset/up_axis") or "Y_UP").strip()]
        T[:3, :3] *= float(unit.get("meter", 1.0)) if unit is not None else 1.0
        scene = self.root.find("scene/instance_visual_scene")
        shown = [self._resolve(scene)] if scene is not None else self.root.findall("library_visual_scenes/visual_scene")
        for element in shown:
            for node in element.findall("node"):
                self._node(node, T, 0)
        file = self.gathered.file()
        if not file.groups:
            raise SourceError("not_obj", self.where, "has no triangles")
        return file, {name: material(name, self.elements) for name in sorted({g.material for g in file.groups} - {""})}

    def _resolve(self, instance: Any) -> Any:
        return self.elements[instance.get("url").removeprefix("#")]

    def _visit(self) -> None:
        self.visits += 1
        if self.visits > MOST:
            raise SourceError("too_large", self.where, f"draws more than {MOST} things")

    def _node(self, node: Any, T: Floats, depth: int) -> None:
        if depth > DEPTH:
            raise SourceError("not_obj", self.where, "has nodes in a loop, or too deep")
        self._visit()
        for element in node:
            T = T @ _transform(element)
        for instance in node.findall("instance_geometry"):
            bound = {m.get("symbol"): m.get("target", "").removeprefix("#") for m in instance.iter("instance_material")}
            mesh = self._resolve(instance).find("mesh")
            for primitive in mesh if mesh is not None else ():
                if primitive.tag in KINDS:
                    self._visit()
                    self._primitive(primitive, T, bound)
        for child in node.findall("node"):
            self._node(child, T, depth + 1)
        for instance in node.findall("instance_node"):
            self._node(self._resolve(instance), T, depth + 1)

    def _primitive(self, primitive: Any, T: Floats, bound: dict[str, str]) -> None:
        inputs = {i.get("semantic"): i for i in reversed(primitive.findall("input"))}  # of several sets the first
        vertex, uv = inputs["VERTEX"], inputs.get("TEXCOORD")
        width = 1 + max(int(i.get("offset", 0)) for i in primitive.findall("input"))
        if not 0 < width <= MOST_INPUTS:
            raise SourceError("not_obj", self.where, f"has corners of {width} indices")
        corners = np.concatenate([*_triangles(primitive, width), np.zeros((0, 3, width), np.int64)])
        points = self._source(self.elements[vertex.get("source").removeprefix("#")].find("input[@semantic='POSITION']"), 3)
        uvs = self._source(uv, 2) if uv is not None else np.zeros((0, 2))
        faces = corners[:, :, int(vertex.get("offset", 0))]
        uv_faces = corners[:, :, int(uv.get("offset", 0))] if uv is not None else np.full_like(faces, -1)
        symbol = primitive.get("material", "")
        group = ObjGroup(primitive.get("name", ""), bound.get(symbol, symbol), faces, uv_faces)
        self.gathered.add(T, points, uvs, group)

    def _source(self, given: Any, width: int) -> Floats:
        """Return the values (N, width) of a source, parsed once."""
        name = given.get("source").removeprefix("#")
        if (name, width) not in self.sources:
            source = self.elements[name]
            accessor = source.find("technique_common/accessor")
            values = _numbers(self.elements[accessor.get("source").removeprefix("#")].text, np.float64, self.where)
            stride, offset, count = (int(accessor.get(k, d)) for k, d in (("stride", 1), ("offset", 0), ("count", 0)))
            if stride < width or offset < 0 or count < 0 or offset + count * stride > len(values):
                raise SourceError("not_obj", self.where, "has an accessor beyond its numbers")
            self.sources[name, width] = values[offset : offset + count * stride].reshape(count, stride)[:, :width]
        return self.sources[name, width]


def _numbers(text: str | None, kind: type, where: str) -> NDArray[Any]:
    """Return numbers separated by blanks. Raises SourceError for anything else."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            numbers: NDArray[Any] = np.fromstring((text or "").strip(), kind, sep=" ")
        except (ValueError, DeprecationWarning) as error:
            raise SourceError("bad_number", where, "has a list that holds something that is no number") from error
    if kind is np.float64 and not np.isfinite(numbers).all():
        raise SourceError("bad_number", where, "has a number that is not finite")
    return numbers


def _triangles(primitive: Any, width: int) -> Iterator[Ints]:
    """Yield triangles (T, 3, width) of indices into the inputs."""
    where = primitive.tag
    lists = [_numbers(p.text, np.int64, where) for p in primitive.findall("p")]
    lists = [p[: len(p) // width * width].reshape(-1, width) for p in lists]
    if primitive.tag == "triangles":
        yield from (p[: len(p) // 3 * 3].reshape(-1, 3, width) for p in lists)
    elif primitive.tag == "tristrips":
        for p in lists:
            k = np.arange(max(len(p) - 2, 0))
            yield p[np.stack([k, k + 1 + k % 2, k + 2 - k % 2], axis=1)]
    else:
        text = primitive.findtext("vcount")
        whole = np.concatenate([*lists, np.zeros((0, width), np.int64)])
        counts = _numbers(text, np.int64, where) if primitive.tag == "polylist" else np.array([len(p) for p in lists], np.int64)
        if (counts < 0).any() or counts.sum() > len(whole):
            raise ValueError(f"<{where}> names more corners than it has")
        yield whole[fans(counts)]


def _transform(element: Any) -> Floats:
    """Return what a child of a node adds to its transform (4, 4)."""
    T = np.eye(4)
    if element.tag not in {"matrix", "translate", "rotate", "scale"}:
        return T
    values = _numbers(element.text, np.float64, element.tag)
    if element.tag == "matrix":
        return values.reshape(4, 4)
    if element.tag == "translate":
        T[:3, 3] = values.reshape(3)
    elif element.tag == "scale":
        T[:3, :3] *= values.reshape(3)
    else:
        x, y, z = values[:3] / max(float(np.linalg.norm(values[:3])), 1e-12)
        c, s = np.cos(np.radians(values[3])), np.sin(np.radians(values[3]))
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        T[:3, :3] = np.eye(3) + s * cross + (1 - c) * cross @ cross
    return T


def material(name: str, elements: Elements) -> MeshMaterial:
    """Return the material of that id; what it does not say, or says wrong, is as in a material that says nothing."""
    plain = MeshMaterial()
    effect = _following(elements.get(name), "instance_effect", elements)
    profile = effect.find("profile_COMMON") if effect is not None else None
    shader = next((s for tag in SHADERS if profile is not None and (s := profile.find(f"technique/{tag}")) is not None), None)
    if shader is None:
        return plain
    color = _color(shader.find("diffuse"))
    texture = shader.find("diffuse/texture")
    path = _image(texture.get("texture", ""), profile, elements) if texture is not None else ""
    roughness = roughness_of(_number(shader.findtext("shininess/float"), 50.0))
    return MeshMaterial(linear(color[:3]) if color else plain.color, _opacity(shader), roughness, map=path)


def _following(element: Any, tag: str, elements: Elements) -> Any:
    """Return what the first `tag` in an element names by its url, or None."""
    reference = element.find(tag) if element is not None else None
    return None if reference is None else elements.get(reference.get("url", "").removeprefix("#"))


def _image(sampler: str, profile: Any, elements: Elements) -> str:
    """Return the path of a texture, "" where it leads nowhere.

    COLLADA 1.4: sampler2D/source names a surface, its init_from an image; 1.5: sampler2D/instance_image. Some files name
    the image at once.
    """
    params = {p.get("sid"): p for p in profile.iter("newparam")}
    name = sampler
    for tag in ("sampler2D/source", "surface/init_from"):
        text = params[name].findtext(tag) if name in params else None
        name = text.strip() if text else name
    image = _following(params[name].find("sampler2D"), "instance_image", elements) if name in params else elements.get(name)
    if image is None or image.tag != "image":
        return ""
    path = image.findtext("init_from/ref") or image.findtext("init_from") or ""
    return unquote(path.strip())


def _opacity(shader: Any) -> float:
    """Return the opacity: COLLADA's default, A_ONE, multiplies the colour's alpha; RGB_ZERO is transparent where it is white."""
    transparent = shader.find("transparent")
    amount = _number(shader.findtext("transparency/float"), 1.0)
    color = _color(transparent) if transparent is not None else None
    if color is None:
        return 1.0
    if transparent.get("opaque", "A_ONE") == "RGB_ZERO":
        return min(max(1.0 - amount * sum(color[:3]) / 3, 0.0), 1.0)
    # Exporters that mean opaque write alpha 0 or amount 0 as often as 1: nothing is made of glass that cannot be seen.
    return min(amount * color[3], 1.0) if amount * color[3] > 0 else 1.0


def _color(element: Any) -> tuple[float, float, float, float] | None:
    """Return the colour (r, g, b, a) in an element, each within [0, 1], or None."""
    words = (element.findtext("color") or "").split() if element is not None else []
    values = [_number(word, math.nan) for word in words]
    if len(values) not in {3, 4} or not all(map(math.isfinite, values)):
        return None
    r, g, b, a = (min(max(v, 0.0), 1.0) for v in (*values, 1.0)[:4])
    return r, g, b, a


def _number(text: str | None, otherwise: float) -> float:
    try:
        value = float(text or "")
    except ValueError:
        return otherwise
    return value if math.isfinite(value) else otherwise
