"""A dataset is filled by workers: the same bytes whatever their number, and what kills or stops them costs one home."""

import errno
import functools
import json
import os
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
import papers

from pipeline.errors import ContentError
from pipeline.execution import Progress
from pipeline.homes.production import FAILURES, Chunk, Recipe, fill, make_chunk
from pipeline.shards import forget_altered, open_or_create, scene_id, shard_name
from sfgen.check import check

ROOT = Path(__file__).parents[2]


def filled(folder, workers=1, scheduler=None, **asked):
    """Fill a dataset with made-up homes; returns the tally."""
    recipe = Recipe(functools.partial(papers.open_paper, str(folder.parent), **asked))
    with open_or_create(folder, papers.HEADER, papers.made.AssetSource(folder.parent / "cache")) as dataset:
        return fill(
            dataset,
            recipe,
            papers.request,
            workers=workers,
            scheduler=scheduler,
            progress=Progress(10, "homes", voice="quiet"),
            again="again {index}",
        )


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """The files of the ten homes, made by one process that nobody disturbs."""
    folder = tmp_path_factory.mktemp("undisturbed") / "set"
    filled(folder)
    return papers.made.snapshot(folder)


def test_one_and_two_workers_and_a_resumed_run_give_the_same_bytes(tmp_path, undisturbed):
    tally = filled(tmp_path / "two", workers=2)
    assert (tally.homes, tally.resumed, tally.empty) == (10, 0, {})
    assert papers.made.snapshot(tmp_path / "two") == undisturbed
    shutil.rmtree(tmp_path / "two" / "usd")
    again = filled(tmp_path / "two", workers=2)
    assert (again.homes, again.resumed) == (10, 0)
    assert papers.made.snapshot(tmp_path / "two") == undisturbed


def test_a_cluster_gives_the_same_bytes_and_loses_the_same_home(tmp_path, undisturbed):
    import dask
    from distributed import LocalCluster

    patience = dask.config.set({"distributed.scheduler.allowed-failures": 0})  # of the scheduler itself; every restart takes seconds
    with (
        patience,
        LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs="CRITICAL") as cluster,
    ):
        filled(tmp_path / "cluster", scheduler=cluster.scheduler_address)
        assert papers.made.snapshot(tmp_path / "cluster") == undisturbed
        tally = filled(tmp_path / "lost", scheduler=cluster.scheduler_address, die=6)
    assert (tally.homes, list(tally.empty)) == (9, ["worker_lost"])


def test_workers_that_are_killed_now_and_then_change_nothing(tmp_path, undisturbed):
    tally = filled(tmp_path / "killed", workers=2, die_once=(1, 6))
    assert (tally.homes, tally.empty) == (10, {})
    assert (tmp_path / "died-1").exists()
    assert (tmp_path / "died-6").exists()
    assert papers.made.snapshot(tmp_path / "killed") == undisturbed


@pytest.mark.parametrize(("culprit", "word"), [("die", "3 workers died at it"), ("hang", "3 workers kept silent")])
def test_the_home_that_costs_three_workers_is_recorded_and_the_rest_is_made(tmp_path, culprit, word):
    tally = filled(tmp_path / "set", workers=2, **{culprit: 6})
    assert (tally.homes, list(tally.empty)) == (9, ["worker_lost"])
    ((scene, detail),) = tally.empty["worker_lost"]
    assert scene == "s5_00000006"
    assert word in detail
    assert check(tmp_path / "set").empty == 1
    assert filled(tmp_path / "set").empty == tally.empty  # another run neither repeats nor forgets it


def test_a_shard_that_takes_too_long_leaves_its_other_homes_empty_and_repair_may_try_them_again(tmp_path):
    header = replace(papers.HEADER, shard_size=8)  # shards of 8 and 2 homes; a chunk is 4, and says that it took a second

    def run(limit):
        recipe = Recipe(functools.partial(papers.open_paper, str(tmp_path), shard_seconds=limit))
        with open_or_create(tmp_path / "set", header, papers.made.AssetSource(tmp_path / "cache")) as dataset:
            forgotten = forget_altered(dataset, FAILURES) if limit > 1 else []
            return forgotten, fill(dataset, recipe, papers.request, progress=Progress(10, "homes", voice="quiet"))

    (_, tally), shard = run(0.1), shard_name(0)
    late = [scene_id(header.seed, index) for index in range(4, 8)]
    assert (tally.homes, [scene for scene, _ in tally.empty["shard_deadline"]]) == (6, late)
    assert check(tmp_path / "set").empty == 4
    assert run(0.1)[1].empty == tally.empty  # another run neither repeats nor forgets them
    forgotten, again = run(2.0)
    assert (forgotten, again.homes, again.empty) == ([shard], 8, {})


def test_an_unknown_error_costs_one_home_and_a_full_disk_the_run(tmp_path, monkeypatch):
    tally = filled(tmp_path / "set", stumble=(3,))
    assert (tally.homes, list(tally.empty)) == (9, ["internal"])
    monkeypatch.setattr(shutil, "disk_usage", lambda _: shutil._ntuple_diskusage(1, 1, 0))
    with pytest.raises(OSError, match="No space") as caught:
        filled(tmp_path / "full", stumble=(3,))
    assert caught.value.errno == errno.ENOSPC


def command(folder, count, workers=1, **asked):
    """Start a command that fills a dataset, as a program."""
    program = [sys.executable, str(Path(__file__).parent / "papers.py"), str(folder), json.dumps(asked), str(workers), str(count)]
    return subprocess.Popen(program, env={**os.environ, "PYTHONPATH": str(ROOT)}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def await_homes(folder, run):
    """Wait until a command that cannot come to its end has made some homes."""
    end = time.monotonic() + 300
    while not [*folder.glob(".parts/*/*"), *folder.glob("commits/shard-*.json")]:
        assert time.monotonic() < end
        assert run.poll() is None
        time.sleep(0.01)


def test_a_run_that_is_killed_keeps_the_chunks_that_were_done(tmp_path, undisturbed):
    run = command(tmp_path / "cut", 10, workers=2, stop=9)
    await_homes(tmp_path / "cut", run)
    run.kill()
    run.wait()
    tally = filled(tmp_path / "cut", workers=1)
    assert tally.resumed >= 1
    assert tally.homes == 10 - tally.resumed
    assert papers.made.snapshot(tmp_path / "cut") == undisturbed


def test_a_worker_with_other_weights_loads_them_again_or_refuses(tmp_path):
    opened = functools.lru_cache(functools.partial(papers.open_paper, str(tmp_path)))
    request = (papers.request(0),)
    (tmp_path / "weights").write_text("new")
    assert make_chunk(Recipe(opened, digests={"weights": "new"}), Chunk(0, request)).homes
    with pytest.raises(ContentError, match="other weights than the command"):
        make_chunk(Recipe(opened, digests={"weights": "newer"}), Chunk(0, request))
    with pytest.raises(ContentError, match="other code"):
        make_chunk(Recipe(opened, digests={"code": "x"}), Chunk(0, request))
    with pytest.raises(ContentError, match="not abacus"):
        make_chunk(Recipe(opened, versions={"instructions": "abacus"}), Chunk(0, request))


def test_several_commands_share_one_dataset_and_each_home_is_made_once(tmp_path):
    """Three commands, one of them with processes of its own, each of which gets work, whoever comes first."""
    (tmp_path / "alone").mkdir()
    assert command(tmp_path / "alone" / "set", 40).wait() == 0
    runs = [command(tmp_path / "set", 40, workers, crowd=3, shard_seconds=300.0) for workers in (1, 2, 1)]
    assert [run.wait(timeout=600) for run in runs] == [0, 0, 0]
    lines = [line.split() for line in (tmp_path / "made.txt").read_text().splitlines()]
    assert sorted(int(index) for index, _ in lines) == list(range(40))
    assert {int(who) for _, who in lines} == {run.pid for run in runs}
    assert papers.made.snapshot(tmp_path / "set") == papers.made.snapshot(tmp_path / "alone" / "set")


def test_what_a_killed_command_had_claimed_is_made_by_the_others(tmp_path):
    """On one machine it is seen at once that a process is gone: these commands never give up one that is only silent."""
    (tmp_path / "alone").mkdir()
    assert command(tmp_path / "alone" / "set", 24).wait() == 0
    killed, other = (
        command(tmp_path / "set", 24, crowd=2, stop="first", shard_seconds=300.0),
        command(tmp_path / "set", 24, crowd=2, shard_seconds=300.0),
    )
    await_homes(tmp_path / "set", other)
    killed.kill()
    killed.wait()
    assert other.wait(timeout=600) == 0
    assert papers.made.snapshot(tmp_path / "set") == papers.made.snapshot(tmp_path / "alone" / "set")
