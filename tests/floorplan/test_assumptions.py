"""What a default filled in is said: every room, area, link, way in, outline and wall that the request left open, and nothing else."""

import numpy as np
import pytest

from pipeline.floorplan import complete, parse, prior
from pipeline.floorplan.program.areas import usual_area
from pipeline.floorplan.program.description import assumptions
from pipeline.floorplan.program.floor_program import Entrance, FloorProgram, Footprint, Link, Range, RoomReq, Shell
from stages.plan import main


def said(program):
    return {a["field"]: a["text"] for a in assumptions(program)}


@pytest.mark.parametrize("number", range(8))
def test_all_that_is_not_stated_is_named(number):
    program = complete(prior(np.random.default_rng(number)))
    found = said(program)
    names = {part.split()[0] for part in found.get("rooms", "").split(", ") if part}
    assert names == {r.id for r in program.rooms if not r.stated}
    assert all(f"{r.id} {r.area.target:.1f}" in found["areas"] for r in program.rooms if not r.area.stated)
    assert len(found["links"].split(", ")) == sum(not k.stated for k in program.links)
    assert ("entrance" in found) == (not program.entrance.stated)


def test_nothing_is_assumed_where_all_is_stated():
    area = Range(target=20.0, stated=True)
    program = FloorProgram(
        rooms=(RoomReq(id="a", type="living_room", area=area), RoomReq(id="b", type="bathroom", area=area)),
        links=(Link(a="a", b="b", stated=True),),
        entrance=Entrance(into="a", stated=True),
        footprint=Footprint(stated=True),
        shell=Shell(stated=True),
        only=True,
    )
    assert assumptions(complete(program)) == []


def test_areas_that_were_fitted_say_so():
    program = parse("a two-bedroom flat of 60 m2")
    factor = {round((r.area.target or 0) / usual_area(r, program), 2) for r in program.rooms if r.type != "hallway"}
    assert len(factor) == 1
    assert f"usual x {factor.pop():g}" in said(program)["areas"]
    assert "the total" in said(program)["areas"]
    assert "usual" not in said(parse("a studio"))["areas"]


def test_the_terminal_shows_it(tmp_path, capsys):
    main(tmp_path, prompt="a two-bedroom flat of 60 m2")
    shown = " ".join(capsys.readouterr().out.split())
    assert "assumed" in shown
    assert "usual x 0.8" in shown
    assert "bath (bathroom)" in shown


@pytest.mark.parametrize(
    ("roles", "largest"), [(("child", ""), 1), (("", "child"), 0), (("guest", "child", "primary"), 2), (("child", "guest"), None)]
)
def test_the_largest_bedroom_is_theirs_whose_home_it_is(roles, largest):
    beds = tuple(RoomReq(id=f"b{k}", type="bedroom", role=role) for k, role in enumerate(roles))
    program = complete(FloorProgram(rooms=(*beds, RoomReq(id="l", type="living_room"), RoomReq(id="k", type="bathroom"))))
    target = {r.id: r.area.target for r in program.rooms}
    areas = [target[b.id] for b in beds]
    if largest is None:
        assert len(set(areas)) == 1
    else:
        assert areas[largest] > max(a for k, a in enumerate(areas) if k != largest)
