"""`sfgen doctor --use PATH`: takes real copies into use; `--use embedded` goes back to the embedded corpus."""

import sys
from collections.abc import Sequence
from pathlib import Path

from pipeline import params
from pipeline.errors import UsageError
from pipeline.manifest import write_bytes
from pipeline.sources import inventory
from pipeline.sources.registry import SOURCES, recognise_sources
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.source import Listing

EMBEDDED = "embedded"
OURS = "CC0-1.0"  # of the embedded corpus
MADE = "LicenseRef-research-only"  # what is made of research-only furniture may not be more than that


def main(root: Path, paths: Sequence[Path]) -> None:
    """Recognise what lies in `paths`, write its inventories, then name it in params.yaml."""
    text = (root / "params.yaml").read_text(encoding="utf-8")
    if any(str(path) == EMBEDDED for path in paths):
        if len(paths) > 1:
            raise UsageError("--use embedded goes with no other --use", "give it alone")
        plain = PreprocessSettings()
        changes: dict[tuple[str, ...], str | None] = {("shard", "licence"): OURS}
        for source in SOURCES:
            path = plain.sources.get(source.key)
            changes[("preprocess", "sources", source.key)] = path
            changes[("preprocess", "licences", source.key)] = OURS if path else source.licence
            (root / inventory.FOLDER / f"{source.key}.csv").unlink(missing_ok=True)
        save(root, params.rewritten(text, changes))
        sys.stdout.write("the embedded corpus is in use; `dvc repro` makes what follows from it\n")
        return
    listings = sources_by_key(paths)
    changes = {("shard", "licence"): MADE}
    for source in SOURCES:
        if source.key in listings:
            changes[("preprocess", "sources", source.key)] = params_path(root, listings[source.key].root)
            changes[("preprocess", "licences", source.key)] = source.licence
        elif source.replaces & listings.keys():  # the houses that are named, no longer what somebody made of them
            changes[("preprocess", "sources", source.key)] = None
            (root / inventory.FOLDER / f"{source.key}.csv").unlink(missing_ok=True)
    text = params.rewritten(text, changes)
    for key, listing in listings.items():
        files = inventory.write(root / inventory.FOLDER / f"{key}.csv", inventory.scan(listing))
        sys.stdout.write(f"+ {key}: {listing}; {files} files in {inventory.FOLDER / key}.csv\n")
    save(root, text)
    sys.stdout.write("params.yaml names them, with their licences; `dvc repro` reads them\n")


def sources_by_key(paths: Sequence[Path]) -> dict[str, Listing]:
    """Return the one source of each kind, by key. Raises UsageError when two of a kind are given."""
    listings: dict[str, Listing] = {}
    for listing in (s for path in paths for s in recognise_sources(path)):
        other = listings.setdefault(listing.key, listing)
        if other.root != listing.root:
            raise UsageError(f"{other.root} and {listing.root} are both {listing.key} data", "give one of them")
    return listings


def params_path(root: Path, path: Path) -> str:
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
