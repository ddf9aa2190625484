"""Solids as Wavefront OBJ and MTL text, in the y-up frame of 3D-FRONT and of PartNet-Mobility's meshes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.finishes import Finish
from pipeline.corpus.furniture.shape import Piece
from pipeline.corpus.furniture.solids import Solid
from pipeline.corpus.furniture.texture import Atlas, normals, srgb


def mesh_frame(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn points (..., 3) of our object frame (z up, front -y) to the y-up frame with the front at +z."""
    return np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1)


@dataclass(frozen=True, slots=True)
class Group:
    """The pieces of one OBJ group, all of one material `material`."""

    name: str
    material: str
    pieces: tuple[Piece, ...]


@dataclass(frozen=True, slots=True)
class Text:
    """An OBJ in parts: positions (V, 3) in the mesh frame, and the lines that follow them whatever their scale."""

    header: str
    positions: NDArray[np.float64]
    rest: str

    def obj(self, scale: float = 1.0, offset: NDArray[np.float64] | None = None) -> bytes:
        """Return the file's bytes with positions (p + offset) * scale, five decimals."""
        points = (self.positions + (0.0 if offset is None else offset)) * scale
        body = ("v %.5f %.5f %.5f\n" * len(points)) % tuple(np.round(points, 5).ravel().tolist())
        return (self.header + body.replace("-0.00000", "0.00000") + self.rest).encode()


def text(groups: Sequence[Group], library: str, sheet: Atlas | None = None) -> Text:
    """Return groups of solids as OBJ text: triangles and quads as they are, larger faces in fans, flat normals."""
    positions: list[NDArray[np.float64]] = []
    uv_lines: list[str] = []
    normal_lines: list[str] = []
    known: dict[tuple[float, ...], int] = {}
    face_lines: list[str] = []
    base = uv_base = 1
    for group in groups:
        face_lines += [f"g {group.name}\n", f"usemtl {group.material}\n"]
        for piece in group.pieces:
            solid = piece.solid
            positions.append(mesh_frame(solid.vertices))
            flat = np.round(mesh_frame(normals(solid)), 3) + 0.0
            uv_of: dict[int, int] = {}
            uv = projection = None
            if sheet is not None:
                uv, projection = sheet.uv(solid, piece.finish)
            for k, face in enumerate(solid.faces):
                direction = tuple(flat[k].tolist())
                if direction not in known:
                    known[direction] = len(known) + 1
                    normal_lines.append("vn {:g} {:g} {:g}\n".format(*direction))
                n = known[direction]
                if uv is None or projection is None:
                    corners = [f"{base + v}//{n}" for v in face]
                else:
                    offset = int(projection[k]) * len(solid.vertices)
                    corners = []
                    for v in face:
                        row = offset + v
                        if row not in uv_of:
                            uv_of[row] = uv_base + len(uv_of)
                            uv_lines.append(f"vt {uv[row, 0]:.4f} {uv[row, 1]:.4f}\n")
                        corners.append(f"{base + v}/{uv_of[row]}/{n}")
                if len(corners) <= 4:
                    face_lines.append("f " + " ".join(corners) + "\n")
                else:
                    face_lines += [f"f {corners[0]} {corners[i]} {corners[i + 1]}\n" for i in range(1, len(corners) - 1)]
            base += len(solid.vertices)
            uv_base += len(uv_of)
    header = f"mtllib {library}\n"
    return Text(header, np.concatenate(positions), "".join(uv_lines) + "".join(normal_lines) + "".join(face_lines))


def bare(name: str, solids: Sequence[Solid]) -> Text:
    """Return convex solids as OBJ text without normals or materials: what a link collides by."""
    lines, base = [f"g {name}\n"], 1
    for solid in solids:
        lines += [f"f {a + base} {b + base} {c + base}\n" for a, b, c in solid.triangles().tolist()]
        base += len(solid.vertices)
    return Text("", np.concatenate([mesh_frame(s.vertices) for s in solids]), "".join(lines))


def material_name(finish: Finish, number: int) -> str:
    """Return a material's name in an MTL file."""
    return f"{finish.name}_{number}"


def mtl(finishes: Iterable[tuple[str, Finish]], texture: str | None = None) -> bytes:
    """Return an MTL file; Kd is sRGB as in the real sets, Ns the Blinn-Phong exponent 2 / roughness^4 - 2."""
    lines = []
    for name, finish in finishes:
        shininess = min(900.0, max(1.0, 2 / finish.roughness**4 - 2))
        lines += [f"newmtl {name}", "illum 2", "Ka 0 0 0", "Kd {:g} {:g} {:g}".format(*srgb(finish.color))]
        lines += [
            f"Ks {0.5 if finish.metallic else 0.1:g} {0.5 if finish.metallic else 0.1:g} {0.5 if finish.metallic else 0.1:g}",
            f"Ns {shininess:.1f}",
            f"d {finish.opacity:g}",
        ]
        if texture and finish.opacity == 1.0:
            lines.append(f"map_Kd {texture}")
        lines.append("")
    return "\n".join(lines).encode()
