"""DVC stage `baselines`: the peers' layout models and the paper's, trained for the same CPU time on the same rooms, in one table.

Does nothing unless `metrics.baselines` of params.yaml is true. Reads data/tables/ and data/latents/, writes
models/baselines/ (the weights of ours) and metrics/baselines.json.
"""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import torch
from tqdm import tqdm

from pipeline import params
from pipeline.baselines import ours
from pipeline.baselines.job import BASELINES, NETS, Job, Trainer, furnish, open_job, train, trainer
from pipeline.baselines.rooms import BaselineSettings
from pipeline.diffusion.settings import SampleSettings, TrainSettings
from pipeline.entry import run
from pipeline.experiments.baselines import cases_of, compare_models
from pipeline.experiments.settings import MetricsSettings
from pipeline.manifest import write_json
from pipeline.relations.model import Relations


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
    trained = {name: trained_net(name, job, settings, tree["seed"]) for name in NETS}
    nets = {name: each.average for name, each in trained.items()}
    makers = {name: partial(furnish, name, nets[net].eval(), job, settings, tree["seed"]) for name, net in BASELINES.items()}
    layout = params.section(TrainSettings, tree, "train")
    own = ours.train_model(
        root, folder, replace(layout, start="scratch"), params.section(SampleSettings, tree, "sample"), settings.seconds, tree["seed"]
    )
    makers |= {"ours": partial(ours.furnish, own.sampler, "none"), "ours_guided": partial(ours.furnish, own.sampler, "heuristic")}
    cases = cases_of(getattr(job.sets, metrics.split), job.scaling.classes)
    opens = dict(zip(job.scaling.classes, job.opens.tolist(), strict=True))
    comparison = compare_models(makers, cases, opens, settings, tree["seed"], Relations.load(root / "data/tables/relations.json"))
    cost = {name: report(each) for name, each in trained.items()} | {"ours": own.cost}
    write_json(root / "metrics" / "baselines.json", comparison | {"trained": cost, "train_rooms": len(job.outlines)})


def trained_net(name: str, job: Job, settings: BaselineSettings, seed: int) -> Trainer:
    """Train one network."""
    net_trainer = trainer(name, job, settings, seed)
    with tqdm(total=round(settings.seconds), desc=name, unit="CPU s") as bar:
        for step in train(net_trainer, job.outlines, job.furniture, job.weights):
            bar.update(round(step.spent) - bar.n)
            bar.set_postfix(loss=f"{step.loss:.3f}", steps=step.done, refresh=False)
    return net_trainer


def report(state: Trainer) -> dict[str, Any]:
    """Return what a training run cost."""
    return {"parameters": sum(p.numel() for p in state.net.parameters()), "steps": state.done, "cpu_seconds": round(state.spent, 1)}


if __name__ == "__main__":
    run(main)
