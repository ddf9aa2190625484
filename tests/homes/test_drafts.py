"""Drafts on disk: in the order of homes, and some of them are read without the others."""

import pytest

from pipeline import tables
from pipeline.errors import ContentError
from pipeline.homes.drafts import DRAFT_TABLES, read_drafts, write_drafts
from pipeline.homes.request import Request
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


def filled(folder, parts=((0, 1), (2, 3), (4,))):
    write_drafts(folder, ((tuple(map(Request, part)), rows(*part)) for part in parts))


def snapshot(folder):
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_the_order_in_which_chunks_are_done_does_not_matter(tmp_path):
    filled(tmp_path / "one")
    filled(tmp_path / "other", parts=((4,), (2, 3), (0, 1)))
    assert snapshot(tmp_path / "one") == snapshot(tmp_path / "other")
    assert {name.split(".")[0] for name in snapshot(tmp_path / "one")} == {table.name for table in DRAFT_TABLES}


def test_some_homes_are_read_alone(tmp_path):
    filled(tmp_path)
    for indices in ((1,), (3, 4), ()):
        found = read_drafts(tmp_path, 3, indices)
        scenes = {scene_id(3, i) for i in indices}
        assert {row["scene_id"] for row in found["objects"]} == scenes
        assert {row["where"].split("/")[0] for row in found["rejects"]} == scenes
        assert found["rooms"] == [row for row in tables.read(tmp_path / "rooms.parquet", DRAFT_TABLES[1]) if row["scene_id"] in scenes]


def test_a_torn_table_is_named(tmp_path):
    filled(tmp_path)
    (tmp_path / "rooms.parquet").write_bytes(b"PAR1 and nothing")
    with pytest.raises(ContentError, match="is not a readable"):
        read_drafts(tmp_path, 3, [0])
