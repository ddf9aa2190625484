"""The program that a given plan is: every room with its area, every opening as a link; so that wishes have something to hang on."""

from pipeline.entities.plan import Plan
from pipeline.floorplan.program.floor_program import Entrance, FloorProgram, Link, Range, RoomReq, Shell

THINNEST, THICKEST = 0.05, 0.6  # that a program states [m]; walls measured in a plan may lie beyond
KINDS = {"door": "door", "open": "open", "portal": "portal"}


def program_of(plan: Plan) -> FloorProgram:
    """Return the completed program that the plan answers to. Nothing in it was said in words."""
    rooms = [
        RoomReq.model_validate(
            {
                "id": r.room_id,
                "type": r.type,
                "role": r.role,
                "functions": r.functions,
                "level": r.level,
                "area": Range(target=round(r.area, 3), stated=True),
                "stated": False,
            }
        )
        for r in plan.rooms
    ]
    pairs: dict[tuple[str, str], str] = {}
    for o in plan.openings:
        if o.kind in KINDS and len(o.rooms) == 2:
            pairs.setdefault((min(o.rooms), max(o.rooms)), KINDS[o.kind])
    links = tuple(Link.model_validate({"a": a, "b": b, "kind": kind}) for (a, b), kind in sorted(pairs.items()))
    inside = round(sum(r.area for r in plan.rooms if r.type not in {"balcony", "garage"}), 3)
    return FloorProgram(
        storeys=1 + max(r.level for r in plan.rooms),
        total_area=Range(target=inside, stated=True) if inside else Range(),
        rooms=tuple(rooms),
        links=links,
        entrance=Entrance(into=plan.entrance),
        shell=Shell(inner_wall=_wall(plan.inner_wall), outer_wall=_wall(plan.outer_wall), ceiling=max(r.height for r in plan.rooms)),
        only=True,
    )


def _wall(thickness: float) -> float:
    return round(min(max(thickness, THINNEST), THICKEST), 4)
