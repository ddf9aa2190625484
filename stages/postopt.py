"""Stage `postopt`: drafts → walkable-area control → separation → verification → export; the dataset in data/shards."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path
from typing import Any

from pipeline import params, tables
from pipeline.execution import map_shards, track
from pipeline.homes.drafts import drafts_of
from pipeline.homes.factory import Outcome, open_factory
from pipeline.homes.request import Request
from pipeline.homes.settings import DatasetSettings, requests_of
from pipeline.manifest import digest, write_json
from pipeline.shards import Header, commit_library, commit_shard, gather, open_or_create
from schemas.objects import OBJECTS
from schemas.openings import OPENINGS
from schemas.rejects import REJECTS
from schemas.rooms import ROOMS
from schemas.scenes import SCENES
from stages import runner


def main(root: Path) -> None:
    """Finish the drafts of data/samples into the dataset; what an interrupted run committed is kept."""
    tree = params.read(root / "params.yaml")
    seed = tree["seed"]
    asked = requests_of(params.section(DatasetSettings, tree, "dataset"), root, seed)
    factory = open_factory(root, seed)
    named = {**factory.digests, "prompts": digest([request.prompt for request in asked])}
    header = Header(seed, len(asked), factory.shard_size, factory.licence, named)
    seconds: dict[str, float] = {}
    with open_or_create(root / "data" / "shards", header, discard=True) as dataset:
        commit_library(dataset, factory.write_library)
        todo = [asked[i] for number in dataset.missing() for i in header.indices(number)]
        jobs = [(n, tuple(todo[i : i + factory.chunk])) for n, i in enumerate(range(0, len(todo), factory.chunk))]
        made: dict[int, Outcome] = {}
        done = map_shards(partial(finish, root, seed), jobs, workers=min(os.cpu_count() or 1, len(jobs)))
        for _, (outcomes, spent) in track(done, len(jobs), "postopt", unit="chunk"):
            made |= {outcome.home.index: outcome for outcome in outcomes}
            seconds |= {part: seconds.get(part, 0.0) + value for part, value in spent.items()}
        for number in dataset.missing():
            homes = [made[i] for i in header.indices(number)]
            commit_shard(dataset, number, gather(number, [(home.rows, home.files) for home in homes]))
    if todo:  # a resumed run that finds all done leaves the costs of the run that did the work
        costs = {f"cpu_seconds_per_home_{part}": round(spent / len(todo), 4) for part, spent in seconds.items()}
        write_json(root / "metrics" / "timing.json", costs)


def finish(root: Path, seed: int, requests: tuple[Request, ...]) -> tuple[list[Outcome], dict[str, float]]:
    """Finish one chunk of homes: the step that workers run. Returns them with the CPU seconds of each part."""
    factory = open_factory(root, seed)
    factory.seconds.clear()
    drafts = drafts_of(samples(root), requests, factory)
    return factory.make(requests, drafts), dict(factory.seconds)


def samples(root: Path) -> dict[str, list[dict[str, Any]]]:
    """Read the tables of stage `sample`."""
    folder = root / "data" / "samples"
    return {t.name: tables.read(folder / f"{t.name}.parquet", t) for t in (SCENES, ROOMS, OPENINGS, OBJECTS, REJECTS)}


if __name__ == "__main__":
    runner.run(main)
