"""glTF (.glb) and STL files as meshes, for URDFs whose meshes are of those kinds: trimesh reads them, what it makes is checked here.

OBJ and COLLADA have readers of our own, for trimesh reads what is broken as something else and says nothing. Of an OBJ it takes negative indices from
the end of the file and index 0 for the first vertex, passes over uvs that are not there, and knows no tabs or indents; a face of millions of corners takes 570 MiB. Of a COLLADA
file (by pycollada) it ignores unit, axis that is up, `transparency` and references that lead nowhere, and takes seven times the time and memory.
"""

import io
from typing import Any

import numpy as np

from pipeline.arrays import Floats
from pipeline.sources.meshes.gathering import MeshGatherer
from pipeline.sources.meshes.obj_file import MeshMaterial, ObjFile, ObjGroup
from pipeline.sources.meshes.visual_meshes import MAX_PIXELS
from pipeline.sources.reasons import SourceError

MAX_SCENE = 64 << 20  # bytes
COMPRESSED = (b"KHR_draco_mesh_compression", b"EXT_meshopt_compression")


def parse_scene(data: bytes, suffix: str, where: str) -> tuple[ObjFile, dict[str, MeshMaterial]]:
    """Return the triangles of a "glb" or "stl" file, a group per mesh that its scene shows, and its materials by name.

    Raises SourceError `not_obj`, `bad_number` or `too_large`, naming `where`.
    """
    import trimesh  # half a second that most objects do without

    if any(name in data for name in COMPRESSED):
        raise SourceError("not_obj", where, "is compressed")
    if suffix == "stl" and data[:5] == b"solid" and b"facet" in data[:1000] and b"endsolid" not in data[-200:]:
        raise SourceError("not_obj", where, "is a truncated STL file")  # whose whole facets would be read
    try:
        scene = trimesh.load_scene(io.BytesIO(data), file_type=suffix, process=False)
        shown = [(np.asarray(T, np.float64), scene.geometry[name]) for T, name in map(scene.graph.get, scene.graph.nodes_geometry)]
        return _merge_meshes(shown, where)
    except (MemoryError, SourceError):
        raise
    except Exception as error:  # trimesh promises no kind of error for what is broken
        raise SourceError("not_obj", where, f"cannot be read ({type(error).__name__}: {str(error)[:60]})") from error


def _merge_meshes(shown: list[tuple[Floats, Any]], where: str) -> tuple[ObjFile, dict[str, MeshMaterial]]:
    """Return meshes (T (4, 4), trimesh) as one file, and its materials by name."""
    gathered = MeshGatherer(where)
    materials: dict[str, MeshMaterial] = {}
    names: dict[int, str] = {}
    for T, mesh in shown:
        points, faces = np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int64)
        uv, material = getattr(mesh.visual, "uv", None), getattr(mesh.visual, "material", None)
        uv = np.zeros((0, 2)) if uv is None or len(uv) != len(points) else np.asarray(uv, np.float64)[:, :2]
        name = names.setdefault(id(material), str(len(names))) if hasattr(material, "baseColorFactor") else ""
        gathered.add(T, points, uv, ObjGroup("", name, faces, faces if len(uv) else np.full_like(faces, -1)))
        if name and name not in materials:
            materials[name] = _material(material)
    if not gathered.counts[2]:
        raise SourceError("not_obj", where, "has no triangles")
    return gathered.file(), materials


def _material(material: Any) -> MeshMaterial:
    color = np.ones(4) if material.baseColorFactor is None else np.asarray(material.baseColorFactor, np.float64) / 255
    r, g, b, a = np.clip(np.nan_to_num(color, nan=0.8), 0, 1).tolist()
    rough = 1.0 if material.roughnessFactor is None else float(material.roughnessFactor)
    rough = round(min(max(rough, 0.2), 1.0), 3) if np.isfinite(rough) else 0.6
    image, out = material.baseColorTexture, io.BytesIO()
    if image is not None and image.width * image.height <= MAX_PIXELS:
        image.convert("RGBA" if "A" in image.getbands() else "RGB").save(out, "PNG", optimize=False, compress_level=6)
    opacity = a if material.alphaMode == "BLEND" else 1.0
    return MeshMaterial((round(r, 5), round(g, 5), round(b, 5)), opacity, rough, image=out.getvalue())
