"""Stage `postopt`: drafts → walkable-area control → separation → verification → export; the dataset in data/shards."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from pipeline import params
from pipeline.entry import run
from pipeline.execution import Progress, cores
from pipeline.homes.drafts import drafts_of, read_drafts
from pipeline.homes.factory import Factory, open_factory
from pipeline.homes.jit_warmup import warm_up_workers
from pipeline.homes.planning import PlannedHome
from pipeline.homes.production import Recipe, fill
from pipeline.homes.prompt_mix import DatasetSettings, requests_of
from pipeline.homes.reproduction import header_of
from pipeline.homes.request import Request
from pipeline.manifest import digest, write_json
from pipeline.shards import open_or_create


def main(root: Path) -> None:
    """Finish the drafts of data/samples into the dataset; what an interrupted run committed is kept."""
    tree = params.read(root / "params.yaml")
    seed = tree["seed"]
    asked = requests_of(params.section(DatasetSettings, tree, "dataset"), root, seed)
    factory = open_factory(root, seed)
    header = header_of(factory, len(asked), digest([request.prompt for request in asked]))
    progress = Progress(len(asked), "postopt")
    with open_or_create(root / "data" / "shards", header, factory.asset_cache, discard=True) as dataset:
        recipe = Recipe(partial(open_factory, root, seed), partial(first_drafts, root))
        if dataset.missing():
            warm_up_workers(progress, root, recipe.opened, cores())
        tally = fill(dataset, recipe, lambda index: asked[index], workers=cores(), progress=progress)
    progress.close()
    for line in tally.lines():
        progress.say(line)
    if tally.homes:  # a resumed run that finds all done leaves the costs of the run that did the work
        costs = {f"cpu_seconds_per_home_{part}": round(spent / tally.homes, 4) for part, spent in tally.seconds.items()}
        write_json(root / "metrics" / "timing.json", costs)


def first_drafts(root: Path, factory: Factory, requests: Sequence[Request]) -> list[PlannedHome]:
    """Return the drafts that stage `sample` has made of these homes."""
    rows = read_drafts(root / "data" / "samples", factory.seed, [request.index for request in requests])
    return drafts_of(rows, requests, factory)


if __name__ == "__main__":
    run(main)
