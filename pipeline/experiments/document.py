"""Writes the report: plots, top views, path-traced views, and the page that shows them with the figures."""

import json
import shutil
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from pipeline import seeds, tables, taxonomy
from pipeline.entities.asset import Asset
from pipeline.entities.home import Home
from pipeline.errors import SfgenError
from pipeline.execution import cores, map_jobs
from pipeline.experiments.dataset import reject_rows, shipped_rows
from pipeline.experiments.settings import MetricsSettings
from pipeline.export import ExportFolder, export_home, home_stages
from pipeline.homes.factory import Factory, open_factory
from pipeline.homes.rows import homes_of
from pipeline.manifest import write_bytes, write_with
from pipeline.preview.sheet import contact_sheet
from pipeline.preview.top import top_view
from pipeline.report import baselines, calibration, sections
from pipeline.report.page import Picture, Section, render
from pipeline.report.plots import Curve, lines
from pipeline.report.realism import realism_section
from pipeline.report.viewer import viewer_page
from pipeline.shards import read_header
from schemas import OBJECTS, OPENINGS, ROOMS, SCENES

SHOWN = 24  # top views on the page
EACH = 5  # rooms of each type and kind in a line-up
CELL = 190  # pixels of its pictures
Room = tuple[Home, str]  # a home, and the room of it that is shown


def write_report(root: Path, figures: Mapping[str, Any], factory: Factory, settings: MetricsSettings) -> None:
    """Write report/index.html with its pictures, from the figures and the dataset of this checkout."""
    folder = root / "report"
    shutil.rmtree(folder, ignore_errors=True)
    homes = homes_of({table.name: shipped_rows(root / "data" / "shards", table) for table in (SCENES, ROOMS, OPENINGS, OBJECTS)})
    gallery, missing = path_traced(root, folder, homes, factory.seed, settings)
    model, no_model = in_3d(root, folder, homes)
    views = [Picture(_copy_preview(root, folder, home), f"{home.scene_id}: {home.prompt}") for home in homes[:SHOWN]]
    rates = {name: _plot(folder, name, curves, **labels) for name, (curves, labels) in _plots(figures).items()}
    trained = (root / "plots" / "loss.csv").is_file()
    loss = [_plot(folder, "loss", [_loss(root)], title="training", x="step", y="loss", log=True)] if trained else []
    compared = _json(root / "metrics" / "calibration.json")
    fits = [_picture(folder, name, png, name.replace("_", ", ")) for name, png in calibration.plots(compared).items()] if compared else []
    chapters = [
        Section("Views", [why for why in (no_model, missing) if why], pictures=[*model, *gallery], wide=True),
        sections.dataset_section(
            figures["dataset"], _json(root / "metrics" / "sampling.json") | _json(root / "metrics" / "timing.json"), views
        ),
        sections.plan_section(figures["plan"]),
        sections.quantity_section(figures["quantity"], rates["quantity"]),
        sections.articulation_section(figures["articulation"], figures["ablation"]),
        sections.walkable_section(figures["walkable"], rates["walkable"]),
        sections.category_section(figures["category"]),
        baselines.baselines_section(_json(root / "metrics" / "baselines.json")),
        realism_section(figures["realism"], figures["coherence"], lineups(root, folder, homes, factory, settings)),
        sections.training_section(_json(root / "metrics" / "encode.json"), _json(root / "metrics" / "train.json"), loss),
        calibration.calibration_section(compared, fits) if compared else None,
        sections.reject_section(reject_rows(root)),
    ]
    write_bytes(folder / "index.html", render("Homes for robots", _lead(root), [c for c in chapters if c]).encode())


def _lead(root: Path) -> str:
    """Say what the homes were made from: how many houses, and under which licence, as the tables have it."""
    licences = tables.read_arrow(root / "data" / "tables" / f"{SCENES.name}.parquet", SCENES)["licence"].to_pylist()
    from_what = f"{len(licences)} houses ({', '.join(sorted(set(licences)))})"
    return f"Made by sfgen from {from_what}. Every figure was measured in the run that wrote this page; intervals are 95 %."


def lineups(root: Path, folder: Path, homes: Sequence[Home], factory: Factory, settings: MetricsSettings) -> list[Picture]:
    """Draw real rooms of the split and shipped ones beside each other, in two pictures: which is which, and the answer."""
    rows = {t.name: tables.read(root / "data" / "tables" / f"{t.name}.parquet", t) for t in (SCENES, ROOMS, OPENINGS, OBJECTS)}
    rows[SCENES.name] = [row for row in rows[SCENES.name] if row["split"] == settings.split]
    all_rooms = (*rows[ROOMS.name], *shipped_rows(root / "data" / "shards", ROOMS))
    types = {(row["scene_id"], row["room_id"]): row["layout_type"] for row in all_rooms}
    rng = seeds.generator(factory.seed, "lineup")
    images = lineup(rng, by_type(homes_of(rows), types), by_type(homes, types), factory.library)
    pictures = []
    for name, caption, image in zip(
        ("lineup", "lineup_told"), ("which five of each row are made?", "the answer"), images or (), strict=False
    ):
        write_with(folder / "plots" / f"{name}.png", image.save)
        pictures.append(Picture(f"plots/{name}.png", caption))
    return pictures


def alone(home: Home, room_id: str) -> Home:
    """Return the home that is left when one room is cut out of it, with its windows: sources draw doors in different ways, and leaves would tell."""
    room = replace(home.plan.room(room_id), level=0)
    lift = np.array([0.0, 0.0, home.plan.room(room_id).level * home.plan.storey_height])
    openings = tuple(replace(o, level=0) for o in home.plan.openings if o.kind == "window" and room_id in o.rooms)
    placed = tuple(replace(p, position=p.position - lift) for p in home.in_room(room_id))
    return replace(home, plan=replace(home.plan, rooms=(room,), openings=openings, entrance=room_id), placements=placed)


def lineup(
    rng: np.random.Generator, real: Mapping[str, Sequence[Room]], generated: Mapping[str, Sequence[Room]], assets: Mapping[str, Asset]
) -> tuple[Image.Image, Image.Image] | None:
    """Return the two pictures of rooms by type, a row for each type that both have; None where there is none."""
    hidden: list[tuple[str, Image.Image]] = []
    answers: list[tuple[str, Image.Image]] = []
    for kind in (kind for kind in taxonomy.load().layout_types if real.get(kind) and generated.get(kind)):
        row = [
            (name, top_view(alone(*room), assets, CELL, reaches=False))
            for name, rooms in (("real", real), ("made", generated))
            for room in (rooms[kind][k] for k in sorted(rng.permutation(len(rooms[kind]))[:EACH]))
        ]
        blank = Image.new("RGB", (CELL, CELL), (244, 244, 241))
        row += [("", blank)] * (2 * EACH - len(row))
        answers += [(f"{name} {kind.replace('_', ' ')}" if name else "", picture) for name, picture in row]
        hidden += [("", row[k][1]) for k in rng.permutation(len(row))]
    if not answers:
        return None
    return contact_sheet(hidden, 2 * EACH, CELL), contact_sheet(answers, 2 * EACH, CELL)


def by_type(homes: Iterable[Home], types: Mapping[tuple[str, str], str]) -> dict[str, list[Room]]:
    """Return the furnished rooms of homes by their layout type; `types` by (scene_id, room_id)."""
    rooms: dict[str, list[Room]] = {}
    for home in homes:
        for room in home.plan.rooms:
            if home.in_room(room.room_id):
                rooms.setdefault(types.get((home.scene_id, room.room_id), ""), []).append((home, room.room_id))
    return rooms


def in_3d(root: Path, folder: Path, homes: Sequence[Home]) -> tuple[list[Picture], str]:
    """Write the first home as `sfgen export --to glb` does, and a page that shows it; return its view from above, which opens that, or why not."""
    dataset = root / "data" / "shards"
    header = read_header(dataset)
    stages = home_stages(dataset, header)
    home = next((home for home in homes if home.scene_id in stages), None)
    if not home:
        return [], ""
    glb = export_home(ExportFolder.of_dataset(folder / "glb", "glb", header), stages[home.scene_id], home.scene_id)
    page = f"{home.scene_id}.html"
    try:
        write_bytes(folder / page, viewer_page(home.scene_id, glb.read_bytes()).encode())
    except SfgenError as error:
        return [], str(error)
    return [Picture(_copy_preview(root, folder, home), f"{home.scene_id} in 3D: click, then turn it with the mouse", page)], ""


def path_traced(root: Path, folder: Path, homes: Sequence[Home], seed: int, settings: MetricsSettings) -> tuple[list[Picture], str]:
    """Path-trace the homes with the most to open, in parallel; without the renderer, return what to install instead."""
    library = open_factory(root, seed).library
    ranked = sorted(homes, key=lambda h: (-sum(library[p.asset_id].openable for p in h.placements) / max(1, len(h.plan.rooms)), h.index))
    chosen = ranked[: settings.gallery]
    try:
        for _ in map_jobs(partial(_trace, root, seed, folder, settings), chosen, workers=min(cores(), len(chosen))):
            pass
    except SfgenError as error:
        return [], str(error)
    return [Picture(f"views/{home.scene_id}.png", home.prompt) for home in chosen], ""


def _trace(root: Path, seed: int, folder: Path, settings: MetricsSettings, home: Home) -> None:
    from pipeline.preview.trace import path_trace

    (folder / "views").mkdir(parents=True, exist_ok=True)
    size = (settings.gallery_width, settings.gallery_width * 3 // 4)
    library = open_factory(root, seed).library
    path_trace(home, library, folder / "views" / f"{home.scene_id}.png", size=size, spp=settings.gallery_samples)


def _copy_preview(root: Path, folder: Path, home: Home) -> str:
    source = next((root / "data" / "shards" / "previews").glob(f"*/{home.scene_id}.png"))
    write_bytes(folder / "previews" / source.name, source.read_bytes())
    return f"previews/{source.name}"


def _plots(figures: Mapping[str, Any]) -> dict[str, tuple[list[Curve], dict[str, Any]]]:
    counts, taus = figures["quantity"], figures["walkable"]
    quantity = [
        _curve(label, {n: row[key] for n, row in counts.items() if row[key]})
        for key, label in (("plain", "no guidance"), ("drafted", "guided, first attempts"), ("shipped", "guided, shipped"))
    ]
    walkable = [
        _curve(label, {tau: row["free"][key] for tau, row in taus.items()})
        for key, label in (("without", "without"), ("first", "first attempts"), ("with", "with control, shipped"))
    ]
    return {
        "quantity": (quantity, {"title": "Exactly N objects", "x": "N", "y": "SR(N)", "y_range": (-0.03, 1.03)}),
        "walkable": (walkable, {"title": "Free floor of at least tau", "x": "tau", "y": "SR(tau)", "y_range": (-0.03, 1.03)}),
    }


def _curve(label: str, rates: Mapping[str, Mapping[str, float]]) -> Curve:
    rows = list(rates.values())
    return Curve(label, [float(x) for x in rates], [r["rate"] for r in rows], [r["low"] for r in rows], [r["high"] for r in rows])


def _loss(root: Path) -> Curve:
    rows = [line.split(",") for line in (root / "plots" / "loss.csv").read_text(encoding="utf-8").splitlines()]
    step, loss = rows[0].index("step"), rows[0].index("loss")
    return Curve("loss", [float(r[step]) for r in rows[1:]], [float(r[loss]) for r in rows[1:]])


def _plot(folder: Path, name: str, curves: Sequence[Curve], **labels: Any) -> Picture:
    return _picture(folder, name, lines(curves, **labels), str(labels["title"]))


def _picture(folder: Path, name: str, png: bytes, caption: str) -> Picture:
    write_bytes(folder / "plots" / f"{name}.png", png)
    return Picture(f"plots/{name}.png", caption)


def _json(path: Path) -> dict[str, Any]:
    if not path.is_file():
        return {}
    content: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return content
