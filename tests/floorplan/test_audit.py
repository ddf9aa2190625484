"""The audit of plans finds nothing in a good plan, and whatever is broken in it."""

import dataclasses

import numpy as np
import pytest

from benchmarks.knobs import in_processes
from benchmarks.plan import failures
from pipeline.errors import RefusedError
from pipeline.floorplan import FloorProgram, complete, solve
from pipeline.floorplan.program.floor_program import Entrance, Footprint, Forbid, Link, Range, Relation, RoomReq, Shell
from tests.floorplan import attempts, audit

PROGRAM = complete(
    FloorProgram(
        storeys=2,
        rooms=(
            RoomReq(id="entry", type="entry", level=0), RoomReq(id="living", type="living_room", level=0, window="required"),
            RoomReq(id="kitchen", type="kitchen", level=0), RoomReq(id="wc", type="wc", level=0),
            RoomReq(id="bed", type="bedroom", count=2, level=1, area=Range(target=14.0, stated=True)), RoomReq(id="bath", type="bathroom", level=1),
        ),
        links=(Link(a="living", b="kitchen", kind="open", stated=True),),
    )
)  # fmt: skip


@pytest.fixture(scope="module")
def plan():
    return solve(PROGRAM, 3)


def room(plan, name, **changes):
    return dataclasses.replace(plan, rooms=tuple(dataclasses.replace(r, **changes) if r.room_id == name else r for r in plan.rooms))


def turned(plan, kind, change):
    """The plan with its first opening of a kind (and with a leaf, where a leaf is changed) changed."""
    chosen = next(o for o in plan.openings if o.kind == kind and (len(o.rooms) == 2) == (kind in {"door", "open"}))
    return dataclasses.replace(plan, openings=tuple(change(o) if o is chosen else o for o in plan.openings))


def shifted(by):
    def change(o):
        along = (o.segment[1] - o.segment[0]) / o.width
        across = np.array([-along[1], along[0]])
        return dataclasses.replace(o, segment=o.segment + by[0] * along + by[1] * across)

    return change


def wider(by):
    return lambda o: dataclasses.replace(o, segment=o.segment + np.array([[0.0, 0.0], by * (o.segment[1] - o.segment[0]) / o.width]))


def grown(plan, name, by):
    """A room with its highest side moved up."""
    polygon = plan.room(name).polygon.copy()
    polygon[polygon[:, 1] == polygon[:, 1].max(), 1] += by
    return room(plan, name, polygon=polygon)


def without(plan, kind):
    return dataclasses.replace(plan, openings=tuple(o for o in plan.openings if o.kind != kind))


def hinged(o):
    return dataclasses.replace(o, swing=dataclasses.replace(o.swing, hinge=1 - o.swing.hinge, angle=3.1))


def test_a_good_plan_has_no_fault(plan):
    assert audit.faults(PROGRAM, plan) == []


BROKEN = {
    "wall": lambda p: grown(p, "wc", 0.3),
    "gap": lambda p: grown(grown(p, "bed_1", -0.6), "bed_2", -0.6),
    "clockwise": lambda p: room(p, "living", polygon=p.room("living").polygon[::-1]),
    "collinear": lambda p: room(p, "wc", polygon=np.insert(p.room("wc").polygon, 1, p.room("wc").polygon[:2].mean(axis=0), axis=0)),
    "finer": lambda p: room(p, "wc", polygon=p.room("wc").polygon + 1e-4 / 3),
    "slanted": lambda p: room(p, "wc", polygon=p.room("wc").polygon + np.eye(4, 2) * 0.05),
    "type": lambda p: room(p, "wc", type="closet"),
    "level": lambda p: room(p, "bath", level=0),
    "area": lambda p: grown(p, "bed_1", -0.9),
    "cut off": lambda p: without(p, "door"),
    "no entrance": lambda p: without(p, "entrance"),
    "entered elsewhere": lambda p: dataclasses.replace(p, entrance="kitchen"),
    "no window": lambda p: without(p, "window"),
    "closed": lambda p: without(p, "open"),
    "door beside its wall": lambda p: turned(p, "door", shifted((0.0, 0.08))),
    "door through a side wall": lambda p: turned(p, "door", shifted((4.0, 0.0))),
    "narrow door": lambda p: turned(p, "door", wider(-0.15)),
    "window inside": lambda p: turned(p, "window", lambda o: dataclasses.replace(o, rooms=("kitchen",) if o.rooms != ("kitchen",) else ("living",))),
    "window above the ceiling": lambda p: turned(p, "window", lambda o: dataclasses.replace(o, sill=2.0)),
    "leaf through a wall": lambda p: turned(p, "door", hinged),
    "leaf of no room": lambda p: turned(p, "door", lambda o: dataclasses.replace(o, swing=dataclasses.replace(o.swing, room_id="wc" if "wc" not in o.rooms else "bath"))),
    "no leaf": lambda p: turned(p, "door", lambda o: dataclasses.replace(o, swing=None)),
    "door on another storey": lambda p: turned(p, "door", lambda o: dataclasses.replace(o, level=1 - o.level)),
    "twice": lambda p: dataclasses.replace(p, openings=(*p.openings, dataclasses.replace(p.openings[0], opening_id="again"))),
    "hanging": lambda p: dataclasses.replace(p, rooms=tuple(dataclasses.replace(r, polygon=r.polygon + np.array([3.0, 0.0])) if r.level == 1 else r for r in p.rooms)),
    "missing": lambda p: dataclasses.replace(p, rooms=p.rooms[1:]),
}  # fmt: skip


@pytest.mark.parametrize("name", BROKEN)
def test_what_is_broken_is_found(plan, name):
    assert audit.faults(PROGRAM, BROKEN[name](plan))


ASKED = {
    "adjacent": {"forbids": (Forbid(what="adjacent", a="kitchen", b="living"),)},
    "through": {"forbids": (Forbid(what="through", a="kitchen", avoid="living"),)},
    "separation": {"relations": (Relation(kind="separation", a="kitchen", b="living", value=0.9),)},
    "area_order": {"relations": (Relation(kind="area_order", a="wc", b="living", value=1.0),)},
    "area_equal": {"relations": (Relation(kind="area_equal", a="living", b="kitchen", value=0.05),)},
    "degree": {"relations": (Relation(kind="degree", a="kitchen", value=3.0),)},
    "area_share": {"relations": (Relation(kind="area_share", a="kitchen", value=0.5),)},
    "total": {"total_area": Range(max=40.0, stated=True)},
    "long": {"footprint": Footprint(min_aspect=3.0, max_aspect=4.0, stated=True)},
    "shape": {"footprint": Footprint(shape="T", max_aspect=5.0, stated=True)},
    "bent": {"nonrect": 9},
    "enter": {"entrance": Entrance(into="kitchen", stated=True)},
    "exit": {"entrance": Entrance(into="entry", separate=("kitchen",), stated=True)},
}


@pytest.mark.parametrize("name", ASKED)
def test_a_wish_that_the_plan_misses_is_found(plan, name):
    assert audit.faults(PROGRAM.model_copy(update=ASKED[name]), plan)


@pytest.mark.parametrize(
    "change", [{"min_width": 7.0}, {"window": "forbidden"}, {"exterior_length": 30.0}, {"area": Range(min=50.0, stated=True)}]
)
def test_a_wish_for_a_room_that_the_plan_misses_is_found(plan, change):
    rooms = tuple(r.model_copy(update=change) if r.id == "living" else r for r in PROGRAM.rooms)
    assert audit.faults(PROGRAM.model_copy(update={"rooms": rooms}), plan)


def test_thickness_is_that_of_the_plan(plan):
    assert audit.faults(PROGRAM, dataclasses.replace(plan, inner_wall=0.3))
    assert audit.faults(PROGRAM, dataclasses.replace(plan, outer_wall=0.4))


@pytest.mark.parametrize(("error", "kind"), [(RefusedError("no", "try"), "refused"), (ValueError("oops"), "crash")])
def test_a_failure_is_counted_and_does_not_stop_the_run(monkeypatch, capsys, error, kind):
    def fails(program, seed):
        raise error

    monkeypatch.setattr(attempts, "solve", fails)
    assert failures(2, 5, ("prior",), 1) == 2
    said = capsys.readouterr().out
    assert all(f"prior {k}: {kind}" in said for k in (5, 6))


SHELLS = [
    Shell(inner_wall=0.08, outer_wall=0.3, ceiling=2.3),
    Shell(inner_wall=0.2, outer_wall=0.45, ceiling=3.4),
    Shell(inner_wall=0.25, outer_wall=0.25),
]


@pytest.mark.parametrize("shell", SHELLS)
@pytest.mark.parametrize("corners", ["plain", "chamfered"])
def test_walls_ceilings_and_chamfers(shell, corners):
    program = PROGRAM.model_copy(update={"shell": shell, "footprint": Footprint(corners=corners)})
    made = solve(program, 1)
    assert audit.faults(program, made) == []
    assert (made.inner_wall, made.outer_wall) == (shell.inner_wall, shell.outer_wall)
    assert {r.height for r in made.rooms} == {shell.ceiling}
    assert made.storey_height >= shell.ceiling + 0.25
    assert all(o.sill + o.height < shell.ceiling for o in made.openings)
    slanted = [r.room_id for r in made.rooms if np.any(np.abs(np.roll(r.polygon, -1, axis=0) - r.polygon).min(axis=1) > 1e-6)]
    assert bool(slanted) == (corners == "chamfered")


def test_outside_walls_are_no_thinner_than_those_between_rooms():
    rooms = {"rooms": PROGRAM.rooms[:4], "only": True}
    assert complete(FloorProgram(shell=Shell(inner_wall=0.3), **rooms)).shell.outer_wall == 0.3
    assert complete(FloorProgram(shell=Shell(outer_wall=0.1), **rooms)).shell.inner_wall == 0.1
    with pytest.raises(RefusedError, match="thinner"):
        solve(FloorProgram(shell=Shell(inner_wall=0.3, outer_wall=0.2), **rooms), 0)


def test_processes_give_what_one_gives():
    work = [("trees", number) for number in range(3)]
    two, one = ([bad for _, bad in in_processes(attempts.attempt, work, jobs)] for jobs in (2, 1))
    assert two == one
