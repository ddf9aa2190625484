"""Claims: one holder at a time; who is gone, dead or silent loses them; nothing stays behind."""

import json
import subprocess
import sys
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from pipeline.shards.claims import PATIENCE, Claims

FAR = {"host": "elsewhere", "boot": "1", "processes": "1"}


@pytest.fixture
def claims(tmp_path):
    """Makes commands on one folder; they leave in the end."""
    made = []

    def one(**how):
        made.append(Claims(tmp_path / "claims", **how))
        return made[-1]

    yield one
    for each in made:
        each.leave()
    assert not (tmp_path / "claims").exists()


def test_a_name_has_one_holder(claims):
    first, second = claims(), claims()
    assert first.take("shard/1")
    assert first.take("shard/1")
    assert not second.take("shard/1")
    assert second.take("shard/2")
    assert second.others() == [first.token]


def test_of_many_at_once_one_gets_it(claims):
    crowd = [claims() for _ in range(8)]
    start, got = threading.Barrier(8), []

    def grab(one):
        start.wait()
        got.extend(name for name in map(str, range(50)) if one.take(name))

    threads = [threading.Thread(target=grab, args=(one,)) for one in crowd]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(got, key=int) == list(map(str, range(50)))


def test_who_leaves_gives_up_its_claims(claims):
    first, second = claims(), claims()
    assert first.take("a")
    assert not first.leave()
    assert second.take("a")
    assert not second.others()


def pretend(folder, token, **who):
    """Write what an owner on another machine, or a dead one on this, would have left."""
    assert len(token) == 16
    (folder / "owners").mkdir(parents=True, exist_ok=True)
    (folder / "owners" / token).write_text(json.dumps({"machine": FAR, "pid": 1, "born": "1", **who}) + "\n")
    (folder / "a.0").write_text(token)


def test_a_process_of_this_machine_that_is_dead_is_known_at_once(tmp_path, claims):
    one = claims()
    mine = json.loads((one.folder / "owners" / one.token).read_text())
    done = subprocess.Popen([sys.executable, "-c", ""])
    done.wait()
    pretend(one.folder, "deaddeaddeaddead", machine=mine["machine"], pid=done.pid)
    assert one.take("a")
    pretend(one.folder, "beefbeefbeefbeef", **{**mine, "born": "1"})  # its number belongs to another process now
    assert one.others() == []
    pretend(one.folder, "cafecafecafecafe", machine={**mine["machine"], "boot": "before"})
    assert one.others() == []


@pytest.fixture
def clock(monkeypatch):
    """The seconds that claims go by: [now]."""
    now = [0.0]
    monkeypatch.setattr("pipeline.shards.claims.time", SimpleNamespace(monotonic=lambda: now[0], sleep=time.sleep))
    return now


def test_another_machine_is_given_up_when_it_keeps_silent(claims, clock):
    one = claims()
    pretend(one.folder, "fafafafafafafafa", machine=FAR)
    assert not one.take("a")
    for _ in range(4):
        clock[0] += PATIENCE - 1
        with (one.folder / "owners" / "fafafafafafafafa").open("a") as file:
            file.write(".")
        assert not one.take("a")
    clock[0] += PATIENCE + 1
    assert one.take("a")


def test_signs_of_life_are_given(claims):
    one = claims(beat=0.05)
    path = one.folder / "owners" / one.token
    size, end = path.stat().st_size, time.monotonic() + 30
    while path.stat().st_size == size:
        assert time.monotonic() < end
        time.sleep(0.05)


def test_a_claim_that_was_never_signed_expires(claims, clock):
    one, other = claims(), claims()
    one.folder.joinpath("a.0").touch()
    assert not one.take("a")
    clock[0] += PATIENCE + 1
    with (one.folder / "owners" / other.token).open("a") as file:
        file.write(".")  # the other lives; it is not known whether the claim is its own
    assert one.take("a")


def test_alone_an_unsigned_claim_is_nobodys(claims):
    one = claims()
    one.folder.joinpath("a.0").touch()  # torn by a power cut
    assert one.take("a")


def test_one_at_a_time_holds_what_is_held_alone(claims):
    crowd, inside, seen = [claims() for _ in range(4)], [], []

    def enter(one):
        for _ in range(5):
            with one.alone("open"):
                inside.append(one)
                seen.append(len(inside))
                inside.remove(one)

    threads = [threading.Thread(target=enter, args=(one,)) for one in crowd]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert seen == [1] * 20


def test_who_joins_while_the_last_one_leaves_is_registered(claims, monkeypatch):
    """The folder of claims is swept away between the making of a new owner's folder and its file."""
    last, write = claims(), Path.write_text

    def swept(path, text):
        if path.parent.name == "owners":
            monkeypatch.undo()
            assert last.leave()
        return write(path, text)

    monkeypatch.setattr(Path, "write_text", swept)
    new = claims()
    assert (new.folder / "owners" / new.token).exists()
    assert new.take("a")


def test_who_leaves_last_tidies_before_anyone_else_begins(claims):
    one, other, seen = claims(), claims(), []
    assert not one.leave(lambda: seen.append("one"))
    assert other.leave(lambda: seen.append(other.take("open")))
    assert seen == [True]
