"""The chapter of the report that puts made rooms beside real ones."""

from collections.abc import Mapping, Sequence
from typing import Any

from pipeline.report.page import Picture, Section, TableView
from pipeline.report.sections import share

Json = Mapping[str, Any]

TITLES = {
    "real": "real",
    "train": "real, of split train",
    "unguided": "drafts, unguided",
    "guided": "drafts, guided",
    "finished": "finished",
    "shipped": "shipped",
}
VOID = "Void, for harm that is not seen:"


def realism_section(table: Json, coherence: Json, pictures: Sequence[Picture]) -> Section:
    """Return relation rates, counts, what goes together, classifiers, image metrics and novelty."""
    relations = table["relations"]
    text = [
        "Real: furnished rooms of the test split. Drafts: what the layout model draws on the same floors. Finished: those as they would ship. Shipped: the rooms of the homes above, on floors of their own.",
        "Harms are done to real rooms: a figure that does not see each of them (SCA of .8 and more, FID and KID at least twice those of training rooms) is void.",
        "Learnt relations are those that the training rooms show most clearly; no list of them is written by hand.",
    ]
    tables = [
        _rates("Share of cases in which it holds", relations["rates"]),
        _rates("The strongest learnt relations: share of cases that stand in one of their modes", relations["learnt"]),
        _rates("Objects in a room; chairs in rooms with a dining table", {**relations["objects"], "chairs": relations["chairs"]}),
        _rates(
            "Whether things go together (a home's furniture in its commonest style, sets of one model, finishes that look alike), and how many a home has",
            coherence,
        ),
        _forest(table["layout"]),
        *(_views(name, figures) for name, figures in table["views"].items()),
        _novelty(table["novelty"]),
    ]
    return Section("Made rooms beside real ones", text, tables, pictures, wide=True)


def _title(name: str) -> str:
    return TITLES.get(name, name)


def _rates(caption: str, figures: Json) -> TableView:
    sets = list(next(iter(figures.values()), {}))
    rows = [
        [name.replace("_", " "), *(share(row[key]) if row[key]["n"] else "-" for key in sets), str(row["real"]["n"])]
        for name, row in figures.items()
    ]
    return TableView(caption, ("", *map(_title, sets), "real cases"), rows)


def _forest(figures: Json) -> TableView:
    rows = [[_title(name), share(value), str(value["n"])] for name, value in figures["made"].items()]
    rows += [[f"harm: {name}", share(value), str(value["n"])] for name, value in figures["harm"].items()]
    caption = "SCA of a random forest on layout features against real rooms: .5 is best."
    return TableView(_with_warning(caption, figures), ("rooms", "accuracy", "rooms of both"), rows)


def _views(name: str, figures: Json) -> TableView:
    rows = [
        [
            _title(key) if k == 0 else f"harm: {key}",
            f"{v['fid']:.2f}",
            "-" if v.get("floor") is None else f"{v['floor']:.2f}",
            f"{v['kid']['mean']:.4f} ({v['kid']['low']:.4f} to {v['kid']['high']:.4f})",
            share(v["sca"]),
        ]
        for k, part in enumerate((figures["made"], figures["harm"]))
        for key, v in part.items()
    ]
    caption = f"Plan views against those of real rooms, features of {name}."
    return TableView(_with_warning(caption, figures), ("rooms", "FID", "of training rooms", "KID", "SCA"), rows)


def _with_warning(caption: str, figures: Json) -> str:
    void = [f"{figure} ({', '.join(harms)})" for figure, harms in figures["blind_to"].items() if harms]
    return f"{caption} {VOID} {', '.join(void)}." if void else caption


def _novelty(figures: Json) -> TableView:
    rows = []
    for name, v in figures.items():
        distances = (v["made"].get("median", 0), v["held_out"].get("median", 0), v["statistic"], v["p"])
        rows.append([_title(name), *(f"{d:.3f}" for d in distances), str(v["copies"]), str(v["copies_held_out"])])
    header = ("rooms", "median", "of held-out rooms", "KS statistic", "p", "copies", "copies among held-out rooms")
    return TableView("Distance to the nearest training room [m a thing]", header, rows)
