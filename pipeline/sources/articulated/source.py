"""PartNet-Mobility, GAPartNet and other people's URDFs as a source of models: a folder of objects, however deep."""

import os
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from pipeline import taxonomy
from pipeline.manifest import sha256
from pipeline.sources.articulated.assets import assets
from pipeline.sources.articulated.metric_scale import gather_proportions, read_extent
from pipeline.sources.articulated.partnet import URDFS, read_shape, stated_category
from pipeline.sources.articulated.plain_urdf import candidates, orient_shape, read_plain_urdf
from pipeline.sources.batch import Batch
from pipeline.sources.guarded import Folder
from pipeline.sources.reasons import SourceError
from pipeline.sources.rows import LibraryRows, Scale
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.source import Listing, Reading, Source, Task, require_folders

DEPTH = 4  # folders below the root in which objects are looked for
OWN_FILES = frozenset({"meta.json", *(name for name, _ in URDFS)})  # a folder with one of these is an object


@dataclass(frozen=True, slots=True)
class ObjectEntry:
    """An object of an articulated source: its folder or URDF relative to the source, and the stem of its assets' ids."""

    path: str
    stem: str

    @property
    def source_id(self) -> str:
        """Return the id in the source: the folder's name, or the URDF's without its suffix."""
        return self.path.rsplit("/", 1)[-1].removesuffix(".urdf")


class Articulated(Source):
    """See `pipeline.sources.source.Source`."""

    key = "partnet"
    licence = "LicenseRef-PartNet-Mobility"
    expected = "folders of PartNet-Mobility or GAPartNet objects"
    replaces: frozenset[str] = frozenset()

    def recognise(self, folder: Path) -> Path | None:
        """Return the folder that holds all objects; of a folder that is one of a set, the set is meant."""
        base = folder.parent if any((folder / name).is_file() for name in OWN_FILES) else folder
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
        drawn = Batch("extent", read_extent, listing.root, [entry.path for entry in listing.items], lambda *_: None)
        task = Task(listing.root, reading, gather_proportions(reading.each(drawn)))
        yield from reading.each(
            Batch("object", read_object, task, listing.items, lambda entry, *why: LibraryRows.refused(entry.source_id, *why))
        )


def objects_in(source: Path) -> list[ObjectEntry]:
    """Return the objects below `source`, sorted: folders of PartNet-Mobility or GAPartNet, and URDFs by themselves.

    A link to a folder elsewhere is among them, to be refused; one to a folder within would only name it twice. Objects that share a stem
    once it is written in [a-z0-9_] get a digest of their path behind it.
    """
    root = source.resolve()
    paths = []
    for base, folders, files in os.walk(root):
        folders.sort()
        here = Path(base).relative_to(root)
        links = [f for f in folders if (Path(base) / f).is_symlink() and not (Path(base) / f).resolve().is_relative_to(root)]
        paths += [(here / link).as_posix() for link in links]
        if not OWN_FILES.isdisjoint(files):
            paths.append(here.as_posix())
            folders.clear()
            continue
        paths += [(here / file).as_posix() for file in sorted(files) if file.lower().endswith(".urdf")]
        if len(here.parts) >= DEPTH:
            folders.clear()
    plain = ["".join(c if c.isalnum() and c.isascii() else "_" for c in ObjectEntry(path, "").source_id.lower())[:60] for path in paths]
    count = Counter(plain)
    return [
        ObjectEntry(path, stem if count[stem] == 1 and stem.strip("_") else f"{stem.strip('_')}_{sha256(path.encode())[:8]}".strip("_"))
        for path, stem in zip(paths, plain, strict=True)
    ]


def read_object(task: Task, entry: ObjectEntry) -> LibraryRows:
    """Read one articulated object and write an asset file for each category that it serves; `known` of the task are proportions by category."""
    rows, kinds, root, limits = LibraryRows(), taxonomy.load(), Folder.at(task.root), task.reading.settings.models
    if entry.path.lower().endswith(".urdf"):
        categories = candidates(entry.path, kinds)
        shape = orient_shape(read_plain_urdf(root, entry.path, entry.source_id, limits.max_texture), categories)
    else:
        models = sorted({name for kind in kinds.categories.values() for name in kind.names.partnet})
        shape = read_shape(root.sub(entry.path), entry.source_id, limits.max_texture, models)
        stated = stated_category(root.sub(entry.path))
        if stated and stated not in kinds.categories:
            raise SourceError("unknown_category", entry.source_id, f"category {stated!r} in meta.json")
        categories = (stated,) if stated else kinds.from_partnet(shape.model_cat)
        categories = categories or ((shape.model_cat,) if shape.model_cat in kinds.categories else ())
    own = task.known.get(shape.model_cat)
    for asset, fit, rejects in assets(shape, entry.stem, categories, kinds, limits, task.reading.licence, own):
        rows.keep(task.reading.assets, asset, Scale(fit.scale, fit.category if fit.fitted else "file", fit.rms))
        rows.rejects += rejects
    return rows
