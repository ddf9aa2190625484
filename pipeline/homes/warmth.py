"""Compiles what planning and judging homes run, into the cache beside the code."""

from __future__ import annotations

from pipeline import floorplan
from pipeline.entities.home import Home
from pipeline.execution import Progress
from pipeline.geometry.compiled import is_cold
from pipeline.verify import VerifySettings, verify_home


def warm() -> None:
    """Plan a small home and judge it empty; from the cache this takes a second."""
    verify_home(Home("empty", 0, 0, "", "", floorplan.warm(), ()), {}, VerifySettings())


def warm_up(progress: Progress) -> None:
    """Compile where that was not done on this machine: once, before workers would, each for itself."""
    if is_cold():
        progress.say("compiling the planner, once on this machine: half a minute")
        warm()
