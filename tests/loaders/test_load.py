"""sfgen.load: what was written comes back, lazily, without any of the factory's code."""

import json
import shutil
import subprocess
import sys
from dataclasses import fields

import numpy as np
import pyarrow.parquet as pq
import pytest

import sfgen
from pipeline.shards import TABLES, header
from schemas.table import SCHEMA_VERSION
from sfgen import dataset
from sfgen.check import check
from sfgen.homes import Joint, Opening, PlacedObject, Room


def test_homes_come_in_order_with_all_their_parts(dataset_folder):
    homes = sfgen.load(dataset_folder)
    assert len(homes) == len(list(homes)) == 10
    assert [home.index for home in homes] == list(range(10))
    for home in homes:
        assert home.scene_id == f"s5_{home.index:08d}"
        assert [room.room_id for room in home.rooms] == ["room_0", "room_1"]
        assert len(home.objects) == 1 + home.index % 3 == len(home.in_room("room_0")) + len(home.in_room("room_1"))
        assert {j.object_id for j in home.joints} == {"thing_0", "door_0"}
        assert home.joints_of("door_0")[0].joint_id == "joint_0"
        assert home.openings[0].rooms == ("room_0", "room_1")
        assert home.usd.is_file()
        assert home.program == ({"version": 1} if home.index % 2 else None)
        assert home.prompt == f"home {home.index}"


def test_numbers_come_as_arrays_with_their_shapes(dataset_folder):
    home = sfgen.load(dataset_folder)[3]
    thing, room, joint = home.objects[0], home.rooms[0], home.joints[0]
    assert (thing.position.shape, thing.size.dtype, thing.latent.shape, thing.latent.dtype) == ((3,), np.float64, (32,), np.float32)
    np.testing.assert_array_equal(room.polygon, [[0, 0], [4, 0], [4, 6], [0, 6]])
    assert joint.axis.shape == (3,)
    assert home.openings[0].segment.shape == (2, 2)
    assert joint.stand is None
    assert sfgen.load(dataset_folder)[2].joints[0].stand.shape == (3,)


@pytest.mark.parametrize(("cls", "table"), [(Room, "rooms"), (Opening, "openings"), (PlacedObject, "objects"), (Joint, "joints")])
def test_records_are_columns_of_the_tables(cls, table):
    assert {f.name for f in fields(cls)} <= {c.name for c in TABLES[table].columns}


def test_indexing_slices_and_splits(dataset_folder):
    homes = sfgen.load(dataset_folder)
    assert homes[-1].index == 9
    assert [h.index for h in homes[3:9:2]] == [3, 5, 7]
    assert [h.index for h in homes.split("val")] == [1, 4, 7]
    assert [h.index for h in sfgen.load(dataset_folder, "test")] == [2, 5, 8]
    assert len(homes.split("nonsense")) == 0
    with pytest.raises(IndexError):
        homes[10]


def test_tables_and_header(dataset_folder):
    homes = sfgen.load(str(dataset_folder))
    assert homes.header["seed"] == 5
    assert homes.table("scenes").num_rows == 10
    assert homes.table("rejects")["reason"].to_pylist() == ["too_crowded"] * 2
    assert {"double_bed", "oven"} < set(homes.categories())
    assert homes[2:5].categories() == homes.split("nothing").categories() == homes.categories()
    assert {"bedroom", "kitchen", "gym"} < set(homes.room_types())
    assert "10 homes" in repr(homes)
    with pytest.raises(sfgen.DatasetError, match="tables are"):
        homes.table("chairs")


def test_shards_are_read_when_they_are_needed(tmp_path, dataset_folder):
    folder = shutil.copytree(dataset_folder, tmp_path / "copy")
    (folder / "objects" / "shard-00002.parquet").write_bytes(b"PAR1 cut")
    homes = sfgen.load(folder)
    assert homes[7].index == 7
    with pytest.raises(sfgen.DatasetError, match=r"objects/shard-00002\.parquet"):
        homes[8]


def test_shards_that_are_not_committed_are_not_seen(tmp_path, dataset_folder):
    folder = shutil.copytree(dataset_folder, tmp_path / "copy")
    (folder / "commits" / "shard-00001.json").unlink()
    assert [h.index for h in sfgen.load(folder)] == [0, 1, 2, 3, 8, 9]
    for commit in (folder / "commits").glob("shard-*"):
        commit.unlink()
    assert len(sfgen.load(folder)) == 0


@pytest.mark.parametrize("text", [None, "", "[]", json.dumps({"format": "sfgen-dataset-99"}), json.dumps({"format": "sfgen-dataset-3"})])
def test_what_is_no_dataset_is_named(tmp_path, text):
    if text is not None:
        (tmp_path / "dataset.json").write_text(text)
    with pytest.raises(sfgen.DatasetError, match=r"dataset\.json|tables of version None"):
        sfgen.load(tmp_path)


def test_unknown_names_are_attribute_errors():
    with pytest.raises(AttributeError, match="no attribute 'lode'"):
        sfgen.lode  # noqa: B018


def test_loaders_import_none_of_the_factory(dataset_folder):
    program = (
        "import sys, sfgen; assert not {'numpy', 'pyarrow'} & sys.modules.keys()\n"
        f"assert sum(1 for _ in sfgen.load({str(dataset_folder)!r})) == 10\n"
        "assert not {'pipeline', 'schemas', 'stages', 'typer', 'torch', 'yaml'} & sys.modules.keys()"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


def test_reading_starts_no_threads_that_could_outlive_the_interpreter(dataset_folder):
    program = (
        "import sys, os, sfgen.dataset\n"
        "threads = lambda: len(os.listdir('/proc/self/task'))\n"
        "before = threads()\n"
        f"homes = list(sfgen.load({str(dataset_folder)!r}))\n"
        "assert len(homes) == 10 and threads() == before, threads()"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


def test_empty_indices_are_told(tmp_path):
    import made

    made.fill(tmp_path / "set", without={1, 4, 5, 6, 7})
    dataset = sfgen.load(tmp_path / "set")
    assert [home.index for home in dataset] == [0, 2, 3, 8, 9]
    assert dataset.empty() == dict.fromkeys((1, 4, 5, 6, 7), "refused")


def test_another_version_of_the_tables_is_named(tmp_path, dataset_folder):
    folder = shutil.copytree(dataset_folder, tmp_path / "copy")
    header = json.loads((folder / "dataset.json").read_text())
    (folder / "dataset.json").write_text(json.dumps({**header, "schema_version": "1"}))
    with pytest.raises(sfgen.DatasetError, match="tables of version 1, and this release of sfgen reads 2"):
        sfgen.load(folder)
    with pytest.raises(sfgen.DatasetError, match="tables of version 1, and this release of sfgen reads 2"):
        check(folder)


def test_facts_that_loaders_and_factory_share_are_the_same():
    assert (dataset.FORMAT, dataset.SCHEMA_VERSION) == (header.FORMAT, SCHEMA_VERSION)
    assert set(dataset.TABLES) == set(TABLES)


@pytest.mark.parametrize("name", ["shard-notes.json", "shard-00009.json", "notes.txt"])
def test_foreign_commits_are_named(tmp_path, dataset_folder, name):
    folder = shutil.copytree(dataset_folder, tmp_path / "copy")
    (folder / "commits" / name).write_text("{}")
    with pytest.raises(sfgen.DatasetError, match=name):
        sfgen.load(folder)


def test_another_programs_table_is_named(tmp_path, dataset_folder):
    folder = shutil.copytree(dataset_folder, tmp_path / "copy")
    path = folder / "objects" / "shard-00000.parquet"
    pq.write_table(pq.read_table(path).drop_columns(["yaw", "size"]), path)
    with pytest.raises(sfgen.DatasetError, match="has no column yaw, size"):
        sfgen.load(folder)[0]


def test_a_stage_whose_assets_were_deleted_is_named(tmp_path, dataset_folder):
    folder = shutil.copytree(dataset_folder, tmp_path / "copy")
    assert sfgen.load(folder)[0].stage().is_file()
    shutil.rmtree(folder / "assets" / "asset_0")
    assert sfgen.load(folder)[0].rooms  # the tables alone can be read
    with pytest.raises(sfgen.DatasetError, match=r"assets/asset_0/asset_0\.usda is missing"):
        sfgen.load(folder)[0].stage()


def test_a_dataset_at_an_address_is_read_as_one_in_a_folder(dataset_folder):
    import fsspec

    fsspec.filesystem("memory").put(str(dataset_folder), "/bucket/made", recursive=True)
    there, here = sfgen.load("memory://bucket/made"), sfgen.load(dataset_folder)
    assert [h.scene_id for h in there] == [h.scene_id for h in here]
    np.testing.assert_array_equal(there[4].objects[1].position, here[4].objects[1].position)
    assert there[4].stage() == "memory://bucket/made/usd/shard-00001/s5_00000004.usdc"
    with pytest.raises(sfgen.DatasetError, match="is not a dataset"):
        sfgen.load("memory://bucket/nothing")


def test_a_shard_is_read_once_in_any_order_of_its_neighbours(dataset_folder, monkeypatch):
    homes, read = sfgen.load(dataset_folder), []
    real = homes._read
    monkeypatch.setattr(homes, "_read", lambda table, number, *columns: read.append((table, number)) or real(table, number, *columns))
    for i in (9, 0, 5, 3, 8, 1, 4):
        assert homes[i].index == i
    assert len(read) == len(set(read)) == 15
