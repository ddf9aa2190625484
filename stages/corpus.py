"""The embedded corpus: 3D-FRONT houses, 3D-FUTURE models, PartNet-Mobility/GAPartNet objects, in the formats of the real sets.

Writes data/raw/, metrics/calibration.json (the corpus beside what is known of 3D-FRONT) and plots/classes.csv.
"""

import json
import multiprocessing
import shutil
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import partial
from pathlib import Path
from typing import Any

from pipeline import params
from pipeline.corpus.calibration import HouseTally, calibration, write_calibration
from pipeline.corpus.furniture.catalogue import Model, catalogue
from pipeline.corpus.future_writer import info, write_model
from pipeline.corpus.house_files import CorpusSettings, write_houses
from pipeline.corpus.houses import corruption
from pipeline.corpus.partnet_writer import write_partnet
from pipeline.entry import run
from pipeline.execution import cores, track
from pipeline.floorplan import warm

RAW = Path("data/raw")
BATCH = 10
Done = tuple[int, list[HouseTally]]
"""How many things a task wrote, and what its houses count."""
Task = Callable[[], Done]


def main(root: Path) -> None:
    """Make the corpus of params.yaml under data/raw: in a temporary folder, which takes its place when it is whole."""
    tree = params.read(root / "params.yaml")
    settings = params.section(CorpusSettings, tree, "corpus")
    corpus = make(root / RAW, params.convert(int, tree.get("seed"), "seed"), settings, workers=cores())
    write_calibration(root, corpus)


def make(target: Path, seed: int, settings: CorpusSettings, workers: int) -> dict[str, Any]:
    """Write the corpus to `target`, whole or not at all; return the calibration."""
    making, old = target.with_name(f".{target.name}.making"), target.with_name(f".{target.name}.old")
    if old.exists() and not target.exists():  # a run was killed while it swapped the two
        old.replace(target)
    for leftover in (making, old):
        shutil.rmtree(leftover, ignore_errors=True)
    making.mkdir(parents=True)
    warm()  # before workers start, which would each compile the planner
    jobs = list(tasks(making, seed, settings))
    total = sum(n for n, _ in jobs)
    tallies: list[HouseTally] = []
    for _, houses in track(run_tasks([job for _, job in jobs], workers), total, "corpus", unit="file", size=lambda done: done[0]):
        tallies += houses
    if target.exists():
        target.replace(old)
    making.replace(target)
    shutil.rmtree(old, ignore_errors=True)
    models = catalogue(seed, settings.models).future
    return calibration(tallies, models, len(corruption.in_centimetres(seed, models) if settings.corruption else ()))


def tasks(folder: Path, seed: int, settings: CorpusSettings) -> Iterator[tuple[int, Task]]:
    """Cut the work into batches that depend on nothing but their arguments; yields (number of things, task)."""
    models = catalogue(seed, settings.models)
    centimetres = corruption.in_centimetres(seed, models.future) if settings.corruption else frozenset()
    front = folder / "3d-front"
    for name in ("3D-FRONT", "3D-FUTURE-model"):
        (front / name).mkdir(parents=True)
    (folder / "partnet").mkdir()
    for start in range(0, len(models.future), BATCH):
        part = models.future[start : start + BATCH]
        yield len(part), partial(_future, part, front / "3D-FUTURE-model", centimetres)
    records = [info(model) for model in models.future]
    (front / "3D-FUTURE-model" / "model_info.json").write_text(json.dumps(records, indent=1) + "\n", encoding="utf-8")
    for start in range(0, len(models.partnet), BATCH):
        part = models.partnet[start : start + BATCH]
        yield len(part), partial(_partnet, part, folder / "partnet")
    for start in range(0, settings.houses, BATCH):
        indices = range(start, min(start + BATCH, settings.houses))
        yield len(indices), partial(_houses, front / "3D-FRONT", seed, settings, indices)


def run_tasks(jobs: Sequence[Task], workers: int) -> Iterator[Done]:
    """Run the tasks on that many processes and yield what each did."""
    if workers == 1:
        for job in jobs:
            yield job()
        return
    method = "fork" if "fork" in multiprocessing.get_all_start_methods() else "spawn"
    with ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context(method)) as pool:
        try:
            for future in as_completed([pool.submit(job) for job in jobs]):
                yield future.result()
        finally:
            pool.shutdown(cancel_futures=True)


def _houses(folder: Path, seed: int, settings: CorpusSettings, indices: range) -> Done:
    return len(indices), write_houses(folder, seed, settings, indices)


def _future(models: Sequence[Model], folder: Path, centimetres: frozenset[str]) -> Done:
    for model in models:
        write_model(model, folder / model.model_id, 100.0 if model.model_id in centimetres else 1.0)
    return len(models), []


def _partnet(models: Sequence[Model], folder: Path) -> Done:
    write_partnet(models, folder)
    return len(models), []


if __name__ == "__main__":
    run(main)
