"""The peers' cached rooms as a source of houses."""

from collections.abc import Iterator
from pathlib import Path

from pipeline.sources.atiss.files import BOXES, STATS
from pipeline.sources.atiss.reader import House, PeersTask, kinds_of, peers_houses, read_peers
from pipeline.sources.batch import Batch
from pipeline.sources.folders import require_folders
from pipeline.sources.house_rows import HouseRows
from pipeline.sources.library_rows import LibraryRows
from pipeline.sources.reasons import reject
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.source import Listing, Reading, Source


class Atiss(Source):
    """See `pipeline.sources.source.Source`. Its rooms are 3D-FRONT's; models come from 3D-FUTURE where that is at hand."""

    key = "peers"
    licence = "LicenseRef-3D-FRONT-3D-FUTURE"
    expected = "rooms as ATISS caches them"
    replaces = frozenset({"front"})

    def recognise(self, folder: Path) -> Path | None:
        """Return a folder of cached rooms, or of such folders."""
        return folder if next(folder.glob(STATS), None) or next(folder.glob(f"*/{STATS}"), None) else None

    def list(self, root: Path, _settings: PreprocessSettings, *, houses: bool = True) -> Listing:  # noqa: ARG002 - it has nothing else
        """Describe it. Raises ContentError for a folder of other classes."""
        require_folders(self.key, root)
        kinds = kinds_of(root)
        rooms = {path.parent.name for name in kinds for path in (root / name).glob(f"*_*/{BOXES}")}
        names = {room.split("_", 1)[0] for room in rooms}
        parts = (".",) if "." in kinds else tuple(kinds)
        return Listing(self.key, root, parts, (("rooms", len(rooms)), ("houses", len(names))), items=tuple(peers_houses(root, kinds)))

    def houses(self, listing: Listing, reading: Reading, library: LibraryRows) -> Iterator[HouseRows]:
        """Read the rooms, house by house."""
        task = PeersTask(listing.root, kinds_of(listing.root), library.models, reading.settings.filters, reading.licence, reading.walker)
        yield from reading.each(Batch("house", read_peers, task, listing.items, _no_house))


def _no_house(house: House, reason: str, detail: str) -> HouseRows:
    return HouseRows(rejects=[reject("house", house[0], reason, detail)])
