"""DVC stage `baselines`: the peers' layout models and the paper's, trained for the same CPU time on the same rooms, in one table.

Does nothing unless `metrics.baselines` of params.yaml is true. Reads data/tables/ and data/latents/, writes
models/baselines/ (resumable) and metrics/baselines.json.
"""

from __future__ import annotations

import platform
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
from pipeline.experiments.baselines import cases_of, compare, controlled, spread
from pipeline.experiments.settings import MetricsSettings
from pipeline.manifest import write_json
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
    found = compared(made, job, settings, metrics.split)
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


def compared(made: Baselines, job: Job, settings: BaselineSettings, split: str) -> dict[str, Any]:
    """Return the table over the rooms of the split."""
    cases = cases_of(job.tables, split, job.layouts, job.scaling.classes, settings.slots)
    models = {name: partial(made.furnish, name) for name in BASELINES}
    opens = dict(zip(job.scaling.classes, job.opens.tolist(), strict=True))
    rng = seeds.generator(made.seed, "baselines-bootstrap")
    return {
        "models": compare(rng, models, spread(cases, settings.rooms), opens, settings.counts),
        "quantity": controlled(models["scenefoundry"], cases, settings.counts, settings.count_rooms),
    }


def report(state: Trainer) -> dict[str, Any]:
    """Return what a training run cost."""
    return {
        "parameters": sum(p.numel() for p in state.net.parameters()),
        "steps": state.done,
        "cpu_seconds": round(state.spent, 1),
        "machine": platform.machine(),
    }


if __name__ == "__main__":
    run(main)
