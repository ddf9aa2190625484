"""Folders of data: those that have to be there, and those that lie near the one that a user names."""

from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

from pipeline.errors import ContentError


def require_folders(key: str, root: Path, parts: Iterable[str] = ()) -> None:
    """Raise ContentError, naming the key of params.yaml, where a source's folder or a part of it is missing."""
    for folder in (root, *(root / part for part in parts)):
        if not folder.is_dir():
            remedy = "name the folder of the data with `sfgen doctor --use PATH`, or make the embedded corpus with `dvc repro corpus`"
            raise ContentError(f"preprocess.sources.{key}: {folder} is {'no folder' if folder.exists() else 'missing'}", remedy)


def below(root: Path, levels: int, closed: Collection[str] = ()) -> Iterator[Path]:
    """Yield the folders below, the nearest first; those named in `closed` are not looked into."""
    layer = [root]
    for _ in range(levels):
        layer = [p for folder in layer if folder.name not in closed for p in sorted(folder.iterdir()) if p.is_dir()]
        yield from layer
