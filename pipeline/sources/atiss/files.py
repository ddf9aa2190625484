"""Files of the cached format of ATISS and DiffuScene: boxes.npz of one room, dataset_stats.txt of all.

Frame of everything here: 3D-FRONT's (y up, metres, front +z); `translations` are middles of boxes relative to
`floor_plan_centroid`, the middle of the bounds of the floor's vertices; `sizes` are HALF extents (width, height, depth)
along the object's own axes; `angles` are yaws about +y in [-pi, pi).
"""

import io
import json
import zipfile
import zlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Ints
from pipeline.manifest import write_bytes
from pipeline.sources.guarded import Folder, read_json
from pipeline.sources.reasons import SourceError

Float32s = NDArray[np.float32]
BOXES, STATS = "boxes.npz", "dataset_stats.txt"
ENDS = ("start", "end")  # the last two columns of class_labels
MASK = 256  # pixels a side
MAX_FILE, MAX_UNPACKED = 16 << 20, 64 << 20  # bytes
MAX_OBJECTS = 500
TEXTS = ("scene_id", "scene_uid", "scene_type", "json_path")
NAMES = {  # of arrays that are called otherwise here
    "layout": "room_layout", "vertices": "floor_plan_vertices", "faces": "floor_plan_faces", "centroid": "floor_plan_centroid",
    "classes": "class_labels",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class CachedRoom:
    """One room; arrays of L objects: `classes` (L, C) one-hot, `translations` and `sizes` (L, 3), `angles` (L, 1).

    `layout` (256, 256, 1) is the floor mask, 0 or 255: columns along +x, rows along +z. `vertices` (V, 3) and `faces`
    (F, 3) are the floor in world coordinates.
    """

    uids: tuple[str, ...]
    jids: tuple[str, ...]
    scene_id: str
    scene_uid: str
    scene_type: str
    json_path: str
    layout: NDArray[np.uint8]
    vertices: Float32s
    faces: Ints
    centroid: Float32s
    classes: Float32s
    translations: Float32s
    sizes: Float32s
    angles: Float32s


def write_room(folder: Path, room: CachedRoom) -> None:
    """Write boxes.npz; the bytes depend on nothing but the room, and reading them needs no pickle."""
    held = ((NAMES.get(field.name, field.name), getattr(room, field.name)) for field in fields(room))
    out = io.BytesIO()
    arrays: dict[str, Any] = {k: v if isinstance(v, np.ndarray) else np.array(v, dtype=np.str_) for k, v in held}
    np.savez_compressed(out, **arrays)
    write_bytes(folder / BOXES, out.getvalue())


def read_room(folder: Folder, file: str) -> CachedRoom:
    """Read boxes.npz. Raises SourceError `bad_boxes` for anything that is not what `CachedRoom` says."""
    arrays = _arrays(folder.read(file, MAX_FILE), file)

    def refuse(detail: str) -> SourceError:
        return SourceError("bad_boxes", file, detail)

    def array(name: str, kinds: str, *shape: int | None) -> NDArray[Any]:
        name = NAMES.get(name, name)
        if name not in arrays:
            raise refuse(f"lacks {name}")
        held = arrays[name]
        fits = held.ndim == len(shape) and all(n in {None, m} for n, m in zip(shape, held.shape, strict=True))
        if held.dtype.kind not in kinds or not (fits or not shape):
            raise refuse(f"{name} has type {held.dtype} and shape {held.shape}")
        return held

    def numbers(name: str, *shape: int | None) -> Float32s:
        floats = array(name, "fiu", *shape).astype(np.float32)
        if not np.isfinite(floats).all():
            raise refuse(f"{NAMES.get(name, name)} holds a number that is not finite")
        return floats

    def words(name: str) -> tuple[str, ...]:
        held = array(name, "U")
        if held.ndim > 1:
            raise refuse(f"{name} has shape {held.shape}")
        return tuple(map(str, held.reshape(-1)))

    count = len(numbers("translations", None, 3))
    if count > MAX_OBJECTS:
        raise refuse(f"{count} objects in a room")
    faces, vertices = numbers("faces", None, 3), numbers("vertices", None, 3)
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise refuse("floor_plan_faces index vertices that are not there")
    uids, jids = words("uids"), words("jids")
    if not (len(uids) == len(jids) == count):
        raise refuse(f"{len(uids)} uids and {len(jids)} jids for {count} objects")
    texts = {name: "".join(words(name)[:1]) for name in TEXTS}
    return CachedRoom(
        uids, jids, **texts, layout=numbers("layout").astype(np.uint8), vertices=vertices, faces=faces.astype(np.int64),
        centroid=numbers("centroid", 3), classes=numbers("classes", count, None), translations=numbers("translations", count, 3),
        sizes=numbers("sizes", count, 3), angles=numbers("angles", count, 1),
    )  # fmt: skip


def _arrays(data: bytes, file: str) -> dict[str, NDArray[Any]]:
    arrays: dict[str, NDArray[Any]] = {}
    name = ""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            unpacked = sum(entry.file_size for entry in archive.infolist())
        if unpacked > MAX_UNPACKED:
            raise SourceError("bad_boxes", file, f"unpacks to {unpacked} bytes")
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            for name in archive.files:
                arrays[name] = archive[name]
    except (zipfile.BadZipFile, zlib.error, OSError, ValueError, KeyError, EOFError, NotImplementedError) as error:
        pickled = f"{name} needs pickle, which is never loaded; write it again as an array of text or numbers"
        why = pickled if "allow_pickle" in str(error) else f"is no readable npz file ({str(error)[:60]})"
        raise SourceError("bad_boxes", file, why) from error
    return arrays


def read_classes(folder: Folder, file: str) -> tuple[str, ...]:
    """Return the classes that dataset_stats.txt lists, without start and end."""
    tree = read_json(folder, file)
    labels = tree.get("class_labels") if isinstance(tree, dict) else None
    if not isinstance(labels, list) or not all(isinstance(c, str) for c in labels):
        raise SourceError("bad_structure", file, "has no list class_labels")
    return tuple(c for c in labels if c not in ENDS)


def stats(rooms: Sequence[CachedRoom], classes: Sequence[str]) -> dict[str, Any]:
    """Return what dataset_stats.txt holds, over the rooms of train and val: bounds, classes, how often each occurs."""
    counts = Counter(classes[k] for room in rooms for k in room.classes.argmax(axis=1))
    total = max(1, sum(counts.values()))
    order = sorted(counts, key=lambda c: (-counts[c], c))
    return {
        "bounds_translations": _bounds([room.translations for room in rooms], 3),
        "bounds_sizes": _bounds([room.sizes for room in rooms], 3),
        "bounds_angles": _bounds([room.angles for room in rooms], 1),
        "class_labels": [*classes, *ENDS],
        "object_types": list(classes),
        "class_frequencies": {c: counts[c] / total for c in order},
        "class_order": {c: k for k, c in enumerate(order)},
        "count_furniture": {c: counts[c] for c in order},
    }


def _bounds(parts: list[Float32s], columns: int) -> list[float]:
    """Return the least value of every column, then the largest."""
    whole = np.concatenate([np.zeros((0, columns)), *parts])
    return [*whole.min(axis=0).tolist(), *whole.max(axis=0).tolist()] if len(whole) else [0.0] * (2 * columns)


def write_stats(path: Path, content: dict[str, Any]) -> None:
    """Write dataset_stats.txt: one JSON object."""
    write_bytes(path, (json.dumps(content, allow_nan=False) + "\n").encode())
