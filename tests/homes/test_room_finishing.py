from dataclasses import replace
from types import SimpleNamespace

import pytest

from pipeline.floorplan.program.floor_program import Furniture
from pipeline.homes import room_finishing as finishing
from tests.geometry.furniture import one_room
from tests.judging import SETTINGS


class SeenError(Exception):
    """Carries what the arranger was handed."""


@pytest.mark.parametrize(
    "change", [{"reach": (0.1, 0.2)}, {"cone": 11.0}, {"step": 0.07}, {"height": 0.9}, {"radius": 0.1}], ids=lambda c: next(iter(c))
)
def test_the_arranger_has_the_robot_and_the_raster_of_the_judge(monkeypatch, change):
    def stop(site, *_args, **_kwargs):
        raise SeenError(site)

    monkeypatch.setattr(finishing, "post_optimise", stop)
    job = SimpleNamespace(plan=one_room(), room_id="room", walkable=None, bounds=(None, None), furniture=Furniture())
    draft = SimpleNamespace(job=job, placements=(), lost=(), taste=SimpleNamespace(style="", wished=False))
    index = SimpleNamespace(smaller=lambda *_: None)
    settings = replace(SETTINGS, cell=0.08, robot=replace(SETTINGS.robot, **change))
    with pytest.raises(SeenError) as seen:
        finishing.finish(draft, SimpleNamespace(library={}, index=index, learnt=None, postopt=None, verify=settings))
    site = seen.value.args[0]
    assert site.robot == replace(settings.robot, radius=settings.robot.radius + finishing.MARGIN)
    assert site.floor.raster.cell == settings.cell


def test_a_room_whose_only_cooker_nobody_gets_to_is_tried_again():
    job = SimpleNamespace(
        bounds=(None, None),
        furniture=Furniture(),
        walkable=None,
        room=SimpleNamespace(type="kitchen"),
        essentials=lambda _: (("oven",), ("sink_cabinet",)),
    )
    placements = tuple(
        SimpleNamespace(category=c, object_id=i, asset_id=i) for i, c in (("one", "oven"), ("two", "oven"), ("basin", "sink_cabinet"))
    )
    draft = SimpleNamespace(job=job, placements=placements)
    for unreached, failure in ((set(), ""), ({"one"}, ""), ({"one", "two"}, "out_of_reach"), ({"basin"}, "out_of_reach")):
        result = finishing.RoomResult(draft, placements, unreached=frozenset(unreached)).judged()
        assert result.failure == failure
