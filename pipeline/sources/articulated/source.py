"""PartNet-Mobility, GAPartNet and other people's URDFs as a source of models: a folder of objects, however deep."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from pipeline import taxonomy
from pipeline.sources.articulated import proportions
from pipeline.sources.articulated.assets import assets
from pipeline.sources.articulated.objects import Found, objects_in
from pipeline.sources.articulated.partnet import URDFS, read_shape
from pipeline.sources.articulated.plain_urdf import candidates, orient_shape, read_plain_urdf
from pipeline.sources.articulated.proportions import Proportions
from pipeline.sources.batch import Batch
from pipeline.sources.folders import require_folders
from pipeline.sources.guarded import Folder
from pipeline.sources.library_rows import LibraryRows, Scale
from pipeline.sources.reasons import reject
from pipeline.sources.settings import ModelLimits, PreprocessSettings
from pipeline.sources.source import Listing, Reading, Source


@dataclass(frozen=True, slots=True)
class ObjectTask:
    """What every object is read with; `spreads`: by model category, what its objects' proportions are."""

    source: Path
    out: Path
    limits: ModelLimits
    licence: str
    spreads: Mapping[str, Proportions] = field(default_factory=dict)


class Articulated(Source):
    """See `pipeline.sources.source.Source`."""

    key = "partnet"
    licence = "LicenseRef-PartNet-Mobility"
    expected = "folders of PartNet-Mobility or GAPartNet objects"
    replaces: frozenset[str] = frozenset()

    def recognise(self, folder: Path) -> Path | None:
        """Return the folder that holds all objects; of a folder that is one of a set, the set is meant."""
        base = folder.parent if _is_object(folder) else folder
        names = [entry.path for entry in objects_in(base)]
        if not names:
            return None
        while all("/" in name for name in names) and len({name.split("/", 1)[0] for name in names}) == 1:
            base, names = base / names[0].split("/", 1)[0], [name.split("/", 1)[1] for name in names]
        return base

    def list(self, root: Path, _settings: PreprocessSettings, *, houses: bool = True) -> Listing:  # noqa: ARG002 - it has none
        """Describe a folder below which objects with a URDF lie; of a URDF by itself all of its folder counts as read."""
        require_folders(self.key, root)
        objects = objects_in(root)
        paths = [PurePosixPath(entry.path) for entry in objects]
        folders = {path.parent if path.suffix == ".urdf" else path for path in paths if not (root / path).is_symlink()}
        names = sorted(folder.as_posix() for folder in folders if folders.isdisjoint(folder.parents))
        recut = sum((root / name / URDFS[0][0]).is_file() for name in names)
        counts = (("objects", len(paths)), ("of them with GAPartNet's parts", recut))
        return Listing(self.key, root, tuple(names), counts, items=tuple(objects))

    def models(self, listing: Listing, reading: Reading) -> Iterator[LibraryRows]:
        """Read the proportions of all objects, then the objects."""
        drawn = Batch("extent", proportions.read_extent, listing.root, [entry.path for entry in listing.items], lambda *_: None)
        task = ObjectTask(
            listing.root,
            reading.assets,
            reading.settings.models,
            reading.licence,
            proportions.spreads(reading.each(drawn)),
        )
        yield from reading.each(Batch("object", read_object, task, listing.items, _no_object))


def read_object(task: ObjectTask, entry: Found) -> LibraryRows:
    """Read one articulated object and write an asset file for each category that it serves."""
    rows = LibraryRows()

    def work() -> None:
        kinds, root = taxonomy.load(), Folder.at(task.source)
        if entry.path.lower().endswith(".urdf"):
            categories = candidates(entry.path, kinds)
            shape = orient_shape(read_plain_urdf(root, entry.path, entry.source_id, task.limits.max_texture), categories)
        else:
            models = sorted({name for kind in kinds.categories.values() for name in kind.names.partnet})
            shape = read_shape(root.sub(entry.path), entry.source_id, task.limits.max_texture, models)
            categories = kinds.from_partnet(shape.model_cat) or ((shape.model_cat,) if shape.model_cat in kinds.categories else ())
        own = task.spreads.get(shape.model_cat)
        for asset, fit, rejects in assets(shape, entry.stem, categories, kinds, task.limits, task.licence, own):
            rows.keep(task.out, asset, Scale(fit.scale, fit.category if fit.fitted else "file", fit.rms))
            rows.rejects += rejects

    return rows.guard(entry.source_id, work)


def _no_object(entry: Found, reason: str, detail: str) -> LibraryRows:
    return LibraryRows(rejects=[reject("model", entry.source_id, reason, detail)])


def _is_object(folder: Path) -> bool:
    return (folder / "meta.json").is_file() or any((folder / name).is_file() for name, _ in URDFS)
