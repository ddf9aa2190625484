"""Drafts on disk: a killed run goes on, the tables are the same, and some homes are read without the others."""

import pytest

from pipeline import tables
from pipeline.errors import ContentError
from pipeline.homes.draft_store import DRAFT_TABLES, DraftStore, read_drafts
from pipeline.shards import scene_id

VALUES = {"string": "", "double": 0.5, "float": 0.5, "bool": True}


def value(column):
    if column.nullable:
        return None
    kind = str(column.type)
    if "list" in kind:
        return [0.0] * getattr(column.type, "list_size", 0)
    return VALUES.get(kind, 1)


def rows(*indices):
    made = {}
    for table in DRAFT_TABLES:
        blank = {c.name: value(c) for c in table.columns}
        key = "where" if table.name == "rejects" else "scene_id"
        tail = "/room_0#0" if key == "where" else ""
        made[table.name] = [{**blank, key: scene_id(3, i) + tail} for i in indices for _ in range(1 + i % 2)]
    return made


def filled(folder, made_of="a" * 64, parts=((0, 1), (2, 3), (4,))):
    store = DraftStore(folder, made_of)
    for part in parts:
        if not store.has(part[0]):
            store.put(part[0], rows(*part), {"plan": 0.5, "sample": 1.0})
    return store


def snapshot(folder):
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_a_killed_run_goes_on_to_the_same_tables(tmp_path):
    whole = filled(tmp_path / "whole")
    assert whole.seconds() == {"plan": 1.5, "sample": 3.0}
    whole.join()
    filled(tmp_path / "cut", parts=((2, 3),))
    again = DraftStore(tmp_path / "cut", "a" * 64)
    assert [again.has(first) for first in (0, 2, 4)] == [False, True, False]
    filled(tmp_path / "cut").join()
    assert snapshot(tmp_path / "whole") == snapshot(tmp_path / "cut")
    assert {name.split(".")[0] for name in snapshot(tmp_path / "cut")} == {table.name for table in DRAFT_TABLES}


def test_a_part_that_was_being_written_is_none(tmp_path):
    filled(tmp_path, parts=((0, 1),))
    (place,) = tmp_path.glob(".parts/*/00000000")
    place.rename(place.with_name("00000000.new"))
    assert not DraftStore(tmp_path, "a" * 64).has(0)
    filled(tmp_path).join()
    assert len(tables.read(tmp_path / "scenes.parquet", DRAFT_TABLES[0])) == 7


def test_parts_of_other_code_or_parameters_are_not_used(tmp_path):
    filled(tmp_path)
    assert not DraftStore(tmp_path, "b" * 64).has(0)
    assert not DraftStore(tmp_path, "a" * 64).has(0)


def test_some_homes_are_read_alone(tmp_path):
    filled(tmp_path).join()
    for indices in ((1,), (3, 4), ()):
        found = read_drafts(tmp_path, 3, indices)
        scenes = {scene_id(3, i) for i in indices}
        assert {row["scene_id"] for row in found["objects"]} == scenes
        assert {row["where"].split("/")[0] for row in found["rejects"]} == scenes
        assert found["rooms"] == [row for row in tables.read(tmp_path / "rooms.parquet", DRAFT_TABLES[1]) if row["scene_id"] in scenes]


def test_a_torn_table_is_named(tmp_path):
    filled(tmp_path).join()
    (tmp_path / "rooms.parquet").write_bytes(b"PAR1 and nothing")
    with pytest.raises(ContentError, match="is not a readable"):
        read_drafts(tmp_path, 3, [0])
