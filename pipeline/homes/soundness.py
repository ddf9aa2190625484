"""Is a given plan, still empty, one that a robot can live in? The judge that homes must pass says so before anything is furnished."""

from __future__ import annotations

from pathlib import Path

from pipeline import params
from pipeline.entities.home import Home
from pipeline.entities.plan import Plan
from pipeline.errors import RefusedError
from pipeline.verify import VerifySettings, verify_home


class UnsoundError(RefusedError):
    """A plan in which a door cannot swing, or a room cannot be entered."""

    code = "unsound"


def require_sound(root: Path, plan: Plan) -> None:
    """Raise UnsoundError naming what is wrong with the empty home, by the policy of params.yaml in the checkout at `root`."""
    check_sound(plan, params.section(VerifySettings, params.read(root / "params.yaml"), "verify"))


def check_sound(plan: Plan, settings: VerifySettings) -> None:
    """Raise UnsoundError naming what is wrong with the empty home."""
    faults = verify_home(Home("empty", 0, 0, "", "", plan, ()), {}, settings).faults(settings.policy)
    if faults:
        what = {"room_cut_off": "a robot does not get into", "joint_blocked": "a door leaf does not open:"}
        code, detail = faults[0]
        width = 2 * settings.robot.radius
        raise UnsoundError(
            f"the plan cannot be built: {what.get(code, code)} {detail}", f"doors and rooms must let a robot {width:.2f} m wide pass"
        )
