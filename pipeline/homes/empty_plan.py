"""Is a given plan, still empty, one that a robot can live in? The judge that homes must pass says so before anything is furnished.

A real home may have a closet behind a door of 45 cm. It is a home all the same: such a room is furnished, a robot stays outside of
it, and that is said. Only where the robot is kept out of the larger part is the plan refused.
"""

from pathlib import Path

from pipeline import params
from pipeline.entities.home import Home
from pipeline.entities.plan import Plan
from pipeline.errors import RefusedError
from pipeline.floorplan.imports import OwnPlan, Repair
from pipeline.verify import Certificate, VerifySettings, verify_home


class UnsoundError(RefusedError):
    """A plan in which a door cannot swing, or of which a robot sees less than half."""

    code = "unsound"


def require_sound(root: Path, own: OwnPlan) -> OwnPlan:
    """Return a plan with what a robot finds closed, by the policy of params.yaml in the checkout at `root`. Raises UnsoundError as `check_sound`."""
    return own.and_found(check_sound(own.plan, params.section(VerifySettings, params.read(root / "params.yaml"), "verify")))


def check_sound(plan: Plan, settings: VerifySettings) -> tuple[Repair, ...]:
    """Return a finding for each room that a robot does not get into. Raises UnsoundError naming what is wrong with the empty home."""
    judged = judge_empty(plan, settings)
    closed = judged.closed_rooms() if settings.policy.connected else frozenset[str]()
    width = 2 * settings.robot.radius
    remedy = f"doors and rooms must let a robot {width:.2f} m wide pass"
    if faults := judged.faults(settings.policy, closed):
        code, detail = faults[0]
        what = "a door leaf does not open:" if code == "joint_blocked" else code
        raise UnsoundError(f"the plan cannot be built: {what} {detail}", remedy)
    areas = {room.room_id: room.area for room in plan.rooms}
    shut = {room: f"a robot {width:.2f} m wide does not get into it: {_ways(plan, room)}" for room in areas if room in closed}
    if 2 * sum(areas[room] for room in shut) > sum(areas.values()):
        room, why = next(iter(shut.items()))
        others = f", nor into {', '.join([*shut][1:])}" if len(shut) > 1 else ""
        raise UnsoundError(f"the plan cannot be built: {room}: {why}{others}; that is more than half of the floor", remedy)
    return tuple(Repair("closed", room, why) for room, why in shut.items())


def closed_rooms(plan: Plan, settings: VerifySettings) -> frozenset[str]:
    """Return the rooms of an empty home that a robot does not get into."""
    return judge_empty(plan, settings).closed_rooms()


def judge_empty(plan: Plan, settings: VerifySettings) -> Certificate:
    """Judge a home in which nothing stands yet."""
    return verify_home(Home("empty", 0, 0, "", "", plan, ()), {}, settings)


def _ways(plan: Plan, room: str) -> str:
    """Return the ways into a room with their widths, as words."""
    ways = [f"{o.opening_id} is {o.width:.2f} m wide" for o in plan.openings if room in o.rooms and o.kind != "window"]
    return ", ".join(ways) or "no door leads to it"
