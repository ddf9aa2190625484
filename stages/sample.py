"""Stage `sample`: prompts → floor plans → guided diffusion → retrieval; the first attempt at every home of the dataset."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from pipeline import params, tables
from pipeline.entry import run
from pipeline.execution import cores, map_jobs, track
from pipeline.homes.drafts import draft_rows
from pipeline.homes.factory import open_factory
from pipeline.homes.furnish import HomeDraft
from pipeline.homes.request import Request
from pipeline.homes.settings import DatasetSettings, requests_of
from pipeline.manifest import write_json
from schemas.objects import OBJECTS
from schemas.openings import OPENINGS
from schemas.rejects import REJECTS
from schemas.rooms import ROOMS
from schemas.scenes import SCENES


def main(root: Path) -> None:
    """Draft the homes that section `dataset` of params.yaml asks for, into data/samples."""
    tree = params.read(root / "params.yaml")
    settings = params.section(DatasetSettings, tree, "dataset")
    asked = requests_of(settings, root, tree["seed"])
    chunk = open_factory(root, tree["seed"]).chunk
    jobs = [asked[start : start + chunk] for start in range(0, len(asked), chunk)]
    done = map_jobs(partial(draft, root, tree["seed"]), jobs, workers=min(cores(), len(jobs)))
    parts = dict(track(done, len(asked), "sample", size=lambda pair: len(pair[0])))
    rows = draft_rows([home for job in jobs for home in parts[job][0]], tree["seed"], open_factory(root, tree["seed"]).library)
    for table in (SCENES, ROOMS, OPENINGS, OBJECTS, REJECTS):
        tables.write(root / "data" / "samples" / f"{table.name}.parquet", table, rows[table.name])
    spent = {part: sum(seconds[part] for _, seconds in parts.values()) for part in ("plan", "sample")}
    costs = {f"cpu_seconds_per_home_first_{part}": round(value / len(asked), 4) for part, value in spent.items()}
    write_json(root / "metrics" / "sampling.json", costs)


def draft(root: Path, seed: int, requests: tuple[Request, ...]) -> tuple[list[HomeDraft], dict[str, float]]:
    """Draft one chunk of homes: the step that workers run. Returns them with the CPU seconds of each part."""
    factory = open_factory(root, seed)
    factory.seconds.clear()
    return factory.first_drafts(requests), dict(factory.seconds)


if __name__ == "__main__":
    run(main)
