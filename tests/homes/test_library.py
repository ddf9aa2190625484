"""What stays in memory of a library: assets up to a bound of bytes, those that were asked for last; and what was derived from them."""

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


def test_the_asset_that_was_not_asked_for_the_longest_goes(library):
    first = library["a"]
    library["b"]
    assert library["a"] is first
    library["c"]
    assert library["a"] is first
    again = library["b"]
    library["c"]
    assert library["b"] is again
    assert library["a"] is not first
    assert np.array_equal(library["a"].links[0].visuals[0].vertices, first.links[0].visuals[0].vertices)


def test_what_was_derived_from_an_asset_outlives_its_meshes(library):
    shape = solid(library["a"])
    meshes = weakref.ref(library["a"].links[0].visuals[0].vertices)
    library["b"], library["c"]
    gc.collect()
    assert meshes() is None
    assert solid(library["a"]) is shape


def test_the_finish_is_read_once(library, monkeypatch):
    found = library.finish("a")
    monkeypatch.setattr(type(library), "__getitem__", lambda *_: pytest.fail("read again"))
    assert library.finish("a") is found


def test_more_memory_keeps_more():
    assert kept_within(100) == kept_within(0) > 0
    assert kept_within(2000) - kept_within(1000) > 500 << 20
