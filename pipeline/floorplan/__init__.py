"""Floor plans: language → typed program → annealed plan."""

from pipeline.floorplan.document import plan_from_json, plan_json, refusal_json
from pipeline.floorplan.language import parse
from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.description import describe
from pipeline.floorplan.program.floor_program import FloorProgram, json_schema
from pipeline.floorplan.program.priors import prior
from pipeline.floorplan.prompt import request
from pipeline.floorplan.solver import solve, warm

__all__ = [
    "FloorProgram",
    "complete",
    "describe",
    "json_schema",
    "parse",
    "plan_from_json",
    "plan_json",
    "prior",
    "refusal_json",
    "request",
    "solve",
    "warm",
]
