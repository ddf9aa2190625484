"""Compiles what making homes runs, into the cache beside the code."""

import multiprocessing
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from pipeline import floorplan, params
from pipeline.execution import Progress
from pipeline.geometry.compiled import cache_folder, is_cold
from pipeline.homes.empty_plan import judge_empty
from pipeline.homes.factory import Factory
from pipeline.homes.request import Request
from pipeline.verify import VerifySettings

WHOLE = "whole-home"  # a file of the cache: what it takes to make a whole home has been compiled
SAMPLES = 2  # homes that are made to compile it


def warm(root: Path) -> None:
    """Plan a small home and judge it empty; from the cache this takes a second. `root` is the checkout."""
    judge_empty(floorplan.warm(), params.section(VerifySettings, params.read(root / "params.yaml"), "verify"))


def warm_up(progress: Progress, root: Path) -> None:
    """Compile where that was not done on this machine, in this process."""
    if is_cold():
        progress.say("compiling the planner, once on this machine: half a minute")
        warm(root)


def warm_up_workers(progress: Progress, root: Path, opened: Callable[[], Factory], workers: int) -> None:
    """Compile where that was not done on this machine, in a process that ends then: one that has compiled keeps 200 MiB for it.

    `opened` opens the factory there. Where that fails, or nothing can be kept, workers compile for themselves. One worker is this process.
    """
    if workers == 1:
        warm_up(progress, root)
    elif (folder := cache_folder()) is not None and not (folder / WHOLE).exists():
        progress.say("compiling, once on this machine: a minute")
        process = multiprocessing.get_context("spawn").Process(target=_make_homes, args=(opened, folder / WHOLE), daemon=True)
        process.start()
        process.join()


def _make_homes(opened: Callable[[], Factory], done: Path) -> None:
    """Make homes for what they compile, and say in the file `done` that it was."""
    with suppress(Exception, KeyboardInterrupt):  # whoever makes homes next says what is wrong
        opened().make([Request(index) for index in range(SAMPLES)])
        done.touch()
