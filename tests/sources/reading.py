"""Read a made folder as the stage does, in this process, and return all rows."""

import dataclasses
from pathlib import Path
from types import SimpleNamespace

from pipeline import taxonomy
from pipeline.sources import batch
from pipeline.sources.articulated import proportions
from pipeline.sources.articulated.household import named_categories
from pipeline.sources.batch import HouseTask, LibraryRows, LibraryTask
from pipeline.sources.guarded import Folder
from pipeline.sources.settings import FrontFilters, ModelLimits
from pipeline.sources.threed_front.house import HouseRows
from pipeline.sources.threed_front.mirrored import add_mirrored
from pipeline.sources.threed_front.model_hints import hints
from pipeline.sources.threed_front.walkable_share import Walker
from tests.judging import SETTINGS

WALKER = Walker(SETTINGS.robot, SETTINGS.cell)


def read(root, *, front="front", partnet="partnet", filters=None, limits=None):
    """`filters` and `limits` are changes of the default settings."""
    root = Path(root)
    library, houses = LibraryRows(), HouseRows()
    made_limits = dataclasses.replace(ModelLimits(), **(limits or {}))
    made_filters = dataclasses.replace(FrontFilters(), **(filters or {}))
    if (root / front / batch.MODELS).is_dir():
        said = hints((batch.house_records(root / front, file) for file in batch.house_files(root / front)), taxonomy.load())
        infos, library.rejects = batch.future_models(root / front, said)
        task = LibraryTask(root / front, root / "assets", made_limits, "CC0-1.0", said)
        for entry in infos:
            library.add(batch.read_future(task, entry))
    if (root / partnet).is_dir():
        categories = named_categories(Folder.at(root / partnet))
        spreads = proportions.spreads(proportions.drawn(root / partnet, found.path) for found in batch.partnet_objects(root / partnet))
        task = LibraryTask(root / partnet, root / "assets", made_limits, "CC0-1.0", categories=categories, spreads=spreads)
        for name in batch.partnet_objects(root / partnet):
            library.add(batch.read_partnet(task, name))
    if (root / front / batch.HOUSES).is_dir():
        task = HouseTask(root / front, library.models, made_filters, "CC0-1.0", WALKER)
        for part in batch.numbered(batch.read_front(task, file) for file in batch.house_files(root / front)):
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
