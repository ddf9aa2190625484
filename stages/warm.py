"""Compiles what planning and judging homes run, into the cache beside the code: `make run` does it beside its first stages.

Without it the workers of stage `sample` would compile the same functions, each for itself, before their first home.
"""

from pathlib import Path

from pipeline.entry import run
from pipeline.homes.jit_warmup import warm


def main(root: Path) -> None:
    """Compile."""
    warm(root)


if __name__ == "__main__":
    run(main)
