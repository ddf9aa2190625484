"""`sfgen doctor --use PATH`: takes real copies into use; `--use embedded` goes back to the embedded corpus."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from pipeline import params
from pipeline.errors import UsageError
from pipeline.manifest import write_bytes
from pipeline.sources import inventory
from pipeline.sources.recognition import LICENCES, Source, recognised
from pipeline.sources.settings import PreprocessSettings

EMBEDDED = "embedded"
MADE = "LicenseRef-research-only"  # what is made of research-only furniture may not be more than that


def main(root: Path, paths: Sequence[Path]) -> None:
    """Recognise what lies in `paths`, write its inventories, then name it in params.yaml."""
    text = (root / "params.yaml").read_text(encoding="utf-8")
    if any(str(path) == EMBEDDED for path in paths):
        if len(paths) > 1:
            raise UsageError("--use embedded goes with no other --use", "give it alone")
        plain = PreprocessSettings()
        changes: dict[tuple[str, str], str | None] = {
            ("preprocess", key): getattr(plain, key)
            for key in ("front", "partnet", "peers", "front_licence", "partnet_licence", "peers_licence")
        }
        save(root, params.rewritten(text, {**changes, ("shard", "licence"): "CC0-1.0"}))
        for key in LICENCES:
            (root / inventory.FOLDER / f"{key}.csv").unlink(missing_ok=True)
        sys.stdout.write("the embedded corpus is in use; `dvc repro` makes what follows from it\n")
        return
    found = chosen(paths)
    changes = {("shard", "licence"): MADE}
    for source in found:
        changes |= {("preprocess", source.key): written(root, source.root), ("preprocess", f"{source.key}_licence"): LICENCES[source.key]}
    if {source.key for source in found} & {"front", "peers"} == {"front"}:  # its houses, no longer somebody's rooms
        changes[("preprocess", "peers")] = None
        (root / inventory.FOLDER / "peers.csv").unlink(missing_ok=True)
    text = params.rewritten(text, changes)
    for source in found:
        files = inventory.write(root / inventory.FOLDER / f"{source.key}.csv", inventory.scan(source))
        sys.stdout.write(f"+ {source.key}: {source}; {files} files in {inventory.FOLDER / source.key}.csv\n")
    save(root, text)
    sys.stdout.write("params.yaml names them, with their licences; `dvc repro` reads them\n")


def chosen(paths: Sequence[Path]) -> list[Source]:
    """Return the one source of each kind. Raises UsageError when two of a kind are given."""
    found: dict[str, Source] = {}
    for source in (s for path in paths for s in recognised(path)):
        other = found.setdefault(source.key, source)
        if other.root != source.root:
            raise UsageError(f"{other.root} and {source.root} are both {source.key} data", "give one of them")
    return list(found.values())


def written(root: Path, path: Path) -> str:
    """Return a path as params.yaml names it: relative where it lies in the checkout."""
    return path.relative_to(root).as_posix() if path.is_relative_to(root) else str(path)


def save(root: Path, text: str) -> None:
    """Write params.yaml, if it still reads."""
    target = root / "params.yaml"
    before = target.read_bytes()
    write_bytes(target, text.encode())
    try:
        params.section(PreprocessSettings, params.read(target), "preprocess")
    except Exception:
        write_bytes(target, before)
        raise
