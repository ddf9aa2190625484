"""Wavefront OBJ and MTL files, as 3D-FUTURE and PartNet-Mobility use them, read strictly and fast.

Handled: triangles, quads and larger polygons (fanned), indices of every form (v, v/t, v//n, v/t/n), negative ones,
doubled blanks, indents, comments, colours behind vertices, groups and materials. Left out: normals, curves, lines and points.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.sources.reasons import SourceError

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


@dataclass(frozen=True, slots=True)
class MtlMaterial:
    """What we use of an MTL entry: diffuse colour, opacity, shininess (Ns), metalness (Pm) and the diffuse map's path as written."""

    name: str
    diffuse: tuple[float, float, float] = (0.8, 0.8, 0.8)
    opacity: float = 1.0
    shininess: float = 50.0
    metallic: float = 0.0
    map: str = ""


def parse_obj(data: bytes, where: str) -> ObjFile:
    """Parse an OBJ file. Raises SourceError `not_obj` or `too_large`, naming `where`."""
    data = data.removeprefix(BOM)
    if not data.strip():
        raise SourceError("not_obj", where, "is empty")
    if b"\x00" in data[:4096] or data[:2] == b"\x1f\x8b" or data.lstrip()[:1] == b"<":
        raise SourceError("not_obj", where, "is no text of an OBJ file")
    counts = data.count(b"\nv "), data.count(b"\nf "), data.count(b"\nvt")
    if counts[0] > MAX_VERTICES or counts[1] > MAX_FACES or counts[2] > MAX_UVS:
        raise SourceError("too_large", where, f"has {counts[0]} vertices, {counts[1]} faces and {counts[2]} uvs")
    v_lines, vt_lines, blocks, library = _sorted_lines(data, where)
    if len(v_lines) > MAX_VERTICES or len(vt_lines) > MAX_UVS or len(blocks) > MAX_GROUPS:
        raise SourceError("too_large", where, f"{len(v_lines)} vertices and {len(vt_lines)} uvs in {len(blocks)} groups")
    vertices = _numbers(v_lines, 3, where)
    uvs = _numbers(vt_lines, 2, where) if vt_lines else np.zeros((0, 2))
    if len(vertices) and np.abs(vertices).max() > MAX_COORDINATE:
        raise SourceError("bad_number", where, "has coordinates beyond 100,000")
    groups = tuple(_group(key, lines, len(vertices), len(uvs), where) for key, lines in blocks.items())
    if not sum(len(g.faces) for g in groups):
        raise SourceError("not_obj", where, "has no faces")
    return ObjFile(vertices, uvs, groups, library)


def _sorted_lines(data: bytes, where: str) -> tuple[list[bytes], list[bytes], dict[tuple[str, str], list[bytes]], str]:
    """Return the lines of vertices, of uvs, of faces by (group, material), and the mtllib's name."""
    data = _plain(data)
    v_lines: list[bytes] = []
    vt_lines: list[bytes] = []
    blocks: dict[tuple[str, str], list[bytes]] = {}
    group, material, library = "", "", ""
    current: list[bytes] | None = None
    for line in data.split(b"\n"):
        head = line[:2]
        if head == b"v ":
            v_lines.append(line)
        elif head == b"f ":
            if current is None:
                current = blocks.setdefault((group, material), [])
            current.append(_absolute(line, len(v_lines), len(vt_lines), where) if b"-" in line else line)
        elif head == b"vt":
            vt_lines.append(line)
        elif head in {b"g ", b"o "}:
            group, current = _name(line), None
        elif line.startswith(b"usemtl"):
            material, current = _name(line), None
        elif line.startswith(b"mtllib"):
            library = _name(line)
    return v_lines, vt_lines, blocks, library


def _plain(data: bytes) -> bytes:
    """Return the text with joined lines, plain line ends, no tabs, no indents, no comments behind vertices and faces."""
    data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n").replace(b"\t", b" ").replace(b"\\\n", b" ")
    if b"\n " in data or data[:1] == b" ":
        data = re.sub(rb"(?m)^ +", b"", data)
    return re.sub(rb"(?m)^((?:v|vt|f) [^#\n]*)#.*", rb"\1", data) if b" #" in data else data


def parse_mtl(data: bytes) -> dict[str, MtlMaterial]:
    """Parse an MTL file; a line that makes no sense is passed over, for a wrong colour is no reason to lose a model.

    Tf and Ke are ignored: 3D-FUTURE's are wrong.
    """
    materials: dict[str, MtlMaterial] = {}
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
            materials.setdefault(name, MtlMaterial(name))
        elif name is not None:
            materials[name] = _set(materials[name], key, rest)
    return materials


def _set(entry: MtlMaterial, key: str, rest: str) -> MtlMaterial:
    if key == "map_Kd":  # without options like `-s 1 1 1` before the file's name, which may contain blanks
        return replace(entry, map=re.sub(r"^(-[a-zA-Z]+\s+((-?[\d.]+|on|off)\s+)*)+", "", rest).strip())
    values = _finite(rest.split()[: 3 if key == "Kd" else 1])
    shares = [min(max(v, 0.0), 1.0) for v in values]
    if key == "Kd" and len(shares) == 3:
        return replace(entry, diffuse=(shares[0], shares[1], shares[2]))
    if key == "Ns" and values:
        return replace(entry, shininess=values[0])
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


def _absolute(line: bytes, vertices: int, uvs: int, where: str) -> bytes:
    """Turn the negative indices of a face into absolute ones: -1 is the last vertex read so far."""
    corners = []
    for word in line.split()[1:]:
        parts = word.split(b"/")
        try:
            for k, count in ((0, vertices), (1, uvs)):
                if k < len(parts) and parts[k][:1] == b"-":
                    parts[k] = str(count + 1 + int(parts[k])).encode()
        except ValueError as error:
            raise SourceError("not_obj", where, f"has a face index {word[:20]!r}") from error
        corners.append(b"/".join(parts[:2]).rstrip(b"/"))
    return b"f " + b" ".join(corners)


def _group(key: tuple[str, str], lines: list[bytes], vertices: int, uvs: int, where: str) -> ObjGroup:
    words = [line.split()[1:] for line in lines]
    counts = np.fromiter(map(len, words), np.int64, len(words))
    flat = [word for corners in words for word in corners]
    if len(flat) > MAX_CORNERS:
        raise SourceError("too_large", where, f"{len(flat)} face corners in one group")
    index = _indices(flat, where)
    index = np.where(index > 0, index - 1, -1)
    if len(index) and (index[:, 0].min() < 0 or index[:, 0].max() >= vertices or index[:, 1].max() >= uvs):
        raise SourceError("not_obj", where, f"a face of {key[0] or 'the first group'!r} indexes vertices that are not there")
    corners = fans(counts)
    triangles = index[corners]
    return ObjGroup(key[0], key[1], triangles[:, :, 0], triangles[:, :, 1])


def _indices(flat: list[bytes], where: str) -> Ints:
    """Return (N, 2) vertex and uv indices, 1-based, 0 where there is no uv."""
    joined = b" ".join(flat)
    n, slashes, doubled = len(flat), joined.count(b"/"), joined.count(b"//")
    try:
        if slashes == 0:
            width, text = 1, joined
        elif slashes == n and doubled == 0:
            width, text = 2, joined.replace(b"/", b" ")
        elif slashes == 2 * n and doubled == n:
            width, text = 1, re.sub(rb"//-?\d+", b"", joined)
        elif slashes == 2 * n and doubled == 0:
            width, text = 3, joined.replace(b"/", b" ")
        else:  # mixed forms in one group
            pairs = [(*w.split(b"/"), b"")[:2] for w in flat]
            return np.array([[int(a), int(b or b"0")] for a, b in pairs], np.int64).reshape(-1, 2)
        numbers = np.array(text.split(), dtype=np.bytes_).astype(np.int64).reshape(-1, width)
    except (ValueError, OverflowError) as error:
        raise SourceError("not_obj", where, "has a face index that is no number") from error
    if len(numbers) != n:
        raise SourceError("not_obj", where, "has a malformed face")
    uv = numbers[:, 1] if width >= 2 else np.zeros(n, np.int64)
    return np.stack([numbers[:, 0], uv], axis=1)


def fans(counts: Ints) -> Ints:
    """Return (T, 3) positions in the flat list of corners: each polygon of n corners becomes n - 2 triangles."""
    starts, inner = np.cumsum(counts) - counts, np.maximum(counts - 2, 0)
    step = np.arange(int(inner.sum())) - np.repeat(np.cumsum(inner) - inner, inner)
    first = np.repeat(starts, inner)
    return np.stack([first, first + step + 1, first + step + 2], axis=1)
