"""Floor plans: language → typed program → annealed plan."""

from pipeline.floorplan.complete import complete
from pipeline.floorplan.describe import describe
from pipeline.floorplan.document import plan_from_json, plan_json, refusal_json
from pipeline.floorplan.language import parse
from pipeline.floorplan.prior import prior
from pipeline.floorplan.program import FloorProgram, json_schema
from pipeline.floorplan.solve import solve

__all__ = ["FloorProgram", "complete", "describe", "json_schema", "parse", "plan_from_json", "plan_json", "prior", "refusal_json", "solve"]
