"""The mesh files and primitives that the shapes of a URDF name, each file read once."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

import numpy as np

from pipeline.arrays import Floats
from pipeline.sources.articulated.shape import Note
from pipeline.sources.articulated.urdf import Shape
from pipeline.sources.guarded import Folder
from pipeline.sources.meshes.collada_file import MAX_DAE, parse_dae
from pipeline.sources.meshes.mesh_solids import even_directions, hull
from pipeline.sources.meshes.obj_file import MAX_OBJ, MeshMaterial, ObjFile, ObjGroup, parse_obj
from pipeline.sources.meshes.scene_file import MAX_SCENE, parse_scene
from pipeline.sources.reasons import SourceError

PACKAGE = re.compile(r"^(?:package|model)://", re.IGNORECASE)
MAX_TOTAL = 1_500_000  # triangles of all files of an object together, counted once per use


class MeshFiles:
    """Files below `base` of a folder; what is missing goes to `notes`."""

    def __init__(self, folder: Folder, base: str, notes: list[Note]) -> None:
        self.folder, self.base, self.notes = folder, base, notes
        self.files: dict[str, ObjFile | None] = {}
        # By mesh file and name, where a file brings its own.
        self.materials: dict[str, dict[str, MeshMaterial]] = {}
        self.total = 0
        self._places: dict[str, str] = {}

    def place(self, mesh: str) -> str:
        """Return the path of a mesh from `base` on.

        package://name/rest is looked up as name/rest and as rest beside the URDF, then in the folders above it, as far up
        as the source goes. Raises SourceError `unsafe_path` for one that leads out of the source.
        """
        if not PACKAGE.match(mesh):
            return mesh
        if mesh not in self._places:
            full = PACKAGE.sub("", mesh).replace("\\", "/").lstrip("/")
            tails = (full, full.partition("/")[2] or full)
            ways = ("../" * up + tail for up in range(len(PurePosixPath(self.base).parts) + 1) for tail in tails)
            self._places[mesh] = next((way for way in ways if self.folder.has(way, self.base)), tails[1])
        return self._places[mesh]

    def geometry(self, shapes: Sequence[Shape], T: Floats) -> Iterator[tuple[Shape, ObjGroup, ObjFile, Floats]]:
        """Yield the groups of the shapes of a link at T (4, 4), with their shape, file and its vertices there.

        A mirrored scale turns the faces. Raises SourceError for a file that is broken, too large or outside the folder, before
        any of the shapes costs more than a look.
        """
        files = [self._of(shape) for shape in shapes]
        for shape, file in zip(shapes, files, strict=True):
            self.total += sum(len(g.faces) for g in file.groups) if file else 0
            if self.total > MAX_TOTAL:
                raise SourceError("too_large", shape.mesh, f"more than {MAX_TOTAL} triangles in all")
        for shape, file in zip(shapes, files, strict=True):
            if file is None:
                continue
            T_shape = T @ shape.T
            points = (file.vertices * shape.scale) @ T_shape[:3, :3].T + T_shape[:3, 3]
            groups = file.groups
            if np.prod(shape.scale) < 0:
                groups = tuple(replace(g, faces=g.faces[:, ::-1], uv_faces=g.uv_faces[:, ::-1]) for g in groups)
            yield from ((shape, group, file, points) for group in groups if len(group.faces))

    def _of(self, shape: Shape) -> ObjFile | None:
        """Return a shape's triangles: its mesh file, read once, a missing one noted; a primitive as one; or None."""
        path = shape.mesh
        if not path:
            return _primitive(*shape.primitive, shape.name) if shape.primitive[0] else None
        if path not in self.files:
            try:
                self.files[path] = self._load(path)
            except SourceError as error:
                if error.code != "missing_file":
                    raise
                self.notes.append(("model", "missing_mesh", f"{path}: {error.detail}"))
                self.files[path] = None
        return self.files[path]

    def _load(self, mesh: str) -> ObjFile:
        path = self.place(mesh)
        suffix = path.lower().rsplit(".", 1)[-1]
        if suffix == "obj":
            return parse_obj(self.folder.read(path, MAX_OBJ, self.base), path)
        if suffix in {"glb", "stl"}:
            file, self.materials[mesh] = parse_scene(self.folder.read(path, MAX_SCENE, self.base), suffix, path)
            return file
        if suffix == "dae":
            file, self.materials[mesh] = parse_dae(self.folder.read(path, MAX_DAE, self.base), path)
            return file
        self.folder.path(path, self.base)  # a path that leaves the folder is refused whatever it names
        raise SourceError("missing_file", path, f"is of a kind that is not read ({suffix[:10]})")


def _primitive(kind: str, values: tuple[float, ...], where: str) -> ObjFile:
    """Return the outward triangles of a URDF primitive centred at the origin, a cylinder along z."""
    if min(values) <= 0:
        raise SourceError("bad_number", where, f"a {kind} of size {values}")
    if kind == "box":
        points = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * values
    elif kind == "cylinder":
        turn = np.arange(24) * (2 * np.pi / 24)
        ring = np.stack([np.cos(turn), np.sin(turn)], axis=1) * values[0]
        points = np.concatenate([np.column_stack([ring, np.full(24, z)]) for z in (-values[1] / 2, values[1] / 2)])
    else:
        points = even_directions(64) * values[0]
    convex = hull(points)
    assert convex is not None
    vertices, faces, _ = convex
    return ObjFile(vertices, np.zeros((0, 2)), (ObjGroup("", "", faces, np.full_like(faces, -1)),), "")
