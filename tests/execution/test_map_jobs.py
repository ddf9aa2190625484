"""map_jobs: every mode gives the same results, errors come through, dead and silent workers and Ctrl-C cost nothing and leave nothing behind."""

import asyncio
import functools
import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import pytest

from pipeline.errors import ContentError, UsageError
from pipeline.execution import Lost, Progress, cores, map_divisible, map_jobs, single_thread, track

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(Path(__file__).parent))  # where the workers find the steps
import work  # noqa: E402


def singles(jobs):
    return [(j,) for j in jobs]


@pytest.fixture(scope="module")
def cluster():
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs="ERROR") as made:
        yield made


def test_serial_and_processes_agree():
    wanted = {job: job * job for job in range(10, 19)}
    assert dict(map_jobs(work.square, wanted)) == wanted
    assert dict(map_jobs(work.square, iter(wanted), workers=2)) == wanted


def test_one_worker_is_this_process():
    assert {pid for _, (_, pid) in map_jobs(work.where, range(3), workers=1)} == {os.getpid()}


def test_nothing_listens_on_a_port():
    """Neither the command nor its workers have a socket that another user of the machine could reach."""
    program = f"import sys; sys.path[:0] = [{str(ROOT)!r}, {str(Path(__file__).parent)!r}]; import work; work.tell_ports()"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == [[], [], 1, False]


def test_jobs_are_drawn_as_needed():
    drawn = []

    def jobs():
        for i in range(1000):
            drawn.append(i)
            yield i

    for _ in zip(range(5), map_jobs(work.square, jobs(), workers=2), strict=False):
        pass
    assert len(drawn) < 50


def test_workers_compute_with_one_thread():
    answers = [r for _, r in map_jobs(work.threads, range(4), workers=2)]
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
        list(map_jobs(work.refuse_third, range(6), workers=workers))
    assert (caught.value.message, caught.value.remedy) == ("the third shard is bad", "leave it out")


def test_other_errors_come_through_at_once_with_their_trace(tmp_path):
    with pytest.raises(OSError, match="hiccups") as caught:
        list(map_jobs(functools.partial(work.count_and_raise, str(tmp_path)), [0], workers=2))
    assert "in count_and_raise" in caught.value.__notes__[0]
    assert len(list(tmp_path.iterdir())) == 1
    with pytest.raises(RuntimeError, match="StubbornError: 5 does not travel"):
        list(map_jobs(work.raise_stubborn, [0], workers=2))


def test_a_killed_worker_costs_nothing(tmp_path):
    results = dict(map_jobs(functools.partial(work.die_once, str(tmp_path)), range(6), workers=2))
    assert results == {i: i for i in range(6)}
    assert (tmp_path / "died-2").exists()


def test_a_job_that_kills_its_workers_is_named():
    with pytest.raises(ContentError, match=r"killed 3 workers \(7\)"):
        list(map_jobs(work.die_always, [7], workers=2))


def test_the_culprit_in_a_job_is_found_and_the_rest_is_done(tmp_path):
    step = functools.partial(work.die_of_seven, str(tmp_path))
    results = dict(map_divisible(step, [(0, 1), (6, 7, 8), (9,)], singles, workers=2))
    assert results.pop((7,)) == Lost("died", 3)
    assert results == {(0, 1): 1, (6,): 6, (8,): 8, (9,): 9}
    assert (tmp_path / "begun").read_text().count("7") == 3


def test_a_silent_worker_is_replaced():
    results = dict(map_divisible(work.hang_at_two, range(4), lambda job: [job], workers=2, silence=1.0))
    assert results == {0: 0, 1: 1, 2: Lost("hung", 3), 3: 3}


def test_a_worker_that_whispers_is_not(monkeypatch):
    """By a clock on which longer than `silence` passes in all, and less between two words."""
    now, heard = [0.0], []
    monkeypatch.setattr("pipeline.execution.pool.time", SimpleNamespace(monotonic=lambda: now[0]))

    def hear(note):
        heard.append(note)
        now[0] += 200.0

    assert dict(map_divisible(work.whisper, [5], None, workers=2, note=hear, silence=300.0)) == {5: 5}
    assert heard == [("part", 5, part) for part in range(4)]


def test_notes_are_heard_in_this_process_too():
    heard = []
    assert dict(map_jobs(work.whisper, [1], note=heard.append)) == {1: 1}
    assert len(heard) == 4


def test_what_workers_leave_in_the_temporary_folder_goes_with_them():
    ((_, place),) = map_jobs(work.litter, [0], workers=2)
    assert not Path(place).exists()


def test_a_named_scheduler_is_used(cluster):
    assert dict(map_jobs(work.square, range(5), scheduler=cluster.scheduler_address)) == {i: i * i for i in range(5)}


def test_a_scheduler_behind_tls_takes_those_only_who_have_its_certificate(tmp_path):
    pytest.importorskip("cryptography")
    import dask
    from distributed import LocalCluster
    from distributed.security import Security

    keys, told = Security.temporary(), {"distributed.comm.require-encryption": True}
    for name in ("ca-file", "client.key", "client.cert"):
        file = tmp_path / name
        file.write_text(getattr(keys, f"tls_{name.replace('-', '_').replace('.', '_')}"))
        told[f"distributed.comm.tls.{name}"] = str(file)
    how = {"protocol": "tls://", "security": keys, "silence_logs": "CRITICAL", "dashboard_address": None}
    with LocalCluster(n_workers=1, threads_per_worker=1, processes=True, **how) as made:
        assert made.scheduler_address.startswith("tls://")
        with dask.config.set(told):
            assert dict(map_jobs(work.square, range(3), scheduler=made.scheduler_address)) == {0: 0, 1: 1, 2: 4}
        with pytest.raises(UsageError, match="certificates"):
            list(map_jobs(work.square, [0], scheduler=made.scheduler_address))


def test_workers_that_join_late_are_all_busy(cluster):
    """The first worker's window of two jobs does not starve those that come, in three lots, while it is at work."""
    joined, pids = 1, []
    for done, (_, (_, pid)) in enumerate(map_jobs(work.doze, range(160), scheduler=cluster.scheduler_address)):
        if done in (1, 20, 60):
            joined = {1: 3, 20: 4, 60: 8}[done]
            cluster.scale(joined)
            cluster.wait_for_workers(joined, 120)
        pids.append(pid)
        if done == 60:
            assert len(set(pids)) == 4
    jobs = Counter(pids[80:])
    assert len(jobs) == 8
    assert min(jobs.values()) >= 3, jobs  # ten each, were all alike


@pytest.mark.parametrize("scheduler", ["nowhere.json", "tcp://127.0.0.1:9", "gopher://x"])
def test_a_scheduler_that_does_not_answer_is_the_users_error(scheduler, monkeypatch):
    monkeypatch.setattr("pipeline.execution.cluster.PATIENCE", "1s")
    with pytest.raises(UsageError, match="scheduler"):
        list(map_jobs(work.square, [0], scheduler=scheduler))


def test_a_scheduler_that_dies_is_one_line_at_once(tmp_path, monkeypatch, capfd):
    monkeypatch.setattr("pipeline.execution.cluster.PATIENCE", "10s")
    monkeypatch.setattr("pipeline.execution.cluster.FIRST", 300.0)
    file = tmp_path / "scheduler.json"
    dask = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--no-dashboard", "--port", "0"]
    quiet = {
        "stdout": subprocess.DEVNULL,
        "stderr": subprocess.DEVNULL,
        "cwd": ROOT,
        "env": {**os.environ, "PYTHONPATH": f"{ROOT}:{Path(__file__).parent}"},
    }
    scheduler = subprocess.Popen([*dask, "--scheduler-file", str(file)], **quiet)
    worker = subprocess.Popen(
        [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(file), "--nthreads", "1", "--no-dashboard"], **quiet
    )
    try:
        end = time.monotonic() + 300
        while not file.exists():
            assert time.monotonic() < end
            time.sleep(0.05)
        run = map_jobs(work.doze, range(1000), scheduler=str(file))
        next(run)
        scheduler.kill()
        began = time.monotonic()
        with pytest.raises(ContentError, match="is gone"):
            list(run)
        assert time.monotonic() - began < 100  # Dask alone waits for two minutes
    finally:
        for process in (scheduler, worker):
            process.kill()
            process.wait()
    assert "Traceback" not in capfd.readouterr().err


def test_interrupt_ends_all_workers(tmp_path):
    program = [sys.executable, str(Path(__file__).parent / "work.py"), str(tmp_path)]
    run = subprocess.Popen(program, env={**os.environ, "PYTHONPATH": str(ROOT)}, start_new_session=True, stderr=subprocess.PIPE, text=True)
    pids = await_pids(tmp_path, 2)
    os.killpg(run.pid, signal.SIGINT)
    _, said = run.communicate(timeout=300)
    assert run.returncode == 130
    assert "Traceback" not in said
    assert all(gone(pid) for pid in pids)


def test_a_worker_that_is_told_twice_to_leave_says_nothing(capfd):
    assert sorted(answer for _, answer in map_jobs(work.be_told_twice_to_leave, range(4), workers=2)) == [0, 1, 2, 3]
    assert not capfd.readouterr().err


def test_workers_end_with_a_killed_run(tmp_path):
    program = [sys.executable, str(Path(__file__).parent / "work.py"), str(tmp_path)]
    run = subprocess.Popen(program, env={**os.environ, "PYTHONPATH": str(ROOT)}, start_new_session=True, stderr=subprocess.DEVNULL)
    pids = await_pids(tmp_path, 2)
    run.kill()
    run.wait()
    assert all(gone(pid) for pid in pids)


def test_track_counts_and_passes_on(capsys, monkeypatch):
    monkeypatch.setattr("pipeline.execution.progress.FIRST", 0.0)
    monkeypatch.setattr("pipeline.execution.progress.QUIET", 0.0)
    assert list(track([[1, 2], [3]], 3, "homes", size=len)) == [[1, 2], [3]]
    said = capsys.readouterr().err.splitlines()
    assert [line.split(",")[0] for line in said] == ["homes: 2 of 3 homes", "homes: 3 of 3 homes"]


def test_progress_speaks_to_machines_or_not_at_all(capsys, monkeypatch):
    monkeypatch.setattr("pipeline.execution.progress.FIRST", 0.0)
    for voice in ("json", "quiet"):
        progress = Progress(4, "homes", voice=voice)
        progress.say("begins")
        progress.count(retries=2)
        progress.add(1)
        progress.close()
    first, second = map(json.loads, capsys.readouterr().err.splitlines())
    assert (first["event"], first["text"]) == ("said", "begins")
    assert (second["homes"], second["of"], second["retries"]) == (1, 4, 2)
    assert second["seconds_left"] >= 0


@pytest.mark.parametrize(
    ("files", "most"),
    [
        ({}, None),
        ({"proc/self/cgroup": "0::/a/b\n", "sys/fs/cgroup/a/b/cpu.max": "max 100000\n", "sys/fs/cgroup/a/cpu.max": "100000 100000\n"}, 1),
        ({"proc/self/cgroup": "0::/\n", "sys/fs/cgroup/cpu.max": "150000 100000"}, 1),
        ({"proc/self/cgroup": "0::/host/path\n", "sys/fs/cgroup/cpu.max": "50000 100000"}, 1),
        (
            {
                "proc/self/cgroup": "5:cpu,cpuacct:/x\n",
                "sys/fs/cgroup/cpu/x/cpu.cfs_quota_us": "100000",
                "sys/fs/cgroup/cpu/x/cpu.cfs_period_us": "100000",
            },
            1,
        ),
        (
            {
                "proc/self/cgroup": "5:cpu:/x\n",
                "sys/fs/cgroup/cpu/x/cpu.cfs_quota_us": "-1",
                "sys/fs/cgroup/cpu/x/cpu.cfs_period_us": "100000",
            },
            None,
        ),
        ({"proc/self/cgroup": "0::/x\n", "sys/fs/cgroup/x/cpu.max": "6400000 100000"}, None),
    ],
)
def test_cores_are_those_that_affinity_and_control_groups_leave(tmp_path, monkeypatch, files, most):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _pid: set(range(8)), raising=False)
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    assert cores(tmp_path) == (most or 8)


def await_pids(folder, count):
    end = time.monotonic() + 300
    while time.monotonic() < end:
        pids = [int(p.name.removeprefix("pid-")) for p in folder.glob("pid-*")]
        if len(pids) >= count:
            return pids
        time.sleep(0.05)
    pytest.fail("the workers did not start")


def gone(pid):
    end = time.monotonic() + 120
    while time.monotonic() < end:
        try:
            state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
        except OSError:
            return True
        if state == "Z":
            return True
        time.sleep(0.1)
    return False


@pytest.mark.parametrize("capability", ["avx2", None])
def test_workers_that_compute_with_other_instructions_are_started_again(monkeypatch, capability):
    from pipeline.execution.cluster import SameInstructions

    monkeypatch.setenv("ATEN_CPU_CAPABILITY", "avx2")
    plugin, nanny = SameInstructions(), SimpleNamespace(pre_spawn_env={})
    if capability is None:  # on the worker's machine
        monkeypatch.delenv("ATEN_CPU_CAPABILITY")
    asyncio.run(plugin.setup(nanny))
    assert (plugin.restart, nanny.pre_spawn_env["ATEN_CPU_CAPABILITY"]) == (capability is None, "avx2")
