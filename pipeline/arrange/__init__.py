"""Post-optimisation: walkable area (algorithm 2 of the paper), relations made exact, and what is left of collisions separated."""

from pipeline.arrange.hanging import Hanging
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.postoptimisation import post_optimise
from pipeline.arrange.rugs import lay_rug
from pipeline.arrange.separate import Reject, Separated, separate
from pipeline.arrange.settings import PostoptSettings, SeparateSettings, ThingsSettings, WalkableSettings
from pipeline.arrange.site import Site
from pipeline.arrange.surface_placement import Laying
from pipeline.arrange.walkable_area import control_walkable, free_ratio

__all__ = [
    "Hanging",
    "Laying",
    "LearntRelations",
    "PostoptSettings",
    "Reject",
    "SeparateSettings",
    "Separated",
    "Site",
    "ThingsSettings",
    "WalkableSettings",
    "control_walkable",
    "free_ratio",
    "lay_rug",
    "post_optimise",
    "separate",
]
