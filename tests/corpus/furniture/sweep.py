"""The sweep of the articulated library: each joint through its range, every pair of convex pieces told apart exactly."""

from functools import cache

import numpy as np

from pipeline.corpus.furniture.shape import Mover, Shape, colliders

TOUCH = 5e-4  # how much two pieces may overlap [m]
STEPS = 13


def transform(mover: Mover, q):
    T = np.eye(4)
    if mover.type == "prismatic":
        T[:3, 3] = q * np.array(mover.axis)
        return T
    x, y, z = mover.axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T[:3, :3] = np.eye(3) + np.sin(q) * K + (1 - np.cos(q)) * K @ K
    T[:3, 3] = np.array(mover.origin) - T[:3, :3] @ np.array(mover.origin)
    return T


def poses(shape: Shape, positions):
    """Transforms of all bodies, the base first, with movers at `positions` {name: q}."""
    T = {"base": np.eye(4)}
    for mover in shape.movers:
        T[mover.name] = T[mover.parent] @ transform(mover, positions.get(mover.name, 0.0))
    return T


def unique_directions(vectors):
    length = np.linalg.norm(vectors, axis=1)
    a = vectors[length > 1e-9] / length[length > 1e-9, None]
    sign = np.sign(a[np.arange(len(a)), np.argmax(np.abs(a) > 1e-6, axis=1)])
    return np.unique(np.round(a * sign[:, None], 4), axis=0)


def directions(solid):
    """Distinct face normals and edge directions of a convex solid."""
    tri = solid.vertices[solid.triangles()]
    normals = np.cross(tri[:, 1] - tri[:, 0], tri[:, 2] - tri[:, 0])
    edges = np.concatenate([np.roll(solid.vertices[list(f)], -1, axis=0) - solid.vertices[list(f)] for f in solid.faces])
    return unique_directions(normals), unique_directions(edges)


def apart(a, b, axes, limit):
    """Whether convex point sets enter each other by no more than `limit` along one of the axes."""
    pa, pb = a @ axes.T, b @ axes.T
    return bool((np.minimum(pa.max(0), pb.max(0)) - np.maximum(pa.min(0), pb.min(0))).min() <= limit)


def collisions(shape: Shape, steps=STEPS):
    """Move each joint through its range, those it waits for open, the others closed; yield (mover, other) that meet."""
    bodies = [("base", s) for s in colliders(shape.base)] + [(m.name, s) for m in shape.movers for s in colliders(m.pieces)]
    owner = np.array([name for name, _ in bodies])
    axes_of = cache(lambda k: directions(bodies[k][1]))
    upper = {m.name: m.upper for m in shape.movers}
    hangs = {m.name: {m.name} for m in shape.movers}
    for m in reversed(shape.movers):
        if m.parent != "base":
            hangs[m.parent] |= hangs[m.name]
    for mover in shape.movers:
        moving = np.isin(owner, sorted(hangs[mover.name]))
        for q in np.linspace(0.0, mover.upper, steps):
            T = poses(shape, {name: upper[name] for name in mover.after} | {mover.name: q})
            points = [s.vertices @ T[name][:3, :3].T + T[name][:3, 3] for name, s in bodies]
            low, high = np.array([p.min(0) for p in points]) + TOUCH, np.array([p.max(0) for p in points])
            for i in np.flatnonzero(moving):
                for k in np.flatnonzero(~moving & (low < high[i]).all(1) & (high > low[i]).all(1)):
                    (normals_i, edges_i), (normals_k, edges_k) = axes_of(i), axes_of(k)
                    turn_i, turn_k = T[owner[i]][:3, :3].T, T[owner[k]][:3, :3].T
                    faces = np.concatenate([normals_i @ turn_i, normals_k @ turn_k])
                    if apart(points[i], points[k], faces, TOUCH):
                        continue
                    crossed = np.cross((edges_i @ turn_i)[:, None], (edges_k @ turn_k)[None]).reshape(-1, 3)
                    length = np.linalg.norm(crossed, axis=1)
                    crossed = crossed[length > 1e-6] / length[length > 1e-6, None]
                    if not len(crossed) or not apart(points[i], points[k], crossed, TOUCH):
                        yield mover.name, str(owner[k]), round(float(q), 3)
