"""DVC stage `preprocess`: 3D-FRONT, 3D-FUTURE and PartNet folders to tables and assets. Nothing here knows which copies they are.

Reads data/raw/ (or the user's copies), writes data/tables/*.parquet, data/tables/relations.json (how things stand to each other) and data/assets/*.safetensors.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from pipeline import params, taxonomy
from pipeline.entry import run
from pipeline.errors import ContentError
from pipeline.execution import cores, track
from pipeline.relations import files, learning
from pipeline.relations.split import rooms_of
from pipeline.sources import batch, inventory
from pipeline.sources.articulated import proportions
from pipeline.sources.articulated.household import named_categories
from pipeline.sources.atiss.reader import PeersTask, kinds_of, peers_houses, read_peers
from pipeline.sources.batch import Found, HouseTask, LibraryRows, LibraryTask
from pipeline.sources.guarded import Folder
from pipeline.sources.recognition import front_at, partnet_at, peers_at
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.sink import write_houses, write_library
from pipeline.sources.threed_front.house import HouseRows
from pipeline.sources.threed_front.mirrored import add_mirrored
from pipeline.sources.threed_front.model_hints import hints
from pipeline.sources.threed_front.walkable_share import Walker


def main(root: Path) -> None:
    """Read the sources that section `preprocess` of params.yaml names."""
    tree = params.read(root / "params.yaml")
    settings = params.section(PreprocessSettings, tree, "preprocess")
    walker = Walker.of(tree)
    workers = settings.workers or cores()
    needed = () if settings.peers else (batch.HOUSES,) if settings.filters.keep_without_model else (batch.HOUSES, batch.MODELS)
    front = folder(root, "front", settings.front, needed)
    inventory.require_listed(root, front, front_at)
    partnet = folder(root, "partnet", settings.partnet, ()) if settings.partnet else None
    objects = batch.partnet_objects(partnet) if partnet else []
    if partnet:
        inventory.require_listed(root, partnet, lambda path: partnet_at(path, objects))
    peers = folder(root, "peers", settings.peers, ()) if settings.peers else None
    if peers:
        inventory.require_listed(root, peers, peers_at)
    library = read_library(root, front, partnet, objects, settings, workers)
    step, task, houses = homes(front, peers, library, settings, walker)
    out = root / "data" / "tables"
    read = track(batch.each(step, task, houses, workers), len(houses), "houses", unit="house")
    summary = write_houses(out, read, library, peers or front)
    library.assets += add_mirrored(root / "data" / "assets", library.assets, summary.assets)
    write_library(out, library, summary)
    files.save(out / "relations.json", learning.fit(rooms_of(out, "train")))
    sys.stdout.writelines(f"{line}\n" for line in summary.lines())


def homes(
    front: Path, peers: Path | None, library: LibraryRows, settings: PreprocessSettings, walker: Walker
) -> tuple[Callable[[Any, Any], HouseRows], Any, Sequence[Any]]:
    """Return how a house is read, what each of them needs, and the houses: 3D-FRONT files, or the peers' cached rooms."""
    if peers:
        kinds = kinds_of(peers)
        return (
            read_peers,
            PeersTask(peers, kinds, library.models, settings.filters, settings.peers_licence, walker),
            peers_houses(peers, kinds),
        )
    return batch.read_front, HouseTask(front, library.models, settings.filters, settings.front_licence, walker), batch.house_files(front)


def read_library(
    root: Path, front: Path, partnet: Path | None, objects: Sequence[Found], settings: PreprocessSettings, workers: int
) -> LibraryRows:
    """Read all models, those of `partnet` being `objects`, write their assets, and remove assets of earlier runs."""
    out = root / "data" / "assets"
    library = LibraryRows()
    houses = [] if settings.peers else batch.house_files(front)
    said = hints(track(batch.each(batch.house_records, front, houses, workers), len(houses), "records", unit="house"), taxonomy.load())
    if (front / batch.MODELS).is_dir():  # `folder` has seen to it, but where rooms can do without
        infos, library.rejects = batch.future_models(front, said)
        task = LibraryTask(front, out, settings.models, settings.front_licence, said)
        for made in track(batch.each(batch.read_future, task, infos, workers), len(infos), "models", unit="model"):
            library.add(made)
    if partnet:
        categories = named_categories(Folder.at(partnet))
        spreads = proportions.spreads(batch.each(proportions.drawn, partnet, [found.path for found in objects], workers))
        task = LibraryTask(partnet, out, settings.models, settings.partnet_licence, categories=categories, spreads=spreads)
        for made in track(batch.each(batch.read_partnet, task, objects, workers), len(objects), "articulated", unit="object"):
            library.add(made)
    if not library.assets and not settings.peers and not settings.filters.keep_without_model:
        raise ContentError(f"{front} gives no usable model", "check the folders in section preprocess of params.yaml")
    kept = {row["file"] for row in library.assets}
    for path in out.glob("*.safetensors"):
        if path.name not in kept:
            path.unlink()
    return library


def folder(root: Path, key: str, path: str, parts: Iterable[str]) -> Path:
    """Return a source folder. Raises ContentError naming the key of params.yaml when it, or a part of it, is missing."""
    found = root / path
    for part in (found, *(found / p for p in parts)):
        if not part.is_dir():
            remedy = "name the folder of the data with `sfgen doctor --use PATH`, or make the embedded corpus with `dvc repro corpus`"
            raise ContentError(f"preprocess.{key}: {part} is {'no folder' if part.exists() else 'missing'}", remedy)
    return found


if __name__ == "__main__":
    run(main)
