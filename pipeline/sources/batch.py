"""Reading whole sources: one task per model, object or house, spread over processes, results in the sources' order."""

from __future__ import annotations

import functools
import multiprocessing
import os
from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from pipeline import taxonomy
from pipeline.entities.asset import Asset
from pipeline.entities.files import save_asset
from pipeline.errors import ContentError
from pipeline.manifest import sha256
from pipeline.sources.articulated import assets as articulated
from pipeline.sources.articulated.household import candidates, oriented, read_household
from pipeline.sources.articulated.partnet import URDFS, read_shape
from pipeline.sources.articulated.proportions import Proportions
from pipeline.sources.guarded import Folder
from pipeline.sources.identity import split_of
from pipeline.sources.library_rows import Scale, asset_row, joint_rows, part_rows
from pipeline.sources.masses import held
from pipeline.sources.reasons import Row, SourceError, reject
from pipeline.sources.settings import FrontFilters, ModelLimits
from pipeline.sources.threed_front.furniture import Model
from pipeline.sources.threed_front.future import ModelInfo, read_model, read_model_info
from pipeline.sources.threed_front.house import HouseRows, read_house
from pipeline.sources.threed_front.house_file import Furniture
from pipeline.sources.threed_front.model_hints import Hint, records
from pipeline.sources.threed_front.notches import filled
from pipeline.sources.threed_front.walkable_share import Walker

T = TypeVar("T")
R = TypeVar("R")
HOUSES, MODELS = "3D-FRONT", "3D-FUTURE-model"
AHEAD = 64  # tasks handed to the pool before results are taken: memory stays flat over thousands of files
DEPTH = 4  # folders below the root in which objects are looked for


@dataclass(slots=True)
class LibraryRows:
    """What models give: rows, and what houses need to know of each 3D-FUTURE model."""

    assets: list[Row] = field(default_factory=list)
    joints: list[Row] = field(default_factory=list)
    parts: list[Row] = field(default_factory=list)
    rejects: list[Row] = field(default_factory=list)
    models: dict[str, Model] = field(default_factory=dict)

    def add(self, other: LibraryRows) -> None:
        """Append what another gave."""
        self.assets += other.assets
        self.joints += other.joints
        self.parts += other.parts
        self.rejects += other.rejects
        self.models.update(other.models)


@dataclass(frozen=True, slots=True)
class LibraryTask:
    """What every model task needs: where assets go, limits, licence.

    `hints`: what houses say of models; `categories`: by id, those that the user named; `spreads`: by model category, what
    its objects' proportions are.
    """

    source: Path
    out: Path
    limits: ModelLimits
    licence: str
    hints: Mapping[str, Hint] = field(default_factory=dict)
    categories: Mapping[str, str] = field(default_factory=dict)
    spreads: Mapping[str, Proportions] = field(default_factory=dict)


def future_models(source: Path, hints: Mapping[str, Hint]) -> tuple[list[ModelInfo], list[Row]]:
    """Return the models of a source by id, and the rejects of entries of model_info.json and of folders without one.

    A folder without an entry is a model all the same when houses name its category.
    """
    folder = Folder.at(source)
    infos, rejects = read_model_info(folder, f"{MODELS}/model_info.json")
    there = {p.name for p in (folder.root / MODELS).iterdir() if p.is_dir()}
    for name in sorted(there - infos.keys()):
        if name in hints and (hints[name].categories or hints[name].kinds):
            infos[name] = ModelInfo(name, "", "", "", "", "")
        else:
            rejects.append(reject("model", name, "no_model_info"))
    return [infos[k] for k in sorted(infos)], rejects


def house_records(source: Path, file: str) -> list[Furniture]:
    """Return what one house file says of the models in it; see `hints`."""
    return records(Folder.at(source), file)


@dataclass(frozen=True, slots=True)
class Found:
    """An object of an articulated source: its folder or URDF relative to the source, and the stem of its assets' ids."""

    path: str
    stem: str

    @property
    def source_id(self) -> str:
        """Return the id in the source: the folder's name, or the URDF's without its suffix."""
        return self.path.rsplit("/", 1)[-1].removesuffix(".urdf")


def partnet_objects(source: Path) -> list[Found]:
    """Return the objects below `source`, sorted: folders of PartNet-Mobility or GAPartNet, and URDFs by themselves.

    A link to a folder elsewhere is among them, to be refused; one to a folder within would only name it twice.
    """
    root, names = source.resolve(), {name for name, _ in URDFS}
    found = []
    for base, folders, files in os.walk(root):
        folders.sort()
        here = Path(base).relative_to(root)
        links = [f for f in folders if (Path(base) / f).is_symlink() and not (Path(base) / f).resolve().is_relative_to(root)]
        found += [(here / link).as_posix() for link in links]
        if names & set(files) or "meta.json" in files:
            found.append(here.as_posix())
            folders.clear()
            continue
        found += [(here / file).as_posix() for file in sorted(files) if file.lower().endswith(".urdf")]
        if len(here.parts) >= DEPTH:
            folders.clear()
    return _stems(found)


def _stems(paths: list[str]) -> list[Found]:
    """Give each object a stem for ids; those that share one once written in [a-z0-9_] get a digest of their path behind it."""
    plain = ["".join(c if c.isalnum() and c.isascii() else "_" for c in Found(path, "").source_id.lower())[:60] for path in paths]
    count = Counter(plain)
    return [
        Found(path, stem if count[stem] == 1 and stem.strip("_") else f"{stem.strip('_')}_{sha256(path.encode())[:8]}".strip("_"))
        for path, stem in zip(paths, plain, strict=True)
    ]


def read_future(task: LibraryTask, info: ModelInfo) -> LibraryRows:
    """Read one 3D-FUTURE model and write its asset file."""
    made = LibraryRows()

    def work() -> None:
        models = Folder.at(task.source).sub(MODELS)
        words, hint = taxonomy.load(), task.hints.get(info.model_id)
        model = read_model(models, info, words, task.limits, task.licence, hint, cut=task.limits.cut == "all")
        asset = model.asset
        _keep(made, task, asset, Scale(model.box.unit), words.materials.get(info.material.lower(), ""), info.material)
        made.rejects += model.rejects
        w, d, h = asset.size.tolist()
        made.models[info.model_id] = Model(
            model.box, asset.category, asset.asset_id, (w, d, h), asset.openable, filled(asset.meshes(), asset.size)
        )

    return _guarded(made, "model", info.model_id, work)


def read_partnet(task: LibraryTask, found: Found) -> LibraryRows:
    """Read one articulated object and write an asset file for each category that it serves."""
    made = LibraryRows()

    def work() -> None:
        kinds, root = taxonomy.load(), Folder.at(task.source)
        named = task.categories.get(found.source_id) or task.categories.get(found.path) or ""
        if found.path.lower().endswith(".urdf"):
            categories = candidates(found.path, named, kinds)
            shape = oriented(read_household(root, found.path, found.source_id, task.limits.max_texture), categories)
        else:
            models = sorted({name for kind in kinds.categories.values() for name in kind.names.partnet})
            shape = read_shape(root.sub(found.path), found.source_id, task.limits.max_texture, models, named)
            categories = kinds.from_partnet(shape.model_cat) or ((shape.model_cat,) if shape.model_cat in kinds.categories else ())
        own = task.spreads.get(shape.model_cat)
        for asset, fit, rejects in articulated.assets(shape, found.stem, categories, kinds, task.limits, task.licence, own):
            _keep(made, task, asset, Scale(fit.scale, fit.category if fit.fitted else "file", fit.rms))
            made.rejects += rejects

    return _guarded(made, "model", found.source_id, work)


def _keep(made: LibraryRows, task: LibraryTask, asset: Asset, scale: Scale, material: str = "", matter: str = "") -> None:
    """Write an asset and its rows; `matter` is the material by which its density was chosen.

    A mass by volume is held to what such things weigh; a URDF to scale may state its own.
    """
    asset, heavier = (asset, 1.0) if asset.source == "urdf" else held(asset)
    file = f"{asset.asset_id}.safetensors"
    digest = save_asset(task.out / file, asset)
    split = split_of(asset.source_id)
    made.assets.append(
        asset_row(asset, material=material, matter=matter, split=split, scale=scale, file=file, sha256=digest, heavier=heavier)
    )
    made.joints += joint_rows(asset)
    made.parts += part_rows(asset)


def _guarded(made: LibraryRows, what: str, where: str, work: Callable[[], None]) -> LibraryRows:
    """Do the work; whatever goes wrong in one file becomes a reject of that file."""
    try:
        work()
    except SourceError as error:
        made.rejects.append(reject(what, where, error.code, f"{error.where}: {error.detail}"))
    except Exception as error:  # noqa: BLE001 - one bad file of thousands must not end the run; the table tells
        made.rejects.append(reject(what, where, "internal", f"{type(error).__name__}: {error}"))
    return made


@dataclass(frozen=True, slots=True)
class HouseTask:
    """What every house task needs."""

    source: Path
    models: Mapping[str, Model]
    filters: FrontFilters
    licence: str
    walker: Walker


def house_files(source: Path) -> list[str]:
    """Return the house files, sorted, relative to the source."""
    return [f"{HOUSES}/{p.name}" for p in sorted((source / HOUSES).glob("*.json"))]


def read_front(task: HouseTask, file: str) -> HouseRows:
    """Read one house."""
    try:
        return read_house(Folder.at(task.source), file, task.models, taxonomy.load(), task.filters, task.licence, task.walker)
    except Exception as error:  # noqa: BLE001 - as in _guarded
        return HouseRows(rejects=[reject("house", Path(file).stem, "internal", f"{type(error).__name__}: {error}")])


def each(step: Callable[[T, R], Any], common: T, items: Sequence[R], workers: int) -> Iterator[Any]:
    """Yield step(common, item) for each item in order, over `workers` processes; `common` is sent to each process once."""
    if workers <= 1 or len(items) < 2 * workers:
        yield from (step(common, item) for item in items)
        return
    context = _context()
    with ProcessPoolExecutor(workers, context, _receive, (step, common)) as pool:
        waiting: deque[Future[Any]] = deque()
        try:
            for item in items:
                waiting.append(pool.submit(_do, item))
                if len(waiting) >= AHEAD:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        except Exception:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _context() -> Any:
    """Return how processes start: from a server that has imported all this once, anew where there is none (Windows)."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([__name__])
    return context


_work: Callable[[Any], Any] | None = None


def _receive(step: Callable[[Any, Any], Any], common: Any) -> None:
    global _work  # noqa: PLW0603 - what a pool's process is started with has no other place
    _work = functools.partial(step, common)


def _do(item: Any) -> Any:
    if _work is None:
        raise ContentError("a worker was not set up", "report this")
    return _work(item)


def numbered(parts: Iterable[HouseRows]) -> Iterator[HouseRows]:
    """Yield the rows of all houses, their scenes numbered in order; one that was there before under another name only gives a reject."""
    count = 0
    known: dict[str, str] = {}
    for part in parts:
        first = known.setdefault(part.content, part.name) if part.content else part.name
        if first != part.name:
            of_house = [row for row in part.rejects if row["what"] == "house"]
            yield HouseRows(part.name, rejects=[*of_house, reject("house", part.name, "duplicate_house", f"the same as {first}")])
            continue
        for scene in part.scenes:
            scene["index"] = count
            count += 1
        yield part
