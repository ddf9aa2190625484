"""Stage `metrics`: every metric and table of the paper, with intervals and the noise floor; plots; the report."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from operator import itemgetter
from pathlib import Path
from typing import Any

from pipeline import params, seeds, tables, taxonomy
from pipeline.entry import run
from pipeline.execution import cores, map_jobs, track
from pipeline.experiments import paper_tables
from pipeline.experiments.dataset import dataset_coherence, dataset_figures
from pipeline.experiments.document import write_report
from pipeline.experiments.prompts import evaluate_prompts, read_prompts
from pipeline.experiments.realism import beside, embeddings, realism_table
from pipeline.experiments.settings import MetricsSettings, spread
from pipeline.experiments.trials import Condition, Drafts, Trial, test_rooms, trial
from pipeline.floorplan import parse
from pipeline.homes.factory import open_factory
from pipeline.homes.request import RoomJob
from pipeline.homes.rows import Row
from pipeline.manifest import write_bytes, write_json
from pipeline.metrics.collision import sweeps_of
from pipeline.relations.model import Relations
from schemas import OBJECTS, OPENINGS, ROOMS, SCENES

LIVED_IN = ("living_dining_room", "living_room", "bedroom", "dining_room", "kitchen", "kids_room", "study")


def main(root: Path) -> None:
    """Measure, and write metrics/metrics.json, plots/ and report/."""
    tree = params.read(root / "params.yaml")
    settings, seed = params.section(MetricsSettings, tree, "metrics"), tree["seed"]
    parts: list[Callable[[], Any]] = [partial(run_family, root, seed, settings, family) for family in paper_tables.families(settings)]
    parts.append(partial(plans, root, settings))
    jobs = map_jobs(partial(measure, parts), range(len(parts)), workers=min(cores(), len(parts)))
    *families, plan = (measurement for _, measurement in sorted(track(jobs, len(parts), "metrics", unit="experiment"), key=itemgetter(0)))
    trials: dict[str, Trial] = {name: measurement for family in families for name, measurement in family.items()}
    factory = open_factory(root, seed)
    rng = seeds.generator(seed, "bootstrap")
    source = {t.name: tables.read(root / "data" / "tables" / f"{t.name}.parquet", t) for t in (SCENES, OBJECTS)}
    split = {s["scene_id"]: s["split"] for s in source["scenes"]}
    real = [o for o in source["objects"] if split[o["scene_id"]] == "train"]
    held_out = [o for o in source["objects"] if split[o["scene_id"]] == settings.split]
    rooms = len(trials["plain"].drafted["rooms"])
    figures = {
        "dataset": dataset_figures(root / "data" / "shards"),
        "quantity": paper_tables.quantity_table(trials, settings.counts, settings.rooms),
        "walkable": paper_tables.walkable_table(trials, settings.taus, rooms),
        "articulation": paper_tables.articulation_table(rng, trials, sweeps_of(factory.library.joints), factory.library),
        "ablation": paper_tables.ablation_table(rng, trials, settings.taus),
        "coherence": dataset_coherence(root, rng, held_out),
        "category": paper_tables.category_table(trials, real, held_out, taxonomy.load().names),
        "realism": realism(root, seed, settings, trials),
        "plan": plan,
    }
    write_json(root / "metrics" / "metrics.json", figures)
    for name, text in paper_tables.curves(figures).items():
        write_bytes(root / "plots" / f"{name}.csv", text.encode())
    write_report(root, figures, factory, settings)


def realism(root: Path, seed: int, settings: MetricsSettings, trials: Mapping[str, Trial]) -> dict[str, Any]:
    """Put what was drafted for the split's floors, and what shipped, beside the rooms that stand there."""
    plain, guided = trials[paper_tables.ALL_PLAIN], trials[paper_tables.ALL_GUIDED]
    generated = {"unguided": plain.drafted, "guided": guided.drafted, "finished": guided.shipped}
    known = Relations.load(root / "data" / "tables" / "relations.json")
    return realism_table(seed, beside(root, settings.split, generated), known, embeddings(settings.inception))


def measure(parts: Sequence[Callable[[], Any]], number: int) -> Any:
    """Do one part of the work: the step that workers run."""
    return parts[number]()


def run_family(root: Path, seed: int, settings: MetricsSettings, family: Sequence[Condition]) -> dict[str, Trial]:
    """Run the conditions of one family, which share their drafts; return them by name."""
    named = (SCENES, ROOMS, OPENINGS)
    source = {t.name: tables.read(root / "data" / "tables" / f"{t.name}.parquet", t) for t in named}
    factory = open_factory(root, seed)
    drafts = Drafts(factory, family[0].articulation)
    return {condition.name: trial(factory, _rooms(source, settings, condition), condition, drafts) for condition in family}


def _rooms(source: Mapping[str, Sequence[Row]], settings: MetricsSettings, condition: Condition) -> Sequence[RoomJob]:
    if condition.name in {paper_tables.ALL_PLAIN, paper_tables.ALL_GUIDED}:
        return spread(test_rooms(source, settings.split, taxonomy.load().layout_types), settings.all_rooms)
    jobs = test_rooms(source, settings.split, LIVED_IN)
    if condition.count is not None:  # rooms that can hold so many things: 1.2 m2 of floor for each
        jobs = [job for job in jobs if job.room.area >= 1.2 * condition.count] or jobs
    return spread(jobs, settings.rooms)


def plans(root: Path, settings: MetricsSettings) -> dict[str, Any]:
    """Score the floor plans of the benchmark's prompts."""
    return evaluate_prompts(
        read_prompts(root / "manifests/prompts/benchmark.yaml"), settings.plan_seeds, lambda case: parse(case["prompt"])
    )


if __name__ == "__main__":
    run(main)
