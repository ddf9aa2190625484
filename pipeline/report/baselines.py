"""The chapter of the layout models side by side: the peers' and the paper's, in this code."""

from collections.abc import Mapping
from typing import Any

from pipeline.report.page import Section, TableView
from pipeline.report.sections import share

Json = Mapping[str, Any]
NAMES = {
    "real": "real rooms",
    "atiss": "ATISS-type",
    "diffuscene": "DiffuScene-type",
    "physcene": "PhyScene-type",
    "scenefoundry": "SceneFoundry as printed",
    "ours": "ours, unguided",
    "ours_guided": "ours, guided",
}
TEXT = (
    "Small models, each trained for the CPU seconds of the last table on the same rooms: the table compares methods at that price, and is no "
    "figure of the papers. Drafts, as boxes; nothing is retrieved, moved or repaired. The number of objects is asked where a row says so; "
    "elsewhere SR(N) is chance."
)  # fmt: skip


def baselines_section(figures: Json) -> Section | None:
    """Return the tables of metrics/baselines.json; None where the baselines were not run."""
    if not figures:
        return None
    models, counts = {name: figures["models"][name] for name in NAMES}, sorted(figures["quantity"]["ours"], key=int)
    rows = [
        [
            NAMES[name], share(row["objects"]), share(row["r_acoll"]["rooms"]), share(row["collision"]["col_obj"]),
            f"{row['ckl']['real_to_generated']:.3f}", *(share(row["chance"][n]) for n in counts), f"{row.get('cpu_seconds_per_room', 0):.3f}",
        ]
        for name, row in models.items()
    ]  # fmt: skip
    rows += [
        [f"{NAMES[name]}, asked for N", *["-"] * 4, *(share(rates[n]) for n in counts), "-"] for name, rates in figures["quantity"].items()
    ]
    header = ("", "objects a room", "R_acoll, boxes + depth/3", "Col_obj, boxes", "CKL", *(f"SR({n})" for n in counts), "CPU s a room")
    rules = sorted(models["real"]["relations"])
    kept = [[rule, *(share(row["relations"][rule]) for row in models.values())] for rule in rules if models["real"]["relations"][rule]["n"]]
    kept.append(["SCA of a forest on layout features (.5 is best)", *(share(row.get("sca")) for row in models.values())])
    cost = [
        [NAMES[name], f"{row['parameters']:,}", str(row["steps"]), f"{row['cpu_seconds']:.0f}"] for name, row in figures["trained"].items()
    ]
    tables = [
        TableView(f"{models['real']['rooms']} rooms of the held-out split, with 95 % intervals", header, rows),
        TableView("Relations: share of cases where they hold", ("", *(NAMES[name] for name in models)), kept),
        TableView(f"Training, on {figures['train_rooms']:,} rooms", ("", "parameters", "steps", "CPU s"), cost),
    ]
    return Section("Layout models of the peers and of the paper", [TEXT], tables)
