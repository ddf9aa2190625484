"""OBJ groups as visual meshes of an asset, with their materials and textures."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from pipeline.arrays import Floats
from pipeline.entities.asset import Material, Mesh
from pipeline.sources.guarded import DRIVE, Folder
from pipeline.sources.meshes.obj_file import MAX_MTL, MtlMaterial, ObjFile, ObjGroup, parse_mtl
from pipeline.sources.meshes.textures import MAX_FILE, prepare_texture
from pipeline.sources.reasons import SourceError

T = TypeVar("T")


@dataclass(slots=True)
class Palette:
    """The materials and textures of one asset, each once; `notes` are (reason, detail) of what could not be had."""

    folder: Folder
    texture_limit: int
    materials: list[Material] = field(default_factory=list)
    textures: dict[str, bytes] = field(default_factory=dict)
    notes: list[tuple[str, str]] = field(default_factory=list)
    _libraries: dict[str, dict[str, MtlMaterial]] = field(default_factory=dict)
    _images: dict[str, str | None] = field(default_factory=dict)
    _index: dict[Material, int] = field(default_factory=dict)

    def index(self, library: str, base: str, name: str) -> int:
        """Return the index of the material `name` of the MTL file `library` (relative to the folder `base`)."""
        return self.entry(self._library(library, base).get(name) or MtlMaterial(name or "plain"), base)

    def entry(self, entry: MtlMaterial, base: str) -> int:
        """Return the index of a material whose texture's path is relative to the folder `base`."""
        texture = self.image(entry.map, base) if entry.map else None
        color = (1.0, 1.0, 1.0) if texture else entry.diffuse
        return self.add(color, entry.opacity, texture, _roughness(entry.shininess), entry.metallic)

    def add(
        self, color: tuple[float, float, float], opacity: float, texture: str | None, roughness: float = 0.6, metallic: float = 0.0
    ) -> int:
        """Return the index of a material of sRGB `color`, made when it is new."""
        linear = (_linear(color[0]), _linear(color[1]), _linear(color[2]))
        return self._material_index(linear, opacity, texture, roughness, metallic)

    def _material_index(
        self, linear: tuple[float, float, float], opacity: float, texture: str | None, roughness: float, metallic: float = 0.0
    ) -> int:
        plain = Material("", linear, roughness, metallic, round(max(opacity, 0.05), 4), texture)
        if plain not in self._index:
            self._index[plain] = len(self.materials)
            self.materials.append(Material(f"material_{len(self.materials)}", linear, roughness, metallic, plain.opacity, texture))
        return self._index[plain]

    def own(self, color: tuple[float, float, float, float], roughness: float, image: bytes, where: str) -> int:
        """Return the index of a material that a mesh file brings along: linear `color` with opacity, the bytes of an image or none."""
        texture = self._noted(where, lambda: self._texture(image, where)) if image else None
        r, g, b = (1.0, 1.0, 1.0) if texture else color[:3]
        return self._material_index((round(r, 5), round(g, 5), round(b, 5)), color[3], texture, round(max(roughness, 0.2), 3))

    def image(self, path: str, base: str) -> str | None:
        """Return the name under which the image is kept, or None with a note where it cannot be had.

        A path that leaves the folder is no missing texture: it raises. A drive letter is somebody's own disk.
        """
        path = _without_drive(path)
        key = f"{base}/{path}"
        if key not in self._images:
            self._images[key] = self._noted(path, lambda: self._texture(self.folder.read(path, MAX_FILE, base), path))
        return self._images[key]

    def _noted(self, path: str, read: Callable[[], T]) -> T | None:
        """Return what `read` gives, or None with a note where it cannot be had."""
        try:
            return read()
        except SourceError as error:
            if error.code == "unsafe_path":
                raise
            self.notes.append(("missing_texture", f"{path}: {error.detail}"))
            return None

    def _texture(self, image: bytes, where: str) -> str:
        """Return the name under which an image is kept, each only once."""
        data, suffix = prepare_texture(image, where, self.texture_limit)
        known = next((name for name, blob in self.textures.items() if blob == data), None)
        if known:
            return known
        name = f"texture_{len(self.textures)}.{suffix}"
        self.textures[name] = data
        return name

    def _library(self, library: str, base: str) -> dict[str, MtlMaterial]:
        library = _without_drive(library)
        key = f"{base}/{library}"
        if key not in self._libraries:
            read = self._noted(library, lambda: parse_mtl(self.folder.read(library, MAX_MTL, base))) if library else None
            self._libraries[key] = read or {}
        return self._libraries[key]


def _without_drive(path: str) -> str:
    """Return the file's name of a path on somebody's own disk, any other path as it is."""
    return path.replace("\\", "/").rsplit("/", 1)[-1] if DRIVE.match(path) else path


def visual_mesh(group: ObjGroup, file: ObjFile, points: Floats, name: str, material: int, part: str = "") -> Mesh | None:
    """Return a group as a mesh; `points` (V, 3) are the file's vertices already in the object frame [m].

    A vertex is a (position, uv) pair. None for a group without a proper face.
    """
    faces, uv_faces = group.faces, group.uv_faces
    proper = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    faces, uv_faces = faces[proper], uv_faces[proper]
    if not len(faces):
        return None
    textured = len(file.uvs) > 0 and bool((uv_faces >= 0).all())
    count = len(file.uvs) if textured else 1
    pairs, index = np.unique(faces * count + uv_faces if textured else faces, return_inverse=True)
    vertices, corners = points[pairs // count].astype(np.float32), index.reshape(faces.shape).astype(np.int32)
    uv = np.clip(file.uvs[pairs % count], -1e4, 1e4).astype(np.float32) if textured else None
    return Mesh(name, vertices, corners, material, uv, part)


def _linear(value: float) -> float:
    """SRGB to linear (IEC 61966-2-1)."""
    return round(value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4, 5)


def _roughness(shininess: float) -> float:
    """Blinn-Phong exponent to roughness: alpha = sqrt(2 / (n + 2)), roughness its square root, within [0.2, 1]."""
    return round(min(1.0, max(0.2, math.sqrt(math.sqrt(2 / (max(shininess, 0.0) + 2))))), 3)
