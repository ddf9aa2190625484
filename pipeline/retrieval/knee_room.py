"""Can one sit at a desk whose drawers all open? A seat goes below what opens, beside it, or stands close behind it when it is drawn out."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SAT_AT = ("desk", "dressing_table", "dining_table")  # categories at which people sit
SEAT = 0.55  # width of a seat, and of who sits on it [m]
KNEES = 0.5  # what opens above this is above the seat [m]
CLOSE = 0.4  # a seat behind what reaches no farther before the front is still at the desk [m]


def has_knee_room(size: Floats, sweeps: Floats) -> bool:
    """Tell whether a table of this size (3,) leaves a place for a seat at its front; `sweeps` (K, 2, 3) are the boxes through which its parts move [m]."""
    half, front = float(size[0]) / 2, -float(size[1]) / 2
    low, high = sweeps[:, 0], sweeps[:, 1]
    blocks = (low[:, 2] < KNEES) & (front - low[:, 1] > CLOSE)
    place = -half
    for box in np.argsort(low[blocks, 0], kind="stable"):
        if low[blocks][box, 0] - place >= SEAT:
            return True
        place = max(place, float(high[blocks][box, 0]))
    return not blocks.any() or half - place >= SEAT
