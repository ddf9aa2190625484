"""Rows and files of made-up homes, and a program that makes a dataset of them and can be told to wait where it shall be killed."""

import hashlib
import os
import sys
import time
from pathlib import Path

import pyarrow as pa

from pipeline.shards import EMPTY, TABLES, Header, add_part, commit_shard, gather, is_committed, open_or_create, scene_id
from schemas import ASSETS

HEADER = Header(seed=5, count=10, shard_size=4, licence="CC0-1.0", digests={"params": "p" * 64, "weights": "w" * 64})


def value(column, index):
    """A value of a column's type that depends on the home's index."""
    kind = column.type
    if column.nullable and index % 2:
        return None
    if pa.types.is_fixed_size_list(kind):
        return [0.25 * index] * kind.list_size
    if pa.types.is_list(kind):
        if pa.types.is_string(kind.value_type):
            return []
        return [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0 + index], [0.0, 3.0 + index]]
    if pa.types.is_boolean(kind):
        return bool(index % 2)
    if pa.types.is_integer(kind):
        return index
    if pa.types.is_floating(kind):
        return index / 2
    return ""


def row(table, home, base=5, /, **given):
    columns = {c.name: value(c, home) for c in TABLES[table].columns}
    if "scene_id" in columns:
        columns["scene_id"] = scene_id(base, home)
    return {**columns, **given}


def home(index, seed=5):
    """Rows and files of one home, as the factory hands them over."""
    name = scene_id(seed, index)
    split = ("train", "val", "test")[index % 3]
    program = '{"version": 1}' if index % 2 else ""
    rows = {
        "scenes": [
            row("scenes", index, seed, index=index, seed=seed, split=split, usd=f"usd/{name}.usdc", prompt=f"home {index}", program=program)
        ],
        "rooms": [row("rooms", index, seed, room_id=f"room_{i}", type=("bedroom", "kitchen")[i]) for i in range(2)],
        "openings": [
            row("openings", index, seed, opening_id="door_0", rooms=["room_0", "room_1"], kind="door", segment=[[1.0, 0.0], [1.9, 0.0]])
        ],
        "objects": [
            row(
                "objects",
                index,
                seed,
                object_id=f"thing_{i}",
                room_id=f"room_{i % 2}",
                asset_id=f"asset_{i % 2}",
                category=("double_bed", "oven")[i % 2],
            )
            for i in range(1 + index % 3)
        ],
        "joints": [row("joints", index, seed, object_id=o, joint_id="joint_0") for o in ("thing_0", "door_0")],
        "rejects": [row("rejects", index, seed, what="home", where=name, reason="too_crowded")] if index % 4 == 3 else [],
    }
    return rows, {f"usd/{name}.usdc": hashlib.sha256(name.encode()).digest() * 20, f"previews/{name}.png": name.encode()}


def empty(index, seed=5, reason="refused"):
    """What the factory hands over for a home that cannot be made."""
    return {"rejects": [{"what": EMPTY, "where": scene_id(seed, index), "reason": reason, "detail": "it cannot be"}]}, {}


class AssetSource:
    """Two assets in a folder of their own."""

    def __init__(self, folder):
        self.folder = Path(folder)

    def entry(self, asset_id):
        place = self.folder / asset_id
        if not place.exists():
            (place / "textures").mkdir(parents=True)
            (place / f"{asset_id}.usda").write_text(f"#usda 1.0 {asset_id}")
            (place / "textures" / "wood.png").write_bytes(asset_id.encode() * 10)
        return place

    def stock(self, asset_ids):
        for asset_id in asset_ids:
            self.entry(asset_id)

    def tables(self, asset_ids):
        return {ASSETS: [{**{c.name: value(c, 0) for c in ASSETS.columns}, "asset_id": a} for a in asset_ids]}


def opened(folder, header=HEADER, source=None, **how):
    return open_or_create(Path(folder), header, AssetSource(source or Path(folder).parent / "source"), **how)


def fill(folder, header=HEADER, stop=None, numbers=None, without=(), source=None, **how):
    """Make what is missing of a dataset (at home `stop` it waits for good); returns the numbers of the shards that were made."""
    with opened(folder, header, source, **how) as dataset:
        missing = [n for n in dataset.missing() if numbers is None or n in numbers]
        for number in missing:
            while not is_committed(dataset, number):
                for index in dataset.todo(number):
                    if dataset.take(number, index):
                        while index == stop:
                            time.sleep(1)
                        add_part(dataset, number, gather(number, *(empty if index in without else home)(index, header.seed)))
                commit_shard(dataset, number)
    return missing


def snapshot(folder):
    """Every file of a folder: its bytes by its relative path."""
    found = {}
    for place, _, names in os.walk(folder):
        within = os.path.relpath(place, folder)
        for name in names:
            found[name if within == "." else f"{within}/{name}"] = Path(place, name).read_bytes()
    return dict(sorted(found.items()))


if __name__ == "__main__":
    fill(sys.argv[1], Header(seed=5, count=24, shard_size=4, licence="CC0-1.0"), *map(int, sys.argv[2:]))
