"""What stays in memory of a library: assets up to a bound of bytes, those that were asked for last; and what was derived from them."""

import dataclasses
import gc
import weakref

import numpy as np
import pytest

from pipeline.geometry.prisms import solid
from pipeline.homes.library import kept_within
from tests.geometry import furniture
from tests.homes.conftest import library_of

NAMES = ("a", "b", "c")


@pytest.fixture
def library(tmp_path):
    made = library_of(tmp_path, [furniture.cupboard(name) for name in NAMES])
    made.kept = 2 * max(path.stat().st_size for path in tmp_path.iterdir())
    return made


def test_meshes_that_were_not_looked_at_the_longest_go(library):
    kept = {name: weakref.ref(library[name].links[0].visuals[0].vertices) for name in "ab"}
    assert library["a"].links[0].visuals[0].vertices is kept["a"]()
    assert library["c"].links
    gc.collect()
    assert [kept[name]() is None for name in "ab"] == [False, True]
    assert library["b"] is library["b"]
    assert np.array_equal(library["b"].links[0].visuals[0].vertices, furniture.cupboard("b").links[0].visuals[0].vertices)


def test_what_was_derived_from_an_asset_outlives_its_meshes(library, monkeypatch):
    shape = solid(library["a"])
    assert library["b"].links
    assert library["c"].links
    monkeypatch.setattr(type(library), "_read", lambda *_: pytest.fail("read again"))
    assert solid(library["a"]) is shape


def test_textures_are_read_when_they_are_asked_for(tmp_path):
    made = library_of(tmp_path, [dataclasses.replace(furniture.cupboard("a"), textures={"wood.png": b"grain"})])
    assert dict(made["a"].textures) == {"wood.png": b"grain"}


def test_more_memory_keeps_more():
    assert kept_within(100) == kept_within(0) > 0
    assert kept_within(2000) - kept_within(1000) > 500 << 20
