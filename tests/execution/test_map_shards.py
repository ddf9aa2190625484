"""map_shards: every mode gives the same results, errors come through, dead workers and Ctrl-C leave nothing behind."""

import functools
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pipeline.errors import ContentError, UsageError
from pipeline.execution import map_shards, single_thread, track

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(Path(__file__).parent))  # where Dask's workers find the steps
import work  # noqa: E402


def test_serial_and_cluster_agree():
    jobs = [(i, i + 10) for i in range(9)]
    wanted = {i: job * job for i, job in jobs}
    assert dict(map_shards(work.square, jobs)) == wanted
    assert dict(map_shards(work.square, iter(jobs), workers=2, digest="d")) == wanted


def test_two_clusters_on_a_machine_are_quiet(recwarn, capfd):
    first = map_shards(work.square, enumerate(range(2)), workers=2)
    next(first)
    assert dict(map_shards(work.square, enumerate(range(2)), workers=2)) == {0: 0, 1: 1}
    first.close()
    assert [str(w.message) for w in recwarn] == []
    assert capfd.readouterr() == ("", "")


def test_jobs_are_drawn_as_needed():
    drawn = []

    def jobs():
        for i in range(1000):
            drawn.append(i)
            yield i, i

    for _ in zip(range(5), map_shards(work.square, jobs(), workers=2), strict=False):
        pass
    assert len(drawn) < 50


def test_workers_compute_with_one_thread():
    answers = [r for _, r in map_shards(work.threads, enumerate(range(4)), workers=2)]
    assert {(env, count) for _, env, count in answers} == {("1", 1)}
    assert os.getpid() not in {pid for pid, _, _ in answers}


def test_this_process_computes_with_one_thread():
    import torch

    torch.set_num_threads(2)
    single_thread()
    assert torch.get_num_threads() == 1


@pytest.mark.parametrize("workers", [1, 2])
def test_our_errors_come_through_whole(workers):
    with pytest.raises(ContentError) as caught:
        list(map_shards(work.refuse_third, enumerate(range(6)), workers=workers))
    assert (caught.value.message, caught.value.remedy) == ("the third shard is bad", "leave it out")


def test_other_errors_are_retried_then_raised(tmp_path):
    with pytest.raises(OSError, match="hiccups"):
        list(map_shards(functools.partial(work.count_and_raise, str(tmp_path)), [(0, 0)], workers=2))
    assert len(list(tmp_path.iterdir())) == 3


def test_a_killed_worker_costs_nothing(tmp_path):
    results = dict(map_shards(functools.partial(work.die_once, str(tmp_path)), enumerate(range(6)), workers=2))
    assert results == {i: i for i in range(6)}
    assert (tmp_path / "died-2").exists()


def test_a_shard_that_kills_its_workers_is_named():
    with pytest.raises(ContentError, match="shard 7 killed its worker"):
        list(map_shards(work.die_always, [(7, 0)], workers=2))


def test_a_named_scheduler_is_used():
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs="ERROR") as cluster:
        assert dict(map_shards(work.square, enumerate(range(5)), scheduler=cluster.scheduler_address)) == {i: i * i for i in range(5)}


@pytest.mark.parametrize("scheduler", ["nowhere.json", "tcp://127.0.0.1:9", "gopher://x"])
def test_a_scheduler_that_does_not_answer_is_the_users_error(scheduler, monkeypatch):
    monkeypatch.setattr("pipeline.execution.PATIENCE", "1s")
    with pytest.raises(UsageError, match="scheduler"):
        list(map_shards(work.square, [(0, 0)], scheduler=scheduler))


def test_interrupt_ends_all_workers(tmp_path):
    program = [sys.executable, str(Path(__file__).parent / "work.py"), str(tmp_path)]
    run = subprocess.Popen(program, env={**os.environ, "PYTHONPATH": str(ROOT)}, start_new_session=True, stderr=subprocess.PIPE, text=True)
    pids = await_pids(tmp_path, 2)
    os.killpg(run.pid, signal.SIGINT)
    _, said = run.communicate(timeout=120)
    assert run.returncode == 130
    assert "Traceback" not in said
    assert all(gone(pid) for pid in pids)


def test_workers_end_with_a_killed_run(tmp_path):
    program = [sys.executable, str(Path(__file__).parent / "work.py"), str(tmp_path)]
    run = subprocess.Popen(program, env={**os.environ, "PYTHONPATH": str(ROOT)}, start_new_session=True, stderr=subprocess.DEVNULL)
    pids = await_pids(tmp_path, 2)
    run.kill()
    run.wait()
    assert all(gone(pid) for pid in pids)


def test_track_counts_and_passes_on(capsys, monkeypatch):
    monkeypatch.setattr("pipeline.execution.QUIET", 0.0)
    assert list(track([[1, 2], [3]], 3, "homes", size=len)) == [[1, 2], [3]]
    said = capsys.readouterr().err.splitlines()
    assert [line.split(",")[0] for line in said] == ["homes: 2 of 3 homes", "homes: 3 of 3 homes"]


def await_pids(folder, count):
    end = time.monotonic() + 120
    while time.monotonic() < end:
        pids = [int(p.name.removeprefix("pid-")) for p in folder.glob("pid-*")]
        if len(pids) >= count:
            return pids
        time.sleep(0.05)
    pytest.fail("the workers did not start")


def gone(pid):
    end = time.monotonic() + 15
    while time.monotonic() < end:
        try:
            state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
        except OSError:
            return True
        if state == "Z":
            return True
        time.sleep(0.1)
    return False
