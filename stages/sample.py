"""Stage `sample`: prompts → floor plans → guided diffusion → retrieval; the first attempt at every home of the dataset."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path

from pipeline import params, tables
from pipeline.execution import map_shards, track
from pipeline.homes.drafts import draft_rows
from pipeline.homes.factory import HomeDraft, open_factory
from pipeline.homes.request import Request
from pipeline.homes.settings import DatasetSettings, requests_of
from schemas.objects import OBJECTS
from schemas.openings import OPENINGS
from schemas.rejects import REJECTS
from schemas.rooms import ROOMS
from schemas.scenes import SCENES
from stages import runner


def main(root: Path) -> None:
    """Draft the homes that section `dataset` of params.yaml asks for, into data/samples."""
    tree = params.read(root / "params.yaml")
    settings = params.section(DatasetSettings, tree, "dataset")
    asked = requests_of(settings, root, tree["seed"])
    chunk = open_factory(root, tree["seed"]).chunk
    jobs = [(number, asked[start : start + chunk]) for number, start in enumerate(range(0, len(asked), chunk))]
    done = map_shards(partial(draft, root, tree["seed"]), jobs, workers=min(os.cpu_count() or 1, len(jobs)))
    parts = dict(track(done, len(jobs), "sample", unit="chunk"))
    rows = draft_rows([home for number, _ in jobs for home in parts[number]], tree["seed"], open_factory(root, tree["seed"]).library)
    for table in (SCENES, ROOMS, OPENINGS, OBJECTS, REJECTS):
        tables.write(root / "data" / "samples" / f"{table.name}.parquet", table, rows[table.name])


def draft(root: Path, seed: int, requests: tuple[Request, ...]) -> list[HomeDraft]:
    """Draft one chunk of homes: the step that workers run."""
    return open_factory(root, seed).first_drafts(requests)


if __name__ == "__main__":
    runner.run(main)
