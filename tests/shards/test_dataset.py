"""Datasets on disk: whole or not at all, resumed when equal, refused when not, never rewritten."""

import json
import os
import shutil
from dataclasses import replace
from pathlib import Path

import made
import pytest

from pipeline.errors import ContentError, UsageError
from pipeline.shards import Header, add_part, commit_shard, is_committed, read_header
from pipeline.shards import dataset as dataset_module
from sfgen.check import check
from sfgen.place import DatasetError


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "set"


def test_same_homes_same_bytes_in_any_order(tmp_path):
    made.fill(tmp_path / "a")
    for number in (2, 0, 1):
        made.fill(tmp_path / "b", numbers={number})
    assert made.snapshot(tmp_path / "a") == made.snapshot(tmp_path / "b")


def test_layout_is_that_of_the_documentation(dataset_folder):
    names = set(made.snapshot(dataset_folder))
    assert {
        "dataset.json",
        "commits/assets.json",
        "commits/shard-00002.json",
        "scenes/shard-00001.parquet",
        "rejects/shard-00000.parquet",
    } <= names
    assert "usd/shard-00001/s5_00000004.usdc" in names
    assert not [n for n in names if "tmp" in n or "staging" in n]


def test_nothing_in_a_dataset_tells_where_or_when_it_was_made(dataset_folder):
    everything = b"".join(made.snapshot(dataset_folder).values())
    assert str(dataset_folder).encode() not in everything
    assert os.uname().nodename.encode() not in everything


def test_header_round_trips(dataset_folder):
    assert read_header(dataset_folder) == made.HEADER


def test_an_equal_dataset_is_resumed_and_committed_shards_stay(folder):
    made.fill(folder, numbers={1})
    before = {p: (p.stat().st_mtime_ns, p.stat().st_ino) for p in folder.rglob("*shard-00001*")}
    assert made.fill(folder) == [0, 2]
    assert made.fill(folder) == []
    assert {p: (p.stat().st_mtime_ns, p.stat().st_ino) for p in before} == before


def test_full_shards_may_grow(tmp_path):
    made.fill(tmp_path / "a", replace(made.HEADER, count=8))
    assert made.fill(tmp_path / "a", made.HEADER) == [2]
    made.fill(tmp_path / "b", made.HEADER)
    assert made.snapshot(tmp_path / "a") == made.snapshot(tmp_path / "b")


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"seed": 6}, "seed 5, not 6"),
        ({"count": 9}, "count 10, not 9"),
        ({"count": 12}, "not full"),
        ({"licence": "MIT"}, "licence"),
        ({"digests": {"params": "p" * 64, "weights": "x" * 64}}, "digest of weights wwwwwwwwwwww, not xxxxxxxxxxxx"),
    ],
)
def test_another_dataset_is_refused_and_left_alone(folder, change, word):
    made.fill(folder)
    before = made.snapshot(folder)
    with pytest.raises(UsageError, match=word):
        made.fill(folder, replace(made.HEADER, **change))
    assert made.snapshot(folder) == before


def test_a_folder_that_dvc_owns_may_discard(folder):
    made.fill(folder)
    (folder / "notes.txt").write_text("mine")
    other = replace(made.HEADER, seed=6, count=4)
    with made.opened(folder, other, discard=True) as dataset:
        assert dataset.missing() == [0]
        for index in range(4):
            add_part(dataset, 0, made.gather(0, *made.home(index, 6)))
        commit_shard(dataset, 0)
    assert check(folder).homes == 4
    assert (folder / "notes.txt").read_text() == "mine"


def test_a_folder_with_other_files_is_refused_and_left_alone(folder):
    folder.mkdir()
    (folder / "thesis.tex").write_text("precious")
    with pytest.raises(UsageError, match="other files"):
        made.fill(folder)
    assert made.snapshot(folder) == {"thesis.tex": b"precious"}


def test_a_file_in_the_place_of_the_folder_is_refused(folder):
    folder.write_text("precious")
    with pytest.raises(UsageError, match="not a folder"):
        made.fill(folder)
    with pytest.raises(UsageError, match="cannot make"):
        made.fill(folder / "below")
    assert folder.read_text() == "precious"


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", '{"format": "sfgen-dataset-3"}'])
def test_a_broken_header_is_named_and_that_of_a_whole_dataset_made_again(folder, dataset_folder, text):
    made.fill(folder)
    (folder / "dataset.json").write_text(text)
    made.fill(folder)
    assert made.snapshot(folder) == made.snapshot(dataset_folder)
    (folder / "commits" / "dataset.json").unlink()  # which knows what it was
    (folder / "dataset.json").write_text(text)
    with pytest.raises(ContentError, match=r"dataset\.json"):
        made.fill(folder)


def test_impossible_numbers_in_a_header_are_named(folder):
    made.fill(folder)
    (folder / "commits" / "dataset.json").unlink()
    data = json.loads((folder / "dataset.json").read_text())
    (folder / "dataset.json").write_text(json.dumps({**data, "shard_size": 0}))
    with pytest.raises(ContentError, match="cannot be"):
        made.fill(folder)


def test_another_dataset_does_not_wipe_one_that_is_being_written(folder):
    with (
        made.opened(folder),
        pytest.raises(UsageError, match="another run"),
        made.opened(folder, replace(made.HEADER, seed=6), discard=True),
    ):
        pass
    made.fill(folder)


def test_leftovers_of_a_killed_run_are_cleaned(folder, dataset_folder):
    made.fill(folder)
    (folder / "commits" / "shard-00001.json").unlink()  # killed between the last rename and the commit
    (folder / "usd" / "shard-00001" / "stray.usdc").write_text("half")
    (folder / ".staging" / "shard-00002").mkdir(parents=True)
    (folder / ".staging" / "shard-00002" / "half").write_text("half")
    assert made.fill(folder) == [1]
    assert made.snapshot(folder) == made.snapshot(dataset_folder)


def test_a_shard_that_lost_a_file_is_made_again(folder, dataset_folder):
    made.fill(folder)
    (folder / "objects" / "shard-00000.parquet").unlink()
    assert made.fill(folder) == [0]
    assert made.snapshot(folder) == made.snapshot(dataset_folder)


def test_parts_may_come_in_any_order(tmp_path):
    made.fill(tmp_path / "a")
    with made.opened(tmp_path / "c") as dataset:
        for index in (2, 3, 1, 0, 1):
            add_part(dataset, 0, made.gather(0, *made.home(index)))
        commit_shard(dataset, 0)
    names = [n for n in made.snapshot(tmp_path / "c") if "shard-00000" in n]
    assert {n: (tmp_path / "a" / n).read_bytes() for n in names} == {n: (tmp_path / "c" / n).read_bytes() for n in names}


def test_homes_that_were_made_before_a_kill_are_kept(folder, dataset_folder):
    with made.opened(folder) as dataset:
        for index in (4, 5, 7):
            add_part(dataset, 1, made.gather(1, *made.home(index)))
    with pytest.raises(DatasetError, match="shard-00000"):
        check(folder)
    with made.opened(folder) as dataset:
        assert dataset.todo(1) == [6]
        assert dataset.todo(0) == [0, 1, 2, 3]
    torn = folder / ".parts" / "shard-00001" / "00000004" / "files" / "usd" / "shard-00001" / "s5_00000004.usdc"
    torn.write_bytes(bytes(len(torn.read_bytes())))  # what a power cut leaves
    with made.opened(folder) as dataset:
        add_part(dataset, 1, made.gather(1, *made.home(6)))
        assert not commit_shard(dataset, 1)
        assert dataset.todo(1) == [4]
    made.fill(folder)
    assert made.snapshot(folder) == made.snapshot(dataset_folder)


def test_an_index_may_stay_empty_with_its_reason(folder):
    made.fill(folder, without={1, 4, 5, 6, 7})
    summary = check(folder)
    assert (summary.homes, summary.empty, summary.rows["scenes"]) == (5, 5, 5)
    assert made.fill(folder, without=()) == []  # resumed, it is not tried again


def test_the_library_holds_what_the_homes_use_and_shares_its_files(folder):
    made.fill(folder, replace(made.HEADER, count=4), without={1, 2, 3})  # home 0 has one thing
    assert sorted(p.name for p in (folder / "assets").iterdir()) == ["asset_0", "assets.parquet"]
    made.fill(folder, replace(made.HEADER, count=8))
    assert sorted(p.name for p in (folder / "assets").iterdir()) == ["asset_0", "asset_1", "assets.parquet"]
    shared = Path("asset_1/textures/wood.png")
    assert (folder / "assets" / shared).stat().st_ino == (folder.parent / "source" / shared).stat().st_ino
    assert check(folder).homes == 5


def test_a_library_that_lost_a_file_is_made_again(folder, dataset_folder):
    made.fill(folder)
    shutil.rmtree(folder / "assets" / "asset_1")
    made.fill(folder)
    assert made.snapshot(folder) == made.snapshot(dataset_folder)


def test_a_committed_shard_is_never_rewritten(folder):
    made.fill(folder)
    before = {p: p.stat().st_ino for p in folder.rglob("*shard-00000*")}
    with made.opened(folder) as dataset:
        assert is_committed(dataset, 0)
        assert commit_shard(dataset, 0)
    assert {p: p.stat().st_ino for p in before} == before


def test_a_shard_that_lacks_homes_is_not_committed(folder):
    with made.opened(folder) as dataset:
        add_part(dataset, 0, made.gather(0, *made.home(2)))
        assert not commit_shard(dataset, 0)
        assert not is_committed(dataset, 0)
        assert dataset.todo(0) == [0, 1, 3]


@pytest.mark.parametrize("numbers", [{"count": 0}, {"count": -5}, {"shard_size": 0}])
def test_a_dataset_of_nothing_is_refused(folder, numbers):
    with pytest.raises(UsageError):
        made.fill(folder, replace(made.HEADER, **numbers))
    assert not folder.exists()


def test_shards_of_a_header():
    header = Header(0, 130, 64, "x")
    assert [len(header.indices(n)) for n in range(header.shards)] == [64, 64, 2]


def test_a_dataset_that_another_command_begins_just_now_is_joined(folder, monkeypatch):
    folder.mkdir()
    look = Path.iterdir

    def begins_first(place):
        if place == folder:
            monkeypatch.undo()
            with made.opened(folder):
                pass
        return look(place)

    monkeypatch.setattr(Path, "iterdir", begins_first)
    assert made.fill(folder) == [0, 1, 2]


def test_a_shard_that_another_command_commits_just_now_is_not_missed(folder, monkeypatch):
    with made.opened(folder) as one, made.opened(folder) as other:
        for index in range(4):
            add_part(one, 0, made.gather(0, *made.home(index)))
        look = dataset_module.parts_there

        def commits_first(*place):
            monkeypatch.undo()
            assert commit_shard(other, 0)
            return look(*place)

        monkeypatch.setattr(dataset_module, "parts_there", commits_first)
        assert commit_shard(one, 0)


@pytest.mark.parametrize("late", ["before it reads them", "after"])
def test_who_was_given_up_while_it_committed_spoils_nothing(folder, dataset_folder, monkeypatch, late):
    """A command that was suspended for long: another takes over, commits and removes the parts that the first still reads."""
    with made.opened(folder) as one, made.opened(folder) as other:
        for index in range(4):
            add_part(one, 0, made.gather(0, *made.home(index)))
        join = dataset_module.join

        def suspended(parts):
            rows = join(parts) if late == "after" else {}
            monkeypatch.undo()
            (folder / ".claims" / "owners" / one.claims.token).unlink()
            assert commit_shard(other, 0)
            return rows or join(parts)

        monkeypatch.setattr(dataset_module, "join", suspended)
        assert commit_shard(one, 0)
    made.fill(folder)
    assert made.snapshot(folder) == made.snapshot(dataset_folder)
