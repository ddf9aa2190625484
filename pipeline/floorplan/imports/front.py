"""The rooms of a 3D-FRONT house as a sketch: floors, doors and windows as `pipeline.sources` reads them, without the furniture."""

from collections.abc import Mapping
from typing import Any

from pipeline.errors import ContentError
from pipeline.floorplan.imports.sketch import Sketch, SketchOpening, SketchRoom, refuse
from pipeline.sources.reasons import REASONS, Row, SourceError
from pipeline.sources.settings import FrontFilters
from pipeline.sources.threed_front.house import openings_of, rooms_of
from pipeline.sources.threed_front.house_file import parse_house


def is_front(document: object) -> bool:
    """Whether a document looks like a 3D-FRONT house."""
    return isinstance(document, dict) and isinstance(document.get("scene"), dict) and "mesh" in document


def front_sketch(document: Mapping[str, Any], name: str) -> Sketch:
    """Read a house. Raises ContentError for a broken file, RefusedError for a house without a usable floor."""
    rejects: list[Row] = []
    limits = FrontFilters()
    try:
        house = parse_house(document, name)
        rooms = rooms_of(house, limits, rejects)
        if not rooms:
            raise refuse("the house has no room with a floor")
        openings, (inner, outer) = openings_of(house, rooms, limits, rejects)
    except SourceError as error:
        raise ContentError(f"3D-FRONT house {name}: {error.code}: {error.detail or error}", "see docs/reasons.md for the code") from error
    sketch = Sketch(
        [SketchRoom(r.room_id, r.record.type, r.floor.polygon, height=round(r.height, 3)) for r in rooms],
        [SketchOpening(o.opening_id, o.kind, o.rooms, o.segment, height=o.height, sill=o.sill) for o in openings],
        "inner",
        "some",  # most rooms of the release have no Door mesh at all
        next((r.room_id for r in rooms if r.record.instance in house.entry_rooms), ""),
        inner,
        outer,
        units="m",
        foreign=True,
    )
    for row in rejects:
        reason = REASONS[row["reason"]]
        sketch.repair(row["reason"], row["where"], f"{reason.effect}: {reason.doc}" + (f" ({row['detail']})" if row["detail"] else ""))
    return sketch
