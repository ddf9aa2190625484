"""Objects as PartNet-Mobility has them: parts drawn from both sides with holes in them, no metric size, some drawn open.

Real files cannot be put here; these are made in the same way: textured_objs/original-N.obj, mobility.urdf, mobility_v2.json,
semantics.txt, meta.json, bounding_box.json, result.json. Built in metres in the mesh frame (x right, y up, z front), then
centred and scaled to a diagonal of about 2, as real ones are.
"""

import json
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

BASE = "1.570796326794897 0 -1.570796326794897"


@dataclass
class Moving:
    """A link: its meshes, and the joint that moves it; `at` is how far from closed it is drawn."""

    word: str
    meshes: list
    kind: str = ""
    axis: tuple = (0, 1, 0)
    origin: tuple = (0, 0, 0)
    limits: tuple = (0.0, 1.0)
    at: float = 0.0
    parts: list = field(default_factory=list)


def board(low, high, n=4, bevel=0.003):
    """A box with rounded edges, each side a grid of n x n quads."""
    low, high = np.minimum(low, high).astype(float), np.maximum(low, high).astype(float)
    r = min(bevel, (high - low).min() / 3)
    u = np.linspace(-1, 1, n + 1)
    vertices, faces = [], []
    for axis in range(3):
        for sign in (-1, 1):
            a, b = np.meshgrid(u, u, indexing="ij")
            points = np.stack([np.full(a.size, float(sign)), a.ravel() * (1 if sign > 0 else -1), b.ravel()], axis=1)
            points = np.roll(points, axis, axis=1)
            quad = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
            p, q, s, t = quad[:-1, :-1].ravel(), quad[1:, :-1].ravel(), quad[1:, 1:].ravel(), quad[:-1, 1:].ravel()
            faces += [np.stack([p, q, s], 1) + len(vertices) * (n + 1) ** 2, np.stack([p, s, t], 1) + len(vertices) * (n + 1) ** 2]
            vertices.append(points)
    cube = np.concatenate(vertices)
    half = (high - low) / 2
    inner = np.clip(cube * half, -(half - r), half - r)
    away = cube * half - inner
    length = np.linalg.norm(away, axis=1, keepdims=True)
    return (low + high) / 2 + inner + away / np.maximum(length, 1e-12) * np.minimum(length, r), np.concatenate(faces)


def sheet(corner, u, v, n=4):
    """A flat sheet without thickness."""
    a, b = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), indexing="ij")
    points = np.array(corner, float) + a.ravel()[:, None] * np.array(u, float) + b.ravel()[:, None] * np.array(v, float)
    quad = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    p, q, s, t = quad[:-1, :-1].ravel(), quad[1:, :-1].ravel(), quad[1:, 1:].ravel(), quad[:-1, 1:].ravel()
    return points, np.concatenate([np.stack([p, q, s], 1), np.stack([p, s, t], 1)])


def joined(meshes):
    start = np.cumsum([0, *(len(v) for v, _ in meshes)])
    return np.concatenate([v for v, _ in meshes]), np.concatenate([f + k for (_, f), k in zip(meshes, start, strict=False)])


def tray(low, high, n=3):
    """An open box of five sheets as one mesh: a drawer or basin as drawn."""
    (x, y, z), (X, Y, Z) = low, high
    sides = [((x, y, z), (X - x, 0, 0), (0, 0, Z - z)), ((x, y, z), (0, Y - y, 0), (0, 0, Z - z)), ((X, y, z), (0, Y - y, 0), (0, 0, Z - z)),
             ((x, y, z), (X - x, 0, 0), (0, Y - y, 0)), ((x, y, Z), (X - x, 0, 0), (0, Y - y, 0))]  # fmt: skip
    return joined([sheet(*s, n) for s in sides])


def lathe(profile, sections=32, at=(0, 0, 0)):
    """A surface of revolution about y; `profile` is (radius, height) pairs."""
    turn = np.arange(sections) * (2 * np.pi / sections)
    rings = [np.stack([r * np.cos(turn), np.full(sections, y), r * np.sin(turn)], axis=1) for r, y in profile]
    quad = np.arange(len(rings) * sections).reshape(len(rings), sections)
    p, q = quad[:-1], quad[1:]
    s, t = np.roll(q, -1, axis=1), np.roll(p, -1, axis=1)
    faces = [np.stack([p.ravel(), q.ravel(), s.ravel()], 1), np.stack([p.ravel(), s.ravel(), t.ravel()], 1)]
    return np.concatenate(rings) + np.array(at, float), np.concatenate(faces)


def tube(path, radius, sections=10):
    """A bar along a polyline, open at its ends."""
    path = np.array(path, float)
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    up = np.array([0.3, 0.9, 0.2])
    turn = np.arange(sections) * (2 * np.pi / sections)
    rings = []
    for point, way in zip(path, along, strict=True):
        side = np.cross(way, up)
        side /= np.linalg.norm(side)
        rings.append(point + radius * (np.cos(turn)[:, None] * side + np.sin(turn)[:, None] * np.cross(way, side)))
    quad = np.arange(len(path) * sections).reshape(len(path), sections)
    p, q = quad[:-1], quad[1:]
    s, t = np.roll(q, -1, axis=1), np.roll(p, -1, axis=1)
    return np.concatenate(rings), np.concatenate(
        [np.stack([p.ravel(), q.ravel(), s.ravel()], 1), np.stack([p.ravel(), s.ravel(), t.ravel()], 1)]
    )


def handle(a, b, out, n=12):
    """A bow between two points that stands out by `out` (3,)."""
    t = np.linspace(0, 1, n)[:, None]
    a, b = np.array(a, float), np.array(b, float)
    return tube(a + (b - a) * t + np.sin(np.pi * t) ** 0.4 * np.array(out, float), 0.006)


def dirty(mesh, rng):
    """A mesh as exporters leave it: some faces missing, many drawn from both sides, vertices of half of them not shared."""
    v, f = mesh
    f = f[rng.random(len(f)) > 0.01] if len(f) > 60 else f
    f = np.concatenate([f, f[rng.random(len(f)) < 0.6][:, ::-1]])
    own = rng.random(len(f)) < 0.5
    loose = f[own]
    extra = v[loose.ravel()]
    return np.concatenate([v, extra]), np.concatenate([f[~own], (len(v) + np.arange(loose.size)).reshape(-1, 3)])


def cabinet(rng, n=4, w=1.0, h=1.2, d=0.5, drawers=3, doors=2):
    t = 0.02
    body = [board((-w / 2, 0, -d / 2), (-w / 2 + t, h, d / 2), n), board((w / 2 - t, 0, -d / 2), (w / 2, h, d / 2), n),
            board((-w / 2, 0, -d / 2), (w / 2, t, d / 2), n), board((-w / 2, h - t, -d / 2), (w / 2, h, d / 2), n),
            sheet((-w / 2, 0, -d / 2), (w, 0, 0), (0, h, 0), n)]  # fmt: skip
    links = [Moving("furniture_body", body)]
    top = h - t
    for k in range(drawers):
        y = top - (k + 1) * 0.18
        box = tray((-w / 2 + 0.03, y + 0.02, -d / 2 + 0.04), (w / 2 - 0.03, y + 0.14, d / 2 - 0.01), n)
        front = board((-w / 2 + t, y + 0.005, d / 2), (w / 2 - t, y + 0.175, d / 2 + t), n)
        bow = handle((-0.08, y + 0.09, d / 2 + t), (0.08, y + 0.09, d / 2 + t), (0, 0, 0.04), 4 + 2 * n)
        links.append(Moving("drawer", [box, front, bow], "slider", (0, 0, 1), (0, 0, 0), (0.0, 0.35)))
    below = top - drawers * 0.18
    for k in range(doors):
        x = -w / 2 + t + k * (w - 2 * t) / doors
        leaf = board((x, t, d / 2), (x + (w - 2 * t) / doors - 0.002, below, d / 2 + t), n)
        right = k % 2
        grip = x + (0.04 if right else (w - 2 * t) / doors - 0.04)
        bow = handle((grip, below / 2 - 0.06, d / 2 + t), (grip, below / 2 + 0.06, d / 2 + t), (0, 0, 0.04), 4 + 2 * n)
        edge = (x + (w - 2 * t) / doors if right else x, 0, d / 2)
        links.append(Moving("rotation_door", [leaf, bow], "hinge", (0, 1 if right else -1, 0), edge, (0.0, 1.57)))
    return links


def laptop(rng, n=4, at=1.9, closes=True):
    base = [board((-0.165, 0, -0.115), (0.165, 0.012, 0.115), n)]
    keys = [
        board((-0.15 + 0.022 * i, 0.0125, -0.07 + 0.02 * j), (-0.132 + 0.022 * i, 0.0145, -0.054 + 0.02 * j), 1, 0)
        for i in range(14)
        for j in range(5)
    ]
    screen = board((-0.165, 0.0125, -0.115), (0.165, 0.0185, 0.115), n)
    return [
        Moving("base_body", base + keys),
        Moving("rotation_screen", [screen], "hinge", (-1, 0, 0), (0, 0.0125, -0.115), (0.0 if closes else 1.2, 2.3), at),
    ]


def toaster(rng, n=4):
    body = [board((-0.08, 0, -0.15), (0.08, 0.19, 0.15), n, 0.03)]
    lever = board((-0.012, 0.11, 0.15), (0.012, 0.125, 0.175), n)
    knob = lathe([(0.0, 0.0), (0.015, 0.0), (0.015, 0.01), (0.0, 0.01)], 24)
    knob = (knob[0][:, [0, 2, 1]] + (0.03, 0.05, 0.15), knob[1])
    return [
        Moving("toaster_body", body),
        Moving("slider", [lever], "slider", (0, -1, 0), (0, 0, 0), (0.0, 0.06)),
        Moving("knob", [knob], "hinge", (0, 0, 1), (0.03, 0.05, 0.15), (0.0, 3.0)),
    ]


def suitcase(rng, n=4, pulled=0.4):
    body = [board((-0.2, 0.03, -0.11), (0.2, 0.58, 0.11), n, 0.04)] + [
        lathe([(0, 0), (0.025, 0), (0.025, 0.02), (0, 0.02)], 20, (x, 0.0, z)) for x in (-0.17, 0.17) for z in (-0.08, 0.08)
    ]
    bar = [tube([(x, 0.3, -0.08), (x, 0.6, -0.08)], 0.008) for x in (-0.09, 0.09)] + [
        tube([(-0.09, 0.6, -0.08), (0, 0.605, -0.08), (0.09, 0.6, -0.08)], 0.012)
    ]
    return [Moving("suitcase_body", body), Moving("handle", bar, "slider", (0, 1, 0), (0, 0, 0), (0.0, 0.45), pulled)]


def door(rng, n=4, frame=0.05):
    jambs = [
        board((-0.5, 0, -frame / 2), (-0.46, 2.05, frame / 2), n),
        board((0.46, 0, -frame / 2), (0.5, 2.05, frame / 2), n),
        board((-0.5, 2.02, -frame / 2), (0.5, 2.05, frame / 2), n),
    ]
    leaf = [board((-0.455, 0.005, -0.02), (0.455, 2.015, 0.02), n), handle((0.4, 1.0, 0.02), (0.3, 1.0, 0.02), (0, 0, 0.05), 4 + 2 * n)]
    return [Moving("door_frame", jambs), Moving("rotation_door", leaf, "hinge", (0, -1, 0), (-0.455, 0, 0.02), (0.0, 1.6))]


def coffee_machine(rng, n=4):
    body = [
        board((-0.16, 0, -0.12), (0.16, 0.03, 0.14), n),
        board((-0.16, 0, -0.14), (0.16, 0.26, -0.03), n),
        board((-0.16, 0.2, -0.14), (0.16, 0.26, 0.14), n),
    ]
    jug = lathe([(0.0, 0.032), (0.055, 0.032), (0.065, 0.08), (0.05, 0.14), (0.052, 0.14), (0.067, 0.08), (0.057, 0.034)], 8 * n)
    buttons = [
        Moving(
            "button",
            [board((-0.12 + 0.05 * k, 0.22, 0.14), (-0.10 + 0.05 * k, 0.24, 0.145), 2)],
            "slider",
            (0, 0, -1),
            (0, 0, 0),
            (0.0, 0.004),
        )
        for k in range(5)
    ]
    return [Moving("coffee_machine_body", [*body, jug]), *buttons]


def bucket(rng, n=4, height=0.4, up=True):
    wall = lathe([(0.0, 0.0), (0.11, 0.0), (0.15, height), (0.155, height), (0.113, -0.003), (0.0, -0.003)], 8 * n)
    t = np.linspace(0, np.pi, 4 * n + 3)
    bail = tube(np.stack([0.155 * np.cos(t), height + 0.16 * np.sin(t), 0 * t], 1), 0.004, 6)
    return [Moving("bucket_body", [wall]), Moving("handle", [bail], "hinge", (1, 0, 0), (0, height, 0), (-1.57, 1.57), 0.0)]


def microwave(rng, n=4, w=0.62, h=0.27):
    body = [board((-w / 2, 0, -0.2), (w / 2, 0.02, 0.2), n), board((-w / 2, h - 0.02, -0.2), (w / 2, h, 0.2), n), board((-w / 2, 0, -0.2), (-w / 2 + 0.02, h, 0.2), n),
            board((w / 2 - 0.14, 0, -0.2), (w / 2, h, 0.2), n), sheet((-w / 2, 0, -0.2), (w, 0, 0), (0, h, 0), n), lathe([(0.0, 0.025), (0.14, 0.025), (0.14, 0.03), (0, 0.03)], 8 * n)]  # fmt: skip
    leaf = [
        board((-w / 2, 0.005, 0.2), (w / 2 - 0.142, h - 0.005, 0.225), n),
        handle((w / 2 - 0.17, 0.06, 0.225), (w / 2 - 0.17, h - 0.06, 0.225), (0, 0, 0.03), 4 + 2 * n),
    ]
    return [Moving("microwave_body", body), Moving("door", leaf, "hinge", (0, -1, 0), (-w / 2, 0, 0.2), (0.0, 1.6))]


def remote(rng, n=4, rows=12):
    body = [board((-0.024, 0, -0.009), (0.024, 0.18, 0.009), n, 0.006)]
    keys = [
        Moving(
            "button",
            [board((-0.018 + 0.013 * i, 0.015 + 0.013 * j, 0.009), (-0.008 + 0.013 * i, 0.023 + 0.013 * j, 0.0115), max(1, n // 2))],
            "slider",
            (0, 0, -1),
            (0, 0, 0),
            (0.0, 0.001),
        )
        for i in range(3)
        for j in range(rows)
    ]
    return [Moving("remote_body", body), *keys]


def keyboard(rng, n=1, columns=36, rows=18):
    """649 parts: a base and 648 keys."""
    base = board((-0.22, 0, -0.08), (0.22, 0.015, 0.08), 4)
    keys = [
        board((-0.21 + 0.0117 * i, 0.012, -0.075 + 0.0083 * j), (-0.2 + 0.0117 * i, 0.022, -0.0685 + 0.0083 * j), n, 0.001)
        for i in range(columns)
        for j in range(rows)
    ]
    return [
        Moving("keyboard_body", [base, *keys[3:]]),
        *(Moving("key", [k], "slider", (0, -1, 0), (0, 0, 0), (0.0, 0.002)) for k in keys[:3]),
    ]


def dishwasher(rng, n=4):
    body = [
        tray((-0.29, 0.03, -0.28), (0.29, 0.8, 0.26), n),
        board((-0.3, 0, -0.29), (-0.29, 0.85, 0.27), n),
        board((0.29, 0, -0.29), (0.3, 0.85, 0.27), n),
        board((-0.3, 0.82, -0.29), (0.3, 0.85, 0.27), n),
        board((-0.3, 0, -0.29), (0.3, 0.03, 0.27), n),
    ]
    wires = [
        tube([(-0.27 + 0.045 * k, 0.2, -0.25), (-0.27 + 0.045 * k, 0.18, 0), (-0.27 + 0.045 * k, 0.2, 0.24)], 0.003, 6) for k in range(13)
    ]
    wires += [
        tube([(-0.27, 0.2 + 0.05 * j, z), (0, 0.2 + 0.05 * j, z), (0.27, 0.2 + 0.05 * j, z)], 0.003, 6)
        for z in np.linspace(-0.25, 0.24, 8)
        for j in (0, 1, 2)
    ]
    front = [board((-0.3, 0.08, 0.27), (0.3, 0.82, 0.3), n), handle((-0.15, 0.78, 0.3), (0.15, 0.78, 0.3), (0, 0, 0.04), 4 + 2 * n)]
    return [
        Moving("dishwasher_body", body),
        Moving("rotation_door", front, "hinge", (1, 0, 0), (0, 0.08, 0.27), (0.0, 1.5)),
        Moving("rack", wires, "slider", (0, 0, 1), (0, 0, 0), (0.0, 0.4)),
    ]


def pot(rng, n=4):
    wall = lathe([(0.0, 0.0), (0.12, 0.0), (0.125, 0.14), (0.13, 0.14), (0.124, -0.003), (0.0, -0.003)], 8 * n)
    ears = [handle((s * 0.125, 0.11, -0.04), (s * 0.125, 0.11, 0.04), (s * 0.04, 0, 0), 4 + 2 * n) for s in (-1, 1)]
    cover = [
        lathe([(0.0, 0.17), (0.06, 0.165), (0.126, 0.142), (0.126, 0.14), (0.06, 0.162), (0.0, 0.167)], 8 * n),
        lathe([(0.0, 0.2), (0.018, 0.195), (0.012, 0.17)], 16),
    ]
    return [Moving("pot_body", [wall, *ears]), Moving("lid", cover, "slider", (0, 1, 0), (0, 0, 0), (0.0, 0.2))]


MAKERS = {
    "StorageFurniture": cabinet, "Laptop": laptop, "Toaster": toaster, "Suitcase": suitcase, "Door": door, "CoffeeMachine": coffee_machine, "Bucket": bucket,
    "Microwave": microwave, "Remote": remote, "Keyboard": keyboard, "Dishwasher": dishwasher, "KitchenPot": pot,
}  # fmt: skip


def turned(link):
    """Return a link's meshes as drawn: moved by `at` along its joint."""
    axis, origin = np.array(link.axis, float), np.array(link.origin, float)
    if link.kind == "slider":
        return [(v + axis * link.at, f) for v, f in link.meshes]
    K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    R = np.eye(3) + np.sin(link.at) * K + (1 - np.cos(link.at)) * K @ K
    return [((v - origin) @ R.T + origin, f) for v, f in link.meshes]


def write(root, name, category, links, seed=0, *, clean=False):
    """Write an object's folder; joints are 0 as drawn, so limits are relative to that."""
    rng = np.random.default_rng(seed)
    folder = Path(root) / name
    (folder / "textured_objs").mkdir(parents=True, exist_ok=True)
    drawn = [turned(link) for link in links]
    everything = np.concatenate([v for meshes in drawn for v, _ in meshes])
    low, high = everything.min(axis=0), everything.max(axis=0)
    middle, scale = (low + high) / 2, 2.0 / float(np.linalg.norm(high - low))
    number, texts, entries, words = 0, [], [], []
    for k, (link, meshes) in enumerate(zip(links, drawn, strict=True)):
        origin = (np.array(link.origin, float) - middle) * scale if link.kind else np.zeros(3)
        shapes = ""
        for mesh in meshes:
            v, f = mesh if clean else dirty(mesh, rng)
            lines = ["mtllib original.mtl", "usemtl plain", *(f"v {p[0]:.6f} {p[1]:.6f} {p[2]:.6f}" for p in (v - middle) * scale)]
            (folder / "textured_objs" / f"original-{number}.obj").write_text(
                "\n".join([*lines, *(f"f {t[0]} {t[1]} {t[2]}" for t in f + 1), ""])
            )
            for kind in ("visual", "collision"):
                shapes += f'<{kind} name="part-{number}"><origin xyz="{-origin[0]} {-origin[1]} {-origin[2]}"/><geometry><mesh filename="textured_objs/original-{number}.obj"/></geometry></{kind}>'
            number += 1
        texts.append(f'<link name="link_{k}">{shapes}</link>')
        data = {}
        if link.kind:
            unit = scale if link.kind == "slider" else 1.0
            lower, upper = (link.limits[0] - link.at) * unit, (link.limits[1] - link.at) * unit
            texts.append(
                f'<joint name="joint_{k}" type="{"prismatic" if link.kind == "slider" else "revolute"}"><origin xyz="{origin[0]} {origin[1]} {origin[2]}"/>'
                f'<axis xyz="{link.axis[0]} {link.axis[1]} {link.axis[2]}"/><child link="link_{k}"/><parent link="link_0"/><limit lower="{lower}" upper="{upper}"/></joint>'
            )
            turn = 180 / np.pi if link.kind == "hinge" else 1.0
            data = {
                "axis": {"origin": origin.tolist(), "direction": list(link.axis)},
                "limit": {"a": lower * turn, "b": upper * turn, "noLimit": False},
            }
        entries.append(
            {"id": k, "parent": 0 if k else -1, "joint": link.kind or "heavy", "name": link.word, "parts": [], "jointData": data}
        )
        words.append(f"link_{k} {link.kind or 'heavy'} {link.word}\n")
    root_joint = f'<joint name="joint_0" type="fixed"><origin rpy="{BASE}" xyz="0 0 0"/><child link="link_0"/><parent link="base"/></joint>'
    (folder / "mobility.urdf").write_text(
        f'<?xml version="1.0" ?><robot name="partnet_{name}"><link name="base"/>{"".join(texts)}{root_joint}</robot>'
    )
    (folder / "textured_objs" / "original.mtl").write_text("newmtl plain\nKd 0.6 0.6 0.6\n")
    (folder / "semantics.txt").write_text("".join(words))
    (folder / "mobility_v2.json").write_text(json.dumps(entries))
    (folder / "meta.json").write_text(
        json.dumps({"model_cat": category, "anno_id": name, "user_id": "1", "version": "1", "model_id": name})
    )
    (folder / "bounding_box.json").write_text(
        json.dumps({"min": ((low - middle) * scale).tolist(), "max": ((high - middle) * scale).tolist()})
    )
    (folder / "result.json").write_text(json.dumps([{"id": 0, "name": category.lower(), "children": []}]))
    return folder
