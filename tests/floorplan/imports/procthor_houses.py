"""ProcTHOR houses by code: rectangles cut from a rectangle, doors and frames up to as wide as their wall, empty walls, wide windows."""

import numpy as np

SIDES = (1.6, 2.2)  # [m] of a cell, as in the release
TYPES = ("LivingRoom", "Kitchen", "Bedroom", "Bathroom")
FRAMES = (0.98, 1.0, 2.0)  # [m] widths of the release's doors and door frames


def house(seed):
    """Return a house of 2 to 7 rooms."""
    rng = np.random.default_rng(seed)
    cell = float(rng.uniform(*SIDES))
    rects = [(0.0, 0.0, cell * int(rng.integers(3, 6)), cell * int(rng.integers(3, 5)))]
    for _ in range(int(rng.integers(1, 7))):
        x0, z0, x1, z1 = max(rects, key=lambda r: (r[2] - r[0]) * (r[3] - r[1]))
        cut = cell * max(1, round(max(x1 - x0, z1 - z0) / cell * rng.uniform(0.3, 0.7)))
        if cut >= max(x1 - x0, z1 - z0) - 1e-6:
            break
        rects.remove((x0, z0, x1, z1))
        rects += (
            [(x0, z0, x0 + cut, z1), (x0 + cut, z0, x1, z1)] if x1 - x0 >= z1 - z0 else [(x0, z0, x1, z0 + cut), (x0, z0 + cut, x1, z1)]
        )
    rooms = [
        {"id": f"room|{k + 2}", "roomType": TYPES[min(k, 3)] if k < 4 else "Bedroom",
         "floorPolygon": [{"x": x, "y": 0, "z": z} for x, z in ((x0, z0), (x0, z1), (x1, z1), (x1, z0))]}
        for k, (x0, z0, x1, z1) in enumerate(rects)
    ]  # fmt: skip
    walls, doors, windows = [], [], []
    joined = {0}
    while len(joined) < len(rects):
        a, b, low, high = next(
            (a, b, *line) for a in sorted(joined) for b in range(len(rects)) if b not in joined and (line := shared(rects[a], rects[b]))
        )
        joined.add(b)
        length = float(np.hypot(*np.subtract(high, low)))
        empty = bool({rooms[a]["roomType"], rooms[b]["roomType"]} == {"LivingRoom", "Kitchen"} and rng.random() < 0.3)
        pair = [wall(a, low, high, empty=empty), wall(b, high, low, empty=empty)]
        walls += pair
        if empty:
            continue
        wide = rng.random() < 0.4
        width = length if wide else float(min(rng.choice(FRAMES), length))
        start = 0.0 if wide else float(rng.uniform(0, length - width))
        frame = bool(wide or width > 1.5)
        doors.append({"id": f"door|{a}|{b}", "assetId": "Doorframe_1" if frame else "Doorway_1", "openable": not frame, "room0": f"room|{a + 2}",
                      "room1": f"room|{b + 2}", "wall0": pair[0]["id"], "wall1": pair[1]["id"], "holePolygon": hole(start, start + width, 0, 2.1)})  # fmt: skip
    x0, z0, x1, z1 = rects[0]
    widest, deepest = max(r[2] for r in rects), max(r[3] for r in rects)
    outer = [
        (((x0, z0), (x0, z1)), x0 == 0),
        (((x1, z1), (x1, z0)), x1 == widest),
        (((x0, z0), (x1, z0)), z0 == 0),
        (((x1, z1), (x0, z1)), z1 == deepest),
    ]
    out = wall(0, *next(ends for ends, there in outer if there))
    length = float(np.hypot(out["polygon"][1]["x"] - out["polygon"][0]["x"], out["polygon"][1]["z"] - out["polygon"][0]["z"]))
    walls.append(out)
    doors.append({"id": "door|1|2", "assetId": "Doorway_2", "openable": True, "room0": "room|2", "room1": "room|2", "wall0": out["id"],
                  "wall1": "wall|exterior", "holePolygon": hole(0.3, 1.28, 0, 2.1)})  # fmt: skip
    windows.append(
        {"id": "window|1", "room0": "room|2", "room1": "room|2", "wall0": out["id"], "holePolygon": hole(1.28, length, 0.8, 2.0)}
    )
    return {"rooms": rooms, "walls": walls, "doors": doors, "windows": windows}


def shared(a, b):
    """Return the line (low, high) that two rectangles share, None where it is shorter than a door."""
    for i in (0, 1):
        for at in {a[i], a[i + 2]} & {b[i], b[i + 2]}:
            low, high = max(a[1 - i], b[1 - i]), min(a[3 - i], b[3 - i])
            if high - low > 0.95:
                return ((at, low), (at, high)) if i == 0 else ((low, at), (high, at))
    return None


def wall(room, a, b, *, empty=False):
    (x0, z0), (x1, z1) = a, b
    points = [{"x": x0, "y": 0, "z": z0}, {"x": x1, "y": 0, "z": z1}, {"x": x1, "y": 2.8, "z": z1}, {"x": x0, "y": 2.8, "z": z0}]
    return {
        "id": f"wall|{room}|{x0:.2f}|{z0:.2f}|{x1:.2f}|{z1:.2f}",
        "roomId": f"room|{room + 2}",
        "polygon": points,
        **({"empty": True} if empty else {}),
    }


def hole(low, high, bottom, top):
    return [{"x": low, "y": bottom, "z": 0}, {"x": high, "y": top, "z": 0}]
