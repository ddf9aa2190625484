"""Figures of the dataset that ships, and counts of what was left out on the way."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pipeline import tables
from pipeline.homes import rows as homes
from pipeline.homes.rows import Row
from pipeline.metrics.coherence import coherence, tastes
from pipeline.sources import reasons as sources
from schemas import ASSETS, LATENTS, OBJECTS, REJECTS, ROOMS, SCENES
from schemas.table import Table


def shipped_rows(folder: Path, table: Table) -> list[Row]:
    """Return the rows of a table of all shards of the dataset in `folder`, in their order."""
    return [row for path in sorted((folder / table.name).glob("*.parquet")) for row in tables.read(path, table)]


def dataset_figures(folder: Path) -> dict[str, Any]:
    """Return counts and means over the homes of a dataset."""
    scenes, rooms = shipped_rows(folder, SCENES), shipped_rows(folder, ROOMS)
    furnished = [r for r in rooms if r["layout_type"]]
    total = {name: int(sum(s[name] for s in scenes)) for name in ("rooms", "objects", "openable", "joints", "joints_clear", "collisions")}
    return {
        "homes": len(scenes),
        **total,
        "objects_per_furnished_room": _mean(furnished, "objects"),
        "openable_per_furnished_room": _mean(furnished, "openable"),
        "openable_per_furnished_room_drafted": round(float(np.mean([r["openable_sampled"] or 0 for r in furnished])), 4),
        "reach": _mean(scenes, "reach"),
        "walkable_paper": _mean(scenes, "walkable_paper"),
        "walkable_free": _mean(scenes, "walkable_free"),
        "room_tries_per_home": _mean(scenes, "attempts"),
        "megabytes": round(sum(p.stat().st_size for p in folder.rglob("*") if p.is_file()) / 1e6, 1),
    }


def dataset_coherence(root: Path, rng: np.random.Generator, real: Sequence[Row], dataset: Path | None = None) -> dict[str, Any]:
    """Return by figure whether things go together in real homes, given the rows of their objects, and in those of a dataset (data/shards)."""
    places = ((ASSETS, root / "data/tables/assets.parquet"), (LATENTS, root / "data/latents/latents.parquet"))
    assets, latents = (tables.read(path, table) for table, path in places)
    shipped = shipped_rows(dataset or root / "data" / "shards", OBJECTS)
    own = tastes(assets, latents)
    real_figures, made = (coherence(rng, rows, *own) for rows in (real, shipped))
    return {name: {"real": value, "shipped": made[name]} for name, value in real_figures.items() if name in made}


def reject_rows(root: Path) -> list[list[str]]:
    """Count everything that was left out, repaired or tried again: stage, kind of thing, reason, its effect, count, what it means, first case."""
    places = [("preprocess", sources.REASONS, [root / "data" / "tables" / "rejects.parquet"])]
    places += [("postopt", homes.REASONS, sorted((root / "data" / "shards" / "rejects").glob("*.parquet")))]
    counts = []
    for stage, known, paths in places:
        cases: dict[tuple[str, str], list[Row]] = {}
        for row in (row for path in paths for row in tables.read(path, REJECTS)):
            cases.setdefault((row["what"], row["reason"]), []).append(row)
        for (what, code), rows in sorted(cases.items()):
            example = ": ".join(filter(None, (rows[0]["where"], rows[0]["detail"])))
            counts.append([stage, what, code, known[code].effect, str(len(rows)), known[code].doc, example[:90]])
    return counts


def _mean(rows: list[Row], name: str) -> float:
    return round(float(np.mean([row[name] for row in rows])), 4) if rows else 0.0
