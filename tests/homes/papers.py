"""A factory of paper that workers can open: its homes are made-up rows, and some of them kill, stop or trip who makes them."""

import functools
import json
import os
import signal
import sys
import time
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

sys.path.insert(0, str(Path(__file__).parents[1] / "shards"))
import made

from pipeline.execution import tell
from pipeline.homes.request import Request

HEADER = made.HEADER  # 10 homes in shards of 4


def request(index):
    return Request(index, f"home {index}")


class Paper:
    """`die` and `hang` name a home that takes every worker with it; `die_once` homes that take the first; `stumble` homes with a bug.

    `crowd` commands wait for each other at the first home of each; at home `stop` (or its "first") one waits for good, and is not silent.
    """

    chunk = 4

    def __init__(self, folder, die=None, hang=None, die_once=(), stumble=(), crowd=0, stop=None, shard_seconds=30.0):
        self.folder, self.seed, self.seconds = Path(folder), HEADER.seed, {}
        self.die, self.hang, self.die_once, self.stumble = die, hang, die_once, stumble
        self.crowd, self.stop = crowd, stop
        self.shard = SimpleNamespace(home_seconds=2.0, shard_seconds=shard_seconds)

    @property
    def digests(self):
        """What lies in the folder now."""
        path = self.folder / "weights"
        return {"weights": path.read_text() if path.exists() else ""}

    @property
    def asset_cache(self):
        return made.AssetSource(self.folder / "cache")

    @contextmanager
    def time(self, part):
        self.seconds[part] = 1.0
        yield

    def make(self, requests, first=None):
        assert first is None
        return [self.home(r.index) for r in requests]

    def home(self, index):
        tell("planning", index)
        who = os.environ.get("PAPER_COMMAND", "")
        begun = self.folder / "begun"
        begun.mkdir(exist_ok=True)
        (begun / f"by-{who}").touch()
        while len(list(begun.iterdir())) < self.crowd or self.stop in {index, "first"}:
            tell("waiting at", index)
            time.sleep(0.05)
        mark = self.folder / f"died-{index}"
        if index == self.die or (index in self.die_once and not mark.exists()):
            mark.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        if index == self.hang:
            time.sleep(600)
        if index in self.stumble:
            raise ZeroDivisionError("a bug")
        with (self.folder / "made.txt").open("a") as log:
            log.write(f"{index} {who}\n")
        rows, files = made.home(index)
        return SimpleNamespace(rows=rows, files=files)


def open_paper(folder, **asked):
    (Path(folder) / "cache").mkdir(exist_ok=True)
    return Paper(folder, **asked)


if __name__ == "__main__":
    os.environ["PAPER_COMMAND"] = str(os.getpid())  # which its workers inherit

    from pipeline.shards.claims import Claims

    Claims.__init__.__kwdefaults__["patience"] = 1e9  # so that who is slow is never taken for gone, and who is gone is not found by waiting
    from pipeline.execution import Progress
    from pipeline.homes.production import Recipe, fill
    from pipeline.shards import open_or_create

    out, count = Path(sys.argv[1]), int(sys.argv[4])
    with open_or_create(out, replace(HEADER, count=count), made.AssetSource(out.parent / "cache")) as dataset:
        recipe = Recipe(functools.partial(open_paper, str(out.parent), **json.loads(sys.argv[2])))
        fill(dataset, recipe, request, workers=int(sys.argv[3]), progress=Progress(count, "homes"))
