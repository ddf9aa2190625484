"""The files that MJCF and URDF share: a model's meshes as OBJ with their materials, its textures beside them."""

import shutil
from collections.abc import Sequence
from pathlib import Path
from xml.etree.ElementTree import Element, indent, tostring

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from pipeline.arrays import Floats
from pipeline.export.model import Hull, Material, Model, Surface
from pipeline.rendering import palette

MATERIALS = "materials.mtl"


def write_meshes(model: Model, folder: Path) -> None:
    """Write all surfaces and hulls of a model into `folder`, which it makes."""
    folder.mkdir(parents=True)
    looks = model.materials()
    for texture in {m.texture for m in looks if m.texture}:
        shutil.copyfile(texture, folder / texture.name)
    if looks:
        (folder / MATERIALS).write_text("".join(map(_mtl, looks)), encoding="ascii")
    for surface in model.surfaces():
        (folder / f"{surface.name}.obj").write_text(surface_obj(surface), encoding="ascii")
    for body in model.bodies:
        for hull in body.hulls:
            (folder / f"{hull.name}.obj").write_text(hull_obj(hull), encoding="ascii")


def surface_obj(surface: Surface) -> str:
    """Return a surface as a Wavefront OBJ; nine digits are all that a float32 has."""
    lines = [f"mtllib {MATERIALS}", f"usemtl {surface.material.name}", *_rows("v", surface.points), *_rows("vn", surface.normals)]
    pattern = "f {0}//{0} {1}//{1} {2}//{2}"
    if surface.uv is not None:
        lines += _rows("vt", surface.uv)
        pattern = "f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}"
    return "\n".join([*lines, *(pattern.format(*face) for face in (surface.faces + 1).tolist()), ""])


def hull_obj(hull: Hull) -> str:
    """Return a hull as a Wavefront OBJ."""
    return "\n".join([*_rows("v", hull.points), *("f {} {} {}".format(*face) for face in (hull.faces + 1).tolist()), ""])


def display(color: Sequence[float]) -> list[float]:
    """Convert a linear colour to sRGB, which MJCF, URDF and OBJ mean."""
    return palette.display(np.clip(np.asarray(color, np.float64), 0, 1)).round(5).tolist()  # type: ignore[no-any-return]


def numbers(values: NDArray[np.floating] | Sequence[float]) -> str:
    """Write numbers for XML, twelve digits each."""
    return " ".join(f"{value + 0.0:.12g}" for value in np.asarray(values, np.float64).ravel().tolist())


def position(T: Floats) -> str:
    """Write the translation of a transform."""
    return numbers(np.where(np.abs(T[:3, 3]) < 1e-12, 0.0, T[:3, 3]))


def quaternion(T: Floats) -> Floats:
    """Return the rotation of a transform as (w, x, y, z), w >= 0."""
    return Rotation.from_matrix(T[:3, :3]).as_quat(canonical=True, scalar_first=True)  # type: ignore[no-any-return]


def xml_bytes(root: Element) -> bytes:
    """Return the indented text of an XML file."""
    indent(root)
    return tostring(root) + b"\n"


def _mtl(material: Material) -> str:
    color = "{} {} {}".format(*display(material.color))
    texture = f"map_Kd {material.texture.name}\n" if material.texture else ""
    return f"newmtl {material.name}\nKd {color}\nd {material.opacity:g}\n{texture}\n"


def _rows(key: str, values: NDArray[np.float32]) -> list[str]:
    pattern = " ".join([key, *["%.9g"] * values.shape[1]])
    return [pattern % tuple(row) for row in (values + np.float32(0)).tolist()]
