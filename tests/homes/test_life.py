from dataclasses import replace

import pytest

from pipeline.errors import ContentError, RefusedError
from pipeline.homes import life as lives
from pipeline.homes.furnish import Draft
from pipeline.homes.life import HomeLife, RoomTries, State
from pipeline.homes.request import Request, RoomJob
from pipeline.homes.room_finishing import RoomResult


@pytest.fixture
def job():
    return RoomJob(None, "room", "bedroom", 0, 0)


def test_a_room_keeps_the_better_of_its_tries_and_has_no_more_than_its_budget(job):
    tries = RoomTries(job)
    poor, good = RoomResult(Draft(job, ()), (), failure="lacks_essential"), RoomResult(Draft(job, ()), ())
    assert tries.keep(poor) is poor
    assert tries.keep(good) is good
    assert tries.keep(poor) is good
    assert [tries.again(3).attempt, tries.again(3).attempt, tries.again(3)] == [1, 2, None]


def test_no_two_tries_of_a_room_share_a_draw(job, factory):
    most = factory.shard.room_attempts
    draws = [replace(job, plan_attempt=plan, attempt=k).draw for plan in range(3) for k in range(most)]
    assert len(set(draws)) == len(draws)
    with pytest.raises(ContentError, match="room_attempts"):
        replace(factory.shard, room_attempts=101)


def test_a_home_waits_for_drafts_or_is_refused_at_once(factory):
    assert HomeLife(factory, Request(0, "a studio with a bathroom")).state is State.PLANNED
    most = factory.sampler.slots
    life = HomeLife(factory, Request(1, f"a bedroom with {most + 1} pieces of furniture and a bathroom"))
    assert life.state is State.REFUSED
    assert f"at most {most}" in str(life.outcome(files=False).error)


def test_a_plan_of_ones_own_that_is_refused_is_not_asked_which_rooms_it_closes(factory, monkeypatch):
    asked = []

    def refuse(*_):
        raise RefusedError("no plan", "draw another")

    monkeypatch.setattr(lives, "plan_home", refuse)
    monkeypatch.setattr(lives, "closed_rooms", lambda *_: asked.append(1) or frozenset())
    assert HomeLife(factory, Request(0, plan="{}")).state is State.REFUSED
    assert not asked
