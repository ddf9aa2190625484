"""Convex pieces of parts that are not convex, by CoACD; seconds per part, so cached by the content of the mesh.

CoACD is native code that may run for minutes or die on a mesh that it does not like: it works in a process of its own,
with a time limit, so that neither takes the reader with it.
"""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from safetensors import SafetensorError
from safetensors.numpy import load_file, save, save_file

from pipeline.manifest import sha256, write_bytes

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Pieces = list[tuple[Floats, Ints]]
THRESHOLD = 0.05  # concavity that CoACD may leave, its own default
PIECES = 32
MAX_FACES = 50_000  # of a part; more take minutes
SECONDS = 120  # that a part may take


def available() -> bool:
    """Whether CoACD is installed."""
    return importlib.util.find_spec("coacd") is not None


def decompose(vertices: Floats, faces: Ints, cache: Path) -> Pieces | None:
    """Return convex pieces (vertices (V, 3), faces (F, 3)) of a mesh, or None where CoACD is missing, fails or takes too long.

    `cache` is a folder of results by content hash; a failure is kept as well, as a file without pieces.
    """
    used, index = np.unique(faces, return_inverse=True)
    points, triangles = np.ascontiguousarray(vertices[used]), np.ascontiguousarray(index.reshape(faces.shape), np.int64)
    settings = json.dumps([THRESHOLD, PIECES]).encode()
    path = cache / f"{sha256(settings + points.tobytes() + triangles.tobytes())}.safetensors"
    try:
        tensors = load_file(path)
    except (OSError, SafetensorError):  # not there yet, or half a file of a machine that died
        if not available() or len(triangles) > MAX_FACES:
            return None
        tensors = _cut(points, triangles)
        write_bytes(path, save(tensors))
    return [(tensors[k], tensors[f"{k[:-2]}.f"]) for k in sorted(tensors) if k.endswith(".v")] or None


def _cut(points: Floats, triangles: Ints) -> dict[str, NDArray[np.generic]]:
    """Run CoACD in a process of its own; {} where it fails."""
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder) / "given.safetensors", Path(folder) / "made.safetensors"
        save_file({"v": points, "f": triangles}, given)
        command = [sys.executable, "-c", _PROGRAM, str(given), str(made), str(THRESHOLD), str(PIECES)]
        try:
            subprocess.run(command, check=True, capture_output=True, timeout=SECONDS)
            return dict(load_file(made))
        except (subprocess.SubprocessError, OSError, SafetensorError):
            return {}


_PROGRAM = """
import sys, coacd, numpy as np
from safetensors.numpy import load_file, save_file
given, made, threshold, most = sys.argv[1:]
mesh = load_file(given)
coacd.set_log_level("off")
found = coacd.run_coacd(coacd.Mesh(mesh["v"], mesh["f"]), threshold=float(threshold), max_convex_hull=int(most), seed=0)
pieces = {}
for k, (v, f) in enumerate(found):
    pieces[f"{k:03d}.v"], pieces[f"{k:03d}.f"] = np.asarray(v, np.float64), np.asarray(f, np.int64)
save_file(pieces, made)
"""
