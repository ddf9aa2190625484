"""The furniture library whole: what it costs to make and to write, and every joint of it swept through its range.

    python benchmarks/library.py [seed]

Prints CPU seconds, triangles and convex pieces; counts pieces that are open or not convex, and models whose parts enter each other.
Exits with 1 when there is one.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.furniture.solids import Solid
from pipeline.corpus.future_writer import write_future
from pipeline.corpus.partnet_writer import write_partnet

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "corpus" / "furniture"))
from sweep import STEPS, collisions  # noqa: E402 - the tests' own check, over all models instead of one a form

FLAT = 3e-4  # how far a point may lie outside a face's plane [m]


def main(seed: int) -> int:
    """Make, write and sweep; return 1 when something is wrong."""
    start = time.process_time()
    library = catalogue(seed)
    shapes = [shape_of(model) for model in (*library.future, *library.partnet)]
    made = time.process_time() - start
    with tempfile.TemporaryDirectory() as place:
        start = time.process_time()
        write_future(library.future, Path(place) / "future")
        static = time.process_time() - start
        start = time.process_time()
        write_partnet(library.partnet, Path(place) / "partnet")
        opening = time.process_time() - start
        size = sum(p.stat().st_size for p in Path(place).rglob("*") if p.is_file()) / 1e6
    print(
        f"{len(library.future)} + {len(library.partnet)} models: {made:.1f} CPU s to make, {static:.1f} + {opening:.1f} to write, {size:.0f} MB"
    )
    triangles = [sum(len(p.solid.triangles()) for p in shape.pieces()) for shape in shapes]
    print(f"triangles of a model: median {np.median(triangles):.0f}, most {max(triangles)}")
    solids = [p.solid for shape in shapes for p in shape.pieces()]
    leaky, bent = sum(map(leaks, solids)), sum(map(bends, solids))
    start = time.process_time()
    swept = [shape for model, shape in zip((*library.future, *library.partnet), shapes, strict=True) if model.partnet_category]
    met = sum(next(collisions(shape), None) is not None for shape in swept)
    joints = sum(len(shape.movers) for shape in swept)
    print(f"{len(solids)} pieces: {leaky} open, {bent} not convex")
    print(f"{joints} joints in {STEPS} positions: parts of {met} models enter each other; {time.process_time() - start:.0f} CPU s")
    return int(bool(leaky or bent or met))


def leaks(solid: Solid) -> bool:
    """Whether an edge of the solid has not exactly one face on each side."""
    faces: NDArray[np.int64] = solid.triangles().astype(np.int64)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    count = len(solid.vertices)
    return not np.array_equal(np.sort(start * count + end), np.sort(end * count + start))


def bends(solid: Solid) -> bool:
    """Whether a vertex lies outside the plane of a face."""
    v, faces = solid.vertices, solid.triangles()
    a, b, c = (v[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-15)
    return bool((v @ normals.T - np.einsum("ij,ij->i", a, normals)).max() > FLAT)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 0))
