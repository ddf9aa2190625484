"""What a file may cost: who exceeds it costs that file, and the rest is read by the same pool."""

import os
import resource
import signal

import pytest

from pipeline.sources.batch import Batch, each
from pipeline.sources.budget import MIB, Budget, OutOfTimeError, enforce
from pipeline.sources.registry import SOURCES
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.source import Reading
from tests.sources import making
from tests.sources.reading import WALKER

SPENT = {"out_of_time", "out_of_memory", "reader_died"}
SMALL = Budget(seconds=0.2, mebibytes=128)
LIMITS = (resource.RLIMIT_AS, resource.RLIMIT_CPU, resource.RLIMIT_CORE)


def step(common, item):
    """What a bad file can make a reader do."""
    if item == "spin":
        while True:
            pass
    if item == "swallow":
        while True:
            try:
                while True:
                    pass
            except Exception:  # noqa: BLE001 - a reader that takes everything for a fault of the file
                return "went on"
    if item == "hog":
        return len(bytearray(common * MIB))
    if item == "die":
        os._exit(1)
    if item == "deaf":  # as code that never comes back to Python
        signal.signal(signal.SIGPROF, signal.SIG_IGN)
        while True:
            pass
    return item


def refused(item, reason, _detail):
    return item, reason


@pytest.mark.parametrize("workers", [1, 2])
def test_each_bad_file_costs_itself_only(workers):
    items = ["a", "spin", "b", "hog", "c", "die", "d", "swallow", "e"]
    wanted = [
        "a",
        ("spin", "out_of_time"),
        "b",
        ("hog", "out_of_memory"),
        "c",
        ("die", "reader_died"),
        "d",
        ("swallow", "out_of_time"),
        "e",
    ]
    assert list(each(Batch("file", step, 4 * 128, items, refused), workers, SMALL)) == wanted


def test_who_hears_no_signal_is_ended_by_the_system():
    assert list(each(Batch("file", step, 1, ["a", "deaf", "b"], refused), 1, SMALL)) == ["a", ("deaf", "reader_died"), "b"]


def test_nothing_to_read():
    assert list(each(Batch("file", step, 1, [], refused), 2, SMALL)) == []


def test_limits_are_taken_back():
    before = [resource.getrlimit(kind) for kind in LIMITS], signal.getsignal(signal.SIGPROF)
    with pytest.raises(OutOfTimeError), enforce(Budget(seconds=0.5, mebibytes=512)):
        step(0, "spin")
    assert ([resource.getrlimit(kind) for kind in LIMITS], signal.getsignal(signal.SIGPROF)) == before


@pytest.mark.parametrize(("budget", "reason"), [(Budget(seconds=0.004), "out_of_time"), (Budget(mebibytes=1), "out_of_memory")])
def test_real_readers_within_a_budget(tmp_path, budget, reason):
    """Of every source: a model, an object and a house."""
    making.write_library(tmp_path / "front", (making.BED,))
    house = making.two_rooms()
    house["furniture"] = house["furniture"] * 2000  # read for long enough: the clock of a budget ticks every few milliseconds
    making.write_house(tmp_path / "front", house)
    making.write_partnet(tmp_path / "partnet")
    rejects = []
    for source in SOURCES[:2]:
        settings = PreprocessSettings(budget=budget)
        listing = source.list(tmp_path / source.key, settings)
        reading = Reading(settings, "CC0-1.0", tmp_path / "assets", WALKER, 1)
        for made in source.models(listing, reading):
            rejects += made.rejects
            empty = made
        for house in source.houses(listing, reading, empty):
            rejects += house.rejects
    assert {(r["what"], r["where"]) for r in rejects if r["reason"] == reason} == {
        ("model", making.BED),
        ("model", "40000"),
        ("house", "house-a"),
    }
