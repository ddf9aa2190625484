import numpy as np
import pytest

from pipeline.corpus.furniture import solids
from pipeline.corpus.furniture.solids import Solid

UNIT = ((0.0, 1.0), (0.0, 2.0), (0.0, 0.5))

MADE = {
    "box": [solids.box(*UNIT)],
    "bevelled": [solids.box(*UNIT, 0.02)],
    "cushion": [solids.cushion(*UNIT, 0.1, 3)],
    "slab": [solids.slab(solids.rounded_rectangle((0, 1), (0, 2), 0.2), (0, 0.1), 0.01)],
    "rod": [solids.rod((0, 0, 0), (1, 2, 3), 0.1, 0.05)],
    "beam": [solids.beam((0, 0, 0), (0.2, 0.1, 1), 0.05, 0.04, 0.6)],
    "vase": solids.revolve([(0.2, 0), (0.3, 0.1), (0.1, 0.3), (0.1, 0.5), (0.25, 0.6)]),
    "ring": solids.ring((0.5, 0.4), (0.45, 0.35), (0, 0.3), squash=0.7),
    "hull": [solids.hull(np.random.default_rng(3).normal(size=(20, 3)))],
    "mirrored": [solids.beam((0, 0, 0), (0.2, 0.1, 1), 0.05, 0.04).mirror()],
    "turned": [solids.box(*UNIT, 0.02).rotate("y", 0.7, (1, 2, 3))],
}


def volume(solid: Solid) -> float:
    a, b, c = (solid.vertices[solid.triangles()[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def unshared_edges(solid: Solid) -> int:
    edges = [(a, b) for f in solid.faces for a, b in zip(f, (*f[1:], f[0]), strict=True)]
    return len(edges) - len(set(edges)) + sum((b, a) not in set(edges) for a, b in edges)


def bulge(solid: Solid) -> float:
    """How far a vertex lies outside the plane of any face [m]."""
    tri = solid.triangles()
    a, b, c = (solid.vertices[tri[:, k]] for k in range(3))
    n = np.cross(b - a, c - a)
    length = np.linalg.norm(n, axis=1)
    keep = length > 1e-12
    n = n[keep] / length[keep, None]
    return float((solid.vertices @ n.T - np.einsum("ij,ij->i", a[keep], n)).max())


@pytest.mark.parametrize("name", MADE)
def test_solids_are_closed_convex_and_turned_outwards(name):
    for solid in MADE[name]:
        assert unshared_edges(solid) == 0
        assert volume(solid) > 0
        assert bulge(solid) < 1e-9


def test_boxes_span_their_intervals():
    for made in (MADE["box"][0], MADE["bevelled"][0], MADE["cushion"][0]):
        assert np.allclose(made.bounds(), np.array(UNIT).T)


def test_volumes():
    assert volume(MADE["box"][0]) == pytest.approx(1.0)
    assert volume(solids.rod((0, 0, 0), (0, 0, 2), 0.1, n=256)) == pytest.approx(np.pi * 0.01 * 2, rel=1e-3)
    full = sum(volume(s) for s in solids.ring((0.5, 0.5), (0.3, 0.3), (0, 1), 128))
    assert full == pytest.approx(np.pi * (0.25 - 0.09), rel=1e-3)
    assert 0.9 < volume(MADE["cushion"][0]) < volume(MADE["bevelled"][0]) < 1.0


def test_turning_keeps_volume_and_distance():
    solid = MADE["bevelled"][0]
    assert volume(solid.rotate("x", 1.1)) == pytest.approx(volume(solid))
    assert np.allclose(solid.rotate("z", np.pi / 2).vertices[:, 0], -solid.vertices[:, 1])
