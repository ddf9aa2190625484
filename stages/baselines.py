"""DVC stage `baselines`: the peers' layout models and the paper's, trained for the same CPU time on the same rooms, in one table.

Does nothing unless `metrics.baselines` of params.yaml is true. Reads data/tables/ and data/latents/, writes
models/baselines/ (weights and drafts; a run that was cut off goes on) and metrics/baselines.json.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

import torch
from tqdm import tqdm

from pipeline import params, seeds
from pipeline.baselines import weights
from pipeline.baselines.furnish import BASELINES, Baselines
from pipeline.baselines.job import NETS, Job, open_job, run_digest, trainer
from pipeline.baselines.settings import BaselineSettings
from pipeline.baselines.training import Trainer, train
from pipeline.diffusion.context import RoomContext
from pipeline.experiments.baselines import Drafts, asked, cases_of, drafted, figures, liveable, spread, success
from pipeline.experiments.settings import MetricsSettings
from pipeline.manifest import digest, write_json
from pipeline.relations import files
from pipeline.relations.known import Relations
from stages.runner import run


def main(root: Path) -> None:
    """Train what is not trained yet, and compare."""
    tree = params.read(root / "params.yaml")
    metrics, settings = params.section(MetricsSettings, tree, "metrics"), params.section(BaselineSettings, tree, "baselines")
    folder = root / "models" / "baselines"
    folder.mkdir(parents=True, exist_ok=True)
    if not metrics.baselines:
        write_json(root / "metrics" / "baselines.json", {})
        return
    torch.set_num_threads(1)  # CPU seconds are compared
    job = open_job(root, settings)
    trained = {name: trained_net(folder, name, job, settings, tree["seed"]) for name in NETS}
    nets = {name: each.average for name, each in trained.items()}
    made = Baselines(nets, job.scaling, settings, job.layouts, job.opens, tree["seed"])
    found = compared(folder, made, trained, job, files.load(root / "data/tables/relations.json"), metrics.split)
    write_json(
        root / "metrics" / "baselines.json",
        found | {"trained": {name: report(each) for name, each in trained.items()}, "train_rooms": len(job.outlines)},
    )


def trained_net(folder: Path, name: str, job: Job, settings: BaselineSettings, seed: int) -> Trainer:
    """Train, or go on training, one network."""
    made, path, key = trainer(name, job, settings, seed), folder / f"{name}.safetensors", run_digest(name, job, settings, seed)
    weights.restore(path, key, made)

    def save(state: Trainer) -> None:
        weights.write(path, key, state, job.scaling)

    with tqdm(total=round(settings.seconds), initial=round(made.spent), desc=name, unit="CPU s") as bar:
        for step in train(made, job.outlines, job.furniture, job.weights, save):
            bar.update(round(step.spent) - bar.n)
            bar.set_postfix(loss=f"{step.loss:.3f}", steps=step.done, refresh=False)
    return made


def compared(folder: Path, made: Baselines, trained: Mapping[str, Trainer], job: Job, known: Relations, split: str) -> dict[str, Any]:
    """Furnish the rooms of the split with every baseline, and return their figures beside those of the real rooms."""
    settings, classes = made.settings, job.scaling.classes
    cases = cases_of(job.tables, split, job.layouts, classes, settings.slots)
    shown = spread(cases, settings.rooms)

    def drafts(name: str, label: str, rooms: Sequence[RoomContext]) -> Drafts:
        net = trained[BASELINES[name]]
        key = digest([asdict(settings), run_digest(net.name, job, settings, made.seed), net.done, [str(r) for r in rooms]])
        return drafted(folder / f"{label}.json", key, partial(made.furnish, name), rooms)

    found = {name: drafts(name, name, [case.context for case in shown]) for name in BASELINES}
    counted = {n: drafts("scenefoundry", f"scenefoundry_{n}", asked(cases, n, settings.count_rooms)) for n in settings.counts}
    real, opens = [case.real for case in shown], dict(zip(classes, job.opens.tolist(), strict=True))
    rng = seeds.generator(made.seed, "baselines-bootstrap")
    made_by = {"real": real} | {name: each.rooms for name, each in found.items()}
    lived = liveable(rng, made.seed, shown, made_by, known)
    models = {name: figures(rng, shown, rooms, real, opens, settings.counts) | lived[name] for name, rooms in made_by.items()}
    for name, each in found.items():
        models[name]["cpu_seconds_per_room"] = round(each.seconds / len(shown), 4)
    return {"models": models, "quantity": {str(n): success(each.rooms, n) for n, each in counted.items()}}


def report(state: Trainer) -> dict[str, Any]:
    """Return what a training run cost."""
    return {
        "parameters": sum(p.numel() for p in state.net.parameters()),
        "steps": state.done,
        "cpu_seconds": round(state.spent, 1),
    }


if __name__ == "__main__":
    run(main)
