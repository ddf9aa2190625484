"""A small world of rooms with rules that are easy to see: beds at walls, nightstands beside, wardrobes, chairs at tables."""

import math
from dataclasses import replace

import numpy as np

from pipeline import seeds
from pipeline.diffusion.rooms import Example, context_of, example_of

CLASSES = ("double_bed", "nightstand", "wardrobe", "dining_table", "dining_chair", "pendant_lamp")
LAYOUTS = ("bedroom", "dining_room")
SIZES = {
    "double_bed": (1.8, 2.1, 1.1), "nightstand": (0.5, 0.42, 0.5), "wardrobe": (1.6, 0.6, 2.2),
    "dining_table": (1.5, 0.9, 0.75), "dining_chair": (0.5, 0.52, 0.85), "pendant_lamp": (0.5, 0.5, 0.5),
}  # fmt: skip


def room_rows(rng, number):
    """One room as table rows: (room, openings, objects)."""
    layout = LAYOUTS[number % 2]
    w, d = rng.uniform(3.4, 4.8, 2)
    polygon = [[0, 0], [w, 0], [w, d], [0, d]]
    room = {"scene_id": f"h{number}", "room_id": "r0", "layout_type": layout, "polygon": polygon, "level": 0, "height": 2.7}
    at = rng.uniform(0.1, 0.4)
    door = {
        "scene_id": f"h{number}", "kind": "door", "rooms": ["r0", "r1"], "segment": [[at, -0.06], [at + 0.85, -0.06]],
        "sill": 0.0, "swing_room": "r0", "swing_hinge": 0, "swing_angle": 1.5,
    }  # fmt: skip
    window = {
        **door,
        "kind": "window",
        "segment": [[w + 0.1, d / 2 - 0.5], [w + 0.1, d / 2 + 0.5]],
        "sill": 0.9,
        "swing_room": "",
        "swing_hinge": None,
    }
    placed = []

    def place(name, x, y, yaw, z=0.0):
        size = np.array(SIZES[name]) * rng.uniform(0.95, 1.05, 3)
        if yaw == 0.0:
            y = d - size[1] / 2 if y is None else y
        placed.append((name, (x, y, z), yaw, size))

    if layout == "bedroom":
        x = rng.uniform(1.6, w - 1.6)
        place("double_bed", x, None, 0.0)
        place("nightstand", x - 1.2, None, 0.0)
        if rng.random() < 0.6:
            place("nightstand", x + 1.2, None, 0.0)
        place("wardrobe", w - 1.0, 0.3, math.pi)
    else:
        x, y = w / 2 + rng.uniform(-0.2, 0.2), d / 2 + rng.uniform(-0.1, 0.3)
        place("dining_table", x, y, 0.0)
        for side in (-0.4, 0.4):
            place("dining_chair", x + side, y - 0.78, math.pi)
            place("dining_chair", x + side, y + 0.78, 0.0)
        place("pendant_lamp", x, y, 0.0, 1.8)
    objects = [
        {
            "scene_id": f"h{number}", "room_id": "r0", "category": n, "asset_id": n, "position": list(p), "size": s.tolist(),
            "yaw": yaw, "scale": [1.0, 1.0, 1.0], "openable": n in {"nightstand", "wardrobe"},
        }
        for n, p, yaw, s in placed
    ]  # fmt: skip
    return room, [door, window], objects


def shapes():
    """Latents and sweeps by asset."""
    rng = seeds.generator(0, "shapes")
    latents = {name: rng.normal(0, 1, 32).astype(np.float32) for name in CLASSES}
    sweeps = {}
    for name in ("nightstand", "wardrobe"):
        w, d, h = SIZES[name]
        sweeps[name] = np.array([[[-w / 2, -d / 2 - 0.3, 0.1], [w / 2, -d / 2, h]]], np.float32)
    return latents, sweeps


def make_examples(count, seed=0) -> list[Example]:
    latents, sweeps = shapes()
    found = []
    for number in range(count):
        room, openings, objects = room_rows(seeds.generator(seed, "room", number), number)
        layout = LAYOUTS.index(room["layout_type"])
        found.append(example_of(f"h{number}/r0", "train", layout, context_of(room, openings), objects, CLASSES, latents, sweeps))
    return found


def make_context(number, seed=1, n_target=None):
    room, openings, _ = room_rows(seeds.generator(seed, "room", number), number)
    return replace(context_of(room, openings), n_target=n_target)
