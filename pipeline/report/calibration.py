"""The chapter on the embedded corpus: every figure of metrics/calibration.json beside 3D-FRONT's."""

from collections.abc import Mapping, Sequence
from typing import Any

from pipeline.report.page import Picture, Section, TableView
from pipeline.report.plots import bars

Json = Mapping[str, Any]
GROUPS = {
    "classes": "Classes and objects per room, over the peers' labels and after their filters",
    "rooms_by_house": "Houses by the number of their furnished rooms",
    "areas": "Room areas",
    "shares": "Shares",
    "relations": "Where pieces stand to each other",
    "defects": "Defects of the files: observed, made",
}
HEADER = ("", "ours", "3D-FRONT", "to lie within", "n", "interval from", "")
SIZES = ("category", "models", "mean w, d, h / reference", "spread w, d, h / reference", "")


def calibration_section(figures: Json, pictures: Sequence[Picture]) -> Section:
    """Return the chapter: a table per group, one row per figure; sizes in one row per category."""
    lines = [entry for group in (*GROUPS, "sizes") for entry in figures[group].values()]
    met = sum(entry["ok"] for entry in lines)
    lead = f"{figures['houses']} houses, {figures['rooms']} rooms, counted as they were written: {met} of {len(lines)} figures lie where 3D-FRONT's do."
    tables = [TableView(caption, HEADER, [_row(*named) for named in figures[group].items()]) for group, caption in GROUPS.items()]
    tables.append(TableView("Sizes of models: ours over the reference's", SIZES, sizes(figures["sizes"])))
    return Section("The embedded corpus beside 3D-FRONT", [lead], tables, pictures)


def _row(name: str, entry: Json) -> list[str]:
    within = f"{entry['low']:.3f}-{entry['high']:.3f}"
    shown = [f"{entry[k]:.3f}" for k in ("ours", "reference")]
    return [name, *shown, within, str(entry["n"]), entry["basis"], "ok" if entry["ok"] else "not ok"]


def sizes(lines: Json) -> list[list[str]]:
    """Return one row per category from lines named "category, axis, mean|spread [m]"."""
    by: dict[str, dict[str, Json]] = {}
    for name, entry in lines.items():
        category, axis, what = name.removesuffix(" [m]").split(", ")
        by.setdefault(category, {})[f"{what} {axis}"] = entry
    rows = []
    for category, entries in by.items():
        ratios = [
            ", ".join(f"{entries[f'{what} {a}']['ours'] / entries[f'{what} {a}']['reference']:.2f}" for a in "wdh")
            for what in ("mean", "spread")
        ]
        ok = all(entry["ok"] for entry in entries.values())
        rows.append([category, str(next(iter(entries.values()))["n"]), *ratios, "ok" if ok else "not ok"])
    return rows


def plots(figures: Json) -> dict[str, bytes]:
    """Return the chapter's pictures by name: class frequencies and objects per room, ours beside the reference."""
    pictures = {}
    for group, y in (("frequencies", "share of objects"), ("histograms", "share of rooms")):
        for kind, shares in figures[group].items():
            values = {name: [entry[key] for entry in shares.values()] for name, key in (("ours", "ours"), ("3D-FRONT", "reference"))}
            title = f"{kind}: {'classes' if group == 'frequencies' else 'objects per room'}"
            pictures[f"{group}_{kind}"] = bars(values, [label.replace("_", " ") for label in shares], title=title, y=y)
    return pictures
