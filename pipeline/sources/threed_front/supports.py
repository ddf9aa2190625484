"""What stands on or in what: from the boxes of a room's objects, for scene files say nothing of it."""

from collections.abc import Sequence

import numpy as np
import shapely

from pipeline.sources.threed_front.furniture import Placed
from pipeline.taxonomy import Taxonomy

ON = 0.03  # [m] what starts within this height of another's top stands on it
RAISED = 0.003  # [m] what starts no higher stands on the floor
LEAST = 0.7  # share of a thing's footprint that must be over its support's


def supports(objects: Sequence[Placed], taxonomy: Taxonomy) -> list[int]:
    """Return for each object of a room the index of what it stands on or in, -1 for the floor, a wall, the ceiling.

    A thing stands on the highest box whose top it starts at; else it is in the smallest box around its foot.
    """
    bearers = [-1] * len(objects)
    shapes = np.array([o.footprint() for o in objects])
    raised = [i for i, o in enumerate(objects) if o.span[0] > RAISED and taxonomy.categories[o.category].mount != "ceiling"]
    if not raised:
        return bearers
    areas = shapely.area(shapes)
    for i in raised:
        z = objects[i].span[0]
        over = shapely.area(shapely.intersection(shapes[i], shapes)) >= LEAST * areas[i]
        below = [
            j
            for j in np.flatnonzero(over).tolist()
            if j != i and objects[j].span[0] < z - RAISED / 2 and z <= objects[j].span[1] + ON and areas[j] > areas[i]
        ]
        on = [j for j in below if z >= objects[j].span[1] - ON]
        if on:
            bearers[i] = max(on, key=lambda j: objects[j].span[1])
        elif below:
            bearers[i] = min(below, key=lambda j: areas[j] * (objects[j].span[1] - objects[j].span[0]))
    return bearers


def hangs_in_air(piece: Placed, support: int, taxonomy: Taxonomy) -> bool:
    """Whether a small thing hangs in the air: its support was left out."""
    category = taxonomy.categories[piece.category]
    return not category.layout and category.mount == "floor" and support < 0 and piece.span[0] > ON
