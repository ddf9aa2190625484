"""The user's own plan: read from our JSON, a 3D-FRONT house or a ProcTHOR house; checked, and repaired only where it says so."""

from pipeline.floorplan.imports.reader import OwnPlan, describe_repairs, program_of, read_own, read_own_json
from pipeline.floorplan.imports.sketch import Repair

__all__ = ["OwnPlan", "Repair", "describe_repairs", "program_of", "read_own", "read_own_json"]
