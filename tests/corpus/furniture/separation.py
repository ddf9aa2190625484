"""Penetration of convex solids by separating axes: the oracle of the sweep tests."""

from collections.abc import Iterator

import numpy as np

from pipeline.corpus.furniture.shape import Mover, Shape

TOLERANCE = 5e-4  # touching, and the rounding of facets, are no penetration [m]


def rotation(axis, angle):
    """Rodrigues' formula."""
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def posed(mover: Mover, vertices: np.ndarray, q: float) -> np.ndarray:
    """Vertices (V, 3) of a mover of the base at joint position q."""
    if mover.type == "prismatic":
        return vertices + q * np.array(mover.axis)
    origin = np.array(mover.origin)
    return (vertices - origin) @ rotation(mover.axis, q).T + origin


def directions(solid):
    """Distinct face normals and edge directions of a solid at rest."""
    v = solid.vertices
    normals, edges = [], []
    for face in solid.faces:
        p = v[list(face)]
        normals.append(sum(np.cross(p[i] - p[0], p[i + 1] - p[0]) for i in range(1, len(p) - 1)))
        edges += list(np.roll(p, -1, axis=0) - p)
    return _distinct(normals), _distinct(edges)


def _distinct(vectors):
    a = np.array(vectors)
    length = np.linalg.norm(a, axis=1)
    a = a[length > 1e-12] / length[length > 1e-12, None]
    sign = np.sign(a[np.arange(len(a)), np.argmax(np.abs(a) > 1e-6, axis=1)])
    return np.unique(np.round(a * sign[:, None], 4), axis=0)


def depth(a, axes_a, b, axes_b) -> float:
    """Penetration [m] of two convex point sets (0 or less: apart) over their normals and crossed edges."""
    (na, ea), (nb, eb) = axes_a, axes_b
    crossed = np.cross(ea[:, None], eb[None]).reshape(-1, 3)
    axes = np.concatenate([na, nb, crossed])
    length = np.linalg.norm(axes, axis=1)
    axes = axes[length > 1e-6] / length[length > 1e-6, None]
    pa, pb = a @ axes.T, b @ axes.T
    gap = np.maximum(pa.min(0) - pb.max(0), pb.min(0) - pa.max(0))
    return float(-gap.max())


def penetrations(shape: Shape, steps: int = 7) -> Iterator[tuple[tuple[str, str], str, float, float]]:
    """Move each joint through its range, the others at rest; yield (who, other, q, depth) of every penetration of a fixed part
    or of another mover that hangs on the base."""
    solids = [("base", p.name, p.solid) for p in shape.base]
    solids += [(m.name, p.name, p.solid) for m in shape.movers for p in m.pieces]
    low = np.array([s.vertices.min(0) for *_, s in solids])
    high = np.array([s.vertices.max(0) for *_, s in solids])
    found = {}
    for mover in shape.movers:
        positions = np.linspace(mover.lower, mover.upper, steps)
        others = np.array([owner != mover.name for owner, *_ in solids])
        for piece in mover.pieces:
            axes = None
            for q in positions:
                v = posed(mover, piece.solid.vertices, q)
                near = others & (low < v.max(0) - TOLERANCE).all(1) & (high > v.min(0) + TOLERANCE).all(1)
                for k in np.flatnonzero(near):
                    owner, name, other = solids[k]
                    if axes is None:
                        axes = directions(piece.solid)
                    turned = axes if mover.type == "prismatic" else tuple(x @ rotation(mover.axis, q).T for x in axes)
                    if k not in found:
                        found[k] = directions(other)
                    d = depth(v, turned, other.vertices, found[k])
                    if d > TOLERANCE:
                        yield (mover.name, piece.name), f"{owner}:{name}", float(q), d
