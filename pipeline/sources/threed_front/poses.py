"""Poses and boxes of 3D-FRONT's furniture in our world frame.

File frame (y up, front +z) to ours (z up, front -y): (x, y, z) -> (x, -z, y). A yaw about the file's +y is the same
yaw about our +z, for the change of frame is a rotation.
"""

import math
from dataclasses import dataclass

import numpy as np

from pipeline.arrays import Floats


@dataclass(frozen=True, slots=True)
class Box:
    """Bounds of a model in its own file frame [file units], and the factor `unit` to metres."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    unit: float = 1.0


@dataclass(frozen=True, slots=True)
class Pose:
    """`position` (3,) of the box's bottom centre [m, world], `yaw` [rad], `size` (w, d, h) [m], whether mirrored."""

    position: Floats
    yaw: float
    size: Floats
    mirrored: bool


def to_ours(points: Floats) -> Floats:
    """Map points (..., 3) of the file frame (y up) to ours (z up)."""
    return np.stack([points[..., 0], -points[..., 2], points[..., 1]], axis=-1)


def yaw_and_tilt(rotation: Floats) -> tuple[float, float]:
    """Return yaw [rad] about the vertical and the tilt of the vertical [rad] of a quaternion (x, y, z, w) of any norm.

    A quaternion of norm 0 is taken as no rotation.
    """
    norm = float(np.linalg.norm(rotation))
    x, y, z, w = (0.0, 0.0, 0.0, 1.0) if norm < 1e-9 else (float(v) / norm for v in rotation)
    tilt = math.acos(min(1.0, max(-1.0, 1 - 2 * (x * x + z * z))))
    return math.atan2(2 * (w * y + x * z), 1 - 2 * (x * x + y * y)), tilt


def place(box: Box, position: Floats, yaw: float, scale: Floats) -> Pose:
    """Return where the model's box ends up: v' = R(yaw) (scale . unit . v) + position, in the file's frame.

    A negative scale mirrors. Two negative plan axes are a half turn; one mirrors across the model's width once the
    half turn is taken out. `scale` y must be positive.
    """
    low, high = np.array(box.low) * box.unit, np.array(box.high) * box.unit
    middle = (low + high) / 2
    bottom = np.array([middle[0], low[1], middle[2]]) * scale
    c, s = math.cos(yaw), math.sin(yaw)
    turned = np.array([c * bottom[0] + s * bottom[2], bottom[1], -s * bottom[0] + c * bottom[2]])
    facing = yaw + (math.pi if scale[2] < 0 else 0.0)
    size = (high - low) * np.abs(scale)
    return Pose(to_ours(turned + position), wrap(facing), size[[0, 2, 1]], bool(scale[0] * scale[2] < 0))


def wrap(angle: float) -> float:
    """Return the angle in (-pi, pi], rounded to 1e-5 rad like the quaternions it comes from."""
    wrapped = round(math.remainder(angle, 2 * math.pi), 5)
    return 3.14159 if wrapped <= -3.14159 else wrapped + 0.0
