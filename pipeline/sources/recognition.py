"""Which of the known sources lie in a folder, however the archives were unpacked."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Literal

from pipeline.errors import ContentError, UsageError
from pipeline.sources.articulated.partnet import URDFS
from pipeline.sources.atiss.files import BOXES, STATS
from pipeline.sources.atiss.reader import kinds_of
from pipeline.sources.batch import HOUSES, MODELS, Found, partnet_objects

TEXTURES = "3D-FRONT-texture"
LEVELS = 2  # folders below the named one in which 3D-FRONT is looked for
HOUSE_NAME = re.compile(r"^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}\.json$")  # houses of 3D-FRONT are named by a uuid4
LICENCES = {
    "front": "LicenseRef-3D-FRONT-3D-FUTURE",
    "partnet": "LicenseRef-PartNet-Mobility",
    "peers": "LicenseRef-3D-FRONT-3D-FUTURE",
}


@dataclass(frozen=True, slots=True)
class Source:
    """One source as params.yaml names it: `root` the folder, `parts` what of it is read, `counts` what lies there, `lacks` what does not."""

    key: Literal["front", "partnet", "peers"]
    root: Path
    parts: tuple[str, ...]
    counts: tuple[tuple[str, int], ...]
    lacks: tuple[str, ...] = ()

    def __str__(self) -> str:
        """Say what was found."""
        found = ", ".join(f"{count} {what}" for what, count in self.counts)
        return f"{self.root}: {found}" + (f"; without {', '.join(self.lacks)}" if self.lacks else "")


def recognised(path: Path) -> list[Source]:
    """Return the sources that lie in `path`, or around it when it is a part of one.

    Raises UsageError for a path that is missing or no folder, ContentError when nothing that is known lies there, or
    only half of it.
    """
    if not path.is_dir():
        raise UsageError(f"{path} is {'no folder' if path.exists() else 'missing'}", "give the folder that the data was unpacked to")
    root = path.resolve()
    try:
        front = _front(root)
        # What the peers made of 3D-FRONT often lies beside it: then their rooms have to be named themselves.
        found = [source for source in (front, _partnet(root), None if front else _peers(root)) if source]
    except PermissionError as error:
        raise ContentError(f"{error.filename} cannot be read", "give yourself the right to read it") from error
    if not found:
        expected = f"{HOUSES}/*.json beside {MODELS}/model_info.json, folders of PartNet-Mobility or GAPartNet objects, or rooms as ATISS caches them"
        raise ContentError(f"{path} holds no data set that is known here", f"it should hold {expected}")
    return found


def front_at(root: Path) -> Source:
    """Describe a folder that holds 3D-FRONT and 3D-FUTURE-model side by side, or one of them beside the peers' rooms."""
    houses = sum(1 for p in (root / HOUSES).glob("*.json"))
    models, textures = (
        sum(1 for p in (root / name).iterdir() if p.is_dir()) if (root / name).is_dir() else 0 for name in (MODELS, TEXTURES)
    )
    counts = (("houses", houses), ("models", models), *((("textures", textures),) if textures else ()))
    lacks = () if textures else (f"{TEXTURES} (optional: walls and floors)",)
    return Source("front", root, tuple(name for name in (HOUSES, MODELS) if (root / name).is_dir()), counts, lacks)


def partnet_at(root: Path, objects: Sequence[Found] | None = None) -> Source:
    """Describe a folder below which objects with a URDF lie; of a URDF by itself all of its folder counts as read.

    `objects` are those that lie there, where somebody has looked already.
    """
    paths = [PurePosixPath(found.path) for found in (partnet_objects(root) if objects is None else objects)]
    folders = {path.parent if path.suffix == ".urdf" else path for path in paths if not (root / path).is_symlink()}
    names = sorted(folder.as_posix() for folder in folders if folders.isdisjoint(folder.parents))
    recut = sum((root / name / URDFS[0][0]).is_file() for name in names)
    return Source("partnet", root, tuple(names), (("objects", len(paths)), ("of them with GAPartNet's parts", recut)))


def peers_at(root: Path) -> Source:
    """Describe a folder of cached rooms, or of such folders. Raises ContentError for one of another kind."""
    names = tuple(kinds_of(root))
    rooms = {path.parent.name for name in names for path in (root / name).glob(f"*_*/{BOXES}")}
    houses = {room.split("_", 1)[0] for room in rooms}
    return Source("peers", root, (".",) if "." in names else names, (("rooms", len(rooms)), ("houses", len(houses))))


def _front(root: Path) -> Source | None:
    halves: dict[str, Path] = {}
    around = (root.parent,) if root.name in {HOUSES, MODELS, TEXTURES} else ()
    for folder in (root, *_below(root, LEVELS), *around):
        has_houses, has_models = _has_houses(folder / HOUSES), (folder / MODELS / "model_info.json").is_file()
        if has_houses and has_models:
            return front_at(folder)
        if folder not in around:
            halves |= ({HOUSES: folder} if has_houses else {}) | ({MODELS: folder} if has_models else {})
    if (root / "model_info.json").is_file():
        halves[MODELS] = root.parent
    elif HOUSES not in halves and (other := next((f for f in (root, *_below(root, 1)) if f.name != HOUSES and _holds_houses(f)), None)):
        raise ContentError(
            f"{other} holds houses of 3D-FRONT under another name", f"call the folder {HOUSES}, or link it so, with {MODELS} beside it"
        )
    elif root.name == HOUSES and _holds_houses(root):
        halves[HOUSES] = root.parent
    if halves:
        (name, folder), lacking = next(iter(halves.items())), (MODELS if HOUSES in halves else HOUSES)
        if len(halves) == 2:
            raise ContentError(
                f"{HOUSES} lies in {halves[HOUSES]}, {MODELS} in {halves[MODELS]}", "put both into one folder, by a link if need be"
            )
        remedy = f"put {lacking} beside it: objects cannot be read without both"
        if lacking == MODELS:
            remedy += "; for rooms with boxes alone name the folder in preprocess.front of params.yaml and set preprocess.filters.keep_without_model"
        raise ContentError(f"{folder} holds {name} but no {lacking}", remedy)
    return None


def _has_houses(folder: Path) -> bool:
    return folder.is_dir() and any(folder.glob("*.json"))


def _holds_houses(folder: Path) -> bool:
    return any(HOUSE_NAME.match(p.name) for p in folder.glob("*.json"))


def _is_object(folder: Path) -> bool:
    return (folder / "meta.json").is_file() or any((folder / name).is_file() for name, _ in URDFS)


def _partnet(root: Path) -> Source | None:
    if _is_object(root):  # one object of a set: the set is meant
        root = root.parent
    names = [found.path for found in partnet_objects(root)]
    if not names:
        return None
    base = root
    while all("/" in name for name in names) and len({name.split("/", 1)[0] for name in names}) == 1:
        base, names = base / names[0].split("/", 1)[0], [name.split("/", 1)[1] for name in names]
    return partnet_at(base)


def _peers(root: Path) -> Source | None:
    return peers_at(root) if next(root.glob(STATS), None) or next(root.glob(f"*/{STATS}"), None) else None


def _below(root: Path, levels: int) -> Iterator[Path]:
    """Yield the folders below, the nearest first; not those of single models or objects."""
    layer = [root]
    for _ in range(levels):
        layer = [p for folder in layer if folder.name not in {HOUSES, MODELS, TEXTURES} for p in sorted(folder.iterdir()) if p.is_dir()]
        yield from layer
