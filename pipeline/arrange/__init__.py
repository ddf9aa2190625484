"""Post-optimisation: walkable area (algorithm 2 of the paper), relations made exact, and what is left of collisions separated."""

from pipeline.arrange.hanging import Hanging
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.postoptimisation import control_walkable, free_ratio, post_optimise
from pipeline.arrange.separate import separate
from pipeline.arrange.settings import PostoptSettings, ThingsSettings, WalkableSettings
from pipeline.arrange.site import Site
from pipeline.arrange.surface_placement import SurfacePlacement

__all__ = [
    "Hanging",
    "LearntRelations",
    "PostoptSettings",
    "Site",
    "SurfacePlacement",
    "ThingsSettings",
    "WalkableSettings",
    "control_walkable",
    "free_ratio",
    "post_optimise",
    "separate",
]
