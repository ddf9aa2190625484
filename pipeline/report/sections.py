"""The chapters of the report, from the figures of metrics.json."""

from collections.abc import Mapping, Sequence
from typing import Any

from pipeline.report.page import Picture, Section, TableView

Json = Mapping[str, Any]


def share(value: Mapping[str, Any] | None) -> str:
    """Show a rate or mean with its 95 % interval."""
    if not value:
        return "none"
    middle = value.get("rate", value.get("mean"))
    return f"{middle:.3f} ({value['low']:.2f}-{value['high']:.2f})"


def dataset_section(dataset: Json, timing: Json, pictures: Sequence[Picture]) -> Section:
    """Return what was made, and what it cost."""
    rows = [[name.replace("_", " "), f"{value:.4g}" if isinstance(value, float) else str(value)] for name, value in dataset.items()]
    cost = [[name.removeprefix("cpu_seconds_per_home_").replace("_", " "), f"{value:.3f}"] for name, value in timing.items()]
    return Section(
        "The dataset",
        ["Every home below was judged: no collisions, every joint moves through its whole range, every room can be entered."],
        [TableView("What data/shards holds", ("figure", "value"), rows), TableView("CPU seconds per home, by part", ("part", "s"), cost)],
        pictures,
    )


def quantity_section(table: Json, picture: Picture) -> Section:
    """Return SR(N) beside the paper's figure."""
    kinds = ("plain", "drafted", "first", "shipped")
    rows = [[n, *(share(r[k]) for k in kinds), f"{r['ships']:.2f}", "0.95-0.97"] for n, r in table.items()]
    header = ("N", "no guidance", "guided, drafted", "first attempts, finished", "rooms that ship", "share that ships", "the paper")
    return Section("Object quantity", [], [TableView("SR(N): exactly N objects, with 95 % intervals", header, rows)], [picture])


def walkable_section(table: Json, picture: Picture) -> Section:
    """Return SR(tau) in both meanings of R_walkable."""
    rows = [
        [tau, *(share(r[m][w]) for m in ("free", "paper") for w in ("without", "first", "with")), f"{r['ships']:.2f}"]
        for tau, r in table.items()
    ]
    kinds = ("without", "first attempts", "rooms that ship")
    header = ("tau", *(f"{meaning}: {kind}" for meaning in ("free", "paper") for kind in kinds), "share that ships")
    text = [
        "Free is connected floor that the robot covers, over all floor; this one is controlled.",
        "Paper is (A_room - sum of footprints) / A_room, as printed.",
    ]
    return Section("Walkable area", text, [TableView("SR(tau) over rooms that ship, with 95 % intervals", header, rows)], [picture])


ARTICULATION = (  # the figure, where it lies, and the paper's, without and with guidance
    ("R_acoll, boxes + depth/3", lambda f: f["r_acoll_heuristic"]["rooms"], "0.191 / 0.109"),
    ("R_acoll, joints' sweeps", lambda f: f["r_acoll_joints"]["rooms"], "-"),
    ("blocked joints, exact", lambda f: f["swept"]["joints"], "-"),
    ("R_reach", lambda f: f["r_reach"], "0.742 / 0.808"),
    ("openable in reach", lambda f: f["reach"]["objects"], "-"),
    ("Col_obj, boxes", lambda f: f["collision"]["bbox"]["col_obj"], "0.279 / 0.267"),
    ("Col_obj, exact", lambda f: f["collision"]["prism"]["col_obj"], "-"),
    ("openable per room", lambda f: f["openable"]["shipped"], "-"),
    ("objects per room", lambda f: f["openable"]["objects"], "-"),
)


def articulation_section(table: Json, ablation: Json) -> Section:
    """Return articulation with and without guidance, and the ablation."""
    rows = [[label, *(share(figure(figures)) for figures in table.values()), paper] for label, figure, paper in ARTICULATION]
    titles = ("", *(name.replace("_", ", ") for name in table), "the paper, without / with")
    cut = [
        [name, share(r["col_obj"]), share(r["r_walkable"]["paper"]), share(r["r_walkable"]["free"]), share(r["r_reach"])]
        for name, r in ablation.items()
    ]
    return Section(
        "Articulated collisions",
        [
            "plain: no guidance. heuristic: the paper's axis-aligned extension. guided: the joints' swept volumes. drafted: all first attempts, before post-optimisation."
        ],
        [
            TableView("Rooms of the test split", titles, rows),
            TableView("Ablation", ("mechanisms", "Col_obj", "R_walkable (paper)", "R_walkable (free)", "R_reach"), cut),
        ],
    )


def category_section(table: Json) -> Section:
    """Return CKL in both directions beside its noise floor."""
    rows = [
        [k.replace("_", " "), f"{v['generated_to_real']:.4f}", f"{v['real_to_generated']:.4f}", str(v["generated_objects"])]
        for k, v in table.items()
    ]
    header = ("against the test split", "D(generated || real)", "D(real || generated)", "objects")
    text = ["The first row is the noise floor: two halves of the same corpus. The paper reports 0.0024 on 3D-FRONT, with 1,000 scenes."]
    return Section("Categories (CKL)", text, [TableView("Divergence of category frequencies [nat]", header, rows)])


def plan_section(table: Json) -> Section:
    """Return the floor plan scores beside the paper's."""
    m = table["mean"]
    rows = [
        ["S_node", f"{m['node']:.3f}", "0.989"],
        ["S_constraint", f"{m['constraint']:.3f}", "0.923"],
        ["S_edge", f"{m['edge']:.3f}", "0.954"],
        ["benchmark score", f"{_benchmark(m):.3f}", "0.954"],
        ["all met exactly", f"{m['strict']:.3f}", "0.70"],
        ["CPU seconds per prompt", f"{m['cpu_seconds']:.2f}", "272 (wall)"],
    ]
    each = [
        [r["id"], *(f"{v:.2f}" for v in (own["node"], own["constraint"], own["edge"], _benchmark(own), own["strict"], own["cpu_seconds"]))]
        for r in table["prompts"]
        for own in [r["mean"]]
    ]
    header = ("prompt", "S_node", "S_constraint", "S_edge", "score", "strict", "CPU s")
    return Section(
        "Floor plans from language",
        [f"Twenty prompts, {table['seeds']} seeds each, built-in parser, no language model."],
        [TableView("Means", ("", "ours", "the paper"), rows), TableView("Each prompt", header, each)],
    )


def _benchmark(mean: Json) -> float:
    """Return the paper's benchmark score: presence, adjacency and constraints by its weights."""
    return 0.5 * float(mean["presence"]) + 0.3 * float(mean["adjacency"]) + 0.2 * float(mean["constraints"])


def training_section(encode: Json, train: Json, pictures: Sequence[Picture]) -> Section:
    """Return what the models learnt."""
    flat = {**{f"encoder: {k}": v for k, v in encode.items()}, **{f"denoiser: {k}": v for k, v in train.items()}}
    rows = [[k.replace("_", " "), f"{v:.4g}" if isinstance(v, float) else str(v)] for k, v in flat.items() if isinstance(v, (int, float))]
    return Section("Models", [], [TableView("Shape encoder and layout denoiser", ("figure", "value"), rows)], pictures)


def reject_section(rows: Sequence[Sequence[str]]) -> Section:
    """Return what was left out, repaired or tried again: stage, kind of thing, reason, effect, count, meaning, first case."""
    header = ("stage", "what", "reason", "effect", "count", "meaning", "for instance")
    text = ["Nothing is dropped or changed silently; docs/reasons.md lists all codes. One home may be tried several times."]
    return Section("Rejects", text, [TableView("Counts", header, rows)])
