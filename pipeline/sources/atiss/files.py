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
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline.manifest import write_bytes
from pipeline.sources.guarded import Folder, read_json
from pipeline.sources.reasons import SourceError

Floats = NDArray[np.float32]
BOXES, STATS = "boxes.npz", "dataset_stats.txt"
ENDS = ("start", "end")  # the last two columns of class_labels
MASK = 256  # pixels a side
MAX_FILE, MAX_UNPACKED = 16 << 20, 64 << 20  # bytes
MAX_OBJECTS = 500
TEXTS = ("scene_id", "scene_uid", "scene_type", "json_path")


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
    vertices: Floats
    faces: NDArray[np.int64]
    centroid: Floats
    classes: Floats
    translations: Floats
    sizes: Floats
    angles: Floats


def write_room(folder: Path, room: CachedRoom) -> None:
    """Write boxes.npz; the bytes depend on nothing but the room, and reading them needs no pickle."""
    out = io.BytesIO()
    np.savez_compressed(
        out,
        uids=np.array(room.uids, dtype=np.str_),
        jids=np.array(room.jids, dtype=np.str_),
        scene_id=np.array(room.scene_id),
        scene_uid=np.array(room.scene_uid),
        scene_type=np.array(room.scene_type),
        json_path=np.array(room.json_path),
        room_layout=room.layout,
        floor_plan_vertices=room.vertices,
        floor_plan_faces=room.faces,
        floor_plan_centroid=room.centroid,
        class_labels=room.classes,
        translations=room.translations,
        sizes=room.sizes,
        angles=room.angles,
    )
    write_bytes(folder / BOXES, out.getvalue())


def read_room(folder: Folder, file: str) -> CachedRoom:
    """Read boxes.npz. Raises SourceError `bad_boxes` for anything that is not what `CachedRoom` says."""
    arrays = _arrays(folder.read(file, MAX_FILE), file)

    def numbers(name: str, *shape: int | None) -> Floats:
        array = _array(arrays, name, file)
        if (
            array.dtype.kind not in "fiu"
            or array.ndim != len(shape)
            or any(n not in {None, m} for n, m in zip(shape, array.shape, strict=True))
        ):
            raise SourceError("bad_boxes", file, f"{name} has type {array.dtype} and shape {array.shape}")
        floats = array.astype(np.float32)
        if not np.isfinite(floats).all():
            raise SourceError("bad_boxes", file, f"{name} holds a number that is not finite")
        return floats

    def words(name: str) -> tuple[str, ...]:
        array = _array(arrays, name, file)
        if array.dtype.kind != "U" or array.ndim > 1:
            raise SourceError("bad_boxes", file, f"{name} has type {array.dtype}, not text")
        return tuple(map(str, array.reshape(-1)))

    count = len(numbers("translations", None, 3))
    if count > MAX_OBJECTS:
        raise SourceError("bad_boxes", file, f"{count} objects in a room")
    texts = {name: "".join(words(name)[:1]) for name in TEXTS}
    layout = numbers("room_layout", *([None] * _array(arrays, "room_layout", file).ndim))
    faces, vertices = numbers("floor_plan_faces", None, 3), numbers("floor_plan_vertices", None, 3)
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise SourceError("bad_boxes", file, "floor_plan_faces index vertices that are not there")
    room = CachedRoom(
        words("uids"), words("jids"), **texts, layout=layout.astype(np.uint8), vertices=vertices, faces=faces.astype(np.int64),
        centroid=numbers("floor_plan_centroid", 3), classes=numbers("class_labels", count, None), translations=numbers("translations", count, 3),
        sizes=numbers("sizes", count, 3), angles=numbers("angles", count, 1),
    )  # fmt: skip
    if not (len(room.uids) == len(room.jids) == count):
        raise SourceError("bad_boxes", file, f"{len(room.uids)} uids and {len(room.jids)} jids for {count} objects")
    return room


def _arrays(data: bytes, file: str) -> dict[str, NDArray[Any]]:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            unpacked = sum(entry.file_size for entry in archive.infolist())
        if unpacked > MAX_UNPACKED:
            raise SourceError("bad_boxes", file, f"unpacks to {unpacked} bytes")
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            return {name: _load_array(archive, name, file) for name in archive.files}
    except (zipfile.BadZipFile, zlib.error, OSError, ValueError, KeyError, EOFError, NotImplementedError) as error:
        raise SourceError("bad_boxes", file, f"is no readable npz file ({str(error)[:60]})") from error


def _load_array(archive: Any, name: str, file: str) -> NDArray[Any]:
    try:
        array: NDArray[Any] = archive[name]
    except ValueError as error:
        if "allow_pickle" not in str(error):
            raise
        raise SourceError(
            "bad_boxes", file, f"{name} needs pickle, which is never loaded; write it again as an array of text or numbers"
        ) from error
    return array


def _array(arrays: dict[str, NDArray[Any]], name: str, file: str) -> NDArray[Any]:
    if name not in arrays:
        raise SourceError("bad_boxes", file, f"lacks {name}")
    return arrays[name]


def read_classes(folder: Folder, file: str) -> tuple[str, ...]:
    """Return the classes that dataset_stats.txt lists, without start and end."""
    tree = read_json(folder, file)
    labels = tree.get("class_labels") if isinstance(tree, dict) else None
    if not isinstance(labels, list) or not all(isinstance(c, str) for c in labels):
        raise SourceError("bad_structure", file, "has no list class_labels")
    return tuple(c for c in labels if c not in ENDS)


def stats(rooms: Iterable[CachedRoom], classes: Sequence[str]) -> dict[str, Any]:
    """Return what dataset_stats.txt holds, over the rooms of train and val: bounds, classes, how often each occurs."""
    translations: list[NDArray[Any]] = [np.zeros((0, 3))]
    sizes: list[NDArray[Any]] = [np.zeros((0, 3))]
    angles: list[NDArray[Any]] = [np.zeros((0, 1))]
    counts: Counter[str] = Counter()
    for room in rooms:
        translations.append(room.translations)
        sizes.append(room.sizes)
        angles.append(room.angles)
        counts.update(classes[k] for k in room.classes.argmax(axis=1))
    total = max(1, sum(counts.values()))
    order = sorted(counts, key=lambda c: (-counts[c], c))
    return {
        "bounds_translations": _bounds(translations),
        "bounds_sizes": _bounds(sizes),
        "bounds_angles": _bounds(angles),
        "class_labels": [*classes, *ENDS],
        "object_types": list(classes),
        "class_frequencies": {c: counts[c] / total for c in order},
        "class_order": {c: k for k, c in enumerate(order)},
        "count_furniture": {c: counts[c] for c in order},
    }


def _bounds(parts: list[NDArray[Any]]) -> list[float]:
    """Return the least value of every column, then the largest."""
    whole = np.concatenate(parts).astype(np.float64)
    return [*whole.min(axis=0).tolist(), *whole.max(axis=0).tolist()] if len(whole) else [0.0] * (2 * whole.shape[1])


def write_stats(path: Path, content: dict[str, Any]) -> None:
    """Write dataset_stats.txt: one JSON object."""
    write_bytes(path, (json.dumps(content, allow_nan=False) + "\n").encode())
