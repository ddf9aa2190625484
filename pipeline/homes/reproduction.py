"""What the bytes of a home hang on beside its digests, and whether homes of a dataset come out the same here."""

import platform
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.lib.introspect import opt_func_info

from pipeline import tables
from pipeline.homes.factory import Factory
from pipeline.homes.life import Empty
from pipeline.homes.request import Request
from pipeline.shards import TABLES, Header, gather, scene_id
from pipeline.shards.layout import table_path

PACKAGES = ("numba", "numpy", "pillow", "pyarrow", "scipy", "shapely", "torch", "usd-core")


def made_with() -> dict[str, str]:
    """Return the versions of what computes here, and the instructions that it is held to."""
    targets = opt_func_info(func_name="^exp$", signature="float64").get("exp", {})
    loops = next((target["current"] for target in targets.values()), "baseline")
    instructions = f"{platform.machine()} {torch.backends.cpu.get_cpu_capability()}, NumPy {loops}"
    return {**{name: version(name) for name in PACKAGES}, "python": platform.python_version(), "instructions": instructions}


def header_of(factory: Factory, count: int, words: str) -> Header:
    """Return what a dataset of `count` homes is that is made here; `words` is the digest of what it was asked for."""
    settings = factory.shard
    digests = {**factory.digests, "prompts": words}
    return Header(factory.seed, count, settings.homes, settings.licence, digests, made_with(), settings.preview)


def spread_indices(header: Header, count: int) -> list[int]:
    """Return so many indices of a dataset, evenly spread."""
    return [int(i) for i in np.unique(np.linspace(0, header.count - 1, min(count, header.count)).round())]


def differing(folder: Path, header: Header, factory: Factory, asked: Callable[[int], Request], indices: Sequence[int]) -> list[str]:
    """Make homes again and return a line for each that is not what lies in the dataset: which columns and files, and by how much."""
    lines = []
    for start in range(0, len(indices), factory.chunk):
        some = indices[start : start + factory.chunk]
        for index, outcome in zip(some, factory.make([asked(i) for i in some]), strict=True):
            number, name = index // header.shard_size, scene_id(header.seed, index)
            rows, files = (outcome.rows(header.seed), {}) if isinstance(outcome, Empty) else (outcome.rows, outcome.files)
            content = gather(number, rows, files)
            parts = []
            for table, schema in TABLES.items():
                there = [r for r in tables.read(folder / table_path(table, number), schema) if name in (r.get("scene_id"), r.get("where"))]
                here = schema.from_rows(r for r in content.rows[table] if name in (r.get("scene_id"), r.get("where"))).to_pylist()
                parts += _columns(table, there, here)
            parts += [file for file, data in content.files.items() if not (folder / file).is_file() or (folder / file).read_bytes() != data]
            if parts:
                lines.append(f"{name}: {', '.join(parts)}")
    return lines


def _columns(table: str, there: Sequence[Mapping[str, Any]], here: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return what differs between the rows of one home."""
    if len(there) != len(here):
        return [f"{table} ({len(there)} rows, here {len(here)})"]
    differences = []
    for column in here[0] if here else ():
        pairs = [(a[column], b[column]) for a, b in zip(there, here, strict=True) if a[column] != b[column]]
        if pairs and all(isinstance(v, float) or (isinstance(v, list) and v and isinstance(v[0], float)) for pair in pairs for v in pair):
            most = max(float(np.abs(np.subtract(a, b)).max()) for a, b in pairs)
            differences.append(f"{table}.{column} ({len(pairs)} rows, by {most:.0e} at most)")
        elif pairs:
            differences.append(f"{table}.{column} ({len(pairs)} rows)")
    return differences
