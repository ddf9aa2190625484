"""Stage `sample`: prompts → floor plans → guided diffusion → retrieval; the first attempt at every home of the dataset."""

from functools import partial
from pathlib import Path

from pipeline import params
from pipeline.entry import run
from pipeline.execution import cores, map_jobs, track
from pipeline.homes.draft_store import DraftStore, Row
from pipeline.homes.drafts import draft_rows
from pipeline.homes.factory import open_factory
from pipeline.homes.request import Request
from pipeline.homes.settings import DatasetSettings, requests_of
from pipeline.manifest import digest, write_json


def main(root: Path) -> None:
    """Draft the homes that section `dataset` of params.yaml asks for, into data/samples; an interrupted run goes on."""
    tree = params.read(root / "params.yaml")
    settings = params.section(DatasetSettings, tree, "dataset")
    asked, folder = requests_of(settings, root, tree["seed"]), root / "data" / "samples"
    factory = open_factory(root, tree["seed"])
    store = DraftStore(folder, digest([factory.digests, factory.chunk, [request.prompt for request in asked]]))
    jobs = [asked[start : start + factory.chunk] for start in range(0, len(asked), factory.chunk)]
    todo = [job for job in jobs if not store.has(job[0].index)]
    done = map_jobs(partial(draft, root, tree["seed"]), todo, workers=min(cores(), max(1, len(todo))))
    for job, (rows, seconds) in track(done, sum(map(len, todo)), "sample", size=lambda pair: len(pair[0])):
        store.put(job[0].index, rows, seconds)
    costs = {f"cpu_seconds_per_home_first_{part}": round(value / len(asked), 4) for part, value in store.seconds().items()}
    store.join()
    write_json(root / "metrics" / "sampling.json", costs)


def draft(root: Path, seed: int, requests: tuple[Request, ...]) -> tuple[dict[str, list[Row]], dict[str, float]]:
    """Draft one chunk of homes: the step that workers run. Returns their rows with the CPU seconds of each part."""
    factory = open_factory(root, seed)
    factory.seconds.clear()
    rows = draft_rows(factory.first_drafts(requests), seed, factory.library)
    return rows, {part: factory.seconds[part] for part in ("plan", "sample")}


if __name__ == "__main__":
    run(main)
