"""DVC stage `preprocess`: the sources that params.yaml names to tables and assets. Nothing here knows which they are.

Reads data/raw/ (or the user's copies), writes data/tables/*.parquet, data/tables/relations.json (how things stand to each other) and data/assets/*.safetensors.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

from pipeline import params
from pipeline.entry import run
from pipeline.errors import ContentError
from pipeline.execution import cores
from pipeline.relations import learning
from pipeline.relations.arrangement import rooms_of
from pipeline.sources import inventory
from pipeline.sources.registry import configured_sources
from pipeline.sources.rows import LibraryRows
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.source import Listing, Reading, Source
from pipeline.sources.table_writer import write_houses, write_library
from pipeline.sources.threed_front.future import add_mirrored
from pipeline.sources.walkable_share import Walker

Used = list[tuple[Source, Listing, Reading]]


def main(root: Path) -> None:
    """Read the sources that section `preprocess` of params.yaml names."""
    tree = params.read(root / "params.yaml")
    settings = params.section(PreprocessSettings, tree, "preprocess")
    used = list(sources(root, settings, Walker.of(tree)))
    required = not settings.filters.keep_without_model and not any(source.replaces for source, _, _ in used)
    library = read_library(root / "data" / "assets", used, required=required)
    houses = (house for source, listing, reading in used if reading.houses for house in source.houses(listing, reading, library))
    out = root / "data" / "tables"
    summary = write_houses(out, houses, library, places(used))
    library.assets += add_mirrored(root / "data" / "assets", library.assets, summary.assets)
    write_library(out, library, summary)
    learning.fit(rooms_of(out, "train")).save(out / "relations.json")
    sys.stdout.writelines(f"{line}\n" for line in summary.lines())


def sources(root: Path, settings: PreprocessSettings, walker: Walker) -> Iterator[tuple[Source, Listing, Reading]]:
    """Yield the sources in use, what lies there, and how each is read."""
    used = configured_sources(settings.sources)
    replaced = {key for source, _ in used for key in source.replaces}
    for source, path in used:
        houses = source.key not in replaced
        listing = source.list(root / path, settings, houses=houses)
        inventory.require_listed(root, listing)
        licence = settings.licences.get(source.key, source.licence)
        yield source, listing, Reading(settings, licence, root / "data" / "assets", walker, settings.workers or cores(), houses)


def read_library(out: Path, used: Used, *, required: bool) -> LibraryRows:
    """Read all models, write their assets, and remove assets of earlier runs. Raises ContentError where models are `required` and none is usable."""
    library = LibraryRows()
    for source, listing, reading in used:
        for rows in source.models(listing, reading):
            library.add(rows)
    if required and not library.assets:
        raise ContentError(f"{places(used)} gives no usable model", "check the folders in section preprocess of params.yaml")
    kept = {row["file"] for row in library.assets}
    for path in out.glob("*.safetensors"):
        if path.name not in kept:
            path.unlink()
    return library


def places(used: Used) -> str:
    """Say where the sources lie."""
    return ", ".join(str(listing.root) for _, listing, _ in used)


if __name__ == "__main__":
    run(main)
