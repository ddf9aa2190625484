"""How `python -m stages.<name>` runs a stage's main: in the checkout, errors of ours as one line and an exit code."""

import os
import sys
from collections.abc import Callable
from pathlib import Path

from pipeline.errors import SfgenError

ROOT = Path(__file__).resolve().parents[1]


def announce_compiling() -> None:
    """Say on stderr why the first plan on a machine takes long."""
    from pipeline.geometry.compiled import is_cold  # numba takes a second to load; most commands do without it

    if is_cold():
        sys.stderr.write("sfgen: compiling the planner, once on this machine: half a minute\n")


def run(main: Callable[[Path], object]) -> None:
    """Call `main` with the checkout's folder and end the process.

    Errors that users can mend are one line on stderr; anything else is a fault of ours and keeps its traceback.
    """
    try:
        main(ROOT)
    except SfgenError as error:
        if os.environ.get("SFGEN_DEBUG"):
            raise
        sys.stderr.write(f"sfgen: {' '.join(str(error).split())}\n")
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        sys.exit(130)
