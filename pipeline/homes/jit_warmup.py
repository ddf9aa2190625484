"""Compiles what planning and judging homes run, into the cache beside the code."""

from __future__ import annotations

from pathlib import Path

from pipeline import floorplan, params
from pipeline.entities.home import Home
from pipeline.execution import Progress
from pipeline.geometry.compiled import is_cold
from pipeline.verify import VerifySettings, verify_home


def warm(root: Path) -> None:
    """Plan a small home and judge it empty; from the cache this takes a second. `root` is the checkout."""
    verify_home(
        Home("empty", 0, 0, "", "", floorplan.warm(), ()), {}, params.section(VerifySettings, params.read(root / "params.yaml"), "verify")
    )


def warm_up(progress: Progress, root: Path) -> None:
    """Compile where that was not done on this machine: once, before workers would, each for itself."""
    if is_cold():
        progress.say("compiling the planner, once on this machine: half a minute")
        warm(root)
