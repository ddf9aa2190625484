"""Settings of the stage `preprocess` (section `preprocess` of params.yaml)."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from pipeline.sources.budget import Budget


@dataclass(frozen=True, slots=True)
class FrontFilters:
    """When something of a 3D-FRONT house is left out; see docs/reasons.md."""

    min_room_area: float = 1.0  # m2
    min_inside: float = 0.8  # share of an object's footprint that must lie in its room
    max_shift: float = 0.6  # m that furniture is moved at most, out of walls and of each other; 0: it stays where the file has it
    max_tilt: float = 0.0175  # rad
    max_scale: float = 5.0  # factor
    max_top: float = 4.0  # m above the floor
    max_overlap: float = 0.5  # share of the smaller box's volume that two objects may have in common
    max_overlap_tucked: float = 0.9  # the same for a seat at a table or desk
    wall_reach: float = 0.4  # m from an opening's centre to the rooms that it joins
    ceiling: float = 2.7  # m; height of rooms whose ceiling is not in the file
    keep_without_model: bool = False  # keep objects whose model is missing, with the size that their record declares


@dataclass(frozen=True, slots=True)
class ModelLimits:
    """How models become assets."""

    max_texture: int = 512  # pixels; larger images are scaled down
    max_pieces: int = 96  # convex colliders per link
    convex_fill: float = 0.95  # a part that fills this share of its hull is convex
    cut: Literal["none", "articulated", "all"] = "all"  # models whose other parts are cut; elsewhere their hull stands
    fit_rms: float = 2.5  # standard deviations; a PartNet object that fits no category better is left out
    fit_keep: int = 3  # categories that one PartNet object may serve
    fit_margin: float = 2.0  # log-likelihood that a further category may be worse than the best


@dataclass(frozen=True, slots=True)
class PreprocessSettings:
    """Where the sources are and how they are read. Paths are relative to the checkout, or absolute; null: none."""

    sources: Mapping[str, str | None] = field(default_factory=lambda: {"front": "data/raw/3d-front", "partnet": "data/raw/partnet"})
    licences: Mapping[str, str] = field(default_factory=dict)  # by source; one without is under the licence of real copies
    workers: int = 0  # processes; 0: one per core
    budget: Budget = field(default_factory=Budget)
    filters: FrontFilters = FrontFilters()
    models: ModelLimits = ModelLimits()
