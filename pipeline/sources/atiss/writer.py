"""Our training tables as the peers' cached rooms, so that ATISS and DiffuScene train on exactly our split."""

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

from pipeline.arrays import Floats, Ints
from pipeline.manifest import write_bytes
from pipeline.sources.atiss.files import ENDS, MASK, STATS, CachedRoom, stats, write_room, write_stats
from pipeline.sources.atiss.labels import HIGHEST, LEAST, LOWEST, Kind
from pipeline.sources.reasons import Row, reject

Rooms = Sequence[tuple[str, Row, Sequence[Row]]]  # (split, row of the room, rows of its objects)


@dataclass(slots=True)
class Written:
    """What became of one kind: rooms by split, and rows for what was left out."""

    rooms: dict[str, int] = field(default_factory=lambda: {"train": 0, "val": 0, "test": 0})
    rejects: list[Row] = field(default_factory=list)


def write_kind(folder: Path, rooms: Rooms, kind: Kind, *, filtered: bool) -> Written:
    """Write <folder>/<kind>/<house>_<room>/boxes.npz, dataset_stats.txt, and <kind>_threed_front_splits.csv beside it."""
    summary = Written()
    kept: list[CachedRoom] = []
    lines = []
    for split, room in _select_rooms(rooms, kind, summary.rejects, filtered=filtered):
        write_room(folder / kind.name / room.scene_uid, room)
        summary.rooms[split] += 1
        lines.append(f"{room.scene_id},{split}\n")
        if split != "test":
            kept.append(room)
    write_stats(folder / kind.name / STATS, stats(kept, kind.classes))
    write_bytes(folder / f"{kind.name}_threed_front_splits.csv", "".join(lines).encode())
    return summary


def _select_rooms(rooms: Rooms, kind: Kind, rejects: list[Row], *, filtered: bool) -> Iterator[tuple[str, CachedRoom]]:
    taken: set[str] = set()
    for split, row, objects in rooms:
        if kind.word not in row["type"]:
            continue
        known = [o for o in objects if kind.label(o["category"])]
        where = f"{kind.name}/{row['source_id']}"
        why = _refusal(row, objects, known, kind) if filtered else ""
        if why or not known:
            rejects.append(reject("room", where, "peers_filter", why or "holds nothing of the kind's classes"))
            continue
        others = sorted({o["category"] for o in objects} - {o["category"] for o in known})
        if others:
            rejects.append(reject("room", where, "peers_class", f"{len(objects) - len(known)} objects left out: {', '.join(others)}"))
        scene_id = row["source_id"].split("/", 1)[-1].replace("_", "-")
        while scene_id in taken:  # splits are looked up by it, and ids of rooms recur between houses
            scene_id = f"{scene_id}-again"
        taken.add(scene_id)
        yield split, to_cached_room(row, known, kind, scene_id)


def _refusal(row: Row, objects: Sequence[Row], known: Sequence[Row], kind: Kind) -> str:
    """Return which of the peers' filters refuses the room, "" for none."""
    span = np.ptp(np.array(row["polygon"]), axis=0)
    top = max((o["position"][2] + o["size"][2] for o in objects), default=0.0)
    low = min((o["position"][2] for o in objects), default=0.0)
    if not LEAST <= len(objects) <= kind.most:
        return f"{len(objects)} objects"
    if len(known) < len(objects):
        return f"holds {', '.join(sorted({o['category'] for o in objects if o not in known}))}"
    if kind.needs and not set(kind.needs) & {o["category"] for o in known}:
        return f"none of {', '.join(kind.needs)}"
    if top > HIGHEST or low < LOWEST:
        return f"objects from {low:.3f} to {top:.3f} m"
    return f"floor of {span[0]:.1f} x {span[1]:.1f} m" if span.max() > kind.side else ""


def to_cached_room(row: Row, objects: Sequence[Row], kind: Kind, scene_id: str) -> CachedRoom:
    """Return a room with `objects`, all of classes of the kind, as the peers keep it."""
    vertices, faces = floor_mesh(np.array(row["polygon"], float))
    centroid = ((vertices.min(axis=0) + vertices.max(axis=0)) / 2).astype(np.float32)
    position, size = (np.array([o[key] for o in objects], float).reshape(-1, 3) for key in ("position", "size"))
    middle = np.stack([position[:, 0], position[:, 2] + size[:, 2] / 2, -position[:, 1]], axis=1)
    classes = np.zeros((len(objects), len(kind.classes) + len(ENDS)), np.float32)
    classes[np.arange(len(objects)), [kind.classes.index(str(kind.label(o["category"]))) for o in objects]] = 1.0
    house = row["source_id"].split("/", 1)[0].replace("_", "-")
    sources = [o["source_id"].rpartition("#") for o in objects]
    return CachedRoom(
        uids=tuple(s[0].split("/", 2)[-1] for s in sources),
        jids=tuple(s[2] for s in sources),
        scene_id=scene_id,
        scene_uid=f"{house}_{scene_id}",
        scene_type=row["type"],
        json_path=house,
        layout=floor_mask(np.array(row["polygon"], float), centroid, kind.reach),
        vertices=vertices,
        faces=faces,
        centroid=centroid,
        classes=classes,
        translations=(middle - centroid).astype(np.float32),
        sizes=(size[:, [0, 2, 1]] / 2).astype(np.float32),
        # their range is [-pi, pi): pi itself becomes -pi
        angles=np.array([-math.pi if o["yaw"] >= math.pi - 1e-7 else o["yaw"] for o in objects], np.float32).reshape(-1, 1),
    )


def floor_mesh(polygon: Floats) -> tuple[NDArray[np.float32], Ints]:
    """Return vertices (V, 3) in the file frame and triangles (F, 3), facing up, of a floor (n, 2) in our plan."""
    vertices = np.stack([polygon[:, 0], np.zeros(len(polygon)), -polygon[:, 1]], axis=1).astype(np.float32) + np.float32(0)
    index = {tuple(p): k for k, p in enumerate(polygon.tolist())}
    triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(Polygon(polygon)))
    rings = (np.asarray(shapely.geometry.polygon.orient(t, 1.0).exterior.coords)[:3].tolist() for t in triangles)
    return vertices, np.array([[index[tuple(p)] for p in ring] for ring in rings], np.int64).reshape(-1, 3)


def floor_mask(polygon: Floats, centroid: NDArray[np.float32], reach: float) -> NDArray[np.uint8]:
    """Return the floor seen from above (256, 256, 1), 255 where a pixel's middle lies on it; 2 `reach` [m] a side."""
    steps = ((np.arange(MASK) + 0.5) / MASK * 2 - 1) * reach
    x, z = np.meshgrid(steps + centroid[0], steps + centroid[2])
    shape = Polygon(polygon)
    shapely.prepare(shape)
    return np.where(shapely.contains_xy(shape, x, -z), 255, 0).astype(np.uint8)[..., None]


def rooms_with_objects(rooms: Sequence[Row], objects: Sequence[Row], splits: Mapping[str, str]) -> list[tuple[str, Row, list[Row]]]:
    """Return (split, room, its objects) for all rooms, in the order of the rooms table."""
    inside: dict[tuple[str, str], list[Row]] = defaultdict(list)
    for row in objects:
        inside[row["scene_id"], row["room_id"]].append(row)
    return [(splits[row["scene_id"]], row, inside[row["scene_id"], row["room_id"]]) for row in rooms]
