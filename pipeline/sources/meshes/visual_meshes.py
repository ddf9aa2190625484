"""OBJ groups as visual meshes of an asset, with their materials and textures."""

import io
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from PIL import Image, UnidentifiedImageError

from pipeline.arrays import Floats
from pipeline.entities.asset import Material, Mesh
from pipeline.sources.guarded import DRIVE, Folder
from pipeline.sources.meshes.obj_file import MAX_MTL, MeshMaterial, ObjFile, ObjGroup, parse_mtl
from pipeline.sources.reasons import SourceError

MAX_FILE = 32 << 20  # bytes
MAX_PIXELS = 4096 * 4096
T = TypeVar("T")


@dataclass(slots=True)
class Palette:
    """The materials and textures of one asset, each once; `notes` are (reason, detail) of what could not be had."""

    folder: Folder
    texture_limit: int
    materials: list[Material] = field(default_factory=list)
    textures: dict[str, bytes] = field(default_factory=dict)
    notes: list[tuple[str, str]] = field(default_factory=list)
    _libraries: dict[str, dict[str, MeshMaterial]] = field(default_factory=dict)
    _images: dict[str, str | None] = field(default_factory=dict)
    _index: dict[Material, int] = field(default_factory=dict)

    def named(self, library: str, base: str, name: str) -> int:
        """Return the index of the material `name` of the MTL file `library` (relative to the folder `base`)."""
        return self.index(self._library(library, base).get(name, MeshMaterial()), base)

    def index(self, material: MeshMaterial, base: str, where: str = "") -> int:
        """Return the index of a material, made when it is new: its image's path is relative to the folder `base`, an image that it brings is of `where`."""
        texture = self.image(material.map, base) if material.map else None
        if material.image:
            texture = self._noted(where, lambda: self._texture(material.image, where))
        color = (1.0, 1.0, 1.0) if texture else material.color
        plain = Material("", color, material.roughness, material.metallic, round(max(material.opacity, 0.05), 4), texture)
        if plain not in self._index:
            self._index[plain] = len(self.materials)
            self.materials.append(replace(plain, name=f"material_{len(self.materials)}"))
        return self._index[plain]

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

    def _library(self, library: str, base: str) -> dict[str, MeshMaterial]:
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


def prepare_texture(data: bytes, where: str, limit: int) -> tuple[bytes, str]:
    """Return (bytes, suffix) of an image of at most `limit` pixels a side.

    A small PNG or JPEG stays as it is; anything else is re-encoded as PNG with fixed settings, so the bytes depend on
    the image alone. Raises SourceError `missing_texture` for what is no such image.
    """
    try:
        with Image.open(io.BytesIO(data), formats=("PNG", "JPEG")) as image:
            if image.width * image.height > MAX_PIXELS:
                raise SourceError("missing_texture", where, f"{image.width} x {image.height} pixels")
            if max(image.size) <= limit:
                suffix = "png" if image.format == "PNG" else "jpg"
                image.load()  # a truncated image fails here, not in a viewer
                return data, suffix
            mode = "RGBA" if "A" in image.getbands() or "transparency" in image.info else "RGB"
            small = image.convert(mode)
            small.thumbnail((limit, limit), Image.Resampling.LANCZOS)
            out = io.BytesIO()
            small.save(out, "PNG", optimize=False, compress_level=6)
            return out.getvalue(), "png"
    except (UnidentifiedImageError, OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        told = str(error).split(" <")[0]  # without the buffer's address, which is another in every run
        raise SourceError("missing_texture", where, f"is no readable PNG or JPEG ({told[:60]})") from error
