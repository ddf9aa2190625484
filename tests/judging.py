"""The judge's settings as params.yaml has them, and the arranger's view of a room with the robot that homes are made for."""

from dataclasses import replace
from pathlib import Path

from pipeline import params
from pipeline.arrange import Site
from pipeline.homes.room_finishing import MARGIN
from pipeline.verify import VerifySettings

SETTINGS = params.section(VerifySettings, params.read(Path(__file__).parents[1] / "params.yaml"), "verify")


def site(plan, room_id="room", **changes):
    """`changes` are those of the arranger's robot."""
    robot = replace(SETTINGS.robot, radius=SETTINGS.robot.radius + MARGIN)
    return Site.of(plan, room_id, replace(robot, **changes), SETTINGS.cell)
