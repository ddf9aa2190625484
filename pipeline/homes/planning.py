"""A request becomes a plan that the judge finds sound, and a job for each room that the layout model furnishes."""

import json
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pipeline import floorplan, seeds, taxonomy
from pipeline.entities.plan import Plan
from pipeline.errors import RefusedError
from pipeline.floorplan.language import parse
from pipeline.floorplan.program.floor_program import Furniture
from pipeline.floorplan.program.furniture import LAID, least_pieces, matching_categories, plain
from pipeline.homes.empty_plan import judge_empty
from pipeline.homes.furnish import Draft
from pipeline.homes.request import Request, RoomJob, layout_type
from pipeline.homes.resources import Resources


@dataclass(frozen=True, slots=True)
class PlannedHome:
    """One attempt at a home: what was asked in words, the program as JSON, the plan, one job per room that is furnished; their drafts, where they are made already."""

    request: Request
    prompt: str
    program: str
    plan: Plan
    jobs: tuple[RoomJob, ...]
    drafts: tuple[Draft, ...] = ()


def plan_home(resources: Resources, request: Request, attempt: int) -> PlannedHome:
    """Plan a home for the `attempt`-th time. Raises RefusedError for what cannot be met."""
    with resources.time("plan"):
        if request.program:
            program, prompt = floorplan.FloorProgram.model_validate_json(request.program), request.prompt
        elif request.prompt:
            program, prompt = parse(request.prompt), request.prompt
        else:
            draw, family = (seeds.generator(resources.seed, step, request.index) for step in ("program", "family"))
            program = floorplan.prior(draw, resources.prior, family)
            prompt = floorplan.describe(program)
        if request.plan:  # the user's own, which `check_sound` has seen
            plan = floorplan.plan_from_json(json.loads(request.plan))
        else:
            program = floorplan.complete(program)
            plan = _sound_plan(resources, program, (request.index, attempt))
    wishes = {room.id: room.furniture for room in program.rooms}
    jobs = room_jobs(resources, plan, request.index, attempt, wishes)
    return PlannedHome(request, prompt, program.model_dump_json(exclude_defaults=True), plan, tuple(jobs))


def _sound_plan(resources: Resources, program: floorplan.FloorProgram, keys: tuple[int, int]) -> Plan:
    """Solve a program until the judge finds nothing wrong with the empty home: doors swing, every room is entered."""
    plan = floorplan.solve(program, resources.seed, keys)
    for retry in range(1, resources.shard.plan_draws):
        if judge_empty(plan, resources.verify).ok(resources.verify.policy):
            break
        plan = floorplan.solve(program, resources.seed, (*keys, retry))
    return plan


def room_jobs(resources: Resources, plan: Plan, index: int, attempt: int, wishes: Mapping[str, Furniture]) -> list[RoomJob]:
    """Return one job per room that the layout model furnishes; `wishes` by room id. Raises RefusedError for those that cannot be met."""
    jobs = []
    for number, room in enumerate(plan.rooms):
        kind = layout_type(room, plan, taxonomy.load())
        if kind is None:
            continue
        wish = wishes.get(room.room_id, Furniture())
        _check_possible(resources, room.room_id, room.type, wish)
        count = told_count(wish, seeds.generator(resources.seed, "pieces", index, number, attempt))
        jobs.append(RoomJob(plan, room.room_id, kind, index, number, attempt, 0, count, wish.walkable, wish))
    return jobs


def _check_possible(resources: Resources, room_id: str, kind: str, wish: Furniture) -> None:
    """Raise RefusedError for wishes that the layout model or the library cannot meet."""
    most, slots = max(wish.least or 0, least_pieces(wish)), resources.sampler.slots
    if most > slots:
        raise RefusedError(
            f"{most} objects are asked for in {room_id}, and a room takes at most {slots}",
            "ask for fewer, or train with more train.slots",
        )
    for things in wish.counts:
        names = matching_categories(things, kind)
        if things.min and not any(resources.library.of(n) if n in LAID else resources.index.shelves.get(n) is not None for n in names):
            raise RefusedError(f"the library has no {plain(things.category)} for {room_id}", "ask for something else")


def told_count(wish: Furniture, rng: np.random.Generator) -> int | None:
    """Return the number of objects that the sampler is told: any number within the bounds; None where nobody asked."""
    least, most = wish.least, wish.most
    if least is None and most is None:
        return None
    low = max(least or 0, least_pieces(wish))
    high = most if most is not None else max(low + 2, 4)
    low = low if least is not None else max(low, high // 2)
    return int(rng.integers(low, max(high, low) + 1))
