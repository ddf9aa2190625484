from __future__ import annotations

from pipeline.geometry.memo import recent


class Thing:
    __hash__ = None  # as records that hold arrays


def test_recent_results_are_made_once_and_old_ones_again():
    made = []

    @recent(2)
    def doubled(thing, by):
        made.append((thing, by))
        return object()

    one, two = Thing(), Thing()
    first = doubled(one, 1)
    assert doubled(one, 1) is first
    assert doubled(one, 2) is not first
    assert len(made) == 2
    doubled(two, 1)  # the oldest goes
    assert doubled(one, 1) is not first
    assert len(made) == 4
