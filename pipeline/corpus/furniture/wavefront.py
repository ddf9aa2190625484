"""Solids as Wavefront OBJ and MTL text, in the y-up frame of 3D-FRONT and of PartNet-Mobility's meshes."""

import functools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.finishes import Finish
from pipeline.corpus.furniture.shape import Piece, Pieces
from pipeline.corpus.furniture.solids import Face, Solid, Topology, merge_solids, normals, topology
from pipeline.corpus.furniture.texture import Atlas
from pipeline.rendering.palette import display


def mesh_frame(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn points (..., 3) of our object frame (z up, front -y) to the y-up frame with the front at +z."""
    return np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1)


@dataclass(frozen=True, slots=True)
class Group:
    """The pieces of one OBJ group, all of one finish, which the material library calls `material`."""

    name: str
    material: str
    finish: Finish
    pieces: Pieces


def group_by_finish(pieces: Iterable[Piece], name: str) -> list[Group]:
    """Return pieces in groups, one for each finish; `name` of a group, with its number where there is a field for it."""
    members: dict[Finish, list[Piece]] = {}
    for piece in pieces:
        members.setdefault(piece.finish, []).append(piece)
    return [Group(name.format(k + 1), f"{f.name}_{k}", f, tuple(parts)) for k, (f, parts) in enumerate(members.items())]


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


def text(groups: Sequence[Group], library: str, sheet: Atlas) -> Text:
    """Return groups of solids as OBJ text: triangles and quads as they are, larger faces in fans, flat normals."""
    pieces = [piece for group in groups for piece in group.pieces]
    vertices, shared = merge_solids([piece.solid for piece in pieces])
    normal = normals(vertices, shared)
    directions = np.round(mesh_frame(normal), 3) + 0.0
    code = np.round((directions + 1) * 1000).astype(np.int64) @ np.array([4_000_000, 2001, 1])
    _, distinct, index = np.unique(code, return_index=True, return_inverse=True)
    known = directions[distinct]
    side = sides_of(normal, shared)
    _, first, place = np.unique(3 * shared.corners + side, return_index=True, return_inverse=True)
    uv = sheet.uv(pieces, vertices, shared, side)[first]
    table = np.stack([shared.corners, place, np.repeat(index, shared.lengths)], axis=1) + 1
    lines = ["vt %.4f %.4f\n" * len(uv) % tuple(uv.ravel().tolist()), "vn %g %g %g\n" * len(known) % tuple(known.ravel().tolist())]
    start = 0
    for group in groups:
        lines.append(f"g {group.name}\nusemtl {group.material}\n")
        rows: tuple[list[NDArray[np.int64]], list[NDArray[np.int64]]] = ([], [])
        for piece in group.pieces:
            for chunks, faces in zip(rows, faces_of(piece.solid.faces), strict=True):
                chunks.append(faces.ravel() + start)
            start += len(topology(piece.solid.faces).corners)
        for count, parts in zip((3, 4), rows, strict=True):
            wanted = table[np.concatenate(parts)]
            lines.append(("f" + count * " %d/%d/%d" + "\n") * (len(wanted) // count) % tuple(wanted.ravel().tolist()))
    return Text(f"mtllib {library}\n", mesh_frame(vertices), "".join(lines))


def sides_of(normal: NDArray[np.float64], faces: Topology) -> NDArray[np.int64]:
    """Return the axis (C,) along which each corner's face, of that `normal` (F, 3), looks most."""
    return np.repeat(np.argmax(np.abs(normal), axis=1), faces.lengths)


@functools.lru_cache(maxsize=8192)
def faces_of(faces: tuple[Face, ...]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return rows of a solid's list of corners: its triangles (T, 3), larger faces cut into fans, and its quads (Q, 4)."""
    tris, quads, start = [], [], 0
    for face in faces:
        if len(face) == 4:
            quads.append(range(start, start + 4))
        else:
            tris += [(start, start + i, start + i + 1) for i in range(1, len(face) - 1)]
        start += len(face)
    return np.array(tris, np.int64).reshape(-1, 3), np.array(quads, np.int64).reshape(-1, 4)


def bare(name: str, solids: Sequence[Solid]) -> Text:
    """Return convex solids as OBJ text without normals or materials: what a link collides by."""
    lines, base = [f"g {name}\n"], 1
    for solid in solids:
        lines += [f"f {a + base} {b + base} {c + base}\n" for a, b, c in solid.triangles().tolist()]
        base += len(solid.vertices)
    return Text("", np.concatenate([mesh_frame(s.vertices) for s in solids]), "".join(lines))


def mtl(groups: Iterable[Group], texture: str) -> bytes:
    """Return an MTL file; Kd is sRGB as in the real sets, Ns the Blinn-Phong exponent 2 / roughness^4 - 2.

    Metals say so by Pm, of the usual extension of MTL for physically based surfaces.
    """
    lines = []
    for group in groups:
        finish = group.finish
        gloss = 0.5 if finish.metallic else 0.1
        color = np.round(display(np.array(finish.color)), 4)
        lines += [f"newmtl {group.material}", "illum 2", "Ka 0 0 0", "Kd {:g} {:g} {:g}".format(*color)]
        shininess = min(900.0, max(1.0, 2 / finish.roughness**4 - 2))
        lines += [f"Ks {gloss:g} {gloss:g} {gloss:g}", f"Ns {shininess:.1f}", f"d {finish.opacity:g}"]
        if finish.metallic:
            lines.append(f"Pm {finish.metallic:g}")
        if finish.opacity == 1.0:
            lines.append(f"map_Kd {texture}")
        lines.append("")
    return "\n".join(lines).encode()
