"""The recipe of CONTRIBUTING.md for a dataset: one folder's worth of code here, its line in the registry, its path in params.yaml."""

import numpy as np
import pytest
import yaml
from shapely.geometry import Polygon

from pipeline import tables
from pipeline.sources import inventory, registry
from pipeline.sources.batch import Batch
from pipeline.sources.guarded import MIB, Folder
from pipeline.sources.reasons import SourceError
from pipeline.sources.rows import HouseRows, slug
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.source import Listing, Reading, Source, Task, require_folders
from pipeline.sources.threed_front.floors import outline
from pipeline.sources.threed_front.furniture import Placed
from pipeline.sources.threed_front.house import rows_of
from pipeline.sources.threed_front.house_file import NO_TURN, ONE, Child, HouseFile, RoomRecord
from pipeline.sources.threed_front.house_rows import ReadRoom
from pipeline.sources.threed_front.poses import Pose
from schemas import OBJECTS, REJECTS, SCENES
from stages import preprocess
from tests.sources.reading import WALKER
from tests.stages.test_preprocess import VERIFY

GOOD = "bedroom 4 3\ndouble_bed 2 1.2 0 1.8 2.1 0.5\nnightstand 3.5 0.3 0 0.5 0.4 0.5\n"


class Sketches(Source):
    """Rooms as text: their type, width and depth [m], then a line per thing: category, x, y, yaw, w, d, h."""

    key, licence, expected, replaces = "sketches", "CC-BY-4.0", "*.room", frozenset()

    def recognise(self, folder):
        return folder if next(folder.glob("*.room"), None) else None

    def list(self, root, _settings, *, houses=True):
        require_folders(self.key, root)
        files = sorted(p.name for p in root.glob("*.room"))
        return Listing(self.key, root, (".",), (("rooms", len(files)),), items=tuple(files))

    def houses(self, listing, reading, _library):
        yield from reading.each(Batch("house", read_sketch, Task(listing.root, reading), listing.items, HouseRows.refused))


def read_sketch(task, file):
    try:
        head, *lines = Folder.at(task.root).read(file, MIB).decode().splitlines()
        kind, w, d = head.split()
        if kind == "spin":
            while True:
                pass
        corners = np.array([[0, 0, 0], [float(w), 0, 0], [float(w), 0, -float(d)], [0, 0, -float(d)]])
        floor = outline(corners[[[0, 1, 2], [0, 2, 3]]])
        room = ReadRoom(RoomRecord(kind, kind, ()), slug("r", kind), kind, floor, Polygon(floor.polygon), 2.7, [])
        for number, line in enumerate(lines):
            category, *numbers = line.split()
            x, y, yaw, *size = map(float, numbers)
            pose = Pose(np.array([x, y, 0.0]), yaw, np.array(size), mirrored=False)
            child = Child(str(number), str(number), pose.position, NO_TURN, ONE)
            room.objects.append(Placed(child, "", category, "", pose, ONE, False, ()))
        return rows_of(HouseFile(file, {}, {}, (), (), ()), [room], HouseRows(file), task)
    except ValueError as error:
        raise SourceError("bad_structure", file, str(error)) from error


@pytest.fixture
def root(tmp_path, monkeypatch):
    monkeypatch.setattr(registry, "SOURCES", (*registry.SOURCES, Sketches()))
    (tmp_path / "sketches").mkdir()
    settings = {
        "sources": {"sketches": "sketches"},
        "workers": 1,
        "budget": {"seconds": 5.0, "mebibytes": 1024},
        "filters": {"keep_without_model": True},
    }
    (tmp_path / "params.yaml").write_text(yaml.safe_dump({"preset": "a", "presets": {"a": {}}, "verify": VERIFY, "preprocess": settings}))
    for name, text in {"a": GOOD, "b": "bedroom four 3\n", "c": "spin 1 1\n", "d": GOOD}.items():
        (tmp_path / "sketches" / f"{name}.room").write_text(text)
    read_sketch(
        Task(tmp_path / "sketches", Reading(PreprocessSettings(), "", tmp_path, WALKER, 1)), "a.room"
    )  # compiles what is compiled once a machine
    return tmp_path


def test_it_is_recognised_listed_and_read(root):
    (listing,) = registry.recognise_sources(root / "sketches")
    assert str(listing) == f"{root / 'sketches'}: 4 rooms"
    assert inventory.write(root / inventory.FOLDER / "sketches.csv", inventory.scan(listing)) == 4
    preprocess.main(root)
    rows = {t.name: tables.read(root / "data/tables" / f"{t.name}.parquet", t) for t in (SCENES, OBJECTS, REJECTS)}
    assert [(s["scene_id"], s["licence"]) for s in rows["scenes"]] == [("h_a_room", "CC-BY-4.0"), ("h_d_room", "CC-BY-4.0")]
    assert [o["category"] for o in rows["objects"]] == ["double_bed", "nightstand"] * 2
    assert {r["where"]: r["reason"] for r in rows["rejects"]} == {"b.room": "bad_structure", "c.room": "out_of_time"}


def test_a_key_that_is_none_of_a_source_is_said(root):
    text = (root / "params.yaml").read_text().replace("sketches: sketches", "sketch: sketches")
    (root / "params.yaml").write_text(text)
    with pytest.raises(Exception, match=r"preprocess\.sources\.sketch"):
        preprocess.main(root)
