"""Poses are rounded before anything is derived from them, so that the last bits of a sum never reach a dataset."""

import math
from dataclasses import replace

import numpy as np

from pipeline.entities.home import Placement


def round_placement(placement: Placement) -> Placement:
    """Round position and size to 0.1 mm, yaw to 1e-5 rad in (-pi, pi], scale to 1e-6."""
    yaw = round(math.remainder(placement.yaw, 2 * math.pi), 5)
    if yaw <= -3.14159:
        yaw = 3.14159
    # Adding 0.0 turns -0.0 into 0.0: equal numbers must be equal bytes.
    return replace(
        placement,
        position=np.round(placement.position, 4) + 0.0,
        yaw=yaw + 0.0,
        size=np.round(placement.size, 4),
        scale=np.round(placement.scale, 6),
        retrieval_distance=round(placement.retrieval_distance, 6),
    )
