"""The robot for which floors must be walkable and handles in reach: an upright cylinder."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Robot:
    """Section `verify.robot` of params.yaml, the only place of these numbers: readers, arranger and judge are handed them."""

    radius: float  # [m]
    height: float  # [m]
    step: float  # it drives over what is lower [m]
    reach: tuple[float, float]  # distance in plan from its axis to a handle [m]
    cone: float  # it stands within this angle of the way in which the handle sets off [deg]

    def band(self, floor: float) -> tuple[float, float]:
        """Return between which heights (low, high) [m, world] things are in its way on a floor at that height [m]."""
        return floor + self.step, floor + self.height
