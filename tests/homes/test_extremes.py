"""Rooms and libraries at the edge of what can be furnished: each a home whose tables say what it lacks, or a refusal with its remedy."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pipeline.diffusion.sampling import Sampler
from pipeline.diffusion.settings import SampleSettings
from pipeline.errors import ContentError, RefusedError
from pipeline.floorplan import plan_json
from pipeline.floorplan.imports import program_of, read_own_json
from pipeline.floorplan.program.floor_program import Furniture, Things
from pipeline.homes.empty_plan import check_sound
from pipeline.homes.furniture_report import deliveries, report
from pipeline.homes.request import Request
from pipeline.verify import verify_home
from tests.judging import SETTINGS

RELEASED = Path(__file__).parents[2] / "weights" / "denoiser.safetensors"
WISH = Furniture(counts=(Things(category="any_bed", min=1),))
BED = "none of double_bed, single_bed, kids_bed"


def box(x0, y0, x1, y1):
    return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]


def beside_a_living_room(bedroom, *, door=True):
    """Return the request for a home of two rooms, its plan and its program."""
    rooms = [{"id": "living", "type": "living_room", "polygon": box(0, 0, 5, 4)}, {"id": "bed", "type": "bedroom", "polygon": bedroom}]
    doors = [{"kind": "entrance", "rooms": ["living"], "segment": [[2, -0.12], [2.9, -0.12]]}]
    doors += [{"rooms": ["living", "bed"], "segment": [[5.05, 1.0], [5.05, 1.9]]}] if door else []
    plan = read_own_json({"inner_wall": 0.1, "rooms": rooms, "doors": doors}).plan
    check_sound(plan, SETTINGS)
    program = program_of(plan)
    return Request(0, "", program.model_dump_json(exclude_defaults=True), json.dumps(plan_json(plan))), program


def what_lacks(home):
    return [(r["where"].partition("#")[0], r["detail"]) for r in home.rows["rejects"] if r["reason"] == "best_of_tries"]


def test_a_bedroom_that_no_bed_fits_into_ships_without_and_says_so(factory):
    request, program = beside_a_living_room(box(5.1, 0.5, 6.3, 2.1))
    (home,) = factory.make([request], files=False)
    tries = [r for r in home.rows["rejects"] if r["reason"] == "lacks_essential"]
    assert len(tries) == factory.shard.room_attempts
    assert what_lacks(home) == [("s3_00000000/bed", f"lacks_essential: {BED}")]
    assert BED in report(deliveries(program, home.rows, {}))
    wish = program.model_copy(
        update={"rooms": tuple(r.model_copy(update={"furniture": WISH}) if r.id == "bed" else r for r in program.rooms)}
    )
    (empty,) = factory.make([replace(request, program=wish.model_dump_json(exclude_defaults=True))], files=False)
    assert (empty.reason, type(empty.error)) == ("attempts_spent", RefusedError)


def test_a_room_of_sixty_walls_is_furnished_by_the_released_weights(factory):
    y = np.repeat(np.linspace(0.2, 4.2, 30), 2)[1:-1]
    teeth = [[9.1 if k // 2 % 2 else 9.0, float(at)] for k, at in enumerate(y)]
    request, _ = beside_a_living_room([[5.1, 0.2], [teeth[0][0], 0.2], *teeth, [teeth[-1][0], 4.2], [5.1, 4.2]])
    (home,) = replace(factory, sampler=Sampler.load(RELEASED, SampleSettings(), 3, factory.index)).make([request], files=False)
    assert len(home.home.plan.room("bed").polygon) >= 60
    assert home.home.in_room("bed")
    assert not verify_home(home.home, factory.library, SETTINGS).faults(SETTINGS.policy)


def test_a_room_without_a_door_is_refused_with_the_remedy():
    with pytest.raises(RefusedError, match="no way from living to bed") as refused:
        beside_a_living_room(box(5.1, 0.2, 8.1, 3.2), door=False)
    assert refused.value.remedy == "add doors between them"


def test_a_category_that_the_library_lacks_is_left_out_and_said(factory_with):
    bare = factory_with(lambda asset: "bed" not in asset.category)
    request, _ = beside_a_living_room(box(5.1, 0.2, 9.1, 4.2))
    (home,) = bare.make([request], files=False)
    assert {r["detail"] for r in home.rows["rejects"] if r["reason"] == "no_asset"} == {"double_bed"}
    assert what_lacks(home) == [("s3_00000000/bed", f"lacks_essential: {BED}")]


def test_a_library_without_furniture_is_an_error(factory_with):
    with pytest.raises(ContentError, match="holds no furniture") as refused:
        factory_with(lambda asset: False)
    assert "dvc repro preprocess" in refused.value.remedy
