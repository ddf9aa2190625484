"""Wavefront OBJ and MTL files, as 3D-FUTURE and PartNet-Mobility use them, read strictly and fast.

Handled: triangles, quads and larger polygons (fanned), indices of every form (v, v/t, v//n, v/t/n), negative ones,
doubled blanks, indents, comments, colours behind vertices, groups and materials. Left out: normals, curves, lines and points.
"""

import math
import re
from array import array
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.sources.reasons import SourceError

Color = tuple[float, float, float]
BOM = b"\xef\xbb\xbf"
MAX_OBJ = 64 << 20  # bytes
MAX_MTL = 4 << 20
MAX_CORNERS = 3_000_000  # face corners of one file
MAX_VERTICES = 500_000
MAX_UVS = 1_000_000
MAX_FACES = 1_000_000
MAX_GROUPS = 2048
MAX_MATERIALS, MAX_LINES = 4096, 40_000  # of one file of materials; later ones are not read
MAX_COORDINATE = 1e5  # a mesh that reaches further is nonsense in any unit


@dataclass(frozen=True, slots=True)
class ObjGroup:
    """The faces of one group and material: `faces` (F, 3) index the file's vertices, `uv_faces` (F, 3) its uvs (-1: none)."""

    name: str
    material: str
    faces: Ints
    uv_faces: Ints


@dataclass(frozen=True, slots=True)
class ObjFile:
    """`vertices` (V, 3) and `uvs` (T, 2) in file units; groups in file order; the mtllib's name or ""."""

    vertices: Floats
    uvs: Floats
    groups: tuple[ObjGroup, ...]
    library: str


def linear(color: Sequence[float]) -> Color:
    """Return an sRGB colour in linear light (IEC 61966-2-1)."""
    r, g, b = (round(v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4, 5) for v in color)
    return r, g, b


def roughness_of(shininess: float) -> float:
    """Blinn-Phong exponent to roughness: alpha = sqrt(2 / (n + 2)), roughness its square root, within [0.2, 1]."""
    return round(min(1.0, max(0.2, math.sqrt(math.sqrt(2 / (max(shininess, 0.0) + 2))))), 3)


GREY, SATIN = linear((0.8, 0.8, 0.8)), roughness_of(50.0)  # of what says nothing


@dataclass(frozen=True, slots=True)
class MeshMaterial:
    """What we use of a file's material: linear colour, opacity, roughness, metalness, and the colour's image: its path as written, or its bytes."""

    color: Color = GREY
    opacity: float = 1.0
    roughness: float = SATIN
    metallic: float = 0.0
    map: str = ""
    image: bytes = b""


def parse_obj(data: bytes, where: str) -> ObjFile:
    """Parse an OBJ file. Raises SourceError `not_obj` or `too_large`, naming `where`."""
    data = data.removeprefix(BOM)
    if not data.strip():
        raise SourceError("not_obj", where, "is empty")
    if b"\x00" in data[:4096] or data[:2] == b"\x1f\x8b" or data.lstrip()[:1] == b"<":
        raise SourceError("not_obj", where, "is no text of an OBJ file")
    text = b"\n" + _plain(data)
    counts = text.count(b"\nv "), text.count(b"\nf "), text.count(b"\nvt")
    if counts[0] > MAX_VERTICES or counts[1] > MAX_FACES or counts[2] > MAX_UVS:  # before lines without end take memory
        raise SourceError("too_large", where, f"has {counts[0]} vertices, {counts[1]} faces and {counts[2]} uvs")
    v_lines, vt_lines, blocks, library = _read_lines(text, where)
    vertices = _numbers(v_lines, 3, where)
    uvs = _numbers(vt_lines, 2, where) if vt_lines else np.zeros((0, 2))
    if len(vertices) and np.abs(vertices).max() > MAX_COORDINATE:
        raise SourceError("bad_number", where, "has coordinates beyond 100,000")
    groups = tuple(_group(*key, block, len(vertices), len(uvs), where) for key, block in blocks.items())
    if not sum(len(g.faces) for g in groups):
        raise SourceError("not_obj", where, "has no faces")
    return ObjFile(vertices, uvs, groups, library)


@dataclass(frozen=True, slots=True)
class _Block:
    """The faces of a group and material as read: how many corners each has, and vertex and uv of every corner, one after the other."""

    sizes: "array[int]" = field(default_factory=lambda: array("q"))
    corners: "array[int]" = field(default_factory=lambda: array("q"))


def _read_lines(data: bytes, where: str) -> tuple[list[bytes], list[bytes], dict[tuple[str, str], _Block], str]:
    """Return the lines of vertices, of uvs, the faces by (group, material), and the mtllib's name. Raises SourceError `too_large` beyond the limits of groups and corners."""
    v_lines: list[bytes] = []
    vt_lines: list[bytes] = []
    blocks: dict[tuple[str, str], _Block] = {}
    group, material, library = "", "", ""
    for line in data.split(b"\n"):
        head = line[:2]
        if head == b"v ":
            v_lines.append(line)
        elif head == b"f ":
            block = blocks.setdefault((group, material), _Block())
            if len(blocks) > MAX_GROUPS:
                raise SourceError("too_large", where, f"more than {MAX_GROUPS} groups")
            words = line.split()[1:]
            if len(block.corners) // 2 + len(words) > MAX_CORNERS:
                raise SourceError("too_large", where, f"more than {MAX_CORNERS} face corners in one group")
            block.sizes.append(len(words))
            try:
                for word in words:
                    block.corners.extend(_corner(word, len(v_lines), len(vt_lines)))
            except (ValueError, OverflowError) as error:
                raise SourceError("not_obj", where, "has a face index that is no number") from error
        elif head == b"vt":
            vt_lines.append(line)
        elif head in {b"g ", b"o "}:
            group = _name(line)
        elif line.startswith(b"usemtl"):
            material = _name(line)
        elif line.startswith(b"mtllib"):
            library = _name(line)
    return v_lines, vt_lines, blocks, library


def _corner(word: bytes, vertices: int, uvs: int) -> tuple[int, int]:
    """Return vertex and uv of a corner "v", "v/t", "v//n" or "v/t/n" from 0 on, -1 for none; negative ones count back from the last read so far."""
    parts = word.replace(b"//", b"/0/").split(b"/")
    v, t = int(parts[0]), int(parts[1]) if len(parts) > 1 else 0
    return v - 1 if v > 0 else vertices + v if v else -1, t - 1 if t > 0 else uvs + t if t else -1


def _plain(data: bytes) -> bytes:
    """Return the text with joined lines, plain line ends, no tabs, no indents, no comments behind vertices and faces."""
    data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n").replace(b"\t", b" ").replace(b"\\\n", b" ")
    if b"\n " in data or data[:1] == b" ":
        data = re.sub(rb"(?m)^ +", b"", data)
    return re.sub(rb"(?m)^((?:v|vt|f) [^#\n]*)#.*", rb"\1", data) if b" #" in data else data


def parse_mtl(data: bytes) -> dict[str, MeshMaterial]:
    """Parse an MTL file; a line that makes no sense is passed over, for a wrong colour is no reason to lose a model.

    Tf and Ke are ignored: 3D-FUTURE's are wrong.
    """
    materials: dict[str, MeshMaterial] = {}
    name: str | None = None
    for raw in data.removeprefix(BOM).replace(b"\r", b"\n").split(b"\n", MAX_LINES)[:MAX_LINES]:
        words = raw.decode("utf-8", "replace").strip().split(None, 1)
        if len(words) < 2:
            continue
        key, rest = words[0], words[1].strip()
        if key == "newmtl":
            if len(materials) >= MAX_MATERIALS:
                break
            name = rest
            materials.setdefault(name, MeshMaterial())
        elif name is not None:
            materials[name] = _set(materials[name], key, rest)
    return materials


def _set(entry: MeshMaterial, key: str, rest: str) -> MeshMaterial:
    if key == "map_Kd":  # without options like `-s 1 1 1` before the file's name, which may contain blanks
        return replace(entry, map=re.sub(r"^(-[a-zA-Z]+\s+((-?[\d.]+|on|off)\s+)*)+", "", rest).strip())
    values = _finite(rest.split()[: 3 if key == "Kd" else 1])
    shares = [min(max(v, 0.0), 1.0) for v in values]
    if key == "Kd" and len(shares) == 3:
        return replace(entry, color=linear(shares))
    if key == "Ns" and values:
        return replace(entry, roughness=roughness_of(values[0]))
    if key == "Pm" and shares:
        return replace(entry, metallic=shares[0])
    return replace(entry, opacity=shares[0] if key == "d" else 1 - shares[0]) if key in {"d", "Tr"} and shares else entry


def _finite(words: Sequence[str]) -> list[float]:
    try:
        values = [float(w) for w in words]
    except ValueError:
        return []
    return values if np.isfinite(values).all() else []


def _name(line: bytes) -> str:
    words = line.split(None, 1)
    return words[1].strip().decode("utf-8", "replace") if len(words) > 1 else ""


def _numbers(lines: list[bytes], width: int, where: str) -> Floats:
    """Return the first `width` numbers of each line, (N, width)."""
    rows = [line.split()[1 : width + 1] for line in lines]
    try:
        values = np.array(rows, dtype=np.bytes_).astype(np.float64) if rows else np.zeros((0, width))
    except ValueError as error:
        raise SourceError("not_obj", where, "has a line with too few numbers, or with something else") from error
    if values.ndim != 2 or values.shape[1] != width:
        raise SourceError("not_obj", where, "has a line with too few numbers")
    if not np.isfinite(values).all():
        raise SourceError("bad_number", where, "has a number that is not finite")
    return values


def _group(name: str, material: str, block: _Block, vertices: int, uvs: int, where: str) -> ObjGroup:
    index = np.array(block.corners, np.int64).reshape(-1, 2)
    if len(index) and (index[:, 0].min() < 0 or index[:, 0].max() >= vertices or index[:, 1].max() >= uvs):
        raise SourceError("not_obj", where, f"a face of {name or 'the first group'!r} indexes vertices that are not there")
    triangles = index[fans(np.array(block.sizes, np.int64))]
    return ObjGroup(name, material, triangles[:, :, 0], np.maximum(triangles[:, :, 1], -1))


def fans(counts: Ints) -> Ints:
    """Return (T, 3) positions in the flat list of corners: each polygon of n corners becomes n - 2 triangles."""
    starts, inner = np.cumsum(counts) - counts, np.maximum(counts - 2, 0)
    step = np.arange(int(inner.sum())) - np.repeat(np.cumsum(inner) - inner, inner)
    first = np.repeat(starts, inner)
    return np.stack([first, first + step + 1, first + step + 2], axis=1)
