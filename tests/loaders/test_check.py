"""check names the first thing that is wrong, whatever it is."""

import json
import random
import shutil
import sys
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from pipeline.manifest import sha256
from pipeline.shards import read_header
from pipeline.shards.seal import seal
from sfgen.check import check
from sfgen.place import DatasetError

sys.path.insert(0, str(Path(__file__).parents[1] / "shards"))
import made


@pytest.fixture
def folder(tmp_path, dataset_folder):
    return shutil.copytree(dataset_folder, tmp_path / "copy")


def test_a_whole_dataset_passes_and_is_counted(dataset_folder):
    calls = []
    summary = check(dataset_folder, lambda *done: calls.append(done))
    files = made.snapshot(dataset_folder)
    assert (summary.homes, summary.shards, summary.rows["rooms"]) == (10, 3, 20)
    assert summary.files == len([n for n in files if not n.startswith(("commits/", "dataset.json"))])
    assert calls == [(1, 3), (2, 3), (3, 3)]


def test_every_file_is_watched(folder):
    """Whichever file loses its end, gains a byte, changes one or goes: it is named."""
    for name, data in made.snapshot(folder).items():
        path = folder / name
        same_length = b"?" * len(data) if name.endswith("json") else data[:-1] + bytes([data[-1] ^ 1])
        for bad in (data[: len(data) // 2], data + b"x", same_length, None):
            path.unlink()
            if bad is not None:
                path.write_bytes(bad)
            with pytest.raises(DatasetError, match=path.stem):
                check(folder)
        path.write_bytes(data)
    assert check(folder).homes == 10


def test_any_flipped_bit_is_noticed(folder):
    """Of every kind of file: the header, the seal, commits, tables, stages, previews, the library's files and its table."""
    rng = random.Random(0)
    for name, data in made.snapshot(folder).items():
        tries = 40 if name in {"dataset.json", "commits/dataset.json"} else 4
        for place in [0, len(data) - 1, *(rng.randrange(len(data)) for _ in range(tries))]:
            flipped = data[:place] + bytes([data[place] ^ 1 << rng.randrange(8)]) + data[place + 1 :]
            (folder / name).unlink()  # the library's files have another name, in the cache
            (folder / name).write_bytes(flipped)
            with pytest.raises(DatasetError):
                check(folder)
        (folder / name).write_bytes(data)
    assert check(folder).homes == 10


def test_a_dataset_is_checked_at_an_address_as_in_a_folder(folder):
    fsspec = pytest.importorskip("fsspec")
    fsspec.filesystem("memory").put(str(folder), "/sets/checked", recursive=True)
    assert check("memory://sets/checked") == check(folder)
    fsspec.filesystem("memory").rm("/sets/checked/usd/shard-00001/s5_00000004.usdc")
    with pytest.raises(DatasetError, match=r"memory://sets/checked/usd/shard-00001/s5_00000004\.usdc is missing"):
        check("memory://sets/checked")


@pytest.mark.parametrize(
    "name",
    [
        "usd/shard-00000/extra.usdc",
        "scenes/shard-00003.parquet",
        "assets/asset_9/x",
        ".staging/x",
        ".parts/shard-00000/x",
        "commits/.tmp-1-x",
    ],
)
def test_a_stranger_is_named(folder, name):
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text("?")
    with pytest.raises(DatasetError, match=name.rsplit("/", 1)[1]):
        check(folder)


def test_files_at_the_top_are_the_users(folder):
    (folder / "README.md").write_text("about my dataset")
    assert check(folder).homes == 10


def rewritten(folder, table, number, change):
    """Change the rows of a table, and forge the commit so that only the rows are wrong."""
    path = folder / table / f"shard-{number:05d}.parquet"
    data = pq.read_table(path)
    rows = data.to_pylist()
    change(rows)
    pq.write_table(data.schema.empty_table().from_pylist(rows, schema=data.schema), path)
    commit = folder / "commits" / f"shard-{number:05d}.json"
    forged = json.loads(commit.read_text())
    forged["files"][f"{table}/{path.name}"] = {"sha256": sha256(path.read_bytes()), "bytes": path.stat().st_size}
    commit.write_text(json.dumps(forged))
    seal(folder, read_header(folder), folder.parent)


@pytest.mark.parametrize(
    ("table", "change", "word"),
    [
        ("rooms", lambda rows: rows.pop(), "rows, not"),
        ("scenes", lambda rows: rows[0].update(index=3), "does not hold the homes"),
        ("scenes", lambda rows: rows.reverse(), "does not hold the homes"),
        ("rejects", lambda rows: rows[0].update(what="index", where="s5_00000004"), "does not hold the homes"),
        ("rejects", lambda rows: rows[0].update(what="index", where="home four"), "names a home that cannot be"),
        ("rooms", lambda rows: rows[0].update(room_id="Room 0"), "not a valid id"),
        ("rooms", lambda rows: rows[1].update(room_id="room_0"), "stands twice"),
        ("objects", lambda rows: rows[0].update(room_id="room_7"), "'room_7' of s5_00000004 does not exist"),
        ("objects", lambda rows: rows[0].update(scene_id="s5_00000000"), "no home 's5_00000000'"),
        ("objects", lambda rows: rows[0].update(asset_id="asset_9"), "not in the library"),
        ("openings", lambda rows: rows[0].update(rooms=["room_0", "attic"]), "'attic'"),
        ("joints", lambda rows: rows[0].update(object_id="thing_77"), "'thing_77'"),
        ("scenes", lambda rows: rows[0].update(usd="/abs/x.usdc"), "not a file of the shard"),
        ("scenes", lambda rows: rows[0].update(usd="../x.usdc"), "not a file of the shard"),
        ("scenes", lambda rows: rows[0].update(usd_sha256="0" * 64), "not that of the file"),
    ],
)
def test_wrong_rows_are_named(folder, table, change, word):
    rewritten(folder, table, 1, change)
    with pytest.raises(DatasetError, match=word):
        check(folder)


def test_a_commit_that_points_outside_is_refused(folder):
    commit = folder / "commits" / "shard-00001.json"
    forged = json.loads(commit.read_text())
    forged["files"]["../../etc/passwd"] = {"sha256": "0", "bytes": 1}
    commit.write_text(json.dumps(forged))
    with pytest.raises(DatasetError, match="not a plain relative path"):
        check(folder)


def test_an_unfinished_dataset_is_named(tmp_path):
    made.fill(tmp_path / "set", numbers={0, 2})
    with pytest.raises(DatasetError, match="shard-00001"):
        check(tmp_path / "set")


def test_what_holds_no_dataset_is_named(tmp_path):
    for path in (tmp_path, tmp_path / "nothing"):
        with pytest.raises(DatasetError, match="is not a dataset"):
            check(path)
