"""An apartment's plan from one generator: the factory's own planner on a program in 3D-FRONT's types of rooms."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from pipeline.corpus.houses import room_list
from pipeline.entities.plan import Plan, Room
from pipeline.errors import ContentError, RefusedError
from pipeline.floorplan import solve

PROGRAMS = 24
LARGEST_AISLE = 3.1
"""What is larger is called a corridor [m2]."""


def make_plan(rng: np.random.Generator, furnished: Sequence[str]) -> Plan:
    """Draw a plan with a room of every type in `furnished`: rooms `room_<i>` with 3D-FRONT types, doors, windows and an entrance."""
    for _ in range(PROGRAMS):
        program, types = room_list.sample(rng, furnished)
        try:
            plan = solve(program, int(rng.integers(2**31)))
        except RefusedError:
            continue
        return _as_front(plan, types, float(rng.uniform(1.45, 1.57)))
    raise ContentError(f"no house plan after {PROGRAMS} programs", "choose another seed in params.yaml")


def _as_front(plan: Plan, types: Mapping[str, str], angle: float) -> Plan:
    """Return the plan with 3D-FRONT's types, its leaves open by `angle` [rad]."""
    openings = (o if o.swing is None else replace(o, swing=replace(o.swing, angle=angle)) for o in plan.openings)
    return replace(plan, rooms=tuple(replace(r, type=_front_type(r, types)) for r in plan.rooms), openings=tuple(openings))


def _front_type(room: Room, types: Mapping[str, str]) -> str:
    name = types[room.room_id]
    return "Aisle" if name == "Corridor" and room.area < LARGEST_AISLE else name
