"""The meshes that a scene shows, gathered as one file: each at its place, and all together within the limits of a file."""

import numpy as np

from pipeline.arrays import Floats
from pipeline.sources.meshes.obj_file import MAX_COORDINATE, MAX_FACES, MAX_GROUPS, MAX_UVS, MAX_VERTICES, ObjFile, ObjGroup
from pipeline.sources.reasons import SourceError


class MeshGatherer:
    """Takes meshes one by one; `where` is the file that errors name."""

    def __init__(self, where: str) -> None:
        self.where = where
        self.vertices: list[Floats] = [np.zeros((0, 3))]
        self.uvs: list[Floats] = [np.zeros((0, 2))]
        self.groups: list[ObjGroup] = []
        self.counts = np.zeros(3, np.int64)  # vertices, uvs, faces

    def add(self, T: Floats, points: Floats, uvs: Floats, group: ObjGroup) -> None:
        """Take the triangles of a group, which index its own `points` (V, 3) and `uvs` (U, 2), at T (4, 4) [m]; where T mirrors they are turned.

        Raises SourceError `too_large`, `not_obj` or `bad_number`.
        """
        start, start_uv, _ = self.counts.tolist()
        faces, uv_faces = group.faces, group.uv_faces
        self.counts += len(points), len(uvs), len(faces)
        if (self.counts > (MAX_VERTICES, MAX_UVS, MAX_FACES)).any() or len(self.groups) >= MAX_GROUPS:
            shown = "{} meshes with {} vertices, {} uvs and {} faces".format(len(self.groups) + 1, *self.counts)
            raise SourceError("too_large", self.where, f"shows {shown}")
        if len(faces) and (faces.min() < 0 or faces.max() >= len(points) or uv_faces.min() < -1 or uv_faces.max() >= len(uvs)):
            raise SourceError("not_obj", self.where, "indexes vertices that are not there")
        with np.errstate(invalid="ignore", over="ignore"):  # looked at in the next line
            points = points @ T[:3, :3].T + T[:3, 3]
        if not np.isfinite(points).all() or np.abs(points).max(initial=0) > MAX_COORDINATE or not np.isfinite(uvs).all():
            raise SourceError("bad_number", self.where, "has coordinates that are not finite, or absurd")
        if np.linalg.det(T[:3, :3]) < 0:
            faces, uv_faces = faces[:, ::-1], uv_faces[:, ::-1]
        self.vertices.append(points)
        self.uvs.append(uvs)
        self.groups.append(ObjGroup(group.name, group.material, faces + start, np.where(uv_faces < 0, -1, uv_faces + start_uv)))

    def file(self) -> ObjFile:
        """Return all that was taken, groups in that order."""
        return ObjFile(np.concatenate(self.vertices), np.concatenate(self.uvs), tuple(self.groups), "")
