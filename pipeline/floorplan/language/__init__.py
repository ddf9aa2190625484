"""Language → FloorProgram: the built-in deterministic parser."""

from pipeline.floorplan.language.parser import parse

__all__ = ["parse"]
