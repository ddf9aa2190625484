"""The peers' cached rooms as a source of houses: boxes with a class, a floor, no openings and no models.

Rooms of one house lie in folders "<house>_<room>"; their floors are in the house's own coordinates, so they make a home
again. Where a 3D-FUTURE folder is at hand, the models that the jids name give category and asset.
"""

import itertools
import math
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from shapely.geometry import Polygon

from pipeline import taxonomy
from pipeline.errors import ContentError
from pipeline.sources.atiss.files import BOXES, ENDS, STATS, CachedRoom, read_classes, read_room
from pipeline.sources.atiss.labels import Kind, kind_of
from pipeline.sources.batch import Batch
from pipeline.sources.guarded import Folder
from pipeline.sources.reasons import SourceError, reject
from pipeline.sources.rows import HouseRows, LibraryRows, slug
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.sizes import LONGEST, MIN_SIZE, likeliest_category
from pipeline.sources.source import Listing, Reading, Source, Task, require_folders
from pipeline.sources.threed_front.floors import outline
from pipeline.sources.threed_front.furniture import Model, Placed
from pipeline.sources.threed_front.house import rows_of
from pipeline.sources.threed_front.house_file import NO_TURN, ONE, Child, HouseFile, RoomRecord
from pipeline.sources.threed_front.house_rows import ReadRoom
from pipeline.sources.threed_front.poses import Pose, to_ours

House = tuple[str, tuple[tuple[Kind, str], ...]]  # its id; of each room its kind, and its file relative to the source


class Atiss(Source):
    """See `pipeline.sources.source.Source`. Its rooms are 3D-FRONT's; models come from 3D-FUTURE where that is at hand."""

    key = "peers"
    licence = "LicenseRef-3D-FRONT-3D-FUTURE"
    expected = "rooms as ATISS caches them"
    replaces = frozenset({"front"})

    def recognise(self, folder: Path) -> Path | None:
        """Return a folder of cached rooms, or of such folders."""
        return folder if next(folder.glob(STATS), None) or next(folder.glob(f"*/{STATS}"), None) else None

    def list(self, root: Path, _settings: PreprocessSettings, *, houses: bool = True) -> Listing:  # noqa: ARG002 - it has nothing else
        """Describe it. Raises ContentError for a folder of other classes."""
        require_folders(self.key, root)
        kinds = kinds_of(root)
        homes = peers_houses(root, kinds)
        counts = (("rooms", sum(len(rooms) for _, rooms in homes)), ("houses", len(homes)))
        return Listing(self.key, root, (".",) if "." in kinds else tuple(kinds), counts, items=tuple(homes))

    def houses(self, listing: Listing, reading: Reading, library: LibraryRows) -> Iterator[HouseRows]:
        """Read the rooms, house by house."""
        task = Task(listing.root, reading, library.models)
        yield from reading.each(Batch("house", read_peers, task, listing.items, lambda house, *why: HouseRows.refused(house[0], *why)))


def kinds_of(source: Path) -> dict[str, Kind]:
    """Return the folders with a dataset_stats.txt, in `source` or one below it, and the kind that each holds.

    Raises ContentError where there is none, or its classes are not those of the peers.
    """
    kinds = {}
    for path in sorted([*source.glob(STATS), *source.glob(f"*/{STATS}")]):
        file = path.relative_to(source)
        kind = kind_of(read_classes(Folder.at(source), file.as_posix()))
        if kind is None:
            raise ContentError(f"{path} lists classes that are none of the peers' four sets", "give the file that came with the rooms")
        kinds[file.parent.as_posix()] = kind
    if not kinds:
        where = f"preprocess.sources.peers: {source}"
        raise ContentError(f"{where} has no {STATS}", "name the folder with the cached rooms, or the one above it")
    return kinds


def peers_houses(source: Path, kinds: Mapping[str, Kind]) -> list[House]:
    """Return the houses, sorted by id, with their rooms; of a room in two kinds the first counts."""
    files = sorted(
        (path.parent.name.split("_", 1)[0], name, path.parent.name, path.relative_to(source).as_posix())
        for name in kinds
        for path in (source / name).glob(f"*_*/{BOXES}")
    )
    homes = []
    for house, group in itertools.groupby(files, lambda entry: entry[0]):
        rooms: dict[str, tuple[Kind, str]] = {}
        for _, name, room, file in group:
            rooms.setdefault(room, (kinds[name], file))
        homes.append((house, tuple(rooms.values())))
    return homes


def read_peers(task: Task, house: House) -> HouseRows:
    """Read the rooms of one house; `known` of the task are models. A room that is refused gives one reject row."""
    uid, files = house
    rows = HouseRows()
    rooms: list[ReadRoom] = []
    for kind, file in files:
        try:
            rooms.append(_room(read_room(Folder.at(task.root), file), task, kind, rooms, rows))
        except SourceError as error:
            rows.rejects.append(reject("room", Path(file).parent.name, error.code, error.detail))
    if not any(room.objects for room in rooms):
        rows.rejects.append(reject("house", uid, "no_objects" if rooms else "no_rooms"))
        return rows
    try:
        return rows_of(HouseFile(uid, {}, {}, (), (), ()), rooms, rows, task)
    except SourceError as error:
        return HouseRows(rejects=[*rows.rejects, reject("house", uid, error.code, error.detail)])


def _room(cached: CachedRoom, task: Task, kind: Kind, others: list[ReadRoom], rows: HouseRows) -> ReadRoom:
    if not len(kind.classes) <= cached.classes.shape[1] <= len(kind.classes) + len(ENDS):
        raise SourceError("bad_boxes", cached.scene_uid, f"{cached.classes.shape[1]} columns of class_labels, {len(kind.classes)} classes")
    floor = outline(cached.vertices.astype(np.float64)[cached.faces])
    if floor is None:
        raise SourceError("no_floor", cached.scene_uid, "floor_plan_faces have no area")
    if cached.scene_type.lower() not in taxonomy.load().front_rooms:
        rows.rejects.append(reject("room", cached.scene_uid, "unknown_room_type", f"type {cached.scene_type!r}"))
    room_id = slug("r", cached.scene_id)
    room_id = room_id if all(room_id != room.room_id for room in others) else f"{room_id}_{len(others)}"
    record, objects = RoomRecord(cached.scene_id, cached.scene_type, ()), list(_objects(cached, task.known, kind, rows))
    if bare := sum(not piece.asset_id for piece in objects):
        rows.rejects.append(reject("room", cached.scene_uid, "size_from_bbox", f"{bare} of {len(objects)} objects have no model"))
    ceiling = task.reading.settings.filters.ceiling
    return ReadRoom(record, room_id, cached.scene_type.lower(), floor, Polygon(floor.polygon), ceiling, objects)


def _objects(cached: CachedRoom, models: Mapping[str, Model], kind: Kind, rows: HouseRows) -> Iterator[Placed]:
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
        model = models.get(jid)
        category = model.category if model and model.category in members else likeliest_category(size, members) or members[0]
        position, angle = to_ours(middles[k] - [0, half[1], 0]), float(cached.angles[k, 0])
        pose = Pose(position, math.pi if abs(angle) >= math.pi - 1e-7 else angle, size, mirrored=False)  # the peers' range is [-pi, pi)
        scale = np.round(size / np.array(model.asset_size), 6) if model else ONE
        child = Child(cached.uids[k], cached.uids[k], position, NO_TURN, ONE)
        yield Placed(child, jid, category, model.asset_id if model else "", pose, scale, bool(model and model.openable), ())
