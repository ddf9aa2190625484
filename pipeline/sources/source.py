"""What a dataset has to offer to be read: one folder of code with a `Source`, named in `registry`."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from pipeline.errors import ContentError
from pipeline.execution import track
from pipeline.sources.batch import Batch, each
from pipeline.sources.rows import HouseRows, LibraryRows
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.walkable_share import Walker


@dataclass(frozen=True, slots=True)
class Listing:
    """What lies in a source's folder `root`.

    `parts` is what of it is read, `counts` of which there is how much, `lacks` what is not there, `items` what its reader goes through.
    """

    key: str
    root: Path
    parts: tuple[str, ...]
    counts: tuple[tuple[str, int], ...]
    lacks: tuple[str, ...] = ()
    items: tuple[Any, ...] = field(default=(), repr=False)

    def __str__(self) -> str:
        """Say what was found."""
        contents = ", ".join(f"{count} {what}" for what, count in self.counts)
        return f"{self.root}: {contents}" + (f"; without {', '.join(self.lacks)}" if self.lacks else "")


@dataclass(frozen=True, slots=True)
class Reading:
    """What a source is read with: settings, the licence of what is made, the folder for assets, who must find a way through a house.

    `houses`: whether its houses are wanted, or those of another source in their place.
    """

    settings: PreprocessSettings
    licence: str
    assets: Path
    walker: Walker
    workers: int
    houses: bool = True

    def each(self, batch: Batch[Any, Any, Any]) -> Iterator[Any]:
        """Yield what comes of each item, with a bar that says how far it is."""
        return iter(track(each(batch, self.workers, self.settings.budget), len(batch.items), f"{batch.unit}s", unit=batch.unit))


@dataclass(frozen=True, slots=True)
class Task:
    """What every item of a source is read with: where it lies, how it is read, and what is `known` by id, such as the models of a house."""

    root: Path
    reading: Reading
    known: Mapping[str, Any] = field(default_factory=dict)


class Source(Protocol):
    """A dataset that can be read.

    `key` names it under preprocess.sources of params.yaml, `licence` is that of real copies [SPDX], `expected` says what its folder
    holds, and `replaces` names sources of the same houses, which are not read from there where this one is in use.
    """

    key: str
    licence: str
    expected: str
    replaces: frozenset[str]

    def recognise(self, folder: Path) -> Path | None:
        """Return the folder of its data, which lies in `folder` or around it, or None. Raises ContentError for half of it."""

    def list(self, root: Path, settings: PreprocessSettings, *, houses: bool = True) -> Listing:
        """Say what lies in the folder of its data. Raises ContentError where something that is read is missing."""

    def models(self, listing: Listing, reading: Reading) -> Iterator[LibraryRows]:  # noqa: ARG002 - for those that have some
        """Read its models, if it has any, and write their assets."""
        return iter(())

    def houses(self, listing: Listing, reading: Reading, library: LibraryRows) -> Iterator[HouseRows]:  # noqa: ARG002 - likewise
        """Read its houses, if it has any; the models of all sources are in the `library`."""
        return iter(())


def require_folders(key: str, root: Path, parts: Iterable[str] = ()) -> None:
    """Raise ContentError, naming the key of params.yaml, where a source's folder or a part of it is missing."""
    for folder in (root, *(root / part for part in parts)):
        if not folder.is_dir():
            remedy = "name the folder of the data with `sfgen doctor --use PATH`, or make the embedded corpus with `dvc repro corpus`"
            raise ContentError(f"preprocess.sources.{key}: {folder} is {'no folder' if folder.exists() else 'missing'}", remedy)


def folders_below(root: Path, levels: int, closed: Collection[str] = ()) -> Iterator[Path]:
    """Yield the folders below, the nearest first; those named in `closed` are not looked into."""
    layer = [root]
    for _ in range(levels):
        layer = [p for folder in layer if folder.name not in closed for p in sorted(folder.iterdir()) if p.is_dir()]
        yield from layer
