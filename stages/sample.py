"""Stage `sample`: prompts → floor plans → guided diffusion → retrieval; the first attempt at every home of the dataset."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path

from pipeline import params
from pipeline.entry import run
from pipeline.execution import cores, map_jobs, track
from pipeline.homes.drafts import draft_rows, write_drafts
from pipeline.homes.factory import open_factory
from pipeline.homes.prompt_mix import DatasetSettings, requests_of
from pipeline.homes.request import Request
from pipeline.homes.rows import Row
from pipeline.manifest import write_json


def main(root: Path) -> None:
    """Draft the homes that section `dataset` of params.yaml asks for, into data/samples."""
    tree = params.read(root / "params.yaml")
    settings = params.section(DatasetSettings, tree, "dataset")
    asked, folder = requests_of(settings, root, tree["seed"]), root / "data" / "samples"
    factory = open_factory(root, tree["seed"])
    chunks = [asked[start : start + factory.chunk] for start in range(0, len(asked), factory.chunk)]
    spent: dict[str, float] = {}

    def parts() -> Iterator[tuple[tuple[Request, ...], dict[str, list[Row]]]]:
        done = map_jobs(partial(draft, root, tree["seed"]), chunks, workers=min(cores(), len(chunks)))
        for chunk, (rows, seconds) in track(done, len(asked), "sample", size=lambda pair: len(pair[0])):
            for part, value in seconds.items():
                spent[part] = spent.get(part, 0.0) + value
            yield chunk, rows

    write_drafts(folder, parts())
    costs = {f"cpu_seconds_per_home_first_{part}": round(value / len(asked), 4) for part, value in spent.items()}
    write_json(root / "metrics" / "sampling.json", costs)


def draft(root: Path, seed: int, requests: tuple[Request, ...]) -> tuple[dict[str, list[Row]], dict[str, float]]:
    """Draft one chunk of homes: the step that workers run. Returns their rows with the CPU seconds of each part."""
    factory = open_factory(root, seed)
    factory.seconds.clear()
    rows = draft_rows(factory.first_drafts(requests), seed, factory.library)
    return rows, {part: factory.seconds[part] for part in ("plan", "sample")}


if __name__ == "__main__":
    run(main)
