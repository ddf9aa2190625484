"""Compilation of hot loops: numba with a disk cache where one can be written, without it elsewhere (a read-only checkout)."""

import hashlib
import importlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba

# numba looks for SciPy's BLAS, with which it would multiply matrices. No loop here does, and scipy.linalg costs every process
# a tenth of a second and 17 MiB.
if "scipy.linalg" not in sys.modules:
    sys.modules["scipy.linalg"] = None  # type: ignore[assignment]
    importlib.import_module("numba.np.arraymath")
    del sys.modules["scipy.linalg"]

F = TypeVar("F", bound=Callable[..., object])
ROOT = Path(__file__).resolve().parents[1]


def source_digest(root: Path) -> str:
    """Return a digest of every module below `root` that compiles something.

    Compiled code holds what it calls in other modules; numba itself looks only at the module of the function, and would go on using the rest.
    """
    hasher = hashlib.sha256(numba.__version__.encode())
    for path in sorted(root.rglob("*.py")):
        source = path.read_bytes()
        if b"geometry.compiled import" in source:
            hasher.update(source)
    return hasher.hexdigest()[:16]


CONFIG: Any = numba.config
if not CONFIG.CACHE_DIR:
    CONFIG.CACHE_DIR = str(ROOT / "__pycache__" / "numba" / source_digest(ROOT))


def cache_folder() -> Path | None:
    """Return where what is compiled is kept; None where nothing can be written there."""
    folder = Path(CONFIG.CACHE_DIR)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def is_cold() -> bool:
    """Whether nothing has been compiled on this machine yet: the first call of what is will take half a minute."""
    return not any(Path(CONFIG.CACHE_DIR).rglob("*.nbi"))


def compiled(function: F) -> F:
    """Compile `function` on its first call. The plain form stays at `.py_func`: the oracle of the tests.

    Division by zero gives infinity, as in arrays: the checks for it would make the code larger, and slower to compile by a quarter.
    No wrapper for callers from C: nothing calls it, and each costs as much as a small function.
    """
    return _compiled(function, counting=True)


def borrowing(function: F) -> F:
    """Compile a function as `compiled` does that makes no array: its arrays are its callers', and the references to them are not counted.

    Counting takes a third of the time of small functions that are handed many arrays.
    """
    return _compiled(function, counting=False)


def reordering(function: F) -> F:
    """Compile a function as `borrowing` does whose sums may be taken in any order, and products and sums rounded once: it can use vectors for them."""
    return _compiled(function, counting=False, fastmath={"contract", "reassoc", "nsz"})


def _compiled(function: F, *, counting: bool, **more: Any) -> F:
    options: dict[str, Any] = {"error_model": "numpy", "no_cfunc_wrapper": True, "_nrt": counting, **more}
    try:
        return cast("F", numba.njit(cache=True, **options)(function))
    except RuntimeError:  # numba finds no folder for its cache
        return cast("F", numba.njit(cache=False, **options)(function))
