"""The peers' cached rooms as rows of the training tables: boxes with a class, a floor, no openings and no models.

Rooms of one house lie in folders "<house>_<room>"; their floors are in the house's own coordinates, so they make a home
again. Where a 3D-FUTURE folder is at hand, the models that the jids name give category and asset.
"""

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from shapely.geometry import Polygon

from pipeline import taxonomy
from pipeline.errors import ContentError
from pipeline.sources.atiss.files import BOXES, ENDS, STATS, CachedRoom, read_classes, read_room
from pipeline.sources.atiss.labels import Kind, kind_of
from pipeline.sources.guarded import Folder
from pipeline.sources.house_rows import HouseRows
from pipeline.sources.identity import slug
from pipeline.sources.reasons import SourceError, reject
from pipeline.sources.settings import FrontFilters
from pipeline.sources.threed_front.floors import outline
from pipeline.sources.threed_front.furniture import MIN_SIZE, Model, Placed
from pipeline.sources.threed_front.future_scale import LONGEST, likeliest
from pipeline.sources.threed_front.house import rows_of
from pipeline.sources.threed_front.house_file import NO_TURN, ONE, Child, HouseFile, RoomRecord
from pipeline.sources.threed_front.poses import Pose, to_ours
from pipeline.sources.threed_front.rows import ReadRoom
from pipeline.sources.walkable_share import Walker

House = tuple[str, tuple[tuple[str, str], ...]]  # its id, and (folder of the kind, folder of the room) of each room


@dataclass(frozen=True, slots=True)
class PeersTask:
    """What every house needs: the root, the classes of each kind's folder, models by jid, filters, licence, and who must find a way."""

    source: Path
    kinds: Mapping[str, Kind]
    models: Mapping[str, Model]
    filters: FrontFilters
    licence: str
    walker: Walker


def kinds_of(source: Path) -> dict[str, Kind]:
    """Return the folders with a dataset_stats.txt, in `source` or one below it, and the kind that each holds.

    Raises ContentError where there is none, or its classes are not those of the peers.
    """
    kinds = {}
    for path in sorted([*source.glob(STATS), *source.glob(f"*/{STATS}")]):
        name = path.parent.relative_to(source).as_posix()
        kind = kind_of(read_classes(Folder.at(source), path.relative_to(source).as_posix()))
        if kind is None:
            raise ContentError(f"{path} lists classes that are none of the peers' four sets", "give the file that came with the rooms")
        kinds[name] = kind
    if not kinds:
        raise ContentError(
            f"preprocess.sources.peers: {source} has no {STATS}", "name the folder with the cached rooms, or the one above it"
        )
    return kinds


def peers_houses(source: Path, kinds: Mapping[str, Kind]) -> list[House]:
    """Return the houses, sorted by id, and the folders of their rooms."""
    rooms = sorted(
        (path.parent.name.split("_", 1)[0], name, path.parent.name) for name in kinds for path in (source / name).glob(f"*_*/{BOXES}")
    )
    return [(house, tuple((name, folder) for _, name, folder in group)) for house, group in itertools.groupby(rooms, lambda r: r[0])]


def read_peers(task: PeersTask, house: House) -> HouseRows:
    """Read the rooms of one house. A room that is refused gives one reject row; a room in two kinds is read once."""
    uid, folders = house
    rows = HouseRows()
    rooms: list[ReadRoom] = []
    seen: set[str] = set()
    for name, folder in folders:
        if folder in seen:
            continue
        seen.add(folder)
        try:
            cached = read_room(Folder.at(task.source), (Path(name) / folder / BOXES).as_posix())
            rooms.append(_room(cached, task, task.kinds[name], rooms, rows))
        except SourceError as error:
            rows.rejects.append(reject("room", folder, error.code, error.detail))
        except MemoryError:
            raise  # the budget's business
        except Exception as error:  # noqa: BLE001 - one bad file of thousands must not end the run; the table tells
            rows.rejects.append(reject("house", uid, "internal", f"{type(error).__name__}: {error}"))
    if not any(room.objects for room in rooms):
        rows.rejects.append(reject("house", uid, "no_objects" if rooms else "no_rooms"))
        return rows
    try:
        return rows_of(HouseFile(uid, {}, {}, (), (), ()), rooms, rows, taxonomy.load(), task.filters, task.licence, task.walker)
    except SourceError as error:
        return HouseRows(rejects=[*rows.rejects, reject("house", uid, error.code, error.detail)])


def _room(cached: CachedRoom, task: PeersTask, kind: Kind, others: list[ReadRoom], rows: HouseRows) -> ReadRoom:
    if not len(kind.classes) <= cached.classes.shape[1] <= len(kind.classes) + len(ENDS):
        raise SourceError("bad_boxes", cached.scene_uid, f"{cached.classes.shape[1]} columns of class_labels, {len(kind.classes)} classes")
    floor = outline(cached.vertices.astype(np.float64)[cached.faces])
    if floor is None:
        raise SourceError("no_floor", cached.scene_uid, "floor_plan_faces have no area")
    words = taxonomy.load()
    if cached.scene_type.lower() not in words.front_rooms:
        rows.rejects.append(reject("room", cached.scene_uid, "unknown_room_type", f"type {cached.scene_type!r}"))
    taken = {room.room_id for room in others}
    room_id = slug("r", cached.scene_id)
    room_id = room_id if room_id not in taken else f"{room_id}_{len(others)}"
    record = RoomRecord(cached.scene_id, cached.scene_type, ())
    room = ReadRoom(record, room_id, cached.scene_type.lower(), floor, Polygon(floor.polygon), task.filters.ceiling, [])
    room.objects.extend(_objects(cached, task, kind, rows))
    bare = sum(not piece.asset_id for piece in room.objects)
    if bare:
        rows.rejects.append(reject("room", cached.scene_uid, "size_from_bbox", f"{bare} of {len(room.objects)} objects have no model"))
    return room


def _objects(cached: CachedRoom, task: PeersTask, kind: Kind, rows: HouseRows) -> Iterator[Placed]:
    middles = cached.translations.astype(np.float64) + cached.centroid.astype(np.float64)
    for k, jid in enumerate(cached.jids):
        half = cached.sizes[k].astype(np.float64)
        where = f"{cached.scene_uid}/{cached.uids[k]}"
        column = int(cached.classes[k].argmax())
        if column >= len(kind.classes):
            rows.rejects.append(reject("object", where, "unknown_category", "its class is start or end"))
            continue
        size = 2 * half[[0, 2, 1]]
        if size.max() > LONGEST or size.min() < MIN_SIZE:
            rows.rejects.append(reject("object", where, "bad_size", f"size {np.round(size, 3).tolist()}"))
            continue
        members = kind.categories(kind.classes[column])
        model = task.models.get(jid)
        category = model.category if model and model.category in members else likeliest(size, members) or members[0]
        position = to_ours(middles[k] - [0, half[1], 0])
        pose = Pose(position, _yaw(float(cached.angles[k, 0])), size, mirrored=False)
        scale = np.round(size / np.array(model.asset_size), 6) if model else ONE
        child = Child(cached.uids[k], cached.uids[k], position, NO_TURN, ONE)
        yield Placed(child, jid, category, model.asset_id if model else "", pose, scale, bool(model and model.openable), ())


def _yaw(angle: float) -> float:
    """Return an angle of the peers in our range (-pi, pi]."""
    return math.pi if abs(angle) >= math.pi - 1e-7 else angle
