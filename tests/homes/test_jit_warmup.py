"""What homes run is compiled once on a machine, in a process of its own."""

from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest

from pipeline.execution import Progress
from pipeline.geometry import compiled
from pipeline.homes.jit_warmup import SAMPLES, WHOLE, warm_up_workers

ROOT = Path(__file__).resolve().parents[2]


def opened(record, *, broken):
    def make(requests):
        with record.open("a") as file:
            file.write(f"{len(requests)}\n")
        if broken:
            raise MemoryError

    return SimpleNamespace(make=make)


@pytest.fixture
def cache(monkeypatch, tmp_path):
    monkeypatch.setattr(compiled.CONFIG, "CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_homes_are_made_for_it_once(cache, tmp_path):
    record = tmp_path / "made"
    for _ in range(2):
        warm_up_workers(Progress(1, "homes"), ROOT, partial(opened, record, broken=False), 2)
    assert record.read_text() == f"{SAMPLES}\n"
    assert (cache / WHOLE).exists()


def test_where_that_fails_it_is_tried_again_and_the_run_goes_on(cache, tmp_path):
    record = tmp_path / "made"
    for _ in range(2):
        warm_up_workers(Progress(1, "homes"), ROOT, partial(opened, record, broken=True), 2)
    assert record.read_text() == 2 * f"{SAMPLES}\n"
    assert not (cache / WHOLE).exists()


def test_where_nothing_can_be_kept_nothing_is_compiled_ahead(monkeypatch, tmp_path):
    monkeypatch.setattr(compiled.CONFIG, "CACHE_DIR", str(tmp_path / "file" / "cache"))
    (tmp_path / "file").write_text("no folder")
    warm_up_workers(Progress(1, "homes"), ROOT, partial(opened, tmp_path / "made", broken=False), 2)
    assert not (tmp_path / "made").exists()
