"""Compiles what planning and judging homes run, into the cache beside the code: `make run` does it beside its first stages.

Without it the workers of stage `sample` would compile the same functions, each for itself, before their first home.
"""

from __future__ import annotations

from pathlib import Path

from pipeline import floorplan
from pipeline.entities.home import Home
from pipeline.verify import VerifySettings, verify_home
from stages import runner


def main(_root: Path) -> None:
    """Plan a small home and judge it empty; from the cache this takes a second."""
    verify_home(Home("empty", 0, 0, "", "", floorplan.warm(), ()), {}, VerifySettings())


if __name__ == "__main__":
    runner.run(main)
