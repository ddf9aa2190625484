"""How fast the readers are, and whether their memory stays flat: houses of 2 MB, 3D-FUTURE models, PartNet objects.

    python benchmarks/readers.py [houses]

Needs what `make run` leaves in data/raw/. Houses are those of the corpus, each padded to 2 MB with feature
walls made of its own walls, as real files are mostly meshes.
"""

from __future__ import annotations

import json
import resource
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from pipeline import params, taxonomy
from pipeline.sources.articulated.objects import objects_in
from pipeline.sources.articulated.source import ObjectTask, read_object
from pipeline.sources.library_rows import LibraryRows
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.threed_front import source
from pipeline.sources.threed_front.model_hints import hints
from pipeline.sources.walkable_share import Walker

ROOT = Path(__file__).resolve().parents[1]
SIZE = 2_000_000  # bytes of a house file
HOUSES = 300
LICENCE = "CC0-1.0"
WARM = 30  # houses after which memory is taken as the level to stay at
T = TypeVar("T")
R = TypeVar("R")


def padded(tree: dict[str, Any], size: int) -> str:
    """Return a house as JSON text of about `size` bytes: feature walls of some 60 vertices, each referenced by a room."""
    walls = [m for m in tree["mesh"] if m["type"] in {"WallInner", "WallOuter", "Baseboard", "Ceiling"}]
    short = size - len(json.dumps(tree))
    number = 0
    while short > 0 and walls:
        extra = feature_wall(walls[number % len(walls)], number)
        tree["mesh"].append(extra)
        child = {"ref": extra["uid"], "instanceid": f"mesh/p{number}", "pos": [0, 0, 0], "rot": [0, 0, 0, 1], "scale": [1, 1, 1]}
        tree["scene"]["room"][number % len(tree["scene"]["room"])]["children"].append(child)
        short -= len(json.dumps(extra)) + len(json.dumps(child)) + 4
        number += 1
    return json.dumps(tree)


def feature_wall(wall: dict[str, Any], number: int) -> dict[str, Any]:
    """Return a mesh record of several copies of a wall, one before the other."""
    corners = len(wall["xyz"]) // 3
    copies = max(1, 60 // max(1, corners))
    shift = [round(0.004 * k + 1e-4 * (number % 89), 5) for k in range(copies)]
    return {
        **wall,
        "uid": f"pad/{number}",
        "type": "CustomizedFeatureWall",
        "xyz": [round(v + s, 5) for s in shift for v in wall["xyz"]],
        "normal": [round(v + 1e-5, 5) for _ in shift for v in wall["normal"]],
        "uv": [round(v + s, 5) for s in shift for v in wall["uv"]],
        "faces": [f + corners * k for k in range(copies) for f in wall["faces"]],
    }


def measured(what: str, step: Callable[[T], R], items: Sequence[T], keep: Callable[[R], None] | None = None) -> None:
    """Do the step for every item and print how many a CPU second takes."""
    start = time.process_time()
    for item in items:
        made = step(item)
        if keep:
            keep(made)
    spent = time.process_time() - start
    print(f"{len(items)} {what}: {len(items) / spent:.1f} per CPU second")


def peak() -> float:
    """Return the largest memory of this process so far [MiB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def main(count: int) -> None:
    """Read everything once and print figures."""
    tree = params.read(ROOT / "params.yaml")
    settings = params.section(PreprocessSettings, tree, "preprocess")
    front, partnet = (ROOT / path for key in ("front", "partnet") if (path := settings.sources.get(key)))
    files_of_corpus = source.house_files(front)
    with tempfile.TemporaryDirectory() as place:
        houses = Path(place) / source.HOUSES
        houses.mkdir()
        for k in range(count):
            tree = json.loads((front / files_of_corpus[k % len(files_of_corpus)]).read_text(encoding="utf-8"))
            (houses / f"{tree['uid']}-{k}.json").write_text(padded(tree, SIZE), encoding="utf-8")
        files = source.house_files(Path(place))
        mean = sum((Path(place) / f).stat().st_size for f in files) / len(files)
        print(f"{count} houses of {mean / 1e6:.2f} MB")
        said = hints((source.house_records(front, f) for f in files_of_corpus), taxonomy.load())
        infos, _ = source.future_models(front, said)
        library = LibraryRows()
        task = source.ModelTask(front, Path(place) / "assets", settings.models, LICENCE, said)
        measured("3D-FUTURE models", partial(source.read_future, task), infos, library.add)
        objects = ObjectTask(partnet, Path(place) / "assets", settings.models, LICENCE)
        measured("PartNet objects", partial(read_object, objects), objects_in(partnet)[:40])
        measured("records of houses", partial(source.house_records, Path(place)), files)
        house = source.HouseTask(Path(place), library.models, settings.filters, LICENCE, Walker.of(tree))
        measured("houses, the first", partial(source.read_front, house), files[:WARM])
        before = peak()
        measured("houses, the rest", partial(source.read_front, house), files[WARM:])
        print(f"peak memory {before:.0f} MiB after {WARM} houses, {peak():.0f} MiB after {count}")


if __name__ == "__main__":
    if not (ROOT / "data" / "raw").is_dir():
        sys.exit("sfgen: there is no data/raw; type `make run` first")
    main(int(sys.argv[1]) if len(sys.argv) > 1 else HOUSES)
