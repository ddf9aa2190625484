"""What a home costs, part by part, with the trained model of this checkout; and how fast the readers are.

    python benchmarks/homes.py [homes]

Needs what `make run` leaves: data/ and models/.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TypeVar

ROOT = Path(__file__).resolve().parents[1]
PARTS = ("plan", "sample", "postopt", "verify", "export")
T = TypeVar("T")
R = TypeVar("R")
SAMPLE = 40  # houses and PartNet objects that the readers are timed with


def homes(count: int) -> None:
    """Make homes from the prior, in batches as `sfgen shard` does, and print CPU seconds by part."""
    from pipeline import params
    from pipeline.homes.factory import load_factory
    from pipeline.homes.request import Request

    factory = load_factory(ROOT, params.read(ROOT / "params.yaml"), 17)
    factory.make([Request(10_000)])  # compiles and reads assets
    factory.seconds.clear()
    start = time.perf_counter()
    made = []
    for first in range(0, count, factory.chunk):
        made += factory.make([Request(i) for i in range(first, min(first + factory.chunk, count))])
    wall = time.perf_counter() - start
    total = sum(factory.seconds.values())
    print(f"{count} homes, one process, {wall:.1f} s; CPU seconds per home:")
    for part in PARTS:
        print(f"  {part:10s} {factory.seconds.get(part, 0.0) / count:8.3f}")
    print(f"  {'all':10s} {total / count:8.3f}")
    rooms = sum(len(o.rows["rooms"]) for o in made)
    tries = sum(row["attempts"] for o in made for row in o.rows["scenes"])
    size = sum(len(data) for o in made for data in o.files.values()) / 1e6
    print(f"{rooms / total:.2f} rooms per CPU second, {tries / count:.1f} tries of rooms per home, {size / count:.2f} MB of files per home")


def readers() -> None:
    """Read houses and models of the corpus and print how many per CPU second."""
    from pipeline import params
    from pipeline.sources import batch
    from pipeline.sources.batch import HouseTask, LibraryRows, LibraryTask
    from pipeline.sources.settings import PreprocessSettings

    settings = params.section(PreprocessSettings, params.read(ROOT / "params.yaml"), "preprocess")
    front = ROOT / settings.front
    with tempfile.TemporaryDirectory() as place:
        cache = Path(place) / "cache"
        infos, _ = batch.future_models(front)
        task = LibraryTask(front, Path(place), settings.models, settings.front_licence, cache)
        library = LibraryRows()
        for made in measured("3D-FUTURE models", partial(batch.read_future, task), infos):
            library.add(made)
        if settings.partnet:
            partnet = ROOT / settings.partnet
            task = LibraryTask(partnet, Path(place), settings.models, settings.partnet_licence, cache)
            measured("PartNet objects", partial(batch.read_partnet, task), batch.partnet_objects(partnet)[:SAMPLE])
    house = HouseTask(front, library.models, settings.filters, settings.front_licence)
    measured("houses", partial(batch.read_front, house), batch.house_files(front)[:SAMPLE])


def measured(what: str, step: Callable[[T], R], items: Sequence[T]) -> list[R]:
    """Do the step for every item and print how many a CPU second takes."""
    start = time.process_time()
    made = [step(item) for item in items]
    print(f"reader: {len(items) / (time.process_time() - start):.1f} {what} per CPU second")
    return made


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    if not (ROOT / "models" / "denoiser.safetensors").is_file():
        sys.exit("sfgen: there are no trained weights; type `make run` first")
    homes(int(sys.argv[1]) if len(sys.argv) > 1 else 8)
    readers()
