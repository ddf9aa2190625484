"""How `python -m stages.<name>` runs a stage's main: in the checkout, errors of ours as one line and an exit code."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

from pipeline.errors import SfgenError

ROOT = Path(__file__).resolve().parents[1]


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
