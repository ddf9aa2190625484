"""Furnished rooms whose relations are known: two nightstands at a bed of any size, and a plant that stands anywhere at the walls."""

import numpy as np

from pipeline.relations.arrangement import make_arrangement

SIZES = {"double_bed": (1.8, 2.1, 0.5), "nightstand": (0.45, 0.4, 0.5), "plant": (0.4, 0.4, 1.0), "tv_stand": (1.6, 0.4, 0.5)}


def bedroom(rng, *, turned=0.0):
    width, depth = rng.uniform(4, 6, 2)
    bed = np.array(SIZES["double_bed"]) * [rng.uniform(0.8, 1.2), 1, 1]
    stand = np.array(SIZES["nightstand"]) * rng.uniform(0.8, 1.2)
    x = rng.uniform(1.8, width - 1.8)
    things = [("double_bed", [x, depth - bed[1] / 2 - 0.02, 0], 0.0, bed)]
    for side in (-1, 1):
        off = bed[0] / 2 + rng.uniform(0.03, 0.08) + stand[0] / 2
        things.append(("nightstand", [x + side * off, depth - stand[1] / 2 - 0.02, 0], 0.0, stand))
    size = np.array(SIZES["tv_stand"]) * [rng.uniform(0.7, 1.3), 1, 1]
    things.append(("tv_stand", [x + rng.uniform(-0.1, 0.1), size[1] / 2 + 0.01, 0], np.pi, size))
    size = np.array(SIZES["plant"])
    side = rng.choice([-1, 1])
    plant_x = 0.22 if side < 0 else width - 0.22
    things.append(("plant", [plant_x, rng.uniform(0.3, depth - 0.3), 0], -side * np.pi / 2, size))
    polygon = np.array([[0, 0], [width, 0], [width, depth], [0, depth]])
    c, s = np.cos(turned), np.sin(turned)
    matrix = np.array([[c, s], [-s, c]])
    moved = [(k, [*(np.array(p[:2]) @ matrix), p[2]], y + turned, z) for k, p, y, z in things]
    return make_arrangement("room", "bedroom", polygon @ matrix, moved)


def bedrooms(rng, count):
    return [bedroom(rng, turned=rng.integers(4) * np.pi / 2) for _ in range(count)]
