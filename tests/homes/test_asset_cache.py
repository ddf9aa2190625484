import os
import time
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import pytest

from pipeline.homes import asset_cache
from pipeline.homes.asset_cache import AssetCache, make_room, whole


class Library(SimpleNamespace):
    def __getitem__(self, asset_id):
        return asset_id


@pytest.fixture
def written(monkeypatch):
    """Assets in the order in which they were written, slowly enough for others to come between."""
    found = []

    def write(asset, folder):
        folder.mkdir(parents=True)
        time.sleep(0.05)
        (folder / f"{asset}.usda").write_text(f"#usda 1.0 {asset}")
        found.append(asset)

    monkeypatch.setattr(asset_cache, "write_asset", write)
    return found


@pytest.fixture
def cached(tmp_path):
    names = ("chair", "table")
    return AssetCache(Library(rows={a: {"sha256": a * 16} for a in names}, joints=[]), tmp_path)


def test_of_all_that_want_an_asset_at_once_one_writes_it(written, cached):
    with ThreadPoolExecutor(8) as pool:
        places = list(pool.map(cached.entry, ["chair", "table"] * 8))
    assert sorted(written) == ["chair", "table"]
    assert len(set(places)) == 2
    assert all((place / f"{name}.usda").is_file() for place, name in zip(places, ["chair", "table"] * 8, strict=True))
    assert not list(cached.folder.glob(".tmp-*"))


def test_what_is_broken_is_written_anew_and_what_is_whole_is_not(written, cached):
    place = cached.entry("chair")
    assert whole(place, place.with_suffix(".json"))
    assert (place / "chair.usda").stat().st_mode & 0o222 == 0
    cached.entry("chair")
    assert written == ["chair"]
    (place / "chair.usda").chmod(0o644)
    (place / "chair.usda").write_text("something else")
    assert not whole(place, place.with_suffix(".json"))
    assert (cached.entry("chair") / "chair.usda").read_text() == "#usda 1.0 chair"
    assert written == ["chair", "chair"]


def test_what_was_stocked_is_looked_at_once(written, cached, monkeypatch):
    looked = []
    monkeypatch.setattr(cached, "entry", looked.append)
    cached.stock(["table", "chair", "table"])
    cached.stock(["chair"])
    assert looked == ["chair", "table"]


def test_the_oldest_versions_make_room(tmp_path):
    for k, name in enumerate(("old", "older", "new")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "file").write_bytes(bytes(100))

        os.utime(tmp_path / name, (k != 1, 10 - 5 * (k == 1)))
    make_room(tmp_path / "new", 250)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["new", "old"]
