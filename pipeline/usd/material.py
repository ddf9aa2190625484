"""Materials: UsdPreviewSurface and physics in one prim, because some engines read only the all-purpose binding."""

import functools
from collections.abc import Sequence

from pxr import Gf, Sdf

from pipeline.entities.asset import Material
from pipeline.usd.layer import apply, attribute, identifiers, label, prim, relationship
from pipeline.usd.prim_templates import group, instantiate, template_of

FRICTION = (0.7, 0.6)  # static, dynamic: dry wood, painted board
SLIPPERY = (0.35, 0.3)  # metal, glass, glazed tiles


def convert_materials(parent: Sdf.PrimSpec, materials: Sequence[Material]) -> list[Sdf.Path]:
    """Write all materials in a scope "materials" and return their paths in order."""
    scope = prim(parent, "materials", "Scope")
    names = identifiers(m.name for m in materials)
    return [convert_material(scope, name, material) for name, material in zip(names, materials, strict=True)]


def convert_material(scope: Sdf.PrimSpec, name: str, material: Material) -> Sdf.Path:
    """Write one material: surface, texture if it has one, friction."""
    spec = prim(scope, name, "Material", ["PhysicsMaterialAPI"])
    label(spec, "material", [material.name])
    surface = _shader(spec, "surface", "UsdPreviewSurface")
    diffuse = attribute(surface, "inputs:diffuseColor", "color3f", Gf.Vec3f(*material.base_color))
    attribute(surface, "inputs:roughness", "float", material.roughness)
    attribute(surface, "inputs:metallic", "float", material.metallic)
    if material.opacity < 1:
        attribute(surface, "inputs:opacity", "float", material.opacity)
    if material.texture is not None:
        diffuse.connectionPathList.explicitItems = [_texture(spec, material).path.AppendProperty("outputs:rgb")]
    attribute(surface, "outputs:surface", "token")
    out = attribute(spec, "outputs:surface", "token")
    out.connectionPathList.explicitItems = [surface.path.AppendProperty("outputs:surface")]
    smooth = material.metallic > 0.5 or material.roughness < 0.3
    static, dynamic = SLIPPERY if smooth else FRICTION
    attribute(spec, "physics:staticFriction", "float", static)
    attribute(spec, "physics:dynamicFriction", "float", dynamic)
    return spec.path


def _texture(spec: Sdf.PrimSpec, material: Material) -> Sdf.PrimSpec:
    reader = _shader(spec, "st", "UsdPrimvarReader_float2")
    attribute(reader, "inputs:varname", "string", "st")
    attribute(reader, "outputs:result", "float2")
    texture = _shader(spec, "diffuse", "UsdUVTexture")
    attribute(texture, "inputs:file", "asset", Sdf.AssetPath(f"./{material.texture}"))
    for name, value in (("sourceColorSpace", "sRGB"), ("wrapS", "repeat"), ("wrapT", "repeat")):
        attribute(texture, f"inputs:{name}", "token", value)
    st = attribute(texture, "inputs:st", "float2")
    st.connectionPathList.explicitItems = [reader.path.AppendProperty("outputs:result")]
    attribute(texture, "outputs:rgb", "float3")
    return texture


def _shader(parent: Sdf.PrimSpec, name: str, kind: str) -> Sdf.PrimSpec:
    spec = prim(parent, name, "Shader")
    attribute(spec, "info:id", "token", kind, uniform=True)
    return spec


class Palette:
    """The materials that a home's own parts use, in the order in which they are asked for, in a scope of their own at `path`."""

    def __init__(self, path: str) -> None:
        self._path = path
        self._used: dict[str, Material] = {}

    def path(self, material: Material) -> str:
        """Return the prim of a material."""
        self._used.setdefault(material.name, material)
        return f"{self._path}/{material.name}"

    def paths(self, materials: Sequence[Material]) -> list[str]:
        """Return the prims of several materials."""
        return [self.path(m) for m in materials]

    def text(self) -> str:
        """Return the scope with what has been asked for so far."""
        return instantiate(group(schema="Scope"), self._path, "".join(instantiate(_material(m), self.path(m)) for m in self._used.values()))


@functools.lru_cache(maxsize=256)
def _material(material: Material) -> str:
    """Return the template of a material."""
    return template_of(lambda layer: convert_material(layer, "Template", material))


def bind(spec: Sdf.PrimSpec, material: Sdf.Path) -> None:
    """Bind a material for all purposes, rendering and physics."""
    apply(spec, ["MaterialBindingAPI"])
    relationship(spec, "material:binding", [material])
