"""Convex pieces of parts that are not convex, by CoACD; seconds per model, so cached by the content of the mesh."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from safetensors import SafetensorError
from safetensors.numpy import load_file, save

from pipeline.manifest import sha256, write_bytes

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
THRESHOLD = 0.05  # concavity that CoACD may leave, its own default
PIECES = 32


def decompose(vertices: Floats, faces: Ints, cache: Path) -> list[tuple[Floats, Ints]]:
    """Return convex pieces (vertices (V, 3), faces (F, 3)) of a mesh; `cache` is a folder of results by content hash."""
    used, index = np.unique(faces, return_inverse=True)
    points, triangles = np.ascontiguousarray(vertices[used]), np.ascontiguousarray(index.reshape(faces.shape), np.int64)
    settings = json.dumps([THRESHOLD, PIECES]).encode()
    path = cache / f"{sha256(settings + points.tobytes() + triangles.tobytes())}.safetensors"
    try:
        tensors = load_file(path)
    except (OSError, SafetensorError):  # not there yet, or half a file of a machine that died
        import coacd

        coacd.set_log_level("error")
        found = coacd.run_coacd(coacd.Mesh(points, triangles), threshold=THRESHOLD, max_convex_hull=PIECES, seed=0)
        tensors = {}
        for k, (v, f) in enumerate(found):
            tensors[f"{k:03d}.v"], tensors[f"{k:03d}.f"] = np.asarray(v, np.float64), np.asarray(f, np.int64)
        write_bytes(path, save(tensors))
    return [(tensors[k], tensors[f"{k[:-2]}.f"]) for k in sorted(tensors) if k.endswith(".v")]
