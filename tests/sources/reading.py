"""Read a made folder as the stage does, in this process, and return all rows."""

import dataclasses
from pathlib import Path
from types import SimpleNamespace

from pipeline.sources.registry import SOURCES
from pipeline.sources.rows import HouseRows, LibraryRows, number_scenes
from pipeline.sources.settings import FrontFilters, ModelLimits, PreprocessSettings
from pipeline.sources.source import Reading
from pipeline.sources.threed_front.future import add_mirrored
from pipeline.sources.threed_front.source import HOUSES
from pipeline.sources.walkable_share import Walker
from tests.judging import SETTINGS

LENIENT = FrontFilters(keep_without_model=True)  # a folder of models may lack
WALKER = Walker(SETTINGS.robot, SETTINGS.cell)


class Here(Reading):
    """A reading in this process, where a test can see what it costs and change what it does."""

    def each(self, batch):
        return map(batch.read, batch.items)


def read(root, *, front="front", partnet="partnet", filters=None, limits=None):
    """`filters` and `limits` are changes of the default settings."""
    root = Path(root)
    library, houses = LibraryRows(), HouseRows()
    settings = PreprocessSettings(
        filters=dataclasses.replace(FrontFilters(), **(filters or {})), models=dataclasses.replace(ModelLimits(), **(limits or {}))
    )
    used = []
    for source in SOURCES:
        folder = root / {"front": front, "partnet": partnet}.get(source.key, source.key)
        if folder.is_dir():
            with_houses = source.key != "front" or (folder / HOUSES).is_dir()
            listing = source.list(folder, dataclasses.replace(settings, filters=LENIENT), houses=with_houses)
            used.append((source, listing, Here(settings, "CC0-1.0", root / "assets", WALKER, 1, with_houses)))
    for source, listing, reading in used:
        for made in source.models(listing, reading):
            library.add(made)
    for part in number_scenes(h for source, listing, reading in used if reading.houses for h in source.houses(listing, reading, library)):
        for name in ("scenes", "rooms", "openings", "objects", "rejects"):
            getattr(houses, name).extend(getattr(part, name))
    library.assets += add_mirrored(root / "assets", library.assets, (o["asset_id"] for o in houses.objects))
    rejects = library.rejects + houses.rejects
    return SimpleNamespace(
        scenes=houses.scenes,
        rooms=houses.rooms,
        openings=houses.openings,
        objects=houses.objects,
        assets=library.assets,
        joints=library.joints,
        parts=library.parts,
        models=library.models,
        rejects=rejects,
        reasons={r["reason"] for r in rejects},
    )
