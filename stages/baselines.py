"""DVC stage `baselines`: the peers' layout models and the paper's, trained for the same CPU time on the same rooms, in one table.

Does nothing unless `metrics.baselines` of params.yaml is true. Reads data/tables/ and data/latents/, writes
models/baselines/ (weights and drafts; a run that was cut off goes on) and metrics/baselines.json.
"""

from __future__ import annotations

from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any

import torch
from tqdm import tqdm

from pipeline import params
from pipeline.baselines import ours, weights
from pipeline.baselines.furnish import BASELINES, Baselines
from pipeline.baselines.job import NETS, Job, open_job, run_digest, trainer
from pipeline.baselines.settings import BaselineSettings
from pipeline.baselines.training import Trainer, train
from pipeline.diffusion.settings import SampleSettings, TrainSettings
from pipeline.entry import run
from pipeline.experiments.baselines import Maker, cases_of, compared
from pipeline.experiments.settings import MetricsSettings
from pipeline.manifest import digest, write_json
from pipeline.relations import files


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
    makers = {
        name: Maker(
            digest([asdict(settings), run_digest(net, job, settings, tree["seed"]), trained[net].done]), partial(made.furnish, name)
        )
        for name, net in BASELINES.items()
    }
    layout = params.section(TrainSettings, tree, "train")
    own = ours.trained(
        root, folder, replace(layout, start="scratch"), params.section(SampleSettings, tree, "sample"), settings.seconds, tree["seed"]
    )
    key = digest([own.cost, asdict(own.sampler.settings), tree["seed"]])
    makers |= {"ours": Maker(key, partial(ours.unguided, own.sampler)), "ours_guided": Maker(key, partial(ours.guided, own.sampler))}
    cases = cases_of(job.tables, metrics.split, job.layouts, job.scaling.classes, settings.slots)
    opens = dict(zip(job.scaling.classes, job.opens.tolist(), strict=True))
    found = compared(folder, makers, cases, opens, settings, tree["seed"], files.load(root / "data/tables/relations.json"))
    cost = {name: report(each) for name, each in trained.items()} | {"ours": own.cost}
    write_json(root / "metrics" / "baselines.json", found | {"trained": cost, "train_rooms": len(job.outlines)})


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


def report(state: Trainer) -> dict[str, Any]:
    """Return what a training run cost."""
    return {
        "parameters": sum(p.numel() for p in state.net.parameters()),
        "steps": state.done,
        "cpu_seconds": round(state.spent, 1),
    }


if __name__ == "__main__":
    run(main)
