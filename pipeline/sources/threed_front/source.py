"""3D-FRONT and 3D-FUTURE as a source: houses in 3D-FRONT/, their furniture in 3D-FUTURE-model/ beside it."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from pipeline import taxonomy
from pipeline.sources.batch import Batch
from pipeline.sources.guarded import Folder
from pipeline.sources.reasons import Row, reject
from pipeline.sources.rows import HouseRows, LibraryRows, Scale
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.source import Listing, Reading, Source, Task, folders_below, require_folders
from pipeline.sources.threed_front.furniture import Model
from pipeline.sources.threed_front.future import ModelInfo, read_model, read_model_info
from pipeline.sources.threed_front.house import read_house
from pipeline.sources.threed_front.model_hints import Hint, hints, records
from pipeline.sources.threed_front.notches import occupancy_bits

HOUSES, MODELS, TEXTURES = "3D-FRONT", "3D-FUTURE-model", "3D-FRONT-texture"
LEVELS = 2  # folders below the named one in which it is looked for


class ThreedFront(Source):
    """See `pipeline.sources.source.Source`."""

    key = "front"
    licence = "LicenseRef-3D-FRONT-3D-FUTURE"
    expected = f"{HOUSES}/*.json beside {MODELS}/model_info.json"
    replaces: frozenset[str] = frozenset()

    def recognise(self, folder: Path) -> Path | None:
        """Return the folder with both halves, however the archives were unpacked."""
        around = (folder.parent,) if folder.name in {HOUSES, MODELS, TEXTURES} else ()
        places = (folder, *folders_below(folder, LEVELS, {HOUSES, MODELS, TEXTURES}), *around)
        return next((p for p in places if next((p / HOUSES).glob("*.json"), None) and (p / MODELS / "model_info.json").is_file()), None)

    def list(self, root: Path, settings: PreprocessSettings, *, houses: bool = True) -> Listing:
        """Describe a folder of both halves; where other houses are read, or objects without models are kept, one may lack."""
        require_folders(self.key, root, [HOUSES] * houses + [MODELS] * (houses and not settings.filters.keep_without_model))
        files = tuple(f"{HOUSES}/{p.name}" for p in sorted((root / HOUSES).glob("*.json")))
        models, textures = (sum(1 for _ in _folders(root / name)) for name in (MODELS, TEXTURES))
        counts = (("houses", len(files)), ("models", models), *((("textures", textures),) if textures else ()))
        lacks = () if textures else (f"{TEXTURES} (optional: walls and floors)",)
        return Listing(self.key, root, tuple(n for n in (HOUSES, MODELS) if (root / n).is_dir()), counts, lacks, files)

    def models(self, listing: Listing, reading: Reading) -> Iterator[LibraryRows]:
        """Read what houses say of the models, then the models."""
        told_later = Batch("record", records, listing.root, listing.items * reading.houses, lambda *_: [])  # when the house itself is read
        said = hints(reading.each(told_later), taxonomy.load())
        if MODELS in listing.parts:
            infos, rejects = future_models(listing.root, said)
            yield LibraryRows(rejects=rejects)
            task = Task(listing.root, reading, said)
            yield from reading.each(Batch("model", read_future, task, infos, lambda info, *why: LibraryRows.refused(info.model_id, *why)))

    def houses(self, listing: Listing, reading: Reading, library: LibraryRows) -> Iterator[HouseRows]:
        """Read the houses."""
        task = Task(listing.root, reading, library.models)
        yield from reading.each(
            Batch("house", read_house, task, listing.items, lambda file, *why: HouseRows.refused(Path(file).stem, *why))
        )


def future_models(source: Path, said: Mapping[str, Hint]) -> tuple[list[ModelInfo], list[Row]]:
    """Return the models of a source by id, and the rejects of entries of model_info.json and of folders without one.

    A folder without an entry is a model all the same when houses name its category.
    """
    infos, rejects = read_model_info(Folder.at(source), f"{MODELS}/model_info.json")
    for name in sorted({p.name for p in _folders(source / MODELS)} - infos.keys()):
        if name in said and (said[name].categories or said[name].kinds):
            infos[name] = ModelInfo(name)
        else:
            rejects.append(reject("model", name, "no_model_info"))
    return [infos[k] for k in sorted(infos)], rejects


def read_future(task: Task, info: ModelInfo) -> LibraryRows:
    """Read one 3D-FUTURE model and write its asset file; `known` of the task is what houses say of models."""
    settings = task.reading.settings
    model = read_model(Folder.at(task.root).sub(MODELS), info, settings.models, task.reading.licence, task.known.get(info.model_id))
    asset = model.asset
    rows = LibraryRows(rejects=list(model.rejects))
    rows.keep(task.reading.assets, asset, Scale(model.box.unit), taxonomy.load().materials.get(info.material.lower(), ""), info.material)
    w, d, h = asset.size.tolist()
    shape = occupancy_bits(asset.meshes(), asset.size)
    rows.models[info.model_id] = Model(model.box, asset.category, asset.asset_id, (w, d, h), asset.openable, shape)
    return rows


def _folders(folder: Path) -> Iterator[Path]:
    yield from (p for p in folder.iterdir() if p.is_dir()) if folder.is_dir() else ()
