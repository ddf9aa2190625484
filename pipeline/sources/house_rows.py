"""Rows of the training tables as one house gives them."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from pipeline.sources.reasons import Row, reject


@dataclass(slots=True)
class HouseRows:
    """What a house gives; all lists are empty but `rejects` when it is left out. `name` is that of its file.

    `content` is a digest of its rooms and furniture, wherever its file lies and whatever it is called; "" where nobody needs it.
    """

    name: str = ""
    scenes: list[Row] = field(default_factory=list)
    rooms: list[Row] = field(default_factory=list)
    openings: list[Row] = field(default_factory=list)
    objects: list[Row] = field(default_factory=list)
    rejects: list[Row] = field(default_factory=list)
    content: str = ""


def number_scenes(parts: Iterable[HouseRows]) -> Iterator[HouseRows]:
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
