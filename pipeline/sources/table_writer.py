"""The training tables as houses fill them: rows go to disk, counts stay, so that memory is flat over thousands of houses."""

import contextlib
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

from pipeline import tables
from pipeline.errors import ContentError
from pipeline.sources.rows import HouseRows, LibraryRows, number_scenes
from schemas import ASSET_JOINTS, ASSET_PARTS, ASSETS, OBJECTS, OPENINGS, REJECTS, ROOMS, SCENES


class Summary:
    """Counts of what was read: rows by table, rejects by (what, reason), ids of the assets that objects use, openings."""

    def __init__(self) -> None:
        self.rows: Counter[str] = Counter()
        self.rejects: Counter[tuple[str, str]] = Counter()
        self.assets: set[str] = set()
        self.joining: Counter[int] = Counter()  # openings by how many rooms they join
        self.linked = 0  # rooms that an opening joins to another room

    def add(self, house: HouseRows) -> None:
        """Count a house."""
        self.rows.update(houses=len(house.scenes), rooms=len(house.rooms), openings=len(house.openings), objects=len(house.objects))
        self.assets.update(row["asset_id"] for row in house.objects)
        self.rejects.update((row["what"], row["reason"]) for row in house.rejects)
        self.joining.update(len(row["rooms"]) for row in house.openings)
        self.linked += len({(row["scene_id"], room) for row in house.openings if len(row["rooms"]) > 1 for room in row["rooms"]})

    def lines(self) -> Iterator[str]:
        """Yield lines for a person: what was read, how many openings could be resolved, what was left out and why."""
        yield ", ".join(f"{count} {name}" for name, count in self.rows.items())
        none = self.rejects[("opening", "opening_unresolved")]
        total = max(1, sum(self.joining.values()) + none)
        parts = ((self.joining[2], "join two rooms"), (self.joining[1], "lead from one room outside"), (none, "lie at no room"))
        yield "  openings: " + ", ".join(f"{n} ({n / total:.0%}) {what}" for n, what in parts)
        yield f"  rooms that an opening joins to another: {self.linked} of {self.rows['rooms']}"
        for (what, reason), count in sorted(self.rejects.items()):
            yield f"  {what} {reason}: {count}"


def write_houses(folder: Path, houses: Iterable[HouseRows], library: LibraryRows, source: str) -> Summary:
    """Write scenes, rooms, openings, objects and rejects, those of `library` first, and return the counts of the houses.

    Raises ContentError, naming `source`, and writes nothing where no house is usable.
    """
    summary = Summary()
    with contextlib.ExitStack() as stack:
        written = (SCENES, ROOMS, OPENINGS, OBJECTS, REJECTS)
        opened = {t.name: stack.enter_context(tables.stream(folder / f"{t.name}.parquet", t)) for t in written}
        opened["rejects"].add(library.rejects)
        for house in number_scenes(houses):
            summary.add(house)
            for name, stream in opened.items():
                stream.add(getattr(house, name))
        if not summary.rows["houses"]:
            reasons = ", ".join(f"{reason} {n}" for (_, reason), n in summary.rejects.most_common(3))
            raise ContentError(f"{source} gives no usable house ({reasons or 'no files'})", "docs/reasons.md explains the codes")
    return summary


def write_library(folder: Path, library: LibraryRows, summary: Summary) -> None:
    """Write assets, asset_joints and asset_parts, and count them."""
    for table, rows in ((ASSETS, library.assets), (ASSET_JOINTS, library.joints), (ASSET_PARTS, library.parts)):
        tables.write(folder / f"{table.name}.parquet", table, rows)
    summary.rows.update(assets=len(library.assets), joints=len(library.joints))
    summary.rejects.update((row["what"], row["reason"]) for row in library.rejects)
