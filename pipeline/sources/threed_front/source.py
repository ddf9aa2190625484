"""3D-FRONT and 3D-FUTURE as a source: houses in 3D-FRONT/, their furniture in 3D-FUTURE-model/ beside it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from pipeline import taxonomy
from pipeline.sources.batch import Batch
from pipeline.sources.folders import below, require_folders
from pipeline.sources.guarded import Folder
from pipeline.sources.house_rows import HouseRows
from pipeline.sources.library_rows import LibraryRows, Scale
from pipeline.sources.reasons import Row, reject
from pipeline.sources.settings import FrontFilters, ModelLimits, PreprocessSettings
from pipeline.sources.source import Listing, Reading, Source
from pipeline.sources.threed_front.furniture import Model
from pipeline.sources.threed_front.future import ModelInfo, read_model, read_model_info
from pipeline.sources.threed_front.house import read_house
from pipeline.sources.threed_front.house_file import Furniture
from pipeline.sources.threed_front.model_hints import Hint, hints, records
from pipeline.sources.threed_front.notches import occupancy_bits
from pipeline.sources.walkable_share import Walker

HOUSES, MODELS, TEXTURES = "3D-FRONT", "3D-FUTURE-model", "3D-FRONT-texture"
LEVELS = 2  # folders below the named one in which it is looked for


@dataclass(frozen=True, slots=True)
class ModelTask:
    """What every model is read with; `hints` is what houses say of models."""

    source: Path
    out: Path
    limits: ModelLimits
    licence: str
    hints: Mapping[str, Hint] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class HouseTask:
    """What every house is read with."""

    source: Path
    models: Mapping[str, Model]
    filters: FrontFilters
    licence: str
    walker: Walker


class ThreedFront(Source):
    """See `pipeline.sources.source.Source`."""

    key = "front"
    licence = "LicenseRef-3D-FRONT-3D-FUTURE"
    expected = f"{HOUSES}/*.json beside {MODELS}/model_info.json"
    replaces: frozenset[str] = frozenset()

    def recognise(self, folder: Path) -> Path | None:
        """Return the folder with both halves, however the archives were unpacked."""
        around = (folder.parent,) if folder.name in {HOUSES, MODELS, TEXTURES} else ()
        places = (folder, *below(folder, LEVELS, {HOUSES, MODELS, TEXTURES}), *around)
        return next((p for p in places if _has_houses(p / HOUSES) and (p / MODELS / "model_info.json").is_file()), None)

    def list(self, root: Path, settings: PreprocessSettings, *, houses: bool = True) -> Listing:
        """Describe a folder of both halves; where other houses are read, or objects without models are kept, one may lack."""
        require_folders(self.key, root, [HOUSES] * houses + [MODELS] * (houses and not settings.filters.keep_without_model))
        files = house_files(root)
        models, textures = (sum(1 for _ in _folders(root / name)) for name in (MODELS, TEXTURES))
        counts = (("houses", len(files)), ("models", models), *((("textures", textures),) if textures else ()))
        lacks = () if textures else (f"{TEXTURES} (optional: walls and floors)",)
        return Listing(self.key, root, tuple(n for n in (HOUSES, MODELS) if (root / n).is_dir()), counts, lacks, tuple(files))

    def models(self, listing: Listing, reading: Reading) -> Iterator[LibraryRows]:
        """Read what houses say of the models, then the models."""
        said = hints(
            reading.each(Batch("record", house_records, listing.root, listing.items * reading.houses, _no_records)), taxonomy.load()
        )
        if MODELS in listing.parts:
            infos, rejects = future_models(listing.root, said)
            yield LibraryRows(rejects=rejects)
            task = ModelTask(listing.root, reading.assets, reading.settings.models, reading.licence, said)
            yield from reading.each(Batch("model", read_future, task, infos, _no_model))

    def houses(self, listing: Listing, reading: Reading, library: LibraryRows) -> Iterator[HouseRows]:
        """Read the houses."""
        task = HouseTask(listing.root, library.models, reading.settings.filters, reading.licence, reading.walker)
        yield from reading.each(Batch("house", read_front, task, listing.items, _no_house))


def house_files(source: Path) -> list[str]:
    """Return the house files, sorted, relative to the source."""
    return [f"{HOUSES}/{p.name}" for p in sorted((source / HOUSES).glob("*.json"))]


def house_records(source: Path, file: str) -> list[Furniture]:
    """Return what one house file says of the models in it; see `hints`."""
    return records(Folder.at(source), file)


def future_models(source: Path, said: Mapping[str, Hint]) -> tuple[list[ModelInfo], list[Row]]:
    """Return the models of a source by id, and the rejects of entries of model_info.json and of folders without one.

    A folder without an entry is a model all the same when houses name its category.
    """
    folder = Folder.at(source)
    infos, rejects = read_model_info(folder, f"{MODELS}/model_info.json")
    there = {p.name for p in _folders(folder.root / MODELS)}
    for name in sorted(there - infos.keys()):
        if name in said and (said[name].categories or said[name].kinds):
            infos[name] = ModelInfo(name, "", "", "", "", "")
        else:
            rejects.append(reject("model", name, "no_model_info"))
    return [infos[k] for k in sorted(infos)], rejects


def read_future(task: ModelTask, info: ModelInfo) -> LibraryRows:
    """Read one 3D-FUTURE model and write its asset file."""
    rows = LibraryRows()

    def work() -> None:
        models = Folder.at(task.source).sub(MODELS)
        words, hint = taxonomy.load(), task.hints.get(info.model_id)
        model = read_model(models, info, words, task.limits, task.licence, hint, cut=task.limits.cut == "all")
        asset = model.asset
        rows.keep(task.out, asset, Scale(model.box.unit), words.materials.get(info.material.lower(), ""), info.material)
        rows.rejects += model.rejects
        w, d, h = asset.size.tolist()
        rows.models[info.model_id] = Model(
            model.box, asset.category, asset.asset_id, (w, d, h), asset.openable, occupancy_bits(asset.meshes(), asset.size)
        )

    return rows.guard(info.model_id, work)


def read_front(task: HouseTask, file: str) -> HouseRows:
    """Read one house."""
    try:
        return read_house(Folder.at(task.source), file, task.models, taxonomy.load(), task.filters, task.licence, task.walker)
    except MemoryError:
        raise  # the budget's business
    except Exception as error:  # noqa: BLE001 - one bad file of thousands must not end the run; the table tells
        return _no_house(file, "internal", f"{type(error).__name__}: {error}")


def _no_house(file: str, reason: str, detail: str) -> HouseRows:
    return HouseRows(rejects=[reject("house", Path(file).stem, reason, detail)])


def _no_model(info: ModelInfo, reason: str, detail: str) -> LibraryRows:
    return LibraryRows(rejects=[reject("model", info.model_id, reason, detail)])


def _no_records(_file: str, _reason: str, _detail: str) -> list[Furniture]:
    return []  # told when the house itself is read


def _folders(folder: Path) -> Iterator[Path]:
    yield from (p for p in folder.iterdir() if p.is_dir()) if folder.is_dir() else ()


def _has_houses(folder: Path) -> bool:
    return folder.is_dir() and any(folder.glob("*.json"))
